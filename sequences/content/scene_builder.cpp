// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/glob.h"
#include "layers/layer.h"
#include "sequences/content/default_view.h"
#include "sequences/content/images/place_images.h"
#include "sequences/content/nearest_word.h"
#include "sequences/files/quoted.h"
#include "sequences/import/texture_io.h"

namespace talisman::sequences {

namespace {

int add_node(layers::Scene& scene, const std::string& name, int parent, const layers::Transform& local = {}) {
  scene.nodes.push_back({name, parent, local});
  return static_cast<int>(scene.nodes.size()) - 1;
}

/// The node below which a motion takes place; -1: the world.
int carrier_of(const BuiltScene& built, const Motion& motion) {
  if (motion.carried_by.empty()) return -1;
  const auto found = built.carriers.find(motion.carried_by);
  if (found == built.carriers.end())
    throw InputError("carried_by is '" + motion.carried_by + "', rule: the name of a shape before it",
                     motion.file, motion.line);
  return found->second;
}

}  // namespace

namespace {

/// The node that moves as what was tracked. What is said of the trace is said of the sequence.
int add_trace(BuiltScene& built, const std::string& name, int carrier, const TraceOptions& options) {
  Trace trace = read_trace(options, built.last_s);
  built.files.push_back(options.file);
  built.warnings.insert(built.warnings.end(), trace.warnings.begin(), trace.warnings.end());
  built.notes.insert(built.notes.end(), trace.notes.begin(), trace.notes.end());
  const int node = add_node(built.scene, name, carrier);
  built.scene.tracks.push_back({node, track_of(std::move(trace), options.resample)});
  return node;
}

}  // namespace

/// The node (with others above and below it for a trace and a spin, so that the motions add up) that carries something;
/// returns the lowest.
int add_motion(BuiltScene& built, const std::string& name, const Motion& motion) {
  layers::Scene& scene = built.scene;
  int carrier = carrier_of(built, motion);
  if (motion.trace) carrier = add_trace(built, name, carrier, *motion.trace);
  const bool is_placed =
      motion.rest.translation != layers::dvec3(0) || motion.rest.rotation != glm::dquat(1, 0, 0, 0);
  int node = motion.trace && !is_placed ? carrier : add_node(scene, name, carrier, motion.rest);
  if (motion.flight) scene.tracks.push_back({node, *motion.flight});
  if (!motion.spin) return node;
  node = add_node(scene, name, node);
  scene.tracks.push_back({node, *motion.spin});
  return node;
}

namespace {

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

int shifted(int index, std::size_t by) { return index < 0 ? index : index + static_cast<int>(by); }

/// Meshes, textures and materials of a model are stored once, however many instances there are.
struct SharedContent {
  std::size_t meshes, materials;
};

SharedContent add_content(layers::Scene& scene, const layers::Scene& model, bool two_sided) {
  const SharedContent at{scene.meshes.size(), scene.materials.size()};
  for (layers::Material material : model.materials) {
    material.texture = shifted(material.texture, scene.textures.size());
    material.texture2 = shifted(material.texture2, scene.textures.size());
    material.emissive_texture = shifted(material.emissive_texture, scene.textures.size());
    material.normal_texture = shifted(material.normal_texture, scene.textures.size());
    material.two_sided |= two_sided;
    scene.materials.push_back(std::move(material));
  }
  append(scene.meshes, model.meshes);
  append(scene.textures, model.textures);
  return at;
}

/// Where an instance goes.
struct InstancePlace {
  std::string name;
  int carrier = -1;
  double scale = 1;
  bool with_lights = false;
};

/// What a sequence may, or may not, use of a model's own. What stands in the file's world stands in its carrier's
/// space; lengths are scaled with the model, so that light falls off over it as in the file.
void add_view(BuiltScene& built, const layers::Scene& model, const InstancePlace& place, std::size_t nodes) {
  const auto placed = [&](int node) { return node < 0 ? place.carrier : shifted(node, nodes); };
  for (layers::Camera camera : model.cameras) {
    camera.node = placed(camera.node);
    camera.near_m *= place.scale;
    camera.far_m *= place.scale;
    built.model_cameras.push_back({place.name, std::move(camera)});
  }
  if (!place.with_lights) return;
  for (layers::Light light : model.lights) {
    light.node = placed(light.node);
    light.attenuation /= layers::dvec3(1, place.scale, place.scale * place.scale);
    light.range_m *= place.scale;
    built.scene.lights.push_back(std::move(light));
  }
}

/// Nodes, skins, tracks and parts of one instance below its carrier.
void add_instance(BuiltScene& built, const ImportedModel& model, const SharedContent& content,
                  const InstancePlace& place) {
  layers::Scene& scene = built.scene;
  const std::size_t nodes = scene.nodes.size(), skins = scene.skins.size();
  for (layers::Node node : model.scene.nodes) {
    node.parent = node.parent < 0 ? place.carrier : shifted(node.parent, nodes);
    scene.nodes.push_back(std::move(node));
  }
  for (layers::Skin skin : model.scene.skins) {
    for (int& joint : skin.joints) joint = shifted(joint, nodes);
    scene.skins.push_back(std::move(skin));
  }
  for (layers::Track track : model.scene.tracks) {
    track.node = shifted(track.node, nodes);
    scene.tracks.push_back(std::move(track));
  }
  for (layers::Part part : model.scene.parts) {
    part.name = place.name + "/" + part.name;
    part.node = shifted(part.node, nodes);
    part.mesh = shifted(part.mesh, content.meshes);
    part.material = shifted(part.material, content.materials);
    part.skin = shifted(part.skin, skins);
    scene.parts.push_back(std::move(part));
  }
  for (const LayerTag& tag : model.layer_tags)
    built.layer_tags.push_back({shifted(tag.node, nodes), tag.layer});
  add_view(built, model.scene, place, nodes);
}

/// Turned, scaled and, if wished, centred.
layers::Transform fitting(const ModelRecipe& recipe, const layers::Scene& model) {
  layers::Transform fit;
  fit.rotation = glm::dquat(glm::radians(recipe.turn_deg));
  const layers::WorldBounds bounds = bounds_of_scene(model);
  double scale = recipe.scale;
  if (recipe.length_m && !bounds.empty()) {
    const layers::dvec3 size = bounds.hi - bounds.lo;
    const double longest = std::max({size.x, size.y, size.z});
    if (longest > 0) scale = *recipe.length_m / longest;
  }
  fit.scale = layers::dvec3(scale);
  if (recipe.centered && !bounds.empty())
    fit.translation = fit.rotation * (-0.5 * scale * (bounds.lo + bounds.hi));
  return fit;
}

bool is_among(const layers::Part& part, const std::vector<std::string>& globs) {
  return std::ranges::any_of(globs, [&](const auto& glob) { return layers::glob_matches(glob, part.name); });
}

/// Throws InputError for a glob that matches no part.
void check_globs(const layers::Scene& model, const std::string& key, const std::vector<std::string>& globs,
                 const std::string& file) {
  for (const std::string& glob : globs) {
    if (std::ranges::any_of(model.parts, [&](const auto& part) { return is_among(part, {glob}); })) continue;
    std::vector<std::string> names;
    for (const layers::Part& part : model.parts) names.push_back(part.name);
    throw InputError(
        key + " has '" + glob + "', rule: each matches a part of the file" + did_you_mean(glob, names), file);
  }
}

/// Only the parts that are asked for; cameras and lights stay.
void keep_parts(layers::Scene& model, const ModelRecipe& recipe) {
  check_globs(model, "parts", recipe.parts, recipe.file);
  check_globs(model, "without", recipe.without, recipe.file);
  std::erase_if(model.parts, [&](const layers::Part& part) {
    return (!recipe.parts.empty() && !is_among(part, recipe.parts)) || is_among(part, recipe.without);
  });
}

void add_model(BuiltScene& built, const ModelRecipe& recipe, const std::vector<std::string>& assets) {
  ImportedModel model = import_model(recipe.file, import_limits(), assets);
  keep_parts(model.scene, recipe);
  for (const std::string& warning : model.warnings) built.warnings.push_back(recipe.file + ": " + warning);
  append(built.files, files_read(model));
  const SharedContent content = add_content(built.scene, model.scene, recipe.two_sided);
  const layers::Transform fit = fitting(recipe, model.scene);
  for (const ModelInstance& instance : recipe.instances) {
    const int carrier = add_motion(built, instance.name, instance.motion);
    const int fitted = add_node(built.scene, "fit", carrier, fit);
    add_instance(built, model, content, {instance.name, fitted, fit.scale.x, recipe.lights});
  }
}

/// The texture of a shape runs over each face once: what lies across its edge must not bleed in. Around a
/// sphere and a cylinder it closes.
void wrap_around(const ShapeContent& shape, layers::Texture& texture) {
  using Kind = ShapeContent::Kind;
  const bool closed = shape.kind == Kind::Sphere || shape.kind == Kind::Cylinder;
  texture.wrap_u = closed ? layers::Wrap::Repeat : layers::Wrap::Clamp;
  texture.wrap_v = layers::Wrap::Clamp;
}

/// Named as textures of models are: where the content lies differs from machine to machine, and results name
/// it.
int add_texture(BuiltScene& built, const std::string& file, const ShapeContent& shape) {
  std::vector<layers::Texture>& textures = built.scene.textures;
  textures.push_back(read_texture(file));
  wrap_around(shape, textures.back());
  textures.back().name = std::filesystem::path(file).filename().string();
  built.files.push_back(file);
  return static_cast<int>(textures.size()) - 1;
}

void add_shape(BuiltScene& built, const ShapeRecipe& recipe) {
  layers::Scene& scene = built.scene;
  layers::Material material = recipe.content.material;
  const ShapeContent& content = recipe.content;
  if (!content.texture_file.empty()) material.texture = add_texture(built, content.texture_file, content);
  if (!content.second_texture_file.empty())
    material.texture2 = add_texture(built, content.second_texture_file, content);
  const int mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(shape_mesh(recipe.content));
  scene.meshes.back().name = material.name;
  for (const ModelInstance& instance : recipe.instances) {
    const int node = add_motion(built, instance.name, instance.motion);
    if (!built.carriers.emplace(instance.name, node).second)
      throw InputError("two shapes are called '" + instance.name + "', rule: names are unique",
                       instance.motion.file, instance.motion.line);
    scene.parts.push_back({instance.name, node, mesh, static_cast<int>(scene.materials.size()), -1});
  }
  scene.materials.push_back(std::move(material));
}

const layers::Camera& camera_of_model(const BuiltScene& built, const CameraRecipe& recipe) {
  std::vector<std::string> models, cameras;
  for (const ModelCamera& there : built.model_cameras) {
    models.push_back(there.model);
    if (there.model != recipe.model) continue;
    if (recipe.named.empty() || there.camera.name == recipe.named) return there.camera;
    cameras.push_back(there.camera.name);
  }
  const std::string what = cameras.empty() ? "camera is of model '" + recipe.model +
                                                 "', rule: the name of an instance with a camera" +
                                                 did_you_mean(recipe.model, models)
                                           : "camera is '" + recipe.named + "', rule: a camera of model '" +
                                                 recipe.model + "': " + quoted(cameras);
  throw InputError(what, recipe.motion.file, recipe.motion.line);
}

void add_camera(BuiltScene& built, const CameraRecipe& recipe, double turn_s) {
  layers::Scene& scene = built.scene;
  if (!recipe.model.empty()) {
    scene.cameras.push_back(camera_of_model(built, recipe));
    return;
  }
  const double fov_y_rad = glm::radians(recipe.fov_deg);
  if (recipe.orbit) {
    const OrbitRecipe& orbit = *recipe.orbit;
    add_orbit(scene, {orbit.center, orbit.distance_m, orbit.elevation_rad, turn_s, fov_y_rad, recipe.near_m,
                      recipe.far_m});
    return;
  }
  layers::Camera camera;
  camera.name = "camera";
  camera.node = add_motion(built, "camera", recipe.motion);
  camera.fov_y_rad = fov_y_rad;
  camera.near_m = recipe.near_m;
  camera.far_m = recipe.far_m;
  scene.cameras.push_back(camera);
}

void add_lights(BuiltScene& built, const std::vector<LightRecipe>& recipes) {
  for (std::size_t i = 0; i < recipes.size(); ++i) {
    layers::Light light = recipes[i].light;
    light.color *= static_cast<float>(recipes[i].intensity);
    const std::string name = light.name.empty() ? "light " + std::to_string(i) : light.name;
    if (recipes[i].moves) light.node = add_motion(built, name, recipes[i].motion);
    built.scene.lights.push_back(std::move(light));
  }
}

/// Those of terrain and sky; a class of ground that no pixel has may name a texture that is not there.
std::vector<std::string> files_of(const SceneRecipe& recipe) {
  std::vector<std::string> files;
  if (recipe.sky) files.push_back(recipe.sky->clouds_file);
  if (recipe.terrain) {
    files.insert(files.end(),
                 {recipe.terrain->heights_file, recipe.terrain->classes_file, recipe.terrain->list_file});
    for (const GroundClass& ground : recipe.terrain->classes) files.push_back(ground.texture_file);
  }
  std::erase_if(files, [](const std::string& file) { return !std::filesystem::is_regular_file(file); });
  return files;
}

}  // namespace

BuiltScene build_scene(const SceneRecipe& recipe) {
  BuiltScene built;
  built.scene.background = recipe.background;
  built.files = files_of(recipe);
  built.last_s = recipe.times.last_s();
  if (recipe.sky) add_sky(built.scene, *recipe.sky);
  if (recipe.terrain) add_terrain(built.scene, *recipe.terrain);
  for (const ShapeRecipe& shape : recipe.shapes) add_shape(built, shape);
  for (const ModelRecipe& model : recipe.models) add_model(built, model, recipe.assets);
  add_images_in_world(built, recipe.images, recipe.times);
  if (recipe.swarm) add_swarm(built.scene, *recipe.swarm, recipe.times.fps, recipe.times.last_s());
  if (recipe.building) built.cells = add_building(built.scene, *recipe.building);
  add_cells(recipe.cells, recipe.portals, built.cells);
  if (recipe.camera) add_camera(built, *recipe.camera, recipe.turntable_s);
  add_lights(built, recipe.lights);
  add_default_view(built.scene, recipe.turntable_s);
  add_images_on_screen(built, recipe.images, recipe.times);
  for (layers::Light& light : built.scene.lights) light.color /= static_cast<float>(recipe.exposure_lx);
  return built;
}

}  // namespace talisman::sequences
