// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/box_placement.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

using layers::dvec2;
using layers::ivec2;
using layers::RectI;
using Places = std::vector<std::optional<RectI>>;

bool inside(const RectI& box, const RectI& area) {
  return box.x0 >= area.x0 && box.y0 >= area.y0 && box.x1 <= area.x1 && box.y1 <= area.y1;
}

/// How many are placed; each inside, of its size, clear of the obstacles and of all others.
int count_placed(const RectI& area, const std::vector<RectI>& obstacles, const std::vector<BoxWish>& wishes,
                 const Places& places) {
  EXPECT_EQ(places.size(), wishes.size());
  int placed = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i]) continue;
    ++placed;
    EXPECT_TRUE(inside(*places[i], area)) << i;
    EXPECT_EQ(ivec2(places[i]->width(), places[i]->height()), wishes[i].size_px) << i;
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(places[k] && overlap(*places[i], *places[k])) << i << k;
    for (const RectI& obstacle : obstacles) EXPECT_FALSE(overlap(*places[i], obstacle)) << i;
  }
  return placed;
}

double nearest_wish(const BoxWish& wish, double x, double y) {
  double least = HUGE_VAL;
  for (const dvec2& at : wish.at) least = std::min(least, (x - at.x) * (x - at.x) + (y - at.y) * (y - at.y));
  return least;
}

/// The least squared distance of any free place, by trying every pixel of the area.
double least_distance(const RectI& area, const std::vector<RectI>& taken, const BoxWish& wish) {
  double least = HUGE_VAL;
  for (int y = area.y0; y + wish.size_px.y <= area.y1; ++y)
    for (int x = area.x0; x + wish.size_px.x <= area.x1; ++x) {
      const RectI box{x, y, x + wish.size_px.x, y + wish.size_px.y};
      bool free = true;
      for (const RectI& t : taken) free = free && !overlap(box, t);
      if (free) least = std::min(least, nearest_wish(wish, x, y));
    }
  return least;
}

TEST(PlaceBoxes, NoneInTheWayStandsAtItsWish) {
  const Places places = place_boxes({0, 0, 100, 50}, {}, {{{20, 10}, {{30, 5}}}});
  ASSERT_TRUE(places[0]);
  EXPECT_EQ(*places[0], (RectI{30, 5, 50, 15}));
}

// By hand: the first box takes rows 5 … 14, so the second moves down to 15 (ten) rather than up to -5,
// which is outside.
TEST(PlaceBoxes, TheSecondAtOnePlaceStandsBesideTheFirst) {
  const Places places = place_boxes({0, 0, 100, 50}, {}, {{{20, 10}, {{30, 5}}}, {{20, 10}, {{30, 5}}}});
  ASSERT_TRUE(places[1]);
  EXPECT_EQ(*places[1], (RectI{30, 15, 50, 25}));
}

// What pushes moves by one pixel, what is pushed too.
TEST(PlaceBoxes, APushedBoxMovesAsItsNeighbourDoes) {
  for (int y = 0; y < 10; ++y) {
    const Places places =
        place_boxes({0, 0, 100, 100}, {}, {{{20, 10}, {{30, 15.0 + y}}}, {{20, 10}, {{30, 25}}}});
    ASSERT_TRUE(places[1]);
    EXPECT_EQ(places[1]->y0, 25 + y);
  }
}

TEST(PlaceBoxes, OfSeveralWishesTheNearestFreeOneIsTaken) {
  const std::vector<RectI> marker{{30, 0, 60, 50}};
  const Places places = place_boxes({0, 0, 100, 50}, marker, {{{10, 10}, {{40, 20}, {70, 20}, {5, 20}}}});
  ASSERT_TRUE(places[0]);
  EXPECT_EQ(*places[0], (RectI{70, 20, 80, 30}));
}

TEST(PlaceBoxes, FortyAtOnePointAreAllPlacedAndNoneLiesOverAnother) {
  const RectI area{0, 0, 700, 500};
  for (const dvec2 at :
       {dvec2{350, 250}, dvec2{0, 0}, dvec2{700, 500}, dvec2{-1e300, 250}, dvec2{1e9, -1e9}}) {
    const std::vector<BoxWish> wishes(40, {{60, 15}, {at}});
    EXPECT_EQ(count_placed(area, {}, wishes, place_boxes(area, {}, wishes)), 40) << at.x;
  }
}

// Exactly four have room; the others are said to have none.
TEST(PlaceBoxes, MoreThanThereIsRoomFor) {
  const RectI area{10, 10, 30, 30};
  const std::vector<BoxWish> wishes(9, {{10, 10}, {{10, 10}}});
  EXPECT_EQ(count_placed(area, {}, wishes, place_boxes(area, {}, wishes)), 4);
}

TEST(PlaceBoxes, WhatHasNoPlaceHasNone) {
  const double nan = std::nan("");
  const std::vector<BoxWish> wishes = {{{10, 10}, {{nan, 5}}}, {{10, 10}, {{5, HUGE_VAL}}},
                                       {{10, 10}, {}},         {{101, 1}, {{0, 0}}},
                                       {{1, 51}, {{0, 0}}},    {{100, 50}, {{7, 7}}}};
  const RectI area{0, 0, 100, 50};
  const Places places = place_boxes(area, {}, wishes);
  EXPECT_EQ(count_placed(area, {}, wishes, places), 1);
  EXPECT_EQ(places[5], (RectI{0, 0, 100, 50}));  // as large as the area: at the only place there is
  EXPECT_TRUE(place_boxes(area, {}, {}).empty());
  for (const RectI& none : {RectI{}, RectI{5, 5, 2, 2}})
    EXPECT_FALSE(place_boxes(none, {}, {{{1, 1}, {{0, 0}}}})[0]);
  EXPECT_FALSE(place_boxes(area, {area}, {{{1, 1}, {{0, 0}}}})[0]);
}

// A wish that is not a number among others that are.
TEST(PlaceBoxes, WishesThatAreNotFiniteAreLeftOut) {
  const Places places = place_boxes({0, 0, 100, 50}, {}, {{{10, 10}, {{std::nan(""), 0}, {20, 20}}}});
  ASSERT_TRUE(places[0]);
  EXPECT_EQ(*places[0], (RectI{20, 20, 30, 30}));
}

// Against brute force: each box stands at the least distance that any place of whole pixels has.
TEST(PlaceBoxes, NoFreePlaceIsNearer) {
  constexpr unsigned kSeed = 14;
  std::mt19937 random(kSeed);
  const auto any = [&](int first, int last) {
    return std::uniform_int_distribution<int>(first, last)(random);
  };
  const RectI area{-5, 3, 60, 48};
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<RectI> obstacles;
    for (int i = any(0, 8); i > 0; --i) {
      const int x = any(-10, 60), y = any(0, 50);
      obstacles.push_back({x, y, x + any(0, 25), y + any(0, 20)});
    }
    std::vector<BoxWish> wishes;
    for (int i = 0; i < 8; ++i) {
      wishes.push_back({{any(1, 20), any(1, 12)}, {}});
      for (int k = any(1, 3); k > 0; --k)
        wishes.back().at.push_back({double(any(-20, 80)), double(any(-20, 60))});
    }
    const Places places = place_boxes(area, obstacles, wishes);
    count_placed(area, obstacles, wishes, places);
    std::vector<RectI> taken = obstacles;
    for (std::size_t i = 0; i < wishes.size(); ++i) {
      const double least = least_distance(area, taken, wishes[i]);
      ASSERT_EQ(places[i].has_value(), least < HUGE_VAL) << "seed " << kSeed << " trial " << trial;
      if (!places[i]) continue;
      EXPECT_EQ(nearest_wish(wishes[i], places[i]->x0, places[i]->y0), least)
          << "seed " << kSeed << " trial " << trial << " box " << i;
      taken.push_back(*places[i]);
    }
  }
}

TEST(PlaceBoxesDeathTest, SizesAreNotNegative) {
  EXPECT_DEATH(place_boxes({0, 0, 10, 10}, {}, {{{-1, 2}, {{0, 0}}}}), "size_px");
}

}  // namespace
}  // namespace talisman::sequences
