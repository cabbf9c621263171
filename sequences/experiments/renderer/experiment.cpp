// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/experiment.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/effect_removal.h"
#include "sequences/experiments/renderer/measure.h"
#include "sequences/experiments/statistics.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {
namespace {

using layers::Effect;

std::vector<const Variant*> pointers(const std::vector<Variant>& variants) {
  std::vector<const Variant*> all;
  for (const Variant& variant : variants) all.push_back(&variant);
  return all;
}

double lightings(const Variant& variant, const Measured& measured) {
  switch (variant.settings.render.shading) {
    case chunker::Shading::Flat:
      return measured.per_frame(measured.counters.polygons_drawn);
    case chunker::Shading::Gouraud:
      return 3 * measured.per_frame(measured.counters.polygons_drawn);
    case chunker::Shading::Phong:
      return measured.per_frame(measured.counters.pixels_shaded);
  }
  return 0;
}

double depths_per_lookup(const Variant& variant) {
  int radius = 0;
  for (const layers::Light& light : variant.sequence.scene->lights)
    if (light.casts_shadow) radius = std::max(radius, light.shadow.pcf_radius);
  return (2 * radius + 1) * (2 * radius + 1);
}

/// The rungs of one knob lie side by side, beginning at `first`.
void complete_knob(KnobResults& results, std::size_t first) {
  std::vector<double> work, wall, flip;
  for (std::size_t k = first; k < results.rungs.size(); ++k) {
    RungResult& rung = results.rungs[k];
    const Measured& measured = results.measured[rung.variant];
    if (k > first) {
      const RungResult& coarser = results.rungs[k - 1];
      rung.gain = gain_of(results.measured[coarser.variant], coarser.alone, measured, rung.alone);
    }
    work.push_back(rung.work);
    wall.push_back(measured.cpu.median_ms);
    flip.push_back(rung.alone.quality.flip);
  }
  const std::vector<bool> work_front = pareto_front(work, flip), wall_front = pareto_front(wall, flip);
  for (std::size_t k = first; k < results.rungs.size(); ++k) {
    results.rungs[k].work_front = work_front[k - first];
    results.rungs[k].wall_front = wall_front[k - first];
  }
}

/// Every k-th frame, so that about twelve are compared; the first and the last among them.
std::vector<int> some_of(const std::vector<int>& frames) {
  const std::size_t stride = std::max<std::size_t>(1, frames.size() / 12);
  std::vector<int> some;
  for (std::size_t k = 0; k < frames.size(); k += stride) some.push_back(frames[k]);
  if (some.back() != frames.back()) some.push_back(frames.back());
  return some;
}

Variant under_reference(Variant variant) {
  variant.settings.regulator.policy = regulator::Policy::Reference;
  return variant;
}

/// Policies without memory have nothing that could pay off over time.
Variant under_own_policy(Variant variant) {
  using regulator::Policy;
  Policy& policy = variant.settings.regulator.policy;
  if (policy == Policy::Direct || policy == Policy::Reference) policy = Policy::Threshold;
  return variant;
}

std::vector<Image8> direct_pictures(const Variant& variant, const std::vector<int>& frames) {
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  const chunker::PreparedScene prepared(*variant.sequence.scene);
  std::vector<Image8> pictures;
  for (const int frame : frames) pictures.push_back(to_image8(draw_direct(pipeline, frame, prepared)));
  return pictures;
}

/// The variants of one of the two workloads: with all effects, and without each of them.
struct Removal {
  std::vector<Variant> variants;
  std::vector<EffectResult> effects;

  explicit Removal(Variant with) { variants.push_back(std::move(with)); }
  void add(const layers::EffectCall& call) {
    effects.push_back({call, variants.size(), {}});
    variants.push_back(without_effect(variants[0], call.effect));
  }
};

}  // namespace

Gain gain_of(const Measured& coarser, const PictureError& coarser_error, const Measured& finer,
             const PictureError& finer_error) {
  const double ms = finer.cpu.median_ms - coarser.cpu.median_ms;
  Gain gain;
  if (!(std::fabs(ms) > finer.cpu.spread_ms + coarser.cpu.spread_ms)) return gain;
  const double db = finer_error.quality.psnr_db - coarser_error.quality.psnr_db;
  if (std::isfinite(db)) gain.db_per_ms = db / ms;
  gain.flip_per_ms = (coarser_error.quality.flip - finer_error.quality.flip) / ms;
  return gain;
}

double work_of(WorkKind kind, const Variant& variant, const Measured& measured) {
  const chunker::RenderCounters& counters = measured.counters;
  switch (kind) {
    case WorkKind::Fragments:
      return measured.per_frame(counters.fragments);
    case WorkKind::TextureSamples:
      return measured.per_frame(counters.texture_samples);
    case WorkKind::Lightings:
      return lightings(variant, measured);
    case WorkKind::MapBytes:
      return double(measured.shadow_map_bytes);
    case WorkKind::DepthCompares:
      return measured.per_frame(counters.shadow_lookups) * depths_per_lookup(variant);
    case WorkKind::PixelsShaded:
      return measured.per_frame(counters.pixels_shaded);
    case WorkKind::SpriteBytes:
      return double(measured.sprite_bytes);
  }
  return 0;
}

KnobResults measure_knobs(const Variant& given, const std::vector<int>& frames, int rounds,
                          ProgressKind progress_kind) {
  KnobResults results;
  results.ladder = renderer_ladder(given);
  results.frames = frames;
  const Workload workload{frames, false, frames, rounds};
  Progress progress(progress_kind, "knobs", steps_of(results.ladder.variants.size(), workload));
  results.measured = measure_variants(pointers(results.ladder.variants), workload, progress);
  const std::vector<Image8>& truth = results.measured[kTruth].pictures;
  for (std::size_t k = 0; k < results.ladder.knobs.size(); ++k) {
    const Knob& knob = results.ladder.knobs[k];
    const std::size_t first = results.rungs.size();
    for (std::size_t r = 0; r < knob.rungs.size(); ++r) {
      const std::size_t variant = knob.rungs[r].variant;
      RungResult rung;
      rung.knob = k, rung.rung = r, rung.variant = variant;
      rung.error = error_of(results.measured[variant].pictures, truth);
      rung.alone = knob.in_sprites
                       ? error_of(results.measured[variant].pictures, results.measured[knob.base()].pictures)
                       : rung.error;
      rung.work = work_of(knob.work, results.ladder.variants[variant], results.measured[variant]);
      results.rungs.push_back(rung);
    }
    complete_knob(results, first);
  }
  return results;
}

bool pays_over_time(Effect effect) {
  switch (effect) {
    case Effect::LayerResolution:
    case Effect::SpriteCompression:
    case Effect::VisibilitySort:
    case Effect::ColorWarp:
    case Effect::ShadowLayer:
    case Effect::SpecularLayer:
    case Effect::ReflectionLayer:
    case Effect::TextureLayers:
    case Effect::Predictive:
      return true;
    default:
      return false;
  }
}

EffectResults measure_effects(const Variant& given, const std::vector<int>& frames,
                              const std::vector<int>& run, int rounds, ProgressKind progress_kind) {
  EffectResults results;
  Removal pictures(under_reference(given)), over_time(under_own_policy(given));
  for (const layers::EffectCall& call : effects_of(given))
    if (!call.called)
      results.not_called.push_back(call);
    else
      (pays_over_time(call.effect) ? over_time : pictures).add(call);
  results.frame_load = {frames, false, frames, rounds};
  results.run_load = {run, true, some_of(run), rounds};
  Progress progress(progress_kind, "effects",
                    steps_of(pictures.variants.size(), results.frame_load) +
                        steps_of(over_time.variants.size(), results.run_load));
  results.frames = measure_variants(pointers(pictures.variants), results.frame_load, progress);
  results.runs = measure_variants(pointers(over_time.variants), results.run_load, progress);
  for (EffectResult& effect : pictures.effects)
    effect.error = error_of(results.frames[effect.without].pictures, results.frames[0].pictures);
  const auto run_error = [&](std::size_t k) {
    return error_of(results.runs[k].pictures,
                    direct_pictures(over_time.variants[k], results.run_load.compared));
  };
  results.run_error = run_error(0);
  for (EffectResult& effect : over_time.effects) effect.error = run_error(effect.without);
  results.pictures = std::move(pictures.effects);
  results.over_time = std::move(over_time.effects);
  return results;
}

}  // namespace talisman::sequences
