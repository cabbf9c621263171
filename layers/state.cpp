// SPDX-License-Identifier: Apache-2.0
#include "layers/state.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "layers/built_effects.h"
#include "layers/clip.h"
#include "layers/shading.h"

namespace talisman::layers {
namespace {

bool is_finite(const dvec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

void capture_appearance(const SceneFrame& frame, const Layer& layer, LayerState& state) {
  state.world_from_part = part_matrices(frame, layer.parts);
  if (!is_built(Effect::Lighting) || frame.lights.empty()) return;
  if (any_part(*frame.scene, layer, is_lit)) state.lights = frame.lights;
}

bool can_be_seen(const LayerState& state) {
  return state.camera.near_m > 0 && std::isfinite(state.camera.near_m) && state.view.display_px.x > 0 &&
         state.view.display_px.y > 0 && state.view.clip_margin >= 0 && std::isfinite(state.view.clip_margin);
}

void capture_points(std::vector<dvec3> world_points, LayerState& state) {
  const dmat4 clip_from_points = clip_from_world(state.camera, state.view.display_px);
  state.world_points = std::move(world_points);
  state.clip_points.reserve(state.world_points.size());
  for (const dvec3& p : state.world_points) state.clip_points.push_back(clip_from_points * dvec4(p, 1));
  if (can_be_seen(state) && std::all_of(state.clip_points.begin(), state.clip_points.end(), is_finite))
    return;
  state.world_points.clear();
  state.clip_points.clear();
}

/// Normals and colours of the characteristic points, where the bound asks for them.
void capture_shading(const SceneFrame& frame, const LayerBound& bound, LayerState& state) {
  const bool shaded = is_built(Effect::ColorWarp) && bound.surface;
  if (state.world_points.empty() || !(shaded || bound.follows_faces)) return;
  state.world_from_body = world_from_bodies(frame, bound);
  if (!shaded) return;
  state.world_normals = point_normals(state.world_points, bound.hull, state.world_from_body);
  state.point_colors.reserve(state.world_points.size());
  for (std::size_t i = 0; i < state.world_points.size(); ++i)
    state.point_colors.push_back(shaded_color(*bound.surface, state.lights,
                                              {state.world_points[i], state.world_normals[i], state.eye()}));
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

void include_visible(const dvec4& clip, LayerState& state) {
  state.nearest_w_m = state.in_view() ? std::min(state.nearest_w_m, clip.w) : clip.w;
  state.screen_bounds_px.include(screen_from_clip(clip, state.view.display_px));
}

void capture_bounds(const Polyhedron& hull, LayerState& state) {
  const auto half_spaces = view_half_spaces(state.camera.near_m, state.view.clip_margin, 0);
  unsigned any = 0, all = ~0u;
  for (const dvec4& clip : state.clip_points) {
    const unsigned code = outcode(half_spaces, clip);
    any |= code;
    all &= code;
  }
  if (all != 0) return;  // out of view, or without points
  if (any == 0) {
    for (const dvec4& clip : state.clip_points) include_visible(clip, state);
    return;
  }
  for (const MaterialPoint& p :
       clip_surface(hull.triangles, state.clip_points, state.clip_points, half_spaces)) {
    include_visible(p.clip[0], state);
  }
  state.clipped = state.in_view();
  if (state.clipped && contains_nearest_point(state, hull)) state.nearest_w_m = state.camera.near_m;
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

dvec2 screen_from_clip(const dvec4& clip, ivec2 display_px) {
  return {(0.5 + 0.5 * clip.x / clip.w) * display_px.x, (0.5 - 0.5 * clip.y / clip.w) * display_px.y};
}

bool LayerState::same_pixels(const LayerState& other) const {
  return layer == other.layer && camera == other.camera && view == other.view &&
         world_from_part == other.world_from_part && lights == other.lights &&
         world_from_influence == other.world_from_influence;
}

LayerState capture(const SceneFrame& frame, const Layer& layer, const LayerBound& bound, const View& view) {
  LayerState state;
  state.layer = layer.id;
  state.time_s = frame.time_s;
  state.view = view;
  state.camera = frame.camera;
  capture_appearance(frame, layer, state);
  capture_points(layers::world_points(frame, layer, bound), state);
  capture_shading(frame, bound, state);
  if (!state.clip_points.empty()) capture_bounds(bound.hull, state);
  state.touches_display = overlaps_display(state.screen_bounds_px, view.display_px);
  return state;
}

std::vector<dmat4> part_matrices(const SceneFrame& frame, std::span<const int> parts) {
  const Scene& scene = *frame.scene;
  std::vector<dmat4> matrices;
  matrices.reserve(parts.size());
  for (const int part : parts) matrices.push_back(frame.world_from_node[scene.parts[part].node]);
  if (!is_built(Effect::Skinning) || scene.skins.empty()) return matrices;
  for (const int part : parts) {
    if (scene.parts[part].skin < 0) continue;
    const auto palette = joint_palette(frame, scene.parts[part]);
    matrices.insert(matrices.end(), palette.begin(), palette.end());
  }
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
