// SPDX-License-Identifier: Apache-2.0
#include "layers/point_shading.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "layers/power.h"
#include "layers/spot_cone.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr std::size_t kMostTexelsRead = 65536;

/// As direction_or_zero, for every point and light of a plan: without its scaling, which only lengths beyond
/// 1e±150 need.
dvec3 unit_or_zero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v * (1 / length) : dvec3(0.0);
}

/// sRGB byte to linear, 0 … 1.
const std::array<double, 256>& linear_from_srgb() {
  static const auto table = [] {
    std::array<double, 256> values{};
    for (int v = 0; v < 256; ++v) {
      const double c = v / 255.0;
      values[v] = c <= 0.04045 ? c / 12.92 : power_of_unit(static_cast<float>((c + 0.055) / 1.055), 2.4f);
    }
    return values;
  }();
  return table;
}

struct MeanTexel {
  dvec3 color{1, 1, 1};  ///< linear, premultiplied
  double alpha = 1;
};

/// `cutoff` as Material::alpha_cutoff.
MeanTexel mean_texel(const Scene& scene, int index, double cutoff) {
  if (index < 0) return {};
  const Texture& texture = scene.textures[index];
  const std::size_t count = texture.rgba.size() / 4;
  if (count == 0) return {};
  const std::size_t stride = (count + kMostTexelsRead - 1) / kMostTexelsRead | 1;  // odd: not along a column
  const auto& linear = linear_from_srgb();
  MeanTexel mean{dvec3(0.0), 0};
  int read = 0;
  for (std::size_t i = 0; i < count; i += stride, ++read) {
    const std::uint8_t* texel = &texture.rgba[4 * i];
    double alpha = texture.has_alpha ? texel[3] / 255.0 : 1;
    if (cutoff > 0) alpha = alpha >= cutoff ? 1 : 0;
    mean.color += alpha * dvec3(linear[texel[0]], linear[texel[1]], linear[texel[2]]);
    mean.alpha += alpha;
  }
  return {mean.color / static_cast<double>(read), mean.alpha / read};
}

dvec3 mean_vertex_color(const Mesh& mesh) {
  if (mesh.colors.empty()) return dvec3(1.0);
  dvec3 sum(0.0);
  for (const vec3& color : mesh.colors) sum += dvec3(color);
  return sum / static_cast<double>(mesh.colors.size());
}

double mean_vertex_alpha(const Mesh& mesh) {
  if (mesh.alphas.empty()) return 1;
  double sum = 0;
  for (const float alpha : mesh.alphas) sum += alpha;
  return sum / static_cast<double>(mesh.alphas.size());
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec3 a(mesh.positions[mesh.indices[i]]);
    const dvec3 b(mesh.positions[mesh.indices[i + 1]]), c(mesh.positions[mesh.indices[i + 2]]);
    area += glm::length(cross(b - a, c - a)) / 2;
  }
  return area;
}

/// By how much the nodes above a part enlarge areas, on average over the directions.
double area_scale(const Scene& scene, int node) {
  double scale = 1;
  for (; node >= 0; node = scene.nodes[node].parent) {
    const dvec3 s = abs(scene.nodes[node].local.scale);
    scale *= (s.x * s.y + s.y * s.z + s.z * s.x) / 3;
  }
  return scale;
}

std::vector<double> weights_of(const Scene& scene, const Layer& layer) {
  std::vector<double> weights;
  double sum = 0;
  for (const int index : layer.parts) {
    const Part& part = scene.parts[index];
    weights.push_back(area_of(scene.meshes[part.mesh]) * area_scale(scene, part.node));
    sum += weights.back();
  }
  if (!(sum > 0 && std::isfinite(sum))) {
    sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum += weights[i] = scene.meshes[scene.parts[layer.parts[i]].mesh].triangle_count();
  }
  for (double& weight : weights) weight = sum > 0 ? weight / sum : 0;
  return weights;
}

void add_part(const Scene& scene, const Part& part, double weight, MeanSurface& mean) {
  static const Material plain;
  const Material& material = part.material >= 0 ? scene.materials[part.material] : plain;
  const MeanTexel texel = mean_texel(scene, material.texture, material.alpha_cutoff);
  const double opacity = std::clamp(static_cast<double>(material.opacity), 0.0, 1.0) *
                         mean_vertex_alpha(scene.meshes[part.mesh]);
  const dvec3 base =
      opacity * dvec3(material.base_color) * mean_vertex_color(scene.meshes[part.mesh]) * texel.color;
  if (material.unlit) {
    mean.constant += weight * base;
    return;
  }
  const dvec3 specular = weight * opacity * texel.alpha * dvec3(material.specular);
  mean.base += weight * base;
  mean.constant += weight * opacity * texel.alpha * dvec3(material.emissive) *
                   mean_texel(scene, material.emissive_texture, 0).color;
  mean.specular += specular;
  mean.shininess += (specular.x + specular.y + specular.z) * std::max(material.shininess, 0.0f);
}

/// 1 in the inner cone of a spot, 0 outside the outer one, between as spot_cone.h has it; 1 for other lights.
double in_cone(const LightState& light, const dvec3& to_light) {
  if (light.kind != Light::Kind::Spot) return 1;
  constexpr double kSharpest = 1e-6;  // a cone without a soft edge still has a finite slope
  const double outer = std::cos(light.outer_cone_rad), inner = std::cos(light.inner_cone_rad);
  const double on_axis = -dot(unit_or_zero(light.direction), to_light);
  const double t = std::clamp((on_axis - outer) / std::max(inner - outer, kSharpest), 0.0, 1.0);
  return cone_ramp(light).at(t);
}

}  // namespace

MeanSurface mean_surface(const Scene& scene, const Layer& layer) {
  MeanSurface mean;
  const std::vector<double> weights = weights_of(scene, layer);
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) add_part(scene, scene.parts[layer.parts[i]], weights[i], mean);
  const double strength = mean.specular.x + mean.specular.y + mean.specular.z;
  mean.shininess = strength > 0 ? mean.shininess / strength : 0;
  return mean;
}

dvec3 share_of_light(const MeanSurface& surface, const LightState& light, const SurfacePoint& point) {
  dvec3 color(light.color);
  if (!is_finite(light.position) || !is_finite(light.direction) || !is_finite(color)) return dvec3(0.0);
  if (light.kind == Light::Kind::Ambient) return surface.base * color;
  const dvec3 to_light = unit_or_zero(
      light.kind == Light::Kind::Directional ? -light.direction : light.position - point.position);
  const double facing = dot(point.normal, to_light);
  if (!(facing > 0)) return dvec3(0.0);
  color *= in_cone(light, to_light);
  if (light.falls_off() && light.kind != Light::Kind::Directional)
    color *= falloff(light, glm::length(light.position - point.position));
  const dvec3 diffuse = surface.base * color * facing;
  if (!surface.has_specular()) return diffuse;
  const dvec3 halfway = unit_or_zero(to_light + unit_or_zero(point.eye - point.position));
  const double lobe =
      power_of_unit(static_cast<float>(dot(point.normal, halfway)), static_cast<float>(surface.shininess));
  return diffuse + surface.specular * color * lobe;
}

dvec3 shaded_color(const MeanSurface& surface, std::span<const LightState> lights,
                   const SurfacePoint& point) {
  dvec3 color = surface.constant;
  for (const LightState& light : lights) color += share_of_light(surface, light, point);
  return clamp(color, dvec3(0.0), dvec3(1.0));
}

}  // namespace talisman::layers
