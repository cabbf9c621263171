// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How one value is written in a sequence file: its type as data, how it is read, and how a default is shown.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sequences/content/value_type.h"
#include "sequences/content/yaml_reader.h"

namespace talisman::sequences {

template <typename Value>
struct Format {
  ValueType type;
  std::function<Value(const YamlValue&)> read;
  std::function<std::string(const Value&)> written{};  ///< as in a file; not set: defaults are not shown
};

Format<double> number(const Range& range = kAnyNumber);
Format<double> zero_or(const Range& range);  ///< 0 switches something off; else within the range
Format<double> degrees(const Range& range);  ///< the value is in radians, the range in degrees
Format<int> whole(int low, int high);
Format<bool> truth();
Format<std::string> text();
Format<std::vector<std::string>> texts(std::size_t at_least);
Format<std::string> asset();                 ///< the path of a file that is there (asset_paths.h)
Format<std::vector<std::string>> folders();  ///< that are there, relative to the file
Format<glm::dvec3> vector();                 ///< [x, y, z]
Format<glm::dvec3> direction();              ///< likewise, not zero
Format<glm::dvec3> sides();                  ///< likewise, each above 0
Format<glm::dvec2> pair(const Range& range);
Format<glm::dvec2> interval(const Range& range);  ///< a pair, the first below the second
Format<glm::ivec2> whole_pair(int low, int high);
Format<glm::vec3> color();  ///< linear light
Format<std::string> one_of(const std::vector<std::string>& words);

/// The same with a rule that its reader, or whoever uses the value, checks beyond the type.
template <typename Value>
Format<Value> with_rule(Format<Value> format, const std::string& rule) {
  format.type.rule = rule;
  return format;
}

/// A word for each value.
template <typename Value>
Format<Value> choice(const std::vector<std::pair<std::string, Value>>& choices) {
  std::vector<std::string> words;
  for (const auto& [word, value] : choices) words.push_back(word);
  const auto written = [choices](const Value& value) -> std::string {
    for (const auto& [word, other] : choices)
      if (other == value) return word;
    return "";
  };
  return {choice_type(words),
          [choices, words](const YamlValue& value) { return choices[value.choice(words)].second; }, written};
}

}  // namespace talisman::sequences
