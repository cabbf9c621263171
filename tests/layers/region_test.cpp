// SPDX-License-Identifier: Apache-2.0
#include "layers/region.h"

#include <gtest/gtest.h>

#include "layers/clip.h"
#include "tests/layers/boxes_by_lot.h"

namespace talisman::layers {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Looks along -z from the origin, 90° high and wide, near 1.
CameraState square_camera() { return {dmat4(1), std::asin(1.0), 1, 100}; }
Region square_view() { return view_region(square_camera(), {64, 64}, 0); }

Side side(const Region& region, const dvec3& lo, const dvec3& hi) {
  const Box3 box = box_of(lo, hi);
  const RegionTest test(region, reach_of({&box, 1}));
  PlaneMask mask = test.all();
  return test.side_of(box, mask);
}

TEST(Region, BoxesOfASquareViewByHand) {
  const Region view = square_view();
  EXPECT_EQ(side(view, {-1, -1, -6}, {1, 1, -5}), Side::Inside);
  EXPECT_EQ(side(view, {4, 0, -5}, {6, 1, -4.5}), Side::Cut);          // by the right side, x = -z
  EXPECT_EQ(side(view, {5.1, 0, -5}, {6, 1, -4}), Side::Outside);      // to the right of it
  EXPECT_EQ(side(view, {-1, -1, 1}, {1, 1, 2}), Side::Outside);        // behind the eye
  EXPECT_EQ(side(view, {-1, -1, -0.9}, {1, 1, -0.1}), Side::Outside);  // before the near plane
  EXPECT_EQ(side(view, {-9, -9, -9}, {9, 9, 9}), Side::Cut);           // around the eye
  EXPECT_EQ(side(view, {-1, -1, -1e9}, {1, 1, -5e8}), Side::Inside);   // there is no far plane
}

// A box without extent is a point, a rectangle or a line: what touches a plane is not outside of it.
TEST(Region, BoxesWithoutExtentOnThePlanes) {
  const Region view = square_view();
  EXPECT_NE(side(view, {5, 0, -5}, {5, 0, -5}), Side::Outside);
  EXPECT_NE(side(view, {0, 0, -1}, {0, 0, -1}), Side::Outside);
  EXPECT_NE(side(view, {5, 5, -5}, {5, 5, -5}), Side::Outside);
  EXPECT_EQ(side(view, {5.01, 5, -5}, {5.01, 5, -5}), Side::Outside);
  EXPECT_EQ(side(view, {0, 0, -5}, {0, 0, -5}), Side::Inside);
}

TEST(Region, WhatHasNoBoundsIsNeverOutside) {
  for (const Box3& box :
       {kEverywhere, box_of({0, 0, 0}, {kInf, 0, 0}), box_of({0, std::nan(""), 0}, {1, 1, 1}),
        box_of(std::vector<dvec3>{{0, 0, 0}, {std::nan(""), 0, 0}}), transformed(dmat4(1), kEverywhere),
        transformed(dmat4(kInf), box_of({0, 0, 0}, {1, 1, 1}))}) {
    EXPECT_EQ(box, kEverywhere);
    EXPECT_FALSE(RegionTest(square_view(), 1).misses(box));
  }
}

TEST(Region, NothingIsOutsideEvenOfARegionWithoutPlanes) {
  EXPECT_TRUE(RegionTest(square_view(), 1).misses(Box3{}));
  EXPECT_TRUE(RegionTest({}, 1).misses(Box3{}));
  EXPECT_FALSE(RegionTest({}, 1).misses(box_of({0, 0, 0}, {1, 1, 1})));
}

// A plane that has no direction, or is not finite, says nothing; it must not hide what the others leave.
TEST(Region, PlanesThatAreNoneCutNothing) {
  const Box3 box = box_of({0, 0, 0}, {1, 1, 1});
  for (const Plane& plane : {Plane{{0, 0, 0}, -1}, Plane{{std::nan(""), 0, 0}, 0}, Plane{{1, 0, 0}, kInf},
                             Plane{{1, 0, 0}, -kInf}, Plane{{kInf, 0, 0}, 0}})
    EXPECT_FALSE(RegionTest({&plane, 1}, 1).misses(box)) << plane.normal.x << " " << plane.offset;
}

// Normals of any length are one plane: products of 1e-200 and 1e200 would leave the range of a float.
TEST(Region, LengthOfANormalDoesNotMatter) {
  for (const double length : {1e-200, 1e-20, 1.0, 1e20, 1e200}) {
    const Plane plane{{length, 0, 0}, -2 * length};
    const RegionTest test({&plane, 1}, 10);
    EXPECT_TRUE(test.misses(box_of({0, 0, 0}, {1.9, 1, 1}))) << length;
    EXPECT_FALSE(test.misses(box_of({0, 0, 0}, {2, 1, 1}))) << length;
  }
}

TEST(Region, MaskLosesThePlanesThatABoxIsInsideOf) {
  const Region view = square_view();
  const RegionTest test(view, 10);
  PlaneMask mask = test.all();
  EXPECT_EQ(test.side_of(box_of({4, 0, -5}, {6, 1, -4.5}), mask), Side::Cut);
  EXPECT_EQ(std::popcount(mask), 1);  // the right side alone
  EXPECT_EQ(test.side_of(box_of({4, 0, -5}, {4.1, 1, -4.9}), mask), Side::Inside);
  EXPECT_EQ(mask, 0u);
}

/// Random boxes and cameras at many scales, far from the origin too: what the test throws out is outside by
/// arithmetic of twice the precision, and almost all that is outside is thrown out.
TEST(Region, NeverThrowsOutWhatIsInsideAtAnyScale) {
  std::mt19937 lot(19);
  int outside = 0, thrown_out = 0;
  for (const double size : {1e-4, 1.0, 1e6})
    for (const double away : {0.0, 1.0, 1e3})
      for (int k = 0; k < 20; ++k) {
        const dvec3 centre(away * size);
        const auto boxes = boxes_by_lot(200, size, false, static_cast<unsigned>(k), centre);
        const Region view = view_region(camera_by_lot(lot, size, centre), {160, 120}, 0.1 * (k % 3));
        const RegionTest test(view, reach_of(boxes));
        for (const Box3& box : boxes) {
          const bool is_out = is_outside(view, box);
          EXPECT_FALSE(test.misses(box) && !is_out) << size << " " << away;
          outside += is_out && away < 1e3;
          thrown_out += test.misses(box) && away < 1e3;
        }
      }
  EXPECT_GT(thrown_out, 0.999 * outside);
}

// The clipper's outcode and the region speak of the same view: what all corners' outcodes throw out by one
// half-space, and nothing else, is outside (up to the slack, at places not on a plane).
TEST(Region, AgreesWithTheClipperOnPoints) {
  std::mt19937 lot(7);
  for (int k = 0; k < 50; ++k) {
    const CameraState camera = camera_by_lot(lot, 1);
    const double margin = 0.25 * (k % 2);
    const Region view = view_region(camera, {160, 120}, margin);
    const ViewHalfSpaces half_spaces = view_half_spaces(camera.near_m, margin, 0);
    const dmat4 clip = clip_from_world(camera, {160, 120});
    for (const Box3& box : boxes_by_lot(50, 1, false, static_cast<unsigned>(k))) {
      const Box3 point{box.lo, box.lo};
      const dvec3 p(point.lo[0], point.lo[1], point.lo[2]);
      double nearest = HUGE_VAL;
      for (const Plane& plane : view)
        nearest = std::min(nearest, std::fabs(plane.height(p)) / glm::length(plane.normal));
      if (nearest < 1e-5) continue;
      EXPECT_EQ(RegionTest(view, 2).misses(point), outcode(half_spaces, clip * dvec4(p, 1)) != 0);
    }
  }
}

TEST(Box3, TransformedHoldsEveryCornerAndIsTight) {
  std::mt19937 lot(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100; ++k) {
    dmat4 m(1);
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) m[c][r] = unit(lot) * (c == 3 ? 100 : 1);
    const Box3 box = boxes_by_lot(1, 3, false, static_cast<unsigned>(k)).front(), image = transformed(m, box);
    Box3 corners;
    for (int corner = 0; corner < 8; ++corner) {
      dvec4 p(0, 0, 0, 1);
      for (int axis = 0; axis < 3; ++axis) p[axis] = corner >> axis & 1 ? box.hi[axis] : box.lo[axis];
      const dvec3 q(m * p);
      corners = joined(corners, box_of(q, q));
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(image.lo[axis], corners.lo[axis]);
      EXPECT_GE(image.hi[axis], corners.hi[axis]);
      EXPECT_NEAR(image.lo[axis], corners.lo[axis], 1e-4);
      EXPECT_NEAR(image.hi[axis], corners.hi[axis], 1e-4);
    }
  }
}

TEST(Box3, RoundsOutwards) {
  const double third = 1.0 / 3;
  const Box3 box = box_of(dvec3(third), dvec3(third));
  EXPECT_LT(box.lo[0], third);
  EXPECT_GT(box.hi[0], third);
  EXPECT_EQ(box_of(dvec3(0.5), dvec3(0.5)), (Box3{{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}}));
}

}  // namespace
}  // namespace talisman::layers
