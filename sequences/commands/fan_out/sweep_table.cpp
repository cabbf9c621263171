// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/fan_out/sweep_table.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <nlohmann/json.hpp>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/statistics.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/file_text.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/plot.h"
#include "sequences/results/exports/csv_export.h"
#include "sequences/results/exports/finished_tables.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/shards/merge.h"
#include "sequences/results/shards/shard.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

struct JobOutcome {
  std::string status = "done", why;
  std::map<std::string, std::string> cells;  ///< of the columns of `run`
  double mean_px = NAN, max_px = NAN, drawing_ms = NAN;
};

/// The columns of `run` that some job has, in their order.
using RunColumnNames = std::vector<std::string>;

/// Parts that were made since become a run. What cannot be merged says why.
void merge_parts(const std::string& folder) {
  std::error_code error;
  const bool has_parts = std::filesystem::is_directory(folder + "/" + kShardsFolder, error);
  if (has_parts && !std::filesystem::exists(folder + "/summary.json", error)) merge_shards(folder, false);
}

void add_errors(const Json& summary, JobOutcome& outcome) {
  double sum_px = 0, shown = 0;
  outcome.max_px = 0;
  for (const Json& layer : summary.at("layers")) {
    if (layer.value("shadow_map", false) || layer.value("mirror", false)) continue;
    const double frames = layer.at("frames_shown");
    if (frames == 0) continue;
    sum_px += frames * layer.at("mean_geometric_px").get<double>();
    shown += frames;
    outcome.max_px = std::max(outcome.max_px, layer.at("max_geometric_px").get<double>());
  }
  outcome.mean_px = shown > 0 ? sum_px / shown : 0;
  outcome.drawing_ms = summary.at("modelled_drawing_ms");
}

void read_run(const std::string& folder, JobOutcome& outcome, RunColumnNames& names) {
  for (const FinishedTable& table : finished_tables(folder, false)) {
    if (table.name != "run") continue;
    const RowPlaces places(table.columns);
    table.read([&](const ExportedRow& row) {
      for (std::size_t k = 0; k < places.size(); ++k) {
        const ExportedRow* value = places.at(row, k);
        if (!value || value->is_null()) continue;
        const std::string& name = table.columns[k].name;
        outcome.cells[name] = value->is_string() ? value->get<std::string>() : value->dump();
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    });
  }
}

JobOutcome outcome_of(const Sweep& sweep, const SweepJob& job, RunColumnNames& names) {
  JobOutcome outcome;
  const std::string folder = sweep.folder(job);
  if (const auto why = text_of_file(folder + ".failed")) {
    outcome.status = "failed", outcome.why = why->substr(0, why->find('\n'));
    return outcome;
  }
  try {
    merge_parts(folder);
    add_errors(finished_summary(folder), outcome);
    read_run(folder, outcome, names);
  } catch (const PartialResult& error) {
    outcome.status = "missing", outcome.why = error.what();
  } catch (const InputError& error) {
    outcome.status = "missing", outcome.why = error.what();
  } catch (const nlohmann::json::exception&) {
    outcome.status = "missing", outcome.why = folder + ": summary.json is not as a run writes it";
  }
  return outcome;
}

std::string number_cell(double value) { return std::isfinite(value) ? formatted("%.17g", value) : ""; }

std::string csv_of(const Sweep& sweep, const std::vector<JobOutcome>& outcomes, const RunColumnNames& names) {
  std::string csv = "job,sequence,options,status,why,mean_geometric_px,max_geometric_px";
  for (const std::string& name : names) csv += "," + (name == "sequence" ? "sequence_name" : name);
  csv += "\r\n";
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const SweepJob& job = sweep.jobs[k];
    const JobOutcome& outcome = outcomes[k];
    csv += job.name + "," + csv_field(job.sequence) + "," + csv_field(in_shell(job.own)) + "," +
           outcome.status + "," + csv_field(outcome.why) + "," + number_cell(outcome.mean_px) + "," +
           number_cell(outcome.max_px);
    for (const std::string& name : names) {
      const auto cell = outcome.cells.find(name);
      csv += "," + (cell == outcome.cells.end() ? "" : csv_field(cell->second));
    }
    csv += "\r\n";
  }
  return csv;
}

/// A series per sequence, and what is on its front.
Plot plot_of(const Sweep& sweep, const std::vector<JobOutcome>& outcomes) {
  Plot plot{"error over cost",
            {"modelled time of drawing a frame", "ms", false, true, {}},
            {"error of what is displayed", "px", false, true, {}},
            {}};
  std::vector<std::string> sequences;
  for (const SweepJob& job : sweep.jobs)
    if (std::find(sequences.begin(), sequences.end(), job.sequence) == sequences.end())
      sequences.push_back(job.sequence);
  for (const std::string& sequence : sequences) {
    PlotSeries series{sequence, {}, SeriesStyle::Points, {}};
    std::vector<double> cost, error;
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
      if (sweep.jobs[k].sequence != sequence || outcomes[k].status != "done") continue;
      cost.push_back(outcomes[k].drawing_ms), error.push_back(outcomes[k].mean_px);
      series.points.push_back({cost.back(), error.back()});
    }
    if (series.points.empty()) continue;
    PlotSeries front = front_series(cost, error, pareto_front(cost, error));
    front.name = sequence + ": best";
    plot.series.push_back(std::move(series));
    plot.series.push_back(std::move(front));
  }
  return plot;
}

}  // namespace

SweepOutcome write_sweep_table(const Sweep& sweep) {
  SweepOutcome sum;
  RunColumnNames names;
  std::vector<JobOutcome> outcomes;
  for (const SweepJob& job : sweep.jobs) {
    outcomes.push_back(outcome_of(sweep, job, names));
    const std::string& status = outcomes.back().status;
    ++(status == "done" ? sum.done : status == "failed" ? sum.failed : sum.missing);
  }
  write_text_atomically(sweep.out + "/sweep.csv", csv_of(sweep, outcomes, names));
  if (sum.done == 0) return sum;
  try {
    write_plot(sweep.out, "pareto", plot_of(sweep, outcomes));
  } catch (const OutputError& error) {
    sum.without_plot = error.what();
  }
  return sum;
}

}  // namespace talisman::sequences
