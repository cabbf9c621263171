// SPDX-License-Identifier: Apache-2.0

/// The structures that `accuracy --culling` compares answer alike: with what a slow test finds.

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "layers/box_tree.h"
#include "sequences/experiments/culling/flat_scan.h"
#include "sequences/experiments/culling/octree.h"
#include "tests/layers/boxes_by_lot.h"

namespace talisman::sequences {
namespace {

std::unique_ptr<layers::BoxIndex> index_of(const std::string& name) {
  if (name == "octree") return std::make_unique<Octree>(1);
  if (name == "loose") return std::make_unique<Octree>(2);
  if (name == "flat") return std::make_unique<FlatScan>();
  return std::make_unique<layers::BoxTree>();
}

class BoxIndices : public testing::TestWithParam<const char*> {
 protected:
  /// Every box that must be found is, once; few others are.
  static void expect_right(layers::BoxIndex& index, std::span<const layers::Box3> boxes, std::mt19937& lot,
                           double size) {
    const layers::Region view = view_region(layers::camera_by_lot(lot, size), {80, 60}, 0);
    std::vector<int> found;
    layers::QueryCounters counters;
    index.query(view, found, counters);
    const std::set<int> must = layers::met_slowly(view, boxes), got(found.begin(), found.end());
    EXPECT_EQ(got.size(), found.size());
    EXPECT_TRUE(std::includes(got.begin(), got.end(), must.begin(), must.end()));
    EXPECT_LE(got.size(), must.size() + 3 + must.size() / 50);
  }
};

TEST_P(BoxIndices, FindWhatASlowTestFindsAtEveryScale) {
  std::mt19937 lot(1);
  for (const double size : {1e-4, 1.0, 1e6})
    for (const int count : {0, 1, 3, 4, 5, 1000}) {
      const auto boxes = layers::boxes_by_lot(count, size, count == 1000, 2);
      const auto index = index_of(GetParam());
      index->build(boxes);
      for (int k = 0; k < 10; ++k) expect_right(*index, boxes, lot, size);
    }
}

// Boxes that vanish, come back, leave the world that the structure was built for, and have no bounds.
TEST_P(BoxIndices, FindWhatASlowTestFindsWhileBoxesMove) {
  std::mt19937 lot(2);
  auto boxes = layers::boxes_by_lot(300, 1, true, 3);
  const auto index = index_of(GetParam());
  index->build(boxes);
  for (int step = 0; step < 300; ++step) {
    std::vector<int> moved;
    for (int k = 0; k < 30; ++k) {
      const int entry = static_cast<int>(lot() % boxes.size());
      moved.push_back(entry);
      const unsigned what = lot() % 20;
      boxes[entry] = what == 0   ? layers::Box3{}
                     : what == 1 ? layers::kEverywhere
                                 : layers::boxes_by_lot(1, what < 4 ? 50 : 1, false, lot()).front();
    }
    index->update(boxes, moved);
    if (step % 10 == 0) expect_right(*index, boxes, lot, 1);
  }
}

TEST_P(BoxIndices, CoincidentBoxesAreFoundTogether) {
  const std::vector<layers::Box3> boxes(500, layers::box_of({-1, -1, -6}, {1, 1, -5}));
  const auto index = index_of(GetParam());
  index->build(boxes);
  std::vector<int> found;
  layers::QueryCounters counters;
  index->query(layers::view_region({layers::dmat4(1), 1, 0.1, 10}, {64, 64}, 0), found, counters);
  EXPECT_EQ(found.size(), 500u);
}

INSTANTIATE_TEST_SUITE_P(All, BoxIndices, testing::Values("tree", "octree", "loose", "flat"));

}  // namespace
}  // namespace talisman::sequences
