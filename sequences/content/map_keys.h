// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The keys of one kind of map in a sequence file, as data: what each is called, what may stand behind it, in
/// which unit, what holds without it, and what it means. One description serves the reader and its messages
/// (`MapKeys::read`), the tables of docs/sequence-format.md (key_docs.h) and the JSON Schema (key_schema.h).
///
/// It is filled by `Table<T>` (key_table.h), which knows the type that the map is read into; here that type is
/// forgotten, and `into` points to it.

#include <functional>
#include <string>
#include <vector>

#include "sequences/content/value_type.h"
#include "sequences/content/yaml_reader.h"

namespace talisman::sequences {

struct KeyRow {
  std::string key;
  ValueType type;
  std::string unit;               ///< "m", "°", "px"; empty: none
  std::string meaning;            ///< half a sentence, in Markdown
  std::string standard;           ///< what holds without the key, as it would be written; empty: see the next
  std::string standard_in_words;  ///< where no value of the key says it; empty: nothing
  bool is_required = false;
  std::string only_with;              ///< another key, without which this one has no meaning
  std::vector<std::string> not_with;  ///< keys that exclude this one
  const MapKeys* from = nullptr;      ///< the table that the row was taken over from; nullptr: its own
  std::function<void(const YamlValue& value, void* into)> read{};
};

/// When the keys of a branch belong to the map.
struct Condition {
  std::string key{};  ///< its value is one of `words` (also by default) …
  std::vector<std::string> words{};
  std::vector<std::string> any_of{};  ///< … or one of these keys is there …
  std::string without{};              ///< … or this one is not
  std::string in_words() const;       ///< "kind spot", "with box or plane", "without instances"
};

Condition is(std::string key, std::vector<std::string> words);
Condition has(std::vector<std::string> any_of);
Condition lacks(std::string key);

/// At least one, or exactly one, of these keys.
struct KeyGroup {
  std::vector<std::string> keys;
  bool exactly_one = false;
  std::string why{};  ///< before the rule: "shows nothing"
};

/// A rule over several keys that no schema can say.
struct KeyRule {
  std::string words;  ///< "near_m below far_m"
  std::function<bool(const void* read)> holds{};
};

struct Branch;

class MapKeys {
 public:
  std::string name;  ///< "camera": the heading in the document, the definition in the schema
  std::vector<KeyRow> rows;
  std::vector<Branch> branches;  ///< keys that belong to the map only at times
  std::vector<KeyGroup> groups;
  std::vector<KeyRule> rules;
  std::string base_key;  ///< `extends`: where it is written, another file may say what is required here
  std::vector<std::function<void(void*into)>> begins, ends;  ///< before and after all reading
  std::vector<std::function<void(void* into, const YamlValue& self)>> places;

  /// Reads every key that is written, in the order of the rows. Throws InputError for a key that is not known
  /// (with those that are, and the nearest), one that is required and not there, a wrong value, and a rule that
  /// is broken.
  void read(const YamlMap& map, void* into) const;

  const KeyRow* find(const std::string& key) const;  ///< in our own rows; nullptr: not there
};

struct Branch {
  Condition when;
  MapKeys keys;
};

/// The table and all that it leads to, each once, in the order in which a reader of the file meets them.
std::vector<const MapKeys*> tables_below(const MapKeys& root);

}  // namespace talisman::sequences
