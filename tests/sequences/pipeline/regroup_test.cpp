// SPDX-License-Identifier: Apache-2.0
// Layers that share a sprite because it is cheaper: through the whole pipeline, on scenes small enough to know the answer.
#include "sequences/pipeline/regrouping/regroup.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/profile.h"
#include "sequences/commands/options.h"
#include "sequences/files/image_io.h"
#include "sequences/pictures/quality.h"
#include "sequences/results/summary.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Regroup;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::Playback;
using tests::TemporaryFolder;

/// Two cards that lie before each other and are carried by one hub, so that they always have to be drawn in the same
/// frames, and a third beside them.
const std::string kHead =
    "frames: 240\n"
    "fps: 24\n"
    "display: [320, 240]\n"
    "camera: {fov_deg: 50, near_m: 1, far_m: 100, position: [0, 0, 12], look_at: [0, 0, 0]}\n"
    "regulator: {policy: threshold, geometric_px: 0.5, regroup: amortised}\n";

const std::string kTwins =
    kHead +
    "shapes:\n"
    "  - {id: hub, box: [0.2, 0.2, 0.2], position: [0, 0, 0], spin: {axis: [1, 1, 0], deg_per_s: 200}}\n"
    "  - {id: back, box: [4, 4, 0.2], position: [0, 0, -0.8], carried_by: hub}\n"
    "  - {id: front, box: [4, 4, 0.2], position: [0.3, 0.2, 0.8], carried_by: hub}\n"
    "layers:\n"
    "  - {name: hub, parts: [hub]}\n"
    "  - {name: back, parts: [back]}\n"
    "  - {name: front, parts: [front]}\n";

/// A wall at rest, drawn once, and before it what has to be drawn again in every frame.
const std::string kWallAndTop = kHead +
                                "shapes:\n"
                                "  - {id: wall, box: [9, 7, 0.2], segments: 8, position: [0, 0, -3]}\n"
                                "  - {id: top, box: [1.5, 1.5, 1.5], position: [0, 0, 1], spin: "
                                "{axis: [1, 2, 3], deg_per_s: 400}}\n"
                                "layers:\n"
                                "  - {name: wall, parts: [wall]}\n"
                                "  - {name: top, parts: [top]}\n";

/// A card that turns by 180 degrees a second about y, until `until_s`, and then rests.
std::string turning_card(const std::string& name, double x, double z, double until_s) {
  std::string keys;
  for (int half_seconds = 0; half_seconds <= 20; ++half_seconds) {
    const double t = half_seconds / 2.0, angle = std::min(t, until_s) * std::acos(-1.0);
    keys += std::string(half_seconds > 0 ? ", " : "") + "{t: " + std::to_string(t) + ", position: [" +
            std::to_string(x) + ", 0, " + std::to_string(z) + "], target: [" +
            std::to_string(x + 100 * std::sin(angle)) + ", 0, " + std::to_string(z - 100 * std::cos(angle)) +
            "]}";
  }
  return "  - {id: " + name + ", box: [4, 4, 0.2], flight: [" + keys + "]}\n";
}

/// Two cards, one before the other, that turn for four seconds; then one of them rests.
std::string parting() {
  return kHead + "shapes:\n" + turning_card("left", -0.3, -2.2, 4) + turning_card("right", 0.3, 2.2, 10) +
         "layers:\n"
         "  - {name: left, parts: [left]}\n"
         "  - {name: right, parts: [right]}\n";
}

Sequence sequence_of(const std::string& yaml) {
  const TemporaryFolder folder;
  return load_sequence(folder.write("scene.yaml", yaml));
}

Settings settings_of(const Sequence& s, Regroup by = Regroup::Amortised) {
  Settings settings = resolve({}, s, true).settings;
  settings.regulator.regroup.by = by;
  return settings;
}

/// Because it is cheaper, not for want of an order.
bool shares(const FrameReport& report) {
  return std::any_of(report.order.mergers.begin(), report.order.mergers.end(),
                     [](const Merger& merger) { return merger.why.rfind("cheaper ", 0) == 0; });
}

/// What the renderer does for a frame, as planned, ms.
double render_ms(const FrameReport& report) {
  std::int64_t polygons = 0, pixels = 0;
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    polygons += d.cost.polygons;
    pixels += d.cost.pixels;
  }
  return regulator::modelled_time(regulator::talisman_1996(), polygons, pixels, 0).render_ms;
}

double render_ms(const std::vector<FrameReport>& reports) {
  double sum = 0;
  for (const FrameReport& report : reports) sum += render_ms(report);
  return sum;
}

TEST(Regrouping, LayersThatAreAlwaysDrawnTogetherShareASprite) {
  const Sequence s = sequence_of(kTwins);
  Playback run(s, settings_of(s)), apart(s, settings_of(s, Regroup::None));
  const std::vector<FrameReport> reports = run.all(120), without = apart.all(120);
  const auto first = std::find_if(reports.begin(), reports.end(), shares);
  ASSERT_NE(first, reports.end());
  const Merger& merger = first->order.mergers.front();
  EXPECT_THAT(merger.why, StartsWith("cheaper together: "));
  EXPECT_THAT(merger.why, HasSubstr(" ms once and "));
  EXPECT_THAT(first->plan.decisions[merger.layer].reason, HasSubstr("; merged: cheaper together: "));
  for (const int member : first->layers[merger.layer].members) {
    EXPECT_EQ(first->plan.decisions[member].action, Action::Drop);
    EXPECT_THAT(first->plan.decisions[member].reason, StartsWith("merged into "));
  }
  EXPECT_LT(render_ms(reports), render_ms(without));
}

TEST(Regrouping, WhatRestsIsNotDrawnAgainForWhatMovesBeforeIt) {
  const Sequence s = sequence_of(kWallAndTop);
  Playback run(s, settings_of(s));
  int wall_renders = 0, shared = 0;
  for (const FrameReport& report : run.all(240)) {
    wall_renders += report.plan.decisions[0].action == Action::Rerender;
    shared += shares(report);
  }
  EXPECT_EQ(shared, 0);
  EXPECT_EQ(wall_renders, 1);
}

TEST(Regrouping, WhatPartsIsSplitAndTheNumbersSayWhy) {
  const Sequence s = sequence_of(parting());
  Playback run(s, settings_of(s));
  int merged = 0, splits = 0, last_merged = -1;
  for (const FrameReport& report : run.all(240)) {
    if (shares(report)) last_merged = report.frame;
    merged += shares(report);
    for (const regulator::LayerDecision& d : report.plan.decisions)
      splits += d.reason.rfind("split from left+right (cheaper apart: ", 0) == 0;
  }
  EXPECT_GT(merged, 0);
  EXPECT_GE(splits, 1);  // the other may be out of view, or drawn
  EXPECT_LT(last_merged, 200);
}

/// A frame of a merged layer is as right as one of layers with sprites of their own.
TEST(Regrouping, SharedSpritesShowTheSameScene) {
  const Sequence s = sequence_of(kTwins);
  Settings settings = settings_of(s), without = settings_of(s, Regroup::None);
  settings.regulator.thresholds.geometric_px = without.regulator.thresholds.geometric_px = 0.5;
  Playback run(s, settings, true), apart(s, without, true);
  int compared = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const FrameReport a = run.next(), b = apart.next();
    if (!shares(a) || frame % 5 != 0) continue;
    const Image8 truth = to_image8(draw_direct(run.pipeline, frame, *run.prepared));
    const double psnr = compare(to_image8(a.picture), truth).psnr_db;
    EXPECT_GT(psnr, compare(to_image8(b.picture), truth).psnr_db - 1.5) << frame;
    EXPECT_GT(psnr, 30) << frame;
    ++compared;
  }
  EXPECT_GT(compared, 3);
}

/// Whatever is merged stands side by side in the order: a fresh sorter, asked about every frame, must know no layer that
/// has to lie between two members.
TEST(Regrouping, NothingHasToLieBetweenWhatIsMerged) {
  const Sequence s = sequence_of(
      kHead +
      "shapes:\n"
      "  - {id: hub, box: [0.1, 0.1, 0.1], position: [0, 0, 0], spin: {axis: [0, 1, 0], deg_per_s: 200}}\n"
      "  - {id: a, box: [3, 3, 0.2], position: [0, 0, -2.4], carried_by: hub}\n"
      "  - {id: b, box: [3, 3, 0.2], position: [0, 0, -0.8], carried_by: hub}\n"
      "  - {id: c, box: [3, 3, 0.2], position: [0, 0, 0.8], carried_by: hub}\n"
      "  - {id: d, box: [3, 3, 0.2], position: [0, 0, 2.4], carried_by: hub}\n"
      "  - {id: fly, box: [0.5, 3, 0.1], flight: [{t: 0, position: [-3, 0, 0], target: [100, 0, "
      "0]}, {t: 5, "
      "position: [3, 0, 0], target: [100, 0, 0]}, {t: 10, position: [-3, 0, 0.1], target: [100, 0, 0]}]}\n"
      "layers:\n"
      "  - {name: a, parts: [a]}\n"
      "  - {name: b, parts: [b]}\n"
      "  - {name: c, parts: [c]}\n"
      "  - {name: d, parts: [d]}\n"
      "  - {name: fly, parts: [fly]}\n");
  Playback run(s, settings_of(s)), apart(s, settings_of(s, Regroup::None));
  int shared = 0;
  for (int frame = 0; frame < 240; ++frame) {
    const FrameReport now = run.next(), sorted = apart.next();
    for (const Merger& merger : now.order.mergers) {
      if (merger.why.rfind("cheaper together", 0) != 0) continue;
      const std::vector<int>& members = now.layers[merger.layer].members;
      const std::set<int> inside(members.begin(), members.end());
      std::vector<std::size_t> places;
      for (std::size_t i = 0; i < sorted.order.back_to_front.size(); ++i)
        if (inside.count(sorted.order.back_to_front[i])) places.push_back(i);
      if (places.size() < 2) continue;
      ASSERT_FALSE(places.empty());
      EXPECT_EQ(places.back() - places.front() + 1, places.size()) << "frame " << frame;
      ++shared;
    }
  }
  EXPECT_GT(shared, 0);
}

TEST(Regrouping, PlannedAndDrawnDecideTheSame) {
  const Sequence s = sequence_of(kTwins);
  Playback planned(s, settings_of(s)), drawn(s, settings_of(s), true);
  for (int frame = 0; frame < 40; ++frame) {
    const FrameReport a = planned.next(), b = drawn.next();
    ASSERT_EQ(a.plan.decisions.size(), b.plan.decisions.size());
    for (const regulator::LayerDecision& d : a.plan.decisions)
      ASSERT_EQ(json_of(a, d), json_of(b, b.plan.decisions[d.layer])) << frame;
  }
}

TEST(Regrouping, AFrameDrawnAloneHasTheBytesOfTheWholeRun) {
  const Sequence s = sequence_of(kTwins);
  Playback whole(s, settings_of(s), true), alone(s, settings_of(s));
  FrameReport of_whole;
  for (int frame = 0; frame < 50; ++frame) of_whole = whole.next();
  alone.all(49);
  const FrameReport last = step(alone.pipeline, alone.state, 49, &*whole.prepared);
  ASSERT_TRUE(shares(last));
  EXPECT_EQ(to_image8(last.picture).rgb, to_image8(of_whole.picture).rgb);
}

/// Where the ceiling allows no render, nothing changes.
TEST(Regrouping, ACeilingOfZeroChangesNothing) {
  const Sequence s = sequence_of(kTwins);
  Settings settings = settings_of(s);
  settings.regulator.regroup.ceiling_ms = 0;
  Playback run(s, settings), apart(s, settings_of(s, Regroup::None));
  int too_dear = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const FrameReport a = run.next(), b = apart.next();
    EXPECT_FALSE(shares(a));
    too_dear += run.state.regroup.changes_above_ceiling;
    for (std::size_t d = 0; d < b.plan.decisions.size(); ++d)
      ASSERT_EQ(json_of(a, a.plan.decisions[d]), json_of(b, b.plan.decisions[d]));
  }
  EXPECT_GT(too_dear, 0);
}

/// Layers that their author tells apart keep their own sprites.
TEST(Regrouping, AnAuthorsWishesAreKept) {
  for (const std::string change :
       {"    fade: 0.5\n", "    group: foreground\n", "    preferences: {resolution_scale: 0.5}\n",
        "    preferences: {importance: {geometric: 2}}\n", "    preferences: {warp: trn}\n"}) {
    std::string yaml = kTwins;
    const std::string before = "  - {name: front, parts: [front]}\n";
    yaml.replace(yaml.find(before), before.size(), "  - name: front\n    parts: [front]\n" + change);
    const Sequence s = sequence_of(yaml);
    Playback run(s, settings_of(s));
    for (const FrameReport& report : run.all(60))
      for (const Merger& merger : report.order.mergers)
        EXPECT_EQ(std::count(report.layers[merger.layer].members.begin(),
                             report.layers[merger.layer].members.end(), 2),
                  0)
            << change << report.frame;
  }
}

TEST(Regrouping, MemoryOfALongRunStaysBounded) {
  const Sequence s = sequence_of(parting());
  Playback run(s, settings_of(s));
  run.all(3000);
  EXPECT_LE(run.state.regroup.pairs.size(), 2u);
  EXPECT_LE(run.state.regroup.sets.size(), 1u);
  EXPECT_LE(run.state.regroup.layers.size(), 2u);
  EXPECT_LE(run.state.layers.size(), 3u);
}

TEST(Regrouping, APolicyThatDoesNotRegroupRemembersNothing) {
  const Sequence s = sequence_of(kTwins);
  Settings settings = settings_of(s);
  settings.regulator.policy = regulator::Policy::Reference;
  Playback run(s, settings);
  run.all(5);
  EXPECT_TRUE(run.state.regroup.layers.empty());
  EXPECT_TRUE(run.state.regroup.line.empty());
}

/// [D95]: what lasts nine frames is never merged, what lasts ten always.
class RegroupingBy1995 : public testing::TestWithParam<int> {};

TEST_P(RegroupingBy1995, MergesFromTheTenthFrameOn) {
  const int frames = GetParam();
  const Sequence s = sequence_of(kTwins);
  // The runs themselves are given: what is tested is what is made of them.
  Settings settings = settings_of(s);
  settings.regulator.regroup.prices = regulator::RegroupPrices::Durbin1995;
  settings.regulator.regroup.recency = 1e-9;
  Playback run(s, settings);
  const auto known_to_last = [&](int n) {
    for (auto& [id, layer] : run.state.regroup.layers) layer.run = regulator::RunLength(n);
    for (auto& [ids, pair] : run.state.regroup.pairs) pair.run = regulator::RunLength(n);
    for (auto& [ids, set] : run.state.regroup.sets) set.run = regulator::RunLength(n);
  };
  bool shared = false;
  for (int frame = 0; frame < 40; ++frame) {
    shared |= shares(run.next());
    known_to_last(frames);
  }
  EXPECT_EQ(shared, frames >= 10);
}

INSTANTIATE_TEST_SUITE_P(Runs, RegroupingBy1995, testing::Values(1, 8, 9, 10, 11, 100));

}  // namespace
}  // namespace talisman::sequences
