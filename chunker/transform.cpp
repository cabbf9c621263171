// SPDX-License-Identifier: Apache-2.0
#include "chunker/transform.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "chunker/triangle.h"
#include "layers/state.h"

namespace talisman::chunker {
namespace {

using layers::Affine2;
using layers::dmat3;
using layers::dmat4;
using layers::dvec3;
using layers::dvec4;
using layers::ivec2;

/// No camera looks nearer than this; it keeps 1/w inside the range of float, and its gradients, which are up to 5e8 times
/// as large on a triangle of one unit of the lattice.
constexpr double kSmallestNear = 1e-27;

Rows34 rows_of(const dmat4& m) {
  Rows34 rows;
  for (int r = 0; r < 3; ++r) rows.row[r] = {m[0][r], m[1][r], m[2][r], m[3][r]};
  return rows;
}

/// Homogeneous sprite point (X, Y, w) from clip space: pixels by the display, then texels by the placement.
Rows34 sprite_from_clip(ivec2 display_px, const Affine2& sprite_from_screen) {
  const double half_w = display_px.x * 0.5, half_h = display_px.y * 0.5;
  const Affine2& m = sprite_from_screen;
  Rows34 rows;
  rows.row[0] = {m.a * half_w, -m.b * half_h, 0, m.a * half_w + m.b * half_h + m.tx};
  rows.row[1] = {m.c * half_w, -m.d * half_h, 0, m.c * half_w + m.d * half_h + m.ty};
  rows.row[2] = {0, 0, 0, 1};
  return rows;
}

/// Transforms direction n by the inverse transpose of m, times det(m): no division, so singular matrices are
/// harmless.
dmat3 cofactors(const dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

bool finite(const Affine2& m) {
  return std::isfinite(m.a) && std::isfinite(m.b) && std::isfinite(m.c) && std::isfinite(m.d) &&
         std::isfinite(m.tx) && std::isfinite(m.ty);
}

/// The half-space of the world as one of sprite points; empty where there is none.
std::optional<HalfSpace> of_sprite_points(const HalfSpace& world, const Rows34& sprite_from_world) {
  dmat3 linear;
  dvec3 shift;
  for (int r = 0; r < 3; ++r) {
    const dvec4& row = sprite_from_world.row[r];
    for (int c = 0; c < 3; ++c) linear[c][r] = row[c];
    shift[r] = row.w;
  }
  HalfSpace kept;
  kept.normal = glm::transpose(glm::inverse(linear)) * world.normal;
  kept.offset = world.offset + glm::dot(kept.normal, shift);
  const double length = glm::length(kept.normal);
  if (!(length > 0 && std::isfinite(length) && std::isfinite(kept.offset))) return std::nullopt;
  return kept;
}

/// Nearest integer, halves up, without a library call; |v| < 2³¹.
std::int32_t snap(double texels) {
  const double v = texels * kSubpixel + 0.5;
  const auto i = static_cast<std::int32_t>(v);
  return i - (v < i ? 1 : 0);
}

}  // namespace

Rows34 operator*(const Rows34& outer, const dmat4& inner) {
  Rows34 result;
  for (int r = 0; r < 3; ++r) result.row[r] = outer.row[r] * inner;
  return result;
}

std::optional<SpriteView> sprite_view(const layers::SceneFrame& frame, ivec2 display_px,
                                      const layers::SpritePlacement& placement,
                                      const std::optional<HalfSpace>& kept) {
  if (placement.empty() || !finite(placement.screen_from_sprite)) return std::nullopt;
  const auto sprite_from_screen = layers::inverse(placement.screen_from_sprite);
  if (!sprite_from_screen || !finite(*sprite_from_screen)) return std::nullopt;
  SpriteView view;
  view.size_px = placement.size_px;
  view.sprite_from_world =
      sprite_from_clip(display_px, *sprite_from_screen) * layers::clip_from_world(frame.camera, display_px);
  view.region.near_w = std::max(frame.camera.near_m, kSmallestNear);
  if (kept) view.region.kept = of_sprite_points(*kept, view.sprite_from_world);
  view.region.center_px = {placement.size_px.x * 0.5, placement.size_px.y * 0.5};
  view.eye = dvec3(frame.camera.world_from_camera[3]);
  view.mirrored = (placement.screen_from_sprite.determinant() < 0) !=
                  (glm::determinant(dmat3(frame.camera.world_from_camera)) < 0);
  return view;
}

layers::Region sprite_region(const SpriteView& view) {
  const auto& [x, y, w] = view.sprite_from_world.row;
  const double width = view.size_px.x, height = view.size_px.y;
  layers::Region region;
  for (const dvec4& side : {x, y, width * w - x, height * w - y, w}) region.push_back({dvec3(side), side.w});
  region.back().offset -= view.region.near_w;
  return region;
}

ProjectedVertex project(const SpriteView& view, const dvec3& p) {
  ProjectedVertex v;
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    v.flags = kNotFinite;
    return v;
  }
  const double w = p.z;
  v.flags = static_cast<std::uint8_t>(
      (p.x < 0 ? kLeftOfSprite : 0) | (p.x > view.size_px.x * w ? kRightOfSprite : 0) |
      (p.y < 0 ? kAboveSprite : 0) | (p.y > view.size_px.y * w ? kBelowSprite : 0) |
      (w < view.region.near_w ? kBeforeNear : 0));
  if (v.flags & kBeforeNear) return v;
  const double r = 1 / w, x = p.x * r, y = p.y * r;
  v.depth = static_cast<float>(r);
  if (std::abs(x - view.region.center_px.x) > kGuardBandPx ||
      std::abs(y - view.region.center_px.y) > kGuardBandPx) {
    v.flags |= kOutsideGuard;
    return v;
  }
  v.x = snap(x);
  v.y = snap(y);
  return v;
}

ProjectedVertex project_cut(const SpriteView& view, dvec3 p) {
  p.z = std::max(p.z, view.region.near_w);
  const dvec3 lo(view.region.center_px - kGuardBandPx, 0), hi(view.region.center_px + kGuardBandPx, 0);
  p.x = std::clamp(p.x, lo.x * p.z, hi.x * p.z);
  p.y = std::clamp(p.y, lo.y * p.z, hi.y * p.z);
  ProjectedVertex v = project(view, p);
  if (v.flags & kOutsideGuard) {  // the division's rounding led out again
    v.x = snap(std::clamp(p.x / p.z, lo.x, hi.x));
    v.y = snap(std::clamp(p.y / p.z, lo.y, hi.y));
    v.flags = static_cast<std::uint8_t>(v.flags & ~kOutsideGuard);
  }
  if (v.flags & kClipFlags) v.flags = kNotFinite;
  return v;
}

PartVertices::PartVertices(const layers::SceneFrame& frame, const layers::Part& part, const SpriteView& view,
                           const Shader& shader)
    : mesh_(&frame.scene->meshes[part.mesh]) {
  const bool is_skinned = layers::is_built(layers::Effect::Skinning) && part.skin >= 0;
  const bool is_morphed = layers::is_built(layers::Effect::Morphing) && !mesh_->morphs.empty();
  const dmat4 world_from_mesh = !is_skinned && part.node >= 0 ? frame.world_from_node[part.node] : dmat4(1.0);
  const dmat4 world_from_source = is_morphed ? dmat4(1.0) : world_from_mesh;
  if (is_skinned || is_morphed) world_ = layers::world_positions(frame, part);
  if (is_morphed && shader.lit && !mesh_->normals.empty()) normals_ = layers::morphed_normals(frame, part);
  if (is_skinned) {
    for (const dmat4& joint : layers::joint_palette(frame, part))
      joint_normals_.push_back(cofactors(dmat3(joint)));
  }
  sprite_from_source_ = view.sprite_from_world * world_from_source;
  eye_from_source_ = rows_of(world_from_source);
  for (int r = 0; r < 3; ++r) eye_from_source_.row[r].w -= view.eye[r];
  mirrored_ = glm::determinant(dmat3(world_from_mesh)) < 0;
  normal_from_mesh_ = cofactors(dmat3(world_from_mesh)) * (mirrored_ ? -1.0 : 1.0);
  reads_position_ = shader.lit || shader.layout.position >= 0;
  reads_normal_ = shader.lit && !mesh_->normals.empty();
  reads_color_ = shader.layout.color >= 0 && !mesh_->colors.empty();
  reads_uv_ = shader.layout.uv >= 0 && !(mesh_->uvs.empty() && mesh_->emissive_uvs.empty());
}

template <bool kSkinned>
Float4 PartVertices::world_normal(int i) const {
  const dvec3 n = normals_.empty() ? dvec3(mesh_->normals[i]) : normals_[i];
  dvec3 world(0);
  if (!kSkinned || joint_normals_.empty() || mesh_->joints.empty()) {
    world = normal_from_mesh_ * n;
  } else {
    for (int k = 0; k < 4; ++k)
      world += static_cast<double>(mesh_->weights[i][k]) * (joint_normals_[mesh_->joints[i][k]] * n);
  }
  // Normalised in double first: cofactors of a scene of 1e-15 units would vanish in float.
  const double length = glm::length(world);
  return length > 0 && std::isfinite(length) ? float4(layers::vec3(world / length)) : splat(0);
}

template <bool kSkinned>
ShadePoint PartVertices::shade_point(int i) const {
  ShadePoint point;
  if (reads_position_) point.position = point.lit_at = float4(layers::vec3(eye_position<kSkinned>(i)));
  if (reads_normal_) point.normal = world_normal<kSkinned>(i);
  if (reads_color_)
    point.vertex_color = float4(mesh_->colors[i], mesh_->alphas.empty() ? 1 : mesh_->alphas[i]);
  if (reads_uv_) {
    const std::vector<layers::vec2>& own = mesh_->uvs.empty() ? mesh_->emissive_uvs : mesh_->uvs;
    const std::vector<layers::vec2>& glow = mesh_->emissive_uvs.empty() ? own : mesh_->emissive_uvs;
    point.uv = Float4{usable_coordinate(own[i].x), usable_coordinate(own[i].y), usable_coordinate(glow[i].x),
                      usable_coordinate(glow[i].y)};
  }
  return point;
}
template ShadePoint PartVertices::shade_point<true>(int i) const;
template ShadePoint PartVertices::shade_point<false>(int i) const;

}  // namespace talisman::chunker
