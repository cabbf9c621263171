// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/starter/documented_keys.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "sequences/content/value_type.h"

namespace talisman::sequences {

namespace {

/// Also among the keys that belong to the map only at times.
const KeyRow* row_of(const MapKeys& keys, const std::string& key) {
  if (const KeyRow* row = keys.find(key)) return row;
  for (const Branch& branch : keys.branches)
    if (const KeyRow* row = row_of(branch.keys, key)) return row;
  return nullptr;
}

const KeyRow& known_row(const MapKeys& keys, const std::string& key) {
  const KeyRow* row = row_of(keys, key);
  if (!row) throw std::logic_error("no key '" + key + "' in the table of " + keys.name);
  return *row;
}

const MapKeys* map_in(const ValueType& type) {
  if (type.map) return type.map;
  for (const ValueType& of : type.of)
    if (const MapKeys* map = map_in(of)) return map;
  return nullptr;
}

/// Of code, in Markdown.
std::string without_marks(std::string text) {
  std::erase(text, '`');
  return text;
}

std::string meaning_of(const KeyRow& row) {
  std::string text = row.unit.empty() || row.unit == "1" ? row.meaning : row.unit + ": " + row.meaning;
  if (row.type.kind == ValueType::Kind::Choice) text += "; one of " + joined(row.type.words);
  return without_marks(text);
}

}  // namespace

const MapKeys& keys_below(const MapKeys& keys, const std::string& key) {
  const MapKeys* map = map_in(known_row(keys, key).type);
  if (!map) throw std::logic_error("no map behind '" + key + "'");
  return *map;
}

std::string written(const layers::dvec3& v) { return yaml_list({shown(v.x), shown(v.y), shown(v.z)}); }

std::string DocumentedKeys::meaning(const MapKeys& keys, const std::string& key) {
  return meaning_of(known_row(keys, key));
}

void DocumentedKeys::put(const std::string& prefix, const MapKeys& keys, const std::string& key,
                         const std::string& value) {
  page_.key(prefix, key, value, meaning(keys, key));
}

void DocumentedKeys::standard(const std::string& prefix, const MapKeys& keys, const std::string& key) {
  put(prefix, keys, key, known_row(keys, key).standard);
}

void DocumentedKeys::off(const std::string& indent, const MapKeys& keys, const std::string& key,
                         const std::string& example) {
  const KeyRow& row = known_row(keys, key);
  const std::string otherwise = without_marks(row.standard_in_words);
  const bool is_value =
      !otherwise.empty() && std::string_view("[0123456789").find(otherwise[0]) != std::string_view::npos;
  const std::string value = !example.empty() ? example : is_value ? otherwise : row.standard;
  const bool says_it = !value.empty() || otherwise.empty();
  page_.key(indent + "# ", key, value, meaning_of(row) + (says_it ? "" : "; without it: " + otherwise));
}

void DocumentedKeys::standards(const std::string& indent, const MapKeys& keys) {
  for (const KeyRow& row : keys.rows)
    if (row.standard.empty())
      off(indent, keys, row.key);
    else
      standard(indent, keys, row.key);
}

}  // namespace talisman::sequences
