// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "layers/lod/levels.h"
#include "sequences/content/levels.h"
#include "sequences/experiments/lod/measured.h"
#include "sequences/experiments/regulator/setting_run.h"
#include "sequences/pipeline/lod/levels_now.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using regulator::LodSelector;
using regulator::Policy;

/// A row.
struct LodSetting {
  std::string name;
  double target_ms = 0;
  regulator::RegulatorOptions options;
};

LodSetting selected(const char* name, LodSelector by, double target_ms, regulator::RegulatorOptions options) {
  options.lod.by = by;
  options.policy = by == LodSelector::Optimise ? Policy::Budget : Policy::Reference;
  // Measured only where there is a budget of time, and all rows have to be priced alike.
  const double depth = std::max(1.0, options.budget.depth_complexity);
  options.budget = {};
  options.budget.depth_complexity = depth;
  if (target_ms > 0) options.budget.ms = target_ms;
  return {name, target_ms, options};
}

/// What a run does at each frame, beside what all experiments count.
class LodCounter {
 public:
  void add(const FrameReport& report, LodResult& result) {
    if (report.plan.lod) {
      result.frames_unfit += !report.plan.lod->fits;
      result.skipped += report.plan.lod->skipped;
      benefit_ += report.plan.lod->benefit;
      bound_ += report.plan.lod->upper_bound;
    }
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      if (decision.action != regulator::Action::Rerender) continue;
      const auto [last, is_new] = level_.try_emplace(decision.layer, decision.level);
      result.switched += !is_new && last->second != decision.level;
      last->second = decision.level;
    }
    if (bound_ > 0) result.share_of_bound = benefit_ / bound_;
  }

 private:
  std::map<int, int> level_;  ///< by layer, of its last render
  double benefit_ = 0, bound_ = 0;
};

struct LodRun {
  LodResult result;
  std::vector<double> ms;
};

LodRun measure_selector(const Sequence& sequence, Settings settings, const LodSetting& setting,
                        const ExperimentFrames& frames, const chunker::PreparedScene& prepared,
                        const std::map<int, Image8>& truth) {
  settings.regulator = setting.options;
  SettingRun run(sequence, settings, {setting.name, "", 0, setting.options});
  LodRun measured;
  measured.result.name = setting.name;
  measured.result.target_ms = setting.target_ms;
  const std::vector<int> sampled = sampled_frames(frames);
  LodCounter counter;
  for (int frame = 0; frame <= frames.last; ++frame) {
    const bool is_judged = is_sampled(sampled, frame), is_drawn = is_judged || is_sampled(sampled, frame + 1);
    run.advance(frame, is_drawn ? &prepared : nullptr);
    if (frame < frames.first) continue;
    run.count();
    counter.add(run.report(), measured.result);
    measured.ms.push_back(planned_drawing_ms(run.report()));
    measured.result.frames_above +=
        setting.target_ms > 0 && measured.ms.back() > setting.target_ms * (1 + 1e-9);
    if (is_judged) run.judge({frame > 0 ? truth.at(frame - 1) : Image8{}, truth.at(frame)});
  }
  measured.result.modelled = frame_spread_of(measured.ms);
  measured.result.measured = run.result();
  return measured;
}

/// The sampled frames and those before them, at full detail.
std::map<int, Image8> full_detail(const Sequence& sequence, const Settings& settings,
                                  const ExperimentFrames& frames, const chunker::PreparedScene& prepared) {
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  std::map<int, Image8> pictures;
  for (const int frame : drawn_frames(frames))
    pictures[frame] = to_image8(draw_reference(pipeline, frame, prepared));
  return pictures;
}

}  // namespace

FrameSpread frame_spread_of(const std::vector<double>& ms) {
  if (ms.empty()) return {};
  FrameSpread spread{ms[0], 0, ms[0], 0};
  for (const double t : ms) {
    spread.min = std::min(spread.min, t);
    spread.max = std::max(spread.max, t);
    spread.mean += t / static_cast<double>(ms.size());
  }
  for (const double t : ms) spread.sigma += (t - spread.mean) * (t - spread.mean);
  spread.sigma = std::sqrt(spread.sigma / static_cast<double>(ms.size()));
  return spread;
}

LodExperiment measure_lod(const Sequence& given, const Settings& settings, const ExperimentFrames& frames,
                          ProgressKind progress) {
  Sequence sequence = given;
  if (!sequence.scene->levels) add_levels(sequence);
  LodExperiment experiment{sequence.name, settings.view.display_px, frames, 1, {}, {}};
  for (const layers::Layer& layer : sequence.layers.layers)
    experiment.levels = std::max(experiment.levels, layers::level_count(*sequence.scene, layer));
  const chunker::PreparedScene prepared(*sequence.scene, settings.render);
  const std::map<int, Image8> truth = full_detail(sequence, settings, frames, prepared);
  const regulator::RegulatorOptions& base = settings.regulator;
  Progress bar(progress, "selectors", 8);
  const auto add = [&](const LodSetting& setting) {
    LodRun run = measure_selector(sequence, settings, setting, frames, prepared, truth);
    experiment.results.push_back(std::move(run.result));
    experiment.modelled_ms.push_back(std::move(run.ms));
    bar.advance();
  };
  add(selected("none", LodSelector::None, 0, base));
  add(selected("static", LodSelector::Static, 0, base));
  const double given_ms = base.budget.ms;
  const double target_ms =
      std::isfinite(given_ms) && given_ms > 0 ? given_ms : experiment.results.back().modelled.mean;
  for (const double share : {1.0, 0.5}) {
    add(selected("feedback", LodSelector::Feedback, share * target_ms, base));
    LodSetting optimise = selected("optimise, error", LodSelector::Optimise, share * target_ms, base);
    optimise.options.lod.benefit = regulator::LodBenefit::Error;
    add(optimise);
    optimise.name = "optimise, printed";
    optimise.options.lod.benefit = regulator::LodBenefit::Printed;
    add(optimise);
  }
  return experiment;
}

}  // namespace talisman::sequences
