// SPDX-License-Identifier: Apache-2.0
// What the error of an old sprite comes from. The square of 2 m is seen head-on from 3 m: with f the focal length in pixels
// its corners are f / 3 from the middle along each axis, and where they go is known by hand.
#include "sequences/results/report/changes.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/commands/tool.h"
#include "tests/support/room.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;

constexpr double kHeight_px = 150, kFov_rad = 1.2, kDistance_m = 3;
const double kFocal_px = kHeight_px / 2 / std::tan(kFov_rad / 2);

/// From frame 0 to frame 1 the node goes straight from where it is.
void move(layers::Scene& scene, int node, dvec3 by_m) {
  if (by_m == dvec3(0)) return;
  layers::TransformTrack track;
  const dvec3 from = scene.nodes[node].local.translation;
  track.translation = {{0, 1}, {from, from + by_m}};
  scene.tracks.push_back({node, track});
}

/// Drawn in frame 0, and looked at in frame 1.
std::vector<Change> changes_of(const layers::Scene& scene, const layers::LayerSet& set, Settings settings) {
  settings.view.display_px = {200, static_cast<int>(kHeight_px)};
  settings.fps = 1;
  settings.frames = 2;
  settings.regulator.thresholds.geometric_px = 1e4;
  const Pipeline pipeline = make_pipeline(scene, set, settings);
  PipelineState state(pipeline);
  LastRenders before;
  before.note(step(pipeline, state, 0, nullptr));
  const FrameReport report = step(pipeline, state, 1, nullptr);
  return changes_in(pipeline, report, before);
}

/// The square, carried by a warp that moves it without a turn or a scale, or (Hold) left where it was.
std::vector<Change> changes_of_square(dvec3 camera_m, dvec3 square_m, regulator::Policy policy) {
  layers::Scene scene = tests::textured_quad_scene();
  scene.cameras[0].fov_y_rad = kFov_rad;
  move(scene, scene.cameras[0].node, camera_m);
  move(scene, scene.parts[0].node, square_m);
  Settings settings;
  settings.regulator.policy = policy;
  settings.curve = warp::Curve::trn;
  return changes_of(scene, layers::factor(scene, tests::one_layer_per_part(scene)), settings);
}

/// How far a corner moves when the square comes nearer.
double zoom_px(double to_m) { return std::sqrt(2) * kFocal_px * (1 / to_m - 1 / kDistance_m); }

constexpr double kExact_px = 1e-6;

TEST(Changes, OfTheCameraAloneAreAllOfTheError) {
  const auto changes = changes_of_square({0.3, 0, 0}, {}, regulator::Policy::Hold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].layer, "quad");
  EXPECT_EQ(changes[0].frame, 1);
  EXPECT_EQ(changes[0].since_frame, 0);
  EXPECT_NEAR(changes[0].geometric_px, 0.1 * kFocal_px, kExact_px);
  EXPECT_EQ(changes[0].camera_px, changes[0].geometric_px);
  EXPECT_EQ(changes[0].sum_px(), changes[0].camera_px);
  EXPECT_TRUE(changes[0].separable);
}

TEST(Changes, OfTheLayerAloneAreItsOwnMotion) {
  const auto changes = changes_of_square({}, {0, 0, 0.1}, regulator::Policy::Threshold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_NEAR(changes[0].geometric_px, zoom_px(2.9), kExact_px);
  EXPECT_EQ(changes[0].own_motion_px, changes[0].geometric_px);
  EXPECT_EQ(changes[0].sum_px(), changes[0].own_motion_px);
  EXPECT_TRUE(changes[0].separable);
}

TEST(Changes, OfBothAlongOneLineSumUp) {
  const auto changes = changes_of_square({0.3, 0, 0}, {-0.15, 0, 0}, regulator::Policy::Hold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_NEAR(changes[0].geometric_px, 0.15 * kFocal_px, kExact_px);
  EXPECT_NEAR(changes[0].camera_px.value(), 0.1 * kFocal_px, kExact_px);
  EXPECT_NEAR(changes[0].own_motion_px.value(), 0.05 * kFocal_px, kExact_px);
  EXPECT_TRUE(changes[0].separable);
}

/// 1/2.8 - 1/3 is 3.6 % more than twice 1/2.9 - 1/3; 1/2 - 1/3 is a quarter more than twice 1/2.5 - 1/3.
TEST(Changes, OfBothTowardsEachOtherAreSeparableAsLongAsPerspectiveIsWeak) {
  auto changes = changes_of_square({0, 0, -0.1}, {0, 0, 0.1}, regulator::Policy::Threshold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_NEAR(changes[0].geometric_px, zoom_px(2.8), kExact_px);
  EXPECT_NEAR(changes[0].camera_px.value(), zoom_px(2.9), kExact_px);
  EXPECT_NEAR(changes[0].own_motion_px.value(), zoom_px(2.9), kExact_px);
  EXPECT_TRUE(changes[0].separable);
  changes = changes_of_square({0, 0, -0.5}, {0, 0, 0.5}, regulator::Policy::Threshold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_NEAR(changes[0].geometric_px, zoom_px(2), kExact_px);
  EXPECT_NEAR(changes[0].camera_px.value(), zoom_px(2.5), kExact_px);
  EXPECT_NEAR(changes[0].own_motion_px.value(), zoom_px(2.5), kExact_px);
  EXPECT_FALSE(changes[0].separable);
}

TEST(Changes, OfACameraThatGoesAlongAreNotSeparable) {
  const auto changes = changes_of_square({0.3, 0, 0}, {0.15, 0, 0}, regulator::Policy::Hold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_NEAR(changes[0].geometric_px, 0.05 * kFocal_px, kExact_px);
  EXPECT_NEAR(changes[0].camera_px.value(), 0.1 * kFocal_px, kExact_px);
  EXPECT_NEAR(changes[0].own_motion_px.value(), 0.05 * kFocal_px, kExact_px);
  EXPECT_FALSE(changes[0].separable);
}

/// The camera goes four metres to the side and the square with it: alone, either takes it out of view.
TEST(Changes, OfACauseThatWouldTakeTheLayerOutOfViewAreNotKnown) {
  const auto changes = changes_of_square({4, 0, 0}, {3.9, 0, 0}, regulator::Policy::Hold);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_NEAR(changes[0].geometric_px, 0.1 / kDistance_m * kFocal_px, kExact_px);
  EXPECT_FALSE(changes[0].camera_px.has_value());
  EXPECT_FALSE(changes[0].own_motion_px.has_value());
  EXPECT_FALSE(changes[0].separable);
  EXPECT_NE(json_of(changes[0]).find("\"camera_px\":null"), std::string::npos);
}

TEST(Changes, OfWhatIsNotOffAreNotListed) {
  EXPECT_TRUE(changes_of_square({}, {}, regulator::Policy::Hold).empty());
  EXPECT_TRUE(changes_of_square({0.3, 0, 0}, {0.3, 0, 0}, regulator::Policy::Hold).empty());
  // The warp carries all of it.
  const auto carried = changes_of_square({0.3, 0, 0}, {}, regulator::Policy::Threshold);
  for (const Change& change : carried) EXPECT_LT(change.geometric_px, kExact_px);
}

/// The floor of the room, on which the ball's shadow falls; nothing of it moves, nor does the camera.
Change change_of_floor(dvec3 ball_m, dvec3 lamp_m) {
  constexpr int kBall = 1, kLamp = 3;
  tests::Room room = tests::Room().casting();
  move(room.scene, kBall, ball_m);
  move(room.scene, kLamp, lamp_m);
  Settings settings;
  settings.regulator.policy = regulator::Policy::Threshold;
  const auto changes = changes_of(room.scene, layers::factor(room.scene, room.specs), settings);
  for (const Change& change : changes)
    if (change.layer == "floor") return change;
  ADD_FAILURE() << "the floor is not off";
  return {};
}

TEST(Changes, OfAnotherLayerComeByItsShadow) {
  const Change change = change_of_floor({0.2, 0, 0}, {});
  EXPECT_GT(change.other_layers_px.value(), 1);
  EXPECT_EQ(change.other_layers_px, change.geometric_px);
  EXPECT_EQ(change.sum_px(), change.other_layers_px);
  EXPECT_TRUE(change.separable);
}

TEST(Changes, OfALightComeByTheShadowsThatItThrows) {
  const Change change = change_of_floor({}, {0.2, 0, 0});
  EXPECT_GT(change.light_px.value(), 1);
  EXPECT_EQ(change.light_px, change.geometric_px);
  EXPECT_EQ(change.sum_px(), change.light_px);
  EXPECT_TRUE(change.separable);
}

/// Three metres above the ball the lamp's way moves the shadow the other way: they cancel out.
TEST(Changes, OfLightAndBallAgainstEachOtherAreNotSeparable) {
  const Change change = change_of_floor({0.2, 0, 0}, {0.2, 0, 0});
  EXPECT_EQ(change.light_px, change_of_floor({}, {0.2, 0, 0}).geometric_px);
  EXPECT_EQ(change.other_layers_px, change_of_floor({0.2, 0, 0}, {}).geometric_px);
  EXPECT_LT(change.geometric_px, change.sum_px());
  EXPECT_FALSE(change.separable);
}

TEST(LastRenders, AreThoseOfTheNameWhateverItsIdIs) {
  LastRenders renders;
  FrameReport report;
  report.frame = 7;
  layers::LayerSet set;
  set.layers.resize(2);
  set.layers[0].name = "a";
  set.layers[1].name = "b";
  report.layers = LayerTable(set, BoundTable{});
  report.plan.decisions.resize(2);
  for (int layer = 0; layer < 2; ++layer) report.plan.decisions[layer].layer = layer;
  report.plan.decisions[0].action = regulator::Action::Reuse;
  report.plan.decisions[0].depicts_frame = 2;
  report.plan.decisions[1].action = regulator::Action::Rerender;
  report.plan.decisions[1].depicts_frame = 9;
  renders.note(report);
  EXPECT_FALSE(renders.of("a"));
  ASSERT_TRUE(renders.of("b"));
  EXPECT_EQ(renders.of("b")->frame, 7);
  EXPECT_EQ(renders.of("b")->instant, 9);
}

using Json = nlohmann::json;

class ChangesOfARun : public Tool {
 protected:
  /// By frame and layer.
  std::map<std::pair<int, std::string>, Json> lines(const std::string& file) const {
    std::map<std::pair<int, std::string>, Json> all;
    std::istringstream in(read(file));
    for (std::string line; std::getline(in, line);) {
      Json json = Json::parse(line);
      all[{json["frame"].get<int>(), json["layer"].get<std::string>()}] = json;
    }
    return all;
  }
};

TEST_F(ChangesOfARun, ExplainTheErrorOfEachDecisionThatHasOne) {
  ASSERT_EQ(run("plan carousel --size 160x120 --progress none --out o").exit_code, 0);
  const auto changes = lines("o/changes.jsonl"), decisions = lines("o/decisions.jsonl");
  int with_error = 0, separable = 0;
  for (const auto& [at, decision] : decisions) {
    if (decision["fiducials"].is_null() || at.second.rfind("shadow map", 0) == 0) continue;
    const double error_px = decision["fiducials"]["warp_geometric_px"];
    ASSERT_EQ(changes.contains(at), error_px > 0) << at.first << " " << at.second;
    if (!(error_px > 0)) continue;
    ++with_error;
    const Json& change = changes.at(at);
    EXPECT_EQ(change["geometric_px"], decision["fiducials"]["warp_geometric_px"]);
    double sum_px = 0;
    for (const char* cause : {"camera_px", "own_motion_px", "light_px", "other_layers_px"})
      sum_px += change[cause].get<double>();
    EXPECT_EQ(change["separable"], std::fabs(sum_px - error_px) <= 0.1 * error_px) << change;
    separable += change["separable"] == true;
    EXPECT_LT(change["since_frame"], at.first);
  }
  EXPECT_GT(with_error, 500);
  EXPECT_GT(separable, with_error / 4);
}

TEST_F(ChangesOfARun, OfARangeAreThoseOfTheWholeRun) {
  const std::string options = "plan carousel --size 160x120 --progress none ";
  ASSERT_EQ(run(options + "--out o").exit_code, 0);
  ASSERT_EQ(run(options + "--frames 20-24 --out p").exit_code, 0);
  const auto whole = lines("o/changes.jsonl"), part = lines("p/changes.jsonl");
  EXPECT_FALSE(part.empty());
  std::size_t inside = 0;
  for (const auto& [at, change] : whole) {
    if (at.first < 20 || at.first > 24) continue;
    ++inside;
    ASSERT_TRUE(part.contains(at)) << at.first << " " << at.second;
    EXPECT_EQ(part.at(at), change);
  }
  EXPECT_EQ(part.size(), inside);
}

TEST_F(ChangesOfARun, AreNotWrittenWithoutTheReportAndOldOnesGo) {
  const std::string options = "plan carousel --frames 0-3 --size 64x48 --progress none --out o";
  ASSERT_EQ(run(options).exit_code, 0);
  EXPECT_NE(read("o/changes.jsonl"), "");
  const std::string decisions = read("o/decisions.jsonl");
  ASSERT_EQ(run(options + " --no-report").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("o/changes.jsonl")));
  EXPECT_EQ(read("o/decisions.jsonl"), decisions);
}

}  // namespace
}  // namespace talisman::sequences
