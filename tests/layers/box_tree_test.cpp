// SPDX-License-Identifier: Apache-2.0
#include "layers/box_tree.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/layers/boxes_by_lot.h"

namespace talisman::layers {
namespace {

std::vector<int> query(BoxIndex& index, std::span<const Plane> region) {
  std::vector<int> found;
  QueryCounters counters;
  index.query(region, found, counters);
  std::sort(found.begin(), found.end());
  return found;
}

/// All that must be found is, each once, and little else is.
void expect_right(BoxIndex& index, std::span<const Plane> region, std::span<const Box3> boxes) {
  const std::vector<int> found = query(index, region);
  const std::set<int> must = met_slowly(region, boxes), got(found.begin(), found.end());
  EXPECT_EQ(got.size(), found.size());
  EXPECT_TRUE(std::includes(got.begin(), got.end(), must.begin(), must.end()));
  EXPECT_LE(got.size(), must.size() + 3 + must.size() / 100);
  for (const int entry : found) EXPECT_FALSE(boxes[entry].empty());
}

TEST(BoxTree, FindsWhatASlowTestFindsForEverySmallCount) {
  std::mt19937 lot(1);
  for (int count = 0; count < 40; ++count) {
    const auto boxes = boxes_by_lot(count, 1, false, static_cast<unsigned>(count));
    BoxTree tree;
    tree.build(boxes);
    for (int k = 0; k < 10; ++k) expect_right(tree, view_region(camera_by_lot(lot, 1), {80, 60}, 0), boxes);
  }
}

TEST(BoxTree, FindsWhatASlowTestFindsAtEveryScale) {
  std::mt19937 lot(2);
  for (const double size : {1e-4, 1.0, 1e6})
    for (const bool clustered : {false, true}) {
      const auto boxes = boxes_by_lot(3000, size, clustered, 5);
      BoxTree tree, forgetful(false);
      tree.build(boxes);
      forgetful.build(boxes);
      for (int k = 0; k < 20; ++k) {
        const Region view = view_region(camera_by_lot(lot, size), {80, 60}, 0.25);
        expect_right(tree, view, boxes);
        EXPECT_EQ(query(tree, view), query(forgetful, view));  // what is remembered changes no answer
      }
    }
}

TEST(BoxTree, CoincidentBoxesAreFoundTogether) {
  const std::vector<Box3> boxes(1000, box_of({-1, -1, -6}, {1, 1, -5}));
  BoxTree tree;
  tree.build(boxes);
  EXPECT_EQ(query(tree, view_region({dmat4(1), 1, 0.1, 10}, {64, 64}, 0)).size(), 1000u);
  dmat4 turned(1);
  turned[0][0] = turned[2][2] = -1;  // looks the other way
  EXPECT_EQ(query(tree, view_region({turned, 1, 0.1, 10}, {64, 64}, 0)).size(), 0u);
}

TEST(BoxTree, WhatIsEverywhereIsAlwaysFoundAndWhatIsEmptyNever) {
  auto boxes = boxes_by_lot(100, 1, false, 3);
  boxes[17] = kEverywhere;
  boxes[40] = {};
  BoxTree tree;
  tree.build(boxes);
  std::mt19937 lot(3);
  for (int k = 0; k < 10; ++k) {
    const auto found = query(tree, view_region(camera_by_lot(lot, 1), {80, 60}, 0));
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), 17));
    EXPECT_FALSE(std::binary_search(found.begin(), found.end(), 40));
  }
}

TEST(BoxTree, NoRegionFindsAll) {
  const auto boxes = boxes_by_lot(57, 1, false, 4);
  BoxTree tree;
  tree.build(boxes);
  EXPECT_EQ(query(tree, {}).size(), 57u);
  BoxTree nothing;
  nothing.build({});
  nothing.update({}, {});
  EXPECT_TRUE(query(nothing, {}).empty());
  EXPECT_TRUE(query(nothing, view_region({}, {1, 1}, 0)).empty());
}

/// Ten thousand updates, of one in ten boxes each time: some rest, some drift away, some vanish and come back,
/// some jump across the world. No answer is ever wrong, and a tree that scatters is built anew.
TEST(BoxTree, UpdatesNeverLoseABox) {
  std::mt19937 lot(6);
  auto boxes = boxes_by_lot(200, 1, true, 6);
  BoxTree tree;
  tree.build(boxes);
  for (int step = 0; step < 10'000; ++step) {
    std::vector<int> moved;
    for (int k = 0; k < 20; ++k) {
      const int entry = static_cast<int>(lot() % boxes.size());
      moved.push_back(entry);  // some twice
      boxes[entry] =
          lot() % 10 == 0 ? Box3{} : boxes_by_lot(1, lot() % 7 == 0 ? 30 : 1, false, lot()).front();
    }
    tree.update(boxes, moved);
    if (step % 100 == 0) expect_right(tree, view_region(camera_by_lot(lot, 1), {80, 60}, 0), boxes);
  }
  EXPECT_GT(tree.times_built(), 1);
  EXPECT_LE(tree.worsening(), BoxTree::kWorse);
}

// What shakes in its place never makes the tree worse.
TEST(BoxTree, IsNotBuiltAnewForBoxesThatShake) {
  const auto rest = boxes_by_lot(500, 1, false, 8);
  auto boxes = rest;
  BoxTree tree;
  tree.build(boxes);
  std::vector<int> all(boxes.size());
  std::iota(all.begin(), all.end(), 0);
  for (int step = 0; step < 200; ++step) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const float by = 0.002f * static_cast<float>((step + i + k) % 3);
        boxes[i].lo[k] = rest[i].lo[k] + by, boxes[i].hi[k] = rest[i].hi[k] + by;
      }
    tree.update(boxes, all);
  }
  EXPECT_EQ(tree.times_built(), 1);
}

// A region within one box visits a path, not the tree.
TEST(BoxTree, VisitsFewNodesForASmallRegion) {
  const auto boxes = boxes_by_lot(20'000, 1, false, 9);
  BoxTree tree;
  tree.build(boxes);
  dmat4 place(1);
  place[3] = dvec4(2, 0, 0, 1);  // outside of all, looking along -z
  std::vector<int> found;
  QueryCounters counters;
  tree.query(view_region({place, 0.5, 0.1, 10}, {64, 64}, 0), found, counters);
  EXPECT_TRUE(found.empty());
  EXPECT_LE(counters.nodes, 10);
}

TEST(BoxTree, TakesWithoutTestsWhatIsWhollyInside) {
  const auto boxes = boxes_by_lot(20'000, 1, false, 9);
  BoxTree tree;
  tree.build(boxes);
  dmat4 place(1);
  place[3] = dvec4(0, 0, 10, 1);
  std::vector<int> found;
  QueryCounters counters;
  tree.query(view_region({place, 1, 0.1, 100}, {64, 64}, 0), found, counters);
  EXPECT_EQ(found.size(), 20'000u);
  EXPECT_EQ(counters.whole, 20'000);
  EXPECT_EQ(counters.nodes, 1);
}

}  // namespace
}  // namespace talisman::layers
