// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/exports/csv_export.h"

#include <fstream>

#include "sequences/files/atomic_file.h"
#include "sequences/results/exports/finished_tables.h"

namespace talisman::sequences {

namespace {

std::string csv_header(const std::vector<ColumnInfo>& columns) {
  std::string line;
  for (const ColumnInfo& column : columns) line += (line.empty() ? "" : ",") + csv_field(column.name);
  return line + "\r\n";
}

std::string csv_line(const RowPlaces& places, const ExportedRow& row) {
  std::string line;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (k > 0) line += ',';
    const ExportedRow* value = places.at(row, k);
    if (!value) continue;
    line += value->is_string() ? csv_field(value->get_ref<const std::string&>()) : value->dump();
  }
  return line + "\r\n";
}

void write_csv(const FinishedTable& table, const std::string& target) {
  write_atomically(target, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << csv_header(table.columns);
    const RowPlaces places(table.columns);
    table.read([&](const ExportedRow& row) { out << csv_line(places, row); });
    if (!out.flush()) throw OutputError(target + ": cannot be written");
  });
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> export_csv(const std::string& folder, bool with_timing) {
  std::vector<std::string> names;
  for (const FinishedTable& table : finished_tables(folder, with_timing)) {
    names.push_back(table.name + ".csv");
    write_csv(table, folder + "/" + names.back());
  }
  return names;
}

}  // namespace talisman::sequences
