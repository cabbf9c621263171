// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a sequence file says about its scene, as data: read from YAML without opening any asset; scene_builder.h
/// then opens them. All units are those of the file: metres, seconds, degrees (docs/sequence-format.md).

#include <optional>
#include <string>
#include <vector>

#include "sequences/content/culling/building.h"
#include "sequences/content/culling/cell_keys.h"
#include "sequences/content/ground.h"
#include "sequences/content/images/image_recipe.h"
#include "sequences/content/lights.h"
#include "sequences/content/motion.h"
#include "sequences/content/shapes.h"
#include "sequences/content/sky.h"
#include "sequences/content/swarm/swarm.h"

namespace talisman::sequences {

struct ModelInstance {
  std::string name;  ///< of its node; its parts are called name/…
  Motion motion;
};

struct ModelRecipe {
  std::string file;
  std::vector<std::string> parts, without;  ///< globs: what is taken (empty: all), and what of it is not
  double scale = 1;
  std::optional<double> length_m;   ///< instead of scale: the longest side of the bounds
  layers::dvec3 turn_deg{0, 0, 0};  ///< about x, then y, then z
  bool centered = false;            ///< the middle of the bounds becomes the origin
  bool two_sided = false;           ///< for files with careless windings
  bool lights = false;              ///< those of the file shine, too
  std::vector<ModelInstance> instances;
};

struct ShapeRecipe {
  ShapeContent content;
  std::vector<ModelInstance> instances;  ///< parts are called like them
};

/// An orbit about y (default_view.h) that takes SceneRecipe::turntable_s for a turn.
struct OrbitRecipe {
  layers::dvec3 center{0, 0, 0};
  double distance_m = 5;
  double elevation_rad = 0;
};

struct CameraRecipe {
  double fov_deg = 50, near_m = 0.1, far_m = 10000;
  std::optional<OrbitRecipe> orbit;  ///< instead of a motion
  std::string model, named;          ///< instead of all else: a camera of this model; empty: its first
  Motion motion;
};

struct SceneRecipe {
  std::vector<ShapeRecipe> shapes;
  std::vector<ModelRecipe> models;
  std::vector<ImageRecipe> images;
  ShownTimes times;  ///< of the sequence: which frames of images are read
  std::optional<TerrainContent> terrain;
  std::optional<SkyContent> sky;
  std::optional<SwarmContent> swarm;
  std::optional<BuildingContent> building;
  std::vector<CellRecipe> cells;  ///< beside those of the building
  std::vector<PortalRecipe> portals;
  std::optional<CameraRecipe> camera;
  std::vector<LightRecipe> lights;
  layers::vec3 background{0, 0, 0};
  std::vector<std::string> assets;  ///< folders in whose trees files that models name may lie
  double exposure_lx = 1;           ///< by which all lights are divided
  double turntable_s = 5;           ///< one turn of the orbiting camera, where there is no other
};

/// The keys background, shapes, models, images, assets, terrain, sky, swarm, building, cells, portals, camera, turntable, lights and exposure of a sequence.
const Table<SceneRecipe>& scene_keys();

}  // namespace talisman::sequences
