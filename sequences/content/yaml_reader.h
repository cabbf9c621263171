// SPDX-License-Identifier: Apache-2.0
#pragma once

/// YAML without guesses: every value has a type and a range, and whatever is wrong is an InputError
/// `FILE:LINE: what, the value, the rule`. Which keys a map has is said by its table (key_table.h).

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"

namespace YAML {
class Node;
}

namespace talisman::sequences {

class YamlMap;

/// One value and where it stands.
class YamlValue {
 public:
  YamlValue(const YAML::Node& node, std::string path, std::string file);

  double number(const Range& range = kAnyNumber) const;
  int integer(int low, int high) const;
  bool boolean() const;
  std::string text() const;                   ///< not empty
  glm::dvec3 vector() const;                  ///< [x, y, z], finite
  glm::dvec2 pair(const Range& range) const;  ///< [a, b]
  glm::vec3 color() const;                    ///< [r, g, b] linear, ≥ 0, or "#rrggbb" in sRGB
  std::vector<YamlValue> items(std::size_t at_least = 1) const;
  YamlMap map() const;
  /// Index of the text in `words`.
  std::size_t choice(const std::vector<std::string>& words) const;

  bool is_list() const;
  bool is_map() const;
  /// "what, the value, the rule" with file and line.
  [[noreturn]] void fail(const std::string& rule) const;
  /// The same where more is to be said of the value: "camera has near_m '5', …".
  [[noreturn]] void fail_as(const std::string& is, const std::string& rule) const;
  std::string written() const;  ///< "'text'", "a list of 3", "a map"
  const std::string& file() const { return file_; }
  int line() const;  ///< from 1

 private:
  std::shared_ptr<const YAML::Node> node_;
  std::string path_;  ///< "camera.flight.keys[3].t"
  std::string file_;
};

/// The values of a map by their keys, and where the map itself stands.
class YamlMap {
 public:
  YamlMap(std::map<std::string, YamlValue> values, YamlValue self);

  /// nullptr when the key is not there.
  const YamlValue* find(const std::string& key) const;
  const std::map<std::string, YamlValue>& values() const { return values_; }
  const YamlValue& self() const { return self_; }
  /// Values of `over` replace ours of the same key.
  void replace_by(const YamlMap& over);

 private:
  std::map<std::string, YamlValue> values_;
  YamlValue self_;
};

/// The map at the top of a YAML file: one document, in UTF-8.
YamlMap read_yaml_file(const std::string& file);

/// The same from text; `file` is only named in errors.
YamlMap read_yaml_text(const std::string& text, const std::string& file);

}  // namespace talisman::sequences
