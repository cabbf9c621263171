// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/csv_export.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "sequences/files/atomic_file.h"
#include "sequences/results/column_tables.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The columns of one table, and where their values are in JSON.
class FlatTable {
 public:
  explicit FlatTable(std::vector<ColumnInfo> columns) : columns_(std::move(columns)) {
    for (const ColumnInfo& column : columns_) places_.emplace_back("/" + column.path);
  }

  std::string header() const {
    std::string line;
    for (const ColumnInfo& column : columns_) line += (line.empty() ? "" : ",") + csv_field(column.name);
    return line + "\r\n";
  }

  std::string row(const Json& json) const {
    std::string line;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (k > 0) line += ',';
      if (!json.contains(places_[k])) continue;
      const Json& value = json.at(places_[k]);
      if (value.is_string())
        line += csv_field(value.get_ref<const std::string&>());
      else if (!value.is_null())
        line += value.dump();
    }
    return line + "\r\n";
  }

 private:
  std::vector<ColumnInfo> columns_;
  std::vector<Json::json_pointer> places_;
};

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
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError("holds no results (no summary.json), must be the folder of a render or a plan", folder);
  Json summary = Json::parse(std::string(std::istreambuf_iterator<char>(stream), {}), nullptr, false);
  if (!summary.is_object() || summary.value("schema", "") != run_table().schema)
    throw InputError("is not a summary of ours, must be of schema " + run_table().schema, file);
  if (!summary.contains("layers") || !summary["layers"].is_array() || !summary.contains("effects") ||
      !summary["effects"].is_object() || !summary.contains("frames") ||
      !summary["frames"].is_number_integer())
    throw InputError("lacks frames, layers or effects, must be as the run wrote it", file);
  return summary;
}

/// A table whose rows are the lines of a file that are of `schema`; lines of `others` are passed over. Returns the
/// number of rows.
std::int64_t export_lines(const std::string& source, const std::string& target, const FlatTable& table,
                          const std::string& schema, const std::vector<std::string>& others) {
  std::ifstream lines(source, std::ios::binary);
  if (!lines) throw InputError("cannot be read, must be there as the run wrote it", source);
  std::int64_t rows = 0;
  write_atomically(target, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << table.header();
    int number = 0;
    for (std::string text; std::getline(lines, text);) {
      const Json json = Json::parse(text, nullptr, false);
      ++number;
      const std::string found = json.is_object() ? json.value("schema", "") : "";
      if (std::find(others.begin(), others.end(), found) != others.end()) continue;
      if (found != schema)
        throw InputError("is no line of ours, must be of schema " + schema, source, number);
      out << table.row(json);
      ++rows;
    }
    if (!out.flush()) throw OutputError(target + ": cannot be written");
  });
  return rows;
}

void write_table(const std::string& target, const FlatTable& table, const std::vector<Json>& rows) {
  std::string text = table.header();
  for (const Json& row : rows) text += table.row(row);
  write_text_atomically(target, text);
}

/// Effects are members of an object: their name becomes a column like the others.
std::vector<Json> effect_rows(const Json& summary) {
  std::vector<Json> rows;
  for (const auto& [name, effect] : summary["effects"].items()) {
    rows.push_back(effect);
    rows.back()["effect"] = name;
  }
  return rows;
}

std::vector<ColumnInfo> named_effect_columns() {
  std::vector<ColumnInfo> columns = flat_columns(effect_table());
  columns.insert(columns.begin(), {"effect", "effect", "", "name of the effect"});
  return columns;
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> export_csv(const std::string& folder) {
  const Json summary = read_summary(folder);
  const std::string frames_file = in(folder, "frames.jsonl");
  export_lines(in(folder, "decisions.jsonl"), in(folder, "decisions.csv"),
               FlatTable(flat_columns(decision_table())), decision_table().schema, {});
  const std::int64_t frames = export_lines(frames_file, in(folder, "frames.csv"),
                                           FlatTable(flat_columns(frame_table())), frame_table().schema, {});
  if (frames != summary["frames"].get<std::int64_t>())
    throw InputError("has " + std::to_string(frames) + " frames, must be those of summary.json, " +
                         summary["frames"].dump(),
                     frames_file);
  export_lines(in(folder, "timing.jsonl"), in(folder, "timing.csv"), FlatTable(flat_columns(timing_table())),
               timing_table().schema, {"talisman.process/1", "talisman.timing_total/1"});
  write_table(in(folder, "layers.csv"), FlatTable(flat_columns(layer_table())),
              {summary["layers"].begin(), summary["layers"].end()});
  write_table(in(folder, "effects.csv"), FlatTable(named_effect_columns()), effect_rows(summary));
  write_table(in(folder, "run.csv"), FlatTable(flat_columns(run_table())), {summary});
  return {"decisions.csv", "frames.csv", "timing.csv", "layers.csv", "effects.csv", "run.csv"};
}

}  // namespace talisman::sequences
