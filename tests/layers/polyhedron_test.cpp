// SPDX-License-Identifier: Apache-2.0
#include "layers/polyhedron.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/state.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

using layers::bounding_polyhedron;
using layers::BoundKind;
using layers::Polyhedron;

constexpr BoundKind kKinds[] = {BoundKind::Box8, BoundKind::Dop14, BoundKind::Dop26};

double extent_of(const std::vector<dvec3>& points) {
  const auto bounds = layers::bounds_of(points);
  const dvec3 size = bounds.hi - bounds.lo;
  // Coordinates far from the origin carry their own rounding.
  const dvec3 far = glm::max(glm::abs(bounds.lo), glm::abs(bounds.hi));
  return std::max({size.x, size.y, size.z, 1e-3 * std::max({far.x, far.y, far.z})});
}

double support(const std::vector<dvec3>& points, const dvec3& direction) {
  double result = -HUGE_VAL;
  for (const dvec3& p : points) result = std::max(result, glm::dot(p, direction));
  return result;
}

/// A convex set contains another one if and only if its support is not less in any direction.
void expect_contains(const Polyhedron& hull, const std::vector<dvec3>& points) {
  const double tolerance = 1e-9 * extent_of(points);
  std::mt19937 random(7);
  for (int i = 0; i < 400; ++i) {
    dvec3 d = uniform3(random, -1, 1);
    // Every other direction is a plane normal of some kind, where the polyhedron is tightest.
    if (i % 2 == 0) d = glm::round(d * 1.5);
    if (glm::length(d) == 0) continue;
    d = glm::normalize(d);
    ASSERT_GE(support(hull.points, d), support(points, d) - tolerance)
        << "direction " << d.x << ' ' << d.y << ' ' << d.z;
  }
}

/// Each directed edge once, and its reverse once: a closed surface whose triangles turn the same way.
void expect_closed(const Polyhedron& hull) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : hull.triangles) {
    for (int i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    ASSERT_EQ(count, 1) << edge.first << " - " << edge.second;
    ASSERT_EQ(uses.count({edge.second, edge.first}), 1u) << edge.first << " - " << edge.second;
  }
}

/// No vertex lies outside of a triangle that has an area.
void expect_convex(const Polyhedron& hull) {
  const double extent = extent_of(hull.points);
  for (const auto& [a, b, c] : hull.triangles) {
    const dvec3 origin = hull.points[a];
    const dvec3 normal = glm::cross(hull.points[b] - origin, hull.points[c] - origin);
    if (glm::length(normal) < 1e-4 * extent * extent) continue;
    for (const dvec3& p : hull.points) {
      ASSERT_LE(glm::dot(glm::normalize(normal), p - origin), 1e-8 * extent) << a << ' ' << b << ' ' << c;
    }
  }
}

double volume(const Polyhedron& hull) {
  double six = 0;
  for (const auto& [a, b, c] : hull.triangles) {
    six += glm::dot(hull.points[a] - hull.points[0],
                    glm::cross(hull.points[b] - hull.points[0], hull.points[c] - hull.points[0]));
  }
  return six / 6;
}

void expect_valid(const std::vector<dvec3>& points) {
  for (const BoundKind kind : kKinds) {
    SCOPED_TRACE("kind " + std::to_string(static_cast<int>(kind)));
    const Polyhedron hull = bounding_polyhedron(points, kind);
    const auto box = layers::bounds_of(points), bounds = layers::bounds_of(hull.points);
    // The box planes are exact: cutting never moves them.
    EXPECT_LE(glm::length(box.lo - bounds.lo) + glm::length(box.hi - bounds.hi), 1e-9 * extent_of(points));
    expect_contains(hull, points);
    expect_closed(hull);
    expect_convex(hull);
  }
}

std::vector<dvec3> cloud(unsigned seed, int count, const dvec3& half_size) {
  std::mt19937 random(seed);
  std::vector<dvec3> points;
  for (int i = 0; i < count; ++i) points.push_back(uniform3(random, -1, 1) * half_size);
  return points;
}

std::vector<dvec3> ball() {
  auto points = cloud(3, 3000, dvec3(1.0));
  for (dvec3& p : points) p = glm::normalize(p);
  return points;
}

TEST(BoundingPolyhedron, CountsAreThoseOfTheSolids) {
  const std::size_t points[] = {8, 24, 48}, triangles[] = {12, 44, 92};
  for (int i = 0; i < 3; ++i) {
    const Polyhedron hull = bounding_polyhedron(ball(), kKinds[i]);
    EXPECT_EQ(hull.points.size(), points[i]);
    EXPECT_EQ(hull.triangles.size(), triangles[i]);
  }
}

TEST(BoundingPolyhedron, RandomCloudsAreContained) {
  // Few points make deep cuts that meet; many make a box with shallow ones.
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_valid(cloud(seed, 2 + static_cast<int>(seed % 15), {1, 1, 1}));
  }
}

TEST(BoundingPolyhedron, ThinAndRotatedCloudsAreContained) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const dmat4 rotation = random_rotation(random);
    auto points = cloud(seed, 12, {1, 0.01, seed % 2 ? 1e-9 : 0.3});
    for (dvec3& p : points) p = dvec3(rotation * dvec4(p, 1));
    expect_valid(points);
  }
}

TEST(BoundingPolyhedron, FlatCollinearAndSinglePoints) {
  expect_valid(cloud(1, 20, {1, 1, 0}));
  expect_valid(cloud(2, 20, {0, 1, 1}));
  expect_valid({{0, 0, 0}, {1, 1, 1}});
  expect_valid({{-1, 1, 0}, {1, -1, 0}});
  expect_valid({{0, 0, -3}, {0, 0, 4}});
  expect_valid({{5, 6, 7}});
  expect_valid({{5, 6, 7}, {5, 6, 7}, {5, 6, 7}});
}

TEST(BoundingPolyhedron, TinyHugeAndFarAway) {
  for (const double unit : {1e-4, 1e6}) {
    for (const double offset : {0.0, 1e3}) {
      auto points = cloud(11, 9, dvec3(unit));
      for (dvec3& p : points) p += offset * unit;
      SCOPED_TRACE(std::to_string(unit) + " at " + std::to_string(offset));
      expect_valid(points);
    }
  }
}

TEST(BoundingPolyhedron, EmptyAndNotFiniteSetsGiveNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<dvec3>> sets{
      {}, {{0, nan, 0}}, {{0, 0, 0}, {inf, 0, 0}}, {{-1.7e308, 0, 0}, {1.7e308, 0, 0}}};
  for (const auto& points : sets) {
    for (const BoundKind kind : kKinds) {
      EXPECT_TRUE(bounding_polyhedron(points, kind).points.empty());
      EXPECT_TRUE(bounding_polyhedron(points, kind).triangles.empty());
    }
  }
}

TEST(BoundingPolyhedron, AnOctahedronAndATetrahedronAreExactlyBounded) {
  // Both are bounded by planes of the 26 alone: 4/3 and 8/3 of a volume of 8.
  const std::vector<dvec3> octahedron{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  EXPECT_NEAR(volume(bounding_polyhedron(octahedron, BoundKind::Dop26)), 4.0 / 3, 1e-12);
  const std::vector<dvec3> tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(volume(bounding_polyhedron(tetrahedron, BoundKind::Dop14)), 8.0 / 3, 1e-12);
  EXPECT_NEAR(volume(bounding_polyhedron(tetrahedron, BoundKind::Dop26)), 8.0 / 3, 1e-12);
}

TEST(BoundingPolyhedron, MorePlanesAreTighterAroundABall) {
  const double box = volume(bounding_polyhedron(ball(), BoundKind::Box8));
  const double dop14 = volume(bounding_polyhedron(ball(), BoundKind::Dop14));
  const double dop26 = volume(bounding_polyhedron(ball(), BoundKind::Dop26));
  EXPECT_NEAR(box, 8, 0.05);
  // The corner cuts of a ball would cross; made shallower they leave a cuboctahedron, 5/6 of the cube.
  EXPECT_NEAR(dop14, 8 * 5 / 6.0, 0.05);
  EXPECT_LT(dop26, 0.8 * dop14);
  EXPECT_GT(dop26, 4.188);
}

TEST(BoundingPolyhedron, PointsMoveContinuouslyWithADeformingShape) {
  // Point i then and point i now are matched, so a small deformation must not let the indices jump.
  for (unsigned seed = 0; seed < 30; ++seed) {
    const auto before = cloud(seed, 10, {1, 1, 1});
    auto after = before;
    const auto noise = cloud(seed + 100, 10, dvec3(1e-6));
    for (std::size_t i = 0; i < after.size(); ++i) after[i] += noise[i];
    for (const BoundKind kind : kKinds) {
      const auto a = bounding_polyhedron(before, kind).points, b = bounding_polyhedron(after, kind).points;
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(glm::length(a[i] - b[i]), 1e-4) << "seed " << seed;
    }
  }
}

// ---- bounds of layers
// -------------------------------------------------------------------------------------------

/// root (moves) → arm (at rest on it) → hand (moves); one part of a unit cube each.
struct ArmScene {
  ArmScene() {
    scene.nodes = {{"root", -1, {}}, {"arm", 0, {}}, {"hand", 1, {}}};
    scene.nodes[1].local.translation = {0, 2, 0};
    scene.nodes[2].local.translation = {3, 0, 0};
    scene.tracks = {{0, layers::SpinTrack{}}, {2, layers::SpinTrack{}}};
    scene.meshes.emplace_back();
    for (const dvec3& p : box_corners(dvec3(0.5))) scene.meshes[0].positions.push_back(layers::vec3(p));
    scene.materials.emplace_back();
    for (int node = 0; node < 3; ++node) scene.parts.push_back({scene.nodes[node].name, node, 0, 0, -1});
  }
  layers::SceneFrame frame(double root_angle, double hand_angle) const {
    const dmat4 root = turned_by(root_angle, {0, 1, 0});
    const dmat4 arm = root * moved_by({0, 2, 0});
    return {&scene, 0, {root, arm, arm * moved_by({3, 0, 0}) * turned_by(hand_angle, {0, 0, 1})}, {}, {},
            {},     {}};
  }
  layers::Layer layer(std::vector<int> parts, int rigid_node) const {
    layers::Layer result;
    result.parts = std::move(parts);
    result.rigid_node = rigid_node;
    return result;
  }
  layers::Scene scene;
};

TEST(LayerBound, RigidPartsAreBoundedOnceInTheirNode) {
  const ArmScene arm;
  const auto layer = arm.layer({0, 1}, 0);
  const auto bound = make_layer_bound(arm.scene, layer, BoundKind::Box8);
  EXPECT_TRUE(bound.fixed());
  EXPECT_EQ(bound.node, 0);
  const auto box = layers::bounds_of(bound.hull.points);
  EXPECT_EQ(box.lo, dvec3(-0.5, -0.5, -0.5));
  EXPECT_EQ(box.hi, dvec3(0.5, 2.5, 0.5));
  const auto frame = arm.frame(1.1, 0);
  const auto world = world_points(frame, layer, bound);
  for (std::size_t i = 0; i < world.size(); ++i) {
    EXPECT_EQ(world[i], dvec3(frame.world_from_node[0] * dvec4(bound.hull.points[i], 1)));
  }
}

TEST(LayerBound, PartsThatMoveAgainstEachOtherAreBoundedAtEachTimeAndTurnAsAWhole) {
  const ArmScene arm;
  const auto layer = arm.layer({1, 2}, -1);
  const auto bound = make_layer_bound(arm.scene, layer, BoundKind::Dop26);
  EXPECT_FALSE(bound.fixed());
  EXPECT_EQ(bound.axes_node, -1) << "each part has its own";
  EXPECT_EQ(bound.hull.triangles.size(), 2 * 92u);
  for (const double hand_angle : {0.0, 0.4, 2.0}) {
    const auto frame = arm.frame(0.7, hand_angle);
    std::vector<dvec3> vertices;
    for (const int part : layer.parts) {
      for (const auto& p : arm.scene.meshes[0].positions) {
        vertices.push_back(dvec3(frame.world_from_node[part] * dvec4(dvec3(p), 1)));
      }
    }
    expect_contains({world_points(frame, layer, bound), {}}, vertices);
  }
  // The whole arm turns: every characteristic point turns with it.
  const auto then = world_points(arm.frame(0, 0.3), layer, bound),
             now = world_points(arm.frame(1, 0.3), layer, bound);
  for (std::size_t i = 0; i < then.size(); ++i) {
    EXPECT_LT(glm::length(now[i] - dvec3(turned_by(1, {0, 1, 0}) * dvec4(then[i], 1))), 1e-12);
  }
}

TEST(LayerBound, WhatNeverMovesIsFixedInTheWorld) {
  ArmScene arm;
  arm.scene.tracks.clear();
  const auto layer = arm.layer({0, 2}, -1);
  const auto bound = make_layer_bound(arm.scene, layer, BoundKind::Box8);
  EXPECT_TRUE(bound.fixed());
  EXPECT_EQ(bound.node, -1);
  EXPECT_EQ(layers::bounds_of(world_points(arm.frame(0, 0), layer, bound)).hi, dvec3(3.5, 2.5, 0.5));
}

TEST(LayerBound, SkinnedPartsFollowTheirVertices) {
  ArmScene arm;
  arm.scene.skins.push_back({"skin", {1, 2}, {dmat4(1.0), dmat4(1.0)}});
  arm.scene.meshes[0].joints.assign(8, {0, 0, 0, 0});
  arm.scene.meshes[0].weights.assign(8, {1, 0, 0, 0});
  arm.scene.parts[0].skin = 0;
  const auto layer = arm.layer({0}, -1);
  const auto bound = make_layer_bound(arm.scene, layer, BoundKind::Box8);
  EXPECT_FALSE(bound.fixed());
  EXPECT_EQ(bound.axes_node, 1);
  const auto frame = arm.frame(0.9, 0.2);
  const auto part = world_positions(frame, arm.scene.parts[0]);
  expect_contains({world_points(frame, layer, bound), {}}, part);
}

TEST(LayerBound, ALayerWithoutVerticesHasNoPoints) {
  ArmScene arm;
  arm.scene.meshes[0].positions.clear();
  for (const int rigid_node : {0, -1}) {
    const auto layer = arm.layer({0, 2}, rigid_node);
    const auto bound = make_layer_bound(arm.scene, layer, BoundKind::Dop14);
    EXPECT_TRUE(world_points(arm.frame(0, 0), layer, bound).empty());
  }
}

TEST(LayerBound, ANodeScaledToNothingFallsBackToTheAxesOfTheWorld) {
  const ArmScene arm;
  const auto layer = arm.layer({1, 2}, -1);
  const auto bound = make_layer_bound(arm.scene, layer, BoundKind::Box8);
  auto frame = arm.frame(0, 0);
  frame.world_from_node[1] = glm::scale(dmat4(1.0), dvec3(0.0));
  for (const dvec3& p : world_points(frame, layer, bound)) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  EXPECT_EQ(world_points(frame, layer, bound).size(), 2 * 8u);
}

TEST(LayerBound, EveryVertexIsInsideAtEveryTime) {
  // The scenes of the tests: rigid, orbiting, skinned, at a scale of 1e-4 and of 1e6; one layer per part, and
  // one of all.
  for (const layers::Scene& scene :
       {moving_scene(), skinned_bar_scene(), cube_scene(), tiny_scene(), huge_scene()}) {
    auto specs = one_layer_per_part(scene);
    const std::size_t separate = specs.size();
    const auto one_each = factor(scene, specs);
    specs.resize(1);
    specs[0].part_globs = {"*"};
    const auto together = factor(scene, specs);
    ASSERT_EQ(one_each.layers.size(), separate);
    ASSERT_EQ(together.layers.size(), 1u);
    for (const auto* set : {&one_each, &together}) {
      for (const auto& layer : set->layers) {
        for (const BoundKind kind : kKinds) {
          const auto bound = make_layer_bound(scene, layer, kind);
          for (const double time : {0.0, 0.7, 1.9, 3.3}) {
            SCOPED_TRACE(layer.name + " at " + std::to_string(time));
            const auto frame = scene.at(time);
            std::vector<dvec3> vertices;
            for (const int part : layer.parts) {
              const auto of_part = world_positions(frame, scene.parts[part]);
              vertices.insert(vertices.end(), of_part.begin(), of_part.end());
            }
            expect_contains({world_points(frame, layer, bound), {}}, vertices);
          }
        }
      }
    }
  }
}

TEST(MakeLayerBound, EachPartHasItsOwnPolyhedronWhereTheLayerAsksForIt) {
  // Ground, cube and moon lie apart and move against each other: one box around them all is blind to that.
  const layers::Scene scene = tests::moving_scene();
  const layers::LayerSpec all{"all", {"*"}, layers::OrderGroup::Normal, {}};
  layers::Layer layer = layers::factor(scene, {&all, 1}).layers.at(0);
  layer.preferences.bound_each_part = true;
  for (const layers::BoundKind kind :
       {layers::BoundKind::Box8, layers::BoundKind::Dop14, layers::BoundKind::Dop26}) {
    const layers::LayerBound bound = layers::make_layer_bound(scene, layer, kind);
    ASSERT_EQ(bound.bodies.size(), layer.parts.size());
    for (const double t : {0.0, 0.7, 3.1}) {
      const layers::SceneFrame frame = scene.at(t);
      const auto points = layers::world_points(frame, layer, bound);
      std::size_t first = 0;
      for (const layers::LayerBound& body : bound.bodies) {
        layers::Layer alone = layer;
        alone.preferences.bound_each_part = false;
        alone.parts = body.parts;
        alone.rigid_node = scene.parts[body.parts[0]].node;
        const auto expected =
            layers::world_points(frame, alone, layers::make_layer_bound(scene, alone, kind));
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(points.at(first + i), expected[i]);
        first += expected.size();
      }
      EXPECT_EQ(points.size(), first);
    }
    const std::size_t points_of_kind =
        layers::world_points(scene.at(0), layer, bound).size() / bound.bodies.size();
    for (const auto& triangle : bound.hull.triangles)
      for (const int corner : triangle)
        EXPECT_LT(corner, static_cast<int>(points_of_kind * bound.bodies.size()));
    EXPECT_EQ(bound.hull.triangles.size(), bound.bodies.size() * layers::topology(kind).size());
  }
}

}  // namespace
}  // namespace talisman::tests
