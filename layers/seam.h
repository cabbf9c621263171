// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where can a crack open between layers that share an edge, and what closes it?
///
/// A land that is cut into layers is whole as long as all are drawn for one frame. Each sprite is then carried by a warp
/// of its own, which is off by up to its layer's threshold g (px on the display): along the cut between A and B a crack
/// of up to g_A + g_B may open, and the two edges, each smoothed over a pixel, let through what is behind [LS97 7.2].
///
/// What closes it: each of the two layers also draws what the other has beyond the cut, as far as its own share reaches
/// on the display in any frame in which the cut is in view:
///
///   reach = g + kFilter_px / resolution        of A into B, and of B into A by its own
///
/// It is the neighbour's own surface, its triangles, material and texture, so that nothing is seen that is not there: no
/// outline changes, and a hill stays one. Triangles that reach farther are cut off there, by a straight line; where the
/// reach bulges beyond it they are halved first. What is seen at a grazing angle reaches far in metres: a pixel there is long.
///
/// An edge is shared where it is at the rim of A (one triangle of A has it) and is an edge of B, and both are rigid,
/// opaque and move together: ends coincide to kSameplace of the scene's size.

#include <string>
#include <vector>

#include "layers/layer.h"

namespace talisman::layers {

/// For the filter of the compositor and a texel that is stretched: pixels at one texel per pixel.
inline constexpr double kFilter_px = 2;
inline constexpr double kSameplace = 1e-6;

/// Does the layer draw seams? They are the last body of its bound, and the order of layers leaves them out: they hide
/// nothing that their own layers do not.
bool has_seams(const Scene& scene, const Layer& layer);

/// One edge between two layers.
struct SharedEdge {
  int layer = -1, neighbour = -1;  ///< ids; `layer` ends here
  int part = -1;                   ///< of the neighbour: what lies beyond
  dvec3 a{0}, b{0};                ///< world, at time 0
  int carrier = -1;                ///< the node with which both move; -1: they stand still
};

/// All edges at which a geometry layer meets another, in both directions. Seam parts do not count. Cost: O(triangles).
std::vector<SharedEdge> shared_edges(const Scene& scene, const LayerSet& set);

/// An edge on the display at one frame; the part before the near plane.
struct ScreenEdge {
  dvec2 a_px{0}, b_px{0};
  bool in_view = false;  ///< some of it is on the display
};
ScreenEdge screen_edge(const SceneFrame& frame, const SharedEdge& edge, const std::vector<dmat4>& world_at_0,
                       ivec2 display_px);

/// From how far apart a point is to be filled.
struct SeamOptions {
  double geometric_px = 4;  ///< threshold of the run, ≥ 0; a layer's own is this over its importance
  double fps = 24;
  int frames = 1;  ///< of the sequence, of which kMostViews are looked at
  ivec2 display_px{1024, 1024};
};
inline constexpr int kMostViews = 48;
inline constexpr double kLeastImportance = 0.125;  ///< whoever is less important reaches no farther

/// What one layer gets of one part of a neighbour.
struct SeamPiece {
  int layer = -1;
  Mesh mesh;
  Part part;  ///< without a mesh index
};

/// How far a layer reaches over its edges, px.
double seam_reach_px(const Layer& layer, const SeamOptions& options);

/// The pieces that close all cracks. Cost: O(frames looked at · triangles in reach · edges of the cut).
std::vector<SeamPiece> seam_pieces(const Scene& scene, const LayerSet& set, const SeamOptions& options);

}  // namespace talisman::layers
