// SPDX-License-Identifier: Apache-2.0
#include "layers/light_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/state.h"

namespace talisman::layers {
namespace {

constexpr double kSameHue = 1e-4;  ///< sine of the angle between two colours: far below a step of 8 bits

bool gives_nothing(const vec3& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

bool same_hue(const vec3& a, const vec3& b) {
  return glm::length(glm::cross(dvec3(a), dvec3(b))) <=
         kSameHue * glm::length(dvec3(a)) * glm::length(dvec3(b));
}

const Material& material_of_part(const Scene& scene, int part) {
  static const Material plain;
  const int material = scene.parts[part].material;
  return material >= 0 ? scene.materials[material] : plain;
}

/// How long the scene has to be watched, seconds.
double motion_s(const Scene& scene) {
  double longest = scene.duration_s();
  for (const Track& track : scene.tracks)
    if (const auto* spin = std::get_if<SpinTrack>(&track.motion); spin && spin->rate_rad_per_s != 0)
      longest = std::max(longest, 2 * std::numbers::pi / std::fabs(spin->rate_rad_per_s));
  return std::isfinite(longest) ? longest : 0;
}

/// The layer at one time, as a light sees it.
struct Target {
  dvec3 middle{0, 0, 0};
  double radius = 0;
  std::optional<dvec3> facing, on_plane;  ///< of a flat surface that is seen from one side only
};

class Targets {
 public:
  Targets(const Scene& scene, const Layer& layer)
      : scene_(scene), layer_(layer), plane_(common_plane(scene, layer.parts, layer.rigid_node)) {
    for (const int part : layer.parts)
      if (material_of_part(scene, part).two_sided) plane_.reset();
  }

  Target at(const SceneFrame& frame) const {
    WorldBounds bounds;
    for (const int part : layer_.parts) {
      const WorldBounds own = bounds_of(world_positions(frame, scene_.parts[part]));
      bounds.lo = glm::min(bounds.lo, own.lo);
      bounds.hi = glm::max(bounds.hi, own.hi);
    }
    Target target;
    if (bounds.empty()) return target;
    target.middle = 0.5 * (bounds.lo + bounds.hi);
    target.radius = 0.5 * glm::distance(bounds.lo, bounds.hi);
    if (!plane_) return target;
    const dmat4& world = frame.world_from_node[plane_->node];
    target.facing = glm::transpose(glm::inverse(dmat3(world))) * plane_->normal;
    target.on_plane = dvec3(world * dvec4(plane_->point, 1));
    return target;
  }

 private:
  const Scene& scene_;
  const Layer& layer_;
  std::optional<SurfacePlane> plane_;
};

bool is_faced(const LightState& light, const Target& target) {
  if (!target.facing) return true;
  const dvec3 to_light =
      light.kind == Light::Kind::Directional ? -light.direction : light.position - *target.on_plane;
  return !(glm::dot(*target.facing, to_light) <= 0);
}

bool is_near_enough(const LightState& light, const Target& target) {
  if (light.kind == Light::Kind::Directional) return true;
  const dvec3 way = target.middle - light.position;
  const double distance = glm::length(way);
  if (light.range_m > 0 && distance - target.radius >= light.range_m) return false;
  if (light.kind != Light::Kind::Spot || distance <= target.radius) return true;
  const double off_axis = std::acos(std::clamp(glm::dot(way, light.direction) / distance, -1.0, 1.0));
  return !(off_axis > light.outer_cone_rad + std::asin(target.radius / distance));
}

}  // namespace

bool reaches(const Scene& scene, const Layer& layer, int index) {
  const Light& light = scene.lights[index];
  if (gives_nothing(light.color)) return false;
  if (light.kind == Light::Kind::Ambient) return true;
  const Targets targets(scene, layer);
  const double motion = motion_s(scene);
  for (int k = 0; k < kReachTimes; ++k) {
    const SceneFrame frame = scene.at(motion * k / (kReachTimes - 1));
    const Target target = targets.at(frame);
    if (is_faced(frame.lights[index], target) && is_near_enough(frame.lights[index], target)) return true;
    if (motion == 0) break;
  }
  return false;
}

ShadowsAs shadows_for(const Scene& scene, const Layer& layer) {
  for (const int part : layer.parts) {
    const Material& material = material_of_part(scene, part);
    if (!material.unlit && !gives_nothing(material.emissive)) return ShadowsAs::Light;
  }
  vec3 ambient(0), source(0);
  int sources = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!reaches(scene, layer, static_cast<int>(i))) continue;
    if (light.kind == Light::Kind::Ambient) {
      ambient += light.color;
      continue;
    }
    source = light.color;
    ++sources;
  }
  const bool one_hue = sources == 0 || same_hue(ambient, source);
  return sources > 1 || !one_hue ? ShadowsAs::Light : ShadowsAs::Shade;
}

}  // namespace talisman::layers
