// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "layers/clip.h"
#include "layers/state.h"
#include "tests/layers/worlds.h"
#include "warp/fit.h"

namespace talisman::tests {
namespace {

using layers::BoundKind;
using layers::CameraState;
using layers::Correspondences;
using layers::LayerState;

constexpr double kMargin = 0.25;  // of the default view

/// How far (px) a point lies outside of the display that is larger by this much on each side.
double outside_enlarged(dvec2 p, layers::ivec2 display, dvec2 margin_px) {
  const dvec2 size(display);
  const dvec2 beyond = glm::max(-margin_px - p, p - size - margin_px);
  return std::max({beyond.x, beyond.y, 0.0});
}

void expect_in_both_views(const Correspondences& matched, layers::ivec2 display) {
  ASSERT_EQ(matched.then_px.size(), matched.now_px.size());
  ASSERT_EQ(matched.then_px.size(), matched.point.size());
  for (std::size_t i = 0; i < matched.point.size(); ++i) {
    // Written so that NaN fails.
    EXPECT_TRUE(outside_enlarged(matched.then_px[i], display, layers::kThenMargin * dvec2(display)) < 1e-5)
        << i;
    EXPECT_TRUE(
        outside_enlarged(matched.now_px[i], display, dvec2(kMargin * std::max(display.x, display.y))) < 1e-5)
        << i;
  }
}

double largest_motion(const Correspondences& matched) {
  double result = 0;
  for (std::size_t i = 0; i < matched.point.size(); ++i) {
    result = std::max(result, glm::length(matched.now_px[i] - matched.then_px[i]));
  }
  return result;
}

// ---- the oracle: every triple of planes of the solid and of both views, in the layer's own space
// --------------------

/// dot(normal, p) ≤ offset.
struct Plane {
  dvec3 normal;
  double offset;
};

/// The view, larger by `margin_px` on each side, from the camera's own numbers: |x| ≤ g tan(fov/2) aspect ·
/// (-z), and so on.
std::vector<Plane> view_planes(const dmat4& camera_from_local, const layers::View& view,
                               const CameraState& camera, dvec2 margin_px) {
  const dvec2 g = (dvec2(1) + 2.0 * margin_px / dvec2(view.display_px)) * std::tan(camera.fov_y_rad / 2);
  const double aspect = view.display_px.x / static_cast<double>(view.display_px.y);
  std::vector<Plane> planes;
  for (const Plane& p : {Plane{{0, 0, 1}, -camera.near_m}, Plane{{1, 0, g.x * aspect}, 0},
                         Plane{{-1, 0, g.x * aspect}, 0}, Plane{{0, 1, g.y}, 0}, Plane{{0, -1, g.y}, 0}}) {
    const glm::dmat3 linear(camera_from_local);
    const dvec3 normal = glm::transpose(linear) * p.normal;
    const double length = glm::length(normal);
    planes.push_back(
        {normal / length, (p.offset - glm::dot(p.normal, dvec3(camera_from_local[3]))) / length});
  }
  return planes;
}

/// Vertices of the intersection of all half-spaces that lie on at least one of the first `solid_planes`.
std::vector<dvec3> surface_vertices(const std::vector<Plane>& planes, std::size_t solid_planes) {
  std::vector<dvec3> vertices;
  for (std::size_t i = 0; i < solid_planes; ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        const glm::dmat3 rows(planes[i].normal, planes[j].normal, planes[k].normal);
        if (std::abs(glm::determinant(rows)) < 1e-9) continue;
        const dvec3 p =
            glm::inverse(glm::transpose(rows)) * dvec3(planes[i].offset, planes[j].offset, planes[k].offset);
        if (std::all_of(planes.begin(), planes.end(),
                        [&](const Plane& q) { return glm::dot(q.normal, p) <= q.offset + 1e-9; })) {
          vertices.push_back(p);
        }
      }
    }
  }
  return vertices;
}

struct Pair {
  dvec2 then_px, now_px;
};

/// The place of a local point, by the definition of a pinhole camera.
dvec2 project(const dmat4& camera_from_local, const layers::View& view, const CameraState& camera,
              const dvec3& local) {
  const dvec3 p = dvec3(camera_from_local * dvec4(local, 1));
  const double focal_px = view.display_px.y / 2.0 / std::tan(camera.fov_y_rad / 2);
  return dvec2(view.display_px) / 2.0 + focal_px * dvec2(p.x, -p.y) / -p.z;
}

bool near(const Pair& a, dvec2 then_px, dvec2 now_px) {
  return glm::length(a.then_px - then_px) < 1e-4 && glm::length(a.now_px - now_px) < 1e-4;
}

/// A box of any size anywhere around a camera, moved a little or a lot between two states.
struct MovedBox {
  explicit MovedBox(unsigned seed)
      : random(seed),
        half_size(uniform3(random, 0.2, seed % 3 == 0 ? 40 : 4)),
        world(box_corners(half_size)) {
    world.view.display_px = {800, 600};
    place = moved_by(uniform3(random, -6, 6) + dvec3(0, 0, -4)) * random_rotation(random);
    const double step = seed % 2 ? 0.05 : 0.6;
    motion = moved_by(uniform3(random, -step, step)) * turned_by(step * 0.5, uniform3(random, -1, 1));
  }
  std::mt19937 random;
  dvec3 half_size;
  World world;
  CameraState camera;
  dmat4 place, motion;
};

/// How much larger the display now is: by the fastest corner on it, at least a pixel, at most a quarter.
double growth_px(const MovedBox& box) {
  double fastest = 1;
  const dmat4 now = box.motion * box.place;
  for (const dvec3& corner : box_corners(box.half_size)) {
    const auto depth = [&](const dmat4& m) { return -dvec3(m * dvec4(corner, 1)).z; };
    if (!(depth(now) > box.camera.near_m && depth(box.place) > box.camera.near_m)) continue;
    const dvec2 to = project(now, box.world.view, box.camera, corner);
    if (outside_enlarged(to, box.world.view.display_px, dvec2(0)) > 0) continue;
    fastest = std::max(fastest, glm::length(to - project(box.place, box.world.view, box.camera, corner)));
  }
  return std::min(fastest, kMargin * 800);
}

/// The vertices of what both views see of the box's surface, from all its planes and all of theirs.
std::vector<Pair> vertices_in_both_views(const MovedBox& box) {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 n(0.0);
    n[axis] = 1;
    planes.push_back({n, box.half_size[axis]});
    planes.push_back({-n, box.half_size[axis]});
  }
  const dvec2 then_margin_px = layers::kThenMargin * dvec2(box.world.view.display_px);
  for (const Plane& p : view_planes(box.place, box.world.view, box.camera, then_margin_px))
    planes.push_back(p);
  for (const Plane& p :
       view_planes(box.motion * box.place, box.world.view, box.camera, dvec2(growth_px(box))))
    planes.push_back(p);
  std::vector<Pair> vertices;
  for (const dvec3& p : surface_vertices(planes, 6))
    vertices.push_back({project(box.place, box.world.view, box.camera, p),
                        project(box.motion * box.place, box.world.view, box.camera, p)});
  return vertices;
}

bool is_matched(const Correspondences& matched, const Pair& vertex) {
  for (std::size_t i = 0; i < matched.point.size(); ++i)
    if (near(vertex, matched.then_px[i], matched.now_px[i])) return true;
  return false;
}

TEST(CorrespondOracle, TheSurfaceInBothViewsByBruteForce) {
  int clipped_trials = 0, empty_trials = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    MovedBox box(seed);
    const LayerState then = box.world.at(box.place), now = box.world.at(box.motion * box.place);
    const Correspondences matched = correspond(then, now, box.world.bound.hull);
    if (matched.overlap && matched.point.size() == 8 &&
        std::count(matched.point.begin(), matched.point.end(), -1) == 0)
      continue;  // nothing was cut
    const std::vector<Pair> expected = vertices_in_both_views(box);
    EXPECT_EQ(matched.overlap, !expected.empty());
    if (!matched.overlap) {
      ++empty_trials;
      continue;
    }
    ++clipped_trials;
    expect_in_both_views(matched, box.world.view.display_px);
    // Every vertex of the intersection is among the matched points. (The reverse does not hold: diagonals of
    // faces are cut too.) And no matched point lies outside of their bounds.
    layers::RectD bounds;
    for (const Pair& vertex : expected) {
      EXPECT_TRUE(is_matched(matched, vertex)) << vertex.then_px.x << ' ' << vertex.then_px.y;
      bounds.include(vertex.then_px);
    }
    for (const dvec2 p : matched.then_px)
      EXPECT_LT(std::max({bounds.lo.x - p.x, p.x - bounds.hi.x, bounds.lo.y - p.y, p.y - bounds.hi.y}), 1e-4);
  }
  EXPECT_GT(clipped_trials, 100);
  EXPECT_GT(empty_trials, 5);
}

// ---- situations
// -----------------------------------------------------------------------------------------------------

TEST(Correspond, InViewItIsTheCharacteristicPointsInOrder) {
  for (const BoundKind kind : {BoundKind::Box8, BoundKind::Dop14, BoundKind::Dop26}) {
    std::mt19937 random(5);
    std::vector<dvec3> cloud;
    for (int i = 0; i < 30; ++i) cloud.push_back(uniform3(random, -1, 1));
    const World world(cloud, kind);
    const auto matched =
        correspond(world.at(moved_by({0, 0, -8})), world.at(moved_by({0.5, 0, -9})), world.bound.hull);
    ASSERT_GE(matched.point.size(), world.bound.hull.points.size());
    EXPECT_TRUE(matched.overlap);
    for (std::size_t i = 0; i < world.bound.hull.points.size(); ++i) {
      EXPECT_EQ(matched.point[i], static_cast<int>(i));
      const dvec3 then = world.bound.hull.points[i] + dvec3(0, 0, -8);
      EXPECT_LT(glm::length(matched.then_px[i] - project(dmat4(1.0), world.view, {}, then)), 1e-9);
    }
  }
}

TEST(Correspond, AtRestNothingMovesAndEachPointAppearsOnce) {
  // A box cut by one side of the view: 4 corners stay, 4 edges and the diagonals of 4 faces are cut.
  const World world(box_corners({1, 1, 1}));
  const LayerState state = world.at(moved_by({4.85, 0, -10}));
  const auto matched = correspond(state, state, world.bound.hull);
  EXPECT_EQ(matched.point.size(), 12u);
  EXPECT_EQ(std::count(matched.point.begin(), matched.point.end(), -1), 8);
  EXPECT_EQ(matched.then_px, matched.now_px);
  for (std::size_t i = 0; i < matched.point.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(glm::length(matched.then_px[i] - matched.then_px[j]), 1e-6);
  }
}

TEST(Correspond, AtRestTheOwnClipOfTheStateIsTheAnswer) {
  // At rest the display is grown by one pixel: as the view of a state with that margin is.
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    World world(box_corners({3, 2, 8}), BoundKind::Dop26);
    world.view.display_px = {800, 800};
    world.view.clip_margin = 1.0 / 800;
    const LayerState state = world.at(moved_by(uniform3(random, -4, 4)) * random_rotation(random));
    const auto matched = correspond(state, state, world.bound.hull);
    if (!matched.overlap) continue;
    ASSERT_EQ(matched.then_px.size(), state.screen_points.size()) << "seed " << seed;
    for (std::size_t i = 0; i < matched.then_px.size(); ++i)
      EXPECT_LT(glm::length(matched.then_px[i] - state.screen_points[i]), 1e-6) << "seed " << seed;
    EXPECT_EQ(largest_motion(matched), 0) << "seed " << seed;
  }
}

TEST(Correspond, ADomeAroundATurningCamera) {
  // All eight corners are out of view in both states; the faces in view carry the points.
  const World dome(box_corners({1000, 1000, 1000}));
  const LayerState then = dome.at(dmat4(1.0));
  const LayerState now = dome.at(dmat4(1.0), camera_at(turned_by(0.02, {0, 1, 0})));
  const auto matched = correspond(then, now, dome.bound.hull);
  ASSERT_GE(matched.point.size(), 4u);
  EXPECT_TRUE(matched.overlap);
  expect_in_both_views(matched, dome.view.display_px);
  // 0.02 rad are 0.02 · 512 / tan(0.45) = 21 px in the centre, more towards the sides.
  EXPECT_GT(largest_motion(matched), 21);
  EXPECT_LT(largest_motion(matched), 40);
}

TEST(Correspond, ACanyonThatTheCameraFliesThrough) {
  // The walls reach from behind the camera to far ahead: every edge along them crosses the near plane.
  const World canyon(box_corners({3, 3, 400}), BoundKind::Dop14);
  const LayerState then = canyon.at(moved_by({0, 1, 0})), now = canyon.at(moved_by({0, 1, 0.5}));
  ASSERT_TRUE(then.clipped);
  const auto matched = correspond(then, now, canyon.bound.hull);
  EXPECT_GE(matched.point.size(), 8u);
  expect_in_both_views(matched, canyon.view.display_px);
}

TEST(Correspond, OneFarAwayPointDoesNotPoisonTheOthers) {
  // A corner passes the eye: in view then, thousands of pixels away now.
  const World world(box_corners({0.2, 0.2, 3}));
  const LayerState then = world.at(moved_by({0.5, 0, -4})), now = world.at(moved_by({0.5, 0, -3.11}));
  const auto matched = correspond(then, now, world.bound.hull);
  EXPECT_TRUE(matched.overlap);
  expect_in_both_views(matched, world.view.display_px);
}

TEST(Correspond, NothingInCommonHasNoOverlapAndALargeTrueMotion) {
  const World world(box_corners({0.1, 0.1, 0.1}));
  const LayerState then = world.at(moved_by({0, 0, -10})), now = world.at(moved_by({30, 0, -10}));
  const auto matched = correspond(then, now, world.bound.hull);
  EXPECT_FALSE(matched.overlap);
  ASSERT_EQ(matched.point.size(), 8u);
  EXPECT_GT(largest_motion(matched), 1024);
}

TEST(Correspond, ACameraThatTurnedAroundLeavesNoPoint) {
  const World world(box_corners({1, 1, 1}));
  const LayerState then = world.at(moved_by({0, 0, -10}));
  const LayerState now = world.at(moved_by({0, 0, -10}), camera_at(turned_by(3.1415926, {0, 1, 0})));
  const auto matched = correspond(then, now, world.bound.hull);
  EXPECT_TRUE(matched.point.empty());
  EXPECT_FALSE(matched.overlap);
}

TEST(Correspond, StatesWithoutPointsMatchNothing) {
  const World world(box_corners({1, 1, 1}));
  const LayerState good = world.at(moved_by({0, 0, -10}));
  CameraState broken;
  broken.world_from_camera[0][0] = std::numeric_limits<double>::quiet_NaN();
  const LayerState bad = world.at(moved_by({0, 0, -10}), broken);
  for (const auto& matched :
       {correspond(good, bad, world.bound.hull), correspond(bad, good, world.bound.hull),
        correspond(bad, bad, world.bound.hull)}) {
    EXPECT_TRUE(matched.point.empty());
    EXPECT_FALSE(matched.overlap);
  }
  EXPECT_TRUE(bad.screen_points.empty());
}

TEST(Correspond, PointLineAndPlaneHullsThatAreCut) {
  // A line across the view keeps its two crossings, a plane its outline; a point has nothing to cut.
  const World line(box_corners({100, 0, 0}));
  const auto on_line =
      correspond(line.at(moved_by({0, 0, -10})), line.at(moved_by({0, 0.1, -10})), line.bound.hull);
  EXPECT_EQ(on_line.point.size(), 2u);
  const World plane(box_corners({100, 0, 100}));
  const auto on_plane =
      correspond(plane.at(moved_by({0, -1, 0})), plane.at(moved_by({0, -1, 0.2})), plane.bound.hull);
  EXPECT_GE(on_plane.point.size(), 4u);
  expect_in_both_views(on_plane, plane.view.display_px);
  const World point({{0, 0, 0}});
  const auto alone =
      correspond(point.at(moved_by({0, 0, -10})), point.at(moved_by({50, 0, -10})), point.bound.hull);
  EXPECT_FALSE(alone.overlap);
  EXPECT_EQ(alone.point.size(), 1u);
}

TEST(Correspond, ABillionthFromTheNearPlaneStaysFinite) {
  for (const double offset : {-1e-9, 0.0, 1e-9, 1e-6}) {
    const World world(box_corners({0.05, 0.05, 1}));
    const LayerState then = world.at(moved_by({0, 0, -1.1 * (1 + offset)})),
                     now = world.at(moved_by({0, 0, -1.2}));
    const auto matched = correspond(then, now, world.bound.hull);
    EXPECT_TRUE(matched.overlap) << offset;
    expect_in_both_views(matched, world.view.display_px);
  }
}

TEST(Correspond, ScenesOfTenthsOfMillimetresAndOfThousandsOfKilometresLookTheSame) {
  const auto match_at = [](double unit) {
    const World world(box_corners(dvec3(3, 1, 5) * unit), BoundKind::Dop14);
    CameraState camera;
    camera.near_m *= unit;
    camera.far_m *= unit;
    const auto place = [&](double z) { return moved_by(dvec3(1, -2, z) * unit) * turned_by(0.4, {1, 2, 3}); };
    return correspond(world.at(place(-4), camera), world.at(place(-4.3), camera), world.bound.hull);
  };
  const auto metres = match_at(1);
  ASSERT_GT(metres.point.size(), 6u);
  for (const double unit : {1e-4, 1e6}) {
    const auto other = match_at(unit);
    ASSERT_EQ(other.point, metres.point) << unit;
    for (std::size_t i = 0; i < other.point.size(); ++i) {
      EXPECT_LT(glm::length(other.then_px[i] - metres.then_px[i]), 1e-6);
      EXPECT_LT(glm::length(other.now_px[i] - metres.now_px[i]), 1e-6);
    }
  }
}

TEST(Correspond, AHundredThousandKilometresBehindTheEye) {
  // Rounding on an edge that reaches 1e8 m back is larger than the near distance.
  const World world(box_corners({3, 3, 1e8}));
  const auto matched = correspond(world.at(dmat4(1.0)), world.at(moved_by({0.01, 0, 0})), world.bound.hull);
  EXPECT_TRUE(matched.overlap);
  expect_in_both_views(matched, world.view.display_px);
}

/// The largest error of the affine warp that is fitted to the points.
double error_of_fit(const LayerState& then, const LayerState& now, const World& world) {
  const auto matched = correspond(then, now, world.bound.hull);
  return warp::fit(matched.then_px, matched.now_px, warp::Curve::aff).max_px;
}

TEST(Correspond, HowFarSpritesReachChangesNoPoint) {
  // A land that reaches far beyond the display, seen in a turn: its far points are no part of the error.
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    World world(box_corners(uniform3(random, 2, 60)));
    const dmat4 place = moved_by(uniform3(random, -4, 4) + dvec3(0, -6, -30));
    const dmat4 motion = moved_by(uniform3(random, -0.3, 0.3)) * turned_by(0.02, uniform3(random, -1, 1));
    std::vector<double> errors;
    for (const double margin : {0.1, 0.25, 0.5, 1.0}) {
      world.view.clip_margin = margin;
      errors.push_back(error_of_fit(world.at(place), world.at(motion * place), world));
    }
    for (const double error : errors) EXPECT_DOUBLE_EQ(error, errors.front());
  }
}

/// The largest errors and the largest changes of error between steps of a hundredth of a frame, as shares of the
/// motion in one frame: a slab that turns as it crosses the display in 40 frames, so that its corners come in and
/// go out, and what is left of it at the borders loses its spread.
struct Crossing {
  int seen = 0;
  double largest_share = 0, largest_jump_share = 0;
};

Crossing crossing_of_the_display(warp::Curve curve) {
  const World world(box_corners({1, 1.5, 0.3}));
  const auto place = [](double frame) {
    return moved_by({-7 + 0.35 * frame, 0.4, -9}) * turned_by(0.02 * frame, {0, 1, 0.2});
  };
  Crossing crossing;
  double before = 0;
  for (int step = 0; step < 100 * 40; ++step) {
    const double frame = step / 100.0;
    const LayerState then = world.at(place(frame)), now = world.at(place(frame + 1));
    if (!then.touches_display || !now.touches_display) continue;
    const auto matched = correspond(then, now, world.bound.hull);
    EXPECT_TRUE(matched.overlap) << frame;
    const auto fitted = warp::fit(matched.then_px, matched.now_px, curve);
    EXPECT_TRUE(fitted.usable()) << frame;
    const double motion = largest_motion(matched);
    if (crossing.seen++ > 0)
      crossing.largest_jump_share =
          std::max(crossing.largest_jump_share, std::fabs(fitted.max_px - before) / motion);
    before = fitted.max_px;
    crossing.largest_share = std::max(crossing.largest_share, fitted.max_px / motion);
  }
  return crossing;
}

TEST(Correspond, ALayerEntersAndLeavesWithoutAJump) {
  const Crossing crossing = crossing_of_the_display(warp::Curve::affi);
  EXPECT_GT(crossing.seen, 100 * 25);
  EXPECT_LT(crossing.largest_share, 0.2);
  EXPECT_LT(crossing.largest_jump_share, 0.005);
}

TEST(Correspond, ALeastSquaresFitSeesACornerLeaveAsTheCrossingsThatTakeItsPlace) {
  // Where a corner goes out, up to six edges are cut beside it, each a point of its own: it weighs more, and the
  // mean moves. The points are in the same places, so the error is larger by a few percent of the motion only.
  const Crossing crossing = crossing_of_the_display(warp::Curve::aff);
  EXPECT_LT(crossing.largest_share, 0.2);
  EXPECT_LT(crossing.largest_jump_share, 0.05);
}

TEST(ViewHalfSpaces, NotANumberIsOutsideOfAll) {
  const auto view = layers::view_half_spaces(0.1, kMargin, 0);
  EXPECT_EQ(layers::outcode(view, dvec4(std::numeric_limits<double>::quiet_NaN())), 31u);
  EXPECT_EQ(layers::outcode(view, dvec4(0, 0, 0, 1)), 0u);
  EXPECT_EQ(layers::outcode(view, dvec4(0, 0, 0, 0.1)), 1u);
}

}  // namespace
}  // namespace talisman::tests
