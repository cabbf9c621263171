// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/knobs.h"

#include <cstdio>
#include <functional>
#include <initializer_list>
#include <utility>

#include "sequences/experiments/effect_removal.h"

namespace talisman::sequences {
namespace {

using chunker::TextureFilter;
using layers::Effect;
using layers::LayerKind;

constexpr int kFinestMap_px = 2048, kFinestPcfRadius_texels = 3, kFinestAnisotropy = 16, kFinestSamples = 16;

std::string number(double value, const char* unit = "") {
  char text[48];
  std::snprintf(text, sizeof text, "%g%s", value, unit);
  return text;
}

template <typename Change>
Variant with_shadow_options(const Variant& given, Change change) {
  layers::Scene scene = *given.sequence.scene;
  for (layers::Light& light : scene.lights)
    if (light.casts_shadow) change(light.shadow);
  Variant variant = given;
  variant.sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  return variant;
}

Variant in_sprites(Variant variant) {
  variant.settings.regulator.policy = regulator::Policy::Reference;
  return variant;
}

/// Knobs are added one after the other; rungs that equal the truth are its own.
class LadderBuilder {
 public:
  explicit LadderBuilder(const Variant& given) : given_(given) {
    ladder_.variants.push_back(finest(given));
    ladder_.variants.push_back(in_sprites(ladder_.variants[kTruth]));
  }

  /// A knob of the one pass, if `effect` is called for.
  void pass(const std::string& name, WorkKind work, std::optional<Effect> effect = std::nullopt) {
    begin(name, work, false, effect);
  }
  void sprites(const std::string& name, WorkKind work, std::optional<Effect> effect = std::nullopt) {
    begin(name, work, true, effect);
  }
  void not_called(const std::string& why_not) { knob().why_not = why_not; }
  bool called() { return knob().called(); }

  void rung(const std::string& label, const std::function<void(Variant&)>& change) {
    if (!called()) return;
    Variant variant = ladder_.variants[knob().base()];
    change(variant);
    knob().rungs.push_back({label, ladder_.variants.size()});
    ladder_.variants.push_back(std::move(variant));
  }
  void render_rung(const std::string& label, const std::function<void(chunker::RenderOptions&)>& change) {
    rung(label, [&](Variant& variant) { change(variant.settings.render); });
  }
  void shadow_rung(const std::string& label, const std::function<void(layers::ShadowMapOptions&)>& change) {
    rung(label, [&](Variant& variant) { variant = with_shadow_options(variant, change); });
  }
  /// The rung that is the truth itself, in one pass or in sprites.
  void truth_rung(const std::string& label) {
    if (called()) knob().rungs.push_back({label, knob().base()});
  }

  const Variant& given() const { return given_; }
  RendererLadder take() { return std::move(ladder_); }

 private:
  Knob& knob() { return ladder_.knobs.back(); }
  void begin(const std::string& name, WorkKind work, bool in_sprites, std::optional<Effect> effect) {
    ladder_.knobs.push_back({name, in_sprites, "", {}, work});
    if (!effect) return;
    const layers::EffectCall call = effect_call(given_, *effect);
    if (!call.called) knob().why_not = call.why;
  }

  const Variant& given_;
  RendererLadder ladder_;
};

void add_coverage(LadderBuilder& ladder) {
  ladder.pass("samples", WorkKind::Fragments);
  for (const int samples : {1, 4})
    ladder.render_rung(number(samples), [&](auto& render) { render.samples = samples; });
  ladder.truth_rung(number(kFinestSamples));

  ladder.pass("merge tolerances", WorkKind::Fragments);
  ladder.render_rung("default", [](auto& render) {
    render.merge_depth = chunker::RenderOptions{}.merge_depth;
    render.merge_color = chunker::RenderOptions{}.merge_color;
  });
  ladder.truth_rung("0");
}

void add_textures(LadderBuilder& ladder) {
  ladder.pass("texture filter", WorkKind::TextureSamples, Effect::Texture);
  for (const auto& [label, filter] :
       {std::pair{"nearest", TextureFilter::Nearest}, std::pair{"bilinear", TextureFilter::Bilinear}})
    ladder.render_rung(label, [filter = filter](auto& render) { render.filter = filter; });
  for (const int samples : {1, 2, 4, 8})
    ladder.render_rung(samples == 1 ? "trilinear" : "anisotropy " + number(samples),
                       [&](auto& render) { render.max_anisotropy = samples; });
  ladder.truth_rung("anisotropy " + number(kFinestAnisotropy));
}

void add_lights(LadderBuilder& ladder) {
  ladder.pass("shading", WorkKind::Lightings, Effect::Lighting);
  for (const auto& [label, shading] :
       {std::pair{"flat", chunker::Shading::Flat}, std::pair{"gouraud", chunker::Shading::Gouraud}})
    ladder.render_rung(label, [shading = shading](auto& render) { render.shading = shading; });
  ladder.truth_rung("phong");

  ladder.pass("normal map", WorkKind::TextureSamples, Effect::NormalMap);
  ladder.rung("off", [](Variant& variant) { variant = without_effect(variant, Effect::NormalMap); });
  ladder.truth_rung("on");

  ladder.pass("shadow map", WorkKind::MapBytes, Effect::ShadowMap);
  for (const int px : {128, 256, 512, 1024})
    ladder.shadow_rung(number(px, " px"), [&](auto& shadow) { shadow.resolution_px = px; });
  ladder.truth_rung(number(kFinestMap_px, " px"));

  ladder.pass("shadow filter", WorkKind::DepthCompares, Effect::ShadowMap);
  for (const int radius : {0, 1, 2})
    ladder.shadow_rung("radius " + number(radius), [&](auto& shadow) { shadow.pcf_radius = radius; });
  ladder.truth_rung("radius " + number(kFinestPcfRadius_texels));
}

/// Layers of `kind`, or all shade layers, at each resolution below that of the display.
void add_shade_rungs(LadderBuilder& ladder, std::optional<LayerKind> kind) {
  for (const double scale : {0.125, 0.25, 0.5})
    ladder.rung(number(scale), [&](Variant& variant) {
      for (layers::Layer& layer : variant.sequence.layers.layers)
        if (kind ? layer.kind == *kind : layer.kind != LayerKind::Geometry)
          layer.preferences.resolution_scale = scale;
    });
  ladder.truth_rung("1");
}

void add_shade_layers(LadderBuilder& ladder) {
  struct Kind {
    const char* name;
    LayerKind kind;
    Effect effect;
  };
  constexpr Kind kKinds[] = {{"shadow", LayerKind::Shadow, Effect::ShadowLayer},
                             {"specular", LayerKind::Specular, Effect::SpecularLayer},
                             {"reflection", LayerKind::Reflection, Effect::ReflectionLayer},
                             {"texture", LayerKind::Texture, Effect::TextureLayers}};
  ladder.sprites("all shade layers", WorkKind::PixelsShaded);
  int kinds = 0;
  for (const Kind& kind : kKinds) kinds += effect_call(ladder.given(), kind.effect).called;
  if (kinds == 0) ladder.not_called("no layer factors a term of its shading");
  add_shade_rungs(ladder, std::nullopt);
  for (const Kind& kind : kKinds) {
    ladder.sprites(std::string(kind.name) + " layers", WorkKind::PixelsShaded, kind.effect);
    add_shade_rungs(ladder, kind.kind);
  }
}

void add_sprites(LadderBuilder& ladder) {
  ladder.sprites("sprite resolution", WorkKind::PixelsShaded);
  const auto scaled = [&](double scale) {
    ladder.rung(number(scale), [=](Variant& v) { v.settings.placement.resolution_scale = scale; });
  };
  for (const double scale : {0.25, 0.5, 0.71}) scaled(scale);
  ladder.truth_rung("1");
  for (const double scale : {1.41, 2.0}) scaled(scale);

  add_shade_layers(ladder);

  ladder.sprites("compression", WorkKind::SpriteBytes);
  for (const int quality : {30, 50, 70, 85, 95})
    ladder.rung("quality " + number(quality),
                [&](Variant& v) { v.settings.compression = chunker::CompressionOptions{quality}; });
  ladder.truth_rung("off");

  ladder.sprites("motion blur", WorkKind::PixelsShaded, Effect::MotionBlur);
  ladder.rung("as asked for", [&](Variant& variant) {
    const std::vector<layers::Layer>& asked = ladder.given().sequence.layers.layers;
    for (std::size_t id = 0; id < asked.size(); ++id)
      variant.sequence.layers.layers[id].preferences.motion_blur = asked[id].preferences.motion_blur;
  });
  ladder.truth_rung("off");
}

}  // namespace

const char* name(WorkKind kind) {
  switch (kind) {
    case WorkKind::Fragments:
      return "fragments";
    case WorkKind::TextureSamples:
      return "texture_samples";
    case WorkKind::Lightings:
      return "lightings";
    case WorkKind::MapBytes:
      return "map_bytes";
    case WorkKind::DepthCompares:
      return "depth_compares";
    case WorkKind::PixelsShaded:
      return "pixels_shaded";
    case WorkKind::SpriteBytes:
      return "sprite_bytes";
  }
  return "?";
}

std::string truth_in_words() {
  return "one pass, " + number(kFinestSamples) + " samples, no merging of fragments, anisotropy " +
         number(kFinestAnisotropy) + ", Phong, shadow maps of " + number(kFinestMap_px) +
         " px with filter radius " + number(kFinestPcfRadius_texels);
}

Variant finest(const Variant& given) {
  Variant truth = given;
  for (const Effect effect : {Effect::LayerResolution, Effect::MotionBlur, Effect::SpriteCompression})
    truth = without_effect(truth, effect);
  Settings& settings = truth.settings;
  settings.placement.resolution_scale = 1;
  settings.render.shading = chunker::Shading::Phong;
  settings.render.mipmaps = true;
  settings.render.filter = TextureFilter::Trilinear;
  settings.render.max_anisotropy = kFinestAnisotropy;
  settings.render.samples = kFinestSamples;
  settings.render.merge_depth = settings.render.merge_color = 0;
  settings.regulator.policy = regulator::Policy::Direct;
  if (!effect_call(given, Effect::ShadowMap).called) return truth;
  return with_shadow_options(truth, [](layers::ShadowMapOptions& shadow) {
    shadow.resolution_px = kFinestMap_px;
    shadow.pcf_radius = kFinestPcfRadius_texels;
  });
}

RendererLadder renderer_ladder(const Variant& given) {
  LadderBuilder ladder(given);
  add_coverage(ladder);
  add_textures(ladder);
  add_lights(ladder);
  add_sprites(ladder);
  return ladder.take();
}

}  // namespace talisman::sequences
