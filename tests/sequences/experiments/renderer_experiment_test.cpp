// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/experiments/renderer/measure.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "tests/support/scenes.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using layers::Effect;
using testing::UnorderedElementsAreArray;

/// All effects but shadows: the truth's maps of 2048 texels would take most of the test's time.
const Variant& shadowless() {
  static const Variant variant = without_effect(tests::every_effect(6), Effect::ShadowMap);
  return variant;
}

const KnobResults& knobs() {
  static const KnobResults results = measure_knobs(shadowless(), {1, 4}, 1, ProgressKind::None);
  return results;
}

std::map<std::string, RungResult> rungs_of(const KnobResults& results, const std::string& name) {
  std::map<std::string, RungResult> rungs;
  for (const RungResult& rung : results.rungs) {
    const Knob& knob = results.ladder.knobs[rung.knob];
    if (knob.name == name) rungs.emplace(knob.rungs[rung.rung].label, rung);
  }
  EXPECT_FALSE(rungs.empty()) << name;
  return rungs;
}

const Measured& measured(const RungResult& rung) { return knobs().measured[rung.variant]; }

Measured measure_one(const Variant& variant, const Workload& workload) {
  Progress progress(ProgressKind::None, "", steps_of(1, workload));
  return measure_variants({&variant}, workload, progress).front();
}

// --- Knobs

TEST(MeasureKnobs, TheTruthHasNoError) {
  for (const std::string knob : {"samples", "merge tolerances", "texture filter", "shading"}) {
    int truths = 0;
    for (const auto& [label, rung] : rungs_of(knobs(), knob)) {
      if (rung.variant != kTruth) continue;
      ++truths;
      EXPECT_EQ(rung.error.quality.psnr_db, HUGE_VAL);
      EXPECT_EQ(rung.error.quality.flip, 0);
      EXPECT_EQ(rung.error.rms_code_values, 0);
      EXPECT_EQ(rung.error.quality.max_difference, 0);
    }
    EXPECT_EQ(truths, 1) << knob;
  }
}

TEST(MeasureKnobs, EveryRungOfEveryKnobThatIsCalledForIsThereWithFiniteNumbers) {
  std::size_t expected = 0;
  for (const Knob& knob : knobs().ladder.knobs) expected += knob.rungs.size();
  EXPECT_EQ(knobs().rungs.size(), expected);
  for (const RungResult& rung : knobs().rungs) {
    SCOPED_TRACE(knobs().ladder.knobs[rung.knob].name + " " + std::to_string(rung.rung));
    for (const double value : {rung.error.quality.ssim, rung.error.quality.flip, rung.error.rms_code_values,
                               rung.work, measured(rung).modelled_ms, measured(rung).drawn.median_ms})
      EXPECT_TRUE(std::isfinite(value));
    EXPECT_GT(measured(rung).drawn.median_ms, 0);
    EXPECT_EQ(measured(rung).pictures.size(), 2u);
  }
}

TEST(MeasureKnobs, SpritesAreComparedWithTheTruthAndWithTheirBase) {
  const RungResult base = rungs_of(knobs(), "compression").at("off");
  EXPECT_EQ(base.variant, kTruthInSprites);
  EXPECT_GT(base.error.rms_code_values, 0) << "sprites are 8 bits deep, the truth goes through one only";
  EXPECT_EQ(base.alone.rms_code_values, 0);
  EXPECT_GT(rungs_of(knobs(), "compression").at("quality 30").alone.rms_code_values, 0);
}

TEST(MeasureKnobs, CountersExplainWhatAKnobIsPaidIn) {
  const auto samples = rungs_of(knobs(), "samples");
  EXPECT_LT(samples.at("1").work, samples.at("4").work);
  EXPECT_LT(samples.at("4").work, samples.at("16").work);
  EXPECT_EQ(samples.at("16").work, measured(samples.at("16")).counters.fragments / 2.0) << "per frame";
  const auto merge = rungs_of(knobs(), "merge tolerances");
  EXPECT_EQ(measured(merge.at("0")).counters.fragments_merged, 0);
  EXPECT_LE(merge.at("default").work, merge.at("0").work);
  const auto filter = rungs_of(knobs(), "texture filter");
  EXPECT_LE(filter.at("trilinear").work, filter.at("anisotropy 4").work);
  EXPECT_LT(filter.at("trilinear").work, filter.at("anisotropy 16").work);
  const auto shading = rungs_of(knobs(), "shading");
  EXPECT_EQ(3 * shading.at("flat").work, shading.at("gouraud").work) << "corners of triangles";
  const auto compression = rungs_of(knobs(), "compression");
  EXPECT_LT(compression.at("quality 30").work, compression.at("quality 95").work);
  EXPECT_LT(compression.at("quality 95").work, compression.at("off").work);
  const auto resolution = rungs_of(knobs(), "sprite resolution");
  EXPECT_LT(resolution.at("0.25").work, 0.25 * resolution.at("1").work);
  EXPECT_GT(resolution.at("2").work, 2 * resolution.at("1").work);
}

TEST(MeasureKnobs, FinerRungsAreNearer) {
  const auto alone = [](const std::string& knob, const std::string& rung) {
    return rungs_of(knobs(), knob).at(rung).alone.quality.psnr_db;
  };
  EXPECT_LT(alone("samples", "1"), alone("samples", "4"));
  // Not so flat and Gouraud shading: over the floor's large cells Gouraud smears the cone of the lamp.
  EXPECT_LT(alone("compression", "quality 30"), alone("compression", "quality 95"));
  EXPECT_LT(alone("sprite resolution", "0.25"), alone("sprite resolution", "0.71"));
  EXPECT_LT(alone("reflection layers", "0.125"), alone("reflection layers", "0.5"));
}

TEST(MeasureKnobs, AFrontIsThereForEveryKnobAndNeverBeaten) {
  for (std::size_t k = 0; k < knobs().ladder.knobs.size(); ++k) {
    const Knob& knob = knobs().ladder.knobs[k];
    int on_front = 0;
    for (const RungResult& a : knobs().rungs) {
      if (a.knob != k) continue;
      on_front += a.work_front;
      for (const RungResult& b : knobs().rungs) {
        const bool beats = b.work < a.work && b.alone.quality.flip < a.alone.quality.flip;
        EXPECT_FALSE(b.knob == k && a.work_front && beats) << knob.name;
      }
    }
    EXPECT_EQ(on_front > 0, knob.called()) << knob.name;
  }
}

/// A white square, turned by 10°, before black: nothing but its edges can be wrong.
Variant slanted_edge() {
  layers::Scene scene = tests::textured_quad_scene();
  scene.materials[0].texture = -1;
  scene.materials[0].unlit = true;
  scene.materials[0].base_color = layers::vec3(1);
  scene.nodes[scene.parts[0].node].local.rotation = glm::angleAxis(0.175, layers::dvec3(0, 0, 1));
  Sequence sequence;
  sequence.name = "edge";
  sequence.frames = 1;
  sequence.display_px = {96, 72};
  sequence.layer_specs = tests::one_layer_per_part(scene);
  sequence.layers = layers::factor(scene, sequence.layer_specs);
  sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  return tests::run_of(sequence);
}

TEST(MeasureKnobs, MoreSamplesOnASlantedEdgeAreNeverWorse) {
  const KnobResults edge = measure_knobs(slanted_edge(), {0}, 1, ProgressKind::None);
  const auto samples = rungs_of(edge, "samples");
  EXPECT_LT(samples.at("1").error.quality.psnr_db, samples.at("4").error.quality.psnr_db);
  EXPECT_LT(samples.at("4").error.quality.psnr_db, samples.at("16").error.quality.psnr_db);
  EXPECT_GT(samples.at("1").error.quality.max_difference, 64) << "a pixel half covered is black or white";
}

// --- Gain

Measured drawn_in(double ms, double spread) {
  Measured m;
  m.cpu = {ms, spread};
  return m;
}
PictureError error_with(double psnr_db, double flip) {
  PictureError error;
  error.quality.psnr_db = psnr_db;
  error.quality.flip = flip;
  return error;
}

TEST(GainOf, IsWhatIsBoughtPerMillisecond) {
  const Gain gain = gain_of(drawn_in(10, 0.1), error_with(30, 0.1), drawn_in(14, 0.1), error_with(38, 0.02));
  EXPECT_DOUBLE_EQ(gain.db_per_ms, 2);
  EXPECT_DOUBLE_EQ(gain.flip_per_ms, 0.02);
}

TEST(GainOf, HasNoPriceWhereTheTimesDoNotDiffer) {
  const Gain gain = gain_of(drawn_in(10, 1), error_with(30, 0.1), drawn_in(11.9, 1), error_with(38, 0.02));
  EXPECT_TRUE(std::isnan(gain.db_per_ms) && std::isnan(gain.flip_per_ms));
  const Gain same = gain_of(drawn_in(10, 0), error_with(30, 0.1), drawn_in(10, 0), error_with(38, 0.02));
  EXPECT_TRUE(std::isnan(same.db_per_ms)) << "not infinite";
}

TEST(GainOf, TheTruthIsInfinitelyManyDecibelsAwayButNotInFlip) {
  const Gain gain = gain_of(drawn_in(10, 0), error_with(30, 0.1), drawn_in(12, 0), error_with(HUGE_VAL, 0));
  EXPECT_TRUE(std::isnan(gain.db_per_ms));
  EXPECT_DOUBLE_EQ(gain.flip_per_ms, 0.05);
}

// --- Measuring

TEST(MeasureVariants, PicturesAndCountersAreThoseOfAFrameDrawnAlone) {
  // The oracle: one step from nothing, outside of any experiment.
  Variant variant = shadowless();
  variant.settings.regulator.policy = regulator::Policy::Reference;
  const Measured found = measure_one(variant, {{2, 5}, false, {5}, 2});
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  const chunker::PreparedScene prepared(*variant.sequence.scene);
  chunker::RenderCounters sum;
  for (const int frame : {2, 5}) {
    PipelineState state(pipeline);
    const FrameReport report = step(pipeline, state, frame, &prepared);
    sum += report.render;
    if (frame == 5) {
      ASSERT_EQ(found.pictures.size(), 1u);
      EXPECT_EQ(found.pictures[0].rgb, to_image8(report.picture).rgb);
    }
  }
  EXPECT_EQ(found.counters, sum) << "of one round, however many there are";
  EXPECT_EQ(found.frames, 2);
}

TEST(MeasureVariants, ARunKeepsItsSprites) {
  const Variant& variant = shadowless();
  const std::vector<int> frames = {0, 1, 2, 3, 4, 5};
  const Measured fresh = measure_one(variant, {frames, false, {}, 1}),
                 run = measure_one(variant, {frames, true, {}, 2});
  EXPECT_LT(run.renders, fresh.renders);
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  PipelineState state(pipeline);
  std::int64_t renders = 0;
  for (const int frame : frames) renders += line_of(step(pipeline, state, frame, nullptr)).renders;
  EXPECT_EQ(run.renders, renders);
}

TEST(ErrorOf, RmsBelongsToThePsnr) {
  Image8 black{2, 2, std::vector<std::uint8_t>(12, 0)}, grey = black;
  for (std::uint8_t& value : grey.rgb) value = 3;
  const PictureError error = error_of({grey}, {black});
  EXPECT_NEAR(error.rms_code_values, 3, 1e-9);
  EXPECT_EQ(error.quality.max_difference, 3);
  EXPECT_EQ(error_of({grey}, {grey}).rms_code_values, 0);
}

// --- Effects

const EffectResults& effects() {
  static const EffectResults results =
      measure_effects(tests::every_effect(6), {1, 4}, {0, 1, 2, 3, 4, 5}, 1, ProgressKind::None);
  return results;
}

const EffectResult& result_of(Effect effect) {
  for (const auto* results : {&effects().pictures, &effects().over_time})
    for (const EffectResult& result : *results)
      if (result.call.effect == effect) return result;
  ADD_FAILURE() << layers::name(effect);
  return effects().pictures.front();
}

const Measured& without(Effect effect) {
  const std::size_t index = result_of(effect).without;
  return pays_over_time(effect) ? effects().runs[index] : effects().frames[index];
}

TEST(MeasureEffects, EachIsTakenAwayOnceOrNotCalledFor) {
  std::vector<Effect> found;
  for (const EffectResult& result : effects().pictures) {
    EXPECT_FALSE(pays_over_time(result.call.effect));
    found.push_back(result.call.effect);
  }
  for (const EffectResult& result : effects().over_time) {
    EXPECT_TRUE(pays_over_time(result.call.effect));
    found.push_back(result.call.effect);
  }
  ASSERT_EQ(effects().not_called.size(), 1u);
  EXPECT_EQ(effects().not_called.front().effect, Effect::Predictive);  // the policy excludes most others
  found.push_back(Effect::Predictive);
  EXPECT_THAT(found, UnorderedElementsAreArray(layers::kAllEffects));
}

TEST(MeasureEffects, OfAPlainSceneOnlyWhatItCallsForIsMeasured) {
  const Variant plain = tests::run_of(tests::resting_sequence(2));
  const EffectResults results = measure_effects(plain, {0}, {0, 1}, 1, ProgressKind::None);
  std::set<Effect> found;
  for (const EffectResult& result : results.pictures) found.insert(result.call.effect);
  EXPECT_EQ(found, std::set<Effect>{Effect::Lighting});
  EXPECT_TRUE(results.over_time.empty());
  EXPECT_EQ(results.not_called.size(), layers::kAllEffects.size() - 1);
}

TEST(MeasureEffects, WhatAnEffectOfAFrameBuysIsSeen) {
  for (const EffectResult& result : effects().pictures)
    EXPECT_GT(result.error.quality.flip, 0) << layers::name(result.call.effect);
}

TEST(MeasureEffects, CountersAndPassesSayWhatItCosts) {
  const Measured& with = effects().frames[0];
  EXPECT_GT(with.counters.shadow_lookups, 0);
  EXPECT_EQ(without(Effect::ShadowMap).counters.shadow_lookups, 0);
  EXPECT_EQ(without(Effect::ShadowMap).passes.shadow_maps_drawn, 0);
  EXPECT_EQ(without(Effect::ShadowMap).shadow_map_bytes, 0);
  EXPECT_GT(with.counters.reflection_lookups, 0);
  EXPECT_EQ(without(Effect::ReflectionMap).counters.reflection_lookups, 0);
  EXPECT_EQ(without(Effect::ReflectionMap).passes.reflections_drawn, 0);
  EXPECT_GT(with.counters.texture_samples, 0);
  EXPECT_EQ(without(Effect::Texture).counters.texture_samples, 0);
  EXPECT_EQ(without(Effect::Texture).texture_bytes, 0);
}

TEST(MeasureEffects, OverTimeFewerPixelsAreDrawnAtLowerResolutionAndFewerBytesKeptCompressed) {
  const Measured& as_it_is = effects().runs[0];
  EXPECT_GT(without(Effect::LayerResolution).pixels, as_it_is.pixels);
  EXPECT_GT(without(Effect::SpriteCompression).sprite_bytes, 2 * as_it_is.sprite_bytes);
  EXPECT_GT(effects().run_error.quality.flip, 0);
}

TEST(MeasureEffects, EachRunIsComparedAtItsFirstAndItsLastFrame) {
  std::vector<int> frames(40);
  for (int k = 0; k < 40; ++k) frames[k] = k + 3;
  const EffectResults results =
      measure_effects(tests::run_of(tests::resting_sequence(60)), {5}, frames, 1, ProgressKind::None);
  EXPECT_EQ(results.run_load.compared.front(), 3);
  EXPECT_EQ(results.run_load.compared.back(), 42);
  EXPECT_LE(results.run_load.compared.size(), 15u);
}

}  // namespace
}  // namespace talisman::sequences
