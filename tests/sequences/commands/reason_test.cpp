// SPDX-License-Identifier: Apache-2.0
// Why was a layer drawn again that did not move? The reason names what ran over it, with the figures of the decision.
#include <cstdio>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;

class Reasons : public Tool {
 protected:
  /// A slab of 8 m at rest, above it a bar of 1 m that flies along it, a lamp above both, seen from a fixed place.
  void plan(const std::string& layers,
            const std::string& camera = "position: [0, 6, 9], look_at: [0, 0, 0]") {
    write("mill.yaml",
          "frames: 12\nfps: 12\ndisplay: [320, 240]\nshapes:\n  - {id: slab, box: [8, 0.2, 8], color: [0.6, "
          "0.5, 0.4]}\n"
          "  - {id: bar, box: [1, 0.2, 1], flight: [{t: 0, position: [-2, 2, 0], target: [-9, 2, 0]},"
          " {t: 1, position: [2, 2, 0], target: [-9, 2, 0]}]}\n"
          "camera: {fov_deg: 50, near_m: 0.5, far_m: 100, " +
              camera +
              "}\n"
              "lights:\n  - {kind: ambient, color: [0.3, 0.3, 0.3]}\n"
              "  - {kind: spot, name: key, position: [0, 10, 0.1], look_at: [0, 0, 0], inner_deg: 50, "
              "outer_deg: 60,"
              " casts_shadow: true}\n" +
              layers);
    const Outcome outcome = run("plan mill.yaml --out o --geometric-px 2 --progress none");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const std::string& line : lines("o/decisions.jsonl"))
      decisions_.push_back(nlohmann::json::parse(line));
  }

  /// Decisions about `layer` whose reason holds `words`, of which each has the sum right. How many there are.
  int checked(const std::string& layer, const std::string& words) const {
    int count = 0;
    for (const nlohmann::json& decision : decisions_) {
      const std::string reason = decision["reason"];
      if (decision["layer"] != layer || reason.find(words) == std::string::npos) continue;
      ++count;
      const nlohmann::json& of = decision["fiducials"];
      const double sum = of["warp_geometric_px"], shade = of["shade_px"];
      EXPECT_EQ(decision["decision"], "rerender");
      EXPECT_GT(sum, 2) << reason;
      double place_said = 0, shade_said = shade;
      const std::size_t bracket = reason.find('(');
      if (reason.find("of place") != std::string::npos) {
        EXPECT_EQ(std::sscanf(reason.c_str() + bracket, "(%lf of place + %lf", &place_said, &shade_said), 2);
      }
      EXPECT_NEAR(place_said, sum - shade, 1e-3) << reason;
      EXPECT_NEAR(shade_said, shade, 1e-3) << reason;
    }
    return count;
  }

  std::vector<nlohmann::json> decisions_;
};

TEST_F(Reasons, ShadowThatRanOverALayerIsNamedWithItsCasterAndLight) {
  plan("layers:\n  - {name: ground, parts: [slab]}\n  - {name: rotor, parts: [bar]}\n");
  EXPECT_GT(checked("ground", "of the shadow of 'rotor' in light 'key')"), 2);
  EXPECT_EQ(checked("rotor", "shadow of '"), 0) << "only its own shadow may fall on the bar";
}

TEST_F(Reasons, ShadowLayerNamesTheCasterToo) {
  plan(
      "layers:\n  - {name: ground, parts: [slab], shading: {shadows: {}}}\n  - {name: rotor, parts: "
      "[bar]}\n");
  EXPECT_EQ(checked("ground", "shadow"), 0) << "it holds no shadow";
  int named = 0;
  for (const std::string layer : {"ground/shadow of key", "ground/light of key"})
    named += checked(layer, "of the shadow of 'rotor' in light 'key')");
  EXPECT_GT(named, 2);
}

TEST_F(Reasons, ShadowOfTheLayerItselfIsItsOwn) {
  plan("layers:\n  - {name: mill, parts: [slab, bar], shading: {shadows: {}}}\n");
  int own = 0;
  for (const std::string layer : {"mill/shadow of key", "mill/light of key"})
    own += checked(layer, "its own shadow in light 'key'");
  EXPECT_GT(own, 0);
}

TEST_F(Reasons, WorstPlaceLiesOnTheDisplay) {
  // The slab reaches far beyond the display on all sides, and the eye moves.
  plan("layers:\n  - {name: ground, parts: [slab]}\n  - {name: rotor, parts: [bar]}\n",
       "flight: [{t: 0, position: [0, 3, 4], target: [0, 0, 0]},"
       " {t: 1, position: [1, 3, 4], target: [0.5, 0, 0]}]");
  int count = 0;
  for (const nlohmann::json& decision : decisions_) {
    if (!decision.contains("fiducials") || !decision["fiducials"].is_object()) continue;
    const nlohmann::json& place = decision["fiducials"]["worst_at_px"];
    ++count;
    EXPECT_GE(place[0], 0) << decision.dump();
    EXPECT_LE(place[0], 320) << decision.dump();
    EXPECT_GE(place[1], 0) << decision.dump();
    EXPECT_LE(place[1], 240) << decision.dump();
  }
  EXPECT_GT(count, 10);
}

}  // namespace
}  // namespace talisman
