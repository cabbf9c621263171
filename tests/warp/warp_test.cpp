// SPDX-License-Identifier: Apache-2.0
#include "warp/warp.h"

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"

namespace talisman::warp {
namespace {

using tests::gentle_affine;
using tests::gentle_perspective;
using tests::Random;

TEST(Curve, EveryNameIsReadBackAndNoTwoAreAlike) {
  std::set<std::string_view> names;
  for (Curve curve : kAllCurves) {
    EXPECT_EQ(curve_from_name(name(curve)), curve);
    names.insert(name(curve));
  }
  EXPECT_EQ(names.size(), kAllCurves.size());
}

TEST(Curve, UnknownNamesAreRefused) {
  for (std::string_view text : {"", "affine", "AFF", "per3", "aff "})
    EXPECT_FALSE(curve_from_name(text)) << text;
}

TEST(Curve, FamiliesAreThoseOfThePaper) {
  EXPECT_EQ(family_of(Curve::trni), Family::Translation);
  EXPECT_EQ(family_of(Curve::iso), Family::Isotropic);
  EXPECT_EQ(family_of(Curve::soi), Family::XyScale);
  EXPECT_EQ(family_of(Curve::affi), Family::Affine);
  for (Curve curve : {Curve::per, Curve::peri, Curve::per2, Curve::per2i, Curve::pers, Curve::pers2})
    EXPECT_EQ(family_of(curve), Family::Perspective);
}

TEST(Family, UnknownsGrowAlongTheChain) {
  const std::array families{Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine,
                            Family::Perspective};
  const std::array unknowns{2, 3, 4, 6, 8};
  for (std::size_t i = 0; i < families.size(); ++i) EXPECT_EQ(degrees_of_freedom(families[i]), unknowns[i]);
}

TEST(Warp, DefaultIsTheIdentity) {
  const Warp warp;
  EXPECT_TRUE(warp.is_identity());
  EXPECT_EQ(warp(dvec2(3, -4)), dvec2(3, -4));
  EXPECT_EQ(warp.denominator({1e9, 1e9}), 1);
}

// A homography is the same map under any positive scale, an affine matrix is not.
TEST(Warp, ScaledIdentityIsIdentityAndMirroredIsNot) {
  EXPECT_TRUE((Warp{Family::Perspective, dmat3(2.0)}.is_identity()));
  EXPECT_FALSE((Warp{Family::Perspective, dmat3(-1.0)}.is_identity()));
  EXPECT_FALSE(from_affine(Family::XyScale, {2, 0, 0, 0, 1, 0}).is_identity());
}

TEST(Warp, PerspectiveDividesByTheDenominator) {
  const Warp warp{Family::Perspective, {2, 0, 0.5, 0, 3, 0.25, 10, 20, 1}};
  EXPECT_EQ(warp.denominator({2, 4}), 3);
  EXPECT_DOUBLE_EQ(warp(dvec2(2, 4)).x, 14.0 / 3);
  EXPECT_DOUBLE_EQ(warp(dvec2(2, 4)).y, 32.0 / 3);
}

TEST(WarpCompose, EqualsOneAfterTheOther) {
  Random random(1);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Warp a{Family::Perspective, gentle_perspective(seed)},
        b = from_affine(Family::Affine, gentle_affine(seed + 1000));
    const dvec2 p = dvec2{512, 512} + random.in_square(200);
    EXPECT_LT(glm::length(compose(a, b)(p) - a(b(p))), 1e-9) << "seed " << seed;
    EXPECT_LT(glm::length(compose(b, a)(p) - b(a(p))), 1e-9) << "seed " << seed;
    EXPECT_LT(glm::length(compose(b, b)(p) - b(b(p))), 1e-9) << "seed " << seed;
  }
}

TEST(WarpCompose, TakesTheMoreGeneralFamily) {
  const Warp scale = from_affine(Family::XyScale, {2, 0, 1, 0, 3, 1}),
             shift = from_affine(Family::Translation, {1, 0, 5, 0, 1, 6});
  EXPECT_EQ(compose(scale, shift).family, Family::XyScale);
  EXPECT_EQ(compose(shift, scale).family, Family::XyScale);
  EXPECT_EQ(compose(Warp{Family::Perspective}, shift).family, Family::Perspective);
}

TEST(WarpInverse, UndoesTheWarp) {
  Random random(2);
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    for (const Warp& warp : {Warp{Family::Perspective, gentle_perspective(seed)},
                             from_affine(Family::Affine, gentle_affine(seed))}) {
      const auto back = inverse(warp);
      ASSERT_TRUE(back) << "seed " << seed;
      EXPECT_EQ(back->family, warp.family);
      const dvec2 p = dvec2{512, 512} + random.in_square(200);
      EXPECT_LT(glm::length((*back)(warp(p)) - p), 1e-9) << "seed " << seed;
    }
}

TEST(WarpInverse, SingularOrNotFiniteHasNone) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(inverse(from_affine(Family::Affine, {1, 2, 0, 2, 4, 0})));
  EXPECT_FALSE(inverse(from_affine(Family::Affine, {nan, 0, 0, 0, 1, 0})));
  EXPECT_FALSE(inverse(from_affine(Family::Translation, {1, 0, inf, 0, 1, 0})));
  EXPECT_FALSE(inverse(Warp{Family::Perspective, dmat3(0.0)}));
  EXPECT_FALSE(inverse(Warp{Family::Perspective, {1, 2, 3, 2, 4, 6, 0, 0, 1}}));
  EXPECT_FALSE(inverse(Warp{Family::Perspective, dmat3(nan)}));
}

// The determinant of these underflows to zero although the maps are harmless.
TEST(WarpInverse, TinyHomographiesAreNotTakenForSingular) {
  const Warp tiny{Family::Perspective, gentle_perspective(3) * 1e-150};
  const auto back = inverse(tiny);
  ASSERT_TRUE(back);
  EXPECT_LT(glm::length((*back)(tiny(dvec2(500, 400))) - dvec2(500, 400)), 1e-9);
}

TEST(WarpDeathTest, AffinePartOfAPerspectiveWarpIsAProgrammersMistake) {
  EXPECT_DEATH((void)Warp{Family::Perspective}.affine(), "is_affine");
}

}  // namespace
}  // namespace talisman::warp
