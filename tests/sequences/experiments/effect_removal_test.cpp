// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/effect_removal.h"

#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/files/image_io.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "tests/support/room.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using layers::Effect;
using layers::LayerKind;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

constexpr int kFrames = 6;

const Variant& six_frames() {
  static const Variant variant = tests::every_effect(kFrames);
  return variant;
}

const Variant& calling_for(Effect effect) {
  static const Variant predictive = tests::calling_for(Effect::Predictive, kFrames);
  return effect == Effect::Predictive ? predictive : six_frames();
}

/// Effects that are called for in `before` and not in `after`.
std::set<Effect> lost(const Variant& before, const Variant& after) {
  std::set<Effect> effects;
  for (const Effect effect : layers::kAllEffects)
    if (effect_call(before, effect).called && !effect_call(after, effect).called) effects.insert(effect);
  return effects;
}

std::vector<std::string> names_of(const Variant& variant) {
  std::vector<std::string> names;
  for (const layers::Layer& layer : variant.sequence.layers.layers) names.push_back(layer.name);
  return names;
}

FrameReport frame_of(const Variant& variant, int frame) {
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  const chunker::PreparedScene prepared(*variant.sequence.scene);
  PipelineState state(pipeline);
  for (int f = 0; f < frame; ++f) step(pipeline, state, f, nullptr);
  return step(pipeline, state, frame, &prepared);
}

// --- Each effect alone

class WithoutEffect : public testing::TestWithParam<Effect> {
 protected:
  const Variant& given() const { return calling_for(GetParam()); }
};

TEST_P(WithoutEffect, IsNotCalledForAnyMore) {
  const layers::EffectCall with = effect_call(given(), GetParam());
  ASSERT_TRUE(with.called) << "the scene must call for all: " << with.why;
  const layers::EffectCall without = effect_call(without_effect(given(), GetParam()), GetParam());
  EXPECT_FALSE(without.called) << without.why;
  EXPECT_FALSE(without.why.empty());
  EXPECT_THAT(without.layers, IsEmpty());
}

TEST_P(WithoutEffect, NothingElseGoesThanTheHeaderSays) {
  // What the four shade layers and the surfaces under them cannot do without one another.
  const std::map<Effect, std::set<Effect>> also = {
      {Effect::Texture,
       {Effect::MipFilter, Effect::TextureLayers, Effect::EmissiveMap, Effect::NormalMap,
        Effect::MovingPicture}},
      {Effect::Lighting,
       {Effect::SpecularHighlight, Effect::ColorWarp, Effect::ShadowMap, Effect::ShadowLayer,
        Effect::SpecularLayer, Effect::EmissiveMap, Effect::LightFalloff, Effect::NormalMap,
        Effect::LayerResolution}},  // the shadow's was the only resolution of its own
      {Effect::SpecularHighlight, {Effect::SpecularLayer}},
      {Effect::ShadowMap, {Effect::ShadowLayer, Effect::LayerResolution}},
      {Effect::ShadowLayer, {Effect::SpecularLayer, Effect::TextureLayers, Effect::LayerResolution}},
      {Effect::SpecularLayer, {Effect::TextureLayers}},
      {Effect::ReflectionMap, {Effect::ReflectionLayer}},
      {Effect::ReflectionLayer, {Effect::SpecularLayer, Effect::TextureLayers}},
  };
  std::set<Effect> expected = {GetParam()};
  if (const auto found = also.find(GetParam()); found != also.end())
    expected.insert(found->second.begin(), found->second.end());
  EXPECT_THAT(lost(given(), without_effect(given(), GetParam())), UnorderedElementsAreArray(expected));
}

TEST_P(WithoutEffect, LayersAreFactoredAgainAndTheSceneIsSound) {
  const Variant without = without_effect(given(), GetParam());
  EXPECT_EQ(layers::first_defect(*without.sequence.scene), "");
  EXPECT_EQ(without.sequence.layers.defect, "");
  for (std::size_t id = 0; id < without.sequence.layers.layers.size(); ++id)
    EXPECT_EQ(without.sequence.layers.layers[id].id, int(id));
}

TEST_P(WithoutEffect, TakenTwiceIsTakenOnce) {
  const Variant once = without_effect(given(), GetParam());
  const Variant twice = without_effect(once, GetParam());
  EXPECT_EQ(twice.sequence.scene, once.sequence.scene) << "nothing is copied where nothing is taken";
  EXPECT_EQ(names_of(twice), names_of(once));
}

TEST_P(WithoutEffect, DrawsAFrameAndWhatWasGivenStaysAsItWas) {
  const std::string before = hash_of(frame_of(given(), 0).picture);
  const FrameReport report = frame_of(without_effect(given(), GetParam()), kFrames - 1);
  EXPECT_EQ(report.picture.width, 96);
  EXPECT_EQ(hash_of(frame_of(given(), 0).picture), before);
}

std::string effect_name(const testing::TestParamInfo<Effect>& info) {
  return std::string(layers::name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Of, WithoutEffect, testing::ValuesIn(layers::kAllEffects), effect_name);

// --- What becomes of what was taken away

TEST(WithoutTexture, SurfacesKeepTheirMeanColour) {
  // A checkerboard of sRGB 230 and 60: the mean in linear light is that of neither byte's mean.
  Sequence sequence = tests::moving_sequence(1);
  const Variant plain = without_effect(tests::run_of(sequence), Effect::Texture);
  const double light = std::pow((230 / 255.0 + 0.055) / 1.055, 2.4),
               dark = std::pow((60 / 255.0 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(plain.sequence.scene->materials[0].base_color.x, (light + dark) / 2, 1e-4);
  EXPECT_EQ(plain.sequence.scene->materials[0].opacity, 1);
  EXPECT_EQ(frame_of(plain, 0).render.texture_samples, 0);
}

TEST(WithoutTexture, HolesBecomeMeanOpacityAndColourIsNotDarkened) {
  tests::Room room;
  room.scene.textures[0] = {"holes", 2, 1, {255, 255, 255, 255, 0, 0, 0, 0}, true};
  room.scene.materials[0].texture = 0;
  room.scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
  Sequence sequence;
  sequence.frames = 1;
  sequence.layer_specs = room.specs;
  sequence.layers = room.layers();
  sequence.scene = std::make_shared<const layers::Scene>(room.scene);
  const Variant plain = without_effect(tests::run_of(sequence), Effect::Texture);
  EXPECT_NEAR(plain.sequence.scene->materials[0].opacity, 0.5, 1e-6);
  EXPECT_NEAR(plain.sequence.scene->materials[0].base_color.x, 0.5, 1e-6);
  EXPECT_TRUE(effect_call(plain, Effect::Translucency).called);
}

TEST(WithoutSkinning, TheFirstFrameIsThatOfThePose) {
  const Variant posed = without_effect(six_frames(), Effect::Skinning);
  const layers::SceneFrame was = six_frames().sequence.scene->at(0), is = posed.sequence.scene->at(0);
  const auto expected = layers::world_positions(was, was.scene->parts[2]);
  const auto found = layers::world_positions(is, is.scene->parts[2]);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(glm::distance(found[i], expected[i]), 0, 1e-6) << i;
}

TEST(WithoutSkinning, ThePoseNoLongerBends) {
  const Variant posed = without_effect(six_frames(), Effect::Skinning);
  const layers::SceneFrame first = posed.sequence.scene->at(0), bent = posed.sequence.scene->at(1);
  EXPECT_EQ(layers::world_positions(first, first.scene->parts[2]),
            layers::world_positions(bent, bent.scene->parts[2]));
}

TEST(WithoutTranslucency, GlassThatBecomesOpaqueStillCastsNoShadow) {
  const Variant opaque = without_effect(six_frames(), Effect::Translucency);
  EXPECT_EQ(opaque.sequence.layers.casting_parts, six_frames().sequence.layers.casting_parts);
}

TEST(WithoutVisibilitySort, TheOrderIsThatOfTheFirstFrameAndNothingIsSorted) {
  const Variant fixed = without_effect(six_frames(), Effect::VisibilitySort);
  const FrameReport sorted = frame_of(six_frames(), 0), by_group = frame_of(fixed, 0);
  EXPECT_TRUE(sorted.order.sorted);
  EXPECT_FALSE(by_group.order.sorted);
  EXPECT_EQ(by_group.order.back_to_front, sorted.order.back_to_front);
}

TEST(WithoutShadowLayer, TheShadowStaysInThePicture) {
  // Factored shadows lie before their base; unfactored ones are held by its sprite.
  const Variant held = without_effect(six_frames(), Effect::ShadowLayer);
  for (const layers::Layer& layer : held.sequence.layers.layers) EXPECT_NE(layer.kind, LayerKind::Shadow);
  EXPECT_TRUE(held.sequence.layers.layers[0].holds.shadows);
  EXPECT_GT(frame_of(held, 0).render.shadow_lookups, 0);
}

TEST(WithoutShadowMap, NothingIsLookedUp) {
  const FrameReport report = frame_of(without_effect(six_frames(), Effect::ShadowMap), 0);
  EXPECT_EQ(report.render.shadow_lookups, 0);
  EXPECT_EQ(report.shade.shadow_maps_drawn, 0);
  EXPECT_GT(frame_of(six_frames(), 0).render.shadow_lookups, 0);
}

TEST(WithoutReflectionMap, NothingIsMirrored) {
  const FrameReport report = frame_of(without_effect(six_frames(), Effect::ReflectionMap), 0);
  EXPECT_EQ(report.render.reflection_lookups, 0);
  EXPECT_EQ(report.shade.reflections_drawn, 0);
  EXPECT_GT(frame_of(six_frames(), 0).render.reflection_lookups, 0);
}

TEST(WithoutEffectPairs, OfTheAuthorFollowTheirLayersToNewIds) {
  // Shade layers come between the geometry layers: their ids change when one goes.
  Variant variant = six_frames();
  const auto id_of = [](const Variant& v, const std::string& name) {
    for (const layers::Layer& layer : v.sequence.layers.layers)
      if (layer.name == name) return layer.id;
    return -1;
  };
  variant.settings.explicit_order =
      variant.sequence.explicit_order = {{id_of(variant, "bar"), id_of(variant, "pane")}};
  const Variant without = without_effect(variant, Effect::ReflectionMap);
  ASSERT_NE(id_of(without, "bar"), id_of(variant, "bar")) << "else nothing is tested";
  EXPECT_THAT(without.settings.explicit_order,
              ElementsAre(layers::ExplicitPair{id_of(without, "bar"), id_of(without, "pane")}));
  EXPECT_EQ(without.sequence.explicit_order, without.settings.explicit_order);
}

TEST(WithoutEffectOfAPlainScene, WhatIsNotCalledForTakesNothing) {
  const Variant plain = tests::run_of(tests::resting_sequence(1));
  int not_called = 0;
  for (const Effect effect : layers::kAllEffects) {
    if (effect_call(plain, effect).called) continue;
    ++not_called;
    EXPECT_EQ(without_effect(plain, effect).sequence.scene, plain.sequence.scene) << layers::name(effect);
  }
  EXPECT_GT(not_called, 10);
}

}  // namespace
}  // namespace talisman::sequences
