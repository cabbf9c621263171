// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/exports/finished_tables.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "sequences/files/file_text.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/json_text.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = ExportedRow;
using Show = std::function<void(const Json&)>;

std::string in(const std::string& folder, const char* name) { return folder + "/" + name; }

/// The run as a whole. Throws InputError if the folder holds none, or one that is not complete.
Json read_summary(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError("is no folder, must be that of a render or a plan", folder);
  for (const char* name : {"decisions.jsonl.partial", "frames.jsonl.partial", "timing.jsonl.partial"})
    if (fs::exists(in(folder, name), error))
      throw InputError(std::string("holds a run that is not complete (") + name +
                           "), the same command with --resume continues it",
                       folder);
  const std::string file = in(folder, "summary.json");
  const std::optional<std::string> text = text_of_file(file);
  if (!text)
    throw InputError("holds no results (no summary.json), must be the folder of a render or a plan", folder);
  Json summary = Json::parse(*text, nullptr, false);
  if (!summary.is_object() || text_in(summary, "schema") != run_table().schema)
    throw InputError("is not a summary of ours, must be of schema " + run_table().schema, file);
  if (!summary.contains("layers") || !summary["layers"].is_array() || !summary.contains("effects") ||
      !summary["effects"].is_object() || !summary.contains("frames") ||
      !summary["frames"].is_number_integer())
    throw InputError("lacks frames, layers or effects, must be as the run wrote it", file);
  return summary;
}

/// Shows the lines of a file that are of `schema`; lines of `others` are passed over. Returns how many those are.
std::int64_t read_lines(const std::string& file, const std::string& schema,
                        const std::vector<std::string>& others, const Show& show) {
  std::ifstream lines(file, std::ios::binary);
  if (!lines) throw InputError("cannot be read, must be there as the run wrote it", file);
  std::int64_t rows = 0;
  int number = 0;
  for (std::string text; std::getline(lines, text);) {
    const Json json = Json::parse(text, nullptr, false);
    ++number;
    const std::string found = text_in(json, "schema");
    if (std::find(others.begin(), others.end(), found) != others.end()) continue;
    if (found != schema) throw InputError("is no line of ours, must be of schema " + schema, file, number);
    show(json);
    ++rows;
  }
  return rows;
}

/// Every frame of the summary must have its line.
void read_frames(const std::string& file, std::int64_t frames, const Show& show) {
  const std::int64_t rows = read_lines(file, frame_table().schema, {}, show);
  if (rows != frames)
    throw InputError(
        "has " + std::to_string(rows) + " frames, must be those of summary.json, " + std::to_string(frames),
        file);
}

std::vector<ColumnInfo> named_effect_columns() {
  std::vector<ColumnInfo> columns = flat_columns(effect_table());
  columns.insert(columns.begin(), {"effect", "effect", "", "name of the effect"});
  return columns;
}

/// Effects are members of an object: their name becomes a column like the others.
void read_effects(const Json& summary, const Show& show) {
  for (const auto& [name, effect] : summary["effects"].items()) {
    Json row = effect;
    row["effect"] = name;
    show(row);
  }
}

}  // namespace

std::vector<FinishedTable> finished_tables(const std::string& folder, bool with_timing) {
  const auto summary = std::make_shared<const Json>(read_summary(folder));
  std::vector<FinishedTable> tables;
  const Json run = Json::parse(text_of_file(in(folder, "run.json")).value_or(""), nullptr, false);
  if (!run.is_object() || decisions_kept(run) != "none")
    tables.push_back({"decisions", flat_columns(decision_table()), [folder](const Show& show) {
                        read_lines(in(folder, "decisions.jsonl"), decision_table().schema, {}, show);
                      }});
  tables.push_back({"frames", flat_columns(frame_table()), [folder, summary](const Show& show) {
                      read_frames(in(folder, "frames.jsonl"), (*summary)["frames"].get<std::int64_t>(), show);
                    }});
  if (with_timing)
    tables.push_back({"timing", flat_columns(timing_table()), [folder](const Show& show) {
                        read_lines(in(folder, "timing.jsonl"), timing_table().schema,
                                   {"talisman.process/1", "talisman.timing_total/1"}, show);
                      }});
  tables.push_back({"layers", flat_columns(layer_table()), [summary](const Show& show) {
                      for (const Json& layer : (*summary)["layers"]) show(layer);
                    }});
  tables.push_back(
      {"effects", named_effect_columns(), [summary](const Show& show) { read_effects(*summary, show); }});
  tables.push_back({"run", flat_columns(run_table()), [summary](const Show& show) { show(*summary); }});
  return tables;
}

RowPlaces::RowPlaces(const std::vector<ColumnInfo>& columns) {
  for (const ColumnInfo& column : columns) places_.emplace_back("/" + column.path);
}

const ExportedRow* RowPlaces::at(const ExportedRow& row, std::size_t k) const {
  if (!row.contains(places_[k])) return nullptr;
  const ExportedRow& value = row.at(places_[k]);
  return value.is_null() ? nullptr : &value;
}

}  // namespace talisman::sequences
