// SPDX-License-Identifier: Apache-2.0
#include "sequences/regulator_experiment.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "layers/check.h"
#include "sequences/diff.h"
#include "sequences/rank_correlation.h"
#include "sequences/results.h"

namespace talisman::sequences {
namespace {

Timing timing_of(const std::vector<FrameLine>& lines, double FrameLine::*field) {
  std::vector<double> ms;
  for (const FrameLine& line : lines) ms.push_back(line.*field);
  if (ms.empty()) return {};
  return {std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size()), quantile(ms, 0.5)};
}

/// One setting on its way through the frames.
class SettingRun {
 public:
  SettingRun(const Sequence& sequence, Settings settings, const RegulatorSetting& setting)
      : setting_(setting),
        pipeline_(*sequence.scene, sequence.layers, with(std::move(settings), setting)),
        state_(pipeline_),
        summary_(start_summary(pipeline_, sequence.name)) {}
  SettingRun(const SettingRun&) = delete;
  SettingRun& operator=(const SettingRun&) = delete;

  /// Plans frame `frame`, and draws it where `prepared` is given.
  void advance(int frame, const chunker::PreparedScene* prepared) {
    layers_before_.clear();
    for (const ShownSprite& sprite : report_.shown) layers_before_.push_back(sprite.layer);
    report_ = step(pipeline_, state_, frame, prepared);
    before_ = std::move(now_);
    now_ = prepared ? to_image8(report_.picture) : Image8{};
  }

  void count() {
    const Pipeline& pipeline = with_aggregates(pipeline_, state_);
    add_decisions(summary_, pipeline, report_, state_);
    summary_.frames.push_back(line_of(pipeline, report_));
    for (const regulator::LayerDecision& decision : report_.plan.decisions) chunks_ += decision.cost.chunks;
  }

  /// The frame of the last advance was drawn, and so was the one before unless it was the first.
  void judge(const ConsecutiveFrames& truth) {
    drawn_.push_back(summary_.frames.back());
    qualities_.push_back({std::to_string(report_.frame), compare(now_, truth.now)});
    if (before_.rgb.empty()) return;
    popping_.add(
        {before_, now_}, truth,
        stepping_pixels(layers_before_, report_, state_.sprites, pipeline_.settings.view.display_px));
  }

  ConsecutiveFrames pictures() const { return {before_, now_}; }
  SettingResult result() const;

 private:
  static Settings with(Settings settings, const RegulatorSetting& setting) {
    settings.regulator = setting.options;
    return settings;
  }

  RegulatorSetting setting_;
  Pipeline pipeline_;
  PipelineState state_;
  Summary summary_;
  FrameReport report_;
  Image8 before_, now_;  ///< empty where not drawn
  std::vector<int> layers_before_;
  std::int64_t chunks_ = 0;
  std::vector<FrameLine> drawn_;
  std::vector<FrameDiff> qualities_;
  PoppingMeter popping_;
};

SettingResult SettingRun::result() const {
  SettingResult result;
  result.setting = setting_;
  result.mean_update_rate = summary_.mean_update_rate();
  result.weighted_update_rate = summary_.cost_weighted_update_rate();
  result.polygons = summary_.total(&FrameLine::polygons_rendered);
  result.pixels = summary_.total(&FrameLine::pixels_rendered);
  result.chunks = chunks_;
  double error_px = 0;
  int shown = 0;
  for (const LayerSummary& layer : summary_.layers) {
    result.renders += layer.renders;
    error_px += layer.sum_geometric_px;
    shown += layer.frames_shown;
    result.max_geometric_px = std::max(result.max_geometric_px, layer.max_geometric_px);
  }
  result.mean_geometric_px = shown > 0 ? error_px / shown : 0;
  result.plan = timing_of(summary_.frames, &FrameLine::plan_ms);
  result.render = timing_of(drawn_, &FrameLine::render_ms);
  result.composite = timing_of(drawn_, &FrameLine::composite_ms);
  result.modelled_ms = timing_of(drawn_, &FrameLine::modelled_ms).mean;
  result.quality = summarize(qualities_).mean;
  result.popping = popping_.result();
  return result;
}

/// How often the sampled frames have met each phase of each period of hold and interpolate.
class Phases {
 public:
  Phases() {
    for (const int period : compared_holds()) hits_.emplace_back(period, 0);
  }
  /// Times that the phases of `frame` were met, each in proportion to how rare it is.
  int met(int frame) const {
    int weighted = 0;
    for (const std::vector<int>& hits : hits_)
      weighted += static_cast<int>(hits.size()) * hits[frame % hits.size()];
    return weighted;
  }
  void add(int frame) {
    for (std::vector<int>& hits : hits_) ++hits[frame % hits.size()];
  }

 private:
  std::vector<std::vector<int>> hits_;
};

}  // namespace

std::vector<int> sampled_frames(const ExperimentFrames& frames) {
  TALISMAN_CHECK_GE(frames.every, 1);
  TALISMAN_CHECK_LE(frames.first, frames.last);
  Phases phases;
  std::vector<int> sampled;
  for (int begin = frames.first; begin <= frames.last; begin += frames.every) {
    const int end = begin + std::min(frames.every - 1, frames.last - begin);
    const auto rank = [&](int frame) {
      return std::pair{phases.met(frame), std::abs(2 * frame - begin - end)};
    };
    int best = begin == 0 && end > 0 ? 1 : begin;  // frame 0 has no predecessor
    for (int frame = best + 1; frame <= end; ++frame)
      if (rank(frame) < rank(best)) best = frame;
    sampled.push_back(best);
    phases.add(best);
    if (end == frames.last) break;  // the next stratum might begin beyond the largest number
  }
  return sampled;
}

double reference_polygons_per_frame(const Sequence& sequence, const Settings& settings,
                                    const ExperimentFrames& frames) {
  Settings reference = settings;
  reference.regulator.policy = regulator::Policy::Reference;
  const Pipeline pipeline(*sequence.scene, sequence.layers, reference);
  PipelineState state(pipeline);
  std::int64_t polygons = 0;
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    polygons += line_of(with_aggregates(pipeline, state), report).polygons_reference;
  }
  return static_cast<double>(polygons) / (frames.last - frames.first + 1);
}

std::vector<SettingResult> measure_regulator(const Sequence& sequence, const Settings& settings,
                                             const std::vector<RegulatorSetting>& compared,
                                             const ExperimentFrames& frames, ProgressKind progress_kind) {
  TALISMAN_CHECK(!compared.empty() && compared[0].options.policy == regulator::Policy::Reference);
  const chunker::PreparedScene prepared(*sequence.scene);
  std::vector<std::unique_ptr<SettingRun>> runs;
  for (const RegulatorSetting& setting : compared)
    runs.push_back(std::make_unique<SettingRun>(sequence, settings, setting));
  const std::vector<int> sampled = sampled_frames(frames);
  const auto is_sampled = [&sampled](int frame) {
    return std::binary_search(sampled.begin(), sampled.end(), frame);
  };
  Progress progress(progress_kind, "compared", static_cast<int>(sampled.size() * runs.size()));
  for (int frame = 0; frame <= frames.last; ++frame) {
    const bool judged = is_sampled(frame), drawn = judged || is_sampled(frame + 1);
    for (const std::unique_ptr<SettingRun>& run : runs) {
      run->advance(frame, drawn ? &prepared : nullptr);
      if (frame >= frames.first) run->count();
      if (!judged) continue;
      run->judge(runs[0]->pictures());
      progress.advance();
    }
  }
  std::vector<SettingResult> results;
  for (const std::unique_ptr<SettingRun>& run : runs) results.push_back(run->result());
  return results;
}

}  // namespace talisman::sequences
