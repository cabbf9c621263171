// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/experiment.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "layers/check.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {
namespace {

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
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, reference);
  PipelineState state(pipeline);
  std::int64_t polygons = 0;
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    polygons += line_of(report).polygons_reference;
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
