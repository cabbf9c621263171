// SPDX-License-Identifier: Apache-2.0
#include "fiducials/photometric.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fiducials/lit_places.h"
#include "fiducials/turned_faces.h"
#include "tests/layers/worlds.h"
#include "warp/color.h"

namespace talisman::fiducials {
namespace {

using layers::dmat4;
using layers::LayerState;
using layers::Light;
using layers::LightState;
using layers::vec3;
using tests::lamp;
using tests::moved_by;
using tests::sun;
using tests::turned_by;
using tests::uniform;
using tests::uniform3;

constexpr double kPi = std::numbers::pi;
const dmat4 kAhead = moved_by({0, 0, -10});

LightState ambient(float grey) { return tests::ambient(vec3(grey)); }

/// A grey box of 2 m in a world of lights; 10 m ahead of the eye where `kAhead` moves it.
struct LitBox : tests::World {
  explicit LitBox(std::vector<LightState> its_lights, layers::BoundKind kind = layers::BoundKind::Box8,
                  const dvec3& half_size = {1, 1, 1})
      : World(tests::box_corners(half_size), kind) {
    lights = std::move(its_lights);
    bound.surface.emplace();
    bound.surface->base = {0.5, 0.5, 0.5};
    bound.follows_faces = true;
  }
  LitBox& specular(double strength, double shininess) {
    bound.surface->specular = dvec3(strength);
    bound.surface->shininess = shininess;
    return *this;
  }
  LayerState under(std::vector<LightState> its_lights, const dmat4& place = kAhead) {
    lights = std::move(its_lights);
    return at(place);
  }
  Photometric compare(const LayerState& then, const LayerState& now, bool color_warp = true) const {
    return photometric_of(then, now, bound, {.color_warp = color_warp});
  }
};

/// The same from the definitions: every seen point, multipliers by brute force.
double error_by_definition(const LitBox& box, const LayerState& then, const LayerState& now) {
  std::vector<dvec3> before, after;
  for (std::size_t i = 0; i < now.world_points.size(); ++i) {
    const auto seen = [i](const LayerState& s) {
      return dot(s.world_normals[i], s.eye() - s.world_points[i]) > 0;
    };
    if (!seen(then) && !seen(now)) continue;
    const auto color = [&](const LayerState& s) {
      return shaded_color(*box.bound.surface, s.lights, {s.world_points[i], s.world_normals[i], s.eye()});
    };
    before.push_back(color(then));
    after.push_back(color(now));
  }
  // Which places the light draws is the subject of lit_places_test and light_places_test.
  for (const LitPair& pair : lit_pairs(then, now, box.bound)) {
    before.push_back(shaded_color(*box.bound.surface, then.lights, pair.then));
    after.push_back(shaded_color(*box.bound.surface, now.lights, pair.now));
  }
  dvec3 best(0.0);
  for (int c = 0; c < 3; ++c) {
    double least = HUGE_VAL;
    for (int k = 0; k <= 20000; ++k) {
      const double m = k / 20000.0;
      double sum = 0;
      for (std::size_t i = 0; i < before.size(); ++i) sum += std::pow(m * before[i][c] - after[i][c], 2);
      if (sum < least) least = sum, best[c] = m;
    }
  }
  double worst = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    worst = std::max(worst, glm::length(best * before[i] - after[i]));
  return worst;
}

TEST(PhotometricOf, IdenticalStatesAreExactlyAtTheirBest) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const auto kind = static_cast<layers::BoundKind>(trial % 3);
    LitBox box({ambient(0.2f), sun(uniform3(random, -1, 1)), lamp(uniform3(random, -12, 12))}, kind);
    if (trial % 2) box.specular(0.5, 30);
    const LayerState state = box.at(kAhead * tests::random_rotation(random));
    const Photometric p = box.compare(state, state);
    EXPECT_TRUE(p.computed);
    EXPECT_EQ(p.color, 0);
    EXPECT_EQ(p.multiplier, dvec3(1, 1, 1));
    EXPECT_EQ(p.point, -1);
    EXPECT_EQ(p.color_light.index, LightRef::kNone);
    EXPECT_EQ(p.light_angle_rad, 0);
    EXPECT_EQ(p.light_distance, 0);
    EXPECT_EQ(turned_faces_of(state, state, box.bound.hull).count, 0);
  }
}

TEST(PhotometricOf, EqualsItsDefinition) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 24; ++trial) {
    LitBox box({ambient(0.1f), sun(uniform3(random, -1, 1)), lamp(uniform3(random, -12, 12))},
               static_cast<layers::BoundKind>(trial % 3));
    if (trial % 2) box.specular(0.3, 10);
    const LayerState then = box.at(kAhead * tests::random_rotation(random));
    const LayerState now = box.at(kAhead * tests::random_rotation(random));
    EXPECT_NEAR(box.compare(then, now).color, error_by_definition(box, then, now), 2e-4) << "trial " << trial;
  }
}

// What colour warps are for: a lamp that dims changes all points in proportion.
TEST(PhotometricOf, DimmingIsFollowedByTheColourWarpWithoutError) {
  LitBox box({});
  const LayerState then = box.under({sun({0.3, -1, -0.5})});
  for (const float level : {0.9f, 0.5f, 0.01f}) {
    const LayerState now = box.under({sun({0.3, -1, -0.5}, {level, level * level, 1})});
    const Photometric p = box.compare(then, now);
    EXPECT_NEAR(p.multiplier.x, level, 1e-7);
    EXPECT_NEAR(p.multiplier.y, level * level, 1e-7);
    EXPECT_EQ(p.multiplier.z, 1);
    EXPECT_LT(p.color, 1e-7);
    EXPECT_EQ(p.light_angle_rad, 0) << "the light source form knows nothing of colours";
  }
}

// The compositor can only darken: the multiplier stays at 1 and the error is all that is missing.
TEST(PhotometricOf, BrighteningIsNotFollowedAndShows) {
  LitBox box({});
  const LayerState then = box.under({sun({0, 0, -1}, {0.5f, 0.5f, 0.5f})});
  const LayerState now = box.under({sun({0, 0, -1})});
  const Photometric p = box.compare(then, now);
  EXPECT_EQ(p.multiplier, dvec3(1, 1, 1));
  // Box corners face the eye and the light at cos = 1/√3; grey 0.5; half the light is missing.
  EXPECT_NEAR(p.color, std::sqrt(3.0) * 0.5 * 0.5 / std::sqrt(3.0), 1e-6);
  EXPECT_EQ(p.color_light.index, 0);
}

TEST(PhotometricOf, WithoutColourWarpTheWholeChangeIsTheError) {
  LitBox box({});
  const LayerState then = box.under({sun({0, 0, -1})}), now = box.under({sun({0, 0, -1}, {0.5f, 1, 1})});
  const Photometric p = box.compare(then, now, false);
  EXPECT_EQ(p.multiplier, dvec3(1, 1, 1));
  EXPECT_NEAR(p.color, 0.5 * 0.5 / std::sqrt(3.0), 1e-6);
  EXPECT_LT(box.compare(then, now, true).color, 1e-7);
}

// Black then, or black in itself: no multiplier can be told, and it stays the identity.
TEST(PhotometricOf, BlackLayersKeepTheirColour) {
  LitBox box({});
  const LayerState dark = box.under({}), lit = box.under({sun({0, 0, -1})});
  EXPECT_EQ(box.compare(dark, dark).color, 0);
  const Photometric switched_on = box.compare(dark, lit);
  EXPECT_EQ(switched_on.multiplier, dvec3(1, 1, 1));
  EXPECT_NEAR(switched_on.color, 0.5, 1e-6);
  const Photometric switched_off = box.compare(lit, dark);
  EXPECT_EQ(switched_off.multiplier, dvec3(0, 0, 0));
  EXPECT_EQ(switched_off.color, 0);
  box.bound.surface->base = {0, 0, 0};
  const Photometric black = box.compare(box.under({sun({0, 0, -1})}), box.under({sun({1, 0, -1})}));
  EXPECT_EQ(black.multiplier, dvec3(1, 1, 1));
  EXPECT_EQ(black.color, 0);
}

TEST(PhotometricOf, ALayerThatTurnsUnderAFixedLightIsSeenByBothForms) {
  LitBox box({ambient(0.1f), sun({1, 0, 0})});
  const LayerState then = box.at(kAhead);
  double before = 0;
  for (const double angle : {0.01, 0.1, 0.3, 0.6}) {
    const Photometric p = box.compare(then, box.at(kAhead * turned_by(angle, {0, 1, 0})));
    EXPECT_NEAR(p.light_angle_rad, angle, 1e-12);
    EXPECT_EQ(p.angle_light.index, 1);
    EXPECT_GT(p.color, before);
    before = p.color;
  }
}

// Only relative motion counts: layer, light and eye turned as one show the same picture.
TEST(PhotometricOf, MotionInCommonIsNoChange) {
  const dmat4 together = moved_by({3, -2, 5}) * turned_by(1.1, {1, 2, 3});
  LitBox box({});
  box.specular(0.4, 20);
  const LayerState then = box.under({sun({1, -1, -1}), lamp({4, 3, -6})});
  box.lights = {sun(dvec3(together * layers::dvec4(glm::normalize(dvec3(1, -1, -1)), 0))),
                lamp(dvec3(together * layers::dvec4(4, 3, -6, 1)))};
  const LayerState now = box.at(together * kAhead, tests::camera_at(together));
  const Photometric p = box.compare(then, now);
  EXPECT_LT(p.color, 1e-6);
  EXPECT_LT(p.light_angle_rad, 1e-12);
  EXPECT_LT(p.light_distance, 1e-12);
}

TEST(PhotometricOf, HighlightsCountTheEyeAsALight) {
  LitBox box({sun({0, 0, -1})});
  const dmat4 seen_from_the_side = moved_by({0, 0, -10}) * turned_by(0.2, {0, 1, 0}) * moved_by({0, 0, 10});
  const LayerState then = box.at(kAhead), now = box.at(kAhead, tests::camera_at(seen_from_the_side));
  EXPECT_EQ(box.compare(then, now).light_angle_rad, 0);
  box.specular(0.4, 20);
  const Photometric p = box.compare(then, now);
  EXPECT_NEAR(p.light_angle_rad, 0.2, 1e-12);
  EXPECT_EQ(p.angle_light.index, LightRef::kEye);
}

// Lamps far away: angle and distance are told apart.
TEST(PhotometricOf, FarLampsHaveAnAngleAndADistance) {
  LitBox box({});
  const LayerState then = box.under({lamp({100, 0, -10})});
  const Photometric nearer = box.compare(then, box.under({lamp({80, 0, -10})}));
  EXPECT_EQ(nearer.light_angle_rad, 0);
  EXPECT_NEAR(nearer.light_distance, 0.2, 1e-12);
  const Photometric around = box.compare(then, box.under({lamp({0, 100, -10})}));
  EXPECT_NEAR(around.light_angle_rad, kPi / 2, 1e-12);
  EXPECT_NEAR(around.light_distance, 0, 1e-12);
}

// The angle about the middle jumps to π there; what the surface sees does not.
TEST(PhotometricOf, ALampThatPassesThroughTheLayerGrowsSteadily) {
  LitBox box({});
  const double radius = std::sqrt(3.0);
  const LayerState then = box.under({lamp({-0.3, 0, -10})});
  double before = 0;
  for (const double x : {-0.2, -0.1, 0.0, 0.1, 0.2, 0.3}) {
    const Photometric p = box.compare(then, box.under({lamp({x, 0, -10})}));
    EXPECT_NEAR(p.light_angle_rad, (x + 0.3) / radius, 1e-12) << x;
    EXPECT_GT(p.light_angle_rad, before);
    EXPECT_TRUE(std::isfinite(p.color));
    before = p.light_angle_rad;
  }
}

TEST(PositionChange, IsContinuousWhereCloseBecomesFar) {
  for (const double angle : {0.001, 0.1, 0.5}) {
    const auto at = [angle](double distance) {
      return position_change_rad({distance, 0, 0},
                                 {distance * std::cos(angle), distance * std::sin(angle), 0}, 1);
    };
    EXPECT_NEAR(at(kCloseRadii * 0.9999), at(kCloseRadii * 1.0001), angle * angle * angle / 20) << angle;
  }
}

TEST(PositionChange, HardInputIsNeverMoreThanHalfATurnNorNaN) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_EQ(position_change_rad({0, 0, 0}, {0, 0, 0}, 0), 0);
  EXPECT_EQ(position_change_rad({0, 0, 0}, {1, 0, 0}, 0), kPi);
  for (const double bad : {inf, -inf, nan, 1e300, 1e-300})
    for (const double radius : {0.0, 1.0, 1e300}) {
      const double change = position_change_rad({bad, 0, 1}, {0, 1, 0}, radius);
      EXPECT_TRUE(change >= 0 && change <= kPi) << bad << " " << radius;
    }
  EXPECT_EQ(position_change_rad({nan, 0, 0}, {1, 0, 0}, 1), kPi);
  EXPECT_EQ(angle_between_rad({0, 0, 0}, {1, 0, 0}), kPi);
  EXPECT_NEAR(angle_between_rad({1e-160, 0, 0}, {1, 1, 0}), kPi / 4, 1e-12);
}

TEST(PhotometricOf, BrokenLightsAreFinite) {
  const double inf = std::numeric_limits<double>::infinity();
  LitBox box({});
  const LayerState good = box.under({lamp({5, 5, 5}), ambient(0.1f)});
  for (const double bad : {inf, std::nan("")}) {
    const LayerState broken = box.under({lamp({bad, 5, 5}), ambient(0.1f)});
    for (const auto& [then, now] : {std::pair{&good, &broken}, {&broken, &good}, {&broken, &broken}}) {
      const Photometric p = box.compare(*then, *now);
      EXPECT_TRUE(std::isfinite(p.color) && std::isfinite(p.light_distance));
      EXPECT_EQ(p.light_angle_rad, then == now ? 0 : kPi) << "a light that is there only once";
    }
  }
}

TEST(PhotometricOf, LightsThatComeAndGoAreTheWorstChangeOfAngle) {
  LitBox box({});
  const LayerState one = box.under({sun({0, 0, -1})}), two = box.under({sun({0, 0, -1}), lamp({9, 0, 0})});
  EXPECT_EQ(box.compare(one, two).light_angle_rad, kPi);
  EXPECT_EQ(box.compare(two, one).angle_light.index, 1);
}

// A flat layer's points carry the normals of its two sides; when it stands edge-on neither side is seen, and
// what counts must not depend on the rounding.
TEST(PhotometricOf, AFlatLayerEdgeOnIsFiniteAndAtRestExact) {
  LitBox plate({ambient(0.1f), sun({0, 0, -1})}, layers::BoundKind::Box8, {1, 1, 0});
  const LayerState front = plate.at(kAhead), edge = plate.at(kAhead * turned_by(kPi / 2, {0, 1, 0}));
  for (const dvec3& n : front.world_normals) EXPECT_EQ(std::fabs(n.z), 1);
  EXPECT_EQ(plate.compare(edge, edge).color, 0);
  const Photometric p = plate.compare(front, edge);
  EXPECT_TRUE(std::isfinite(p.color));
  EXPECT_NEAR(p.light_angle_rad, kPi / 2, 1e-12);
  // A plate that stays in front under a sinking light is one colour: followed without error.
  const Photometric sinking = plate.compare(plate.under({sun({0, 0, -1})}), plate.under({sun({1, 0, -1})}));
  EXPECT_NEAR(sinking.multiplier.x, std::sqrt(0.5), 1e-7);
  EXPECT_LT(sinking.color, 1e-7);
}

TEST(PhotometricOf, InsideItsPolyhedronAllPointsCount) {
  LitBox room({sun({0, 0, -1})});
  const LayerState then = room.at(dmat4(1.0)), now = room.at(turned_by(0.5, {0, 1, 0}));
  EXPECT_GT(room.compare(then, now).color, 0.05);
}

TEST(PhotometricOf, MirroredLayersHaveTheirNormalsOutside) {
  LitBox box({sun({0, 0, -1})});
  const LayerState state = box.at(kAhead * glm::scale(dmat4(1.0), dvec3(-1, 1, 1)));
  for (std::size_t i = 0; i < state.world_points.size(); ++i)
    EXPECT_GT(dot(state.world_normals[i], state.world_points[i] - dvec3(0, 0, -10)), 0);
}

TEST(PhotometricOf, IsNotComputedWithoutASurfaceAndSaysWhy) {
  LitBox box({sun({0, 0, -1})});
  box.bound.surface.reset();
  box.bound.surface_why_not = "no part of the layer is lit";
  const LayerState state = box.at(kAhead);
  EXPECT_TRUE(state.world_normals.empty() && state.point_colors.empty());
  const Photometric p = box.compare(state, state);
  EXPECT_FALSE(p.computed);
  EXPECT_EQ(p.why_not, "no part of the layer is lit");
}

TEST(PhotometricOf, StatesWithoutPointsAreNotComputed) {
  LitBox box({sun({0, 0, -1})});
  dmat4 broken(1.0);
  broken[3].x = std::nan("");
  const LayerState state = box.at(kAhead), none = box.at(broken);
  for (const auto& [then, now] : {std::pair{&state, &none}, {&none, &state}, {&none, &none}}) {
    EXPECT_FALSE(box.compare(*then, *now).computed);
    EXPECT_FALSE(turned_faces_of(*then, *now, box.bound.hull).computed);
  }
}

TEST(PhotometricOf, LengthsHaveNoUnit) {
  for (const double unit : {1e-4, 1e6}) {
    const auto figures = [](double u) {
      LitBox box({}, layers::BoundKind::Box8, dvec3(u));
      const LayerState then = box.under({lamp(u * dvec3(3, 2, -6))}, moved_by(u * dvec3(0, 0, -10)));
      const LayerState now = box.under({lamp(u * dvec3(-3, 2, -6))}, moved_by(u * dvec3(0, 0, -10)));
      return box.compare(then, now);
    };
    EXPECT_NEAR(figures(unit).color, figures(1).color, 1e-6);
    EXPECT_NEAR(figures(unit).light_angle_rad, figures(1).light_angle_rad, 1e-9);
  }
}

/// A floor of 12 m below the eye under a narrow spot that hangs 4 m above it.
struct SpottedFloor : LitBox {
  SpottedFloor() : LitBox({}, layers::BoundKind::Box8, {6, 0, 6}) {}
  LayerState spot_at(double x) {
    LightState spot = lamp({x, 1, -10}, {0.8f, 0.8f, 0.8f});
    spot.kind = Light::Kind::Spot;
    spot.inner_cone_rad = 0.17, spot.outer_cone_rad = 0.24;
    return under({ambient(0.1f), spot}, moved_by({0, -3, -10}));
  }
};

TEST(Photometric, SpotThatCrossesAFloorIsSeenWhereItWasAndWhereItIs) {
  SpottedFloor floor;
  const LayerState then = floor.spot_at(0);
  const Photometric still = floor.compare(then, floor.spot_at(0));
  EXPECT_EQ(still.color, 0);
  // The corners see nothing of it. Where it was all of its light is gone: 0.5 · 0.8 in three channels.
  const Photometric gone = floor.compare(then, floor.spot_at(3));
  EXPECT_NEAR(gone.color, 0.4 * std::sqrt(3.0), 0.08);  // the multiplier gives a little more
  EXPECT_EQ(gone.color_light.index, 1);
  EXPECT_GE(gone.point, 8) << "no characteristic point";
  // By 5 cm of a soft edge of 30 cm: its slope is at most 1.5 / 0.3 m.
  const Photometric little = floor.compare(then, floor.spot_at(0.05));
  EXPECT_GT(little.color, 0.4 * std::sqrt(3.0) * 0.05 / 0.3);
  EXPECT_LT(little.color, 0.4 * std::sqrt(3.0) * 0.05 * 1.5 / 0.25);
}

TEST(Photometric, SpotBesideTheDisplayDoesNotCount) {
  SpottedFloor floor;
  floor.bound.hull = layers::bounding_polyhedron(tests::box_corners({60, 0, 6}), layers::BoundKind::Box8);
  EXPECT_EQ(floor.compare(floor.spot_at(40), floor.spot_at(43)).color, 0);
}

}  // namespace
}  // namespace talisman::fiducials
