// SPDX-License-Identifier: Apache-2.0
#include "layers/place_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace talisman::tests {
namespace {

using layers::dvec4;
using layers::MaterialPoint;
using layers::PlaceSet;

/// Each compared with all before it.
class ObviousSet {
 public:
  bool add(const MaterialPoint& place) {
    const auto is_same = [&](const MaterialPoint& p) { return layers::is_same_place(p, place); };
    if (std::any_of(places_.begin(), places_.end(), is_same)) return false;
    places_.push_back(place);
    return true;
  }

 private:
  std::vector<MaterialPoint> places_;
};

MaterialPoint at(const dvec4& p) { return {{p, 0.5 * p}, -1}; }

/// Places of all sizes, most of them near one that is there: the same but for rounding, just the same, just another.
std::vector<MaterialPoint> places(int count, double largest_power, std::mt19937& random) {
  std::uniform_real_distribution<> power(-largest_power, largest_power), side(-1, 1);
  std::vector<MaterialPoint> all;
  for (int i = 0; i < count; ++i) {
    if (i % 3 == 0 || all.empty()) {
      const double size = std::pow(10, power(random));
      all.push_back(at(size * dvec4(side(random), side(random), side(random), side(random))));
      continue;
    }
    const dvec4 p = all[random() % all.size()].clip[0];
    constexpr double kAway[] = {0, 1e-16, 0.9e-10, 1.1e-10, 3e-10, 1e-6};
    all.push_back(at(p * (1 + kAway[random() % 6] * side(random))));
  }
  return all;
}

TEST(PlaceSet, HoldsWhatComparingAllWithAllHolds) {
  std::mt19937 random(3);
  for (const double largest_power : {0.0, 3.0, 12.0, 150.0})
    for (const int count : {3, 63, 64, 65, 200, 3000}) {
      PlaceSet set(8);
      ObviousSet obvious;
      for (const MaterialPoint& place : places(count, largest_power, random))
        ASSERT_EQ(set.add(place), obvious.add(place)) << largest_power << " " << count;
    }
}

TEST(PlaceSet, HoldsWhatIsNoNumberAsOftenAsItComes) {
  PlaceSet set(0);
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(set.add(at(dvec4(0.0))), i == 0);
    EXPECT_TRUE(set.add(at({nan, 0, 0, 1})));
    EXPECT_TRUE(set.add(at({-huge, 0, 0, 1})));
    EXPECT_TRUE(set.add(at({i + 1.0, 0, 0, 1})));
    EXPECT_FALSE(set.add(at({i + 1.0, 0, 0, 1})));
  }
  EXPECT_EQ(set.places().size(), 601u);
}

TEST(PlaceSet, KeepsTheFirstOfTwoAndTheOrder) {
  PlaceSet set(0);
  for (int i = 0; i < 100; ++i) set.add({{dvec4(i, 0, 0, 1), dvec4(i, 0, 0, 1)}, i});
  set.add({{dvec4(7 * (1 + 1e-12), 0, 0, 1), dvec4(7, 0, 0, 1)}, -1});
  ASSERT_EQ(set.places().size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(set.places()[i].point, i);
}

}  // namespace
}  // namespace talisman::tests
