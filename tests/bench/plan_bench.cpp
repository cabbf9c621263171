// SPDX-License-Identifier: Apache-2.0

/// What does planning cost? 119 moving layers, as many as the barnyard of [LS97] has, 250 frames, all
/// fiducials, on one thread. The layers fly through each other; `merging` draws those that meet into one
/// sprite, the others leave them apart. Counters:
///
///   us_per_layer_frame   plan time over layers × frames, as `talisman plan` reports it
///   renders              share of layers and frames that are drawn again
///   share_of_16ms        plan time of a frame over a display frame at 60 Hz
///
/// The steps of one frame beside it, per layer: scene evaluation, capture, order.

#include <benchmark/benchmark.h>

#include "layers/layer.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/step.h"
#include "tests/support/fleet.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

constexpr int kLayers = 119, kFrames = 250;

struct Workload {
  layers::Scene scene = fleet_scene(kLayers, 1997, 8);
  layers::LayerSet layers = layers::factor(scene, one_layer_per_part(scene));
  sequences::Settings settings;
  explicit Workload(regulator::Policy policy, sequences::Cycles cycles = sequences::Cycles::Keep) {
    settings.cycles = cycles;
    settings.regulator.policy = policy;
    settings.regulator.thresholds.geometric_px = 1;
    settings.regulator.budget.polygons = kLayers * 12 / 2;
    settings.regulator.budget.pixels = 300'000;
    settings.frames = kFrames;
  }
};

void plan_sequence(benchmark::State& run, regulator::Policy policy,
                   sequences::Cycles cycles = sequences::Cycles::Keep) {
  const Workload work(policy, cycles);
  const sequences::Pipeline pipeline = sequences::make_pipeline(work.scene, work.layers, work.settings);
  double plan_ms = 0;
  std::int64_t renders = 0, frames = 0;
  for (auto _ : run) {
    sequences::PipelineState state(pipeline);
    for (int frame = 0; frame < kFrames; ++frame, ++frames) {
      const sequences::FrameReport report = sequences::step(pipeline, state, frame, nullptr);
      plan_ms += report.times.plan_ms;
      for (const regulator::LayerDecision& d : report.plan.decisions)
        renders += d.action == regulator::Action::Rerender;
    }
  }
  const double layer_frames = static_cast<double>(frames) * kLayers;
  run.counters["us_per_layer_frame"] = 1e3 * plan_ms / layer_frames;
  run.counters["renders"] = static_cast<double>(renders) / layer_frames;
  run.counters["share_of_16ms"] = plan_ms / static_cast<double>(frames) / (1e3 / 60);
}
BENCHMARK_CAPTURE(plan_sequence, threshold, regulator::Policy::Threshold)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_sequence, threshold_merging, regulator::Policy::Threshold, sequences::Cycles::Merge)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_sequence, interpolate, regulator::Policy::Interpolate)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_sequence, budget, regulator::Policy::Budget)->Unit(benchmark::kMillisecond);

/// Whole sequences that are shipped, as `talisman plan` plans them.
void plan_shipped(benchmark::State& run, const char* name) {
  const sequences::Sequence sequence = sequences::load_sequence(name);
  const sequences::Settings settings = sequences::own_settings(sequence);
  const sequences::Pipeline pipeline = sequences::make_pipeline(*sequence.scene, sequence.layers, settings);
  double plan_ms = 0;
  std::int64_t frames = 0;
  for (auto _ : run) {
    sequences::PipelineState state(pipeline);
    for (int frame = 0; frame < sequence.frames; ++frame, ++frames)
      plan_ms += sequences::step(pipeline, state, frame, nullptr).times.plan_ms;
  }
  run.counters["us_per_layer_frame"] =
      1e3 * plan_ms / (static_cast<double>(frames) * static_cast<double>(sequence.layers.layers.size()));
}
BENCHMARK_CAPTURE(plan_shipped, canyon, "canyon")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_shipped, barnyard, "barnyard")->Unit(benchmark::kMillisecond);

void scene_of_frame(benchmark::State& run) {
  const Workload work(regulator::Policy::Threshold);
  for (auto _ : run) benchmark::DoNotOptimize(work.scene.at(1.3));
}
BENCHMARK(scene_of_frame)->Unit(benchmark::kMicrosecond);

void capture_all(benchmark::State& run) {
  const Workload work(regulator::Policy::Threshold);
  const sequences::Pipeline pipeline = sequences::make_pipeline(work.scene, work.layers, work.settings);
  const layers::SceneFrame frame = work.scene.at(1.3);
  for (auto _ : run)
    for (const layers::Layer& layer : work.layers.layers)
      benchmark::DoNotOptimize(
          layers::capture(frame, layer, pipeline.authored.bound(layer.id), work.settings.view));
}
BENCHMARK(capture_all)->Unit(benchmark::kMicrosecond);

void order_layers(benchmark::State& run) {
  const Workload work(regulator::Policy::Threshold);
  const sequences::Pipeline pipeline = sequences::make_pipeline(work.scene, work.layers, work.settings);
  sequences::PipelineState state(pipeline);
  int frame = 0;
  for (auto _ : run) {
    run.PauseTiming();
    frame = (frame + 1) % kFrames;
    sequences::captured_states(pipeline, state, frame);
    run.ResumeTiming();
    benchmark::DoNotOptimize(sequences::order_layers(pipeline, state, frame));
  }
}
BENCHMARK(order_layers)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace talisman::tests
