// SPDX-License-Identifier: Apache-2.0
#include "chunker/shade.h"

#include <cmath>

#include "chunker/shadow_map.h"
#include "layers/check.h"
#include "layers/moving_picture.h"
#include "layers/shading.h"

namespace talisman::chunker {
namespace {

using layers::dvec3;
using layers::vec3;

/// The pyramid that is looked up for a texture of the material; null: none.
const Pyramid* pyramid_of(const PreparedScene& prepared, const PartInputs& own, int texture) {
  const auto& pyramids = prepared.impl().pyramids;
  if (layers::is_built(layers::Effect::MovingPicture) && own.frame != nullptr && texture >= 0)
    texture = layers::texture_at(*own.frame, texture);
  if (texture < 0 || texture >= static_cast<int>(pyramids.size()) || pyramids[texture].empty())
    return nullptr;
  return &pyramids[texture];
}

bool all_zero(Float4 v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

Float4 unpremultiplied(Float4 texel) { return texel[3] > 0 ? texel * splat(1 / texel[3]) : splat(0); }

/// T₁ for its colour, or where only coverage counts for its alpha.
void choose_texture(const Pyramid* pyramid, bool has_uvs, bool colored, Shader& shader) {
  if (pyramid == nullptr) return;
  shader.opaque = shader.opaque && pyramid->opaque;
  if (!colored && pyramid->opaque) return;
  if (has_uvs)
    shader.pyramid = pyramid;
  else
    shader.texel = pyramid->mean();
}

void choose_second_texture(const Pyramid* pyramid, bool has_uvs, float blend1, float blend2, Shader& shader) {
  shader.two_textures = true;
  shader.blend1 = blend1;
  shader.blend2 = blend2;
  if (has_uvs)
    shader.pyramid2 = pyramid;
  else
    shader.texel2 = pyramid->mean();
}

void choose_textures(const PreparedScene& prepared, const layers::Material& material, bool has_uvs,
                     ShadeTerm term, const PartInputs& own, Shader& shader) {
  const layers::vec2 blend = own.texture_blend.value_or(material.texture_blend);
  const bool whole = term == ShadeTerm::Full || term == ShadeTerm::Base;
  const Pyramid* second = pyramid_of(prepared, own, material.texture2);
  choose_texture(pyramid_of(prepared, own, material.texture), has_uvs, whole || term == ShadeTerm::Texture1,
                 shader);
  if (second == nullptr) return;
  if (whole)
    choose_second_texture(second, has_uvs, clamp_unit(blend.x), clamp_unit(blend.y), shader);
  else if (term == ShadeTerm::Texture2)
    choose_second_texture(second, has_uvs, 0, 1, shader);
}

/// What the alpha of the texture and of the vertices does besides being multiplied.
void choose_alpha(const layers::Material& material, const layers::Mesh& mesh, Shader& shader) {
  if (!layers::is_built(layers::Effect::Translucency)) return;
  shader.alpha_cutoff = clamp_unit(material.alpha_cutoff);
  shader.vertex_alpha = !mesh.alphas.empty() && !mesh.colors.empty();
  shader.opaque = shader.opaque && !shader.vertex_alpha;
}

void choose_emission(const PreparedScene& prepared, const layers::Material& material,
                     const layers::Mesh& mesh, const PartInputs& own, Shader& shader) {
  if constexpr (!layers::is_built(layers::Effect::EmissiveMap)) return;
  const Pyramid* pyramid = pyramid_of(prepared, own, material.emissive_texture);
  if (pyramid == nullptr || all_zero(shader.emissive)) return;
  if (mesh.uvs.empty() && mesh.emissive_uvs.empty())
    shader.emissive *= unpremultiplied(pyramid->mean());
  else
    shader.emissive_map = pyramid;
}

void choose_normal_map(const PreparedScene& prepared, const layers::Material& material,
                       const layers::Mesh& mesh, Shader& shader) {
  if constexpr (!layers::is_built(layers::Effect::NormalMap)) return;
  const std::vector<Pyramid>& pyramids = prepared.impl().normals;
  if (pyramids.empty() || !shader.per_pixel || !layers::has_normal_map(material, mesh)) return;
  const Pyramid& pyramid = pyramids[material.normal_texture];
  if (pyramid.empty()) return;
  shader.normal_map = &pyramid;
  shader.normal_scale = material.normal_scale;
}

/// Does the part show anything in this term, apart from hiding what is behind it?
bool contributes(const Shader& shader, const layers::Material& material, const ShadeInputs& inputs) {
  if (inputs.lights == LightsHeld::One && (material.unlit || shader.lights->ambient_only())) return false;
  switch (inputs.term) {
    case ShadeTerm::Full:
    case ShadeTerm::Base:
    case ShadeTerm::Texture1:
      return true;
    case ShadeTerm::Texture2:
      return shader.two_textures;
    case ShadeTerm::Shadow:
      return !material.unlit && !shader.lights->ambient_only() && shader.lights->shadows > 0;
    case ShadeTerm::Specular:
      return !material.unlit && !shader.lights->ambient_only() && material.specular != vec3(0, 0, 0);
    case ShadeTerm::Reflection:
      return shader.reflection != nullptr;
  }
  return true;
}

void choose_reflection(const layers::Material& material, ShadeTerm term, const ReflectionLookup* lookup,
                       Shader& shader) {
  if (lookup == nullptr || lookup->sprite == nullptr || material.unlit) return;
  if (term != ShadeTerm::Full && term != ShadeTerm::Reflection) return;
  shader.reflectivity = clamp_unit(material.reflectivity);
  if (shader.reflectivity > 0) shader.reflection = lookup;
}

void choose_lighting(const layers::Material& material, bool has_normals, const RenderOptions& options,
                     const ShadeInputs& inputs, Shader& shader) {
  const ShadeTerm term = inputs.term;
  const bool full = term == ShadeTerm::Full, one = inputs.lights == LightsHeld::One;
  shader.lit = !shader.lights->ambient_only() && term != ShadeTerm::Reflection;
  if (!shader.lit) shader.base *= shader.lights->ambient;
  if (term != ShadeTerm::Texture2 && !one) shader.emissive = float4(material.emissive);
  shader.specular = float4(material.specular);
  shader.shininess = material.shininess > 0 ? material.shininess : 0;
  shader.has_specular =
      shader.lit && (full || term == ShadeTerm::Specular) && material.specular != vec3(0, 0, 0);
  // Faces without vertex normals have only their own: there is nothing to interpolate.
  shader.per_pixel = shader.lit && options.shading == Shading::Phong && has_normals;
  shader.shadowed = shader.lit && shader.lights->shadows > 0 &&
                    (full || one || term == ShadeTerm::Shadow || shader.has_specular);
  shader.shadow_term = term == ShadeTerm::Shadow;
}

AttributeLayout choose_layout(const Shader& shader, bool vertex_colors) {
  AttributeLayout layout;
  const auto next = [&layout] { return layout.count++; };
  if (shader.textured()) layout.uv = next();
  if (vertex_colors || shader.vertex_alpha || (shader.lit && !shader.per_pixel)) layout.color = next();
  if (shader.has_specular && !shader.per_pixel) layout.specular = next();
  if (shader.per_pixel) layout.normal = next();
  if (shader.normal_map != nullptr) {
    layout.tangent = next();
    layout.normal_uv = next();
  }
  if (shader.shadowed || (shader.per_pixel && (shader.has_specular || !shader.lights->local_empty())))
    layout.position = next();
  if (!shader.shadowed || shader.per_pixel) return layout;
  const auto one_per_map = [&layout, count = shader.lights->shadows] {
    const int first = layout.count;
    layout.count += count;
    return first;
  };
  if (shader.shadow_term)
    layout.share = next();
  else
    layout.mapped = one_per_map();
  if (shader.has_specular) layout.mapped_specular = one_per_map();
  return layout;
}

/// What one light gives; `to_light` of unit length.
struct OneLight {
  Float4 diffuse, specular;
  int map = -1;
};

template <class Add>
void add_light(const Shader& shader, Float4 normal, Float4 to_eye, Float4 to_light, Float4 color, int map,
               const Add& add) {
  const float facing = dot3(normal, to_light);
  if (!(facing > 0)) return;
  OneLight light{color * splat(facing), splat(0), map};
  if (shader.has_specular) {
    const float lobe = dot3(normal, normalized3(to_light + to_eye));
    light.specular = color * shader.specular * splat(layers::power_of_unit(lobe, shader.shininess));
  }
  add(light);
}

float fading_at(const LightSet::Fading& fading, Float4 source, Float4 position) {
  const Float4 apart = source - position;
  return faded(fading, dot3(apart, apart));
}

/// The colour of a lamp at `position` from which it lies away.
template <class Source>
Float4 faded_color(const Source& source, Float4 position, Float4 color) {
  if (!layers::is_built(layers::Effect::LightFalloff) || !source.fading.any) return color;
  return color * splat(fading_at(source.fading, source.position, position));
}

/// Calls `add` for every light that shines on the point, in the order of the set.
template <class Add>
void for_each_light(const Shader& shader, Float4 normal, Float4 position, const Add& add) {
  const Float4 to_eye = shader.has_specular ? normalized3(-position) : splat(0);
  for (const auto& source : shader.lights->directional)
    add_light(shader, normal, to_eye, source.to_light, source.color, source.shadow, add);
  for (const auto& source : shader.lights->point)
    add_light(shader, normal, to_eye, normalized3(source.position - position),
              faded_color(source, position, source.color), source.shadow, add);
  for (const auto& source : shader.lights->spot) {
    const Float4 to_light = normalized3(source.position - position);
    const float t = clamp_unit((-dot3(source.axis, to_light) - source.cos_outer) * source.inverse_width);
    const float falloff = (t * t) * (source.ramp - source.ramp_slope * t);
    add_light(shader, normal, to_eye, to_light, faded_color(source, position, source.color * splat(falloff)),
              source.shadow, add);
  }
}

/// `uv`: the attribute of the coordinates; `lane`: of the first of the two in it.
Float4 look_up(const Shader& shader, const Pyramid& pyramid, const Interpolator& t, const Lambda& at, int uv,
               int& samples, int lane = 0) {
  const Float4 coordinate = attribute(t, at, uv);
  const float u = coordinate[lane], v = coordinate[lane + 1];
  const MipLevel& finest = pyramid.levels[0];
  if (shader.mipmaps && shader.filter == TextureFilter::Trilinear) {
    const TextureDerivatives derivatives = texture_derivatives(t, at, uv, finest, lane);
    if (pyramid.is_special()) return ++samples, as_texture_says(pyramid, u, v, footprint_of(derivatives));
    if (shader.max_anisotropy > 1)
      return anisotropic(pyramid, u, v, derivatives, shader.max_anisotropy, samples);
    ++samples;
    return trilinear(pyramid, u, v, footprint_of(derivatives));
  }
  ++samples;
  return shader.filter == TextureFilter::Nearest || pyramid.nearest ? nearest(finest, u, v)
                                                                    : bilinear(finest, u, v);
}

Lighting interpolated_lighting(const Shader& shader, const Interpolator& t, const Lambda& at,
                               Float4 visibility) {
  if (shader.shadowed)
    return shader.has_specular ? interpolated_lighting<true, true>(shader, t, at, visibility)
                               : interpolated_lighting<false, true>(shader, t, at, visibility);
  return shader.has_specular ? interpolated_lighting<true, false>(shader, t, at, visibility)
                             : interpolated_lighting<false, false>(shader, t, at, visibility);
}

/// Diffuse (times base and vertex colour) and specular at a pixel.
Lighting lighting_at(const Shader& shader, const Interpolator& t, const Lambda& at, Float4 visibility) {
  if (!shader.per_pixel) return interpolated_lighting(shader, t, at, visibility);
  const AttributeLayout& layout = shader.layout;
  const Float4 color = layout.color >= 0 ? attribute(t, at, layout.color) : shader.base;
  [[maybe_unused]] int samples = 0;
  const Float4 normal = shader.normal_map != nullptr ? mapped_normal(shader, t, at, samples)
                                                     : normalized3(attribute(t, at, layout.normal));
  const Float4 position = layout.position >= 0 ? attribute(t, at, layout.position) : splat(0);
  const Lighting lighting = light(shader, normal, position, visibility);
  return {color * lighting.diffuse, lighting.specular, lighting.shadow};
}

/// Flat, Gouraud: the light of the vertex, in parts where shadows are looked up.
void write_lighting(const Shader& shader, const ShadePoint& point, Float4& color, Float4* attributes) {
  const AttributeLayout& layout = shader.layout;
  if (!shader.shadowed) {
    const Lighting lighting = light(shader, point.normal, point.lit_at, splat(1));
    color *= lighting.diffuse;
    if (layout.specular >= 0) attributes[layout.specular] = lighting.specular;
    return;
  }
  const LightParts parts = light_parts(shader, point.normal, point.lit_at);
  const int count = shader.lights->shadows;
  if (layout.share >= 0) {
    Float4 mapped = splat(0);
    float whole = luminance(parts.diffuse);
    for (int k = 0; k < count; ++k) {
      mapped[k] = luminance(parts.mapped_diffuse[k]);
      whole += mapped[k];
    }
    attributes[layout.share] = whole > 0 ? mapped * splat(1 / whole) : splat(0);
  }
  if (layout.mapped >= 0)
    for (int k = 0; k < count; ++k) attributes[layout.mapped + k] = color * parts.mapped_diffuse[k];
  if (layout.specular >= 0) attributes[layout.specular] = parts.specular;
  if (layout.mapped_specular >= 0)
    for (int k = 0; k < count; ++k) attributes[layout.mapped_specular + k] = parts.mapped_specular[k];
  color *= parts.diffuse;
}

/// Linear 0 … 1; clear outside.
Float4 decoded(const Sprite& sprite, int x, int y) {
  const Linear16 c = decode(sprite.texel(x, y));
  return Float4{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b),
                static_cast<float>(c.a)} *
         splat(1.0f / static_cast<float>(kOne));
}

}  // namespace

Shader make_shader(const PreparedScene& prepared, const layers::Part& part, const LightSet& lights,
                   const RenderOptions& options, const ShadeInputs& inputs, const PartInputs& own) {
  const layers::Scene& scene = prepared.scene();
  static const layers::Material plain;
  const layers::Material& material = part.material >= 0 ? scene.materials[part.material] : plain;
  const layers::Mesh& mesh = scene.meshes[part.mesh];
  Shader shader;
  shader.lights = &lights;
  shader.mipmaps = options.mipmaps && options.filter == TextureFilter::Trilinear;
  shader.filter = options.filter;
  shader.max_anisotropy = shader.mipmaps ? options.max_anisotropy : 1;
  shader.opacity = clamp_unit(material.opacity);
  shader.opaque = shader.opacity == 1;
  choose_textures(prepared, material, !mesh.uvs.empty(), inputs.term, own, shader);
  choose_alpha(material, mesh, shader);
  choose_reflection(material, inputs.term, own.reflection, shader);
  const bool shown = contributes(shader, material, inputs);
  const bool colored = shown && inputs.term != ShadeTerm::Shadow && inputs.term != ShadeTerm::Specular &&
                       inputs.term != ShadeTerm::Reflection;
  shader.base = colored ? float4(material.base_color, 1) : Float4{0, 0, 0, 1};
  if (shown && !material.unlit) choose_lighting(material, !mesh.normals.empty(), options, inputs, shader);
  choose_normal_map(prepared, material, mesh, shader);
  if (!colored) shader.emissive = splat(0);
  choose_emission(prepared, material, mesh, own, shader);
  shader.layout = choose_layout(shader, colored && !mesh.colors.empty());
  TALISMAN_CHECK_LE(shader.layout.count, kMaxAttributes);
  return shader;
}

Lighting light(const Shader& shader, Float4 normal, Float4 position, Float4 visibility) {
  Lighting sum{shader.lights->ambient, splat(0)};
  Float4 whole = shader.lights->ambient;
  for_each_light(shader, normal, position, [&](const OneLight& one) {
    const Float4 seen = splat(one.map >= 0 ? visibility[one.map] : 1.0f);
    if (shader.shadowed) whole += one.diffuse;
    sum.diffuse += one.diffuse * seen;
    sum.specular += one.specular * seen;
  });
  if (shader.shadowed) sum.shadow = share_left(luminance(sum.diffuse), luminance(whole));
  return sum;
}

LightParts light_parts(const Shader& shader, Float4 normal, Float4 position) {
  LightParts parts;
  parts.diffuse = shader.lights->ambient;
  for_each_light(shader, normal, position, [&](const OneLight& one) {
    (one.map >= 0 ? parts.mapped_diffuse[one.map] : parts.diffuse) += one.diffuse;
    (one.map >= 0 ? parts.mapped_specular[one.map] : parts.specular) += one.specular;
  });
  return parts;
}

void write_attributes(const Shader& shader, const ShadePoint& point, Float4* attributes) {
  const AttributeLayout& layout = shader.layout;
  if (layout.uv >= 0) attributes[layout.uv] = point.uv;
  Float4 color = shader.base * point.vertex_color;
  if (shader.lit && !shader.per_pixel) write_lighting(shader, point, color, attributes);
  color[3] = point.vertex_color[3];
  if (layout.color >= 0) attributes[layout.color] = color;
  if (layout.normal >= 0) attributes[layout.normal] = point.normal;
  if (layout.position >= 0) attributes[layout.position] = point.position;
}

Float4 visibility_at(const LightSet& lights, Float4 position) {
  const dvec3 world = lights.eye + dvec3(position[0], position[1], position[2]);
  Float4 visibility = splat(1);
  for (int k = 0; k < lights.shadows; ++k) visibility[k] = lights.shadow_maps[k]->visibility(world);
  return visibility;
}

Float4 reflection_at(const ReflectionLookup& lookup, const Interpolator& t, float dx, float dy) {
  const layers::dvec2 p = lookup.reflection_from_sprite(
      {static_cast<double>(t.corner_x) + dx, static_cast<double>(t.corner_y) + dy});
  const layers::ivec2 size = lookup.sprite->size_px();
  if (!(p.x > -1 && p.y > -1 && p.x < size.x + 1 && p.y < size.y + 1)) return splat(0);
  const float x = static_cast<float>(p.x) - 0.5f, y = static_cast<float>(p.y) - 0.5f;
  const int column = floor_to_int(x), row = floor_to_int(y);
  const float across = x - static_cast<float>(column), down = y - static_cast<float>(row);
  const auto texel = [&](int i, int j) { return decoded(*lookup.sprite, column + i, row + j); };
  return mix(mix(texel(0, 0), texel(1, 0), across), mix(texel(0, 1), texel(1, 1), across), down);
}

/// `texel` with the alpha of the vertices, and cut where there is a cutoff.
Float4 with_alpha(const Shader& shader, const Interpolator& t, const Lambda& at, Float4 texel) {
  if (shader.vertex_alpha) texel *= splat(attribute(t, at, shader.layout.color)[3]);
  if (!(shader.alpha_cutoff > 0)) return texel;
  return texel[3] >= shader.alpha_cutoff ? texel * splat(1 / texel[3]) : splat(0);
}

Float4 emission_at(const Shader& shader, const Interpolator& t, const Lambda& at, int& samples) {
  if (shader.emissive_map == nullptr) return splat(1);
  return unpremultiplied(look_up(shader, *shader.emissive_map, t, at, shader.layout.uv, samples, 2));
}

Float4 mapped_normal(const Shader& shader, const Interpolator& t, const Lambda& at, int& samples) {
  const AttributeLayout& layout = shader.layout;
  const Float4 normal = normalized3(attribute(t, at, layout.normal)),
               along = attribute(t, at, layout.tangent);
  const Float4 across = along - normal * splat(dot3(along, normal));
  constexpr float kParallel = 1e-8f;  // squared: less of the tangent than rounding is left in the surface
  if (!(dot3(across, across) > kParallel * dot3(along, along))) return normal;
  const Float4 tangent = normalized3(across);
  const Float4 bitangent = cross3(normal, tangent) * splat(along[3] < 0 ? -1.0f : 1.0f);
  const Float4 n = look_up(shader, *shader.normal_map, t, at, layout.normal_uv, samples);
  const float scale = shader.normal_scale;
  const Float4 turned =
      normalized3(tangent * splat(scale * n[0]) + bitangent * splat(scale * n[1]) + normal * splat(n[2]));
  return dot3(turned, turned) > 0 ? turned : normal;
}

Float4 texel_at(const Shader& shader, const Interpolator& t, const Lambda& at, int& samples) {
  const int uv = shader.layout.uv;
  Float4 first =
      shader.pyramid != nullptr ? look_up(shader, *shader.pyramid, t, at, uv, samples) : shader.texel;
  if (shader.vertex_alpha || shader.alpha_cutoff > 0) first = with_alpha(shader, t, at, first);
  if (!shader.two_textures) return first;
  const Float4 second =
      shader.pyramid2 != nullptr ? look_up(shader, *shader.pyramid2, t, at, uv, samples) : shader.texel2;
  Float4 color = first * splat(shader.blend1) + second * splat(shader.blend2 * first[3]);
  color[3] = first[3];
  return color;
}

Float4 shade(const Shader& shader, const Interpolator& t, float dx, float dy) {
  const Lambda at = lambda_at(t, dx, dy);
  int samples = 0;
  const Float4 texel = texel_at(shader, t, at, samples);
  const Float4 opacity = splat(shader.opacity), emission = emission_at(shader, t, at, samples);
  if (!shader.extended())
    return combined<Terms{}>(shader, texel, lighting_at(shader, t, at, splat(1)), splat(0), emission) *
           opacity;
  const Float4 visibility =
      shader.shadowed ? visibility_at(*shader.lights, attribute(t, at, shader.layout.position)) : splat(1);
  const Float4 reflection =
      shader.reflection != nullptr ? reflection_at(*shader.reflection, t, dx, dy) : splat(0);
  const Lighting lighting = lighting_at(shader, t, at, visibility);
  if (shader.shadow_term)
    return combined<Terms{.shadow_alone = true}>(shader, texel, lighting, reflection) * opacity;
  return combined<Terms{.shadowed = true, .reflecting = true}>(shader, texel, lighting, reflection,
                                                               emission) *
         opacity;
}

void finish_term(ShadeTerm term, bool adds, std::span<Float4> texels) {
  switch (term) {
    case ShadeTerm::Full:
    case ShadeTerm::Base:
    case ShadeTerm::Texture1:
      if (adds)
        for (Float4& texel : texels) texel[3] = 0;
      return;
    case ShadeTerm::Shadow:
      for (Float4& texel : texels) texel = Float4{0, 0, 0, texel[0]};
      return;
    case ShadeTerm::Specular:
    case ShadeTerm::Reflection:
    case ShadeTerm::Texture2:
      for (Float4& texel : texels) texel[3] = 0;
      return;
  }
}

}  // namespace talisman::chunker
