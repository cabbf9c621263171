// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/visibility.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using Points = std::vector<dvec3>;

Points box(const dvec3& c, const dvec3& h) {
  Points p;
  for (int k = 0; k < 8; ++k)
    p.push_back(c + h * dvec3{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1});
  return p;
}

std::vector<int> order(const dvec3& eye, const std::vector<Points>& bodies) {
  std::vector<Occluder> layers;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    layers.push_back({static_cast<int>(i), OrderGroup::Normal, {bodies[i]}});
  return VisibilitySorter().sort(eye, layers).order;
}

TEST(VisibilitySorter, RowIsOrderedFromEitherEnd) {
  const std::vector<Points> row = {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -3}, {1, 1, 1}), box({0, 0, -6}, {1, 1, 1})};
  EXPECT_THAT(order({0, 0, 9}, row), ElementsAre(2, 1, 0));
  EXPECT_THAT(order({0, 0, -19}, row), ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace talisman::layers
