// SPDX-License-Identifier: Apache-2.0
#include "layers/visibility.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/visibility_oracle.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using tests::box;
using tests::Points;
using tests::World;

constexpr dvec3 kEye{0, 0, 10};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

VisibilityOrder sort_once(const dvec3& eye, const std::vector<Points>& bodies,
                          const std::vector<ExplicitPair>& pairs = {}) {
  const World world{eye, bodies};
  return VisibilitySorter().sort(eye, world.occluders(), pairs);
}

std::vector<int> order(const dvec3& eye, const std::vector<Points>& bodies) {
  return sort_once(eye, bodies).order;
}

Points moved(Points points, const dvec3& by) {
  for (dvec3& p : points) p += by;
  return points;
}

Points scaled(Points points, double by) {
  for (dvec3& p : points) p *= by;
  return points;
}

/// `count` planks around the view axis, each with its near end over the far end of the one before.
std::vector<Points> ring_of_planks(int count) {
  std::vector<Points> planks;
  const double step = 2 * M_PI / count;
  for (int i = 0; i < count; ++i) {
    const auto at = [&](double turns, double z) {
      return dvec3{10 * std::cos(turns * step), 10 * std::sin(turns * step), z};
    };
    const dvec3 near = at(i - 0.1, 0.3), far = at(i + 1.1, -0.3);
    const dvec3 across = glm::normalize(near + far) * 0.4, thick{0, 0, 0.01};
    Points plank;
    for (const dvec3& end : {near, far})
      for (const dvec3& side : {across - thick, across + thick, -across - thick, -across + thick})
        plank.push_back(end + side);
    planks.push_back(plank);
  }
  return planks;
}

TEST(VisibilitySorter, NothingIsNothing) {
  const VisibilityOrder o = sort_once(kEye, {});
  EXPECT_THAT(o.order, IsEmpty());
  EXPECT_THAT(o.groups_back_to_front, IsEmpty());
  EXPECT_EQ(o.counters.components, 0);
}

TEST(VisibilitySorter, RowIsOrderedFromEitherEnd) {
  const std::vector<Points> row = {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -3}, {1, 1, 1}),
                                   box({0, 0, -6}, {1, 1, 1})};
  EXPECT_THAT(order({0, 0, 9}, row), ElementsAre(2, 1, 0));
  EXPECT_THAT(order({0, 0, -19}, row), ElementsAre(0, 1, 2));
}

// A long wall's middle says nothing: the plane between it and the crate does.
TEST(VisibilitySorter, LongThingsGoByThePlaneBetween) {
  const std::vector<Points> bodies = {box({40, 0, 0}, {50, 2, 0.1}), box({0, 0, -1}, {0.5, 0.5, 0.5})};
  EXPECT_THAT(order({0, 0, 3}, bodies), ElementsAre(1, 0));
  EXPECT_THAT(order({0, 0, -9}, bodies), ElementsAre(0, 1));
}

// Slanted planks whose boxes overlap: only the hulls know which is in front.
TEST(VisibilitySorter, HullsDecideWhatBoxesCannot) {
  Points far, near;
  for (const dvec3& p : box({0, 0, 0}, {5, 1, 0.1})) {
    far.push_back({p.x, p.y, p.z + p.x});
    near.push_back({p.x, p.y, p.z + p.x + 0.5});
  }
  EXPECT_THAT(order(kEye, {near, far}), ElementsAre(1, 0));
  EXPECT_THAT(order(kEye, {far, near}), ElementsAre(0, 1));
}

TEST(VisibilitySorter, UnrelatedLayersComeByDistanceThenById) {
  const dvec3 half{0.1, 0.1, 0.1};
  const std::vector<Points> apart = {box({-4, 0, 0}, half), box({4, 0, -2}, half), box({0, 4, 0}, half),
                                     box({4, 0, 0}, half)};
  EXPECT_THAT(order(kEye, apart), ElementsAre(1, 0, 2, 3));
}

TEST(VisibilitySorter, GroupsComeBeforeGeometry) {
  World world{kEye, {box({0, 0, 3}, {1, 1, 1}), box({0, 0, -9}, {1, 1, 1}), box({0, 0, -5}, {1, 1, 1})}};
  auto layers = world.occluders();
  layers[0].group = OrderGroup::Background;
  layers[1].group = OrderGroup::Foreground;
  EXPECT_THAT(VisibilitySorter().sort(kEye, layers).order, ElementsAre(0, 2, 1));
}

// In different groups the two are never one sprite, however they interpenetrate.
TEST(VisibilitySorter, GroupsAreNeverMerged) {
  World world{kEye, {box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1})}};
  auto layers = world.occluders();
  layers[0].group = OrderGroup::Foreground;
  const VisibilityOrder o = VisibilitySorter().sort(kEye, layers);
  EXPECT_THAT(o.order, ElementsAre(1, 0));
  EXPECT_THAT(o.merged, IsEmpty());
}

TEST(VisibilitySorter, TouchingBodiesFormNoCycle) {
  const std::vector<Points> stack = {box({0, 0, 1}, {1, 1, 1}), box({0, 0, -1}, {1, 1, 1}),
                                     box({0, 2, 0}, {1, 1, 2})};
  for (const dvec3& eye : {kEye, dvec3{3, 1, 7}, dvec3{5, 9, -4}, dvec3{0, 0, -9}}) {
    const VisibilityOrder o = sort_once(eye, stack);
    EXPECT_THAT(o.merged, IsEmpty());
    EXPECT_EQ(tests::wrong_with(o, tests::slow_relation({eye, stack}, 1e-3), true), "");
  }
}

// Either side of the tolerance, which is 0.001 of the smaller one's size of 2.
TEST(VisibilitySorter, ToleranceSeparatesTouchingFromMeeting) {
  const Points wall = box({0, 0, -10}, {10, 10, 10});
  EXPECT_THAT(sort_once(kEye, {wall, box({0, 0, 1 - 0.0015}, {1, 1, 1})}).groups_back_to_front,
              ElementsAre(ElementsAre(0), ElementsAre(1)));
  EXPECT_THAT(sort_once(kEye, {wall, box({0, 0, 1 - 0.0025}, {1, 1, 1})}).groups_back_to_front,
              ElementsAre(ElementsAre(0, 1)));
}

TEST(VisibilitySorter, MeetingBodiesAreMergedAndTheReasonNamed) {
  const VisibilityOrder o = sort_once(
      kEye, {box({0, 0, 0}, {1, 1, 1}), box({5, 0, 0}, {1, 1, 1}), box({0.5, 0.5, 0.5}, {1, 1, 1})});
  ASSERT_EQ(o.merged.size(), 1u);
  EXPECT_THAT(o.merged[0].layers, ElementsAre(0, 2));
  EXPECT_EQ(o.merged[0].reason, MergedComponent::Reason::Interpenetration);
  EXPECT_THAT(o.merged[0].cycle, UnorderedElementsAre(0, 2));
  EXPECT_THAT(o.merged[0].relations, ElementsAre(ExplicitPair{0, 2}, ExplicitPair{2, 0}));
  EXPECT_EQ(o.merged[0].absent_frames, 0);
  EXPECT_EQ(o.counters.merged_layers, 2);
  EXPECT_EQ(o.counters.components, 2);
}

TEST(VisibilitySorter, NestedAndIdenticalBodiesAreMerged) {
  const Points outer = box({0, 0, 0}, {3, 3, 3}), inner = box({0.5, 0, 0}, {1, 1, 1});
  EXPECT_EQ(sort_once(kEye, {outer, inner}).merged.size(), 1u);
  EXPECT_EQ(sort_once(kEye, {outer, outer}).merged.size(), 1u);
  EXPECT_EQ(sort_once(kEye, {inner, Points{{0, 0, 0}}}).merged.size(), 1u) << "a point inside";
}

// Decals: in one plane nothing is in front, and nothing must flicker.
TEST(VisibilitySorter, FlatBodiesInOnePlaneAreUnrelated) {
  const Points sheet = box({0, 0, 0}, {2, 2, 0}), decal = box({1, 0, 0}, {2, 1, 0});
  const VisibilityOrder o = sort_once({1, 2, 10}, {sheet, decal, sheet});
  EXPECT_THAT(o.merged, IsEmpty());
  EXPECT_EQ(o.counters.edges, 0);
}

// Seen exactly edge-on the eye lies in the plane of the sheet as well: everything is flat.
TEST(VisibilitySorter, EyeInThePlaneOfASheet) {
  const Points sheet = box({0, 0, 0}, {0, 2, 2}), behind = box({0, 0, -6}, {0, 1, 1});
  const VisibilityOrder o = sort_once(kEye, {sheet, behind});
  EXPECT_THAT(o.merged, IsEmpty());
  EXPECT_EQ(o.counters.undecided, 0);
}

TEST(VisibilitySorter, CrossingSheetsAreMerged) {
  const Points a = box({0, 0, 0}, {2, 2, 0}), b = box({0, 0, 0}, {0, 2, 2});
  EXPECT_EQ(sort_once({3, 2, 10}, {a, b}).merged.size(), 1u);
}

TEST(VisibilitySorter, PointsAndNeedlesAreBodiesToo) {
  const Points wall = box({0, 0, -3}, {5, 5, 0}), needle{{-1, 0, 0}, {1, 0.5, 0}}, point{{0, 0.25, 2}};
  EXPECT_THAT(order(kEye, {wall, point}), ElementsAre(0, 1));
  EXPECT_THAT(order(kEye, {needle, wall}), ElementsAre(1, 0));
  EXPECT_THAT(order({0, 0, -10}, {needle, wall}), ElementsAre(0, 1));
}

// No geometry, no relation: and no harm to the others.
TEST(VisibilitySorter, EmptyAndBrokenBodiesComeFirst) {
  Points broken = box({0, 0, 5}, {1, 1, 1}), infinite = broken, enormous = broken;
  broken[3].y = kNaN;
  infinite[0].x = HUGE_VAL;
  enormous[0].x = 1e200;
  const VisibilityOrder o = sort_once(
      kEye, {box({0, 0, 0}, {1, 1, 1}), broken, box({0, 0, -4}, {1, 1, 1}), Points{}, infinite, enormous});
  EXPECT_THAT(o.order, ElementsAre(1, 3, 4, 5, 2, 0));
  EXPECT_EQ(o.counters.edges, 1);
  const std::vector<Occluder> bodiless = {{0, OrderGroup::Normal, {}}};
  EXPECT_THAT(VisibilitySorter().sort(kEye, bodiless).order, ElementsAre(0));
}

TEST(VisibilitySorter, BrokenForOneFrameIsForgotten) {
  World world{kEye, {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -4}, {1, 1, 1})}};
  VisibilitySorter sorter;
  EXPECT_THAT(sorter.sort(kEye, world.occluders()).order, ElementsAre(1, 0));
  const Points good = world.bodies[0];
  world.bodies[0][5].z = kNaN;
  EXPECT_EQ(sorter.sort(kEye, world.occluders()).counters.edges, 0);
  world.bodies[0] = moved(good, {0, 0, -8});
  EXPECT_THAT(sorter.sort(kEye, world.occluders()).order, ElementsAre(0, 1));
}

TEST(VisibilitySorter, EyeThatIsNotFiniteCountsAsTheOrigin) {
  const std::vector<Points> bodies = {box({0, 0, -3}, {1, 1, 1}), box({0, 0, -9}, {1, 1, 1})};
  EXPECT_THAT(order({kNaN, 0, 0}, bodies), ElementsAre(1, 0));
}

// The eye looks along -z; what is behind it is ordered by the same rule, and does not touch what is before
// it.
TEST(VisibilitySorter, BehindTheCameraIsADirectionLikeOthers) {
  const std::vector<Points> bodies = {box({0, 0, -3}, {1, 1, 1}), box({0, 0, 4}, {1, 1, 1}),
                                      box({0, 0, 9}, {1, 1, 1})};
  const VisibilityOrder o = sort_once({0, 0, 0}, bodies);
  EXPECT_EQ(o.counters.edges, 1);
  EXPECT_THAT(o.order, ElementsAre(2, 1, 0));
}

// A wall beside the camera, from far before it to far behind it.
TEST(VisibilitySorter, BodyAlongsideTheCamera) {
  const std::vector<Points> bodies = {box({-1, 0, 0}, {0.1, 5, 100}), box({-3, 0, -8}, {1, 1, 1}),
                                      box({3, 0, -8}, {1, 1, 1})};
  const VisibilityOrder o = sort_once({0, 0, 0}, bodies);
  EXPECT_EQ(tests::wrong_with(o, tests::slow_relation({{0, 0, 0}, bodies}, 1e-3), true), "");
  EXPECT_EQ(o.counters.edges, 1);
}

TEST(VisibilitySorter, BodyAroundTheEyeIsInFrontOfAllItDoesNotMeet) {
  const Points cockpit = box({0, 0, 0}, {2, 1, 2});
  const std::vector<Points> bodies = {cockpit, box({0, 0, -9}, {1, 1, 1}), box({0, 0, 9}, {1, 1, 1})};
  const VisibilityOrder o = sort_once({0, 0, 0}, bodies);
  EXPECT_EQ(o.order.back(), 0);
  EXPECT_THAT(o.merged, IsEmpty());
  EXPECT_EQ(sort_once({0, 0, 0}, {cockpit, box({0, 0, -2}, {0.5, 0.5, 1})}).merged.size(), 1u);
}

// The eye in a corner of a body, to the bit: no direction, no order, but no NaN either.
TEST(VisibilitySorter, EyeOnACorner) {
  const std::vector<Points> bodies = {
      box({-1, -1, -1}, {1, 1, 1}), box({-4, -4, -4}, {1, 1, 1}), {{0, 0, 0}}};
  const VisibilityOrder o = sort_once({0, 0, 0}, bodies);
  EXPECT_EQ(o.order.size(), 3u);
  EXPECT_LT(std::find(o.order.begin(), o.order.end(), 1), std::find(o.order.begin(), o.order.end(), 0));
}

TEST(VisibilitySorter, ScenesOfAnyScaleAndPlaceAreAlike) {
  const tests::MovingBodies bodies(5, 6, 2, 0);
  const World world = bodies.at(0);
  const VisibilityOrder expected = VisibilitySorter().sort(world.eye, world.occluders());
  for (const double scale : {1e-4, 1e6, 1e-20, 1e20}) {
    World other{world.eye * scale, {}};
    for (const Points& p : world.bodies) other.bodies.push_back(scaled(p, scale));
    EXPECT_EQ(VisibilitySorter().sort(other.eye, other.occluders()).groups_back_to_front,
              expected.groups_back_to_front)
        << scale;
  }
  const dvec3 far{1e6, -2e6, 1e6};
  World other{world.eye + far, {}};
  for (const Points& p : world.bodies) other.bodies.push_back(moved(p, far));
  EXPECT_EQ(VisibilitySorter().sort(other.eye, other.occluders()).groups_back_to_front,
            expected.groups_back_to_front);
}

// A grain of sand before a planet, both seen from a body length of the grain and from far away.
TEST(VisibilitySorter, TinyBeforeHuge) {
  const Points planet = box({0, 0, -1e6}, {1e6, 1e6, 1e6 - 1}), grain = box({0, 0, 0}, {1e-4, 1e-4, 1e-4});
  EXPECT_THAT(order({0, 0, 3e-4}, {grain, planet}), ElementsAre(1, 0));
  EXPECT_THAT(order({0, 0, 1e5}, {grain, planet}), ElementsAre(1, 0));
}

TEST(VisibilitySorter, CyclesOfAnyLengthAreMerged) {
  for (const int count : {3, 4, 50}) {
    std::vector<Points> bodies = ring_of_planks(count);
    bodies.push_back(box({0, 0, -40}, {30, 30, 1}));  // a wall behind, which takes no part
    const VisibilityOrder o = sort_once({0, 0, 30}, bodies);
    ASSERT_EQ(o.merged.size(), 1u) << count;
    EXPECT_EQ(static_cast<int>(o.merged[0].layers.size()), count);
    EXPECT_EQ(o.merged[0].reason, MergedComponent::Reason::Cycle);
    EXPECT_EQ(static_cast<int>(o.merged[0].cycle.size()), count);
    EXPECT_EQ(o.order.front(), count);
    for (int k = 0; k < count; ++k)
      EXPECT_EQ(o.merged[0].cycle[(k + 1) % count], (o.merged[0].cycle[k] + 1) % count)
          << "each plank is behind the next";
  }
}

TEST(VisibilitySorter, AllLayersInOneCycle) {
  const VisibilityOrder o = sort_once({0, 0, 30}, ring_of_planks(300));
  EXPECT_EQ(o.counters.components, 1);
  EXPECT_EQ(o.counters.merged_layers, 300);
}

// A horseshoe of two bodies, with a ball that hangs between them: each layer is before part of the other.
TEST(VisibilitySorter, LayersOfSeveralBodiesCanGoRoundTogether) {
  const Points near = box({0, 0, 3}, {1, 1, 0.5}), far = box({0, 0, -3}, {1, 1, 0.5}),
               ball = box({0, 0, 0}, {1, 1, 1});
  const std::vector<Occluder> layers = {{0, OrderGroup::Normal, {near, far}},
                                        {1, OrderGroup::Normal, {ball}}};
  EXPECT_EQ(VisibilitySorter().sort(kEye, layers).merged.size(), 1u);
  const VisibilityOrder beside = VisibilitySorter().sort({50, 0, 0}, layers);
  EXPECT_THAT(beside.merged, IsEmpty()) << "from the side the three are apart";
  EXPECT_EQ(beside.counters.bodies, 3);
}

TEST(VisibilitySorter, BodiesOfOneLayerAreNotComparedWithEachOther) {
  const Points a = box({0, 0, 0}, {1, 1, 1}), b = box({0, 0, 0.5}, {1, 1, 1}),
               wall = box({0, 0, -5}, {3, 3, 1});
  const std::vector<Occluder> layers = {{0, OrderGroup::Normal, {a, b}}, {1, OrderGroup::Normal, {wall}}};
  const VisibilityOrder o = VisibilitySorter().sort(kEye, layers);
  EXPECT_THAT(o.order, ElementsAre(1, 0));
  EXPECT_THAT(o.merged, IsEmpty());
}

TEST(VisibilitySorter, ExplicitPairsReplaceGeometry) {
  const std::vector<Points> row = {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -3}, {1, 1, 1})};
  const VisibilityOrder o = sort_once(kEye, row, {{0, 1}});
  EXPECT_THAT(o.order, ElementsAre(0, 1));
  EXPECT_EQ(o.defect, "");
}

TEST(VisibilitySorter, ExplicitPairKeepsMeetingLayersApart) {
  const std::vector<Points> meeting = {box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0.5}, {1, 1, 1})};
  EXPECT_THAT(sort_once(kEye, meeting, {{1, 0}}).groups_back_to_front,
              ElementsAre(ElementsAre(1), ElementsAre(0)));
}

TEST(VisibilitySorter, ExplicitPairsThatCannotBeKeptAreReported) {
  const std::vector<Points> apart = {box({-4, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}),
                                     box({4, 0, 0}, {1, 1, 1})};
  const VisibilityOrder o = sort_once(kEye, apart, {{2, 1}, {1, 0}, {0, 2}});
  EXPECT_EQ(o.defect, "explicit pair: layer 0 behind layer 2 closes a cycle of explicit pairs");
  EXPECT_THAT(o.order, ElementsAre(2, 1, 0)) << "the others are kept";
  EXPECT_EQ(sort_once(kEye, apart, {{1, 1}}).defect,
            "explicit pair: layer 1 behind layer 1 names one layer twice");
  EXPECT_EQ(sort_once(kEye, apart, {{1, 7}, {-3, 0}}).defect, "")
      << "layers that are not there are no defect";
}

TEST(VisibilitySorter, ExplicitPairAgainstTheGroupsIsReported) {
  const World world{kEye, {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -3}, {1, 1, 1})}};
  auto layers = world.occluders();  // they refer to the world's points
  layers[0].group = OrderGroup::Background;
  const VisibilityOrder o = VisibilitySorter().sort(kEye, layers, std::vector<ExplicitPair>{{1, 0}});
  EXPECT_EQ(o.defect, "explicit pair: layer 1 behind layer 0 contradicts the groups of the two");
  EXPECT_THAT(o.order, ElementsAre(0, 1));
}

// The author's pair and geometry go round together; in the one sprite the z-buffer decides, and it is
// counted.
TEST(VisibilitySorter, ExplicitPairWithinACycleIsCounted) {
  const std::vector<Points> row = {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -3}, {1, 1, 1}),
                                   box({0, 0, -6}, {1, 1, 1})};
  const VisibilityOrder o = sort_once(kEye, row, {{0, 2}});
  ASSERT_EQ(o.merged.size(), 1u);
  EXPECT_EQ(o.merged[0].layers.size(), 3u);
  EXPECT_EQ(o.counters.overruled_pairs, 1);
}

}  // namespace
}  // namespace talisman::layers
