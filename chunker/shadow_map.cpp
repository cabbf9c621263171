// SPDX-License-Identifier: Apache-2.0
#include "chunker/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include "chunker/bin.h"
#include "chunker/coverage.h"
#include "chunker/job_order.h"
#include "chunker/shadow_view.h"
#include "chunker/transform.h"
#include "layers/check.h"
#include "layers/vectors.h"

namespace talisman::chunker {
namespace {

using layers::dvec3;
using layers::dvec4;

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr double kWidestTan = kWidestShadowTan;
constexpr double kNearShare = 1e-5;        // near plane, of the distance to the farthest caster
constexpr double kSteepestTexels = 16;     // the slope's bias stops growing here
constexpr double kLookupSample = 3.0 / 8;  // place in a texel of the one sample that decides

struct Caster {
  const layers::Mesh* mesh = nullptr;
  std::vector<dvec3> world;
  layers::Box3 box{};  ///< of `world`
};

bool casts(const layers::Scene& scene, const layers::Part& part) {
  return part.material < 0 || scene.materials[part.material].opacity >= 0.5f;
}

std::vector<Caster> casters_of(const layers::SceneFrame& frame, std::span<const int> parts) {
  SpriteView world;  // a view whose sprite space is the world
  for (int r = 0; r < 3; ++r) {
    world.sprite_from_world.row[r] = dvec4(0);
    world.sprite_from_world.row[r][r] = 1;
  }
  std::vector<Caster> casters;
  for (const int index : parts) {
    const layers::Part& part = frame.scene->parts[index];
    if (!casts(*frame.scene, part)) continue;
    const PartVertices vertices(frame, part, world);
    Caster caster{&vertices.mesh(), {}, {}};
    caster.world.resize(vertices.size());
    for (int i = 0; i < vertices.size(); ++i) caster.world[i] = vertices.sprite_point(i);
    caster.box = layers::box_of(caster.world);
    casters.push_back(std::move(caster));
  }
  return casters;
}

/// `visit(point)` for every vertex that is finite.
template <typename Visit>
void for_each_point(std::span<const Caster> casters, const Visit& visit) {
  for (const Caster& caster : casters)
    for (const dvec3& p : caster.world)
      if (layers::is_finite(p)) visit(p);
}

/// Depth that grows towards the light and is linear on the map: 1/w, or -z.
ProjectedVertex project_point(const FaceView& face, const dvec3& p) {
  if (!face.orthographic) return project(face.view, p);
  ProjectedVertex v = project(face.view, layers::is_finite(p) ? dvec3(p.x, p.y, 1) : p);
  v.depth = static_cast<float>(-p.z);
  return v;
}

void emit(const FaceView& face, const std::array<ProjectedVertex, 3>& v, std::vector<Triangle>& triangles) {
  if ((v[0].flags | v[1].flags | v[2].flags) & (kNotFinite | kClipFlags)) return;
  Triangle t{};
  for (int k = 0; k < 3; ++k) {
    t.x[k] = v[k].x;
    t.y[k] = v[k].y;
    t.depth[k] = v[k].depth;
  }
  const std::int64_t area = doubled_area(t);
  const LatticeBox map{0, 0, face.view.size_px.x * 4 - 1, face.view.size_px.y * 4 - 1};
  if (area == 0 || intersection(sample_box(t), map).empty()) return;
  if (area < 0) {
    std::swap(t.x[1], t.x[2]);
    std::swap(t.y[1], t.y[2]);
    std::swap(t.depth[1], t.depth[2]);
  }
  triangles.push_back(t);
}

void cut_and_emit(const FaceView& face, const std::array<dvec3, 3>& points,
                  std::vector<Triangle>& triangles) {
  const ClippedPolygon polygon = clip_triangle(points, face.view.region);
  for (int k = 2; k < polygon.count; ++k)
    emit(face,
         {project_cut(face.view, polygon.vertices[0].point),
          project_cut(face.view, polygon.vertices[k - 1].point),
          project_cut(face.view, polygon.vertices[k].point)},
         triangles);
}

/// Does the caster lie outside of what the light sees through this face?
bool is_out_of_sight(const FaceView& face, const Caster& caster) {
  return !face.orthographic &&
         layers::RegionTest(sprite_region(face.view), layers::reach_of({&caster.box, 1})).misses(caster.box);
}

void add_triangles(const FaceView& face, const Caster& caster, std::vector<Triangle>& triangles) {
  if (is_out_of_sight(face, caster)) return;
  const std::vector<std::uint32_t>& indices = caster.mesh->indices;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<dvec3, 3> points;
    std::array<ProjectedVertex, 3> projected;
    for (int k = 0; k < 3; ++k) {
      points[k] = face.view.sprite_from_world(caster.world[indices[i + k]]);
      projected[k] = project_point(face, points[k]);
    }
    const int all = projected[0].flags & projected[1].flags & projected[2].flags,
              any = projected[0].flags | projected[1].flags | projected[2].flags;
    if ((all & kOutsideFlags) || (any & kNotFinite)) continue;
    if ((any & kClipFlags) && !face.orthographic)
      cut_and_emit(face, points, triangles);
    else
      emit(face, projected, triangles);
  }
}

/// z of the nearest surface and how fast it changes, |∂z/∂x| + |∂z/∂y| per texel.
struct Nearest {
  float z = kNothing, slope = 0;
};

Nearest nearest_of(const FaceView& face, const DepthPlane& plane) {
  const float depth = depth_at(plane, Samples<1>::place(0)), slope = std::abs(plane.dx) + std::abs(plane.dy);
  if (face.orthographic) return {-depth, slope};
  if (!(depth > 0)) return {};
  return {1 / depth, slope / (depth * depth)};
}

/// One chunk of a map.
class DepthChunk {
 public:
  DepthChunk(const FaceView& face, layers::ivec2 origin) : face_(face), origin_(origin) {
    const layers::ivec2 size = face.view.size_px;
    box_ = {0, 0, std::min(kChunkSize, size.x - origin.x) - 1, std::min(kChunkSize, size.y - origin.y) - 1};
  }

  void draw(const Triangle& t) {
    LatticeBox texels = texels_of(sample_box(t));
    texels = intersection(
        box_, {texels.x0 - origin_.x, texels.y0 - origin_.y, texels.x1 - origin_.x, texels.y1 - origin_.y});
    if (texels.empty()) return;
    cover<1>(edges_of(t, origin_.x, origin_.y), texels, coverage_);
    const Gradients gradients = gradients_of(t);
    for (int y = texels.y0; y <= texels.y1; ++y)
      for (std::uint32_t left = coverage_.full[y]; left != 0; left &= left - 1) {
        const int x = __builtin_ctz(left);
        const Nearest found = nearest_of(face_, depth_plane(t, gradients, origin_.x + x, origin_.y + y));
        Nearest& kept = nearest_[y * kChunkSize + x];
        if (found.z < kept.z) kept = found;
      }
  }

  void store(const layers::ShadowMapOptions& options, std::vector<float>& depths) const {
    for (int y = box_.y0; y <= box_.y1; ++y)
      for (int x = box_.x0; x <= box_.x1; ++x)
        depths[static_cast<std::size_t>(origin_.y + y) * face_.view.size_px.x + origin_.x + x] =
            biased(options, nearest_[y * kChunkSize + x]);
  }

 private:
  float biased(const layers::ShadowMapOptions& options, const Nearest& n) const {
    if (n.z == kNothing) return kNothing;
    const double texel = face_.orthographic ? face_.texel_m : face_.texel_m * n.z;
    const double slope = std::min<double>(n.slope, kSteepestTexels * texel);
    return static_cast<float>(n.z + texel * options.bias_texels +
                              options.slope_bias * (options.pcf_radius + 0.5) * slope);
  }

  const FaceView& face_;
  layers::ivec2 origin_;
  LatticeBox box_;
  Coverage coverage_;
  std::array<Nearest, kChunkSize * kChunkSize> nearest_{};
};

std::vector<float> draw_depths(const FaceView& face, const std::vector<Triangle>& triangles,
                               const layers::ShadowMapOptions& options) {
  const layers::ivec2 size = face.view.size_px;
  std::vector<float> depths(static_cast<std::size_t>(size.x) * size.y, kNothing);
  const Bins bins = bin_triangles(triangles, size);
  const JobOrder order(static_cast<std::size_t>(bins.chunks.x) * bins.chunks.y);
  tbb::parallel_for(0, bins.chunks.x * bins.chunks.y, [&](int job) {
    const int c = static_cast<int>(order[job]);
    if (bins.of(c).empty()) return;
    DepthChunk chunk(face, {c % bins.chunks.x * kChunkSize, c / bins.chunks.x * kChunkSize});
    for (const std::uint32_t i : bins.of(c)) chunk.draw(triangles[i]);
    chunk.store(options, depths);
  });
  return depths;
}

bool usable(const layers::LightState& light) {
  return layers::is_finite(light.position) && layers::is_finite(light.direction) &&
         std::isfinite(light.outer_cone_rad) && glm::length(light.direction) > 0;
}

}  // namespace

class ShadowMapBuilder {
 public:
  ShadowMapBuilder(const layers::LightState& light, const std::vector<Caster>& casters,
                   const layers::ShadowMapOptions& options)
      : light_(light), casters_(casters), options_(options) {
    map_.resolution_px_ = options.resolution_px;
    map_.pcf_radius_ = options.pcf_radius;
    map_.light_ = light.position;
    for_each_point(casters_, [&](const dvec3& p) {
      reach_ = std::max(reach_, glm::length(p - light.position));
      lo_ = glm::min(lo_, p);
      hi_ = glm::max(hi_, p);
    });
  }

  ShadowMap build() {
    switch (light_.kind) {
      case layers::Light::Kind::Ambient:
        break;
      case layers::Light::Kind::Directional:
        map_.orthographic_ = true;
        from_afar();
        break;
      case layers::Light::Kind::Point:
        from_place();
        break;
      case layers::Light::Kind::Spot:
        from_spot();
        break;
    }
    return std::move(map_);
  }

 private:
  bool reachable() const { return reach_ > 0 && std::isfinite(reach_); }
  double near_w() const { return reach_ * kNearShare; }

  void add(const FaceView& face) {
    std::vector<Triangle> triangles;
    for (const Caster& caster : casters_) add_triangles(face, caster, triangles);
    map_.polygons_drawn_ += static_cast<std::int64_t>(triangles.size());
    map_.faces_.push_back({face.view.sprite_from_world, draw_depths(face, triangles, options_)});
  }

  void from_afar() {
    const LightAxes axes = axes_along(glm::normalize(light_.direction));
    dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
    for_each_point(casters_, [&](const dvec3& p) {
      lo = glm::min(lo, axes(p));
      hi = glm::max(hi, axes(p));
    });
    if (const auto face = orthographic_view(options_, axes, lo, hi)) add(*face);
  }

  void from_spot() {
    const double tan_outer = std::tan(light_.outer_cone_rad);
    if (!(light_.outer_cone_rad < 1.5 && tan_outer <= kWidestTan)) return from_place();
    if (reachable())
      add(perspective_view(options_, light_.position, axes_along(glm::normalize(light_.direction)), tan_outer,
                           near_w()));
  }

  void from_place() {
    if (!reachable()) return;
    const dvec3 towards = (lo_ + hi_) * 0.5 - light_.position;
    const double distance = glm::length(towards);
    if (distance > near_w()) {
      const double fitted = widest_tan(axes_along(towards / distance));
      if (fitted <= kWidestTan) {
        const LightAxes axes = axes_along(steady_direction(towards / distance, fitted));
        add(perspective_view(options_, light_.position, axes, stepped(widest_tan(axes)), near_w()));
        return;
      }
    }
    for (const dvec3& axis :
         {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)})
      add(perspective_view(options_, light_.position, axes_along(axis), 1, near_w()));
  }

  /// Of the angle to the vertex that is farthest off the axis; infinite where one is not before the light.
  double widest_tan(const LightAxes& axes) const {
    double widest = 0;
    for_each_point(casters_, [&](const dvec3& p) {
      const dvec3 q = p - light_.position;
      const double z = glm::dot(axes.forward, q);
      const double across = std::max(std::abs(glm::dot(axes.right, q)), std::abs(glm::dot(axes.down, q)));
      widest = std::max(widest, z > near_w() ? across / z : HUGE_VAL);
    });
    return widest;
  }

  const layers::LightState& light_;
  const std::vector<Caster>& casters_;
  const layers::ShadowMapOptions& options_;
  dvec3 lo_{HUGE_VAL}, hi_{-HUGE_VAL};  ///< of the casters
  double reach_ = 0;                    ///< distance to the farthest caster
  ShadowMap map_;
};

const ShadowFace* ShadowMap::face_of(const dvec3& world) const {
  if (faces_.size() < 2) return faces_.empty() ? nullptr : &faces_[0];
  const dvec3 d = world - light_;
  const dvec3 size = glm::abs(d);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  return &faces_[2 * axis + (d[axis] < 0 ? 1 : 0)];
}

float ShadowMap::visibility(const dvec3& world) const {
  const ShadowFace* face = face_of(world);
  if (face == nullptr) return 1;
  dvec3 p = face->map_from_world(world);
  if (!orthographic_) {
    if (!(p.z > 0)) return 1;
    p.x /= p.z;
    p.y /= p.z;
  }
  const double beyond = resolution_px_ + kChunkSize;
  if (!(p.x > -kChunkSize && p.y > -kChunkSize && p.x < beyond && p.y < beyond)) return 1;
  const int column = static_cast<int>(std::floor(p.x - kLookupSample + 0.5)),
            row = static_cast<int>(std::floor(p.y - kLookupSample + 0.5)), r = pcf_radius_;
  const float z = static_cast<float>(p.z);
  int lit = 0;
  for (int y = row - r; y <= row + r; ++y)
    for (int x = column - r; x <= column + r; ++x) {
      const bool inside = x >= 0 && y >= 0 && x < resolution_px_ && y < resolution_px_;
      lit += !inside || !(face->depths[static_cast<std::size_t>(y) * resolution_px_ + x] < z) ? 1 : 0;
    }
  const int side = 2 * r + 1;
  return static_cast<float>(lit) / static_cast<float>(side * side);
}

std::int64_t ShadowMap::bytes() const {
  std::int64_t sum = 0;
  for (const ShadowFace& face : faces_) sum += static_cast<std::int64_t>(face.depths.size() * sizeof(float));
  return sum;
}

ShadowMap make_shadow_map(const layers::SceneFrame& frame, int light, std::span<const int> casters,
                          const layers::ShadowMapOptions& options) {
  TALISMAN_CHECK(light >= 0 && light < static_cast<int>(frame.lights.size()));
  TALISMAN_CHECK_LE(options.resolution_px, 8192);
  TALISMAN_CHECK(options.pcf_radius >= 0 && options.pcf_radius <= 8);
  if (options.resolution_px <= 0 || !usable(frame.lights[light])) return {};
  const std::vector<Caster> drawn = casters_of(frame, casters);
  return ShadowMapBuilder(frame.lights[light], drawn, options).build();
}

ShadowMap make_shadow_map(const layers::SceneFrame& frame, int light, std::span<const int> casters) {
  return make_shadow_map(frame, light, casters, frame.scene->lights[light].shadow);
}

}  // namespace talisman::chunker
