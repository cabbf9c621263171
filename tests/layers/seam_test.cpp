// SPDX-License-Identifier: Apache-2.0
// Edges that layers share, and what each of them draws beyond.
#include "layers/seam.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/polyhedron.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A square of 10 m in z = 0, of 2 triangles, in its own space around its origin.
Mesh square() {
  Mesh mesh;
  mesh.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// Two of them side by side, the cut at x = 5, seen straight from 50 m before the cut's middle: with a field of view of
/// 2 atan(1) and a display of 200 px, a metre is 2 px.
struct Tiles {
  Scene scene;
  std::vector<LayerSpec> specs = {{"left", {"left"}, OrderGroup::Normal, {}},
                                  {"right", {"right"}, OrderGroup::Normal, {}}};
  SeamOptions options;

  Tiles() {
    scene.meshes = {square()};
    scene.materials.resize(1);
    Node left, right, eye;
    left.name = "left";
    right.name = "right";
    right.local.translation = {10, 0, 0};
    eye.name = "eye";
    eye.local.translation = {5, 0, 50};
    scene.nodes = {left, right, eye};
    scene.parts = {{"left", 0, 0, 0, -1}, {"right", 1, 0, 0, -1}};
    scene.cameras.emplace_back();
    scene.cameras[0].node = 2;
    scene.cameras[0].fov_y_rad = 2 * std::atan(1.0);
    options.display_px = {200, 200};
    options.geometric_px = 1;
  }
  LayerSet set() const { return factor(scene, specs); }
  std::vector<SeamPiece> pieces() const { return seam_pieces(scene, set(), options); }
};

TEST(SharedEdges, OfTwoTilesAreTheCutSeenFromBothSides) {
  const Tiles tiles;
  const std::vector<SharedEdge> edges = shared_edges(tiles.scene, tiles.set());
  ASSERT_THAT(edges, SizeIs(2));
  for (const SharedEdge& edge : edges) {
    EXPECT_NE(edge.layer, edge.neighbour);
    EXPECT_EQ(edge.part, edge.neighbour);
    EXPECT_EQ(edge.a.x, 5);
    EXPECT_EQ(edge.b.x, 5);
    EXPECT_EQ(std::fabs(edge.a.y - edge.b.y), 10);
  }
}

TEST(SharedEdges, InsideALayerThereIsNone) {
  Tiles tiles;
  tiles.specs = {{"both", {"*"}, OrderGroup::Normal, {}}};
  EXPECT_THAT(shared_edges(tiles.scene, tiles.set()), IsEmpty());
}

TEST(SharedEdges, WhatDoesNotTouchMoveTogetherOrHideSharesNone) {
  Tiles apart;
  apart.scene.nodes[1].local.translation.x = 10.01;
  EXPECT_THAT(shared_edges(apart.scene, apart.set()), IsEmpty());
  Tiles moving;
  moving.scene.tracks.push_back({1, SpinTrack{{0, 0, 1}, 1}});
  EXPECT_THAT(shared_edges(moving.scene, moving.set()), IsEmpty());
  Tiles glass;
  glass.scene.materials[0].opacity = 0.5f;
  EXPECT_THAT(shared_edges(glass.scene, glass.set()), IsEmpty());
}

TEST(SharedEdges, RoundingOfNodesIsNoGap) {
  // The same cut by other sums: 0.1 + 0.2 is not 0.3.
  Tiles tiles;
  tiles.scene.nodes[0].local.translation = {0.3, 0.1, 0};
  tiles.scene.nodes[1].local.translation = {10 + 0.1 + 0.2, 0.1, 0};
  EXPECT_THAT(shared_edges(tiles.scene, tiles.set()), SizeIs(2));
}

TEST(SeamReach, IsTheLayersOwnThresholdAndTheFiltersReach) {
  Layer layer;
  SeamOptions options;
  options.geometric_px = 0.8;
  EXPECT_DOUBLE_EQ(seam_reach_px(layer, options), 0.8 + 2);
  layer.preferences.importance.geometric = 2;
  layer.preferences.resolution_scale = 0.5;
  EXPECT_DOUBLE_EQ(seam_reach_px(layer, options), 0.4 + 4);
  layer.preferences.importance.geometric = 0;  // any displacement is allowed: as far as an eighth's
  EXPECT_DOUBLE_EQ(seam_reach_px(layer, options), 6.4 + 4);
}

TEST(SeamPieces, ReachAsFarAsTheyMustAndNotMuchFarther) {
  // 1 + 2 px at 2 px/m are 1.5 m: what lies that near the cut is there, and hardly more.
  const Tiles tiles;
  const std::vector<SeamPiece> pieces = tiles.pieces();
  ASSERT_THAT(pieces, SizeIs(2));
  EXPECT_EQ(pieces[0].part.name, "seam of left over right");
  EXPECT_EQ(pieces[0].part.node, 1) << "in the space of what it copies";
  EXPECT_TRUE(pieces[0].part.is_seam);
  // In the right tile's space the cut is at x = -5. Each place within 1.5 m is covered: count by samples.
  const Mesh& mesh = pieces[0].mesh;
  const auto covers = [&](const dvec2& p) {
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      dvec2 corner[3];
      for (int k = 0; k < 3; ++k) corner[k] = dvec2(mesh.positions[mesh.indices[3 * t + k]]);
      const auto side = [](const dvec2& a, const dvec2& b, const dvec2& q) {
        return (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x);
      };
      if (side(corner[0], corner[1], p) >= -1e-6 && side(corner[1], corner[2], p) >= -1e-6 &&
          side(corner[2], corner[0], p) >= -1e-6)
        return true;
    }
    return false;
  };
  for (double y = -4.95; y < 5; y += 0.1)
    for (double x = 0.05; x < 1.5; x += 0.1) EXPECT_TRUE(covers({-5 + x, y})) << x << " m beyond, at " << y;
  for (const vec3& p : mesh.positions) EXPECT_LE(p.x, 5.0f);
  double farthest = 0;
  for (const std::uint32_t i : mesh.indices) farthest = std::max(farthest, mesh.positions[i].x + 5.0);
  EXPECT_LE(farthest, 1.5 * 1.01);
}

TEST(SeamPieces, AreTheNeighboursOwnSurface) {
  // Texture coordinates run on as in the tile: u = (x + 5) / 10, v = (5 - y) / 10.
  const Tiles tiles;
  for (const SeamPiece& piece : tiles.pieces()) {
    ASSERT_EQ(piece.mesh.uvs.size(), piece.mesh.positions.size());
    for (std::size_t i = 0; i < piece.mesh.positions.size(); ++i) {
      EXPECT_NEAR(piece.mesh.uvs[i].x, (piece.mesh.positions[i].x + 5) / 10, 1e-6);
      EXPECT_NEAR(piece.mesh.uvs[i].y, (5 - piece.mesh.positions[i].y) / 10, 1e-6);
      EXPECT_EQ(piece.mesh.positions[i].z, 0);
      EXPECT_EQ(piece.mesh.normals[i], vec3(0, 0, 1));
    }
  }
}

TEST(SeamPieces, OfCutsThatAreNeverSeenThereAreNone) {
  Tiles tiles;
  tiles.scene.nodes[2].local.translation = {5, 0, -50};  // looks away
  EXPECT_THAT(tiles.pieces(), IsEmpty());
}

TEST(SeamPieces, GrazingViewsReachFarther) {
  // From 2 m above the ground that the tiles are, across the cut: a pixel is long in metres.
  Tiles straight, grazing;
  grazing.scene.nodes[2].local.translation = {-4, 0, 2};
  grazing.scene.nodes[2].local.rotation =
      glm::angleAxis(-M_PI / 2, dvec3(0, 0, 1)) * glm::angleAxis(M_PI / 2 - 0.1, dvec3(1, 0, 0));
  const auto farthest = [](const std::vector<SeamPiece>& pieces) {
    double x = 0;
    for (const SeamPiece& piece : pieces)
      if (piece.layer == 0)
        for (const std::uint32_t i : piece.mesh.indices) x = std::max(x, piece.mesh.positions[i].x + 5.0);
    return x;
  };
  ASSERT_THAT(grazing.pieces(), SizeIs(2));
  EXPECT_GT(farthest(grazing.pieces()), 0);
  straight.options.geometric_px = 4;
  EXPECT_GT(farthest(straight.pieces()), farthest(Tiles().pieces())) << "more may open";
}

TEST(SeamBound, IsTheLastBodyAndTheSceneIsSound) {
  Tiles tiles;
  for (SeamPiece& piece : tiles.pieces()) {
    tiles.specs[static_cast<std::size_t>(piece.layer)].part_globs.push_back(piece.part.name);
    piece.part.mesh = static_cast<int>(tiles.scene.meshes.size());
    tiles.scene.meshes.push_back(piece.mesh);
    tiles.scene.parts.push_back(piece.part);
  }
  ASSERT_EQ(first_defect(tiles.scene), "");
  const LayerSet set = tiles.set();
  ASSERT_EQ(set.defect, "");
  const LayerBound bound = make_layer_bound(tiles.scene, set.layers[0], BoundKind::Box8);
  EXPECT_TRUE(has_seams(tiles.scene, set.layers[0]));
  ASSERT_THAT(bound.bodies, SizeIs(2));
  EXPECT_TRUE(bound.bodies[0].fixed());
  EXPECT_EQ(bound.bodies[1].parts, std::vector<int>{2});
  // Seams of seams there are none, and what they cover is no edge of a layer.
  EXPECT_THAT(shared_edges(tiles.scene, set), SizeIs(2));
}

}  // namespace
}  // namespace talisman::layers
