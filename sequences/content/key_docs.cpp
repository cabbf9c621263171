// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/key_docs.h"

#include <map>
#include <stdexcept>

namespace talisman::sequences {

namespace {

using Kind = ValueType::Kind;

std::string code(const std::string& text) { return "`" + text + "`"; }

std::string link_to(const MapKeys& keys) { return "[" + keys.name + "](#keys-of-" + keys.name + ")"; }

std::string value_in_markdown(const ValueType& type) {
  std::vector<std::string> parts;
  switch (type.kind) {
    case Kind::Map:
      return "map: " + link_to(*type.map);
    case Kind::Choice:
      for (const std::string& word : type.words) parts.push_back(code(word));
      return joined(parts);
    case Kind::List:
      if (type.of[0].kind != Kind::Map) return in_words(type);
      return "list of maps" + std::string(type.at_least > 0 ? "" : " (or empty)") + ": " +
             link_to(*type.of[0].map);
    case Kind::Either:
      for (const ValueType& of : type.of) parts.push_back(value_in_markdown(of));
      return listed(parts);
    default:
      return in_words(type);
  }
}

std::string company_of(const KeyRow& row) {
  std::string text;
  if (!row.only_with.empty()) text += ". Only together with " + code(row.only_with);
  std::vector<std::string> others;
  for (const std::string& other : row.not_with) others.push_back(code(other));
  if (!others.empty()) text += ". Not together with " + listed(others);
  return text;
}

std::string line_of(const KeyRow& row, const std::string& when) {
  const std::string rule = row.type.rule.empty() ? "" : "; " + row.type.rule;
  std::string otherwise = row.standard.empty() ? row.standard_in_words : code(row.standard);
  if (row.is_required) otherwise = "required";
  std::string line = "|";
  for (const std::string& cell : {code(row.key) + when, value_in_markdown(row.type) + rule, row.unit,
                                  otherwise, row.meaning + company_of(row)})
    line += cell.empty() ? " |" : " " + cell + " |";
  return line + "\n";
}

/// Rows that were taken over from a table with a name are one line that refers to it.
std::string lines_of(const MapKeys& keys, const std::string& when) {
  std::string text;
  const MapKeys* from = nullptr;
  for (const KeyRow& row : keys.rows) {
    if (!row.from)
      text += line_of(row, when);
    else if (row.from != from)
      text += "| keys of " + link_to(*row.from) + when + " | | | | |\n";
    from = row.from;
  }
  for (const Branch& branch : keys.branches) text += lines_of(branch.keys, ", " + branch.when.in_words());
  return text;
}

std::string group_in_words(const KeyGroup& group) {
  std::vector<std::string> keys;
  for (const std::string& key : group.keys) keys.push_back(code(key));
  return (group.exactly_one ? "Exactly one of " : "At least one of ") + listed(keys, "and") + " is given";
}

std::string groups_of(const MapKeys& keys, const std::string& when) {
  std::string text;
  for (const KeyGroup& group : keys.groups) text += "\n" + group_in_words(group) + when + ".\n";
  for (const Branch& branch : keys.branches) text += groups_of(branch.keys, ", " + branch.when.in_words());
  return text;
}

void add_type_rules(const ValueType& type, const std::string& path, std::string& text) {
  // Once for all branches that have the key.
  const std::string line = "- " + code(path) + ": " + type.rule + "\n";
  if (!type.rule.empty() && text.find(line) == std::string::npos) text += line;
  for (const ValueType& of : type.of) add_type_rules(of, path, text);
}

void add_rules(const MapKeys& keys, const std::string& name, std::string& text) {
  for (const KeyRule& rule : keys.rules) text += "- " + code(name) + ": " + rule.words + "\n";
  for (const KeyRow& row : keys.rows)
    if (!row.from) add_type_rules(row.type, name + "." + row.key, text);
  for (const Branch& branch : keys.branches) add_rules(branch.keys, name, text);
}

const std::string kOpen = "<!-- ", kClose = " -->\n", kEnd = "<!-- end -->\n";

/// What stands in the block of each title.
std::map<std::string, std::string> blocks_of(const MapKeys& root) {
  std::map<std::string, std::string> blocks{{"rules", rules_in_markdown(root)}};
  for (const MapKeys* keys : tables_below(root)) blocks["keys of " + keys->name] = markdown_of(*keys);
  return blocks;
}

}  // namespace

std::string markdown_of(const MapKeys& keys) {
  return "### Keys of " + keys.name +
         "\n\n| key | value | unit | without it | meaning |\n|---|---|---|---|---|\n" + lines_of(keys, "") +
         groups_of(keys, "");
}

std::string rules_in_markdown(const MapKeys& root) {
  std::string text;
  for (const MapKeys* keys : tables_below(root)) add_rules(*keys, keys->name, text);
  return text;
}

std::string documented(const std::string& document, const MapKeys& root) {
  std::map<std::string, std::string> blocks = blocks_of(root);
  std::string result;
  std::size_t from = 0;
  for (std::size_t open = 0; (open = document.find(kOpen, from)) != std::string::npos;) {
    const std::size_t close = document.find(kClose, open), end = document.find(kEnd, open);
    if (close == std::string::npos || end == std::string::npos)
      throw std::invalid_argument("a block without an end: " + document.substr(open, 60));
    const std::string title = document.substr(open + kOpen.size(), close - open - kOpen.size());
    const auto block = blocks.find(title);
    if (block == blocks.end()) throw std::invalid_argument("no table for the block '" + title + "'");
    result += document.substr(from, open - from) + kOpen + title + kClose + block->second + kEnd;
    from = end + kEnd.size();
    blocks.erase(block);
  }
  if (!blocks.empty()) throw std::invalid_argument("no block for '" + blocks.begin()->first + "'");
  return result + document.substr(from);
}

}  // namespace talisman::sequences
