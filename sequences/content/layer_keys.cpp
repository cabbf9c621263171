// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/layer_keys.h"

#include "warp/warp.h"

namespace talisman::sequences {

namespace {

using layers::FiducialWeights;
using layers::LayerPreferences;
using layers::LayerSpec;
using layers::OrderGroup;
using layers::ShadingSpec;

const Table<FiducialWeights>& importance_keys() {
  static const Table<FiducialWeights> table =
      Table<FiducialWeights>("importance")
          .key(
              "geometric", &FiducialWeights::geometric, number(kNotNegative), "",
              "weight of the displacement; `geometric_px` is divided by it: 2 allows the layer half of it, 0 "
              "any displacement")
          .key("photometric", &FiducialWeights::photometric, number(kNotNegative), "", "of the shading")
          .key("sampling", &FiducialWeights::sampling, number(kNotNegative), "",
               "of magnification, minification and anisotropy")
          .key("visibility", &FiducialWeights::visibility, number(kNotNegative), "",
               "of sides that come into view");
  return table;
}

std::vector<std::string> curve_names() {
  std::vector<std::string> names;
  for (const warp::Curve curve : warp::kAllCurves) names.emplace_back(warp::name(curve));
  return names;
}

const Table<LayerPreferences>& preference_keys() {
  using P = LayerPreferences;
  static const Table<P> table =
      Table<P>("preferences")
          .key("resolution_scale", &P::resolution_scale, number({kLeast, 4}), "texels/px",
               "along each axis; cost grows with the square")
          .key("min_update_rate", &P::min_update_rate, number({0, 1}), "renders/frame",
               "drawn at least that often")
          .key("max_update_rate", &P::max_update_rate, number({kLeast, 1}), "renders/frame",
               "never drawn more often, after the first time")
          .key("share_of_expected_motion", &P::share_of_expected_motion, number(kNotNegative), "",
               "factor of the growth of extents")
          .key("bound_each_part", &P::bound_each_part, truth(), "",
               "each part has its own characteristic polyhedron, or all have one")
          .otherwise("one for each that moves by itself")
          .key("motion_blur", &P::motion_blur, number({0, 1}), "",
               "share of the frame interval during which the shutter is open")
          .key(
              "extents", &P::whole_extents, choice<bool>({{"motion", false}, {"whole", true}}), "",
              "the sprite reaches as far as the motion asks for, or holds all of the layer within 80° of the "
              "view axis (at a lower density beyond `max_sprite_px`, which counts as magnification)")
          .key("warp", &P::warp, one_of(curve_names()), "", "curve that carries the layer's sprite")
          .otherwise("that of the sequence")
          .key("importance", &P::importance, map_of(importance_keys()), "", "weights of the fiducials");
  return table;
}

struct MultiplierKey {
  double t_s = 0, value = 1;
};

const Table<MultiplierKey>& multiplier_keys() {
  static const Table<MultiplierKey> table = Table<MultiplierKey>("multiplier")
                                                .key("t", &MultiplierKey::t_s, number(), "s", "when")
                                                .required()
                                                .key("value", &MultiplierKey::value, number({0, 1}), "",
                                                     "multiplier at that time; linear between keys")
                                                .required();
  return table;
}

/// Values over time: one number, or a list of {t, value}.
Format<layers::Keys<double>> multiplier() {
  const Format<double> constant = number({0, 1});
  const auto varying = keys_over_time(multiplier_keys(), &MultiplierKey::t_s);
  const auto read = [constant, varying](const YamlValue& value) {
    layers::Keys<double> keys;
    if (!value.is_list())
      return layers::Keys<double>{{0}, {constant.read(value)}, layers::Interpolation::Step};
    for (const MultiplierKey& key : varying.read(value)) {
      keys.times_s.push_back(key.t_s);
      keys.values.push_back(key.value);
    }
    return keys;
  };
  return {either_type({constant.type, varying.type}), read};
}

struct FactoredShadowKeys {
  LayerPreferences preferences;
  std::optional<layers::ShadowsAs> as;
};

const Table<FactoredShadowKeys>& factored_shadow_keys() {
  using enum layers::ShadowsAs;
  static const Table<FactoredShadowKeys> table =
      Table<FactoredShadowKeys>("shadows")
          .key("as", &FactoredShadowKeys::as,
               choice<layers::ShadowsAs>(
                   {{"shade", Shade}, {"light", Light}, {"multiply", Multiply}, {"atop", Atop}}),
               "",
               "black over the surface, or the light of each light that casts, added to the rest; with "
               "`compositor: "
               "extended` also the share of light that is left times the surface, or black atop the surface")
          .otherwise("`light` where more than one light reaches the layer, else `shade`")
          .include(&FactoredShadowKeys::preferences, preference_keys());
  return table;
}

const Table<ShadingSpec>& shading_keys() {
  using S = ShadingSpec;
  const auto own = map_of(preference_keys());
  static const Table<S> table =
      Table<S>("shading")
          .custom(
              "shadows", map_type(factored_shadow_keys().keys()),
              [](const YamlValue& value, S& shading) {
                const FactoredShadowKeys keys = factored_shadow_keys().read(value);
                shading.shadows = keys.preferences;
                shading.shadows_as = keys.as;
              },
              "", "one layer per light that casts, with these preferences")
          .key("specular", &S::specular, own, "", "a layer of the highlights")
          .key("reflection", &S::reflection, own, "", "a layer of what a flat surface mirrors")
          .key("textures", &S::textures, own, "", "a layer of the second texture")
          .key("first_blend", &S::first_blend, multiplier(), "", "multiplier of the first texture's sprite")
          .otherwise("`texture_blend`")
          .only_with("textures")
          .key("second_blend", &S::second_blend, multiplier(), "", "of the second's")
          .otherwise("`texture_blend`")
          .only_with("textures");
  return table;
}

Format<OrderGroup> group() {
  using enum OrderGroup;
  return choice<OrderGroup>({{"background", Background}, {"normal", Normal}, {"foreground", Foreground}});
}

}  // namespace

const Table<LayerEntry>& layer_keys() {
  using L = LayerEntry;
  static const Table<L> table =
      Table<L>("layer")
          .placed([](L& layer, const YamlValue& self) {
            layer.file = self.file();
            layer.line = self.line();
          })
          .key("name", at(&L::spec, &LayerSpec::name), with_rule(text(), "given to one layer only"), "",
               "of the layer")
          .required()
          .key("parts", at(&L::spec, &LayerSpec::part_globs), with_rule(texts(1), "each matches a part"), "",
               "globs over part names: `*` any run, `?` one character, `\\*` and `\\?` themselves")
          .required()
          .key("group", at(&L::spec, &LayerSpec::group), group(), "",
               "drawn in this order, whatever hides what")
          .key("preferences", at(&L::spec, &LayerSpec::preferences), map_of(preference_keys()), "",
               "what it may cost")
          .key("shading", at(&L::spec, &LayerSpec::shading), map_of(shading_keys()), "",
               "terms that are layers of their own")
          .otherwise("all in its sprite")
          .key("fade", at(&L::spec, &LayerSpec::fade), multiplier(), "",
               "multiplies its sprites, colour and alpha")
          .otherwise("1")
          .key("casts_shadows", at(&L::spec, &LayerSpec::casts_shadows), truth(), "",
               "its opaque parts are in the shadow maps");
  return table;
}

}  // namespace talisman::sequences
