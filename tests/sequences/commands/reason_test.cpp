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

class TallShadows : public Reasons {
 protected:
  /// A floor of 10 m, on it a post of 4 m, and a lamp of half its height.
  void plan_post(const std::string& post, const std::string& lamp) {
    write("mill.yaml",
          "frames: 12\nfps: 12\ndisplay: [320, 240]\nshapes:\n  - {id: slab, plane: [10, 10], color: [0.6, "
          "0.5, 0.4]}\n"
          "  - {id: bar, box: [0.4, 4, 0.4], " +
              post +
              "}\ncamera: {fov_deg: 40, near_m: 0.1, far_m: 60, position: [0, 6, 8], look_at: [0, 0, 0]}\n"
              "lights:\n  - {kind: ambient, color: [0.1, 0.1, 0.1]}\n"
              "  - {kind: point, name: key, casts_shadow: true, " +
              lamp +
              "}\n"
              "layers:\n  - {name: ground, parts: [slab], shading: {shadows: {}}}\n  - {name: rotor, parts: "
              "[bar]}\n");
    const Outcome outcome = run("plan mill.yaml --out o --geometric-px 2 --photometric 0.5 --progress none");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const std::string& line : lines("o/decisions.jsonl"))
      decisions_.push_back(nlohmann::json::parse(line));
  }
};

// The post rises above the lamp: its shadow does not end. The lamp moves by 0.36 m a frame, 2 m from the post: its
// shadow turns by 10 degrees a frame.
TEST_F(TallShadows, ShadowWithoutEndIsFollowedWhereTheLampMoves) {
  plan_post("position: [0, 2, 0]",
            "flight: [{t: 0, position: [-2, 2, -2], target: [0, 2, -9]}, {t: 1, position: [2, 2, -2], "
            "target: [0, 2, -9]}]");
  EXPECT_EQ(checked("ground/shadow of key", "shadow of 'rotor' in light 'key'"), 11);
}

TEST_F(TallShadows, ShadowWithoutEndIsFollowedWhereThePostMoves) {
  plan_post(
      "flight: [{t: 0, position: [-1, 2, 0], target: [-1, 2, -9]}, {t: 1, position: [1, 2, 0], target: [1, "
      "2, -9]}]",
      "position: [0, 2, -2]");
  EXPECT_EQ(checked("ground/shadow of key", "shadow of 'rotor' in light 'key'"), 11);
}

TEST_F(TallShadows, NothingMovesNothingIsDrawn) {
  plan_post("position: [0, 2, 0]", "position: [1, 2, -2]");
  EXPECT_EQ(checked("ground/shadow of key", "shadow"), 0);
}

TEST_F(Reasons, LightThatRunsOverAMirroredBodyIsFollowed) {
  write("mirror.yaml",
        "frames: 12\nfps: 12\ndisplay: [320, 240]\nshapes:\n"
        "  - {id: floor, plane: [10, 10], color: [0, 0, 0], reflectivity: 0.9}\n"
        "  - {id: ball, sphere: 2, position: [0, 1.6, -1]}\n"
        "camera: {fov_deg: 40, near_m: 0.1, far_m: 60, position: [0, 4, 8], look_at: [0, 0, 0]}\n"
        "lights:\n  - {kind: spot, name: beam, inner_deg: 4, outer_deg: 8,"
        " flight: [{t: 0, position: [0, 2, 6], target: [-1.5, 1.6, -1]}, {t: 1, position: [0.01, 2, 6], "
        "target: [1.5, 1.6, -1]}]}\n"
        "layers:\n  - {name: floor, parts: [floor], group: background}\n  - {name: ball, parts: [ball]}\n");
  const Outcome outcome = run("plan mirror.yaml --out o --geometric-px 1 --progress none");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  int drawn = 0;
  for (const std::string& line : lines("o/decisions.jsonl"))
    if (const auto json = nlohmann::json::parse(line);
        json["layer"] == "floor" && json["decision"] == "rerender" &&
        json["reason"].get<std::string>().find("reflection of 'ball'") != std::string::npos)
      ++drawn;
  EXPECT_GE(drawn, 8);  // the beam crosses the ball in about nine frames
}

TEST_F(Reasons, ShadowsOfAllLightsAreNamedAsSuch) {
  std::string text = kPassing;
  text.replace(text.find("shadows: {}"), 11, "shadows: {as: multiply}");
  text.replace(text.find("lights:\n"), 8,
               "compositor: extended\nlights:\n  - {kind: directional, name: sun, direction: [0.2, -1, 0.1], "
               "casts_shadow: "
               "true}\n");
  write("all.yaml", text);
  const Outcome outcome = run("inspect all.yaml");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("the shadows of all lights"));
}

// A light layer has no alpha, and a shadow is black over black: both are made visible before they are compared.
TEST_F(Reasons, AuditSeesLightAndShadowLayers) {
  for (const char* as : {"light", "shade", "multiply", "atop"}) {
    std::string text = std::string("compositor: extended\n") + kPassing;
    text.replace(text.find("shadows: {}"), 11, std::string("shadows: {as: ") + as + "}");
    write("held.yaml", text);
    const Outcome outcome =
        run(std::string("audit held.yaml --policy hold --hold 8 --every 1 --progress none --out a_") + as);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    bool is_seen = false;
    const auto summary = nlohmann::json::parse(read(std::string("a_") + as + "/summary.json"));
    for (const auto& layer : summary["audit"])
      if (layer["layer"].get<std::string>().rfind("wall/", 0) == 0)
        is_seen |= layer["flip"] > 0.01 && layer["rms"] > 0.001;
    EXPECT_TRUE(is_seen) << as << "\n" << summary["audit"].dump(1);
  }
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
