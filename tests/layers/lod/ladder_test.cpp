// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/ladder.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "layers/geometry2.h"

namespace talisman::tests {
namespace {

using layers::dvec2;
using layers::dvec3;
using layers::Ladder;
using layers::LadderLevel;
using layers::level_error_px;

Ladder ladder_with(std::vector<std::int64_t> triangles, std::vector<double> errors_m) {
  Ladder ladder;
  for (std::size_t k = 0; k < triangles.size(); ++k)
    ladder.levels.push_back({-1, triangles[k], 3, 100, errors_m[k]});
  return ladder;
}

TEST(Ladder, HalvesAtEachLevel) {
  EXPECT_EQ(first_defect(ladder_with({1000, 500, 250}, {0, 0.1, 0.2})), "");
  EXPECT_EQ(first_defect(ladder_with({1000}, {0})), "");
  EXPECT_EQ(first_defect(ladder_with({1000, 501}, {0, 0.1})),
            "level 1 has 501 triangles, must be at most half of the 1000 of the level above");
  EXPECT_NE(first_defect(ladder_with({1000, 2000}, {0, 0.1})), "") << "larger than its base";
  EXPECT_NE(first_defect(ladder_with({1000, 250, 500}, {0, 0.1, 0.2})), "") << "out of order";
}

TEST(Ladder, EmptyLevelsAndErrorsThatAreNoneAreDefects) {
  EXPECT_EQ(first_defect(ladder_with({10, 0}, {0, 1})), "level 1 is empty, must have at least one triangle");
  EXPECT_NE(first_defect(ladder_with({10, 5}, {0, std::numeric_limits<double>::quiet_NaN()})), "");
  EXPECT_NE(first_defect(ladder_with({10, 5}, {0, HUGE_VAL})), "");
  EXPECT_NE(first_defect(ladder_with({10, 5}, {0, -1})), "");
  EXPECT_NE(first_defect(ladder_with({12, 6, 3}, {0, 0.2, 0.1})), "");
}

TEST(LevelError, OnTheAxisIsTheErrorOnThePlaneOfTheNearestPoint) {
  EXPECT_DOUBLE_EQ(level_error_px(0.1, 10.1, 1000, 0), 10);
  EXPECT_EQ(level_error_px(0, 0, 1000, 3), 0) << "level 0 has none, wherever it is";
}

TEST(LevelError, ReachesTheEyeWhereTheLevelMay) {
  EXPECT_EQ(level_error_px(1, 1, 1000, 0), layers::kMostLevelError_px);
  EXPECT_EQ(level_error_px(1, -5, 1000, 0), layers::kMostLevelError_px);
  EXPECT_EQ(level_error_px(1, std::numeric_limits<double>::quiet_NaN(), 1000, 0), layers::kMostLevelError_px);
  EXPECT_EQ(level_error_px(1, 1 + 1e-15, 1000, 0), layers::kMostLevelError_px);
}

/// Points anywhere, moved anyhow: none goes farther on the display than the bound, and some go nearly as far.
TEST(LevelError, BoundsEveryDisplacementAndIsNotFarAboveTheWorst) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  double worst = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    const double z = 1 + 20 * uniform(random), e = 0.9 * z * uniform(random) * uniform(random);
    const dvec2 t{3 * (uniform(random) - 0.5), 3 * (uniform(random) - 0.5)};
    dvec3 d{normal(random), normal(random), normal(random)};
    d *= e / glm::length(d);
    const dvec2 moved{(t.x * z + d.x) / (z + d.z), (t.y * z + d.y) / (z + d.z)};
    const double bound = level_error_px(e, z, 700, glm::length(t));
    EXPECT_LE(700 * glm::length(moved - t), bound * (1 + 1e-9));
    worst = std::max(worst, 700 * glm::length(moved - t) / bound);
  }
  EXPECT_GT(worst, 0.95);
}

}  // namespace
}  // namespace talisman::tests
