// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a sequence file says about its scene, as data: read from YAML without opening any asset.
/// `build_scene` then opens the assets. All units are those of the file: metres, seconds, degrees
/// (docs/sequence-format.md).

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "layers/layer.h"
#include "sequences/content/ground.h"
#include "sequences/content/shapes.h"
#include "sequences/content/sky.h"
#include "sequences/content/yaml_reader.h"
#include "sequences/import/model_import.h"

namespace talisman::sequences {

/// Where something stands, or how it flies and turns.
struct Motion {
  std::string carried_by;  ///< id of the shape with which it moves; empty: it moves in the world
  std::string file;        ///< and line: where it is written, for errors that show only with the scene
  int line = 0;
  layers::Transform rest;
  std::optional<layers::FlightTrack> flight;
  std::optional<layers::SpinTrack> spin;
};

struct ModelInstance {
  std::string name;  ///< of its node; its parts are called name/…
  Motion motion;
};

struct ModelRecipe {
  std::string file;
  double scale = 1;
  std::optional<double> length_m;   ///< instead of scale: the longest side of the bounds
  layers::dvec3 turn_deg{0, 0, 0};  ///< about x, then y, then z
  bool centered = false;            ///< the middle of the bounds becomes the origin
  bool two_sided = false;           ///< for files with careless windings
  std::vector<ModelInstance> instances;
};

struct ShapeRecipe {
  ShapeContent content;
  std::vector<ModelInstance> instances;  ///< parts are called like them
};

struct CameraRecipe {
  double fov_deg = 50, near_m = 0.1, far_m = 10000;
  Motion motion;
};

struct SceneRecipe {
  std::vector<ShapeRecipe> shapes;
  std::vector<ModelRecipe> models;
  std::optional<TerrainContent> terrain;
  std::optional<SkyContent> sky;
  std::optional<CameraRecipe> camera;
  std::vector<layers::Light> lights;
  std::vector<std::optional<Motion>> light_motions;  ///< one per light; empty: it stands in the world
  layers::vec3 background{0, 0, 0};
};

/// Takes the keys background, shapes, models, terrain, sky, camera and lights out of the map; leaves the
/// others alone.
SceneRecipe read_scene_recipe(YamlMap& sequence);

struct BuiltScene {
  layers::Scene scene;
  std::vector<LayerTag> layer_tags;
  std::vector<std::string> warnings;
  std::vector<std::string> files = {};       ///< that were opened for it: Sequence::content_files
  std::map<std::string, int> carriers = {};  ///< the node of each shape that can carry others, by its name
};

/// Opens the assets. Where the recipe has no camera or no light, the scene gets the defaults of
/// `add_default_view`; cameras and lights inside its models are not used.
BuiltScene build_scene(const SceneRecipe& recipe);

/// An orbit around all parts (one turn in 5 s, seen slightly from above) if there is no camera; a sun and
/// ambient light if there is no light. Any unit scale is framed.
void add_default_view(layers::Scene& scene);

/// Bounds of all parts over the scene's duration (sampled at 9 times).
layers::WorldBounds bounds_of_scene(const layers::Scene& scene);

}  // namespace talisman::sequences
