// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/knobs.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;
using testing::ElementsAre;
using testing::IsEmpty;

const Variant& all_effects() {
  static const Variant variant = tests::every_effect(4);
  return variant;
}

const RendererLadder& ladder() {
  static const RendererLadder of_all = renderer_ladder(all_effects());
  return of_all;
}

const Knob& knob_of(const RendererLadder& ladder, const std::string& name) {
  for (const Knob& knob : ladder.knobs)
    if (knob.name == name) return knob;
  ADD_FAILURE() << "no knob " << name;
  return ladder.knobs.front();
}

std::vector<std::string> labels_of(const std::string& name) {
  std::vector<std::string> labels;
  for (const KnobRung& rung : knob_of(ladder(), name).rungs) labels.push_back(rung.label);
  return labels;
}

/// What `get` says of each rung's variant.
template <typename Get>
auto values_of(const std::string& name, Get get) {
  std::vector<decltype(get(ladder().variants[0]))> values;
  for (const KnobRung& rung : knob_of(ladder(), name).rungs)
    values.push_back(get(ladder().variants[rung.variant]));
  return values;
}

const layers::ShadowMapOptions& shadow_of(const Variant& variant) {
  return variant.sequence.scene->lights[0].shadow;
}

TEST(RendererLadder, TurnsEveryKnobWhereAllEffectsAreCalledFor) {
  std::vector<std::string> names;
  for (const Knob& knob : ladder().knobs) {
    EXPECT_TRUE(knob.called()) << knob.name << ": " << knob.why_not;
    names.push_back(knob.name);
  }
  EXPECT_THAT(names, ElementsAre("samples", "merge tolerances", "texture filter", "shading", "normal map",
                                 "shadow map", "shadow filter", "sprite resolution", "all shade layers",
                                 "shadow layers", "specular layers", "reflection layers", "texture layers",
                                 "compression", "motion blur"));
}

TEST(RendererLadder, GoesFromCoarseToFine) {
  EXPECT_THAT(values_of("samples", [](const Variant& v) { return v.settings.render.samples; }),
              ElementsAre(1, 4, 16));
  EXPECT_THAT(values_of("texture filter", [](const Variant& v) { return v.settings.render.max_anisotropy; }),
              ElementsAre(16, 16, 1, 2, 4, 8, 16))
      << "anisotropy takes no part in the first two, which are not trilinear";
  EXPECT_THAT(values_of("shadow map", [](const Variant& v) { return shadow_of(v).resolution_px; }),
              ElementsAre(128, 256, 512, 1024, 2048));
  EXPECT_THAT(values_of("shadow filter", [](const Variant& v) { return shadow_of(v).pcf_radius; }),
              ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(labels_of("shading"), ElementsAre("flat", "gouraud", "phong"));
  EXPECT_THAT(labels_of("normal map"), ElementsAre("off", "on"));
  EXPECT_THAT(labels_of("sprite resolution"), ElementsAre("0.25", "0.5", "0.71", "1", "1.41", "2"));
  EXPECT_THAT(labels_of("compression"),
              ElementsAre("quality 30", "quality 50", "quality 70", "quality 85", "quality 95", "off"));
}

TEST(RendererLadder, OneKnobAloneIsTurned) {
  // Everything that some knob turns, in one line: a rung may differ from its base in its own field only.
  const auto fields = [](const Variant& v) {
    std::set<std::string> is;
    const chunker::RenderOptions& r = v.settings.render;
    const auto note = [&is](const std::string& what, double value) {
      is.insert(what + std::to_string(value));
    };
    note("samples", r.samples), note("merge", r.merge_depth), note("shading", double(r.shading));
    note("filter", 100 * double(r.filter) + r.max_anisotropy);
    note("map", shadow_of(v).resolution_px), note("pcf", shadow_of(v).pcf_radius);
    note("resolution", v.settings.placement.resolution_scale);
    note("compression", v.settings.compression ? v.settings.compression->quality : 0);
    for (const layers::Layer& layer : v.sequence.layers.layers)
      if (layer.kind != layers::LayerKind::Geometry && layer.preferences.resolution_scale != 1)
        is.insert("shade layers");
    for (const layers::Material& material : v.sequence.scene->materials)
      if (material.normal_texture >= 0) is.insert("normal map");
    return is;
  };
  for (const Knob& knob : ladder().knobs) {
    const std::set<std::string> base = fields(ladder().variants[knob.base()]);
    for (const KnobRung& rung : knob.rungs) {
      std::size_t changed = 0;
      for (const std::string& field : fields(ladder().variants[rung.variant])) changed += !base.count(field);
      EXPECT_LE(changed, 1u) << knob.name << " " << rung.label;
      EXPECT_EQ(ladder().variants[rung.variant].settings.regulator.policy,
                knob.in_sprites ? Policy::Reference : Policy::Direct)
          << knob.name;
    }
  }
}

TEST(RendererLadder, EveryKnobMeetsItsBaseExactlyOnce) {
  for (const Knob& knob : ladder().knobs) {
    int bases = 0;
    std::set<std::string> labels;
    for (const KnobRung& rung : knob.rungs) {
      bases += rung.variant == knob.base();
      labels.insert(rung.label);
    }
    EXPECT_EQ(bases, 1) << knob.name;
    EXPECT_EQ(labels.size(), knob.rungs.size()) << knob.name;
  }
}

TEST(RendererLadder, ShadeLayersOfOneKindLeaveTheOthersAlone) {
  const auto at_half = [](const std::string& name) {
    std::set<layers::LayerKind> kinds;
    for (const KnobRung& rung : knob_of(ladder(), name).rungs)
      if (rung.label == "0.5")
        for (const layers::Layer& layer : ladder().variants[rung.variant].sequence.layers.layers)
          if (layer.preferences.resolution_scale == 0.5) kinds.insert(layer.kind);
    return kinds;
  };
  using layers::LayerKind;
  EXPECT_THAT(at_half("shadow layers"), ElementsAre(LayerKind::Shadow));
  EXPECT_THAT(at_half("reflection layers"), ElementsAre(LayerKind::Reflection));
  EXPECT_THAT(at_half("all shade layers"),
              ElementsAre(LayerKind::Shadow, LayerKind::Specular, LayerKind::Reflection, LayerKind::Texture));
}

TEST(RendererLadder, WhatASceneDoesNotCallForIsNotMeasuredAndSaysWhy) {
  // A grey cube under a lamp that casts no shadow: no texture, no shade layer.
  const RendererLadder plain = renderer_ladder(tests::run_of(tests::resting_sequence(1)));
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"texture filter", "no material has a texture"},
      {"normal map", "no lit part has a normal texture and tangents"},
      {"shadow map", "no light casts shadows"},
      {"shadow filter", "no light casts shadows"},
      {"all shade layers", "no layer factors a term of its shading"},
      {"shadow layers", "no light casts shadows"},
      {"specular layers", "no lit material has specular > 0"},
      {"reflection layers", "no material has reflectivity > 0"},
      {"texture layers", "no material has a second texture"},
      {"motion blur", "no layer has motion_blur > 0"}};
  std::vector<std::pair<std::string, std::string>> found;
  for (const Knob& knob : plain.knobs) {
    EXPECT_EQ(knob.rungs.empty(), !knob.called()) << knob.name;
    if (!knob.called()) found.emplace_back(knob.name, knob.why_not);
  }
  EXPECT_EQ(found, expected);
}

TEST(Finest, TurnsAllUpAndLeavesWhatWasGivenAsItWas) {
  const Variant truth = finest(all_effects());
  EXPECT_EQ(truth.settings.regulator.policy, Policy::Direct);
  EXPECT_EQ(truth.settings.render.samples, 16);
  EXPECT_EQ(truth.settings.render.merge_depth, 0);
  EXPECT_EQ(truth.settings.render.max_anisotropy, 16);
  EXPECT_EQ(shadow_of(truth).resolution_px, 2048);
  EXPECT_FALSE(truth.settings.compression);
  for (const layers::Layer& layer : truth.sequence.layers.layers) {
    EXPECT_EQ(layer.preferences.resolution_scale, 1) << layer.name;
    EXPECT_EQ(layer.preferences.motion_blur, 0) << layer.name;
  }
  EXPECT_EQ(shadow_of(all_effects()).resolution_px, 128);
  EXPECT_TRUE(all_effects().settings.compression);
}

TEST(RendererLadder, ScenesWithoutShadowsAreSharedNotCopied) {
  const Variant plain = tests::run_of(tests::moving_sequence(1));
  for (const Variant& variant : renderer_ladder(plain).variants)
    EXPECT_EQ(variant.sequence.scene, plain.sequence.scene);
}

TEST(MotionBlurKnob, GivesTheShuttersBackAsTheyWere) {
  EXPECT_THAT(values_of("motion blur",
                        [](const Variant& v) {
                          std::set<double> shutters;
                          for (const layers::Layer& layer : v.sequence.layers.layers)
                            shutters.insert(layer.preferences.motion_blur);
                          return shutters;
                        }),
              ElementsAre(std::set<double>{0, 0.5}, std::set<double>{0}));
}

}  // namespace
}  // namespace talisman::sequences
