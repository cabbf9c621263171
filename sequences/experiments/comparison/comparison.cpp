// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/comparison/comparison.h"

#include <algorithm>
#include <memory>

#include "layers/check.h"
#include "sequences/experiments/regulator/setting_run.h"

namespace talisman::sequences {

namespace {

using Runs = std::vector<std::unique_ptr<SettingRun>>;

Runs runs_of(const Sequence& sequence, const std::vector<ComparedSettings>& settings) {
  Runs runs;
  for (const ComparedSettings& each : settings)
    runs.push_back(std::make_unique<SettingRun>(sequence, each.settings,
                                                RegulatorSetting{each.name, "", 0, each.settings.regulator}));
  return runs;
}

Compared compared_of(const std::string& name, const SettingRun& run) {
  Compared compared;
  compared.name = name;
  compared.result = run.result();
  compared.summary = run.summary();
  compared.quality = summarize(run.qualities());
  for (const FrameDiff& frame : run.qualities()) compared.flip.push_back(frame.quality.flip);
  for (const FrameLine& line : compared.summary.frames)
    compared.worst_modelled_ms = std::max(compared.worst_modelled_ms, line.modelled_ms);
  return compared;
}

ShownFrames shown(const Runs& runs) {
  ShownFrames frames;
  for (const auto& run : runs) frames.push_back(&run->pictures().now);
  return frames;
}

}  // namespace

ComparisonReport compare_settings(const Sequence& sequence, const std::vector<ComparedSettings>& settings,
                                  const FrameRange& range, ProgressKind progress_kind,
                                  const std::atomic<bool>& stop,
                                  const std::function<void(int frame, const ShownFrames&)>& show) {
  TALISMAN_CHECK(!settings.empty() && settings[0].settings.regulator.policy == regulator::Policy::Reference);
  ComparisonReport report{
      sequence.name, settings[0].settings.view.display_px, settings[0].settings.fps, range, {}, false};
  const chunker::PreparedScene prepared(*sequence.scene);
  const Runs runs = runs_of(sequence, settings);
  const int frames = range.last - range.first + 1;
  Progress progress(progress_kind, "compared", frames * static_cast<int>(runs.size()));
  int done = range.first - 1;
  for (int frame = 0; frame <= range.last && !stop; ++frame) {
    const bool is_drawn = frame >= range.first;
    for (const auto& run : runs) {
      run->advance(frame, is_drawn ? &prepared : nullptr);
      if (!is_drawn) continue;
      run->count();
      run->judge(runs[0]->pictures());
      progress.advance();
    }
    if (!is_drawn) continue;
    show(frame, shown(runs));
    done = frame;
  }
  report.is_stopped = done < range.last;
  report.frames.last = done;
  if (done >= range.first)
    for (std::size_t k = 0; k < runs.size(); ++k)
      report.compared.push_back(compared_of(settings[k].name, *runs[k]));
  return report;
}

}  // namespace talisman::sequences
