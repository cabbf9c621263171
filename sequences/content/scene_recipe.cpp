// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/scene_recipe.h"

#include "sequences/content/bodies.h"
#include "sequences/content/surroundings.h"
#include "sequences/content/swarm/swarm_keys.h"

namespace talisman::sequences {

namespace {

const Table<OrbitRecipe>& orbit_keys() {
  using O = OrbitRecipe;
  static const Table<O> table =
      Table<O>("orbit")
          .key("center", &O::center, vector(), "m", "what it goes round and looks at")
          .key("distance_m", &O::distance_m, number(kPositive), "m", "from there")
          .key("elevation_deg", &O::elevation_rad, degrees({-90, 90}), "°", "how far above it");
  return table;
}

const std::vector<std::string> kMotionKeys = {"carried_by", "position", "rotation_deg", "look_at",
                                              "flight",     "trace",    "spin"};

/// Keys of a camera that one of a model has from its file.
std::vector<std::string> keys_of_a_view() {
  std::vector<std::string> keys = {"fov_deg", "near_m", "far_m", "orbit"};
  keys.insert(keys.end(), kMotionKeys.begin(), kMotionKeys.end());
  return keys;
}

const Table<CameraRecipe>& camera_keys() {
  using C = CameraRecipe;
  static const Table<C> table =
      Table<C>("camera")
          .key("fov_deg", &C::fov_deg, number({1, 170}), "°", "vertical field of view")
          .key("near_m", &C::near_m, number(kPositive), "m", "what is nearer is not drawn")
          .key("far_m", &C::far_m, number(kPositive), "m",
               "end of the depths; what is farther is drawn all the same")
          .rule("near_m below far_m", [](const C& camera) { return camera.near_m < camera.far_m; })
          .key("orbit", &C::orbit, map_of(orbit_keys()), "",
               "goes round a place, once in the seconds of `turntable`")
          .not_with(kMotionKeys)
          .key("model", &C::model, with_rule(text(), "the name of an instance with a camera"), "",
               "the view of a camera in that model's file, which moves as it does there")
          .not_with(keys_of_a_view())
          .key("named", &C::named, text(), "", "which of its cameras")
          .otherwise("the first")
          .only_with("model")
          .include(&C::motion, motion_keys());
  return table;
}

}  // namespace

const Table<SceneRecipe>& scene_keys() {
  using S = SceneRecipe;
  static const Table<S> table =
      Table<S>()
          .key("background", &S::background, color(), "", "colour behind all layers")
          .key("shapes", &S::shapes, list_of(shape_keys()), "", "simple bodies that need no file")
          .key("models", &S::models, list_of(model_keys(), 0), "", "bodies from files")
          .key("images", &S::images, list_of(image_keys()), "",
               "2-D layers: pictures, sequences of pictures, videos")
          .key("assets", &S::assets, folders(), "",
               "where else files that models name may lie, besides their own folders and that of this file")
          .otherwise("none")
          .key("terrain", &S::terrain, map_of(terrain_keys()), "", "ground out of pictures")
          .key("sky", &S::sky, map_of(sky_keys()), "", "one part, unlit")
          .key("swarm", &S::swarm, map_of(swarm_keys()), "", "many small things that move for themselves")
          .key("building", &S::building, map_of(building_keys()), "",
               "rooms along corridors around an atrium, with furniture, cells and portals")
          .at_least_one_of({"shapes", "models", "images", "terrain", "sky", "swarm", "building"},
                           "it shows nothing")
          .key("cells", &S::cells, list_of(cell_keys()), "",
               "boxes whose faces nobody sees through, but where a portal is")
          .otherwise("none, or those of the building")
          .key("portals", &S::portals, list_of(portal_keys()), "", "the holes between cells")
          .otherwise("none, or those of the building")
          .key("camera", &S::camera, map_of(camera_keys()), "", "from where it is seen")
          .otherwise("an orbit around everything")
          .key("turntable", &S::turntable_s, number(kPositive), "s",
               "one turn of the orbiting camera; of no meaning where the camera does not orbit")
          .key("lights", &S::lights, list_of(light_keys()), "", "at most four of them cast shadows")
          .otherwise("a sun and ambient light")
          .key("exposure", &S::exposure_lx, number(kPositive), "",
               "intensity of a light that shows 1 on a white surface that faces it");
  return table;
}

}  // namespace talisman::sequences
