// SPDX-License-Identifier: Apache-2.0
#pragma once

/// YAML without guesses: every value has a type and a range, every key is known, and whatever is wrong is an
/// InputError `FILE:LINE: what, the value, the rule`. A reader asks a map for the keys it knows and then
/// calls `finish`, which refuses the keys that nobody asked for and lists those that exist.

#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sequences/files/errors.h"

namespace YAML {
class Node;
}

namespace talisman::sequences {

/// Allowed numbers; `above` excludes the lower end itself.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool above = false;
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0, std::numeric_limits<double>::max(), true};
inline constexpr Range kNotNegative{0, std::numeric_limits<double>::max(), false};

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
  /// Index of the text in `names`.
  int choice(const std::vector<std::string>& names) const;

  bool is_list() const;
  /// "what, the value, the rule" with file and line.
  [[noreturn]] void fail(const std::string& rule) const;
  const std::string& file() const { return file_; }
  int line() const;  ///< from 1

 private:
  std::string written() const;
  std::shared_ptr<const YAML::Node> node_;
  std::string path_;  ///< "camera.flight.keys[3].t"
  std::string file_;
};

class YamlMap {
 public:
  explicit YamlMap(std::map<std::string, YamlValue> values, YamlValue self);

  /// nullptr when the key is not there.
  const YamlValue* find(const std::string& key);
  const YamlValue& need(const std::string& key);
  bool has(const std::string& key) const { return values_.count(key) > 0; }

  void read(const std::string& key, double& into, const Range& range);
  void read(const std::string& key, int& into, int low, int high);
  void read(const std::string& key, bool& into);
  void read(const std::string& key, std::string& into);
  void read(const std::string& key, glm::dvec3& into);
  void read_color(const std::string& key, glm::vec3& into);
  std::vector<std::string> texts(const std::string& key);

  /// Refuses the first key that was not asked for.
  void finish() const;
  const YamlValue& self() const { return self_; }
  /// Values of `over` replace ours of the same key.
  void replace_by(const YamlMap& over);

 private:
  std::map<std::string, YamlValue> values_;
  std::set<std::string> known_;
  YamlValue self_;
};

/// The map at the top of a YAML file.
YamlMap read_yaml_file(const std::string& file);

/// The same from text; `file` is only named in errors.
YamlMap read_yaml_text(const std::string& text, const std::string& file);

}  // namespace talisman::sequences
