// SPDX-License-Identifier: Apache-2.0
// `talisman inspect --factoring` and `layers: {auto: …}`: what is promised is what a plan does, and bad input is one line.
#include <sstream>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

// Two bodies of two parts, each of which moves as one, before a wall; a valley around the one that flies.
constexpr const char* kScene = R"(
frames: 24
display: [160, 120]
shapes:
  - {id: wall, box: [14, 8, 0.2], position: [0, 0, -6], color: "#6f8f57"}
  - {id: hub, box: [1, 1, 1], position: [-2, 0, 0], spin: {axis: [0, 1, 0], deg_per_s: 50}}
  - {id: arm, box: [1.6, 0.3, 0.3], carried_by: hub}
  - {id: hull, sphere: 1, flight: [{t: 0, position: [3, -1, 1]}, {t: 1, position: [1, 1, -2]}]}
  - {id: fin, box: [0.2, 1.4, 0.2], carried_by: hull}
camera: {fov_deg: 45, near_m: 0.5, far_m: 50, position: [0, 1, 8], look_at: [0, 0, 0]}
lights: [{kind: ambient, intensity: 1}]
regulator: {policy: threshold, geometric_px: 1}
)";

class FactoringQuestion : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("scene.yaml", kScene);
  }

  struct Drawn {
    std::string renders, polygons, texels;
    bool operator==(const Drawn&) const = default;
  };
  /// Of a plan, as its files say.
  Drawn drawn(const std::string& sequence) const {
    const Outcome planned = run("plan '" + sequence + "' --out p --force --progress none");
    EXPECT_EQ(planned.exit_code, 0) << planned.output;
    std::int64_t renders = 0, polygons = 0, texels = 0;
    for (const std::string& line : lines("p/frames.jsonl")) {
      const Json frame = Json::parse(line);
      renders += frame["renders"].get<std::int64_t>();
      polygons += frame["polygons_rendered"].get<std::int64_t>();
      texels += frame["pixels_rendered"].get<std::int64_t>();
    }
    return {std::to_string(renders), std::to_string(polygons), std::to_string(texels)};
  }
  /// Of the column of the table of sums that has this heading.
  static Drawn said(const std::string& text, const std::string& column) {
    Drawn drawn;
    std::istringstream in(text.substr(text.find("in all")));
    std::string line;
    std::size_t end = 0;
    while (std::getline(in, line) && !line.empty()) {
      if (end == 0) end = line.find(column) + column.size();
      const std::size_t from = line.rfind(' ', end - 1) + 1;
      const std::string number = line.substr(from, end - from);
      if (line.find("renders") != std::string::npos) drawn.renders = number;
      if (line.find("polygons") != std::string::npos) drawn.polygons = number;
      if (line.find("texels") != std::string::npos) drawn.texels = number;
    }
    return drawn;
  }
  static std::string yaml_in(const std::string& text) { return text.substr(text.find("\nlayers:") + 1); }
};

TEST_F(FactoringQuestion, LayersToPasteCostWhatIsPromised) {
  const Outcome outcome = run("inspect scene.yaml --factoring");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  write("pasted.yaml", kScene + yaml_in(outcome.output));
  EXPECT_EQ(drawn("pasted.yaml"), said(outcome.output, "proposed")) << outcome.output;
  EXPECT_EQ(drawn("scene.yaml"), said(outcome.output, "now")) << outcome.output;
}

TEST_F(FactoringQuestion, TheKeyDoesWhatIsProposed) {
  write("auto.yaml", std::string(kScene) + "layers: {auto: velocity}\n");
  write("nodes.yaml", std::string(kScene) + "layers: {auto: node}\n");
  const Outcome outcome = run("inspect scene.yaml --factoring");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(drawn("auto.yaml"), said(outcome.output, "proposed")) << outcome.output;
  EXPECT_EQ(drawn("nodes.yaml"), drawn("scene.yaml")) << "without the key it is a layer per node";
}

TEST_F(FactoringQuestion, AuthoredLayersAreComparedAndTheirShadingStays) {
  write("authored.yaml", std::string(kScene) +
                             "layers:\n  - {name: wall, parts: [wall], fade: 0.5, group: background}\n"
                             "  - {name: rest, parts: ['*']}\n");
  const Outcome outcome = run("inspect authored.yaml --factoring");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("split 'rest' into"), HasSubstr("fade: 0.5"), HasSubstr("group: background")));
  write("pasted.yaml", kScene + yaml_in(outcome.output));
  EXPECT_EQ(drawn("pasted.yaml"), said(outcome.output, "proposed")) << outcome.output;
}

TEST_F(FactoringQuestion, OnePartIsOneLayerAndSaysSo) {
  const Outcome outcome = run("inspect cube.obj --factoring");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("one part: one layer"));
}

TEST_F(FactoringQuestion, AtMostAsManyLayersAsAsked) {
  write("two.yaml", std::string(kScene) + "layers: {auto: velocity, max: 2}\n");
  const Outcome planned = run("plan two.yaml --out p --progress none");
  ASSERT_EQ(planned.exit_code, 0) << planned.output;
  int layers = 0;
  const Json summary = Json::parse(read("p/summary.json"));
  for (const Json& layer : summary["layers"]) layers += !layer["aggregate"].get<bool>();
  EXPECT_LE(layers, 2);
}

TEST_F(FactoringQuestion, BadInputIsOneLine) {
  const auto with = [&](const std::string& layers) {
    write("bad.yaml", std::string(kScene) + "layers: " + layers + "\n");
  };
  with("{auto: velocity, max: 0}");
  expect_bad_input("plan bad.yaml", {"bad.yaml:13", "max", "'0'", "from 1 to 1000"});
  with("{auto: speed}");
  expect_bad_input("plan bad.yaml", {"bad.yaml:13", "auto", "'speed'", "node, velocity"});
  with("{max: 3}");
  expect_bad_input("plan bad.yaml", {"bad.yaml:13", "auto"});
  with("{auto: velocity, most: 3}");
  expect_bad_input("plan bad.yaml", {"bad.yaml:13", "most", "max"});
  expect_bad_input("inspect scene.yaml --factoring --max-layers 0", {"--max-layers is 0", "from 1 to 1000"});
  expect_bad_input("inspect scene.yaml --max-layers 5", {"--max-layers", "--factoring"});
  expect_bad_input("inspect scene.yaml --factoring --order", {"--factoring", "must be one"});
  expect_bad_input("inspect scene.yaml --factoring --json", {"--factoring", "--json"});
}

}  // namespace
}  // namespace talisman
