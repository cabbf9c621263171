// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/advice.h"

#include <algorithm>

#include "sequences/files/number_text.h"
#include "sequences/files/quoted.h"

namespace talisman::sequences {

namespace {

using regulator::Policy;

bool saves_enough(const Summary& run) {
  const auto polygons = run.total([](const FrameLine& line) { return line.polygons.reference; });
  const auto pixels = run.total([](const FrameLine& line) { return line.pixels.reference; });
  return static_cast<double>(run.polygons_rendered()) < kSavesLittle * static_cast<double>(polygons) ||
         static_cast<double>(run.pixels_rendered()) < kSavesLittle * static_cast<double>(pixels);
}

int renders_of(const Summary& run, const std::string& layer) {
  for (const LayerSummary& row : run.layers)
    if (row.name == layer) return row.renders + row.merged_renders;
  return 0;
}

int all_renders(const Summary& run) {
  int sum = 0;
  for (const LayerSummary& row : run.layers) sum += row.renders;
  return sum;
}

/// The dearest layer that is mostly drawn because it would be too far off.
const LayerSummary* dearest_for_geometry(const Summary& run) {
  const LayerSummary* dearest = nullptr;
  for (const LayerSummary& row : run.layers) {
    const ReasonKind* why = row.reasons.most_frequent();
    if (row.is_aggregate || !why || why->words != "geometric" || row.renders < 2) continue;
    if (!dearest || row.render_ms > dearest->render_ms) dearest = &row;
  }
  return dearest;
}

std::string at_another_threshold(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                                 const Summary& run) {
  const LayerSummary* layer = dearest_for_geometry(run);
  const double now_px = settings.regulator.thresholds.geometric_px;
  if (!layer || !(now_px > 0)) return {};
  const int now = renders_of(run, layer->name);
  for (const int times : {2, 3, 4, 6, 8}) {
    Settings other = settings;
    other.regulator.thresholds.geometric_px = times * now_px;
    const int then = renders_of(planned(sequence, other, range), layer->name);
    if (2 * then <= now)
      return formatted("at %g px %s would be drawn in %d of %d frames, now in %d", times * now_px,
                       quoted({layer->name}).c_str(), then, run.frame_count(), now);
  }
  return {};
}

std::string without_merging(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                            const Summary& run) {
  const LayerSummary* merged = nullptr;
  std::vector<std::string> names;
  for (const LayerSummary& row : run.layers) {
    if (row.is_aggregate && row.frames_shown > 0 && (!merged || row.frames_shown > merged->frames_shown))
      merged = &row;
    if (row.merged_renders > 0) names.push_back(row.name);
  }
  if (!merged || settings.cycles != Cycles::Merge) return {};
  Settings apart = settings;
  apart.cycles = Cycles::Keep;
  const int then = all_renders(planned(sequence, apart, range)), now = all_renders(run);
  if (then >= now) return {};
  return formatted(
      "%s were merged, a set of them in %d frames; order: could keep them apart, for %d renders instead of "
      "%d",
      quoted(names).c_str(), merged->frames_shown, then, now);
}

std::string with_lookahead(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                           const Summary& run) {
  if (settings.regulator.policy != Policy::Threshold) return {};
  Settings ahead = settings;
  ahead.regulator.policy = Policy::Lookahead;
  const int then = all_renders(planned(sequence, ahead, range)), now = all_renders(run);
  constexpr double kWorthIt = 0.9;
  if (!(then < kWorthIt * now)) return {};
  return formatted("with --policy lookahead there would be %d renders instead of %d", then, now);
}

}  // namespace

std::vector<std::string> advice_for(const Sequence& sequence, const Settings& settings,
                                    const FrameRange& range, const Summary& run) {
  const Policy policy = settings.regulator.policy;
  if ((policy != Policy::Threshold && policy != Policy::Lookahead) || run.frame_count() == 0 ||
      saves_enough(run) || run.layers.size() * static_cast<std::size_t>(range.last + 1) > kMostPlanned)
    return {};
  std::vector<std::string> lines;
  for (const auto& look : {at_another_threshold, without_merging, with_lookahead})
    if (std::string line = look(sequence, settings, range, run); !line.empty())
      lines.push_back(std::move(line));
  return lines;
}

}  // namespace talisman::sequences
