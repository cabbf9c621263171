// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/lod/measured.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

constexpr NamedValue<LodResult> kLodColumns[] = {
    {"target_ms", [](const LodResult& r) { return r.target_ms; }},
    {"modelled_min_ms", [](const LodResult& r) { return r.modelled.min; }},
    {"modelled_mean_ms", [](const LodResult& r) { return r.modelled.mean; }},
    {"modelled_max_ms", [](const LodResult& r) { return r.modelled.max; }},
    {"modelled_sigma_ms", [](const LodResult& r) { return r.modelled.sigma; }},
    {"frames_above_target", [](const LodResult& r) { return double(r.frames_above); }},
    {"frames_coarsest_exceeds", [](const LodResult& r) { return double(r.frames_unfit); }},
    {"levels_switched", [](const LodResult& r) { return double(r.switched); }},
    {"layers_skipped", [](const LodResult& r) { return double(r.skipped); }},
    {"share_of_bound", [](const LodResult& r) { return r.share_of_bound; }},
    {"renders", [](const LodResult& r) { return double(r.measured.renders); }},
    {"polygons", [](const LodResult& r) { return double(r.measured.polygons); }},
    {"largest_px", [](const LodResult& r) { return r.measured.max_geometric_px; }},
    {"psnr_db", [](const LodResult& r) { return r.measured.quality.psnr_db; }},
    {"flip", [](const LodResult& r) { return r.measured.quality.flip; }},
    {"popping_rms", [](const LodResult& r) { return r.measured.popping.rms; }},
    {"wall_plan_ms", [](const LodResult& r) { return r.measured.plan.mean; }},
    {"wall_render_ms", [](const LodResult& r) { return r.measured.render.mean; }},
};

std::string csv_of(const LodExperiment& experiment) {
  std::string csv = "selector" + csv_names(kLodColumns) + "\n";
  for (const LodResult& result : experiment.results)
    csv += quoted(result.name) + csv_cells(kLodColumns, result) + "\n";
  return csv;
}

std::string label_of(const LodResult& r) {
  return r.target_ms > 0 ? r.name + ", " + fixed(r.target_ms, 2) + " ms" : r.name;
}

Plot time_plot(const LodExperiment& experiment) {
  Plot plot{"times of frames: " + experiment.sequence,
            {"frame", "", false, true},
            {"drawing, modelled, as planned", "ms", false, true},
            {}};
  for (std::size_t i = 0; i < experiment.results.size(); ++i) {
    if (experiment.results[i].name == "none") continue;  // its times would press the others flat
    plot.series.push_back({label_of(experiment.results[i]), {}});
    for (std::size_t f = 0; f < experiment.modelled_ms[i].size(); ++f)
      plot.series.back().points.push_back(
          {double(experiment.frames.first) + double(f), experiment.modelled_ms[i][f]});
  }
  return plot;
}

PageTable lod_table(const LodExperiment& experiment) {
  PageTable table{{"selector", "target ms", "min", "mean", "max", "sigma ms", "above", "unfit", "switched",
                   "skipped", "of bound %", "largest px", "PSNR dB", "FLIP", "pop", "plan", "draw ms"},
                  {},
                  1};
  for (const LodResult& r : experiment.results)
    table.rows.push_back(
        {r.name, r.target_ms > 0 ? fixed(r.target_ms, 2) : "", fixed(r.modelled.min, 2),
         fixed(r.modelled.mean, 2), fixed(r.modelled.max, 2), fixed(r.modelled.sigma, 3),
         std::to_string(r.frames_above), std::to_string(r.frames_unfit), std::to_string(r.switched),
         std::to_string(r.skipped), fixed(100 * r.share_of_bound, 1), fixed(r.measured.max_geometric_px, 2),
         fixed(r.measured.quality.psnr_db, 1), fixed(r.measured.quality.flip, 4),
         fixed(r.measured.popping.rms, 2), fixed(r.measured.plan.mean, 2), fixed(r.measured.render.mean, 2)});
  return table;
}

/// How even the times are at the first target, and what that costs in the picture.
std::string verdict_on(const LodExperiment& experiment) {
  const LodResult *of_static = nullptr, *feedback = nullptr, *optimise = nullptr;
  for (const LodResult& r : experiment.results) {
    if (r.name == "static") of_static = &r;
    if (r.name == "feedback" && !feedback) feedback = &r;
    if (r.name == "optimise, error" && !optimise) optimise = &r;
  }
  if (!of_static || !feedback || !optimise) return {};
  return "At " + fixed(optimise->target_ms, 2) + " ms a frame, modelled: sigma " +
         fixed(of_static->modelled.sigma, 3) + " ms with static, " + fixed(feedback->modelled.sigma, 3) +
         " with feedback, " + fixed(optimise->modelled.sigma, 3) + " with optimise; FLIP " +
         fixed(of_static->measured.quality.flip, 4) + ", " + fixed(feedback->measured.quality.flip, 4) +
         ", " + fixed(optimise->measured.quality.flip, 4) + ".";
}

}  // namespace

void write_report(const LodExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/lod.csv", csv_of(experiment));
  write_plot(dir, "lod_frames", time_plot(experiment));
}

Page page_of(const LodExperiment& experiment) {
  Page page{"Levels of detail: " + experiment.sequence, {}, verdict_on(experiment), "lod.html"};
  page.blocks = {
      Paragraph{measured_on(experiment.sequence, experiment.frames, experiment.display_px) + "; up to " +
                std::to_string(experiment.levels) + " levels; one frame in " +
                std::to_string(experiment.frames.every) +
                " drawn and compared with full detail. min to sigma: modelled, as planned; above: frames "
                "above the target, unfit: of these, the coarsest pictures alone exceed it; plan, draw: this "
                "machine"},
      lod_table(experiment), Figure{"lod_frames.svg", "What each frame costs to draw, modelled."}};
  return page;
}

}  // namespace talisman::sequences
