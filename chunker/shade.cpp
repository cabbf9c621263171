// SPDX-License-Identifier: Apache-2.0
#include "chunker/shade.h"

#include "layers/check.h"

namespace talisman::chunker {
namespace {

using layers::dvec3;
using layers::vec3;

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

const Pyramid* pyramid_of(const PreparedScene& prepared, const layers::Material& material) {
  const auto& pyramids = prepared.impl().pyramids;
  const int index = material.texture;
  if (index < 0 || index >= static_cast<int>(pyramids.size()) || pyramids[index].empty()) return nullptr;
  return &pyramids[index];
}

void choose_texture(const PreparedScene& prepared, const layers::Material& material, const layers::Mesh& mesh,
                    Shader& shader) {
  const Pyramid* pyramid = pyramid_of(prepared, material);
  if (pyramid == nullptr) return;
  shader.opaque = shader.opaque && pyramid->opaque;
  if (mesh.uvs.empty())
    shader.texel = pyramid->mean();
  else
    shader.pyramid = pyramid;
}

AttributeLayout choose_layout(const Shader& shader, bool vertex_colors) {
  AttributeLayout layout;
  const auto next = [&layout] { return layout.count++; };
  if (shader.pyramid) layout.uv = next();
  if (vertex_colors || (shader.lit && !shader.per_pixel)) layout.color = next();
  if (shader.has_specular && !shader.per_pixel) layout.specular = next();
  if (shader.per_pixel) layout.normal = next();
  if (shader.per_pixel && (shader.has_specular || !shader.lights->point.empty())) layout.position = next();
  return layout;
}

/// One light's share: `to_light` of unit length.
void add_light(const Shader& shader, Float4 normal, Float4 to_eye, Float4 to_light, Float4 color,
               Lighting& sum) {
  const float facing = dot3(normal, to_light);
  if (!(facing > 0)) return;
  sum.diffuse += color * splat(facing);
  if (!shader.has_specular) return;
  const float lobe = dot3(normal, normalized3(to_light + to_eye));
  sum.specular += color * shader.specular * splat(power_of_unit(lobe, shader.shininess));
}

Float4 texel_at(const Shader& shader, const Interpolator& t, const Lambda& at) {
  if (shader.pyramid == nullptr) return shader.texel;
  const int uv = shader.layout.uv;
  const Float4 coordinate = attribute(t, at, uv);
  const Pyramid& pyramid = *shader.pyramid;
  if (!shader.mipmaps) return bilinear(pyramid.levels[0], coordinate[0], coordinate[1]);
  return trilinear(pyramid, coordinate[0], coordinate[1], texture_footprint(t, at, uv, pyramid.levels[0]));
}

/// Diffuse (times base and vertex colour) and specular at a pixel.
Lighting lighting_at(const Shader& shader, const Interpolator& t, const Lambda& at) {
  const AttributeLayout& layout = shader.layout;
  const Float4 color = layout.color >= 0 ? attribute(t, at, layout.color) : shader.base;
  if (!shader.per_pixel) return {color, layout.specular >= 0 ? attribute(t, at, layout.specular) : splat(0)};
  const Float4 normal = normalized3(attribute(t, at, layout.normal));
  const Float4 position = layout.position >= 0 ? attribute(t, at, layout.position) : splat(0);
  const Lighting lighting = light(shader, normal, position);
  return {color * lighting.diffuse, lighting.specular};
}

}  // namespace

LightSet light_set(const layers::SceneFrame& frame) {
  const dvec3 eye(frame.camera.world_from_camera[3]);
  LightSet set;
  for (const layers::LightState& light : frame.lights) {
    if (!finite(light.position) || !finite(light.direction) || !finite(dvec3(light.color))) continue;
    const Float4 color = float4(light.color);
    switch (light.kind) {
      case layers::Light::Kind::Ambient:
        set.ambient += color;
        break;
      case layers::Light::Kind::Directional:
        set.directional.push_back({normalized3(float4(vec3(-light.direction))), color});
        break;
      case layers::Light::Kind::Spot:
      case layers::Light::Kind::Point:
        set.point.push_back({float4(vec3(light.position - eye)), color});
        break;
    }
  }
  return set;
}

Shader make_shader(const PreparedScene& prepared, const layers::Part& part, const LightSet& lights,
                   const RenderOptions& options) {
  const layers::Scene& scene = prepared.scene();
  static const layers::Material plain;
  const layers::Material& material = part.material >= 0 ? scene.materials[part.material] : plain;
  const layers::Mesh& mesh = scene.meshes[part.mesh];
  Shader shader;
  shader.lights = &lights;
  shader.mipmaps = options.mipmaps;
  shader.opacity = clamp_unit(material.opacity);
  shader.opaque = shader.opacity == 1;
  choose_texture(prepared, material, mesh, shader);
  shader.base = float4(material.base_color, 1);
  if (!material.unlit) {
    shader.lit = !lights.ambient_only();
    if (!shader.lit) shader.base *= lights.ambient;
    shader.emissive = float4(material.emissive);
    shader.specular = float4(material.specular);
    shader.shininess = material.shininess > 0 ? material.shininess : 0;
    shader.has_specular = shader.lit && material.specular != vec3(0, 0, 0);
    // Faces without vertex normals have only their own: there is nothing to interpolate.
    shader.per_pixel = shader.lit && options.shading == Shading::Phong && !mesh.normals.empty();
  }
  shader.layout = choose_layout(shader, !mesh.colors.empty());
  TALISMAN_CHECK_LE(shader.layout.count, kMaxAttributes);
  return shader;
}

Lighting light(const Shader& shader, Float4 normal, Float4 position) {
  Lighting sum{shader.lights->ambient, splat(0)};
  const Float4 to_eye = shader.has_specular ? normalized3(-position) : splat(0);
  for (const auto& source : shader.lights->directional)
    add_light(shader, normal, to_eye, source.to_light, source.color, sum);
  for (const auto& source : shader.lights->point)
    add_light(shader, normal, to_eye, normalized3(source.position - position), source.color, sum);
  return sum;
}

void write_attributes(const Shader& shader, const ShadePoint& point, Float4* attributes) {
  const AttributeLayout& layout = shader.layout;
  if (layout.uv >= 0) attributes[layout.uv] = point.uv;
  Float4 color = shader.base * point.vertex_color;
  if (shader.lit && !shader.per_pixel) {
    const Lighting lighting = light(shader, point.normal, point.position);
    color *= lighting.diffuse;
    if (layout.specular >= 0) attributes[layout.specular] = lighting.specular;
  }
  if (layout.color >= 0) attributes[layout.color] = color;
  if (layout.normal >= 0) attributes[layout.normal] = point.normal;
  if (layout.position >= 0) attributes[layout.position] = point.position;
}

Float4 shade(const Shader& shader, const Interpolator& t, float dx, float dy) {
  const Lambda at = lambda_at(t, dx, dy);
  return combined(shader, texel_at(shader, t, at), lighting_at(shader, t, at));
}

}  // namespace talisman::chunker
