// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/measure.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <optional>

#include "layers/check.h"
#include "sequences/experiments/statistics.h"
#include "sequences/pictures/diff.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"

namespace talisman::sequences {
namespace {

WallTime wall_time(const std::vector<double>& ms) {
  WallTime time;
  time.median_ms = median(ms);
  std::vector<double> deviations;
  for (const double value : ms) deviations.push_back(std::fabs(value - time.median_ms));
  time.spread_ms = median(deviations);
  return time;
}

/// The stages of one variant, one number per round: mean ms of a frame.
struct RoundTimes {
  std::vector<double> plan, render, composite, drawn, cpu;
  void begin() {
    for (auto* stage : {&plan, &render, &composite, &drawn, &cpu}) stage->push_back(0);
  }
  void add(const StageTimes& times, double cpu_ms, std::size_t frames) {
    plan.back() += times.plan_ms / double(frames);
    render.back() += times.render_ms / double(frames);
    composite.back() += times.composite_ms / double(frames);
    drawn.back() += (times.render_ms + times.composite_ms) / double(frames);
    cpu.back() += cpu_ms / double(frames);
  }
};

class VariantRun {
 public:
  VariantRun(const Variant& variant, const chunker::PreparedScene& prepared, const Workload& workload)
      : prepared_(prepared),
        workload_(workload),
        pipeline_(make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings)) {}
  VariantRun(const VariantRun&) = delete;
  VariantRun& operator=(const VariantRun&) = delete;

  void draw(int frame) {
    if (frame == workload_.frames.front()) times_.begin();
    if (frame == workload_.frames.front() || !workload_.is_run) state_.emplace(pipeline_);
    const std::clock_t begin = std::clock();
    const FrameReport report = step(pipeline_, *state_, frame, &prepared_);
    const double cpu_ms = 1000.0 * double(std::clock() - begin) / CLOCKS_PER_SEC;
    times_.add(report.times, cpu_ms, workload_.frames.size());
    if (times_.plan.size() == 1) count(report);
  }

  Measured result() {
    measured_.frames = static_cast<int>(workload_.frames.size());
    measured_.modelled_ms /= measured_.frames;
    measured_.plan = wall_time(times_.plan);
    measured_.render = wall_time(times_.render);
    measured_.composite = wall_time(times_.composite);
    measured_.drawn = wall_time(times_.drawn);
    measured_.cpu = wall_time(times_.cpu);
    return std::move(measured_);
  }

 private:
  void count(const FrameReport& report) {
    const FrameLine line = line_of(report);
    measured_.renders += line.renders;
    measured_.polygons += line.polygons.rendered;
    measured_.pixels += line.pixels.rendered;
    measured_.counters += report.render;
    measured_.passes += report.shade;
    measured_.modelled_ms += line.modelled_ms;
    measured_.sprite_bytes = std::max(measured_.sprite_bytes, report.sprite_bytes);
    measured_.shadow_map_bytes = std::max(measured_.shadow_map_bytes, state_->shadow_maps.bytes());
    measured_.texture_bytes = prepared_.texture_bytes();
    if (std::binary_search(workload_.compared.begin(), workload_.compared.end(), report.frame))
      measured_.pictures.push_back(to_image8(report.picture));
  }

  const chunker::PreparedScene& prepared_;
  const Workload& workload_;
  Pipeline pipeline_;
  std::optional<PipelineState> state_;
  RoundTimes times_;
  Measured measured_;
};

/// Texture pyramids, once for each scene.
class PreparedScenes {
 public:
  const chunker::PreparedScene& of(const Variant& variant) {
    std::unique_ptr<chunker::PreparedScene>& prepared = by_scene_[variant.sequence.scene.get()];
    if (!prepared) prepared = std::make_unique<chunker::PreparedScene>(*variant.sequence.scene);
    return *prepared;
  }

 private:
  std::map<const layers::Scene*, std::unique_ptr<chunker::PreparedScene>> by_scene_;
};

}  // namespace

int steps_of(std::size_t variants, const Workload& workload) {
  return static_cast<int>(variants * workload.frames.size()) * workload.rounds;
}

std::vector<Measured> measure_variants(const std::vector<const Variant*>& variants, const Workload& workload,
                                       Progress& progress) {
  TALISMAN_CHECK(!workload.frames.empty());
  TALISMAN_CHECK_GE(workload.rounds, 1);
  PreparedScenes scenes;
  std::vector<std::unique_ptr<VariantRun>> runs;
  for (const Variant* variant : variants)
    runs.push_back(std::make_unique<VariantRun>(*variant, scenes.of(*variant), workload));
  for (int round = 0; round < workload.rounds; ++round)
    for (const int frame : workload.frames)
      for (const std::unique_ptr<VariantRun>& run : runs) {
        run->draw(frame);
        progress.advance();
      }
  std::vector<Measured> results;
  for (const std::unique_ptr<VariantRun>& run : runs) results.push_back(run->result());
  return results;
}

PictureError error_of(const std::vector<Image8>& shown, const std::vector<Image8>& truth) {
  TALISMAN_CHECK_EQ(shown.size(), truth.size());
  std::vector<FrameDiff> frames;
  for (std::size_t k = 0; k < shown.size(); ++k) frames.push_back({"", compare(shown[k], truth[k])});
  const DiffSummary summary = summarize(frames);
  PictureError error;
  error.quality = summary.mean;
  error.quality.max_difference = summary.worst.max_difference;
  error.rms_code_values = rms_code_values(summary.mean.psnr_db);
  return error;
}

}  // namespace talisman::sequences
