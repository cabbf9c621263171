// SPDX-License-Identifier: Apache-2.0
// Scenes and settings drawn by lot, from millionths of a unit to thousands of millions: every number is one, no error is
// negative, nothing kept is beyond its threshold, and what decisions say adds up to what frames and the summary say. A
// failure names its seed, which makes the same case again.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "sequences/content/own_settings.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/predictive/plan_buffers.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/summary.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;

constexpr std::uint32_t kSeeds = 240;

/// By lot, the same for the same seed.
class Lot {
 public:
  explicit Lot(std::uint32_t seed) : random_(seed) {}
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  bool one_in(int count) { return below(count) == 0; }
  template <typename T, std::size_t N>
  T of(const T (&values)[N]) {
    return values[below(static_cast<int>(N))];
  }

 private:
  std::mt19937 random_;
};

struct Case {
  Sequence sequence;
  Settings settings;
  double scale = 1;
};

Settings settings_by_lot(const Sequence& sequence, Lot& lot) {
  Settings settings = own_settings(sequence);
  regulator::RegulatorOptions& options = settings.regulator;
  options.policy =
      regulator::kAllPolicies[static_cast<std::size_t>(lot.below(regulator::kAllPolicies.size()))];
  if (options.policy == Policy::Predictive && !unpredictable(*sequence.scene, sequence.layers).empty())
    options.policy = Policy::Threshold;
  options.thresholds.geometric_px = lot.of({0.0, 1e-3, 0.25, 1.0, 4.0, 1e4});
  options.thresholds.turned_px = lot.of({0.0, 0.0, 3.0});
  options.thresholds.light_angle_rad = lot.of({0.0, 0.0, 0.1});
  options.thresholds.photometric = lot.of({0.0, 0.01, 0.05});
  options.hold_frames = 1 + lot.below(4);
  options.lookahead.frames = lot.of({1, 4, 16});
  options.lookahead.predict = lot.one_in(3) ? regulator::Prediction::Linear : regulator::Prediction::Known;
  options.color_warp = !lot.one_in(4);
  options.settle_frames = lot.of({0, 0, 2});
  options.stagger = options.policy == Policy::Interpolate && lot.one_in(2);
  if (options.policy == Policy::Threshold) {
    options.blend_frames = lot.of({0, 0, 3});
    if (options.blend_frames == 0 && lot.one_in(3)) options.regroup.by = regulator::Regroup::Amortised;
  }
  if (options.policy == Policy::Budget) options.budget.ms = lot.of({0.0, 0.01, 1.0});
  settings.bound = lot.of({layers::BoundKind::Box8, layers::BoundKind::Dop14, layers::BoundKind::Dop26});
  settings.curve =
      warp::kAllCurves[static_cast<std::size_t>(lot.below(static_cast<int>(warp::kAllCurves.size())))];
  settings.cycles = lot.of({Cycles::Merge, Cycles::Keep});
  settings.material_points = lot.of({0, 16, layers::kDefaultMaterialPoints});
  return settings;
}

Case case_of(std::uint32_t seed, const std::string& folder) {
  Lot lot(seed);
  Case by_lot{tests::random_sequence(seed, folder), {}, lot.of({1e-6, 1e-3, 1.0, 1.0, 1e3, 1e6, 1e9})};
  by_lot.sequence.scene =
      std::make_shared<const layers::Scene>(tests::scaled(*by_lot.sequence.scene, by_lot.scale));
  by_lot.settings = settings_by_lot(by_lot.sequence, lot);
  return by_lot;
}

struct Sums {
  std::int64_t polygons = 0, pixels = 0;
  int renders = 0, kept = 0;
};

/// An error, a size, a cost: a number that is not negative.
void expect_amount(double value, const char* what, const std::string& where) {
  EXPECT_TRUE(value >= 0) << what << " is " << value << where;
}

void expect_fiducials(const DecisionRow& row, const std::string& where) {
  const fiducials::Report& f = row.assessment.fiducials;
  expect_amount(f.geometric.px, "geometric", where);
  expect_amount(f.sampling.magnification, "magnification", where);
  expect_amount(f.sampling.minification, "minification", where);
  EXPECT_TRUE(f.sampling.anisotropy >= 1) << f.sampling.anisotropy << where;
  expect_amount(f.visibility.uncovered_px, "uncovered", where);
  expect_amount(f.photometric.color, "photometric", where);
  EXPECT_LE(f.photometric.light_angle_rad, M_PI + 1e-9) << where;
  expect_amount(f.photometric.light_angle_rad, "light angle", where);
  expect_amount(f.turned.px, "turned", where);
  expect_amount(f.shade.px, "shade", where);
  for (const layers::dvec2& place : {f.geometric.where_px, f.sampling.where_px, f.visibility.where_px,
                                     f.photometric.where_px, f.turned.where_px, f.shade.where_px})
    EXPECT_TRUE(std::isfinite(place.x) && std::isfinite(place.y)) << place.x << " " << place.y << where;
}

void expect_decision(const DecisionRow& row, const Settings& settings, const std::string& where, Sums& sums) {
  const regulator::LayerDecision& d = row.decision;
  expect_amount(d.shown_geometric_px, "shown error", where);
  expect_amount(d.warp_geometric_px, "error of the warp", where);
  expect_amount(row.assessment.held_geometric_px, "held error", where);
  EXPECT_TRUE(d.resolution > 0 && std::isfinite(d.resolution)) << d.resolution << where;
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_TRUE(d.shown_color[channel] >= 0 && d.shown_color[channel] <= 1) << where;
  EXPECT_TRUE(d.cost.polygons >= 0 && d.cost.pixels >= 0 && d.cost.chunks >= 0 && d.cost.bytes >= 0) << where;
  EXPECT_TRUE(d.action == Action::Rerender || d.cost.polygons == 0) << where;
  sums.polygons += d.cost.polygons, sums.pixels += d.cost.pixels;
  sums.renders += d.action == Action::Rerender;
  sums.kept += d.action == Action::Reuse;
  const double weight = row.assessment.preferences.importance.geometric;
  const double limit_px = settings.regulator.thresholds.geometric_px / weight;
  const bool is_bounded =
      settings.regulator.policy == Policy::Threshold && settings.regulator.blend_frames == 0 && weight > 0;
  EXPECT_TRUE(!is_bounded || d.action != Action::Reuse || d.shown_geometric_px <= limit_px * (1 + 1e-9))
      << d.shown_geometric_px << " px, " << d.reason << where;
}

Sums run_of_case(const Case& by_lot, const std::string& where) {
  const Pipeline pipeline = make_pipeline(*by_lot.sequence.scene, by_lot.sequence.layers, by_lot.settings);
  PipelineState state(pipeline);
  Summary summary = start_summary(pipeline, by_lot.sequence.name);
  Sums all;
  for (int frame = 0; frame < by_lot.sequence.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    const FrameLine line = line_of(report);
    Sums sums;
    for (const DecisionRow& row : decision_rows(state, report)) {
      const std::string at = "\n  " + where + ", frame " + std::to_string(frame) + ", layer " + row.name;
      expect_fiducials(row, at);
      expect_decision(row, by_lot.settings, at, sums);
    }
    for (const double ms : {line.modelled_ms, line.modelled_drawing_ms, line.depth_complexity})
      EXPECT_TRUE(ms >= 0 && std::isfinite(ms)) << ms << where << " frame " << frame;
    EXPECT_EQ(sums.polygons, line.polygons.rendered) << where << " frame " << frame;
    add_decisions(summary, report, state);
    summary.frames.push_back(line);
    all.polygons += sums.polygons, all.pixels += line.pixels.rendered;
    all.renders += sums.renders, all.kept += sums.kept;
    for (const ShadowMapRow& map :
         report.shadow_maps)  // looking ahead, more than one picture may be drawn of it
      all.renders += map.pictures - (map.decision.action == Action::Rerender);
  }
  EXPECT_EQ(all.polygons, summary.polygons_rendered()) << where;
  EXPECT_EQ(all.pixels, summary.pixels_rendered()) << where;
  int renders = 0;
  for (const LayerSummary* row : summary.rows())
    if (!row->is_mirror) renders += row->renders;  // a mirrored picture is drawn by its layer's decision
  EXPECT_EQ(all.renders, renders) << where;
  EXPECT_EQ(json_of(summary).find("nan"), std::string::npos) << where;
  return all;
}

TEST(Numbers, OfScenesAndSettingsByLotAreSound) {
  const tests::TemporaryFolder folder;
  int kept = 0, renders = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Case by_lot = case_of(seed, folder.path());
    const std::string where = "seed " + std::to_string(seed) + ", scale " + std::to_string(by_lot.scale) +
                              ", policy " + std::string(regulator::name(by_lot.settings.regulator.policy)) +
                              ", warp " + std::string(warp::name(by_lot.settings.curve));
    const Sums sums = run_of_case(by_lot, where);
    kept += sums.kept, renders += sums.renders;
    if (::testing::Test::HasFailure()) break;  // one seed says enough
  }
  EXPECT_GT(kept, 3000);
  EXPECT_GT(renders, 3000);
}

}  // namespace
}  // namespace talisman::sequences
