// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/experiment.h"

#include <memory>
#include <utility>

#include "layers/check.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

double reference_polygons_per_frame(const Sequence& sequence, const Settings& settings,
                                    const ExperimentFrames& frames) {
  Settings reference = settings;
  reference.regulator.policy = regulator::Policy::Reference;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, reference);
  PipelineState state(pipeline);
  std::int64_t polygons = 0;
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    polygons += line_of(report).polygons.reference;
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
  Progress progress(progress_kind, "compared", static_cast<int>(sampled.size() * runs.size()));
  for (int frame = 0; frame <= frames.last; ++frame) {
    const bool judged = is_sampled(sampled, frame), drawn = judged || is_sampled(sampled, frame + 1);
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
