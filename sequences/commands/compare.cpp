// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/compare.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <set>

#include <oneapi/tbb/global_control.h>

#include "sequences/commands/compared_run.h"
#include "sequences/commands/run_words.h"
#include "sequences/commands/stop.h"
#include "sequences/commands/words.h"
#include "sequences/experiments/comparison/report.h"
#include "sequences/experiments/comparison/side_by_side.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/setting_file.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/frame_writer.h"
#include "sequences/files/video.h"
#include "sequences/pictures/plot.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/run_folder.h"

namespace talisman::sequences {

namespace {

constexpr const char* kMark = "compare.json";

/// What can be refused without the sequence.
void require_settings(const std::vector<std::string>& settings) {
  std::set<std::string> files{"reference"};
  for (const std::string& setting : settings) {
    words_of_setting(setting);
    if (setting == "reference")
      throw InputError("'reference' is what all are compared with, must not be given");
    if (!files.insert(file_name_of(setting)).second)
      throw InputError("'" + setting + "' is given twice, must be given once");
  }
}

/// `reference`, and behind it all that were asked for.
std::vector<ComparedSettings> compared_settings(const CompareOptions& options, const Sequence& sequence,
                                                RunOptions& run_options) {
  std::vector<ComparedSettings> compared;
  ResolvedRun reference = resolve_setting("reference", options.line, sequence);
  run_options = reference.options;
  compared.push_back({"reference", reference.settings});
  for (const std::string& setting : options.settings)
    compared.push_back({setting, resolve_setting(setting, options.line, sequence).settings});
  return compared;
}

/// What an earlier comparison left goes; a run is not touched.
void make_room(const std::string& folder) {
  if (holds_run(folder))
    throw InputError("--out is '" + folder + "', which holds a run, must be another folder");
  begin_report_folder(folder, kMark, "a comparison");
  std::error_code ignored;
  for (const char* part : {"/frames", "/runs"}) std::filesystem::remove_all(folder + part, ignored);
  std::filesystem::remove(folder + "/video.mp4", ignored);
}

/// Side by side, as files; written while the next frames are drawn.
class SheetWriter {
 public:
  SheetWriter(RunOptions options, std::vector<std::string> titles)
      : options_(std::move(options)), titles_(std::move(titles)) {
    prepare_folder(options_.out + "/frames");
  }
  void write(int frame, const ShownFrames& shown) {
    const auto sheet = std::make_shared<const Image8>(side_by_side(shown, titles_));
    writer_.submit([this, frame, sheet] { write_png(frame_path(options_, frame), *sheet); });
  }
  void finish() { writer_.finish(); }

 private:
  RunOptions options_;
  std::vector<std::string> titles_;
  FrameWriter writer_;
};

ComparisonReport compared(const CompareOptions& options, const Sequence& sequence,
                          const std::vector<ComparedSettings>& settings, const RunOptions& run_options,
                          const std::atomic<bool>& stop) {
  const FrameRange range{run_options.first_frame, run_options.last_frame};
  std::vector<std::string> titles;
  for (const ComparedSettings& each : settings) titles.push_back(each.name);
  std::optional<SheetWriter> sheets;
  if (!options.no_video) sheets.emplace(run_options, titles);
  ComparisonReport report = compare_settings(sequence, settings, range, run_options.progress, stop,
                                             [&](int frame, const ShownFrames& shown) {
                                               if (sheets) sheets->write(frame, shown);
                                             });
  if (sheets) sheets->finish();
  return report;
}

/// Of the pictures side by side, which stay without it.
void add_video(const ComparisonReport& report, const std::string& folder) try {
  write_video(folder, report.fps, FrameFormat::Png, report.frames.first, report.frames.last);
} catch (const OutputError& error) {
  throw PartialResult(std::string(error.what()) + "; the tables and the frames are there");
}

}  // namespace

void add_compare_options(CLI::App& command, CompareOptions& options) {
  CommandLine& line = options.line;
  add_sequence_option(command, line);
  command
      .add_option(
          "settings", options.settings,
          "POLICY, POLICY:VALUE or POLICY:KEY=VALUE,…: threshold:1 budget:ms=5,choice=best hold:3; keys "
          "are the options of render")
      ->required();
  add_run_group(command, line, "out/NAME-compare")
      .flag("--no-video", options.no_video, "no pictures and no video side by side");
  add_content_options(command, line.content);
}

int run_compare(const CompareOptions& options, const std::atomic<bool>& stop, std::ostream& out) {
  heeds_stop = true;
  using oneapi::tbb::global_control;
  require_settings(options.settings);
  choice("--progress", options.line.progress, kProgressWords);
  require_threads(options.line.threads);
  const Sequence sequence = load_with_warnings(options.line);
  RunOptions run_options;
  const std::vector<ComparedSettings> settings = compared_settings(options, sequence, run_options);
  run_options.out = options.line.out.empty() ? "out/" + sequence.name + "-compare" : options.line.out;
  run_options.format = FrameFormat::Png;
  std::optional<global_control> threads;
  if (options.line.threads > 0)
    threads.emplace(global_control::max_allowed_parallelism, options.line.threads);
  require_plotter();
  if (!options.no_video) require_video_encoder();
  make_room(run_options.out);
  const ComparisonReport report = compared(options, sequence, settings, run_options, stop);
  publish(report, run_options.out, out);
  finish_report_folder(run_options.out, kMark);
  if (!report.is_stopped && !options.no_video) add_video(report, run_options.out);
  out << "\nresults in " << run_options.out << "\n";
  if (!report.is_stopped) return kSuccess;
  std::fprintf(stderr, "error: stopped after %d frames; the tables hold these\n",
               report.frames.last - report.frames.first + 1);
  return kPartialResult;
}

}  // namespace talisman::sequences
