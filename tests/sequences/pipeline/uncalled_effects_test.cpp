// SPDX-License-Identifier: Apache-2.0
// An effect that is not called for leaves nothing in a run: no pass, no counter, no memory. The sequence
// calls for all effects; each is taken away in turn, and whatever number belongs to it must be exactly zero.
// With the effect the same numbers must not be, or the test would prove nothing.
#include <functional>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/summary.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using layers::Effect;
using layers::LayerKind;

constexpr int kQuietFrames = 8;

/// A whole run, kept open: its memory can be looked at.
struct WholeRun {
  explicit WholeRun(Variant given)
      : variant(std::move(given)),
        pipeline(make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings)),
        prepared(*variant.sequence.scene, variant.settings.render),
        state(pipeline),
        summary(start_summary(pipeline, "all")) {
    for (int frame = 0; frame < kQuietFrames; ++frame) {
      reports.push_back(step(pipeline, state, frame, &prepared));
      add_decisions(summary, reports.back(), state);
      summary.frames.push_back(line_of(reports.back()));
    }
  }

  Variant variant;
  Pipeline pipeline;
  chunker::PreparedScene prepared;
  PipelineState state;
  Summary summary;
  std::vector<FrameReport> reports;
};

using Numbers = std::map<std::string, double>;

double sum_over(const WholeRun& run, const std::function<double(const FrameReport&)>& number) {
  double sum = 0;
  for (const FrameReport& report : run.reports) sum += number(report);
  return sum;
}

/// Over the states as of which the sprites were drawn.
double sum_over_states(const WholeRun& run, const std::function<double(const layers::LayerState&)>& number) {
  double sum = 0;
  for (const LayerMemory& memory : run.state.memory)
    if (memory.then) sum += number(*memory.then);
  return sum;
}

double traces_of(const WholeRun& run, layers::ShadeTrace::Kind kind) {
  return sum_over_states(run, [kind](const layers::LayerState& state) {
    double count = 0;
    for (const layers::ShadeTrace& trace : state.traces) count += trace.kind == kind;
    return count;
  });
}

/// Layers of a kind, how often they were drawn, and their shares of the sprite store.
Numbers of_shade_layers(const WholeRun& run, LayerKind kind) {
  Numbers n;
  double &layers = n["layers"], &renders = n["renders"], &sprites = n["sprites"];
  for (const layers::Layer& layer : run.pipeline.authored) {
    if (layer.kind != kind) continue;
    ++layers;
    renders += run.summary.layers[layer.id].renders;
    sprites += run.state.sprites.find(layer.id) != nullptr;
  }
  return n;
}

double pyramid_bytes_of_finest_levels(const WholeRun& run) {
  double bytes = 0;
  for (const layers::Texture& texture : run.variant.sequence.scene->textures)
    bytes += 16.0 * texture.width * texture.height;  // four floats a texel
  return bytes;
}

Numbers of_textures(const WholeRun& run) {
  return {{"texture bytes", double(run.prepared.texture_bytes())},
          {"texture samples", sum_over(run, [](auto& r) { return r.render.texture_samples; })},
          {"texture samples in lines", double(run.summary.total(&FrameLine::texture_samples))}};
}

Numbers of_compression(const WholeRun& run) {
  const auto number = [&](auto member) {
    return sum_over(run, [=](auto& r) { return r.compression ? double((*r.compression).*member) : 0; });
  };
  return {{"reports", sum_over(run, [](auto& r) { return r.compression.has_value(); })},
          {"sprites", number(&CompressionReport::sprites)},
          {"compressed bytes", number(&CompressionReport::compressed_bytes)},
          {"chunks", number(&CompressionReport::chunks)},
          {"sprites kept", double(run.state.compressed.size())},
          {"chunks read", sum_over(run, [](auto& r) {
             return r.compression ? double(r.compression->cache.hits + r.compression->cache.misses) : 0;
           })}};
}

Numbers of_visibility_sort(const WholeRun& run) {
  const auto number = [&](int layers::VisibilityCounters::*member) {
    return sum_over(run, [=](auto& r) { return r.order.counters.*member; });
  };
  return {{"frames sorted", sum_over(run, [](auto& r) { return r.order.sorted; })},
          {"layers", number(&layers::VisibilityCounters::layers)},
          {"queries", number(&layers::VisibilityCounters::queries)},
          {"exact tests", number(&layers::VisibilityCounters::exact_tests)},
          {"components", number(&layers::VisibilityCounters::components)}};
}

Numbers of_color_warp(const WholeRun& run) {
  double surfaces = 0;
  for (std::size_t id = 0; id < run.pipeline.authored.size(); ++id)
    surfaces += run.pipeline.authored.bound(id).surface.has_value();
  return {{"mean surfaces", surfaces},
          {"fiducials computed", sum_over(run,
                                          [](auto& r) {
                                            double count = 0;
                                            for (const auto& a : r.assessments)
                                              count += a.fiducials.photometric.computed;
                                            return count;
                                          })},
          {"point colours", sum_over_states(run, [](auto& s) { return s.point_colors.size(); })},
          {"point normals", sum_over_states(run, [](auto& s) { return s.world_normals.size(); })},
          {"body frames", sum_over_states(run, [](auto& s) { return s.world_from_body.size(); })}};
}

Numbers of_shadow_maps(const WholeRun& run) {
  double keys = 0;
  for (const auto& [frame, captured] : run.state.captured) keys += double(captured.shadow_maps.size());
  return {{"maps drawn", sum_over(run, [](auto& r) { return r.shade.shadow_maps_drawn; })},
          {"maps reused", sum_over(run, [](auto& r) { return r.shade.shadow_maps_reused; })},
          {"casters' polygons", sum_over(run, [](auto& r) { return double(r.shade.shadow_polygons); })},
          {"look-ups", sum_over(run, [](auto& r) { return double(r.render.shadow_lookups); })},
          {"map bytes", double(run.state.shadow_maps.bytes())},
          {"keys captured", keys},
          {"shadows followed", traces_of(run, layers::ShadeTrace::Kind::Shadow)}};
}

Numbers of_reflection_maps(const WholeRun& run) {
  return {{"pictures drawn", sum_over(run, [](auto& r) { return r.shade.reflections_drawn; })},
          {"look-ups", sum_over(run, [](auto& r) { return double(r.render.reflection_lookups); })},
          {"mirrored layers followed", traces_of(run, layers::ShadeTrace::Kind::Reflection)}};
}

/// Sprites with fewer texels than the display has pixels under them.
double coarse_sprites(const WholeRun& run) {
  double count = 0;
  for (const LayerMemory& memory : run.state.memory)
    count += memory.then && memory.placement.screen_from_sprite.determinant() > 1.01;
  return count;
}

/// Morph weights are captured 16 to a matrix.
std::size_t morph_matrices_of(const WholeRun& run, int layer) {
  std::size_t weights = 0;
  const layers::Scene& scene = *run.variant.sequence.scene;
  for (const int part : run.state.layers[layer].parts)
    weights += scene.meshes[scene.parts[part].mesh].morphs.size();
  return (weights + 15) / 16;
}

Numbers of_specular_layers(const WholeRun& run) {
  Numbers n = of_shade_layers(run, LayerKind::Specular);
  n["highlights followed"] = traces_of(run, layers::ShadeTrace::Kind::Highlight);
  return n;
}

Numbers of_moving_pictures(const WholeRun& run) {
  std::int64_t bytes = 0;
  for (const FrameLine& line : run.summary.frames) bytes += line.upload_bytes.value_or(0);
  return {{"frames captured", sum_over_states(run, [](auto& s) { return s.pictures.size(); })},
          {"bytes uploaded", double(bytes)}};
}

/// Buffers with depth, words of motion, and what joins them.
Numbers of_prediction(const WholeRun& run) {
  const auto number = [&](auto member) {
    return sum_over(run, [=](auto& r) { return r.predictive ? double((*r.predictive).*member) : 0; });
  };
  return {{"reports", sum_over(run, [](auto& r) { return r.predictive.has_value(); })},
          {"memory", double(run.state.predictive != nullptr)},
          {"vertices projected", number(&PredictiveReport::prediction_vertices)},
          {"parts drawn", number(&PredictiveReport::parts_drawn)},
          {"joins", number(&PredictiveReport::joins_planned)},
          {"bytes of buffers", number(&PredictiveReport::buffer_bytes)},
          {"pixels copied or cleared", sum_over(run, [](auto& r) {
             return r.predictive
                        ? double(r.predictive->joined.pixels_copied + r.predictive->joined.pixels_cleared)
                        : 0;
           })}};
}

/// Every number of a run that belongs to one effect, besides its passes.
Numbers numbers_of(const WholeRun& run, Effect effect) {
  switch (effect) {
    case Effect::Texture:
      return of_textures(run);
    case Effect::MipFilter:
      return {
          {"bytes of coarser levels", run.prepared.texture_bytes() - pyramid_bytes_of_finest_levels(run)}};
    case Effect::Lighting:
      return {{"lights captured", sum_over_states(run, [](auto& s) { return s.lights.size(); })}};
    case Effect::Skinning:
      return {{"joints captured", sum_over_states(run, [&](auto& s) {
                 return s.world_from_part.size() - run.state.layers[s.layer].parts.size() -
                        morph_matrices_of(run, s.layer);
               })}};
    case Effect::SpriteCompression:
      return of_compression(run);
    case Effect::VisibilitySort:
      return of_visibility_sort(run);
    case Effect::ColorWarp:
      return of_color_warp(run);
    case Effect::ShadowMap:
      return of_shadow_maps(run);
    case Effect::ReflectionMap:
      return of_reflection_maps(run);
    case Effect::ShadowLayer:
      return of_shade_layers(run, LayerKind::Shadow);
    case Effect::SpecularLayer:
      return of_specular_layers(run);
    case Effect::ReflectionLayer:
      return of_shade_layers(run, LayerKind::Reflection);
    case Effect::TextureLayers:
      return of_shade_layers(run, LayerKind::Texture);
    case Effect::MovingPicture:
      return of_moving_pictures(run);
    case Effect::Predictive:
      return of_prediction(run);
    default:
      break;  // leave nothing behind but their passes and the picture
  }
  return {};
}

double passes_of(const WholeRun& run, Effect effect) {
  for (std::size_t e = 0; e < run.summary.effects.size(); ++e)
    if (run.summary.effects[e].effect == effect) return run.summary.effect_passes[e];
  return -1;
}

const WholeRun& run_with_all() {
  static const WholeRun run(tests::every_effect(kQuietFrames));
  return run;
}

const WholeRun& run_with(Effect effect) {
  static const WholeRun predictive(tests::calling_for(Effect::Predictive, kQuietFrames));
  return effect == Effect::Predictive ? predictive : run_with_all();
}

class UncalledEffect : public testing::TestWithParam<Effect> {};

TEST_P(UncalledEffect, LeavesNothingInTheRun) {
  const WholeRun without(without_effect(tests::calling_for(GetParam(), kQuietFrames), GetParam()));
  EXPECT_EQ(passes_of(without, GetParam()), 0);
  EXPECT_GT(passes_of(run_with(GetParam()), GetParam()), 0) << "the sequence must call for it";
  const Numbers with_it = numbers_of(run_with(GetParam()), GetParam());
  for (const auto& [name, number] : numbers_of(without, GetParam())) {
    EXPECT_EQ(number, 0) << name;
    EXPECT_GT(with_it.at(name), 0) << name;
  }
}

std::string effect_name(const testing::TestParamInfo<Effect>& info) {
  return std::string(layers::name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Of, UncalledEffect, testing::ValuesIn(layers::kAllEffects), effect_name);

TEST(UncalledEffects, NoOtherPolicyHasBuffersOrWords) {
  for (const regulator::Policy policy : regulator::kAllPolicies) {
    if (policy == regulator::Policy::Predictive) continue;
    Variant variant = tests::calling_for(Effect::Predictive, kQuietFrames);
    variant.settings.regulator.policy = policy;
    const WholeRun run(variant);
    for (const auto& [name, number] : of_prediction(run))
      EXPECT_EQ(number, 0) << regulator::name(policy) << ": " << name;
  }
}

TEST(UncalledEffects, CompressionIsNotInTheLinesOfTheFrames) {
  const WholeRun without(without_effect(tests::every_effect(kQuietFrames), Effect::SpriteCompression));
  for (const FrameLine& line : without.summary.frames)
    EXPECT_THAT(json_of(line), testing::Not(testing::HasSubstr("compression")));
  EXPECT_THAT(json_of(run_with_all().summary.frames.front()), testing::HasSubstr("compression"));
}

// Sampling along the motion makes sprites coarser than the display; with every shutter closed and every layer
// at the display's density none is. The eye follows the ball, so every shutter is opened, at four frames a
// second: what stands aside goes by more than a pixel.
TEST(UncalledEffects, MotionBlurLeavesNoCoarseSprite) {
  Variant sharp = without_effect(tests::every_effect(kQuietFrames), Effect::LayerResolution);
  sharp.sequence.fps = sharp.settings.fps = 4;
  for (layers::LayerSpec& spec : sharp.sequence.layer_specs) spec.preferences.motion_blur = 1;
  sharp.sequence.layers = layers::factor(*sharp.sequence.scene, sharp.sequence.layer_specs);
  EXPECT_GT(coarse_sprites(WholeRun(sharp)), 0);
  EXPECT_EQ(coarse_sprites(WholeRun(without_effect(sharp, Effect::MotionBlur))), 0);
}

TEST(UncalledEffects, LayerResolutionLeavesNoCoarseSprite) {
  const Variant still = without_effect(tests::every_effect(kQuietFrames), Effect::MotionBlur);
  EXPECT_GT(coarse_sprites(WholeRun(still)), 0);
  EXPECT_EQ(coarse_sprites(WholeRun(without_effect(still, Effect::LayerResolution))), 0);
}

}  // namespace
}  // namespace talisman::sequences
