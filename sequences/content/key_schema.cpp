// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/key_schema.h"

#include <algorithm>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;
using Kind = ValueType::Kind;

Json reference(const MapKeys& keys) { return {{"$ref", "#/$defs/" + keys.name}}; }

Json schema_of(const ValueType& type);

Json number_schema(const char* name, const Range& range) {
  Json schema{{"type", name}};
  const bool is_whole = std::string(name) == "integer";
  const auto bound = [&](double value) { return is_whole ? Json(static_cast<long>(value)) : Json(value); };
  if (range.has_low()) schema[range.above ? "exclusiveMinimum" : "minimum"] = bound(range.low);
  if (range.has_high()) schema["maximum"] = bound(range.high);
  return schema;
}

/// A name such as 2001 or yes is a number or a truth to YAML, and a text to the reader.
Json text_schema() { return {{"type", {"string", "number", "boolean"}}, {"minLength", 1}}; }

Json color_schema() {
  const ValueType linear = list_type(number_type(kNotNegative), 3, 3);
  return {{"anyOf", {{{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}}, schema_of(linear)}}};
}

Json list_schema(const ValueType& list) {
  Json schema{{"type", "array"}, {"items", schema_of(list.of[0])}};
  if (list.at_least > 0) schema["minItems"] = list.at_least;
  if (list.at_most < std::numeric_limits<std::size_t>::max()) schema["maxItems"] = list.at_most;
  return schema;
}

Json schema_of(const ValueType& type) {
  switch (type.kind) {
    case Kind::Number:
      return number_schema("number", type.range);
    case Kind::Whole:
      return number_schema("integer", type.range);
    case Kind::Truth:
      return {{"type", "boolean"}};
    case Kind::Text:
      return text_schema();
    case Kind::Color:
      return color_schema();
    case Kind::Choice:
      return {{"enum", type.words}};
    case Kind::List:
      return list_schema(type);
    case Kind::Map:
      return reference(*type.map);
    case Kind::Either:
      break;
  }
  Json alternatives = Json::array();
  for (const ValueType& of : type.of) alternatives.push_back(schema_of(of));
  return {{"anyOf", std::move(alternatives)}};
}

/// Defaults are YAML; those that are JSON too keep their type, the rest are texts.
Json default_of(const std::string& written) {
  Json value = Json::parse(written, nullptr, false);
  return value.is_discarded() ? Json(written) : value;
}

Json property(const KeyRow& row) {
  if (row.from) return {{"$ref", "#/$defs/" + row.from->name + "/properties/" + row.key}};
  Json schema = schema_of(row.type);
  schema["description"] = row.meaning + (row.unit.empty() ? "" : " [" + row.unit + "]");
  if (!row.standard.empty()) schema["default"] = default_of(row.standard);
  return schema;
}

Json required(const std::vector<std::string>& keys) { return {{"required", keys}}; }

Json any_of(const std::vector<std::string>& keys, const char* how = "anyOf") {
  Json schemas = Json::array();
  for (const std::string& key : keys) schemas.push_back(required({key}));
  return {{how, std::move(schemas)}};
}

/// `keys` are those beside the branch.
Json schema_of(const Condition& when, const MapKeys& keys) {
  if (!when.without.empty()) return {{"not", required({when.without})}};
  if (when.key.empty()) return any_of(when.any_of);
  Json schema{{"properties", {{when.key, {{"enum", when.words}}}}}};
  const std::string& standard = keys.find(when.key)->standard;
  // A key that is not there has its default, which "properties" lets pass.
  if (standard.empty() || std::find(when.words.begin(), when.words.end(), standard) == when.words.end())
    schema["required"] = Json::array({when.key});
  return schema;
}

/// What a table asks of the map beyond the values of its keys.
void add_demands(const MapKeys& keys, Json& demands) {
  std::vector<std::string> needed;
  for (const KeyRow& row : keys.rows) {
    if (row.is_required) needed.push_back(row.key);
    for (const std::string& other : row.not_with) demands.push_back({{"not", required({row.key, other})}});
  }
  if (!needed.empty()) demands.push_back(required(needed));
  for (const KeyGroup& group : keys.groups)
    demands.push_back(any_of(group.keys, group.exactly_one ? "oneOf" : "anyOf"));
}

Json properties_of(const MapKeys& keys) {
  Json properties = Json::object();
  for (const KeyRow& row : keys.rows) properties[row.key] = property(row);
  return properties;
}

/// While a branch holds, its keys have its values; each of them needs one of the branches that have it.
void add_branches(const MapKeys& keys, Json& schema, Json& demands) {
  std::map<std::string, Json> homes;
  for (const Branch& branch : keys.branches) {
    const Json when = schema_of(branch.when, keys);
    Json then = Json::object(), needs = Json::array();
    if (!branch.keys.rows.empty()) then["properties"] = properties_of(branch.keys);
    add_demands(branch.keys, needs);
    add_branches(branch.keys, schema, needs);
    if (!needs.empty()) then["allOf"] = needs;
    demands.push_back({{"if", when}, {"then", then}});
    for (const KeyRow& row : branch.keys.rows) {
      schema["properties"].emplace(row.key, true);
      homes.emplace(row.key, Json::array()).first->second.push_back(when);
    }
  }
  for (auto& [key, home] : homes)
    schema["dependentSchemas"][key] = home.size() == 1 ? home[0] : Json{{"anyOf", home}};
}

Json schema_of(const MapKeys& keys) {
  Json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", properties_of(keys)}};
  Json demands = Json::array();
  add_demands(keys, demands);
  // Where another file is the base, that one may hold what is required.
  if (!keys.base_key.empty()) {
    const Json all{{"allOf", demands}};
    const Json either{{"anyOf", Json::array({required({keys.base_key}), all})}};
    demands = Json::array({either});
  }
  add_branches(keys, schema, demands);
  for (const KeyRow& row : keys.rows)
    if (!row.only_with.empty()) schema["dependentRequired"][row.key] = Json::array({row.only_with});
  if (!demands.empty()) schema["allOf"] = demands;
  return schema;
}

}  // namespace

std::string json_schema(const MapKeys& root) {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "A sequence of talisman"},
              {"$ref", "#/$defs/" + root.name}};
  for (const MapKeys* keys : tables_below(root)) schema["$defs"][keys->name] = schema_of(*keys);
  return schema.dump(2) + "\n";
}

}  // namespace talisman::sequences
