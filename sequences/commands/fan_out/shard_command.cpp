// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/fan_out/shard_command.h"

#include <cstdio>
#include <filesystem>
#include <ostream>

#include <oneapi/tbb/global_control.h>

#include "sequences/files/file_text.h"
#include "sequences/files/folders.h"
#include "sequences/files/line_file.h"
#include "sequences/files/number_text.h"
#include "sequences/files/output_file.h"
#include "sequences/files/video.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/results/report/what_if.h"
#include "sequences/results/run_folder.h"
#include "sequences/results/run_identity.h"
#include "sequences/results/shards/shard_file.h"
#include "sequences/results/timing.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A shard of a run that is known in full.
struct ShardRun {
  Shard shard;
  FrameRange whole, range;
  Json run;  ///< run.json of the whole
  std::string folder, partial;
};

bool is_empty(const FrameRange& range) { return range.last < range.first; }

ShardRun shard_run_of(const CommandLine& line, const Sequence& sequence, const ResolvedRun& resolved) {
  const std::optional<Shard> shard = shard_from(line.shard, "/");
  if (!shard)
    throw InputError("--shard is '" + line.shard +
                     "', rule: i/N with 0 <= i < N <= " + std::to_string(kMostShards));
  if (resolved.options.audit_every > 0)
    throw InputError("--audit takes every so many reuses of the whole run, must be given without --shard");
  if (resolved.options.video) require_video_encoder();
  ShardRun run;
  run.shard = *shard;
  run.whole = {resolved.options.first_frame, resolved.options.last_frame};
  run.run = run_json(sequence, resolved.settings, resolved.options);
  std::vector<double> costs;
  if (!line.shard_plan.empty()) costs = costs_in_plan(line.shard_plan, run.whole, run.run);
  run.range = part_of(run.whole, run.shard, costs);
  run.folder = shard_folder(resolved.options.out, run.shard);
  run.partial = run.folder + ".partial";
  return run;
}

/// Is the folder this shard, whole and undamaged?
bool is_complete(const ShardRun& run) {
  const std::optional<ShardFile> file = read_shard_file(run.folder);
  return file && file->run == run.run && file->range.first == run.range.first &&
         file->range.last == run.range.last && first_damaged(run.folder, *file).empty();
}

RunOptions options_of(const ShardRun& run, const RunOptions& whole) {
  RunOptions options = whole;
  options.out = run.partial;
  options.first_frame = run.range.first, options.last_frame = run.range.last;
  options.part_of_run_from = run.whole.first;
  options.video = false;  // of the whole run
  options.resume = whole.resume && !whole.plan_only;
  return options;
}

std::string range_in_words(const FrameRange& range) {
  return is_empty(range) ? "no frame"
                         : "frames " + std::to_string(range.first) + "-" + std::to_string(range.last);
}

/// What it costs to begin in the middle: the sprites that are shown in the first frame and were drawn before it.
std::string cost_of_cut(const ShardRun& run) {
  if (is_empty(run.range) || run.range.first == run.whole.first) return {};
  for (const std::string& text : lines_written(run.folder + "/timing.jsonl")) {
    const std::optional<FrameTiming> timing = timing_from_json(text);
    if (!timing || timing->frame != run.range.first) continue;
    return formatted("; the first frame took %.1f ms to draw, with the sprites that live at the cut",
                     timing->times.render_ms);
  }
  return {};
}

/// The last frame of the run is planned by this shard, and so is what a threshold would cost that is half or twice.
Json what_if_of(const ShardRun& run, const Sequence& sequence, const ResolvedRun& resolved,
                bool makes_report) {
  const bool is_last = !is_empty(run.range) && run.range.last == run.whole.last;
  if (!is_last || !makes_report || resolved.options.plan_only || !has_threshold(resolved.settings))
    return nullptr;
  return what_if_plans(sequence, resolved.settings, run.whole);
}

/// All of it is on the disk: it gets its name. What stood there is taken away last.
void publish(const ShardRun& run) {
  const std::string old = (fs::path(run.folder).parent_path() / (".old-" + run.shard.name())).string();
  std::error_code error;
  fs::remove_all(old, error);
  if (fs::exists(run.folder, error)) rename_file(run.folder, old, run.folder);
  rename_file(run.partial, run.folder, run.folder);
  fs::remove_all(old, error);
}

/// A shard that was complete once and is damaged is gone on with, as one that was never completed.
void reopen(const ShardRun& run) {
  std::error_code error;
  if (!fs::exists(run.folder, error) || fs::exists(run.partial, error)) return;
  rename_file(run.folder, run.partial, run.folder);
  fs::remove(run.partial + "/shard.json", error);
}

}  // namespace

void require_shard_options(const CommandLine& line, bool plan_only) {
  if (!line.shard.empty()) return;
  if (!line.shard_plan.empty())
    throw InputError("--plan shares out the frames of --shard, must come with it");
  if (plan_only && line.resume)
    throw InputError("--resume of a plan is about its --shard, must come with it");
}

int run_shard(const CommandLine& line, bool plan_only, const std::atomic<bool>& stop, std::ostream& out) {
  const Sequence sequence = load_with_warnings(line);
  const ResolvedRun resolved = resolve(line, sequence, plan_only);
  const ShardRun run = shard_run_of(line, sequence, resolved);
  require_folder_or_nothing(resolved.options.out);
  create_folder(resolved.options.out + "/" + kShardsFolder);
  const std::string what = "shard " + std::to_string(run.shard.index) + " of " +
                           std::to_string(run.shard.of) + ", " + range_in_words(run.range);
  if (line.resume && is_complete(run)) {
    if (!line.quiet) out << what << ": complete already, in " << run.folder << "\n";
    return kSuccess;
  }
  if (line.resume) reopen(run);
  const bool makes_report =
      !line.no_report && has_report() && resolved.options.decisions == DecisionLines::All;
  ShardWishes wishes{makes_report, !line.no_thumbnails, resolved.options.video, resolved.settings.fps,
                     nullptr};
  Summary summary;
  if (is_empty(run.range)) {
    create_folder(run.partial);
    summary =
        start_summary(make_pipeline(*sequence.scene, sequence.layers, resolved.settings), sequence.name);
    summary.planned_only = plan_only;
  } else {
    RunOptions options = options_of(run, resolved.options);
    options.changes = makes_report;
    RunOutcome outcome = talisman::sequences::run(sequence, resolved.settings, options, stop);
    if (!outcome.complete) {
      std::fprintf(stderr, "error: stopped after %d frames of %s; the same command with --resume continues\n",
                   outcome.summary.frame_count(), what.c_str());
      return kPartialResult;
    }
    summary = std::move(outcome.summary);
  }
  wishes.what_if = what_if_of(run, sequence, resolved, makes_report);
  write_shard_file(run.partial, run.shard, run.range, run.run, summary, wishes);
  publish(run);
  if (!line.quiet) out << what << ": in " << run.folder << cost_of_cut(run) << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
