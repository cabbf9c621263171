// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/images/place_images.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "layers/glob.h"
#include "sequences/content/images/picture_source.h"
#include "sequences/content/nearest_word.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

constexpr double kBehindFar = 10,
                 kBetween = 0.01;  // of several each lies a hundredth nearer than the one before it

/// Two triangles of side 1 around the origin, facing +z; the picture upright.
layers::Mesh unit_rectangle() {
  layers::Mesh mesh;
  mesh.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// Opens the source. Returns the texture that materials name.
int add_source(BuiltScene& built, const ImageRecipe& image, const ShownTimes& times, layers::Wrap wrap_u,
               layers::Wrap wrap_v) {
  PictureSource source = read_source(image, times);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(built.files, source.files);
  append(built.warnings, source.warnings);
  append(built.notes, source.notes);
  layers::Scene& scene = built.scene;
  const int first = static_cast<int>(scene.textures.size());
  bool has_alpha = false;
  for (layers::Texture& texture : source.textures) {
    texture.wrap_u = wrap_u;
    texture.wrap_v = wrap_v;
    has_alpha |= texture.has_alpha;
    source.timing.textures.push_back(static_cast<int>(scene.textures.size()));
    scene.textures.push_back(std::move(texture));
  }
  scene.textures[static_cast<std::size_t>(first)].has_alpha = has_alpha;  // what is said of it holds for all
  source.timing.texture = first;
  if (source.timing.frames.size() > 1) scene.moving_pictures.push_back(std::move(source.timing));
  return first;
}

/// The part of a rectangle below `parent`; it has its layer's name.
void add_rectangle(BuiltScene& built, const ImageRecipe& image, const ShownTimes& times, int parent,
                   const layers::Transform& local) {
  layers::Scene& scene = built.scene;
  layers::Material material;
  material.name = image.id;
  material.base_color = layers::vec3(1);
  material.unlit = material.two_sided = true;
  material.opacity = image.opacity;
  material.texture = add_source(built, image, times, layers::Wrap::Clamp, layers::Wrap::Clamp);
  const int node = static_cast<int>(scene.nodes.size());
  scene.nodes.push_back({image.id, parent, local});
  if (!built.carriers.emplace(image.id, parent).second)
    throw InputError(
        "image '" + image.id + "' has the name of another shape or image, rule: names are unique", image.file,
        image.line);
  scene.parts.push_back(
      {image.id, node, static_cast<int>(scene.meshes.size()), static_cast<int>(scene.materials.size()), -1});
  built.layer_tags.push_back({node, image.id});
  scene.meshes.push_back(unit_rectangle());
  scene.meshes.back().name = image.id;
  scene.materials.push_back(std::move(material));
}

/// The parts that one glob names; their meshes have texture coordinates.
std::vector<std::size_t> parts_named(const layers::Scene& scene, const ImageRecipe& image,
                                     const std::string& glob) {
  std::vector<std::size_t> parts;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    names.push_back(scene.parts[i].name);
    if (layers::glob_matches(glob, scene.parts[i].name)) parts.push_back(i);
  }
  if (parts.empty())
    throw InputError("image '" + image.id + "': on '" + glob +
                         "' matches no part, rule: each matches a part" + did_you_mean(glob, names),
                     image.file, image.line);
  for (const std::size_t part : parts)
    if (scene.meshes[static_cast<std::size_t>(scene.parts[part].mesh)].uvs.empty())
      throw InputError("image '" + image.id + "': part '" + scene.parts[part].name +
                           "' has no texture coordinates, rule: a part that can show a picture",
                       image.file, image.line);
  return parts;
}

/// Each material of these parts is copied, since others may have it as well.
void add_on_parts(BuiltScene& built, const ImageRecipe& image, const ShownTimes& times) {
  layers::Scene& scene = built.scene;
  std::map<int, int> copy_of;
  int texture = -1;
  for (const std::string& glob : image.part_globs)
    for (const std::size_t index : parts_named(scene, image, glob)) {
      layers::Part& part = scene.parts[index];
      const layers::Material& old = scene.materials[static_cast<std::size_t>(part.material)];
      if (texture >= 0 && old.texture == texture) continue;  // named twice
      if (texture < 0) {
        using layers::Wrap;
        const layers::Texture plain;
        const layers::Texture& before = old.texture >= 0 ? scene.textures[old.texture] : plain;
        const Wrap wrap_u = before.wrap_u, wrap_v = before.wrap_v;
        texture = add_source(built, image, times, wrap_u, wrap_v);
      }
      const auto [copy, is_new] = copy_of.emplace(part.material, static_cast<int>(scene.materials.size()));
      if (is_new) {
        layers::Material material = scene.materials[static_cast<std::size_t>(part.material)];
        material.name += " with " + image.id;
        material.texture = texture;
        material.opacity *= image.opacity;
        scene.materials.push_back(std::move(material));
      }
      part.material = copy->second;
    }
}

/// Seen from the camera: a rectangle of so many pixels of the file's display. `after`: images that follow it.
layers::Transform place_on_screen(const layers::Scene& scene, const ImageRecipe& image,
                                  const ShownTimes& times, std::ptrdiff_t after) {
  const layers::Camera& camera = scene.cameras[static_cast<std::size_t>(scene.active_camera)];
  const double nearest = image.behind ? kBehindFar * camera.far_m : camera.near_m;
  const double depth = nearest * (1 + kBetween * static_cast<double>(after + 1));
  const double px_m = 2 * depth * std::tan(camera.fov_y_rad / 2) / times.display_px.y;
  const layers::dvec4& at = *image.screen_px;
  const layers::dvec2 middle_px =
      layers::dvec2(at) + 0.5 * layers::dvec2(at.z, at.w) - 0.5 * layers::dvec2(times.display_px);
  // A camera's own matrix has no scale; that of the node which carries it may.
  dvec3 scale(1);
  if (camera.node >= 0) {
    const layers::dmat4 world = scene.at(0).world_from_node[static_cast<std::size_t>(camera.node)];
    for (int axis = 0; axis < 3; ++axis) scale[axis] = glm::length(dvec3(world[axis]));
  }
  layers::Transform local;
  local.translation = dvec3(middle_px.x * px_m, -middle_px.y * px_m, -depth) / scale;
  local.scale = dvec3(at.z * px_m, at.w * px_m, 1) / scale;
  return local;
}

}  // namespace

void add_images_in_world(BuiltScene& built, const std::vector<ImageRecipe>& images, const ShownTimes& times) {
  for (const ImageRecipe& image : images) {
    if (!image.part_globs.empty()) add_on_parts(built, image, times);
    if (!image.size_m) continue;
    layers::Transform size;
    size.scale = dvec3(*image.size_m, 1);
    add_rectangle(built, image, times, add_motion(built, image.id, image.motion), size);
  }
}

void add_images_on_screen(BuiltScene& built, const std::vector<ImageRecipe>& images,
                          const ShownTimes& times) {
  for (const ImageRecipe& image : images) {
    if (!image.screen_px) continue;
    const std::ptrdiff_t after = &images.back() - &image;
    const int camera = built.scene.cameras[static_cast<std::size_t>(built.scene.active_camera)].node;
    add_rectangle(built, image, times, camera, place_on_screen(built.scene, image, times, after));
  }
}

void add_image_layers(const std::vector<ImageRecipe>& images, std::vector<layers::LayerSpec>& specs) {
  for (const ImageRecipe& image : images) {
    if (!image.part_globs.empty()) continue;
    const auto takes = [&](const layers::LayerSpec& spec) {
      return std::any_of(spec.part_globs.begin(), spec.part_globs.end(),
                         [&](const std::string& glob) { return layers::glob_matches(glob, image.id); });
    };
    auto spec = std::find_if(specs.begin(), specs.end(), takes);
    if (spec == specs.end())
      spec = specs.insert(
          specs.end(),
          layers::LayerSpec{image.id, {layers::glob_of_name(image.id)}, layers::OrderGroup::Normal, {}});
    if (image.screen_px && spec->name == image.id)
      spec->group = image.behind ? layers::OrderGroup::Background : layers::OrderGroup::Foreground;
  }
}

}  // namespace talisman::sequences
