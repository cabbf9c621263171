// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/starter/starter.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "sequences/content/asset_paths.h"
#include "sequences/content/bare_model.h"
#include "sequences/content/factoring/layers_yaml.h"
#include "sequences/content/nearest_word.h"
#include "sequences/content/sequence_file.h"
#include "sequences/content/starter/documented_keys.h"
#include "sequences/content/starter/part_globs.h"
#include "sequences/files/how_many.h"
#include "sequences/files/quoted.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

const MapKeys& top() { return sequence_keys().keys(); }

struct Source {
  std::string path, id;
  const ContentOptions& options;
  BareModel bare;
  ModelStage stage;
  std::string ground;  ///< name of its layer
};

/// Degrees that read back as these radians, where there are any.
std::string degrees_text(double radians) {
  const double nearest = glm::degrees(radians);
  double degrees = nearest;
  for (int k = 0; k < 4 && glm::radians(degrees) < radians; ++k) degrees = std::nextafter(degrees, HUGE_VAL);
  for (int k = 0; k < 4 && glm::radians(degrees) > radians; ++k) degrees = std::nextafter(degrees, -HUGE_VAL);
  return yaml_number(glm::radians(degrees) == radians ? degrees : nearest);
}

void add_head(DocumentedKeys& out, const Source& source) {
  YamlPage& page = out.page();
  page.comment("", "Made by `talisman init` from " + yaml_text(source.path) +
                       ": it shows what the model shows by itself, and every key that may be changed.");
  page.line("#");
  page.line(
      "#   talisman render THIS.yaml --frames 0-47   frames of two seconds, and a table of what was drawn");
  page.line("#   talisman plan THIS.yaml                   the table alone, without pixels");
  page.line("#   talisman inspect THIS.yaml --parts        nodes, parts and their sizes");
  page.line("#");
  page.comment(
      "",
      "Lengths are metres, times seconds, angles degrees; y is up, and everything looks along its "
      "own -z. Colours are [r, g, b] in linear light or \"#rrggbb\". A key that stands behind a # is "
      "not set: what it says, or \"without it\", holds.");
}

void add_film(DocumentedKeys& out, const Source& source) {
  out.page().line("");
  out.off("", top(), "name");
  out.put("", top(), "frames", std::to_string(source.bare.frames));
  out.put("", top(), "fps", yaml_number(source.bare.fps));
  out.standard("", top(), "display");
  out.off("", top(), "packages");
  out.off("", top(), "extends");
}

void add_model(DocumentedKeys& out, const Source& source) {
  const MapKeys& keys = keys_below(top(), "models");
  out.page().line("");
  out.put("", top(), "models", "");
  out.put("  - ", keys, "id", yaml_text(source.id));
  out.put("    ", keys, "file", yaml_text(source.path));
  out.standard("    ", keys, "scale");
  for (const char* key : {"length_m"}) out.off("    ", keys, key);
  for (const char* key : {"turn_deg", "centered", "two_sided"}) out.standard("    ", keys, key);
  out.put("    ", keys, "lights", source.bare.model.scene.lights.empty() ? "false" : "true");
  for (const char* key : {"position", "rotation_deg", "look_at", "flight", "spin", "instances"})
    out.off("    ", keys, key);
  std::vector<std::string> folders;
  for (const std::string& folder : source.options.assets) folders.push_back(yaml_text(folder));
  if (folders.empty()) return out.off("", top(), "assets");
  out.put("", top(), "assets", yaml_list(folders));
}

/// A camera of the file: it alone moves as the file says.
void add_camera_of_model(DocumentedKeys& out, const Source& source) {
  const MapKeys& keys = keys_below(top(), "camera");
  const std::vector<layers::Camera>& cameras = source.bare.model.scene.cameras;
  out.put("", top(), "camera", "");
  out.put("  ", keys, "model", yaml_text(source.id));
  if (!cameras.front().name.empty()) out.put("  ", keys, "named", yaml_text(cameras.front().name));
  std::vector<std::string> others;
  for (std::size_t k = 1; k < cameras.size(); ++k) others.push_back(cameras[k].name);
  if (!others.empty()) out.page().comment("  ", "Others in the file: " + quoted(others));
  out.page().comment("  ", "Instead of model, a camera of the sequence's own:");
  for (const char* key : {"fov_deg", "near_m", "far_m", "orbit", "position", "look_at", "flight"})
    out.off("  ", keys, key);
  out.off("", top(), "turntable");
}

void add_orbit(DocumentedKeys& out, const Orbit& orbit) {
  const MapKeys &keys = keys_below(top(), "camera"), &orbit_keys = keys_below(keys, "orbit");
  out.put("", top(), "camera", "");
  out.put("  ", keys, "fov_deg", degrees_text(orbit.fov_y_rad));
  out.put("  ", keys, "near_m", yaml_number(orbit.near_m));
  out.put("  ", keys, "far_m", yaml_number(orbit.far_m));
  out.put("  ", keys, "orbit", "");
  out.put("    ", orbit_keys, "center", yaml_vector(orbit.center));
  out.put("    ", orbit_keys, "distance_m", yaml_number(orbit.distance_m));
  out.put("    ", orbit_keys, "elevation_deg", degrees_text(orbit.elevation_rad));
  out.page().comment("  ", "Instead of orbit, a camera that stands, flies or is a model's:");
  const dvec3 from = orbit.center + orbit.distance_m * dvec3(0, std::sin(orbit.elevation_rad),
                                                             std::cos(orbit.elevation_rad));
  out.off("  ", keys, "position", written(from));
  out.off("  ", keys, "look_at", written(orbit.center));
  for (const char* key : {"rotation_deg", "flight", "spin", "carried_by", "model"}) out.off("  ", keys, key);
  out.put("", top(), "turntable", yaml_number(orbit.turn_s));
}

void add_light(DocumentedKeys& out, const layers::Light& light, bool is_first) {
  const MapKeys& keys = keys_below(top(), "lights");
  const bool is_ambient = light.kind == layers::Light::Kind::Ambient;
  const auto put = [&](const std::string& prefix, const char* key, const std::string& value) {
    if (is_first)
      out.put(prefix, keys, key, value);
    else
      out.page().key(prefix, key, value);
  };
  put("  - ", "kind", is_ambient ? "ambient" : "directional");
  put("    ", "name", yaml_text(light.name));
  put("    ", "color", "[1, 1, 1]");
  put("    ", "intensity", yaml_number(light.color.x));
  if (is_ambient) return;
  out.put("    ", keys, "direction", yaml_vector(light.direction));
  out.put("    ", keys, "casts_shadow", light.casts_shadow ? "true" : "false");
}

void add_lights(DocumentedKeys& out, const Source& source) {
  out.page().line("");
  if (source.stage.lights.empty()) {
    out.page().comment("", "The lights are those of the file (`lights` of the model); more may stand here.");
    out.off("", top(), "lights");
  } else {
    out.put("", top(), "lights", "");
    for (const layers::Light& light : source.stage.lights)
      add_light(out, light, &light == &source.stage.lights.front());
  }
  // Those of the file come divided by its own exposure.
  const double divided = source.stage.lights.empty() ? source.bare.model.exposure_lx : 1;
  out.put("", top(), "exposure", yaml_number(source.options.exposure_lx.value_or(divided) / divided));
}

void add_surroundings(DocumentedKeys& out, const Source& source) {
  out.page().line("");
  out.put("", top(), "background",
          yaml_color(source.stage.backdrop.value_or(source.bare.model.scene.background)));
  for (const char* key :
       {"sky", "terrain", "images", "swarm", "building", "cells", "portals", "visibility", "cuts"})
    out.off("", top(), key);
  if (!source.stage.ground) return out.off("", top(), "shapes");
  const MapKeys& keys = keys_below(top(), "shapes");
  const StageGround& ground = *source.stage.ground;
  out.put("", top(), "shapes", "");
  out.page().comment(
      "  ", "A ground that has the backdrop's colour where it is lit: only the shadow on it is seen.");
  out.put("  - ", keys, "id", "ground");
  out.put("    ", keys, "disc", yaml_number(2 * ground.radius_m));
  out.put("    ", keys, "segments", std::to_string(ground.segments));
  out.put("    ", keys, "color", yaml_color(ground.color));
  out.put("    ", keys, "position", yaml_vector(ground.place));
}

std::string description_of(const layers::Layer& layer, const layers::Scene& scene) {
  const std::string motion = layer.rigid_node >= 0
                                 ? "follows the node '" + scene.nodes[layer.rigid_node].name + "'"
                                 : "its parts move against each other, or deform";
  return how_many(layer.parts.size(), "part") + ", " + how_many(layer.polygons, "polygon") + "; " + motion;
}

void add_layer_options(DocumentedKeys& out) {
  const MapKeys& keys = keys_below(top(), "layers");
  for (const char* key : {"group", "fade", "casts_shadows", "preferences"}) out.off("    ", keys, key);
  out.standards("    #   ", keys_below(keys, "preferences"));
  out.off("    ", keys, "shading");
  for (const char* key : {"shadows", "specular", "reflection", "textures"})
    out.put("    #   ", keys_below(keys, "shading"), key, "{}");
}

void add_ground_layer(YamlPage& page, const Source& source) {
  page.key("  - ", "name", yaml_text(source.ground));
  page.key("    ", "parts", "[ground]");
  page.key("    ", "casts_shadows", "false");
  page.key("    ", "shading", "{shadows: {as: shade}}",
           "one light casts: black over what it lights is exact");
}

void add_order(DocumentedKeys& out, const Source& source) {
  if (source.bare.order.empty()) return out.off("", top(), "order");
  std::vector<layers::LayerSpec> specs = source.bare.specs;
  specs.emplace_back().name = source.ground;
  out.page().comment("", out.meaning(top(), "order"));
  std::string text = order_yaml(specs, source.bare.order);
  text.pop_back();
  out.page().line(text);
}

void add_layers(DocumentedKeys& out, const Source& source) {
  const MapKeys& keys = keys_below(top(), "layers");
  const layers::Scene& scene = source.bare.model.scene;
  const layers::LayerSet set = layers::factor(scene, source.bare.specs);
  std::vector<std::string> names;
  for (const layers::Part& part : scene.parts) names.push_back(source.id + "/" + part.name);
  const auto globs = part_globs(set.layers, names);
  out.page().line("");
  out.put("", top(), "layers", "");
  std::size_t k = 0;
  for (const layers::Layer& layer : set.layers) {
    if (layer.base >= 0) continue;
    std::vector<std::string> items;
    for (const std::string& glob : globs[k]) items.push_back(yaml_text(glob));
    out.page().comment("  ", description_of(layer, scene));
    out.page().key("  - ", "name", yaml_text(layer.name), k == 0 ? out.meaning(keys, "name") : "");
    out.page().list("    ", "parts", items, k == 0 ? out.meaning(keys, "parts") : "");
    const std::string preferences = preferences_yaml(layer.preferences);
    if (!preferences.empty()) out.page().key("    ", "preferences", preferences);
    if (k++ == 0) add_layer_options(out);
  }
  if (source.stage.ground) add_ground_layer(out.page(), source);
  add_order(out, source);
}

void add_pipeline(DocumentedKeys& out) {
  out.page().line("");
  out.put("", top(), "regulator", "");
  out.standards("  ", keys_below(top(), "regulator"));
  out.page().line("");
  for (const char* key : {"warp", "bound", "cycles", "compositor", "material_points", "seam"})
    out.standard("", top(), key);
  out.off("", top(), "clip_margin");
  for (const char* key : {"extents", "placement"}) {
    out.put("", top(), key, "");
    out.standards("  ", keys_below(top(), key));
  }
  out.off("", top(), "compression");
  out.standards("#   ", keys_below(top(), "compression"));
}

void require_model(const std::string& path) {
  std::error_code error;
  const std::string extension = std::filesystem::path(path).extension().string();
  const bool is_there = std::filesystem::is_regular_file(path, error);
  if (!sequence_file_of(path).empty() || (is_there && (extension == ".yaml" || extension == ".yml")))
    throw InputError("'" + path + "' is a sequence already, must be a model");
  if (std::filesystem::is_directory(path, error))
    throw InputError("'" + path + "' is a folder, must be the path of a model");
  if (!is_there) throw InputError("'" + path + "' is not there, must be the path of a model");
}

/// As load_sequence calls it.
std::string name_of_ground(const std::vector<layers::LayerSpec>& specs) {
  std::set<std::string> names;
  for (const layers::LayerSpec& spec : specs) names.insert(spec.name);
  return unused_name(names, "ground");
}

}  // namespace

std::string id_of_model(const std::string& path) {
  std::string id = std::filesystem::path(path).stem().string();
  for (char& c : id)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return id.empty() ? "model" : id;
}

Starter starter_sequence(const std::string& path, const ContentOptions& options) {
  require_model(path);
  Source source{path, id_of_model(path), options, read_bare_model(path, options), {}, {}};
  source.stage = model_stage(source.bare.model.scene, source.bare.view);
  source.ground = name_of_ground(source.bare.specs);
  DocumentedKeys out;
  add_head(out, source);
  add_film(out, source);
  add_model(out, source);
  out.page().line("");
  if (source.stage.orbit)
    add_orbit(out, *source.stage.orbit);
  else
    add_camera_of_model(out, source);
  add_lights(out, source);
  add_surroundings(out, source);
  add_layers(out, source);
  add_pipeline(out);
  Starter starter{out.page().text(), {}, {}};
  for (const std::string& warning : source.bare.model.warnings)
    starter.warnings.push_back(path + ": " + warning);
  for (const std::string& note : source.bare.model.notes) starter.notes.push_back(path + ": " + note);
  return starter;
}

}  // namespace talisman::sequences
