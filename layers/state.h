// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What one layer looked like at one instant, and how two instants correspond.
///
/// A `LayerState` holds all that determines a layer's pixels. `then` always is the state at the layer's last
/// *render*, never the last frame. `correspond(then, now)` gives the matched screen positions of material
/// points from which a warp is fitted.
///
/// Which points [LS97 3.1, Fig. 13]. An error that nobody sees is no error: what is judged is the display now,
/// grown on each side by the layer's motion in one frame (at least one pixel). Where the whole polyhedron is
/// on it, and was not far outside the display then: its vertices, the characteristic points. Otherwise the
/// vertices of that part of the polyhedron's surface that is on the grown display now and was within
/// kThenMargin displays of it then: its triangles are clipped by the five half-spaces of each (layers/clip.h),
/// and every vertex that results (kept vertex, crossing of an edge, edge of a view that pierces a triangle) is
/// one material point, evaluated in both states. How far sprites reach (View::clip_margin, extents) takes no
/// part, so that no error rises with larger extents. Content that was not in the old sprite is the business
/// of the visibility fiducial, not of the fit.
///
/// To these come, where depths have changed so unequally that it shows, the places between them that move
/// otherwise than an affine map of the corners says (layers/foreshortening.h), and the material points of what
/// deforms (layers/surface_samples.h), as far as they are in both views: the vertices of its polyhedron are
/// those of its bounds, which may stand still while it moves. A body that deforms is judged by an estimate, then; a rigid one has none of them.
///
/// Where no part is in both views there is nothing to fit. Then `overlap` is false, and the points are those
/// that are in view in either state, however far away they are in the other: the error they give is large,
/// and true. A point with w ≤ near in either state never enters.

#include <span>
#include <vector>

#include "layers/clip.h"
#include "layers/inline_vector.h"
#include "layers/polyhedron.h"

namespace talisman::layers {

/// The display as the decision side sees it.
struct View {
  ivec2 display_px{1024, 1024};
  /// The view to which polyhedra are clipped, and beyond which no sprite reaches, is larger by this share of
  /// the display on each side. Range 0 … 1 (more in the states of layers with whole extents); more keeps
  /// sprites longer.
  double clip_margin = 0.25;
  bool operator==(const View&) const = default;
};

/// clip = clip_from_world · world; x and y in -w … w span the display (y up), depth -w … w from near to far
/// (OpenGL convention); w is the depth along the view axis. A display without area counts as one of 1 × 1.
dmat4 clip_from_world(const CameraState& camera, ivec2 display_px);

/// Display position of a clip-space point with w > 0.
inline dvec2 screen_from_clip(const dvec4& clip, ivec2 display_px) {
  return {(0.5 + 0.5 * clip.x / clip.w) * display_px.x, (0.5 - 0.5 * clip.y / clip.w) * display_px.y};
}

/// Something that moves over a surface without the surface moving: the shadow of one caster, a highlight, the
/// mirrored picture of one layer. Its characteristic places in the receiver's own space
/// (layers/shade_state.h).
struct ShadeTrace {
  enum class Kind { Shadow, Highlight, Reflection };
  Kind kind = Kind::Shadow;
  int light = -1;             ///< index into Scene::lights (Shadow, Highlight)
  int source = -1;            ///< id of the layer that casts or is mirrored
  bool on_receiver = false;   ///< they may touch the receiver
  std::vector<dvec3> places;  ///< NaN where there is none
};

/// A material point whose light is followed.
struct LitPlace {
  SurfacePlace at;       ///< world
  dvec3 color{0, 0, 0};  ///< shaded, linear light 0 … 1
};

/// A frame of a moving picture.
struct ShownPicture {
  int picture = -1;  ///< index into Scene::moving_pictures
  int frame = 0;     ///< of the source
  bool operator==(const ShownPicture&) const = default;
};

struct LayerState {
  int layer = -1;
  double time_s = 0;
  View view;
  CameraState camera;
  std::vector<dvec3> world_points;  ///< characteristic points; none if empty or not finite
  std::vector<dvec4> clip_points;   ///< the same in clip space
  /// On the display: the vertices of the polyhedron's surface clipped to the enlarged view. Where nothing is
  /// clipped those are the characteristic points, by index. Empty: out of view.
  std::vector<dvec2> screen_points;
  std::vector<dmat4> world_from_part;  ///< of each part's node, joint palettes of skinned parts appended
  std::vector<LightState> lights;      ///< empty where no part of the layer is lit
  /// Of each body of the bound (one without bodies): the space that it turns with. Empty unless the bound
  /// asks for it (LayerBound::surface, follows_faces).
  std::vector<dmat4> world_from_body;
  std::vector<dvec3> world_normals;  ///< of the characteristic points; empty without LayerBound::surface
  std::vector<dvec3> point_colors;   ///< likewise: the shaded characteristic points, linear light 0 … 1
  std::vector<dvec4> material_clip;  ///< material points of bodies that deform, in clip space
  std::vector<LitPlace> lit_places;  ///< material points of all bodies; empty without LayerBound::surface
  RectD screen_bounds_px;            ///< of the polyhedron clipped to the enlarged view; empty: out of view
  bool touches_display = false;      ///< screen_bounds_px overlaps the display itself
  bool clipped = false;              ///< part of the polyhedron is in the enlarged view, and part is not
  dvec2 motion_px{0, 0};   ///< of layers with an open shutter: their mean motion on the display in a frame
  double nearest_w_m = 0;  ///< smallest w (depth along the view axis) of the clipped solid; 0: out of view

  dvec3 eye() const { return dvec3(camera.world_from_camera[3]); }
  /// Of layers whose pixels depend on more than their own parts; empty for all others.
  std::vector<dmat4> world_from_influence;  ///< as world_from_part, of the parts that cast or are mirrored
  dmat4 world_from_receiver{1.0};           ///< space of the traces
  std::vector<ShadeTrace> traces;
  std::vector<ShownPicture> pictures;  ///< by index: on its own parts and, where it mirrors others, on theirs

  bool in_view() const { return !screen_bounds_px.empty(); }
  /// True if the two states would be rendered to the same pixels: same layer, camera, view, part matrices,
  /// influences, pictures, motion and lights, compared exactly. The time is not compared. NaN is never the same.
  bool same_pixels(const LayerState& other) const;
};

/// Captures the layers of one frame: what they share is worked out once. Holds a reference to the frame.
class FrameCapture {
 public:
  FrameCapture(const SceneFrame& frame, const View& view);

  /// `state` becomes that of `layer`, whatever it was; it keeps its memory, so that states which are used
  /// again allocate nothing.
  void capture(const Layer& layer, const LayerBound& bound, LayerState& state) const;
  /// `state` becomes one out of view of which nothing else is known.
  void leave_out(const Layer& layer, LayerState& state) const;

 private:
  void capture_points(const LayerBound& bound, LayerState& state) const;
  void capture_samples(const LayerBound& bound, LayerState& state) const;
  void capture_shading(const LayerBound& bound, LayerState& state) const;
  void capture_bounds(const Polyhedron& hull, const ViewHalfSpaces& half_spaces, LayerState& state) const;

  const SceneFrame& frame_;
  View view_;
  dmat4 clip_from_world_;
  ViewHalfSpaces half_spaces_;
  double whole_margin_;  ///< of the view of layers with whole extents
  bool shows_anything_;  ///< camera and display are such that something can be in view
};

/// The state of `layer` at `frame`. A camera or geometry that is not finite, near ≤ 0, or a display without
/// area gives a state out of view. Cost: O(characteristic points) for a fixed bound inside the view; clipping
/// adds O(triangles · 5); a bound with a surface O(triangles + points · lights).
LayerState capture(const SceneFrame& frame, const Layer& layer, const LayerBound& bound, const View& view);

/// The scene's lights as they act on the layer's sprite, by index: one that it does not hold (layers/shading.h)
/// is black, and the same whatever it does.
std::vector<LightState> lights_on(const SceneFrame& frame, const Layer& layer);

/// World matrices of the nodes of `parts`, morph weights (16 to a matrix) and joint palettes of those that have
/// them appended: all that moves them.
std::vector<dmat4> part_matrices(const SceneFrame& frame, std::span<const int> parts);
/// The same, appended.
void append_part_matrices(const SceneFrame& frame, std::span<const int> parts, std::vector<dmat4>& matrices);

/// Matched screen points of the same material points, in pixels. Only finite points with w > near in both
/// states.
struct Correspondences {
  static constexpr std::size_t kRoom = 24;
  InlineVector<dvec2, kRoom> then_px;
  InlineVector<dvec2, kRoom> now_px;
  InlineVector<int, kRoom> point;  ///< index of the characteristic point, -1 for a point between them; the
                                   ///< material points are counted behind the characteristic ones
  bool overlap = false;            ///< some part of the polyhedron is in both views; false:
      ///< nothing of what the old sprite shows is in view now, and no warp of it can serve
};

/// How far outside the display then, in displays, a point may have been that is matched now: as far as extents
/// may reach.
inline constexpr double kThenMargin = 1;

/// `frames` ≥ 0 lie between the states. The order is that of the polyhedron's points or triangles, the same
/// for every run. Cost: O(characteristic points) if all are on the display; else O(hull triangles · 10).
Correspondences correspond(const LayerState& then, const LayerState& now, const Polyhedron& hull,
                           int frames = 1);

/// World bounds of the characteristic points, for sorting.
WorldBounds bounds_of(std::span<const dvec3> points);

}  // namespace talisman::layers
