// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "layers/glob.h"
#include "sequences/files/how_many.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/results/factoring/compared_factorings.h"
#include "sequences/results/factoring/plan_sums.h"

namespace talisman::sequences {

namespace {

/// The least that layers must save of what one layer for all costs to be called worth it.
constexpr double kLeastGain = 0.02;

/// Of the frames, and of the work: what is drawn so often for so much is worth being cut.
constexpr double kNearlyAlways = 0.8, kMuchWork = 0.25;

std::string sums_table(const ComparedFactoring& compared, double display_px) {
  PageTable table{{"in all"}, {}, 1};
  for (const PlannedLayers& one : compared.all) table.header.push_back(one.name);
  const auto row = [&](const std::string& name, const auto& number, int digits) {
    table.rows.push_back({name});
    for (const PlannedLayers& one : compared.all)
      table.rows.back().push_back(fixed(static_cast<double>(number(one)), digits));
  };
  row(
      "layers", [](const PlannedLayers& one) { return one.layers; }, 0);
  row(
      "renders", [](const PlannedLayers& one) { return renders_in(one.summary); }, 0);
  row(
      "polygons", [](const PlannedLayers& one) { return one.summary.polygons_rendered(); }, 0);
  row(
      "texels", [](const PlannedLayers& one) { return one.summary.pixels_rendered(); }, 0);
  row(
      "modelled ms a frame", [](const PlannedLayers& one) { return modelled_ms(one.summary); }, 3);
  row(
      "sprites over a pixel", [&](const PlannedLayers& one) { return one.shown_px / display_px; }, 2);
  return plain_text(table);
}

std::string signed_count(std::int64_t number) { return formatted("%+lld", static_cast<long long>(number)); }

std::string changes_table(const std::vector<LayerChange>& changes) {
  PageTable table{{"by itself", "renders", "polygons", "texels", "ms a frame"}, {}, 1};
  for (const LayerChange& change : changes) {
    const PlannedFactoring &a = change.before, &b = change.after;
    const double ms = (b.work_ms() - a.work_ms()) / std::max(a.frames, 1);
    table.rows.push_back({change.what, signed_count(b.renders - a.renders),
                          signed_count(b.polygons - a.polygons), signed_count(b.pixels - a.pixels),
                          formatted("%+.3f", ms)});
  }
  return plain_text(table);
}

std::string layers_table(const ComparedFactoring& compared) {
  const FactoringStudy& study = compared.study;
  PageTable table{{"proposed layer", "parts", "polygons", "renders", "merged", "ms a frame"}, {}, 1};
  for (const LayerSummary& row : compared.all[1].summary.layers) {
    if (row.is_aggregate) continue;
    const double frames = static_cast<double>(compared.all[1].summary.frames.size());
    table.rows.push_back({row.name, std::to_string(row.parts), std::to_string(row.polygons),
                          std::to_string(row.renders + row.merged_renders),
                          row.merged_renders > 0 ? std::to_string(row.merged_renders) : "",
                          fixed(row.render_ms / std::max(frames, 1.0), 3)});
  }
  std::string text;
  for (const CutEntry& cut : compared.cuts)
    text += "  part '" + layers::name_of_glob(cut.parts) + "' is cut into " + std::to_string(cut.into) +
            " first: one warp does not serve\n";
  text += plain_text(table);
  for (const std::string& line : hidden_in_words(study.chosen)) text += "  " + line + "\n";
  return text;
}

/// What no layers can help: one part that is drawn nearly always, for much of the work.
std::string to_be_cut(const ComparedFactoring& compared) {
  const Summary& summary = compared.all[1].summary;
  const int frames = static_cast<int>(summary.frames.size());
  std::string text;
  for (const LayerSummary& row : summary.layers) {
    const int renders = row.renders + row.merged_renders;
    if (row.parts != 1 || row.is_aggregate || frames < 2 || renders < kNearlyAlways * frames ||
        summary.share_of_cost(row) < kMuchWork)
      continue;
    text += "  '" + row.name + "' is one part, drawn in " + std::to_string(renders) + " of " +
            std::to_string(frames) + " frames for " + formatted("%.0f %%", 100 * summary.share_of_cost(row)) +
            " of the work: cut into more (key cuts; a terrain: segments), most of it might be kept\n";
  }
  return text;
}

const PlannedLayers* of_name(const ComparedFactoring& compared, const std::string& name) {
  for (const PlannedLayers& one : compared.all)
    if (one.name == name) return &one;
  return nullptr;
}

/// Do layers pay?
std::string verdict(const ComparedFactoring& compared) {
  const std::size_t free = compared.study.pieces.free;
  if (free == 0) return "nothing is left to factor: every part is in a layer that stays as it is";
  if (free == 1) return "one part: one layer, there is nothing to factor";
  const PlannedLayers* one = of_name(compared, "one");
  const PlannedLayers& proposed = compared.all[1];
  if (one && proposed.work_ms > (1 - kLeastGain) * one->work_ms)
    return formatted(
        "layers do not pay: one layer for all costs %.3f ms of polygons and texels a frame, these %.3f",
        one->work_ms, proposed.work_ms);
  return formatted("proposed by %s: %.3f ms of polygons and texels a frame",
                   compared.study.chosen.how.c_str(), proposed.work_ms) +
         (one ? formatted(", %.3f in one layer", one->work_ms) : "") +
         formatted(", %.3f as it is now", compared.all[0].work_ms);
}

}  // namespace

std::string factoring_text(const Sequence& sequence, const ComparedFactoring& compared) {
  const FactoringStudy& study = compared.study;
  std::string text = sequence.name + ": " + how_many(sequence.scene->parts.size(), "part") + ", " +
                     how_many(static_cast<std::size_t>(sequence.frames), "frame") +
                     formatted(" of %dx%d px, %g px of error allowed", sequence.display_px.x,
                               sequence.display_px.y, sequence.regulator.thresholds.geometric_px) +
                     (study.instants.empty()
                          ? ""
                          : "; motion and depth looked at in " + how_many(study.instants.size(), "frame")) +
                     "\n  " + verdict(compared) + "\n\n";
  text += sums_table(compared, double(sequence.display_px.x) * sequence.display_px.y) + "\n";
  text += layers_table(compared) + to_be_cut(compared);
  if (!compared.wanted.empty()) text += "\nfrom what is now to this:\n\n" + changes_table(compared.wanted);
  if (!compared.further.empty()) text += "\nwhat else might be done:\n\n" + changes_table(compared.further);
  return text;
}

}  // namespace talisman::sequences
