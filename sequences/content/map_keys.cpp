// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/map_keys.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "sequences/content/nearest_word.h"

namespace talisman::sequences {

namespace {

using Parts = std::vector<const MapKeys*>;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// `keys` are those beside the branch. Refuses a word that the key cannot have.
bool holds(const Condition& when, const MapKeys& keys, const YamlMap& map) {
  if (!when.without.empty()) return !map.find(when.without);
  if (when.key.empty())
    return std::any_of(when.any_of.begin(), when.any_of.end(), [&](const auto& k) { return map.find(k); });
  const KeyRow& row = *keys.find(when.key);
  const YamlValue* value = map.find(when.key);
  return contains(when.words, value ? row.type.words[value->choice(row.type.words)] : row.standard);
}

void add_parts(const MapKeys& keys, const YamlMap& map, Parts& parts) {
  parts.push_back(&keys);
  for (const Branch& branch : keys.branches)
    if (holds(branch.when, keys, map)) add_parts(branch.keys, map, parts);
}

/// Where a key belongs that is not known as things are: "; inner_deg goes with kind spot".
std::string place_of(const std::string& key, const MapKeys& keys) {
  std::vector<std::string> conditions;
  for (const Branch& branch : keys.branches)
    if (branch.keys.find(key)) conditions.push_back(branch.when.in_words());
  return conditions.empty() ? "" : "; " + key + " goes " + listed(conditions);
}

void refuse_unknown(const YamlMap& map, const MapKeys& keys, const Parts& parts) {
  std::set<std::string> known;
  for (const MapKeys* part : parts)
    for (const KeyRow& row : part->rows) known.insert(row.key);
  const bool is_complete = std::all_of(keys.rows.begin(), keys.rows.end(), [&](const KeyRow& row) {
    return !row.is_required || map.find(row.key);
  });
  for (const auto& [key, value] : map.values()) {
    if (known.count(key)) continue;
    const std::string place = place_of(key, keys);
    // As long as something is missing that says which keys belong here, that is what is said.
    if (!place.empty() && !is_complete) continue;
    const std::vector<std::string> words(known.begin(), known.end());
    value.fail("key '" + key + "' is not known here; keys are " + joined(words) +
               (place.empty() ? did_you_mean(key, words) : place));
  }
}

void refuse_missing(const YamlMap& map, const Parts& parts) {
  for (const MapKeys* part : parts)
    for (const KeyRow& row : part->rows)
      if (row.is_required && !map.find(row.key)) map.self().fail("has the key '" + row.key + "'");
}

void check_company(const KeyRow& row, const YamlValue& value, const YamlMap& map) {
  for (const std::string& other : row.not_with)
    if (map.find(other)) value.fail("not together with " + other);
  if (!row.only_with.empty() && !map.find(row.only_with)) value.fail("only together with " + row.only_with);
}

void check_group(const KeyGroup& group, const YamlMap& map) {
  std::vector<const YamlValue*> found;
  for (const std::string& key : group.keys)
    if (const YamlValue* value = map.find(key)) found.push_back(value);
  if (group.exactly_one && found.size() > 1)
    found[1]->fail("one of " + listed(group.keys, "and") + ", not two");
  if (!found.empty()) return;
  if (group.exactly_one) map.self().fail("has one of the keys " + listed(group.keys, "and"));
  std::vector<std::string> quoted;
  for (const std::string& key : group.keys) quoted.push_back("'" + key + "'");
  map.self().fail(group.why + (group.why.empty() ? "" : ": ") + "has the key " + listed(quoted));
}

bool names_word(const std::string& text, const std::string& word) {
  const auto is_part = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_');
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if ((at == 0 || !is_part(at - 1)) && !is_part(at + word.size())) return true;
  return false;
}

/// With the values of the keys that the rule names: "has near_m '5' and far_m '2'".
[[noreturn]] void refuse_by(const KeyRule& rule, const MapKeys& keys, const YamlMap& map) {
  std::vector<std::string> values;
  for (const KeyRow& row : keys.rows) {
    if (!names_word(rule.words, row.key)) continue;
    const YamlValue* value = map.find(row.key);
    if (value || !row.standard.empty())
      values.push_back(row.key + " " + (value ? value->written() : "'" + row.standard + "' (by default)"));
  }
  if (values.empty()) map.self().fail(rule.words);
  map.self().fail_as("has " + listed(values, "and"), rule.words);
}

void find_tables(const MapKeys& keys, Parts& found);

void find_tables(const ValueType& type, Parts& found) {
  if (type.map && std::find(found.begin(), found.end(), type.map) == found.end()) {
    found.push_back(type.map);
    find_tables(*type.map, found);
  }
  for (const ValueType& of : type.of) find_tables(of, found);
}

void find_tables(const MapKeys& keys, Parts& found) {
  for (const KeyRow& row : keys.rows) {
    if (row.from) find_tables(map_type(*row.from), found);
    find_tables(row.type, found);
  }
  for (const Branch& branch : keys.branches) find_tables(branch.keys, found);
}

}  // namespace

Condition is(std::string key, std::vector<std::string> words) {
  return {.key = std::move(key), .words = std::move(words)};
}
Condition has(std::vector<std::string> any_of) { return {.any_of = std::move(any_of)}; }
Condition lacks(std::string key) { return {.without = std::move(key)}; }

std::string Condition::in_words() const {
  if (!without.empty()) return "without " + without;
  return key.empty() ? "with " + listed(any_of) : "with " + key + " " + listed(words);
}

const KeyRow* MapKeys::find(const std::string& key) const {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const KeyRow& r) { return r.key == key; });
  return row == rows.end() ? nullptr : &*row;
}

void MapKeys::read(const YamlMap& map, void* into) const {
  Parts parts;
  add_parts(*this, map, parts);
  refuse_unknown(map, *this, parts);
  refuse_missing(map, parts);
  for (const MapKeys* part : parts) {
    for (const auto& begin : part->begins) begin(into);
    for (const auto& place : part->places) place(into, map.self());
  }
  for (const MapKeys* part : parts)
    for (const KeyRow& row : part->rows)
      if (const YamlValue* value = map.find(row.key)) {
        check_company(row, *value, map);
        row.read(*value, into);
      }
  for (const MapKeys* part : parts) {
    for (const KeyGroup& group : part->groups) check_group(group, map);
    for (const KeyRule& rule : part->rules)
      if (!rule.holds(into)) refuse_by(rule, *part, map);
    for (const auto& end : part->ends) end(into);
  }
}

std::vector<const MapKeys*> tables_below(const MapKeys& root) {
  Parts found{&root};
  find_tables(root, found);
  return found;
}

}  // namespace talisman::sequences
