// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/tune.h"

#include <cstdio>
#include <optional>
#include <ostream>
#include <string>

#include <oneapi/tbb/global_control.h>

#include "sequences/commands/option_group.h"
#include "sequences/commands/run_words.h"
#include "sequences/commands/stop.h"
#include "sequences/commands/words.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/tuning/report.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using regulator::Policy;

double in_range(const char* option, double value, double least, double most, const char* rule) {
  if (!(value >= least && value <= most))
    throw InputError(std::string(option) + formatted(" is %g, must be %s", value, rule));
  return value;
}

TuneGoal goal_of(const TuneOptions& options) {
  const int given = options.flip.has_value() + options.psnr.has_value() + options.budget_ms.has_value();
  if (given != 1)
    throw InputError("--flip, --psnr and --budget-ms: " + std::to_string(given) +
                     " given, must be one of them");
  constexpr double kLargest = 1e6, kSmallest = 1e-6, kMostPsnr = 120;
  if (options.flip)
    return {GoalKind::Flip, in_range("--flip", *options.flip, 0, 1, "from 0 to 1"), options.mean};
  if (options.psnr)
    return {GoalKind::Psnr,
            in_range("--psnr", *options.psnr, kSmallest, kMostPsnr, "above 0 and at most 120 dB"),
            options.mean};
  return {GoalKind::BudgetMs,
          in_range("--budget-ms", *options.budget_ms, kSmallest, kLargest, "above 0 and at most 1e6 ms"),
          options.mean};
}

bool draws_on_thresholds(Policy policy) {
  return policy == Policy::Threshold || policy == Policy::Lookahead || policy == Policy::Oracle;
}

/// The sequence's own policy where that draws on thresholds, or the one that was asked for, which must.
ResolvedRun resolved_for_tuning(CommandLine line, const Sequence& sequence) {
  if (line.policy.empty() && !draws_on_thresholds(sequence.regulator.policy)) line.policy = "threshold";
  ResolvedRun run = resolve(line, sequence, true);
  if (!draws_on_thresholds(run.settings.regulator.policy))
    throw InputError("--policy is '" + line.policy + "', must be threshold, lookahead or oracle");
  return run;
}

/// Why nothing is fast enough, if the first frame alone is the reason.
void say_first_frame(const TuneReport& report) {
  if (report.goal.is_of_pictures() || report.goal.of_mean || report.range.first > 0) return;
  std::fprintf(stderr,
               "note: frame 0 draws every layer in view for the first time; --frames 1-%d leaves it out\n",
               report.range.last);
}

int exit_code_of(const TuneReport& report) {
  if (report.is_stopped) {
    std::fprintf(stderr, "error: stopped; the tables hold what was found so far\n");
    return kPartialResult;
  }
  if (report.common && report.common->holds) return kSuccess;
  std::fprintf(stderr, "error: %s: no threshold holds it, the nearest one is printed\n",
               report.goal.in_words().c_str());
  say_first_frame(report);
  return kFailed;
}

}  // namespace

void add_tune_options(CLI::App& command, TuneOptions& options) {
  CommandLine& line = options.line;
  add_sequence_option(command, line);
  OptionGroup(command, "Goal, one of")
      .option("--flip", options.flip, "FLIP against reference at most this, 0 to 1")
      .option("--psnr", options.psnr, "PSNR against reference at least this, dB")
      .option("--budget-ms", options.budget_ms,
              "modelled drawing time of a frame on talisman-1996 at most this")
      .flag("--mean", options.mean, "the goal is that of the mean of all frames, not of the worst one");
  add_run_group(command, line, "out/NAME-tune")
      .option("--policy", line.policy, "threshold, lookahead or oracle", "the sequence's, else threshold");
  add_content_options(command, line.content);
}

int run_tune(const TuneOptions& options, const std::atomic<bool>& stop, std::ostream& out) {
  heeds_stop = true;
  using oneapi::tbb::global_control;
  const TuneGoal goal = goal_of(options);
  choice("--progress", options.line.progress, kProgressWords);
  const Sequence sequence = load_with_warnings(options.line);
  const ResolvedRun run = resolved_for_tuning(options.line, sequence);
  std::optional<global_control> threads;
  if (options.line.threads > 0)
    threads.emplace(global_control::max_allowed_parallelism, options.line.threads);
  const std::string folder = options.line.out.empty() ? "out/" + sequence.name + "-tune" : options.line.out;
  constexpr const char* kMark = "tune.json";
  require_plotter();
  begin_report_folder(folder, kMark, "a search for thresholds");
  const TuneReport report = tune(sequence, run.settings, {run.options.first_frame, run.options.last_frame},
                                 goal, folder, run.options.progress, stop);
  publish(report, folder, out);
  finish_report_folder(folder, kMark);
  out << "\nresults in " << folder << "\n";
  return exit_code_of(report);
}

}  // namespace talisman::sequences
