// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What one layer looked like at one instant, and how two instants correspond.
///
/// A `LayerState` holds all that determines a layer's pixels. `then` always is the state at the layer's last *render*,
/// never the last frame. `correspond(then, now)` gives the matched screen positions of material points from which a
/// warp is fitted: the characteristic points where the whole polyhedron is in view in both states, and otherwise the
/// vertices of the polyhedron clipped to the enlarged frustum, for each state's own clip, as the same material points
/// in both states [LS97 3.1, Fig. 13]. A point with w ≤ near in either state never enters.

#include <span>
#include <vector>

#include "layers/polyhedron.h"

namespace talisman::layers {

/// The display as the decision side sees it.
struct View {
  ivec2 display_px{1024, 1024};
  double clip_margin = 0.25;   ///< the frustum to which polyhedra are clipped is larger by this share of the display on each
                               ///< side; range 0 … 1; more keeps sprites longer and makes the error bound looser
};

/// clip = clip_from_world · world; x and y in -w … w span the display, depth -w … w from near to far (OpenGL convention).
dmat4 clip_from_world(const CameraState& camera, ivec2 display_px);

/// Display position of a clip-space point with w > 0.
dvec2 screen_from_clip(const dvec4& clip, ivec2 display_px);

struct LayerState {
  int layer = -1;
  double time_s = 0;
  View view;
  CameraState camera;
  std::vector<dvec3> world_points;       ///< characteristic points
  std::vector<dvec4> clip_points;        ///< the same in clip space
  std::vector<dmat4> world_from_part;    ///< node matrix of each part, joint palettes appended for skinned parts
  std::vector<LightState> lights;        ///< empty where no part of the layer is lit
  RectD screen_bounds_px;                ///< of the polyhedron clipped to the enlarged frustum; empty: out of view
  bool touches_display = false;          ///< screen_bounds_px overlaps the display itself
  bool clipped = false;                  ///< the polyhedron crosses the enlarged frustum's sides or the near plane
  double nearest_w_m = 0;                ///< smallest w (depth along the view axis) of the clipped polyhedron

  /// True if the two states would be rendered to the same pixels: same camera, view, part matrices and lights.
  /// The time is not compared.
  bool same_pixels(const LayerState& other) const;
};

/// Cost: O(characteristic points) for a rigid layer inside the view; clipping adds O(triangles · 6).
LayerState capture(const SceneFrame& frame, const Layer& layer, const LayerBound& bound, const View& view);

/// Matched screen points of the same material points, in pixels. Only finite points with w > near in both states.
struct Correspondences {
  std::vector<dvec2> then_px;
  std::vector<dvec2> now_px;
  std::vector<int> point;      ///< index of the characteristic point, or -1 for a point made by clipping
};

/// Cost: O(characteristic points) if neither state is clipped; else O(hull triangles · 6) for each clipped state.
Correspondences correspond(const LayerState& then, const LayerState& now, const Polyhedron& hull);

/// The screen positions of the vertices of the polyhedron clipped to the enlarged frustum (all characteristic points
/// when nothing is clipped).
std::vector<dvec2> clipped_screen_points(const LayerState& state, const Polyhedron& hull);

/// World bounds of the characteristic points, for sorting.
WorldBounds bounds_of(std::span<const dvec3> points);

}  // namespace talisman::layers
