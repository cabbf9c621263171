// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/columns_doc.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "sequences/files/errors.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/report/changes.h"

namespace talisman::sequences {

namespace {

constexpr const char* kBegin = "<!-- columns: ";
constexpr const char* kEndOfTables = "<!-- end of columns -->";

/// "fiducials/worst_at_px/0" as users of JSON write it: `fiducials.worst_at_px[0]`.
std::string place_in_json(const std::string& path) {
  std::istringstream members(path);
  std::string place;
  for (std::string member; std::getline(members, member, '/');) {
    const bool is_index = member.find_first_not_of("0123456789") == std::string::npos;
    place += is_index ? "[" + member + "]" : (place.empty() ? "" : ".") + member;
  }
  return place;
}

template <typename Row>
std::string markdown_of(const ColumnTable<Row>& table) {
  std::string text = "| CSV | JSON | unit | meaning |\n|---|---|---|---|\n";
  for (const ColumnInfo& c : flat_columns(table))
    text += "| `" + c.name + "` | `" + place_in_json(c.path) + "` | " + c.unit + " | " + c.meaning + " |\n";
  if (table.groups.empty()) return text;
  text += "\nThere only in part:\n\n";
  for (const ColumnGroup<Row>& group : table.groups)
    text += "- `" + group.path + "`: " + group.meaning + "\n";
  return text;
}

std::map<std::string, std::string> all_tables() {
  return {{decision_table().name, markdown_of(decision_table())},
          {frame_table().name, markdown_of(frame_table())},
          {change_table().name, markdown_of(change_table())},
          {timing_table().name, markdown_of(timing_table())},
          {layer_table().name, markdown_of(layer_table())},
          {effect_table().name, markdown_of(effect_table())},
          {run_table().name, markdown_of(run_table())},
          {audit_table().name, markdown_of(audit_table())}};
}

}  // namespace

std::string with_column_tables(const std::string& markdown) {
  const std::map<std::string, std::string> tables = all_tables();
  std::istringstream lines(markdown);
  std::string text, line;
  for (int number = 1; std::getline(lines, line); ++number) {
    text += line + "\n";
    if (line.rfind(kBegin, 0) != 0) continue;
    const std::string rest = line.substr(std::string(kBegin).size());
    const std::string name = rest.substr(0, rest.find(' '));
    const auto table = tables.find(name);
    if (table == tables.end())
      throw InputError("line " + std::to_string(number) + ": no table '" + name + "'");
    const int begin = number;
    do {
      if (!std::getline(lines, line))
        throw InputError("line " + std::to_string(begin) + ": table '" + name + "' has no end");
      ++number;
    } while (line != kEndOfTables);
    text += "\n" + table->second + "\n" + line + "\n";
  }
  return text;
}

}  // namespace talisman::sequences
