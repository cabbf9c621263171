// SPDX-License-Identifier: Apache-2.0
// The same scene in other layers, what a frame is planned to cost, and what [D95] is judged by.
#include "sequences/experiments/amortised/measured.h"

#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/amortise.h"
#include "sequences/commands/options.h"
#include "sequences/experiments/amortised/groupings.h"
#include "sequences/experiments/reproduction/durbin/amortised_95.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

const std::string kThree =
    "frames: 12\n"
    "display: [80, 60]\n"
    "shapes:\n"
    "  - {id: floor, box: [8, 0.1, 8], position: [0, -2, 0]}\n"
    "  - {id: left, box: [1, 1, 1], position: [-1.5, 0, 0], spin: {axis: [0, 1, 0], deg_per_s: 90}}\n"
    "  - {id: right, box: [1, 1, 1], position: [1.5, 0, 0], spin: {axis: [0, 1, 0], deg_per_s: 90}}\n"
    "camera: {fov_deg: 50, near_m: 1, far_m: 100, position: [0, 1, 9], look_at: [0, 0, 0]}\n"
    "regulator: {policy: threshold, geometric_px: 0.5}\n"
    "layers:\n"
    "  - {name: ground, parts: [floor], group: background}\n"
    "  - {name: both, parts: [left, right], preferences: {resolution_scale: 0.5}}\n";

Sequence three(const std::string& more = "") {
  const TemporaryFolder folder;
  return load_sequence(folder.write("three.yaml", kThree + more));
}

std::optional<Sequence> parts_of(const Sequence& s) {
  return one_layer_per_part(s, resolve({}, s, true).settings);
}

TEST(Groupings, APartitionIsCountedByItsBellNumber) {
  EXPECT_EQ(partitions(0).size(), 1u);
  EXPECT_THAT(partitions(3), ElementsAre(std::vector{0, 0, 0}, std::vector{0, 0, 1}, std::vector{0, 1, 0},
                                         std::vector{0, 1, 1}, std::vector{0, 1, 2}));
  EXPECT_EQ(partitions(5).size(), 52u);
  const std::vector<std::vector<int>> eight = partitions(8);
  EXPECT_EQ(eight.size(), 4140u);
  EXPECT_EQ(std::set(eight.begin(), eight.end()).size(), 4140u);
}

TEST(Groupings, EachPartHasALayerWithTheWishesOfItsAuthor) {
  const std::optional<Sequence> parts = parts_of(three());
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->layers.layers.size(), 3u);
  EXPECT_EQ(parts->layers.defect, "");
  EXPECT_EQ(parts->layers.layers[0].name, "floor");
  EXPECT_EQ(parts->layers.layers[0].group, layers::OrderGroup::Background);
  for (const int id : {1, 2}) {
    EXPECT_EQ(parts->layers.layers[id].group, layers::OrderGroup::Normal);
    EXPECT_EQ(parts->layers.layers[id].preferences.resolution_scale, 0.5);
    EXPECT_EQ(parts->layers.layers[id].parts.size(), 1u);
  }
}

TEST(Groupings, TheAuthorsOrderHoldsBetweenTheirParts) {
  const Sequence s = three("order: [{behind: ground, front: both}]\n");
  ASSERT_EQ(s.explicit_order.size(), 1u);
  const std::optional<Sequence> parts = parts_of(s);
  ASSERT_TRUE(parts);
  EXPECT_THAT(parts->explicit_order, ElementsAre(layers::ExplicitPair{0, 1}, layers::ExplicitPair{0, 2}));
}

TEST(Groupings, OneForEachGroupKeepsWhatTheAuthorTellsApart) {
  const std::optional<Sequence> parts = parts_of(three());
  ASSERT_TRUE(parts);
  const Sequence grouped = one_layer_per_group(*parts);
  ASSERT_EQ(grouped.layers.layers.size(), 2u);
  EXPECT_EQ(grouped.layers.defect, "");
  EXPECT_EQ(grouped.layers.layers[1].parts.size(), 2u);
}

Sequence three_with(const std::string& left, const std::string& right) {
  std::string yaml = kThree;
  const auto replace = [&yaml](const std::string& what, const std::string& by) {
    yaml.replace(yaml.find(what), what.size(), by);
  };
  replace("id: left", "id: '" + left + "'");
  replace("id: right", "id: '" + right + "'");
  replace("[left, right]", "['" + left + "', '" + right + "']");
  const TemporaryFolder folder;
  return load_sequence(folder.write("three.yaml", yaml));
}

TEST(Groupings, APartWhoseNameWouldMatchAnotherIsNamedAlone) {
  const std::optional<Sequence> parts = parts_of(three_with("r*t", "right"));
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->layers.layers.size(), 3u);
  for (const layers::Layer& layer : parts->layers.layers) EXPECT_EQ(layer.parts.size(), 1u) << layer.name;
}

/// 1,500,000 triangles and 40,000,000 texels a second; direct fills the display once.
TEST(AmortisedExperiment, APlannedFrameCostsWhatItsDecisionsSay) {
  const Sequence s = three();
  Settings settings = resolve({}, s, true).settings;
  tests::Playback run(s, settings);
  const FrameReport first = run.next();
  double polygons = 0, pixels = 0;
  for (const regulator::LayerDecision& d : first.plan.decisions) {
    polygons += double(d.cost.polygons);
    pixels += double(d.cost.pixels);
  }
  ASSERT_GT(pixels, 0);
  const PlannedCost cost = planned_cost(first, regulator::Policy::Threshold);
  EXPECT_NEAR(cost.render_ms, 1e3 * std::max(polygons / 1.5e6, pixels / 40e6), 1e-12);
  EXPECT_GT(cost.composite_ms, 0);
  EXPECT_LE(cost.composite_ms, 1e3 * 2 * 80 * 60 / 320e6);  // two sprites, none larger than the display
  const PlannedCost direct = planned_cost(first, regulator::Policy::Direct);
  EXPECT_NEAR(direct.render_ms, 1e3 * std::max(double(first.reference.polygons) / 1.5e6, 80 * 60 / 40e6),
              1e-12);
  EXPECT_EQ(direct.composite_ms, 0);
}

TEST(AmortisedExperiment, NoFixedGroupingIsPlannedCheaperThanTheFloor) {
  const Sequence s = three();
  const Settings settings = resolve({}, s, true).settings;
  const AmortisedExperiment experiment = measure_amortised(s, settings, {0, 11, 4}, ProgressKind::None);
  EXPECT_EQ(experiment.groupings_tried, 2);  // floor alone; left and right apart, or together
  double floor = -1;
  for (const AmortisedResult& r : experiment.results)
    if (r.grouping == "best") floor = r.planned_ms();
  ASSERT_GE(floor, 0);
  int fixed = 0;
  for (const AmortisedResult& r : experiment.results) {
    if (r.name != "one per part" && r.name != "one per group") continue;
    EXPECT_GE(r.planned_ms(), floor) << r.name;
    ++fixed;
  }
  EXPECT_EQ(fixed, 2);
  EXPECT_THAT(plain_text(page_of(experiment)), HasSubstr("best of all groupings: of 2 that were planned"));
}

// --- [D95] ---

TEST(Durbin95, TheTestHasToSayYesFromTheFirstFrameAboveTheBreakEven) {
  EXPECT_TRUE(break_even_finding(10, 9.88).same);
  EXPECT_FALSE(break_even_finding(9, 9.88).same);
  EXPECT_FALSE(break_even_finding(11, 9.88).same);
  EXPECT_FALSE(break_even_finding(0, 9.88).same);
}

TEST(Durbin95, TheParkHasToGainAndMustNotBeSlowerThanASpriteForEachPart) {
  EXPECT_TRUE(park_finding(83.3, 40, 34.5).same);
  EXPECT_FALSE(park_finding(83.3, 40, 35).same);    // 2.38
  EXPECT_FALSE(park_finding(83.3, 30, 34.5).same);  // one per part is faster
  EXPECT_FALSE(park_finding(83.3, 30, 0).same);
}

}  // namespace
}  // namespace talisman::sequences
