// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sequences/import/gltf_baked_maps.h"
#include "sequences/import/gltf_scene.h"
#include "sequences/import/pbr_surface.h"
#include "sequences/import/picture_kind.h"
#include "sequences/import/texture_io.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

constexpr int kNearest = 9728, kNearestMipNearest = 9984, kLinearMipNearest = 9985, kNearestMipLinear = 9986;
constexpr int kLinear = 9729, kClampToEdge = 33071, kMirroredRepeat = 33648;
constexpr double kEvenRoughness = 0.02;  // standard deviation up to which a map counts as even

layers::vec3 color_of(const std::vector<double>& c) {
  return {static_cast<float>(std::max(0.0, c[0])), static_cast<float>(std::max(0.0, c[1])),
          static_cast<float>(std::max(0.0, c[2]))};
}

layers::Wrap wrap_of(const Json& sampler, const char* key) {
  const int mode = index_of(sampler, key);
  return mode == kClampToEdge      ? layers::Wrap::Clamp
         : mode == kMirroredRepeat ? layers::Wrap::Mirror
                                   : layers::Wrap::Repeat;
}

void apply_sampler(const GltfImport& import, const Json& from, layers::Texture& texture) {
  const int index = index_of(from, "sampler");
  if (index < 0) return;
  const Json& sampler = item_of(import.file, "samplers", index);
  texture.wrap_u = wrap_of(sampler, "wrapS");
  texture.wrap_v = wrap_of(sampler, "wrapT");
  texture.nearest = index_of(sampler, "magFilter") == kNearest;
  const int minified = index_of(sampler, "minFilter");
  texture.nearest_minified =
      minified == kNearest || minified == kNearestMipNearest || minified == kNearestMipLinear;
  texture.finest = minified == kNearest || minified == kLinear;
  texture.one_level = minified == kNearestMipNearest || minified == kLinearMipNearest;
}

/// The image of a texture: a WebP one where the texture has it, else its own; -1: none that is read.
int image_of(const Json& texture) {
  const Json* webp = extension_of(texture, "EXT_texture_webp");
  const int image = webp ? index_of(*webp, "source") : -1;
  return image >= 0 ? image : index_of(texture, "source");
}

layers::Texture read_image(GltfImport& import, int index) {
  const Json& image = item_of(import.file, "images", index);
  const std::string uri = text_of(image, "uri"), own = text_of(image, "name");
  const std::string name = own.empty() ? "image " + std::to_string(index) : own;
  if (uri.empty()) {
    const auto bytes = bytes_of_view(import.file, index_of(image, "bufferView"));
    return read_texture_from_bytes(bytes, name, picture_extension(bytes));
  }
  if (uri.rfind("data:", 0) == 0) {
    const auto bytes = bytes_of_uri(import.file, uri);
    return read_texture_from_bytes(bytes, name, picture_extension(bytes));
  }
  const std::string found = find_texture(import.file.place, percent_decoded(uri), import.file.uses);
  if (found.empty()) throw InputError("is missing");
  layers::Texture texture = read_texture(found);
  texture.name = std::filesystem::path(found).filename().string();
  return texture;
}

std::string name_of_image(const GltfImport& import, const Json& texture) {
  const int index = image_of(texture);
  if (index < 0) return "of another format";
  const Json& image = item_of(import.file, "images", index);
  const std::string uri = text_of(image, "uri");
  const std::string name = text_of(image, "name", "image " + std::to_string(index));
  return uri.empty() || uri.rfind("data:", 0) == 0 ? name : percent_decoded(uri);
}

/// The texture, or an empty one and a warning.
layers::Texture read_gltf_texture(GltfImport& import, int index) {
  const Json& from = item_of(import.file, "textures", index);
  layers::Texture texture;
  try {
    if (image_of(from) < 0) throw InputError("has no source that is read");
    texture = read_image(import, image_of(from));
  } catch (const InputError& e) {
    import.warn("texture '" + name_of_image(import, from) + "': " + e.what() + "; a plain colour is used");
    return {};
  }
  apply_sampler(import, from, texture);
  return texture;
}

GltfCoordinates coordinates_of(const Json& info) {
  GltfCoordinates coordinates;
  coordinates.set = std::max(0, index_of(info, "texCoord"));
  const Json* transform = extension_of(info, "KHR_texture_transform");
  if (!transform) return coordinates;
  const auto offset = numbers_of(*transform, "offset", 2, {0, 0}),
             scale = numbers_of(*transform, "scale", 2, {1, 1});
  for (int k = 0; k < 2; ++k) coordinates.offset[k] = offset[k], coordinates.scale[k] = scale[k];
  coordinates.rotation_rad = number_of(*transform, "rotation", 0);
  if (const int set = index_of(*transform, "texCoord"); set >= 0) coordinates.set = set;
  return coordinates;
}

/// Reads textures, each of them once, with and without its alpha.
class Textures {
 public:
  explicit Textures(GltfImport& import) : import_(import) {}

  /// Index into Scene::textures; -1: none, or none that can be read.
  int of(const Json& info, bool opaque) {
    const int index = index_of(info, "index");
    if (index < 0) return -1;
    const auto [entry, is_new] = found_.emplace(std::pair(index, opaque), -1);
    if (!is_new) return entry->second;
    layers::Texture texture = read(index);
    if (texture.rgba.empty()) return -1;
    if (opaque) make_opaque(texture);
    import_.model.scene.textures.push_back(std::move(texture));
    return entry->second = static_cast<int>(import_.model.scene.textures.size()) - 1;
  }

  struct Spread {
    double mean = 1, deviation = 0;
  };
  /// Of one channel, 0 … 1, as numbers and not as light; even 1 where there is no texture.
  Spread spread_of(const Json& info, int channel) {
    const layers::Texture* texture = content_of(info);
    if (!texture) return {};
    double sum = 0, squares = 0;
    for (std::size_t i = static_cast<std::size_t>(channel); i < texture->rgba.size(); i += 4) {
      const double value = texture->rgba[i] / 255.0;
      sum += value, squares += value * value;
    }
    const double n = static_cast<double>(texture->rgba.size()) / 4, mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
  }
  double mean_of(const Json& info, int channel) { return spread_of(info, channel).mean; }

  /// As it was read; null: none, or none that can be read. Valid as long as this.
  const layers::Texture* content_of(const Json& info) {
    const int index = index_of(info, "index");
    if (index < 0) return nullptr;
    const layers::Texture& texture = read(index);
    return texture.rgba.empty() ? nullptr : &texture;
  }

  /// The colour texture with other maps in it (gltf_baked_maps.h), each combination once; -1: they change nothing.
  int baked(const std::string& combination, bool opaque, const MapsToBake& maps) {
    const auto [entry, is_new] = baked_.emplace(combination, -1);
    if (!is_new) return entry->second;
    layers::Texture texture = baked_maps(maps);
    if (texture.rgba.empty()) return -1;
    if (opaque) make_opaque(texture);
    import_.model.scene.textures.push_back(std::move(texture));
    return entry->second = static_cast<int>(import_.model.scene.textures.size()) - 1;
  }

 private:
  const layers::Texture& read(int index) {
    const auto [entry, is_new] = read_.try_emplace(index);
    if (is_new) entry->second = read_gltf_texture(import_, index);
    return entry->second;
  }
  GltfImport& import_;
  std::map<std::pair<int, bool>, int> found_;
  std::map<std::string, int> baked_;
  std::map<int, layers::Texture> read_;
};

/// The mean of what is seen of it, in linear light.
layers::vec3 mean_color(const layers::Texture& texture) {
  layers::vec3 sum(0);
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4)
    for (int k = 0; k < 3; ++k) sum[k] += linear_from_srgb(static_cast<float>(texture.rgba[i + k]) / 255);
  return sum / static_cast<float>(texture.rgba.size() / 4);
}

/// Reflectance at normal incidence of what is no metal: KHR_materials_ior, KHR_materials_specular.
layers::vec3 dielectric_of(const Json& material) {
  double reflectance = 0.04;
  if (const Json* ior = extension_of(material, "KHR_materials_ior")) {
    const double n = number_of(*ior, "ior", 1.5);
    if (n > 0) reflectance = std::pow((n - 1) / (n + 1), 2);
  }
  const Json* specular = extension_of(material, "KHR_materials_specular");
  if (!specular) return layers::vec3(static_cast<float>(reflectance));
  const double factor = reflectance * number_of(*specular, "specularFactor", 1);
  const layers::vec3 color = color_of(numbers_of(*specular, "specularColorFactor", 3, {1, 1, 1}));
  return glm::min(layers::vec3(1), static_cast<float>(factor) * color);
}

/// One material at a time.
class Reading {
 public:
  Reading(GltfImport& import, Textures& textures, const Json& from, layers::Material& to, GltfMaterial& maps)
      : import_(import), textures_(textures), from_(from), to_(to), maps_(maps) {}

  void read() {
    to_.two_sided = flag_of(from_, "doubleSided", false);
    to_.unlit = extension_of(from_, "KHR_materials_unlit") != nullptr;
    if (const Json* gloss = extension_of(from_, "KHR_materials_pbrSpecularGlossiness"))
      read_gloss(*gloss);
    else
      read_metal(object_of(from_, "pbrMetallicRoughness"));
    read_emission();
    read_normal_map();
    name_what_is_left_out();
  }

 private:
  void read_base(const Json& pbr, const char* factor, const char* map) {
    const auto base = numbers_of(pbr, factor, 4, {1, 1, 1, 1});
    to_.base_color = color_of(base);
    const Json& info = object_of(pbr, map);
    const std::string mode = alpha_mode();
    to_.texture = textures_.of(info, mode == "OPAQUE");
    maps_.base = coordinates_of(info);
    maps_.has_base_map = to_.texture >= 0;
    maps_.is_opaque = mode == "OPAQUE";
    set_alpha(mode, std::clamp(base[3], 0.0, 1.0));
  }

  /// Where everything passes the cutoff, nothing is cut.
  std::string alpha_mode() const {
    const std::string mode = text_of(from_, "alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
      throw InputError("glTF: alphaMode '" + mode + "' of material '" + to_.name +
                       "', rule: OPAQUE, MASK or BLEND");
    return mode == "MASK" && number_of(from_, "alphaCutoff", 0.5) <= 0 ? "OPAQUE" : mode;
  }

  /// alpha = factor · texture · vertices; MASK compares it with the cutoff, so what is compared with is divided.
  void set_alpha(const std::string& mode, double factor) {
    to_.opacity = mode == "BLEND" ? static_cast<float>(factor) : 1;
    if (mode != "MASK") return;
    const double cutoff = number_of(from_, "alphaCutoff", 0.5);
    if (factor < cutoff)
      to_.opacity = 0;
    else
      to_.alpha_cutoff = static_cast<float>(cutoff / factor);
  }

  void read_metal(const Json& pbr) {
    read_base(pbr, "baseColorFactor", "baseColorTexture");
    const Json& map = object_of(pbr, "metallicRoughnessTexture");
    if (to_.unlit) return;
    const Textures::Spread roughness = textures_.spread_of(map, 1);
    if (roughness.deviation > kEvenRoughness)
      import_.lacks("roughness maps are drawn as their mean", to_.name);
    const double metallic = std::clamp(number_of(pbr, "metallicFactor", 1), 0.0, 1.0);
    const layers::Texture* colors = textures_.content_of(object_of(pbr, "baseColorTexture"));
    const layers::vec3 base = to_.base_color;
    set_surface(pbr_surface(base * (colors ? mean_color(*colors) : layers::vec3(1)), dielectric_of(from_),
                            metallic * textures_.mean_of(map, 2),
                            number_of(pbr, "roughnessFactor", 1) * roughness.mean));
    if (!bake(pbr, colors, metallic))
      to_.base_color = base * static_cast<float>(pbr_color_share(metallic * textures_.mean_of(map, 2)));
  }

  void set_surface(const PbrSurface& surface) {
    to_.specular = surface.specular;
    to_.shininess = surface.shininess;
  }

  /// Metalness and occlusion in the colour texture, where they are looked up as it is. True: the metalness is in it.
  bool bake(const Json& pbr, const layers::Texture* colors, double metallic) {
    const Json &metals = object_of(pbr, "metallicRoughnessTexture"),
               &shades = object_of(from_, "occlusionTexture");
    MapsToBake maps{colors, textures_.content_of(metals), textures_.content_of(shades), metallic,
                    std::clamp(number_of(shades, "strength", 1), 0.0, 1.0)};
    if (metallic == 0) maps.metallic = nullptr;
    const GltfCoordinates common = coordinates_of(colors          ? object_of(pbr, "baseColorTexture")
                                                  : maps.metallic ? metals
                                                                  : shades);
    if (maps.metallic && !(coordinates_of(metals) == common)) {
      import_.lacks("metalness maps with coordinates of their own are drawn as their mean", to_.name);
      maps.metallic = nullptr, maps.metallic_factor *= textures_.mean_of(metals, 2);
    }
    if (maps.occlusion && !(coordinates_of(shades) == common)) {
      import_.lacks("occlusion maps with coordinates of their own are not drawn", to_.name);
      maps.occlusion = nullptr;
    }
    if (!maps.metallic && !maps.occlusion) return false;
    const bool opaque = alpha_mode() == "OPAQUE";
    const std::string combination = pbr.dump() + shades.dump() + (opaque ? "opaque" : "");
    const int texture = textures_.baked(combination, opaque, maps);
    if (texture < 0) return true;
    to_.texture = texture;
    maps_.base = common;
    maps_.has_base_map = true;
    return true;
  }

  void read_gloss(const Json& gloss) {
    read_base(gloss, "diffuseFactor", "diffuseTexture");
    const Json& map = object_of(gloss, "specularGlossinessTexture");
    if (!map.empty()) import_.lacks("specular-glossiness maps are drawn as their mean", to_.name);
    const double glossiness = number_of(gloss, "glossinessFactor", 1) * textures_.mean_of(map, 3);
    set_surface(pbr_surface(to_.base_color, color_of(numbers_of(gloss, "specularFactor", 3, {1, 1, 1})), 0,
                            1 - glossiness));
  }

  void read_emission() {
    const Json* strength = extension_of(from_, "KHR_materials_emissive_strength");
    const double factor = strength ? std::max(0.0, number_of(*strength, "emissiveStrength", 1)) : 1;
    to_.emissive = static_cast<float>(factor) * color_of(numbers_of(from_, "emissiveFactor", 3, {0, 0, 0}));
    const Json& info = object_of(from_, "emissiveTexture");
    if (info.empty() || to_.emissive == layers::vec3(0)) return;
    to_.emissive_texture = textures_.of(info, true);
    maps_.emissive = coordinates_of(info);
    maps_.has_emissive_map = to_.emissive_texture >= 0;
    if (!maps_.has_emissive_map) to_.emissive = layers::vec3(0);  // the factor alone would glow all over
  }

  /// Normals are asked for by lights alone.
  void read_normal_map() {
    const Json& info = object_of(from_, "normalTexture");
    const double scale = number_of(info, "scale", 1);
    if (info.empty() || to_.unlit || scale == 0) return;
    to_.normal_texture = textures_.of(info, true);
    to_.normal_scale = static_cast<float>(scale);
    maps_.normal = coordinates_of(info);
    maps_.has_normal_map = to_.normal_texture >= 0;
  }

  void name_what_is_left_out() {
    if (to_.unlit) return;
    if (const Json* specular = extension_of(from_, "KHR_materials_specular"))
      if (specular->contains("specularTexture") || specular->contains("specularColorTexture"))
        import_.lacks("specular maps are not drawn", to_.name);
  }

  GltfImport& import_;
  Textures& textures_;
  const Json& from_;
  layers::Material& to_;
  GltfMaterial& maps_;
};

}  // namespace

void import_gltf_materials(GltfImport& import) {
  Textures textures(import);
  const std::size_t count = list_of(import.file.json, "materials").size();
  for (std::size_t i = 0; i <= count; ++i) {
    static const Json kDefault = Json::object();
    const Json& from = i < count ? item_of(import.file, "materials", static_cast<int>(i)) : kDefault;
    layers::Material to;
    to.name = text_of(from, "name", i < count ? "material " + std::to_string(i) : "default");
    GltfMaterial maps;
    Reading(import, textures, from, to, maps).read();
    import.model.scene.materials.push_back(to);
    import.materials.push_back(maps);
  }
}

}  // namespace talisman::sequences
