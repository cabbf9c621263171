// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/render.h"

#include <cstdio>
#include <optional>
#include <ostream>

#include <oneapi/tbb/global_control.h>

#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

/// Sprites that had to stay smaller than the display shows them.
void say_capped_sprites(const Summary& summary, int max_sprite_px) {
  for (const LayerSummary& layer : summary.layers)
    if (layer.is_capped)
      std::fprintf(
          stderr,
          "warning: layer '%s': its sprite would have more than %d texels on a side, and has fewer than "
          "was asked for; the key max_sprite_px of placement is the limit\n",
          layer.name.c_str(), max_sprite_px);
}

}  // namespace

int run_sequence(const CommandLine& line, bool plan_only, const std::atomic<bool>& stop, std::ostream& out) {
  using oneapi::tbb::global_control;
  const Sequence sequence = load_with_warnings(line.sequence, line.content);
  const ResolvedRun resolved = resolve(line, sequence, plan_only);
  std::optional<global_control> threads;
  if (line.threads > 0) threads.emplace(global_control::max_allowed_parallelism, line.threads);
  const RunOutcome outcome = run(sequence, resolved.settings, resolved.options, stop);
  say_capped_sprites(outcome.summary, resolved.settings.placement.max_sprite_px);
  if (!outcome.complete) {
    std::fprintf(stderr, "error: stopped after %zu frames; the same command with --resume continues\n",
                 outcome.summary.frames.size());
    return kPartialResult;
  }
  if (outcome.frames_kept > 0)
    out << "kept " << outcome.frames_kept << " complete frames of an earlier run\n";
  out << table_of(outcome.summary) << "\nresults in " << resolved.options.out << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
