// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/column_json.h"

namespace talisman::sequences {

using Json = nlohmann::ordered_json;

Json json_of(const Value& value) {
  struct Writer {
    Json operator()(Absent) const { return nullptr; }
    Json operator()(Null) const { return nullptr; }
    Json operator()(bool v) const { return v; }
    Json operator()(std::int64_t v) const { return v; }
    Json operator()(double v) const { return v; }
    Json operator()(const std::string& v) const { return v; }
  };
  return std::visit(Writer{}, value);
}

Value value_from(const Json& json) {
  switch (json.type()) {
    case Json::value_t::null:
      return Null{};
    case Json::value_t::boolean:
      return json.get<bool>();
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
      return json.get<std::int64_t>();
    case Json::value_t::number_float:
      return value_of(json.get<double>());
    case Json::value_t::string:
      return json.get<std::string>();
    default:
      throw std::invalid_argument("not a single value");
  }
}

}  // namespace talisman::sequences
