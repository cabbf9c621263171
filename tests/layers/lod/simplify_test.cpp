// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/simplify.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/lod/surface_distance.h"
#include "layers/lod/triangle_tree.h"

namespace talisman::tests {
namespace {

using layers::BuiltLadder;
using layers::dvec3;
using layers::LadderOptions;
using layers::Mesh;
using layers::vec2;
using layers::vec3;
using layers::vec4;
using testing::HasSubstr;

/// A sphere about the origin: `n` rings, 2 n segments, seams joined.
Mesh ball(int n, float radius) {
  Mesh mesh;
  const int around = 2 * n;
  mesh.positions.push_back({0, radius, 0});
  for (int i = 1; i < n; ++i)
    for (int k = 0; k < around; ++k) {
      const double a = M_PI * i / n, b = 2 * M_PI * k / around;
      mesh.positions.push_back(radius *
                               vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
    }
  mesh.positions.push_back({0, -radius, 0});
  const auto at = [&](int i, int k) {
    return static_cast<std::uint32_t>(i == 0   ? 0
                                      : i == n ? 1 + (n - 1) * around
                                               : 1 + (i - 1) * around + k % around);
  };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < around; ++k) {
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {at(i, k), at(i, k + 1), at(i + 1, k)});
      if (i + 1 < n) mesh.indices.insert(mesh.indices.end(), {at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  return mesh;
}

/// A square of n × n cells with hills, its border straight.
Mesh land(int n, float height) {
  Mesh mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const bool rim = x == 0 || y == 0 || x == n || y == n;
      mesh.positions.push_back({x, rim ? 0 : height * std::sin(0.9f * x) * std::cos(0.7f * y), y});
    }
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto a = static_cast<std::uint32_t>(y * (n + 1) + x), row = static_cast<std::uint32_t>(n + 1);
      mesh.indices.insert(mesh.indices.end(), {a, a + row, a + 1, a + 1, a + row, a + row + 1});
    }
  return mesh;
}

double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    volume += glm::dot(dvec3(mesh.positions[mesh.indices[i]]),
                       glm::cross(dvec3(mesh.positions[mesh.indices[i + 1]]),
                                  dvec3(mesh.positions[mesh.indices[i + 2]]))) /
              6;
  return volume;
}

Mesh inside_out(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return mesh;
}

void expect_sound(const Mesh& mesh) {
  for (const auto v : mesh.indices) ASSERT_LT(v, mesh.positions.size());
  std::set<std::uint32_t> used(mesh.indices.begin(), mesh.indices.end());
  EXPECT_EQ(used.size(), mesh.positions.size()) << "vertices that nothing uses";
}

TEST(BuildLadder, HalvesABallAndKeepsItABall) {
  const Mesh mesh = ball(24, 2);
  const BuiltLadder built = layers::build_ladder(mesh);
  ASSERT_EQ(built.ladder.levels.size(), 5u);
  ASSERT_EQ(built.coarser.size(), 4u);
  EXPECT_EQ(first_defect(built.ladder), "");
  EXPECT_EQ(built.ladder.levels[0].triangles, mesh.triangle_count());
  EXPECT_EQ(built.ladder.levels[0].error_m, 0);
  for (std::size_t k = 1; k < built.ladder.levels.size(); ++k) {
    const Mesh& level = built.coarser[k - 1];
    expect_sound(level);
    EXPECT_EQ(built.ladder.levels[k].triangles, level.triangle_count());
    EXPECT_EQ(built.ladder.levels[k].vertices, static_cast<std::int64_t>(level.positions.size()));
    EXPECT_GT(signed_volume(level), 0.7 * signed_volume(mesh));
  }
}

/// The vertices of a level lie on the ball, so its farthest points are middles of faces: r - their distance to the middle.
TEST(BuildLadder, ErrorOfABallIsTheDepthOfItsFlattestFace) {
  const BuiltLadder built = layers::build_ladder(ball(40, 2));
  for (std::size_t k = 1; k < built.ladder.levels.size(); ++k) {
    const Mesh& level = built.coarser[k - 1];
    const layers::TriangleTree tree({level.positions.begin(), level.positions.end()}, level.indices);
    const double depth = 2 - tree.distance(dvec3(0));
    EXPECT_NEAR(built.ladder.levels[k].error_m, depth, 0.15 * depth + 0.01) << k;
  }
}

TEST(BuildLadder, LockedBordersStayVertexByVertex) {
  const Mesh mesh = land(16, 1.5f);
  LadderOptions options;
  options.lock_borders = true;
  const BuiltLadder built = layers::build_ladder(mesh, options);
  ASSERT_GE(built.coarser.size(), 1u);
  const auto rim = [](const Mesh& m) {
    std::set<std::pair<float, float>> places;
    for (const vec3& p : m.positions)
      if (p.x == 0 || p.z == 0 || p.x == 16 || p.z == 16) places.insert({p.x, p.z});
    return places;
  };
  for (const Mesh& level : built.coarser) EXPECT_EQ(rim(level), rim(mesh));
  options.lock_borders = false;
  EXPECT_LT(rim(layers::build_ladder(mesh, options).coarser.back()).size(), rim(mesh).size());
}

/// Two halves with texture coordinates of their own: where they meet both have the vertices of the seam, in pairs.
TEST(BuildLadder, SeamsOfTextureCoordinatesStayClosed) {
  Mesh mesh = land(16, 1);
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const vec3& p : mesh.positions) mesh.uvs.emplace_back(p.x / 16, p.z / 16);
  for (std::uint32_t v = count; v < 2 * count; ++v) mesh.uvs[v] += vec2(10, 0);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    float x = 0;
    for (int c = 0; c < 3; ++c) x += mesh.positions[mesh.indices[i + static_cast<std::size_t>(c)]].x / 3;
    if (x > 8)
      for (int c = 0; c < 3; ++c) mesh.indices[i + static_cast<std::size_t>(c)] += count;
  }
  const BuiltLadder built = layers::build_ladder(mesh);
  ASSERT_GE(built.coarser.size(), 2u);
  for (const Mesh& level : built.coarser) {
    expect_sound(level);
    std::set<std::tuple<float, float>> left, right;
    for (std::size_t i = 0; i < level.indices.size(); i += 3) {
      const bool is_right = level.uvs[level.indices[i]].x >= 9;
      for (int c = 0; c < 3; ++c) {
        const auto v = level.indices[i + static_cast<std::size_t>(c)];
        EXPECT_EQ(level.uvs[v].x >= 9, is_right) << "a triangle of both halves";
        if (level.positions[v].x == 8)
          (is_right ? right : left).insert({level.positions[v].y, level.positions[v].z});
      }
    }
    EXPECT_EQ(left, right);
    EXPECT_GE(left.size(), 2u);
  }
}

/// Each triangle has vertices of its own, as STL has them: they are the same in everything and are taken for one.
TEST(BuildLadder, EqualVerticesAreOne) {
  const Mesh shared = ball(16, 1);
  Mesh apart;
  for (const auto v : shared.indices) {
    apart.indices.push_back(static_cast<std::uint32_t>(apart.positions.size()));
    apart.positions.push_back(shared.positions[v]);
  }
  const BuiltLadder a = layers::build_ladder(shared), b = layers::build_ladder(apart);
  ASSERT_EQ(a.ladder.levels.size(), b.ladder.levels.size());
  EXPECT_EQ(b.ladder.levels[0].vertices, static_cast<std::int64_t>(apart.positions.size()));
  for (std::size_t k = 1; k < a.ladder.levels.size(); ++k) {
    EXPECT_EQ(b.coarser[k - 1].positions.size(), static_cast<std::size_t>(b.ladder.levels[k].vertices));
    EXPECT_LT(b.ladder.levels[k].vertices, b.ladder.levels[k].triangles);
  }
}

/// Joints and morph targets of a vertex are those it had.
TEST(BuildLadder, VerticesKeepJointsAndMorphTargets) {
  Mesh mesh = ball(16, 1);
  mesh.morphs.resize(1);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.joints.push_back(glm::uvec4(mesh.positions[v].y > 0 ? 1 : 0, 0, 0, 0));
    mesh.weights.push_back(vec4(1, 0, 0, 0));
    mesh.morphs[0].positions.push_back(0.5f * mesh.positions[v]);
  }
  const BuiltLadder built = layers::build_ladder(mesh);
  ASSERT_GE(built.coarser.size(), 2u);
  for (const Mesh& level : built.coarser) {
    ASSERT_EQ(level.joints.size(), level.positions.size());
    ASSERT_EQ(level.morphs[0].positions.size(), level.positions.size());
    for (std::size_t v = 0; v < level.positions.size(); ++v) {
      EXPECT_EQ(level.joints[v].x, level.positions[v].y > 0 ? 1u : 0u);
      EXPECT_EQ(level.morphs[0].positions[v], 0.5f * level.positions[v]);
    }
  }
  // The target makes it half as large again, and the error with it.
  Mesh rigid = mesh;
  rigid.morphs.clear();
  for (std::size_t k = 1; k < built.ladder.levels.size(); ++k) {
    Mesh level = built.coarser[k - 1];
    level.morphs.clear();
    EXPECT_NEAR(built.ladder.levels[k].error_m, 1.5 * layers::surface_distance(rigid, level).error_m(), 1e-6);
  }
}

TEST(BuildLadder, WhatHasTooFewTrianglesHasNoCoarserLevel) {
  Mesh mesh;
  EXPECT_TRUE(layers::build_ladder(mesh).ladder.levels.empty());
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  const BuiltLadder one = layers::build_ladder(mesh);
  EXPECT_EQ(one.ladder.levels.size(), 1u);
  EXPECT_THAT(one.ended_by, HasSubstr("fewer than 8 triangles"));
}

/// All in one place, or none with an area: no NaN, no level that is not sound.
TEST(BuildLadder, DegenerateMeshesEndWithoutALevelOrWithASoundOne) {
  Mesh line = ball(12, 1);
  for (vec3& p : line.positions) p = vec3(p.y, 0, 0);
  Mesh point = ball(12, 1);
  for (vec3& p : point.positions) p = vec3(3, 3, 3);
  for (const Mesh& mesh : {line, point}) {
    const BuiltLadder built = layers::build_ladder(mesh);
    EXPECT_EQ(first_defect(built.ladder), "");
    for (const Mesh& level : built.coarser) expect_sound(level);
  }
}

TEST(BuildLadder, ScaleIsNoMatter) {
  const BuiltLadder one = layers::build_ladder(ball(16, 1));
  for (const float scale : {1e-4f, 1e6f}) {
    const BuiltLadder built = layers::build_ladder(ball(16, scale));
    ASSERT_EQ(built.ladder.levels.size(), one.ladder.levels.size()) << scale;
    EXPECT_NEAR(built.ladder.levels.back().error_m / scale, one.ladder.levels.back().error_m, 0.05);
  }
}

TEST(BuildLadder, TwiceIsTheSameToTheBit) {
  const BuiltLadder a = layers::build_ladder(land(20, 2)), b = layers::build_ladder(land(20, 2));
  EXPECT_EQ(a.ladder, b.ladder);
  for (std::size_t k = 0; k < a.coarser.size(); ++k) EXPECT_EQ(a.coarser[k].indices, b.coarser[k].indices);
}

TEST(LadderOf, RefusesWhatIsInsideOutEmptyOrTooFine) {
  const Mesh mesh = ball(24, 1), half = ball(12, 1);
  EXPECT_EQ(layers::ladder_of(mesh, {half, ball(6, 1)}).ended_by, "");
  EXPECT_EQ(layers::ladder_of(mesh, {half, ball(6, 1)}).ladder.levels.size(), 3u);
  EXPECT_THAT(layers::ladder_of(mesh, {inside_out(half)}).ended_by,
              HasSubstr("level 1 is turned inside out"));
  EXPECT_THAT(layers::ladder_of(mesh, {Mesh{}}).ended_by, HasSubstr("level 1 is empty"));
  EXPECT_THAT(layers::ladder_of(mesh, {ball(23, 1)}).ended_by, HasSubstr("must be at most half"));
  EXPECT_THAT(layers::ladder_of(mesh, {ball(6, 1), half}).ended_by, HasSubstr("level 2 has"));
  EXPECT_THAT(layers::ladder_of(mesh, {}).ended_by, HasSubstr("one level"));
  EXPECT_THAT(layers::ladder_of(Mesh{}, {half}).ended_by, HasSubstr("level 0 is empty"));
}

TEST(SurfaceDistance, SeesWhatIsMissingAndWhatIsTooMuch) {
  const Mesh mesh = ball(16, 1);
  Mesh two = mesh;  // and a small one, 5 m beside it
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  for (const vec3& p : ball(16, 0.1f).positions) two.positions.push_back(p + vec3(5, 0, 0));
  for (const auto v : mesh.indices) two.indices.push_back(v + count);
  const auto lost = layers::surface_distance(two, mesh), gained = layers::surface_distance(mesh, two);
  EXPECT_NEAR(lost.from_base_m, 4.1, 1e-3);
  EXPECT_NEAR(lost.from_level_m, 0, 1e-6);
  EXPECT_NEAR(gained.from_level_m, 4.1, 1e-3);
  EXPECT_NEAR(gained.error_m(), lost.error_m(), 1e-12);
}

TEST(SurfaceDistance, OfBallsWithinEachOtherIsTheDifferenceOfTheirRadii) {
  const auto distance = layers::surface_distance(ball(48, 1), ball(48, 1.25f));
  EXPECT_NEAR(distance.from_base_m, 0.25, 0.005);
  EXPECT_NEAR(distance.from_level_m, 0.25, 0.005);
  EXPECT_NEAR(distance.facing, 1, 0.02);
}

/// Front and back of a sheet lie on each other: either is right.
TEST(SurfaceDistance, ASheetOfTwoSidesIsNotInsideOut) {
  Mesh sheet = land(8, 0);
  const Mesh other = inside_out(sheet);
  sheet.indices.insert(sheet.indices.end(), other.indices.begin(), other.indices.end());
  EXPECT_NEAR(layers::surface_distance(sheet, sheet).facing, 1, 1e-9);
  EXPECT_NEAR(layers::surface_distance(land(8, 0), other).facing, -1, 1e-9);
}

TEST(TriangleTree, IsAsNearAsTheNearestOfAllTriangles) {
  const Mesh mesh = land(12, 2);
  const std::vector<dvec3> at(mesh.positions.begin(), mesh.positions.end());
  const layers::TriangleTree tree(at, mesh.indices);
  for (int i = 0; i < 500; ++i) {
    const dvec3 p{std::fmod(i * 0.37, 14.0) - 1, std::fmod(i * 0.11, 6.0) - 3, std::fmod(i * 0.53, 14.0) - 1};
    double nearest = HUGE_VAL;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
      for (int s = 0; s <= 60; ++s)
        for (int u = 0; s + u <= 60 && i % 20 == 0; ++u)  // by many points of each
          nearest = std::min(nearest, glm::distance(p, at[mesh.indices[t]] * ((60 - s - u) / 60.0) +
                                                           at[mesh.indices[t + 1]] * (s / 60.0) +
                                                           at[mesh.indices[t + 2]] * (u / 60.0)));
    if (i % 20 != 0) continue;
    EXPECT_LE(tree.distance(p), nearest + 1e-12);
    EXPECT_GE(tree.distance(p), nearest - 0.05);
  }
}

}  // namespace
}  // namespace talisman::tests
