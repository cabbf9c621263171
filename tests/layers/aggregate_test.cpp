// SPDX-License-Identifier: Apache-2.0
// Layers merged into one: what it is made of, and that its points are those of its members.
#include "layers/aggregate.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

/// Ground, cube and moon, each a layer; the skinned bar recomputes its bound at each time.
struct Fixture {
  explicit Fixture(Scene s, BoundKind kind = BoundKind::Box8) : scene(std::move(s)) {
    set = factor(scene, tests::one_layer_per_part(scene));
    for (const Layer& layer : set.layers) bounds.push_back(make_layer_bound(scene, layer, kind));
  }
  Scene scene;
  LayerSet set;
  std::vector<LayerBound> bounds;
};

std::vector<const LayerBound*> chosen(const std::vector<LayerBound>& bounds,
                                      const std::vector<int>& members) {
  std::vector<const LayerBound*> result;
  for (const int member : members) result.push_back(&bounds[member]);
  return result;
}

TEST(AggregateOf, TakesPartsAndTheStrictestPreferencesOfItsMembers) {
  Fixture f(tests::moving_scene());
  f.set.layers[0].preferences.resolution_scale = 0.5;
  f.set.layers[0].preferences.importance.sampling = 3;
  f.set.layers[2].preferences.min_update_rate = 0.25;
  f.set.layers[2].preferences.max_update_rate = 0.5;
  const Layer aggregate = aggregate_of(f.set.layers, std::vector{0, 2}, 7);
  EXPECT_EQ(aggregate.id, 7);
  EXPECT_EQ(aggregate.name, "ground+orbit/moon");
  EXPECT_EQ(aggregate.members, (std::vector{0, 2}));
  EXPECT_EQ(aggregate.parts, (std::vector{0, 2}));
  EXPECT_EQ(aggregate.polygons, f.set.layers[0].polygons + f.set.layers[2].polygons);
  EXPECT_EQ(aggregate.preferences.resolution_scale, 1);  // the moon's
  EXPECT_EQ(aggregate.preferences.importance.sampling, 3);
  EXPECT_EQ(aggregate.preferences.min_update_rate, 0.25);
  EXPECT_EQ(aggregate.preferences.max_update_rate, 1);  // the ground may be drawn in every frame
  EXPECT_TRUE(aggregate.is_aggregate());
  EXPECT_FALSE(f.set.layers[0].is_aggregate());
}

TEST(AggregateOf, NamesOfManyMembersAreCut) {
  std::vector<Layer> layers(10);
  std::vector<int> all;
  for (int i = 0; i < 10; ++i) layers[i].name = std::string(1, static_cast<char>('a' + i)), all.push_back(i);
  EXPECT_EQ(aggregate_of(layers, std::span(all).first(4), 10).name, "a+b+c+d");
  EXPECT_EQ(aggregate_of(layers, all, 10).name, "a+b+c+7 more");
}

TEST(AggregateBound, PointsAreThoseOfTheMembersInTheirOrder) {
  // A moving scene, and one whose bound is recomputed; of each kind of polyhedron.
  for (const BoundKind kind : {BoundKind::Box8, BoundKind::Dop14, BoundKind::Dop26}) {
    const Fixture f(tests::moving_scene(), kind);
    const std::vector<int> members{0, 1, 2};
    const Layer aggregate = aggregate_of(f.set.layers, members, 3);
    const LayerBound bound = aggregate_bound(chosen(f.bounds, members));
    const SceneFrame frame = f.scene.at(1.3);
    std::vector<dvec3> expected;
    for (const int member : members)
      for (const dvec3& p : world_points(frame, f.set.layers[member], f.bounds[member]))
        expected.push_back(p);
    EXPECT_EQ(world_points(frame, aggregate, bound), expected);
    EXPECT_EQ(point_count(bound), static_cast<int>(expected.size()));
    for (const auto& [a, b, c] : bound.hull.triangles)
      EXPECT_LT(std::max({a, b, c}), static_cast<int>(expected.size()));
  }
}

TEST(AggregateBound, SkinnedMembersAreRecomputed) {
  const Fixture f(tests::skinned_bar_scene());
  const std::vector<LayerBound> bounds{f.bounds[0], f.bounds[0]};
  const LayerBound bound = aggregate_bound(chosen(bounds, std::vector{0, 1}));
  const auto straight = world_points(f.scene.at(0), f.set.layers[0], bound);
  const auto bent = world_points(f.scene.at(1), f.set.layers[0], bound);
  ASSERT_EQ(straight.size(), 16u);
  ASSERT_EQ(bent.size(), 16u);
  EXPECT_NE(straight, bent);
  EXPECT_TRUE(std::equal(bent.begin(), bent.begin() + 8, bent.begin() + 8));
}

TEST(ConvexBodies, OneForEachBodyAndNoneWithoutPoints) {
  const Fixture f(tests::moving_scene());
  const LayerBound bound = aggregate_bound(chosen(f.bounds, std::vector{1, 2}));
  const auto points = world_points(f.scene.at(0), f.set.layers[1], bound);
  const auto bodies = convex_bodies(bound, points);
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_EQ(bodies[0].data(), points.data());
  EXPECT_EQ(bodies[1].data(), points.data() + 8);
  EXPECT_EQ(convex_bodies(f.bounds[0], std::span(points).first(8)).size(), 1u);
  EXPECT_TRUE(convex_bodies(bound, {}).empty());
}

TEST(ConvexBodies, AggregatesOfLayersWithABodyPerPartAreTakenApart) {
  Scene scene = tests::moving_scene();
  const std::vector<LayerSpec> specs{{"both", {"ground", "cube"}, OrderGroup::Normal, {}},
                                     {"moon", {"orbit/moon"}, OrderGroup::Normal, {}}};
  LayerSet set = factor(scene, specs);
  set.layers[0].preferences.bound_each_part = true;
  const std::vector<LayerBound> bounds{make_layer_bound(scene, set.layers[0], BoundKind::Box8),
                                       make_layer_bound(scene, set.layers[1], BoundKind::Box8)};
  const LayerBound bound = aggregate_bound(chosen(bounds, std::vector{0, 1}));
  const auto points = world_points(scene.at(0), set.layers[0], bound);
  EXPECT_EQ(points.size(), 24u);
  EXPECT_EQ(convex_bodies(bound, points).size(), 3u);
}

}  // namespace
}  // namespace talisman::layers
