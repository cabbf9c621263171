// SPDX-License-Identifier: Apache-2.0
#include "layers/light_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "layers/polyhedron.h"
#include "tests/layers/worlds.h"

namespace talisman::tests {
namespace {

using layers::BodySurface;
using layers::Light;
using layers::LightState;
using layers::MeanSurface;
using layers::SurfacePlace;

/// A floor of 20 m at y = 0, as its flat hull.
const layers::Polyhedron& floor_hull() {
  static const layers::Polyhedron hull =
      layers::bounding_polyhedron(box_corners({10, 0, 10}), layers::BoundKind::Box8);
  return hull;
}

std::vector<SurfacePlace> places_of(const LightState& light, const dvec3& eye = {0, 5, 8},
                                    const MeanSurface& surface = {}) {
  std::vector<SurfacePlace> places;
  layers::append_light_places(light, eye, surface, {floor_hull().points, floor_hull().triangles}, places);
  return places;
}

/// How many places of a lamp above the floor are its own, without a highlight.
int foot_and_ring(const dvec3& lamp_at) { return static_cast<int>(places_of(lamp(lamp_at)).size()); }

LightState spot(const dvec3& position, double inner_rad, double outer_rad) {
  LightState light = lamp(position);
  light.kind = Light::Kind::Spot;
  light.direction = {0, -1, 0};
  light.inner_cone_rad = inner_rad, light.outer_cone_rad = outer_rad;
  return light;
}

TEST(LightPlaces, SpotDrawsItsAxisAndTheRingOfHalfLight) {
  const auto places = places_of(spot({1, 4, 2}, 0.2, 0.3));
  ASSERT_EQ(places.size(), 1u + layers::kRing);
  EXPECT_LT(glm::distance(places[0].position, {1, 0, 2}), 1e-9);
  const double half = std::acos((std::cos(0.2) + std::cos(0.3)) / 2);
  for (std::size_t i = 1; i < places.size(); ++i) {
    EXPECT_NEAR(glm::distance(places[i].position, {1, 0, 2}), 4 * std::tan(half), 1e-9);
    EXPECT_LT(glm::distance(places[i].normal, {0, 1, 0}), 1e-12);
  }
}

// KHR_lights_punctual: t² = 1/2 where t is the root of 1/2.
TEST(LightPlaces, SpotOfAForeignFileHasItsHalfLightFartherIn) {
  LightState light = spot({1, 4, 2}, 0.2, 0.3);
  light.attenuation = {0, 0, 1};
  const double half = std::acos(std::cos(0.3) + std::sqrt(0.5) * (std::cos(0.2) - std::cos(0.3)));
  EXPECT_NEAR(glm::distance(places_of(light).at(1).position, {1, 0, 2}), 4 * std::tan(half), 1e-9);
}

TEST(LightPlaces, SpotFromBelowLightsTheUnderside) {
  LightState light = spot({0, -3, 0}, 0.2, 0.3);
  light.direction = {0, 1, 0};
  for (const SurfacePlace& place : places_of(light)) EXPECT_EQ(place.normal, dvec3(0, -1, 0));
}

TEST(LightPlaces, WhatMissesTheBodyHasNone) {
  EXPECT_TRUE(places_of(spot({40, 4, 0}, 0.2, 0.3)).empty());
  EXPECT_TRUE(places_of(ambient({1, 1, 1})).empty());
  EXPECT_TRUE(places_of(sun({0.2, -1, 0})).empty()) << "lights all of a matt floor alike";
  LightState broken = spot({0, 4, 0}, 0.2, 0.3);
  broken.position.x = std::nan("");
  EXPECT_TRUE(places_of(broken).empty());
}

TEST(LightPlaces, PointLightHasItsFootAndARingAtFortyFiveDegrees) {
  const auto places = places_of(lamp({2, 3, -1}));
  ASSERT_EQ(places.size(), 1u + layers::kRing) << "the two sides of a flat floor are one face";
  EXPECT_LT(glm::distance(places[0].position, {2, 0, -1}), 1e-9);
  for (int i = 1; i <= layers::kRing; ++i)
    EXPECT_NEAR(glm::distance(places[static_cast<std::size_t>(i)].position, {2, 0, -1}), 3, 1e-9);
}

// Two faces of a box that look opposite ways follow each other in its list of triangles.
TEST(LightPlaces, EachSideOfABoxHasTheFootOfALampBesideIt) {
  for (const layers::BoundKind kind :
       {layers::BoundKind::Box8, layers::BoundKind::Dop14, layers::BoundKind::Dop26}) {
    const layers::Polyhedron box = layers::bounding_polyhedron(box_corners({1, 1, 1}), kind);
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        dvec3 at(0.1, 0.2, -0.3), foot = at;
        at[axis] = 1.5 * side, foot[axis] = side;
        std::vector<SurfacePlace> places;
        layers::append_light_places(lamp(at), {9, 9, 9}, {}, {box.points, box.triangles}, places);
        EXPECT_TRUE(
            std::any_of(places.begin(), places.end(),
                        [&](const SurfacePlace& p) { return glm::distance(p.position, foot) < 1e-9; }))
            << axis << " " << side;
      }
  }
}

TEST(LightPlaces, EachSideOfABoxHasItsHighlight) {
  MeanSurface shiny;
  shiny.specular = dvec3(1.0), shiny.shininess = 60;
  const layers::Polyhedron box = layers::bounding_polyhedron(box_corners({1, 1, 1}), layers::BoundKind::Box8);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 light_at(0.2), eye(-0.2), place(0.0);
      light_at[axis] = eye[axis] = 3 * side, place[axis] = side;
      std::vector<SurfacePlace> places;
      layers::append_light_places(lamp(light_at), eye, shiny, {box.points, box.triangles}, places);
      EXPECT_TRUE(std::any_of(places.begin(), places.end(),
                              [&](const SurfacePlace& p) { return glm::distance(p.position, place) < 1e-9; }))
          << axis << " " << side;
    }
}

TEST(LightPlaces, HighlightObeysTheLawOfReflection) {
  MeanSurface shiny;
  shiny.specular = dvec3(0.5);
  shiny.shininess = 60;
  const dvec3 eye(0, 4, 6);
  const auto of_sun = places_of(sun({0, -1, 1}), eye, shiny);
  ASSERT_FALSE(of_sun.empty());
  EXPECT_LT(glm::distance(of_sun[0].position, {0, 0, 2}), 1e-9) << "45° up to the eye, 45° up to the sun";
  // Around it the lobe is a half: (N·H)^60 a half where the plane is not seen aslant.
  for (std::size_t i = 1; i < of_sun.size(); ++i) {
    const dvec3 to_eye = glm::normalize(eye - of_sun[i].position), to_sun = glm::normalize(dvec3(0, 1, -1));
    const double lobe = std::pow(glm::normalize(to_eye + to_sun).y, 60);
    EXPECT_GT(lobe, 0.2);
    EXPECT_LT(lobe, 0.9);
  }
  EXPECT_TRUE(places_of(sun({0, 1, 1}), eye, shiny).empty()) << "the sun is below";
}

/// A ring is looked at only where it may meet the face: every place of it that is on the floor must be found.
TEST(LightPlaces, NoPlaceOfAHighlightIsMissed) {
  std::mt19937 random(7);
  const auto within = [&](double lo, double hi) { return std::uniform_real_distribution<>(lo, hi)(random); };
  int outside = 0, partly = 0, inside = 0;
  for (int run = 0; run < 4000; ++run) {
    const double reach = std::pow(10, within(0, 2));
    const dvec3 eye(within(-reach, reach), std::pow(10, within(-2, 2)), within(-reach, reach));
    const dvec3 at(within(-reach, reach), std::pow(10, within(-2, 2)), within(-reach, reach));
    MeanSurface shiny;
    shiny.specular = dvec3(1.0), shiny.shininess = std::pow(10, within(0, 3));
    // The eye's mirror image sees the lamp through this place.
    const double share = eye.y / (eye.y + at.y);
    const dvec3 place(eye.x + share * (at.x - eye.x), 0, eye.z + share * (at.z - eye.z));
    const double tangent = std::tan(std::acos(std::pow(0.5, 1.0 / shiny.shininess)));
    const double step = 2 * tangent / (1 / glm::distance(eye, place) + 1 / glm::distance(at, place));
    const auto is_on_floor = [](const dvec3& p, double slack) {
      return std::max(std::fabs(p.x), std::fabs(p.z)) <= 10 + slack;
    };
    int least = is_on_floor(place, -1e-6), most = is_on_floor(place, 1e-6);
    for (int k = 0; k < layers::kRing; ++k) {
      const double turn = 2 * std::numbers::pi * k / layers::kRing;
      const dvec3 ring = place + step * dvec3(std::cos(turn), 0, std::sin(turn));
      least += is_on_floor(ring, -1e-6), most += is_on_floor(ring, 1e-6);
    }
    const int found = static_cast<int>(places_of(lamp(at), eye, shiny).size()) - foot_and_ring(at);
    EXPECT_GE(found, least) << run;
    EXPECT_LE(found, most) << run;
    outside += most == 0, inside += least == 1 + layers::kRing, partly += least > 0 && most <= layers::kRing;
  }
  EXPECT_GT(std::min({outside, partly, inside}), 200);
}

/// Does a ray meet the box from -1 to 1?  By slabs [Kay & Kajiya 1986].
bool meets_box(const dvec3& from, const dvec3& way) {
  double enters = 0, leaves = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-1 - from[axis]) / way[axis], b = (1 - from[axis]) / way[axis];
    enters = std::max(enters, std::min(a, b)), leaves = std::min(leaves, std::max(a, b));
  }
  return enters < leaves;
}

TEST(LightPlaces, NoRayThatMeetsABodyIsTakenToMissIt) {
  const layers::Polyhedron box = layers::bounding_polyhedron(box_corners({1, 1, 1}), layers::BoundKind::Box8);
  const BodySurface body(box.points, box.triangles);
  std::mt19937 random(15);
  std::uniform_real_distribution<double> unit(-1, 1), power(-2, 7);
  int met = 0, missed = 0;
  for (int run = 0; run < 60'000; ++run) {
    const dvec3 from = std::pow(10.0, power(random)) * dvec3(unit(random), unit(random), unit(random));
    const dvec3 at = 3.0 * dvec3(unit(random), unit(random), unit(random));
    const dvec3 way = glm::normalize(run % 5 == 0 ? from - at : at - from);
    const bool is_met = meets_box(from, way), is_missed = body.is_missed_by(from, way);
    ASSERT_FALSE(is_met && is_missed) << run;
    met += is_met, missed += is_missed;
  }
  EXPECT_GT(met, 10'000);
  EXPECT_GT(missed, 10'000);
}

TEST(LightPlaces, LampInARoomLightsItsWalls) {
  const layers::Polyhedron room =
      layers::bounding_polyhedron(box_corners({3, 2, 3}), layers::BoundKind::Box8);
  std::vector<SurfacePlace> places;
  layers::append_light_places(spot({0, 0, 0}, 0.3, 0.5), {1, 1, 1}, {}, {room.points, room.triangles},
                              places);
  ASSERT_EQ(places.size(), 1u + layers::kRing);
  for (const SurfacePlace& place : places) {
    EXPECT_NEAR(place.position.y, -2, 1e-9);
    EXPECT_GT(place.normal.y, 0.99) << "towards the lamp";
  }
}

}  // namespace
}  // namespace talisman::tests
