// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "regulator/profile.h"
#include "sequences/experiments/predictive/measured.h"
#include "sequences/experiments/regulator/popping.h"
#include "sequences/experiments/seamed_sequence.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/diff.h"
#include "sequences/pipeline/predictive/plan_buffers.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using regulator::Joining;
using regulator::Policy;

constexpr double kDeltas_px[] = {0.01, 0.1, 0.5, 1, 2, 4};
constexpr int kSliceFrames[] = {2, 4, 8, 16, 32, 64};
constexpr double kUsual_px = 1;
constexpr int kUsualFrames = 16, kUsualChildren = 2;

PredictiveSetting plan_setting(const regulator::RegulatorOptions& base, const std::string& series,
                               double value, double delta_px, const regulator::PlanShape& shape,
                               Joining joining = Joining::InPlace) {
  PredictiveSetting setting{series, "", value, base};
  setting.options.policy = Policy::Predictive;
  setting.options.thresholds.geometric_px = delta_px;
  setting.options.lookahead.frames = shape.frames;
  setting.options.predictive = {};
  setting.options.predictive.children = shape.children;
  setting.options.predictive.joining = joining;
  setting.name = formatted("predictive %g px, N %d, k %d, ", delta_px, shape.frames, shape.children) +
                 std::string(regulator::name(joining));
  return setting;
}

PredictiveSetting sprite_setting(const regulator::RegulatorOptions& base, Policy policy, double delta_px) {
  PredictiveSetting setting{std::string(regulator::name(policy)), "", delta_px, base};
  setting.options.policy = policy;
  setting.options.thresholds.geometric_px = delta_px;
  setting.options.lookahead.frames = kUsualFrames;
  setting.name = setting.series + (policy == Policy::Direct ? "" : formatted(" %g px", delta_px));
  return setting;
}

/// One setting on its way through the frames.
class PredictiveRun {
 public:
  PredictiveRun(const Sequence& sequence, Settings settings, const PredictiveSetting& setting)
      : seamed_(sequence, with(settings, setting)),
        pipeline_(make_pipeline(*seamed_.sequence().scene, seamed_.sequence().layers,
                                with(std::move(settings), setting))),
        state_(pipeline_) {
    result_.setting = setting;
  }

  void advance(int frame, const chunker::PreparedScene* prepared, bool counts) {
    report_ = step(pipeline_, state_, frame, prepared ? &seamed_.prepared(*prepared) : nullptr);
    before_ = std::move(now_);
    now_ = prepared ? to_image8(report_.picture) : Image8{};
    if (!counts) return;
    ++frames_;
    result_.plan_ms += report_.times.plan_ms;
    result_.polygons_reference += report_.reference.polygons;
    for (const regulator::LayerDecision& decision : report_.plan.decisions) add(decision);
    if (!report_.predictive) return;
    result_.draws += report_.predictive->parts_drawn;
    result_.shown += report_.predictive->parts;
    result_.joins += report_.predictive->joins_planned;
    result_.joins_empty += report_.predictive->joins_without_content;
  }

  void judge(const ConsecutiveFrames& truth) {
    ++drawn_;
    qualities_.push_back({std::to_string(report_.frame), compare(now_, truth.now)});
    result_.render_ms += report_.times.render_ms;
    result_.composite_ms += report_.times.composite_ms;
    std::int64_t joined = 0;
    result_.bytes = std::max(result_.bytes, report_.sprite_bytes);
    if (report_.predictive) {
      const chunker::JoinCounters& counters = report_.predictive->joined;
      joined = counters.pixels_compared + counters.pixels_copied;
      result_.pixels_cleared += static_cast<double>(counters.pixels_cleared);
      result_.bytes = std::max(result_.bytes, report_.predictive->buffer_bytes);
    }
    result_.pixels_joined += static_cast<double>(joined);
    const regulator::HardwareProfile& profile = regulator::talisman_1996();
    result_.modelled_joining_ms += 1e3 * 6 * static_cast<double>(joined) / profile.compositor_pixels_per_s;
    result_.modelled_ms +=
        regulator::modelled_time(profile, report_.render.polygons_in, report_.render.pixels_filled,
                                 report_.composite.pixels_composited)
            .frame_ms;
    if (before_.rgb.empty() || truth.before.rgb.empty()) return;
    popping_.add({before_, now_}, truth, PixelMask(now_.rgb.size() / 3, 1));
  }

  PredictiveResult result() const {
    PredictiveResult result = result_;
    const double frames = std::max(frames_, 1), drawn = std::max(drawn_, 1);
    result.plan_ms /= frames;
    for (double* sum : {&result.render_ms, &result.composite_ms, &result.modelled_ms,
                        &result.modelled_joining_ms, &result.pixels_joined, &result.pixels_cleared})
      *sum /= drawn;
    result.quality = summarize(qualities_).mean;
    result.popping_rms = popping_.result().rms;
    return result;
  }

 private:
  static Settings with(Settings settings, const PredictiveSetting& setting) {
    settings.regulator = setting.options;
    return settings;
  }
  void add(const regulator::LayerDecision& decision) {
    if (decision.action == regulator::Action::Drop) return;
    result_.polygons += decision.cost.polygons;
    result_.largest_px = std::max(result_.largest_px, decision.shown_geometric_px);
    if (report_.predictive) return;
    ++result_.shown;
    result_.draws += decision.action == regulator::Action::Rerender;
  }

  SeamedSequence seamed_;
  Pipeline pipeline_;
  PipelineState state_;
  FrameReport report_;
  Image8 before_, now_;
  PredictiveResult result_;
  std::vector<FrameDiff> qualities_;
  PoppingMeter popping_;
  int frames_ = 0, drawn_ = 0;
};

/// The frames as `direct` shows them, each drawn once.
class DirectFrames {
 public:
  DirectFrames(const Sequence& sequence, const Settings& settings, const chunker::PreparedScene& prepared)
      : pipeline_(make_pipeline(*sequence.scene, sequence.layers, settings)), prepared_(prepared) {}
  const Image8& at(int frame) {
    const auto [it, is_new] = frames_.try_emplace(frame);
    if (is_new && frame >= 0) it->second = to_image8(draw_direct(pipeline_, frame, prepared_));
    return it->second;
  }

 private:
  Pipeline pipeline_;
  const chunker::PreparedScene& prepared_;
  std::map<int, Image8> frames_;
};

PredictiveResult measure_setting(const Sequence& sequence, const Settings& settings,
                                 const PredictiveSetting& setting, const ExperimentFrames& frames,
                                 const chunker::PreparedScene& prepared, DirectFrames& truth) {
  PredictiveRun run(sequence, settings, setting);
  const std::vector<int> sampled = sampled_frames(frames);
  for (int frame = 0; frame <= frames.last; ++frame) {
    const bool is_judged = is_sampled(sampled, frame);
    const bool is_drawn = is_judged || is_sampled(sampled, frame + 1);
    run.advance(frame, is_drawn ? &prepared : nullptr, frame >= frames.first);
    if (is_judged) run.judge({truth.at(frame - 1), truth.at(frame)});
  }
  return run.result();
}

}  // namespace

std::vector<PredictiveSetting> predictive_settings(const regulator::RegulatorOptions& base) {
  std::vector<PredictiveSetting> settings = {sprite_setting(base, Policy::Direct, 0)};
  const regulator::PlanShape usual{kUsualFrames, kUsualChildren};
  for (const double delta : kDeltas_px) settings.push_back(plan_setting(base, "delta", delta, delta, usual));
  for (const int frames : kSliceFrames)
    settings.push_back(plan_setting(base, "N", frames, kUsual_px, {frames, kUsualChildren}));
  for (const int children : {kUsualChildren, 4, kUsualFrames})
    settings.push_back(plan_setting(base, "k", children, kUsual_px, {kUsualFrames, children}));
  for (const Joining joining : regulator::kAllJoinings)
    settings.push_back(
        plan_setting(base, "joining", static_cast<double>(joining), kUsual_px, usual, joining));
  for (const regulator::Intervals intervals : regulator::kAllIntervals) {
    PredictiveSetting setting =
        plan_setting(base, "intervals", static_cast<double>(intervals), kUsual_px, usual);
    setting.options.predictive.intervals = intervals;
    setting.name += ", intervals " + std::string(regulator::name(intervals));
    settings.push_back(std::move(setting));
  }
  for (const Policy policy : {Policy::Threshold, Policy::Lookahead, Policy::Oracle})
    for (const double delta : kDeltas_px) settings.push_back(sprite_setting(base, policy, delta));
  return settings;
}

PredictiveExperiment measure_predictive(const Sequence& sequence, const Settings& settings,
                                        const ExperimentFrames& frames, ProgressKind progress) {
  PredictiveExperiment experiment{
      sequence.name, settings.view.display_px, frames, settings.render.samples, {}};
  const chunker::PreparedScene prepared(*sequence.scene, settings.render);
  DirectFrames truth(sequence, settings, prepared);
  const std::vector<PredictiveSetting> compared = predictive_settings(settings.regulator);
  Progress bar(progress, "settings", static_cast<int>(compared.size()));
  for (const PredictiveSetting& setting : compared) {
    experiment.results.push_back(measure_setting(sequence, settings, setting, frames, prepared, truth));
    bar.advance();
  }
  return experiment;
}

}  // namespace talisman::sequences
