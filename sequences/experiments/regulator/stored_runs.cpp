// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/stored_runs.h"

#include <filesystem>

#include "sequences/content/seams.h"
#include "sequences/experiments/regulator/cut_layers.h"
#include "sequences/experiments/setting_file.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/pipeline/stopwatch.h"
#include "sequences/results/report/report.h"
#include "sequences/results/run.h"

namespace talisman::sequences {
namespace {

/// The report of a plan alone; its tables, which are many times as large, go.
void store_run(const Sequence& sequence, const Settings& settings, const ExperimentFrames& frames,
               const std::string& folder, const std::string& page) {
  RunOptions options;
  options.out = folder;
  options.first_frame = frames.first;
  options.last_frame = frames.last;
  options.plan_only = options.changes = options.force = true;
  options.progress = ProgressKind::None;
  const std::atomic<bool> never = false;
  run(with_seams_for(sequence, settings), settings, options, never);
  write_report({folder}, page, false);
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

}  // namespace

void store_runs(const Sequence& sequence, RegulatorReport& report, const std::string& dir) {
  if (!has_report()) return;
  const Stopwatch watch;
  create_folder(dir + "/runs");
  for (const SettingResult& result : report.settings) {
    Settings settings = report.given;
    settings.regulator = result.setting.options;
    const std::string file = "runs/" + file_name_of(result.setting.words()) + ".html",
                      page = dir + "/" + file;
    store_run(with_cut_layers(sequence, result.setting.cut), settings, report.frames, page + ".plan", page);
    report.runs.push_back(file);
    report.runs_mb += double(std::filesystem::file_size(page)) / 1e6;
  }
  report.runs_s = watch.ms() / 1000;
}

}  // namespace talisman::sequences
