// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What may stand behind a key of a sequence file, as data. The rules in messages, the tables of
/// docs/sequence-format.md and the JSON Schema are all made from it, so that they cannot say different things.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace talisman::sequences {

/// Allowed numbers; `above` excludes the lower end itself.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool above = false;

  bool has_low() const { return low > -std::numeric_limits<double>::max(); }
  bool has_high() const { return high < std::numeric_limits<double>::max(); }
  bool holds(double value) const;  ///< false for what is not finite
};

/// What products, quotients and fourth powers of which are finite, also in single precision.
inline constexpr double kMost = 1e9, kLeast = 1e-9;
inline constexpr Range kAnyNumber{-kMost, kMost};
inline constexpr Range kPositive{kLeast, kMost};
inline constexpr Range kNotNegative{0, kMost};

class MapKeys;

struct ValueType {
  enum class Kind {
    Number,  ///< finite, within `range`
    Whole,   ///< within `range`
    Truth,   ///< true or false
    Text,    ///< not empty
    Color,   ///< [r, g, b] linear, each ≥ 0, or "#rrggbb" in sRGB
    Choice,  ///< one of `words`
    List,    ///< `at_least` to `at_most` items, each as of[0]
    Map,     ///< the keys of `map`
    Either,  ///< any type in `of`
  };
  Kind kind = Kind::Text;
  Range range{};
  std::vector<std::string> words{};
  std::vector<ValueType> of{};
  std::size_t at_least = 0, at_most = std::numeric_limits<std::size_t>::max();
  const MapKeys* map = nullptr;
  std::string rule{};  ///< what must hold beyond all this, in words; no schema can say it

  bool is_list_of(std::size_t items) const { return at_least == items && at_most == items; }
};

ValueType number_type(const Range& range = kAnyNumber);
ValueType whole_type(int low, int high);
ValueType choice_type(std::vector<std::string> words);
ValueType list_type(ValueType items, std::size_t at_least,
                    std::size_t at_most = std::numeric_limits<std::size_t>::max());
ValueType map_type(const MapKeys& keys);
ValueType either_type(std::vector<ValueType> alternatives);
/// The same type with a further rule.
ValueType with_rule(ValueType type, std::string rule);

/// "a number from 0 to 1", "one of merge, keep", "a list of 2 whole numbers": what stands behind "rule: ".
std::string in_words(const ValueType& type);

/// "a, b, c".
std::string joined(const std::vector<std::string>& words);

/// "a, b or c", with another last word if wished.
std::string listed(const std::vector<std::string>& words, const std::string& last = "or");

/// The shortest usual way to write a number: "0.05", "1e+06".
std::string shown(double value);

}  // namespace talisman::sequences
