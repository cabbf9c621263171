// SPDX-License-Identifier: Apache-2.0
// What is judged without fiducials is judged as they would: runs against those of a full scan.
#include <algorithm>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "fiducials/place_floor.h"
#include "regulator/policies.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/sequence.h"
#include "sequences/content/swarm/swarm.h"
#include "sequences/files/errors.h"
#include "sequences/pipeline/draw_instant.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::FrameRun;
using regulator::Policy;

/// Instants one by one, each asked for the first frame, the one that it must reach, and those in between.
FrameRun run_in_order(int frame, regulator::Instants instants, int last, const regulator::Serves& serves) {
  FrameRun best{-1, frame, frame - 1};
  const auto attempt = [&](int instant) {
    const int to_beat = best.last + 1;
    if (to_beat > last || !serves(instant, frame) || (to_beat > frame && !serves(instant, to_beat))) return;
    for (int shown = frame + 1; shown < to_beat; ++shown)
      if (!serves(instant, shown)) return;
    best = {instant, frame, to_beat};
    while (best.last < last && serves(instant, best.last + 1)) ++best.last;
  };
  for (int instant = std::max(frame, instants.first); instant <= instants.last; ++instant) attempt(instant);
  for (int instant = std::min(frame - 1, instants.last); instant >= instants.first; --instant)
    attempt(instant);
  return best;
}

/// Which instants are asked for what, in turn.
using Order = FrameRun (*)(int, regulator::Instants, int, const regulator::Serves&);

/// The run by fit and fiducials alone; adds to `evaluated` how often they were asked.
FrameRun scanned_run(const Pipeline& pipeline, PipelineState& state, int layer, int frame, Order order,
                     std::int64_t& evaluated) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  const auto serves = [&](int instant, int shown) {
    const layers::LayerState& now = captured_states(pipeline, state, shown)[layer];
    if (!now.touches_display) return true;
    const layers::LayerState& then = captured_states(pipeline, state, instant)[layer];
    if (!then.touches_display) return false;
    ++evaluated;
    return regulator::violation_of(
               assess_sprite(pipeline, state.layers, then,
                             captured_placement(pipeline, state, layer, instant), now, shown - frame),
               options)
        .empty();
  };
  const int last = pipeline.settings.frames - 1;
  return options.policy == Policy::Oracle
             ? order(frame, {0, last}, last, serves)
             : order(frame, {frame, std::min(frame + options.lookahead.frames, last)}, last, serves);
}

struct Compared {
  std::int64_t runs = 0, judged = 0, evaluated = 0;
  std::int64_t scanned = 0;     ///< by fiducials alone, one instant after the other
  std::int64_t same_order = 0;  ///< by fiducials alone, in the order of regulator::longest_run
};

/// Every layer that is in view, in every `stride`-th frame.
Compared compare_runs(const Pipeline& pipeline, const std::string& what, int stride = 1) {
  Compared compared;
  PipelineState state(pipeline);
  for (int frame = 0; frame < pipeline.settings.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    if (frame % stride != 0) continue;
    for (const layers::Layer& layer : report.layers) {
      if (!report.order.has_own_sprite(layer.id, layer.is_aggregate()) ||
          !captured_states(pipeline, state, frame)[layer.id].touches_display)
        continue;
      LookaheadReport counts;
      const FrameRun found = choose_draw_instant(pipeline, state, layer.id, frame, &counts);
      EXPECT_EQ(found, scanned_run(pipeline, state, layer.id, frame, run_in_order, compared.scanned))
          << what << ", frame " << frame << ", layer '" << layer.name << "'";
      scanned_run(pipeline, state, layer.id, frame, regulator::longest_run, compared.same_order);
      ++compared.runs;
      compared.judged += counts.judged;
      compared.evaluated += counts.evaluated;
    }
    if (::testing::Test::HasFailure()) break;
  }
  EXPECT_LE(compared.evaluated, compared.same_order) << what;
  return compared;
}

layers::Scene blocks(int count, double moving, int frames) {
  layers::Scene scene = tests::cube_scene();
  scene.parts.clear();
  SwarmContent swarm;
  swarm.count = count;
  swarm.cube_m = 8;
  swarm.moving_percent = moving;
  swarm.seed = 18;
  add_swarm(scene, swarm, 30, frames / 30.0);
  return scene;
}

Settings looking_ahead(Policy policy, int lookahead, int frames) {
  Settings settings;
  settings.view.display_px = {160, 120};
  settings.regulator.policy = policy;
  settings.regulator.lookahead.frames = lookahead;
  settings.frames = frames;
  settings.fps = 30;
  return settings;
}

TEST(CertifiedLookahead, BlocksOfWhichATenthMovesTakeAThirdOfTheCalls) {
  const layers::Scene scene = blocks(40, 10, 40);
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  for (const Policy policy : {Policy::Lookahead, Policy::Oracle}) {
    const Pipeline pipeline = make_pipeline(scene, set, looking_ahead(policy, 64, 40));
    const Compared compared = compare_runs(pipeline, std::string(regulator::name(policy)), 5);
    EXPECT_GT(compared.runs, 100);
    EXPECT_LE(3 * compared.evaluated, compared.scanned) << regulator::name(policy);
  }
}

/// What a run by lookahead 64 asks of a sequence that ships with the tool, as its reports count it, and what it would ask by
/// fiducials alone; nothing where its content was not fetched.
std::optional<Compared> run_of_shipped(const char* name) try {
  const Sequence sequence = load_sequence(name);
  Settings settings = own_settings(sequence);
  settings.regulator.policy = Policy::Lookahead;
  settings.regulator.lookahead.frames = 64;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  Compared compared;
  PipelineState state(pipeline), scanning(pipeline);
  for (int frame = 0; frame < settings.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    step(pipeline, scanning, frame, nullptr);
    compared.judged += report.lookahead->judged;
    compared.evaluated += report.lookahead->evaluated;
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      if (decision.action != regulator::Action::Rerender) continue;
      ++compared.runs;
      const FrameRun run =
          scanned_run(pipeline, scanning, decision.layer, frame, run_in_order, compared.scanned);
      EXPECT_EQ(run.instant, decision.depicts_frame) << name << " " << frame << " " << decision.layer;
    }
  }
  return compared;
} catch (const InputError&) {
  return std::nullopt;
}

TEST(CertifiedLookahead, TheStageTakesAThirdOfTheCalls) {
  const auto stage = run_of_shipped("stage");
  if (!stage) GTEST_SKIP() << "content was not fetched";
  EXPECT_GT(stage->runs, 200);
  EXPECT_LE(3 * stage->evaluated, stage->scanned) << stage->evaluated << " of " << stage->scanned;
  RecordProperty("evaluated", std::to_string(stage->evaluated) + " of " + std::to_string(stage->scanned));
}

TEST(CertifiedLookahead, TheCanyonTakesAThirdOfTheCalls) {
  const auto canyon = run_of_shipped("canyon");
  if (!canyon) GTEST_SKIP() << "content was not fetched";
  EXPECT_LE(3 * canyon->evaluated, canyon->scanned) << canyon->evaluated << " of " << canyon->scanned;
  RecordProperty("evaluated", std::to_string(canyon->evaluated) + " of " + std::to_string(canyon->scanned));
}

TEST(CertifiedLookahead, EveryWarpAndThreshold) {
  const layers::Scene scene = tests::moving_scene();
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  for (const warp::Curve curve : {warp::Curve::trn, warp::Curve::soi, warp::Curve::aff, warp::Curve::affi,
                                  warp::Curve::per, warp::Curve::pers})
    for (const double threshold : {0.0, 0.3, 2.0, 50.0}) {
      Settings settings = looking_ahead(Policy::Lookahead, 12, 24);
      settings.curve = curve;
      settings.regulator.thresholds.geometric_px = threshold;
      compare_runs(make_pipeline(scene, set, settings), std::string(warp::name(curve)), 4);
    }
}

// Lights, shadows, highlights, skins, fades, cameras that fly through: whatever the lot brings.
TEST(CertifiedLookahead, ScenesDrawnByLot) {
  const tests::TemporaryFolder folder;
  Compared all;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Sequence sequence = tests::random_sequence(seed, folder.path());
    Settings settings = own_settings(sequence);
    settings.compression.reset();
    settings.regulator.policy = seed % 2 ? Policy::Lookahead : Policy::Oracle;
    settings.regulator.lookahead = {};
    settings.regulator.lookahead.frames = 6;
    const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
    const Compared compared = compare_runs(pipeline, "seed " + std::to_string(seed));
    all.runs += compared.runs;
    all.evaluated += compared.evaluated;
    all.scanned += compared.scanned;
    if (HasFailure()) break;
  }
  EXPECT_GT(all.runs, 300);
  EXPECT_LT(all.evaluated, all.scanned);
}

// Bodies that turn and fly, in and out of view, near the eye: no affine fit is better than the bound says.
TEST(PlaceFloor, IsNeverAboveTheErrorOfTheFit) {
  const layers::Scene scene = blocks(60, 100, 30);
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  Settings settings = looking_ahead(Policy::Lookahead, 4, 30);
  int said = 0, said_of_all = 0;
  for (const warp::Curve curve : {warp::Curve::trni, warp::Curve::so, warp::Curve::aff, warp::Curve::affi}) {
    settings.curve = curve;
    const Pipeline pipeline = make_pipeline(scene, set, settings);
    PipelineState state(pipeline);
    for (const auto& [instant, frame] : {std::pair{0, 1}, {0, 7}, {20, 3}, {11, 29}, {5, 5}})
      for (const layers::Layer& layer : set.layers) {
        const layers::LayerState& then = captured_states(pipeline, state, instant)[layer.id];
        const layers::LayerState& now = captured_states(pipeline, state, frame)[layer.id];
        if (!then.touches_display || !now.touches_display) continue;
        const double floor_px = fiducials::affine_floor_px(then, now, state.layers.bound(layer.id).hull);
        const regulator::LayerAssessment assessment =
            assess_sprite(pipeline, state.layers, then,
                          captured_placement(pipeline, state, layer.id, instant), now, frame - instant);
        ASSERT_LE(floor_px, assessment.fiducials.geometric.px)
            << layer.name << " " << instant << " " << frame;
        const double of_all_px = fiducials::affine_floor_px(
            layers::correspond(then, now, state.layers.bound(layer.id).hull, frame - instant));
        ASSERT_LE(of_all_px, assessment.fiducials.geometric.px)
            << layer.name << " " << instant << " " << frame;
        said += floor_px > 0.5 * assessment.fiducials.geometric.px && floor_px > 0;
        said_of_all += of_all_px > 0.5 * assessment.fiducials.geometric.px && of_all_px > 0;
      }
  }
  EXPECT_GT(said, 100) << "it says little";
  EXPECT_GE(said_of_all, said) << "it says less, of more points";
}

TEST(PlaceFloor, ExactAffineMotionHasNoFloorAndTooFewPointsSayNothing) {
  const layers::Scene scene = blocks(1, 0, 2);
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  const Pipeline pipeline = make_pipeline(scene, set, looking_ahead(Policy::Lookahead, 1, 2));
  PipelineState state(pipeline);
  const layers::LayerState then = captured_states(pipeline, state, 0)[0];
  const layers::Polyhedron& hull = state.layers.bound(0).hull;
  EXPECT_EQ(fiducials::affine_floor_px(then, then, hull), 0);
  layers::LayerState sheared = then;
  for (layers::dvec4& p : sheared.clip_points) p.x += 0.25 * p.y + 0.1 * p.w;
  EXPECT_LT(fiducials::affine_floor_px(then, sheared, hull), 1e-6);
  layers::LayerState behind = then;
  for (std::size_t i = 0; i + 3 < behind.clip_points.size(); ++i) behind.clip_points[i].w = -1;
  EXPECT_EQ(fiducials::affine_floor_px(then, behind, hull), 0);
  layers::LayerState lost = then;
  for (layers::dvec4& p : lost.clip_points) p.x = NAN;
  EXPECT_EQ(fiducials::affine_floor_px(then, lost, hull), 0);
}

}  // namespace
}  // namespace talisman::sequences
