// SPDX-License-Identifier: Apache-2.0
#include "layers/state.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "layers/built_effects.h"
#include "layers/clip.h"
#include "layers/moving_picture.h"
#include "layers/shading.h"

namespace talisman::layers {
namespace {

bool is_finite(const dvec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

bool can_be_seen(const CameraState& camera, const View& view) {
  return camera.near_m > 0 && std::isfinite(camera.near_m) && view.display_px.x > 0 &&
         view.display_px.y > 0 && view.clip_margin >= 0 && std::isfinite(view.clip_margin);
}

/// Is the point of the view axis at the near distance inside the solid? (x, y, w) is an affine image of the
/// world, so the solid is inside of its triangles there too, or outside of all of them where the image is
/// mirrored.
bool contains_nearest_point(const LayerState& state, const Polyhedron& hull) {
  const dvec3 eye_point(0, 0, state.camera.near_m);
  const auto from_eye_point = [&](int i) {
    const dvec4& clip = state.clip_points[i];
    return dvec3(clip.x, clip.y, clip.w) - eye_point;
  };
  bool some_inside = false, some_outside = false;
  for (const auto& [a, b, c] : hull.triangles) {
    const double volume = dot(from_eye_point(a), cross(from_eye_point(b), from_eye_point(c)));
    some_inside = some_inside || volume > 0;
    some_outside = some_outside || volume < 0;
  }
  return some_inside != some_outside;
}

/// Points in view: finite, so that RectD::include with its care for NaN is not needed.
void include_visible(const dvec4& clip, LayerState& state) {
  const dvec2 p = screen_from_clip(clip, state.view.display_px);
  RectD& bounds = state.screen_bounds_px;
  state.nearest_w_m = state.in_view() ? std::min(state.nearest_w_m, clip.w) : clip.w;
  bounds.lo = {std::min(p.x, bounds.lo.x), std::min(p.y, bounds.lo.y)};
  bounds.hi = {std::max(p.x, bounds.hi.x), std::max(p.y, bounds.hi.y)};
  state.screen_points.push_back(p);
}

/// Everything but the memory of the vectors.
void forget(LayerState& state) {
  state.world_points.clear();
  state.clip_points.clear();
  state.screen_points.clear();
  state.world_from_part.clear();
  state.lights.clear();
  state.world_from_body.clear();
  state.world_normals.clear();
  state.point_colors.clear();
  state.material_clip.clear();
  state.lit_places.clear();
  state.world_from_influence.clear();
  state.traces.clear();
  state.pictures.clear();
  state.world_from_receiver = dmat4(1.0);
  state.screen_bounds_px = {};
  state.touches_display = state.clipped = false;
  state.nearest_w_m = 0;
  state.motion_px = dvec2(0);
}

/// The morph weights of the parts, 16 to a matrix: they tell apart what matrices tell apart.
void append_morphs(const SceneFrame& frame, std::span<const int> parts, std::vector<dmat4>& matrices) {
  for (const int part : parts) {
    const std::vector<double> weights = morph_weights(frame, frame.scene->parts[part]);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (k % 16 == 0) matrices.push_back(dmat4(0.0));
      matrices.back()[static_cast<int>(k % 16 / 4)][static_cast<int>(k % 4)] = weights[k];
    }
  }
}

/// The margin of a view that reaches kWholeView_rad to all sides.
double whole_margin(const CameraState& camera, const View& view) {
  const double aspect = std::max(view.display_px.x, 1) / static_cast<double>(std::max(view.display_px.y, 1));
  const double smaller = std::tan(camera.fov_y_rad / 2) * std::min(1.0, aspect);
  return std::max(view.clip_margin, (std::tan(kWholeView_rad) / smaller - 1) / 2);
}

bool overlaps_display(const RectD& bounds, ivec2 display_px) {
  return !bounds.empty() && bounds.lo.x < display_px.x && bounds.hi.x > 0 && bounds.lo.y < display_px.y &&
         bounds.hi.y > 0;
}

}  // namespace

dmat4 clip_from_world(const CameraState& camera, ivec2 display_px) {
  const double aspect = std::max(display_px.x, 1) / static_cast<double>(std::max(display_px.y, 1));
  const double focal = 1 / std::tan(camera.fov_y_rad / 2);
  const double depth = camera.far_m - camera.near_m;
  dmat4 clip_from_camera(0.0);
  clip_from_camera[0][0] = focal / aspect;
  clip_from_camera[1][1] = focal;
  clip_from_camera[2][2] = -(camera.far_m + camera.near_m) / depth;
  clip_from_camera[2][3] = -1;
  clip_from_camera[3][2] = -2 * camera.far_m * camera.near_m / depth;
  return clip_from_camera * inverse(camera.world_from_camera);
}

bool LayerState::same_pixels(const LayerState& other) const {
  return layer == other.layer && camera == other.camera && view == other.view &&
         world_from_part == other.world_from_part && lights == other.lights &&
         world_from_influence == other.world_from_influence && pictures == other.pictures &&
         motion_px == other.motion_px;
}

FrameCapture::FrameCapture(const SceneFrame& frame, const View& view)
    : frame_(frame),
      view_(view),
      clip_from_world_(clip_from_world(frame.camera, view.display_px)),
      half_spaces_(view_half_spaces(frame.camera.near_m, view.clip_margin, 0)),
      whole_margin_(whole_margin(frame.camera, view)),
      shows_anything_(can_be_seen(frame.camera, view)) {}

void FrameCapture::capture_points(const LayerBound& bound, LayerState& state) const {
  if (shows_anything_) append_world_points(frame_, bound, state.world_points);
  state.clip_points.reserve(state.world_points.size());
  for (const dvec3& p : state.world_points) state.clip_points.push_back(clip_from_world_ * dvec4(p, 1));
  if (std::all_of(state.clip_points.begin(), state.clip_points.end(), is_finite)) return;
  state.world_points.clear();
  state.clip_points.clear();
}

/// Material points: for the motion of bodies that deform, and for the light of all where that is followed.
void FrameCapture::capture_samples(const LayerBound& bound, LayerState& state) const {
  const bool shaded = is_built(Effect::ColorWarp) && bound.surface;
  std::vector<SurfacePlace> places;
  for_each_body(bound, [&](const LayerBound& body) {
    if (body.samples.empty() || (body.fixed() && !shaded)) return;
    places.clear();
    append_sample_places(frame_, body.samples, places);
    for (const SurfacePlace& place : places) {
      if (!body.fixed()) state.material_clip.push_back(clip_from_world_ * dvec4(place.position, 1));
      if (shaded) state.lit_places.push_back({place, {}});
    }
  });
}

/// Normals and colours of the characteristic points, where the bound asks for them.
void FrameCapture::capture_shading(const LayerBound& bound, LayerState& state) const {
  const bool shaded = is_built(Effect::ColorWarp) && bound.surface;
  if (state.world_points.empty() || !(shaded || bound.follows_faces)) return;
  append_world_from_bodies(frame_, bound, state.world_from_body);
  if (!shaded) return;
  state.world_normals.resize(state.world_points.size());
  point_normals(state.world_points, bound.hull, state.world_from_body, state.world_normals);
  state.point_colors.reserve(state.world_points.size());
  const dvec3 eye = state.eye();
  for (std::size_t i = 0; i < state.world_points.size(); ++i)
    state.point_colors.push_back(
        shaded_color(*bound.surface, state.lights, {state.world_points[i], state.world_normals[i], eye}));
  for (LitPlace& place : state.lit_places)
    place.color = shaded_color(*bound.surface, state.lights, {place.at.position, place.at.normal, eye});
}

void FrameCapture::capture_bounds(const Polyhedron& hull, const ViewHalfSpaces& half_spaces,
                                  LayerState& state) const {
  unsigned any = 0, all = ~0u;
  for (const dvec4& clip : state.clip_points) {
    const unsigned code = outcode(half_spaces, clip);
    any |= code;
    all &= code;
  }
  if (all != 0) return;  // out of view, or without points
  if (any == 0) {
    state.screen_points.reserve(state.clip_points.size());
    for (const dvec4& clip : state.clip_points) include_visible(clip, state);
    return;
  }
  for (const MaterialPoint& p :
       clip_surface(hull.triangles, state.clip_points, state.clip_points, half_spaces))
    include_visible(p.clip[0], state);
  state.clipped = state.in_view();
  if (state.clipped && contains_nearest_point(state, hull)) state.nearest_w_m = state.camera.near_m;
}

void FrameCapture::leave_out(const Layer& layer, LayerState& state) const {
  forget(state);
  state.layer = layer.id;
  state.time_s = frame_.time_s;
  state.view = view_;
  state.camera = frame_.camera;
}

void FrameCapture::capture(const Layer& layer, const LayerBound& bound, LayerState& state) const {
  leave_out(layer, state);
  append_part_matrices(frame_, layer.parts, state.world_from_part);
  if (is_built(Effect::MovingPicture)) add_shown_pictures(frame_, layer.parts, state.pictures);
  const bool any_light = is_built(Effect::Lighting) && !frame_.lights.empty();
  if (any_light && any_part(*frame_.scene, layer, is_lit)) state.lights = lights_on(frame_, layer);
  capture_points(bound, state);
  if (!state.world_points.empty()) capture_samples(bound, state);
  capture_shading(bound, state);
  if (layer.preferences.whole_extents) state.view.clip_margin = whole_margin_;
  const bool whole = state.view.clip_margin != view_.clip_margin;
  if (!state.clip_points.empty())
    capture_bounds(bound.hull,
                   whole ? view_half_spaces(frame_.camera.near_m, whole_margin_, 0) : half_spaces_, state);
  state.touches_display = overlaps_display(state.screen_bounds_px, view_.display_px);
}

LayerState capture(const SceneFrame& frame, const Layer& layer, const LayerBound& bound, const View& view) {
  LayerState state;
  FrameCapture(frame, view).capture(layer, bound, state);
  return state;
}

void append_part_matrices(const SceneFrame& frame, std::span<const int> parts, std::vector<dmat4>& matrices) {
  const Scene& scene = *frame.scene;
  matrices.reserve(matrices.size() + parts.size());
  for (const int part : parts) matrices.push_back(frame.world_from_node[scene.parts[part].node]);
  if (is_built(Effect::Morphing) && !frame.morph_weights.empty()) append_morphs(frame, parts, matrices);
  if (!is_built(Effect::Skinning) || scene.skins.empty()) return;
  for (const int part : parts) {
    if (scene.parts[part].skin < 0) continue;
    const auto palette = joint_palette(frame, scene.parts[part]);
    matrices.insert(matrices.end(), palette.begin(), palette.end());
  }
}

std::vector<LightState> lights_on(const SceneFrame& frame, const Layer& layer) {
  LightState none;
  none.color = {0, 0, 0};
  std::vector<LightState> lights = frame.lights;
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (!holds_light(*frame.scene, layer, static_cast<int>(i))) lights[i] = none;
  return lights;
}

std::vector<dmat4> part_matrices(const SceneFrame& frame, std::span<const int> parts) {
  std::vector<dmat4> matrices;
  append_part_matrices(frame, parts, matrices);
  return matrices;
}

WorldBounds bounds_of(std::span<const dvec3> points) {
  WorldBounds bounds;
  for (const dvec3& p : points) {
    bounds.lo = min(bounds.lo, p);
    bounds.hi = max(bounds.hi, p);
  }
  return bounds;
}

}  // namespace talisman::layers
