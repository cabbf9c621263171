// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/render.h"
#include "sequences/commands/stop.h"

#include <cstdio>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "sequences/commands/fan_out/shard_command.h"
#include "sequences/files/errors.h"
#include "sequences/files/quoted.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/results/advice.h"
#include "sequences/results/report/report.h"
#include "sequences/results/report/what_if.h"

namespace talisman::sequences {

namespace {

/// Sprites that had to stay smaller than the display shows them.
void say_capped_sprites(const Summary& summary, int max_sprite_px) {
  std::vector<std::string> names;
  for (const LayerSummary& layer : summary.layers)
    if (layer.is_capped) names.push_back(layer.name);
  if (names.empty()) return;
  const bool is_one = names.size() == 1;
  std::fprintf(
      stderr,
      "warning: %s %s: %s would have more than %d texels on a side, and %s fewer than was asked for; "
      "the key max_sprite_px of placement is the limit\n",
      is_one ? "layer" : "layers", quoted(names).c_str(), is_one ? "its sprite" : "their sprites",
      max_sprite_px, is_one ? "has" : "have");
}

/// Pixels at edges of which a join knows one depth: policy predictive with more than one sample for each.
void say_edges(const Summary& summary, int samples) {
  const double shown =
                   static_cast<double>(summary.display_px.x) * summary.display_px.y * summary.frame_count(),
               edges = static_cast<double>(summary.sums().edge_pixels());
  if (!(edges > 0)) return;
  std::fprintf(
      stderr,
      "warning: %.2f %% of the pixels shown are covered in part, and may be too dark where one buffer lies "
      "over another: a join by depth knows one depth of each; --samples is %d, with 1 nothing is lost\n",
      100 * edges / shown, samples);
}

void say(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

/// The camera looks elsewhere, or the scene is where nobody looks for it.
std::vector<std::string> what_is_not_seen(const Summary& summary, const std::string& file) {
  for (const LayerSummary& layer : summary.layers)
    if (layer.frames_shown > 0) return {};
  return {file + ": no layer is in view in any frame"};
}

/// Only a render goes on where it was stopped: `plan` and `audit` have no --resume.
const char* continuation(const RunOptions& options) {
  const bool resumes = !options.plan_only && options.audit_every == 0;
  return resumes ? "; the same command with --resume continues" : "; the same command begins anew";
}

std::string advice_text(const Sequence& sequence, const ResolvedRun& run, const Summary& summary) {
  std::string text;
  const FrameRange range{run.options.first_frame, run.options.last_frame};
  for (const std::string& line : advice_for(sequence, run.settings, range, summary))
    text += (text.empty() ? "  it saves little   " : "                    ") + line + "\n";
  return text.empty() ? text : "\n" + text;
}

bool makes_report(const CommandLine& line) { return !line.no_report && has_report(); }

/// The report, also of a run that was stopped; none in a build that has none.
void write_page(const Sequence& sequence, const ResolvedRun& run, const RunOutcome& outcome,
                const CommandLine& line) {
  const RunOptions& options = run.options;
  if (!makes_report(line) || options.decisions != DecisionLines::All) return;
  if (outcome.complete && !options.plan_only && !line.audit_alone && has_threshold(run.settings))
    write_what_if(sequence, run.settings, {options.first_frame, options.last_frame}, outcome.summary,
                  options.out);
  write_report({options.out}, {}, !line.no_thumbnails);
}

void require_video(const RunOutcome& outcome) {
  if (!outcome.without_video.empty())
    throw PartialResult(outcome.without_video +
                        "; all frames and results are there, the same command with --resume makes the video");
}

}  // namespace

int run_sequence(const CommandLine& line, bool plan_only, const std::atomic<bool>& stop, std::ostream& out) {
  heeds_stop = true;
  using oneapi::tbb::global_control;
  require_threads(line.threads);
  require_shard_options(line, plan_only);
  std::optional<global_control> threads;
  if (line.threads > 0) threads.emplace(global_control::max_allowed_parallelism, line.threads);
  if (!line.shard.empty()) return run_shard(line, plan_only, stop, out);
  const Sequence sequence = load_with_warnings(line);
  ResolvedRun resolved = resolve(line, sequence, plan_only);
  resolved.options.changes = makes_report(line) && resolved.options.decisions == DecisionLines::All;
  const RunOutcome outcome = run(sequence, resolved.settings, resolved.options, stop);
  write_page(sequence, resolved, outcome, line);
  say_capped_sprites(outcome.summary, resolved.settings.placement.max_sprite_px);
  say_edges(outcome.summary, resolved.settings.render.samples);
  if (!outcome.complete) {
    std::fprintf(stderr, "error: stopped after %d frames%s\n", outcome.summary.frame_count(),
                 continuation(resolved.options));
    return kPartialResult;
  }
  const std::vector<std::string> unseen = what_is_not_seen(outcome.summary, sequence.file);
  say(unseen);
  require_none(unseen, line.content.strict, sequence.file);
  if (line.quiet) require_video(outcome);
  if (line.quiet) return kSuccess;
  if (outcome.frames_kept > 0)
    out << "kept " << outcome.frames_kept << " complete frames of an earlier run\n";
  out << table_of(outcome.summary) << advice_text(sequence, resolved, outcome.summary) << "\nresults in "
      << resolved.options.out << "\n";
  require_video(outcome);
  return kSuccess;
}

}  // namespace talisman::sequences
