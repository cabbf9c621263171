// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/paper_bench.h"

#include <algorithm>
#include <cmath>

#include <oneapi/tbb/parallel_for.h>
#include <glm/gtc/quaternion.hpp>

#include "layers/check.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

namespace {

using regulator::Policy;

constexpr double kTripleFraming_frames = 3;

/// `scene` with its camera where it is at `time_s`.
layers::Scene with_fixed_camera(layers::Scene scene, double time_s) {
  const layers::dmat4 placed = scene.at(time_s).camera.world_from_camera;
  layers::Node node{"fixed camera", -1, {}, {}};
  node.local.translation = layers::dvec3(placed[3]);
  node.local.rotation = glm::quat_cast(layers::dmat3(placed));
  scene.nodes.push_back(node);
  scene.cameras[scene.active_camera].node = static_cast<int>(scene.nodes.size()) - 1;
  return scene;
}

/// The layer and its shade sprites at the display's density.
void make_full_resolution(layers::LayerSpec& spec) {
  spec.preferences.resolution_scale = 1;
  layers::ShadingSpec& shading = spec.shading;
  for (auto* term : {&shading.shadows, &shading.specular, &shading.reflection, &shading.textures})
    if (*term) (*term)->resolution_scale = 1;
}

regulator::RegulatorOptions regulated(regulator::RegulatorOptions options, const PlanOf& of) {
  if (!of.policy) return options;
  options.policy = *of.policy;
  options.budget.polygons = options.budget.pixels = options.budget.chunks = regulator::kNoLimit;
  options.budget.ms = regulator::kNoLimitMs;
  if (of.policy == Policy::Threshold)
    options.thresholds.geometric_px = of.value;
  else if (of.policy == Policy::Hold || of.policy == Policy::Interpolate)
    options.hold_frames = static_cast<int>(of.value);
  return options;
}

PlannedRun planned_run(const OpenSequence& original, const PlanOf& of) {
  const OpenSequence open = changed(original, of);
  PlannedRun run;
  run.summary = planned(open.sequence, open.settings, {0, open.settings.frames - 1},
                        [&](const FrameReport& report) { run.sprite_depth.push_back(sprite_depth(report)); });
  return run;
}

}  // namespace

PlanOf own_plan(const std::string& sequence) { return {sequence}; }
PlanOf reference_plan(const std::string& sequence) { return {sequence, Policy::Reference}; }
PlanOf triple_framing(const std::string& sequence) { return {sequence, Policy::Hold, kTripleFraming_frames}; }
PlanOf interpolated_triple_framing(const std::string& sequence) {
  return {sequence, Policy::Interpolate, kTripleFraming_frames};
}
PlanOf threshold_plan(const std::string& sequence, double px) { return {sequence, Policy::Threshold, px}; }

OpenSequence changed(const OpenSequence& original, const PlanOf& of) {
  TALISMAN_CHECK(of.speed > 0);
  OpenSequence open = original;
  Sequence& sequence = open.sequence;
  open.settings.regulator = regulated(open.settings.regulator, of);
  open.settings.frames = sequence.frames;
  if (of.speed != 1) {
    open.settings.fps /= of.speed;
    // Faster, it is over earlier.
    open.settings.frames =
        std::max(1, static_cast<int>(std::floor(sequence.frames / std::max(1.0, of.speed))));
  }
  if (of.fixed_camera) {
    const double middle_s = sequence.frames / 2 / sequence.fps;
    sequence.scene = std::make_shared<const layers::Scene>(with_fixed_camera(*sequence.scene, middle_s));
  }
  if (of.full_resolution) {
    open.settings.placement.resolution_scale = 1;
    for (layers::LayerSpec& spec : sequence.layer_specs) make_full_resolution(spec);
  }
  if (of.fixed_camera || of.full_resolution)
    sequence.layers = layers::factor(*sequence.scene, sequence.layer_specs);
  return open;
}

const OpenSequence& PaperBench::sequence(const std::string& name) {
  std::unique_ptr<OpenSequence>& place = sequences_[name];
  if (!place) place = std::make_unique<OpenSequence>(open_(name));
  return *place;
}

const PlannedRun& PaperBench::plan(const PlanOf& of) {
  plan_all({of});
  return plans_.at(of);
}

void PaperBench::plan_all(const std::vector<PlanOf>& all) {
  std::vector<PlanOf> missing;
  for (const PlanOf& of : all)
    if (!plans_.count(of)) missing.push_back(of);
  std::vector<const OpenSequence*> opened;
  for (const PlanOf& of : missing) opened.push_back(&sequence(of.sequence));
  std::vector<PlannedRun> runs(missing.size());
  oneapi::tbb::parallel_for(std::size_t{0}, missing.size(),
                            [&](std::size_t k) { runs[k] = planned_run(*opened[k], missing[k]); });
  for (std::size_t k = 0; k < missing.size(); ++k) plans_.emplace(missing[k], std::move(runs[k]));
}

}  // namespace talisman::sequences
