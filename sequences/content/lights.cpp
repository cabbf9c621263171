// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/lights.h"

#include <glm/trigonometric.hpp>

namespace talisman::sequences {

namespace {

using layers::Light;
using layers::ShadowMapOptions;
using LightKeys = Table<LightRecipe>;

Format<Light::Kind> kind() {
  using enum Light::Kind;
  return choice<Light::Kind>(
      {{"ambient", Ambient}, {"directional", Directional}, {"point", Point}, {"spot", Spot}});
}

const Table<ShadowMapOptions>& shadow_map_keys() {
  static const Table<ShadowMapOptions> table =
      Table<ShadowMapOptions>("shadow_map")
          .key("resolution_px", &ShadowMapOptions::resolution_px, whole(0, 8192), "texels",
               "on each side; 0 is no map and no shadow")
          .key("bias_texels", &ShadowMapOptions::bias_texels, number({0, 100}), "texels",
               "more: fewer stripes, and shadows come loose from what casts them")
          .key("slope_bias", &ShadowMapOptions::slope_bias, number({0, 16}), "",
               "the same for slanted casters, in multiples of the depth that they gain over the filter's "
               "reach")
          .key("pcf_radius", &ShadowMapOptions::pcf_radius, whole(0, 8), "texels",
               "of the filter: more is softer and slower");
  return table;
}

LightKeys shadow_keys() {
  return LightKeys()
      .key("casts_shadow", at(&LightRecipe::light, &Light::casts_shadow), truth(), "",
           "at most four lights of a scene")
      .key("shadow_map", at(&LightRecipe::light, &Light::shadow), map_of(shadow_map_keys()), "",
           "how its shadow is drawn")
      // No map: no pass and no layer either.
      .ends([](LightRecipe& l) { l.light.casts_shadow &= l.light.shadow.resolution_px != 0; });
}

/// Whatever turns or carries it makes it a node, in whose space it shines along -z; else it stands in the world.
LightKeys place_keys() {
  return LightKeys()
      .include(&LightRecipe::motion, motion_keys())
      .placed([](LightRecipe& l, const YamlValue& self) {
        const YamlMap map = self.map();
        for (const char* key : {"carried_by", "rotation_deg", "look_at", "flight", "trace", "spin"})
          l.moves |= map.find(key) != nullptr;
      })
      .ends([](LightRecipe& l) {
        l.moves |= l.light.kind == Light::Kind::Spot;
        if (l.moves)
          l.light.direction = {0, 0, -1};
        else
          l.light.position = l.motion.rest.translation;
      });
}

LightKeys cone_keys() {
  return LightKeys()
      .begins([](LightRecipe& l) {
        l.light.inner_cone_rad = glm::radians(20.0);
        l.light.outer_cone_rad = glm::radians(30.0);
      })
      .key("inner_deg", at(&LightRecipe::light, &Light::inner_cone_rad), degrees({0, 90}), "°",
           "from the axis: full light inside")
      .key("outer_deg", at(&LightRecipe::light, &Light::outer_cone_rad), degrees({0, 90}), "°",
           "from the axis: no light outside")
      .rule("inner_deg at most outer_deg",
            [](const LightRecipe& l) { return l.light.inner_cone_rad <= l.light.outer_cone_rad; });
}

}  // namespace

const Table<LightRecipe>& light_keys() {
  using layers::Light;
  static const LightKeys table =
      LightKeys("light")
          .key("kind", at(&LightRecipe::light, &Light::kind), kind(), "", "a sun is directional")
          .required()
          .key("name", at(&LightRecipe::light, &Light::name), text(), "",
               "shown, and in the names of its shadow layers")
          .otherwise("its place in the list")
          .key("color", at(&LightRecipe::light, &Light::color), color(), "", "of a light of intensity 1")
          .key("intensity", &LightRecipe::intensity, number(kNotNegative), "1",
               "factor of the colour: 1 is white where white light falls squarely on white. No light falls "
               "off with distance")
          .when(is("kind", {"directional"}), LightKeys()
                                                 .key("direction", at(&LightRecipe::light, &Light::direction),
                                                      direction(), "", "the way the light travels")
                                                 .required())
          .when(is("kind", {"directional", "point", "spot"}), shadow_keys())
          .when(is("kind", {"point", "spot"}), place_keys())
          .when(is("kind", {"point"}),
                LightKeys().at_least_one_of({"position", "look_at", "flight", "spin", "carried_by"}))
          .when(is("kind", {"spot"}), cone_keys());
  return table;
}

}  // namespace talisman::sequences
