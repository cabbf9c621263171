// SPDX-License-Identifier: Apache-2.0
#include "layers/sprite_transform.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "layers/outline.h"
#include "tests/layers/worlds.h"

namespace talisman::tests {
namespace {

using layers::ExtentOptions;
using layers::LayerState;
using layers::PlacementOptions;
using layers::SpritePlacement;

constexpr double kNanExtent = std::numeric_limits<double>::quiet_NaN();
/// Pixels per metre at a distance of 10 m on the default display.
const double kPixelsPerMetre = 512 / std::tan(0.45) / 10;

/// A box (half sizes in pixels) that faces the camera, its centre at `at_px` of the display.
struct Card {
  Card(dvec2 half_size_px, dvec2 at_px, double turn_rad = 0)
      : world(box_corners(dvec3(half_size_px / kPixelsPerMetre, 0))), at_px(at_px), turn_rad(turn_rad) {}

  LayerState moved(dvec2 by_px) const {
    const dvec2 centre = (at_px + by_px - dvec2(512)) / kPixelsPerMetre;
    return world.at(moved_by({centre.x, -centre.y, -10}) * turned_by(-turn_rad, {0, 0, 1}));
  }
  SpritePlacement place(dvec2 velocity_px = {0, 0}, const ExtentOptions& extents = {},
                        const PlacementOptions& options = {}) const {
    return place_sprite(moved({0, 0}), moved(velocity_px), world.bound.hull, extents, options);
  }

  World world;
  dvec2 at_px;
  double turn_rad;
};

bool is_finite(const layers::Affine2& m) { return std::isfinite(m.a + m.b + m.c + m.d + m.tx + m.ty); }

/// All given display points are inside of the sprite, at least `padding` texels from its sides.
void expect_covers(const SpritePlacement& placement, std::span<const dvec2> screen_points, double padding) {
  const auto sprite_from_screen = inverse(placement.screen_from_sprite);
  ASSERT_TRUE(sprite_from_screen);
  for (const dvec2 p : screen_points) {
    const dvec2 q = (*sprite_from_screen)(p);
    EXPECT_GE(std::min(q.x, q.y), padding - 1e-5);
    EXPECT_LE(q.x, placement.size_px.x - padding + 1e-5);
    EXPECT_LE(q.y, placement.size_px.y - padding + 1e-5);
  }
}

/// The centre of texel (0, 0) of both placements differs by a whole number of texels, and so do all others.
void expect_same_lattice(const SpritePlacement& a, const SpritePlacement& b) {
  EXPECT_NEAR(a.screen_from_sprite.a, b.screen_from_sprite.a, 0);
  EXPECT_NEAR(a.screen_from_sprite.b, b.screen_from_sprite.b, 0);
  const dvec2 shift = (*inverse(a.screen_from_sprite))(b.screen_from_sprite({0.5, 0.5})) - dvec2(0.5);
  EXPECT_NEAR(shift.x, std::round(shift.x), 1e-9);
  EXPECT_NEAR(shift.y, std::round(shift.y), 1e-9);
}

TEST(PlaceSprite, AtDisplayDensityTheLatticeIsThatOfThePixels) {
  const Card card({40.3, 25.6}, {300.2, 411.7});
  const SpritePlacement placement = card.place();
  // x 259.9 … 340.5 and y 386.1 … 437.3, whole texels, one of padding on each side.
  EXPECT_EQ(placement.screen_from_sprite, (layers::Affine2{1, 0, 258, 0, 1, 385}));
  EXPECT_EQ(placement.size_px, layers::ivec2(342 - 258, 439 - 385));
  EXPECT_FALSE(placement.clipped.any());
  EXPECT_TRUE(placement.axis_aligned);
  EXPECT_FALSE(placement.resolution_reduced);
}

TEST(PlaceSprite, AFullScreenAtRestIsExactlyTheDisplay) {
  // No padding where everything beyond is off the display: 32 × 32 chunks stay 32 × 32.
  const Card card({2000, 2000}, {512, 512});
  const SpritePlacement placement = card.place();
  EXPECT_EQ(placement.screen_from_sprite, layers::Affine2{});
  EXPECT_EQ(placement.size_px, layers::ivec2(1024, 1024));
  EXPECT_EQ(placement.clipped, (layers::ClippedSides{true, true, true, true}));
}

TEST(PlaceSprite, ALayerAroundTheCameraCoversTheWholeDisplay) {
  const World dome(box_corners({500, 500, 500}));
  for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
    const auto camera = camera_at(turned_by(angle, {1, 2, 0}));
    const LayerState state = dome.at(dmat4(1.0), camera);
    for (const double scale : {1.0, 0.5}) {
      PlacementOptions options;
      options.resolution_scale = scale;
      const SpritePlacement placement = place_sprite(state, state, dome.bound.hull, {}, options);
      expect_covers(placement, std::vector<dvec2>{{0, 0}, {1024, 0}, {0, 1024}, {1024, 1024}}, 0);
      EXPECT_TRUE(placement.clipped.left && placement.clipped.right && placement.clipped.top &&
                  placement.clipped.bottom);
    }
  }
}

TEST(PlaceSprite, NothingInViewIsEmpty) {
  const Card card({10, 10}, {512, 512});
  const LayerState behind = card.world.at(moved_by({0, 0, 10}));
  EXPECT_TRUE(place_sprite(behind, behind, card.world.bound.hull, {}, {}).empty());
  // In the margin of the enlarged view, but not on the display.
  EXPECT_TRUE(Card({10, 10}, {1100, 512}).place().empty());
  // A broken camera.
  layers::CameraState broken;
  broken.world_from_camera[2][1] = kNanExtent;
  const LayerState nowhere = card.world.at(moved_by({0, 0, -10}), broken);
  const SpritePlacement placement = place_sprite(nowhere, nowhere, card.world.bound.hull, {}, {});
  EXPECT_TRUE(placement.empty());
  EXPECT_TRUE(is_finite(placement.screen_from_sprite));
  // Bounds that touch the display's corner while the outline passes it by: a diagonal line past (1024, 0).
  const Card past({0, 60}, {1060, -20}, -std::numbers::pi / 4);
  EXPECT_TRUE(past.moved({0, 0}).touches_display);
  EXPECT_TRUE(past.place().empty());
}

TEST(PlaceSprite, SubPixelLayersHaveATexel) {
  for (const dvec2 half_size : {dvec2(0, 0), dvec2(0.01, 0.01), dvec2(0.4, 0)}) {
    for (const dvec2 at : {dvec2(512, 512), dvec2(100.5, 200.25), dvec2(0, 0), dvec2(1023.99, 3)}) {
      for (const double scale : {1.0, 0.1, 4.0}) {
        PlacementOptions options;
        options.resolution_scale = scale;
        const Card card(half_size, at);
        const SpritePlacement placement = card.place({0, 0}, {}, options);
        if (!card.moved({0, 0}).touches_display) continue;  // rounding may put it on the corner's other side
        EXPECT_GE(std::min(placement.size_px.x, placement.size_px.y), 1);
        EXPECT_LE(std::max(placement.size_px.x, placement.size_px.y), 8);
        EXPECT_TRUE(is_finite(placement.screen_from_sprite));
      }
    }
  }
}

TEST(PlaceSprite, EverySideHasATexelOfPadding) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const double width = uniform(random, 0.1, 200), height = uniform(random, 0.1, 60);
    const double x = uniform(random, 300, 700), y = uniform(random, 300, 700);
    const Card card({width, height}, {x, y}, uniform(random, 0, 3.14));
    PlacementOptions options;
    options.resolution_scale = uniform(random, 0.2, 3);
    options.min_rotation_gain = 0;
    const SpritePlacement placement = card.place({0, 0}, {}, options);
    expect_covers(placement, card.moved({0, 0}).screen_points, 1);
    EXPECT_FALSE(placement.clipped.any());
    EXPECT_GT(placement.screen_from_sprite.determinant(), 0);
  }
}

// ---- motion blur [LS97 3.4]
// -------------------------------------------------------------------------------------

PlacementOptions blurred(dvec2 motion, double density) {
  PlacementOptions options;
  options.motion = motion;
  options.motion_density = density;
  return options;
}

/// Texels per pixel along a direction of the display.
double density_along(const SpritePlacement& placement, dvec2 direction) {
  const auto sprite_from_screen = *inverse(placement.screen_from_sprite);
  return glm::length(sprite_from_screen(direction) - sprite_from_screen(dvec2(0))) / glm::length(direction);
}

TEST(PlaceSpriteForMotionBlur, OneAxisFollowsTheMotionWithFewerSamples) {
  const Card card({120, 80}, {500, 450}, 0.3);
  for (int degrees = 0; degrees < 360; degrees += 15) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * std::numbers::pi / 180;
    const dvec2 way(std::cos(angle), std::sin(angle)), across(-way.y, way.x);
    const SpritePlacement placement = card.place({0, 0}, {}, blurred(7.0 * way, 0.25));
    EXPECT_NEAR(density_along(placement, way), 0.25, 1e-12);
    EXPECT_NEAR(density_along(placement, across), 1, 1e-12);
    EXPECT_GT(placement.screen_from_sprite.determinant(), 0) << "not mirrored";
    EXPECT_GT(placement.screen_from_sprite.a, 0) << "upright to 45 degrees";
    expect_covers(placement, card.moved({0, 0}).screen_points, 1);
  }
}

TEST(PlaceSpriteForMotionBlur, AtRestNothingChanges) {
  const Card card({40.3, 25.6}, {300.2, 411.7});
  const SpritePlacement sharp = card.place();
  EXPECT_EQ(card.place({0, 0}, {}, blurred({0, 0}, 0.25)), sharp);
  EXPECT_EQ(card.place({0, 0}, {}, blurred({5, 3}, 1)), sharp);
  EXPECT_EQ(card.place({0, 0}, {}, blurred({kNanExtent, 3}, 0.5)), sharp);
  EXPECT_EQ(card.place({0, 0}, {}, blurred({HUGE_VAL, 0}, 0.5)), sharp);
  EXPECT_EQ(card.place({0, 0}, {}, blurred({5, 3}, kNanExtent)), sharp);
}

TEST(PlaceSpriteForMotionBlur, ThereAndBackHaveTheSameLattice) {
  const Card card({60, 60}, {512, 512});
  for (const dvec2 motion : {dvec2(3, 1), dvec2(-2, 9), dvec2(0, 4), dvec2(5, 0), dvec2(1, -1)})
    EXPECT_EQ(card.place({0, 0}, {}, blurred(motion, 0.5)),
              card.place({0, 0}, {}, blurred(-2.0 * motion, 0.5)))
        << motion.x << " " << motion.y;
}

TEST(PlaceSpriteForMotionBlur, AlongAnAxisTheSpriteStaysAxisAligned) {
  const Card card({100, 50}, {400, 400});
  const SpritePlacement x = card.place({0, 0}, {}, blurred({-8, 0}, 0.25));
  const SpritePlacement y = card.place({0, 0}, {}, blurred({0, 8}, 0.25));
  EXPECT_TRUE(x.axis_aligned && y.axis_aligned);
  EXPECT_EQ(x.screen_from_sprite.a, 4);
  EXPECT_EQ(x.screen_from_sprite.d, 1);
  EXPECT_EQ(y.screen_from_sprite.a, 1);
  EXPECT_EQ(y.screen_from_sprite.d, 4);
  EXPECT_LT(x.size_px.x, 2 * 100 / 4 + 5);
  EXPECT_LT(y.size_px.y, 2 * 50 / 4 + 5);
}

TEST(PlaceSpriteForMotionBlur, AGrownSpriteHasTheSameSamples) {
  const Card card({700, 500}, {512, 512});
  const PlacementOptions options = blurred({6, 2}, 0.2);
  ExtentOptions none;
  none.expected_reuse_frames = 0;
  expect_same_lattice(card.place({6, 2}, none, options), card.place({6, 2}, {}, options));
}

TEST(PlaceSpriteForMotionBlur, DensityIsBoundFromBelow) {
  const Card card({200, 200}, {512, 512});
  for (const double density : {1e-9, 0.0, -3.0})
    EXPECT_NEAR(density_along(card.place({0, 0}, {}, blurred({1, 0}, density)), {1, 0}), 1.0 / 16, 1e-12);
  // Tiny and huge motions have a direction too.
  for (const double length : {1e-300, 1e300})
    EXPECT_EQ(card.place({0, 0}, {}, blurred({0, length}, 0.5)),
              card.place({0, 0}, {}, blurred({0, 1}, 0.5)));
}

// ---- extents [LS97 3.2]
// -----------------------------------------------------------------------------------------

TEST(PlaceSprite, ExtentsGrowOnlyWhereContentMovesIn) {
  // Wider and higher than the enlarged view, moving 5 px per frame to the right and 2 px down: content comes
  // from the left and the top.
  const Card card({2000, 2000}, {512, 512});
  ExtentOptions extents;
  extents.expected_reuse_frames = 10;
  const SpritePlacement placement = card.place({5, 2}, extents);
  EXPECT_EQ(placement.screen_from_sprite.tx, -50);
  EXPECT_EQ(placement.screen_from_sprite.ty, -20);
  EXPECT_EQ(placement.size_px, layers::ivec2(1024 + 50, 1024 + 20));
  EXPECT_TRUE(placement.clipped.left && placement.clipped.right && placement.clipped.top &&
              placement.clipped.bottom);
  EXPECT_EQ(card.place({-5, 0}, extents).screen_from_sprite.tx, 0);
  EXPECT_EQ(card.place({-5, 0}, extents).size_px.x, 1024 + 50);
}

TEST(PlaceSprite, ALayerThatComesNearerLeavesTheDisplayAndGrowsNothing) {
  // Under a zoom in, the points on each half of the display move out over their own side; receding, they move
  // in.
  const World world(box_corners({20, 20, 0}));
  const LayerState far = world.at(moved_by({0, 0, -10.1})), near = world.at(moved_by({0, 0, -10}));
  const SpritePlacement approaching = place_sprite(far, near, world.bound.hull, {}, {});
  EXPECT_EQ(approaching.size_px, layers::ivec2(1024, 1024));
  const SpritePlacement receding = place_sprite(near, far, world.bound.hull, {}, {});
  EXPECT_GT(receding.size_px.x, 1024 + 60);
  EXPECT_EQ(receding.screen_from_sprite.tx, receding.screen_from_sprite.ty);
}

TEST(PlaceSprite, GrowthIsCapped) {
  const Card card({4000, 4000}, {512, 512});
  ExtentOptions extents;
  extents.expected_reuse_frames = 1000;
  extents.max_growth = 0.1;
  const SpritePlacement placement = card.place({50, 0}, extents);
  EXPECT_EQ(placement.screen_from_sprite.tx, -103);  // 102.4 px in whole texels
  extents.max_growth = 1;  // more than the enlarged view: nothing is known beyond 256 px
  EXPECT_EQ(card.place({50, 0}, extents).screen_from_sprite.tx, -256);
  EXPECT_TRUE(card.place({50, 0}, extents).clipped.left);
}

TEST(PlaceSprite, AGrownSpriteHasTheSameSamples) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const double x = uniform(random, 0, 200), y = uniform(random, 0, 1024);
    const Card card({uniform(random, 200, 500), uniform(random, 5, 60)}, {x, y}, uniform(random, 0, 3.14));
    PlacementOptions options;
    options.resolution_scale = seed % 3 == 0 ? 1 : uniform(random, 0.3, 2);
    ExtentOptions still, moving;
    still.expected_reuse_frames = 0;
    moving.expected_reuse_frames = uniform(random, 1, 40);
    const SpritePlacement a = card.place({3, 1}, still, options), b = card.place({3, 1}, moving, options);
    ASSERT_FALSE(a.empty());
    EXPECT_GE(b.size_px.x, a.size_px.x);
    EXPECT_GE(b.size_px.y, a.size_px.y);
    expect_same_lattice(a, b);
  }
}

TEST(PlaceSprite, SidesAreFlaggedWhereTheLayerGoesOn) {
  const SpritePlacement left = Card({100, 50}, {20, 500}).place();
  EXPECT_EQ(left.clipped, (layers::ClippedSides{true, false, false, false}));
  EXPECT_EQ(left.screen_from_sprite.tx, 0);
  const SpritePlacement corner = Card({100, 50}, {1000, 1000}).place();
  EXPECT_EQ(corner.clipped, (layers::ClippedSides{false, true, false, true}));
  // Less than the padding beyond the side: it is all in the sprite.
  EXPECT_FALSE(Card({100.5, 50}, {100, 500}).place().clipped.any());
  // Enough growth to take in all of the layer.
  ExtentOptions extents;
  extents.expected_reuse_frames = 20;
  EXPECT_FALSE(Card({100, 50}, {20, 500}).place({5, 0}, extents).clipped.any());
}

// ---- direction [LS97 3.3]
// ------------------------------------------------------------------------------------------

TEST(PlaceSprite, AThinDiagonalIsRotated) {
  const Card card({300, 4}, {512, 512}, 0.7);
  const SpritePlacement rotated = card.place();
  EXPECT_FALSE(rotated.axis_aligned);
  PlacementOptions never;
  never.min_rotation_gain = 1;
  const SpritePlacement straight = card.place({0, 0}, {}, never);
  EXPECT_TRUE(straight.axis_aligned);
  EXPECT_LT(rotated.size_px.x * rotated.size_px.y, 0.2 * straight.size_px.x * straight.size_px.y);
  // Rotated, not stretched.
  const auto& m = rotated.screen_from_sprite;
  EXPECT_NEAR(m.determinant(), 1, 1e-12);
  EXPECT_NEAR(m.a * m.b + m.c * m.d, 0, 1e-12);
}

TEST(PlaceSprite, ASmallGainDoesNotRotate) {
  // A square turned by 0.05 rad: the axes cost 1.1 times as much.
  EXPECT_TRUE(Card({50, 50}, {512, 512}, 0.05).place().axis_aligned);
  PlacementOptions eager;
  eager.min_rotation_gain = 0.02;
  eager.slab_directions = 30;
  EXPECT_FALSE(Card({50, 50}, {512, 512}, 0.05).place({0, 0}, {}, eager).axis_aligned);
}

// Directions are not even tried where no rectangle around the outline can be small enough; that must never
// miss one. Boxes from cubes to needles, some of a few pixels, where the padding decides.
TEST(PlaceSprite, ItIsRotatedExactlyWhereASlabDirectionSavesEnough) {
  int rotated = 0, aligned = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const double size = std::exp(uniform(random, -4, 0.7));
    World world(box_corners(size * uniform3(random, 0.02, 1)));
    const LayerState state = world.at(moved_by({0, 0, -8}) * random_rotation(random));
    ASSERT_FALSE(state.clipped);
    PlacementOptions options;
    options.min_rotation_gain = uniform(random, 0, 0.5);
    options.resolution_scale = uniform(random, 0.3, 2);
    const auto padded_area = [&](int k) {
      const double angle = k * (std::numbers::pi / 2) / options.slab_directions;
      layers::RectD r;
      for (const dvec2 p : state.screen_points)
        r.include(
            {std::cos(angle) * p.x + std::sin(angle) * p.y, std::cos(angle) * p.y - std::sin(angle) * p.x});
      return (r.width() * options.resolution_scale + 2) * (r.height() * options.resolution_scale + 2);
    };
    double best = HUGE_VAL;
    for (int k = 1; k < options.slab_directions; ++k) best = std::min(best, padded_area(k));
    const double limit = (1 - options.min_rotation_gain) * padded_area(0);
    if (std::abs(best - limit) < 1e-6 * limit) continue;  // rounding may decide
    const SpritePlacement placement = place_sprite(state, state, world.bound.hull, {}, options);
    EXPECT_EQ(placement.axis_aligned, best > limit);
    ++(placement.axis_aligned ? aligned : rotated);
  }
  EXPECT_GT(rotated, 60);
  EXPECT_GT(aligned, 60);
}

TEST(PlaceSprite, TheAreaIsWithinTheSlabResolutionOfTheBestOfAThousandAngles) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    World world(box_corners(uniform3(random, 0.05, 2.5)), layers::BoundKind::Dop14);
    const LayerState state = world.at(moved_by({0, 0, -12}) * random_rotation(random));
    ASSERT_FALSE(state.clipped);
    PlacementOptions options;
    options.min_rotation_gain = 0;
    options.slab_directions = 2 + static_cast<int>(seed % 29);
    const SpritePlacement placement = place_sprite(state, state, world.bound.hull, {}, options);
    const auto points = state.screen_points;
    const auto sides = [&](double angle) {
      layers::RectD r;
      for (const dvec2 p : points) {
        r.include(
            {std::cos(angle) * p.x + std::sin(angle) * p.y, std::cos(angle) * p.y - std::sin(angle) * p.x});
      }
      return dvec2(r.width(), r.height());
    };
    dvec2 best = sides(0);
    const auto area = [](dvec2 s) { return (s.x + 2) * (s.y + 2); };
    for (int i = 1; i < 1000; ++i) {
      const dvec2 s = sides(i * (std::numbers::pi / 2) / 1000);
      if (area(s) < area(best)) best = s;
    }
    // The nearest slab direction is at most half a step off; each side then gains at most sin(step / 2) of
    // the other one. Rounding to whole texels adds less than 2 to each.
    const double off = std::sin(std::numbers::pi / 4 / options.slab_directions);
    EXPECT_LE(placement.size_px.x * placement.size_px.y,
              (best.x + off * best.y + 4) * (best.y + off * best.x + 4));
    EXPECT_GE((placement.size_px.x) * (placement.size_px.y), 0.999 * area(best) - 1);
  }
}

// ---- resolution [LS97 3.4]
// -------------------------------------------------------------------------------------------

TEST(PlaceSprite, ResolutionIsTexelsPerPixel) {
  PlacementOptions half;
  half.resolution_scale = 0.5;
  const SpritePlacement placement = Card({100, 50}, {512, 512}).place({0, 0}, {}, half);
  EXPECT_EQ(placement.screen_from_sprite, (layers::Affine2{2, 0, 410, 0, 2, 460}));
  EXPECT_EQ(placement.size_px, layers::ivec2(102, 52));
  EXPECT_FALSE(placement.resolution_reduced);
}

TEST(PlaceSprite, ASpriteThatIsTooLargeLosesGrowthThenResolution) {
  const Card card({2000, 200}, {512, 512});
  PlacementOptions options;
  options.max_sprite_px = 1060;
  ExtentOptions extents;
  extents.expected_reuse_frames = 10;
  const SpritePlacement less_growth = card.place({8, 0}, extents, options);
  EXPECT_FALSE(less_growth.resolution_reduced);
  EXPECT_EQ(less_growth.size_px.x, 1060);
  EXPECT_TRUE(less_growth.clipped.left && less_growth.clipped.right);
  expect_covers(less_growth, std::vector<dvec2>{{0, 512}, {1024, 512}}, 0);
  for (const int limit : {1024, 500, 33, 8, 0, -7}) {
    options.max_sprite_px = limit;
    const SpritePlacement reduced = card.place({8, 0}, extents, options);
    EXPECT_TRUE(reduced.resolution_reduced) << limit;
    EXPECT_LE(std::max(reduced.size_px.x, reduced.size_px.y), std::max(limit, 8)) << limit;
    expect_covers(reduced, std::vector<dvec2>{{0, 512}, {1024, 512}}, 0);
  }
}

TEST(PlaceSprite, OptionsThatAreNotNumbersCountAsDefaults) {
  const Card card({100, 50}, {20, 512}, 0.2);
  PlacementOptions options{.slab_directions = -5,
                           .min_rotation_gain = kNanExtent,
                           .resolution_scale = kNanExtent,
                           .max_sprite_px = 4096};
  const ExtentOptions extents{.expected_reuse_frames = kNanExtent, .max_growth = kNanExtent};
  const SpritePlacement placement = card.place({5, 5}, extents, options);
  EXPECT_FALSE(placement.empty());
  EXPECT_TRUE(is_finite(placement.screen_from_sprite));
  options.resolution_scale = 0;
  EXPECT_FALSE(card.place({5, 5}, {HUGE_VAL, HUGE_VAL}, options).empty());
  EXPECT_TRUE(is_finite(card.place({5, 5}, {HUGE_VAL, HUGE_VAL}, options).screen_from_sprite));
}

TEST(PlaceSprite, RandomBoxesAroundTheCameraCoverWhatIsOnTheDisplay) {
  // Anything goes: inside, crossing the near plane, edge-on, rotated, fast. What is on the display is in the
  // sprite.
  int placed = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    World world(box_corners(uniform3(random, seed % 4 == 0 ? 0 : 0.1, 5)), layers::BoundKind::Dop26);
    world.view.display_px = {640, 480};
    const dmat4 place = moved_by(uniform3(random, -6, 6)) * random_rotation(random);
    const LayerState now = world.at(place), soon = world.at(moved_by(uniform3(random, -1, 1)) * place);
    PlacementOptions options;
    options.resolution_scale = uniform(random, 0.2, 2);
    options.min_rotation_gain = uniform(random, 0, 1);
    const SpritePlacement placement = place_sprite(now, soon, world.bound.hull, {}, options);
    ASSERT_TRUE(is_finite(placement.screen_from_sprite));
    const auto outline = layers::convex_hull(now.screen_points);
    const auto shown = layers::clip_to_rect(outline, {{0, 0}, {640, 480}});
    EXPECT_EQ(placement.empty(), shown.empty() || !now.touches_display);
    if (placement.empty()) continue;
    ++placed;
    expect_covers(placement, shown, 0);
  }
  EXPECT_GT(placed, 150);
}

}  // namespace
}  // namespace talisman::tests
