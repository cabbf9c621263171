// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include "sequences/import/assimp_scene.h"
#include "sequences/import/limits.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/pbr_surface.h"
#include "sequences/import/picture_kind.h"
#include "sequences/import/texture_io.h"
#include "sequences/import/texture_search.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

constexpr float kDielectric = 0.04f;  // reflectance of common non-metals at normal incidence

layers::Texture read_embedded(const aiTexture& from, const std::string& name) {
  if (from.mHeight == 0) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(from.pcData);
    return read_texture_from_bytes({bytes, from.mWidth}, name, picture_extension({bytes, from.mWidth}));
  }
  layers::Texture texture;
  texture.name = name;
  texture.width = static_cast<int>(from.mWidth);
  texture.height = static_cast<int>(from.mHeight);
  for (std::size_t i = 0; i < static_cast<std::size_t>(from.mWidth) * from.mHeight; ++i) {
    const aiTexel& t = from.pcData[i];
    texture.rgba.insert(texture.rgba.end(), {t.r, t.g, t.b, t.a});
    texture.has_alpha |= t.a < 255;
  }
  return texture;
}

layers::Texture read_reference(Import& import, const std::string& reference) {
  if (const aiTexture* embedded = import.from.GetEmbeddedTexture(reference.c_str()))
    return read_embedded(*embedded, reference);
  return read_named_texture(import.place, reference, import.files);
}

/// Where a picture ends in a direction; what is beside a decal is taken for its edge.
layers::Wrap wrap_of(const aiMaterial& from, const char* key, aiTextureType type) {
  int mode = aiTextureMapMode_Wrap;
  from.Get(key, type, 0, mode);
  if (mode == aiTextureMapMode_Mirror) return layers::Wrap::Mirror;
  return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? layers::Wrap::Clamp
                                                                          : layers::Wrap::Repeat;
}

/// Index of the material's colour texture; -1: none, or missing (a warning, once per reference).
int material_texture(Import& import, const aiMaterial& from, bool opaque) {
  const aiTextureType type = color_map_of(from);
  aiString written;
  if (type == aiTextureType_NONE || from.GetTexture(type, 0, &written) != aiReturn_SUCCESS) return -1;
  const std::string reference = written.C_Str();
  if (reference.empty()) return -1;
  layers::Wrap u = wrap_of(from, _AI_MATKEY_MAPPINGMODE_U_BASE, type),
               v = wrap_of(from, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
  if (const auto own = import.collada.find(from.GetName().C_Str()); own != import.collada.end())
    u = own->second.wrap_u, v = own->second.wrap_v;
  const std::string way =
      std::to_string(static_cast<int>(u)) + std::to_string(static_cast<int>(v)) + (opaque ? "opaque:" : ":");
  const auto [entry, is_new] = import.texture_of.emplace(way + reference, -1);
  if (!is_new) return entry->second;
  try {
    layers::Texture texture = read_reference(import, reference);
    texture.wrap_u = u, texture.wrap_v = v;
    if (opaque) make_opaque(texture);
    if (const std::string loss = without_empty_alpha(texture); !loss.empty()) import.warn_once(loss);
    import.model.scene.textures.push_back(std::move(texture));
    entry->second = static_cast<int>(import.model.scene.textures.size()) - 1;
  } catch (const InputError& e) {
    import.warn_once(missing_texture(reference, e.what()));
  }
  return entry->second;
}

float clean(float value, float low, float high, float otherwise) {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

layers::vec3 to_color(const aiColor4D& c) {
  return {linear_from_srgb(clean(c.r, 0, 100, 0)), linear_from_srgb(clean(c.g, 0, 100, 0)),
          linear_from_srgb(clean(c.b, 0, 100, 0))};
}

template <typename T>
T property(const aiMaterial& from, const char* key, unsigned type, unsigned index, T otherwise) {
  T value = otherwise;
  return from.Get(key, type, index, value) == aiReturn_SUCCESS ? value : otherwise;
}

/// Roughness and metalness as the Blinn-Phong lobe of about the same width; see model_import.h.
void import_pbr_gloss(const aiMaterial& from, layers::Material& to) {
  const float roughness = clean(property(from, AI_MATKEY_ROUGHNESS_FACTOR, 1.0f), 0, 1, 1);
  const float metallic = clean(property(from, AI_MATKEY_METALLIC_FACTOR, 0.0f), 0, 1, 0);
  const PbrSurface surface = pbr_surface(to.base_color, layers::vec3(kDielectric), metallic, roughness);
  to.base_color = surface.color;
  to.specular = surface.specular;
  to.shininess = surface.shininess;
}

bool is_collada(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".dae" || extension == ".zae";
}

/// <lambert> has no highlight, and <constant> nothing but what it emits; assimp gives both its defaults.
void import_collada_gloss(const aiMaterial& from, layers::Material& to) {
  const int shading = property(from, AI_MATKEY_SHADING_MODEL, static_cast<int>(aiShadingMode_Phong));
  if (shading == aiShadingMode_Gouraud || shading == aiShadingMode_NoShading) to.specular = layers::vec3(0);
  if (shading == aiShadingMode_NoShading) to.base_color = layers::vec3(0);
}

void import_phong_gloss(const aiMaterial& from, layers::Material& to) {
  const float strength = clean(property(from, AI_MATKEY_SHININESS_STRENGTH, 1.0f), 0, 1, 1);
  to.specular = to_color(property(from, AI_MATKEY_COLOR_SPECULAR, aiColor4D(0, 0, 0, 1))) * strength;
  to.shininess = clean(property(from, AI_MATKEY_SHININESS, 0.0f), 0, kMaxShininess, 0);
}

layers::Material import_material(Import& import, const aiMaterial& from) {
  layers::Material to;
  to.name = from.GetName().C_Str();
  const aiColor4D diffuse = property(from, AI_MATKEY_COLOR_DIFFUSE, aiColor4D(0.8f, 0.8f, 0.8f, 1));
  const aiColor4D base = property(from, AI_MATKEY_BASE_COLOR, diffuse);
  const bool opaque = std::string(property(from, AI_MATKEY_GLTF_ALPHAMODE, aiString()).C_Str()) == "OPAQUE";
  to.base_color = to_color(base);
  const float alpha =
      base.a > 0 ? base.a : 1;  // a colour without alpha; what is clear says so by its opacity
  to.opacity = opaque ? 1 : clean(property(from, AI_MATKEY_OPACITY, alpha), 0, 1, 1);
  to.emissive = to_color(property(from, AI_MATKEY_COLOR_EMISSIVE, aiColor4D(0, 0, 0, 1)));
  if (from.GetTextureCount(aiTextureType_EMISSIVE) > 0)
    to.emissive = layers::vec3(0);  // alone it would glow all over
  to.two_sided = property(from, AI_MATKEY_TWOSIDED, 0) != 0;
  to.texture = material_texture(import, from, opaque);
  float roughness = 0;
  if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == aiReturn_SUCCESS)
    import_pbr_gloss(from, to);
  else
    import_phong_gloss(from, to);
  if (is_collada(import.place.path)) import_collada_gloss(from, to);
  if (to.shininess < 1)
    to.specular = layers::vec3(0);  // such a highlight would cover the whole surface evenly
  return to;
}

void warn_of_maps(Import& import, const aiMaterial& from) {
  static constexpr std::pair<aiTextureType, const char*> kLacking[] = {
      {aiTextureType_NORMALS, "normal maps are not drawn"},
      {aiTextureType_HEIGHT, "bump maps are not drawn"},
      {aiTextureType_SPECULAR, "specular maps are not drawn"},
      {aiTextureType_EMISSIVE, "emissive maps are not drawn"},
      {aiTextureType_OPACITY, "opacity maps are not drawn"}};
  for (const auto& [type, text] : kLacking)
    if (from.GetTextureCount(type) > 0) import.warn_once(text);
}

/// An OBJ file without materials gets a grey one from assimp; where the vertices have colours those are meant
/// alone.
void whiten_default(Import& import) {
  for (unsigned i = 0; i < import.from.mNumMeshes; ++i) {
    const aiMesh* mesh = import.from.mMeshes[i];
    if (!mesh || !mesh->HasVertexColors(0) || mesh->mMaterialIndex >= import.model.scene.materials.size())
      continue;
    layers::Material& material = import.model.scene.materials[mesh->mMaterialIndex];
    if (material.name == AI_DEFAULT_MATERIAL_NAME) material.base_color = layers::vec3(1);
  }
}

/// Some exporters of COLLADA write how transparent a material is, where the format asks how opaque: in their files
/// something is all clear, and nothing is opaque.
void turn_transparency_over(Import& import) {
  std::vector<layers::Material>& materials = import.model.scene.materials;
  const auto has = [&](float opacity) {
    return std::any_of(materials.begin(), materials.end(),
                       [&](const layers::Material& m) { return m.opacity == opacity; });
  };
  if (!is_collada(import.place.path) || !has(0) || has(1)) return;
  for (layers::Material& material : materials) material.opacity = 1 - material.opacity;
  import.warn("nothing in it is opaque, and something is clear: transparency is taken the other way round");
}

}  // namespace

aiTextureType color_map_of(const aiMaterial& material) {
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE})
    if (material.GetTextureCount(type) > 0) return type;
  return aiTextureType_NONE;
}

void import_materials(Import& import) {
  for (unsigned i = 0; i < import.from.mNumMaterials; ++i) {
    const aiMaterial* from = import.from.mMaterials[i];
    import.model.scene.materials.push_back(from ? import_material(import, *from) : layers::Material{});
    if (from) warn_of_maps(import, *from);
  }
  whiten_default(import);
  turn_transparency_over(import);
  if (import.model.scene.materials.empty()) import.model.scene.materials.push_back({});
}

}  // namespace talisman::sequences
