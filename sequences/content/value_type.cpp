// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/value_type.h"

#include <cmath>
#include <sstream>

namespace talisman::sequences {

namespace {

using Kind = ValueType::Kind;

/// "from 0 to 1", "above 0, at most 4"; empty where every number is allowed.
std::string range_in_words(const Range& range) {
  if (!range.has_low()) return range.has_high() ? "up to " + shown(range.high) : "";
  std::string text = (range.above ? "above " : "from ") + shown(range.low);
  if (range.has_high()) return text + (range.above ? ", at most " : " to ") + shown(range.high);
  return text + (range.above ? "" : " upwards");
}

std::string number_in_words(const Range& range) {
  if (range.low == range.high) return shown(range.low);
  const std::string limits = range_in_words(range);
  return limits.empty() ? "a finite number" : "a number " + limits;
}

std::string items_in_words(const ValueType& item) {
  const std::string limits = range_in_words(item.range);
  switch (item.kind) {
    case Kind::Number:
      return "numbers" + (limits.empty() ? "" : ", each " + limits);
    case Kind::Whole:
      return "whole numbers, each " + limits;
    case Kind::Text:
      return "texts";
    case Kind::Map:
      return "maps";
    default:
      return "values, each " + in_words(item);
  }
}

std::string list_in_words(const ValueType& list) {
  std::string size;
  if (list.is_list_of(list.at_least))
    size = "of " + std::to_string(list.at_least) + " ";
  else if (list.at_least > 0)
    size = "of " + std::to_string(list.at_least) + " or more ";
  else
    size = "of ";
  return "a list " + size + items_in_words(list.of[0]);
}

}  // namespace

bool Range::holds(double value) const {
  return std::isfinite(value) && value <= high && (above ? value > low : value >= low);
}

ValueType number_type(const Range& range) { return {.kind = Kind::Number, .range = range}; }

ValueType whole_type(int low, int high) {
  return {.kind = Kind::Whole, .range = {static_cast<double>(low), static_cast<double>(high)}};
}

ValueType choice_type(std::vector<std::string> words) {
  return {.kind = Kind::Choice, .words = std::move(words)};
}

ValueType list_type(ValueType items, std::size_t at_least, std::size_t at_most) {
  return {.kind = Kind::List, .of = {std::move(items)}, .at_least = at_least, .at_most = at_most};
}

ValueType map_type(const MapKeys& keys) { return {.kind = Kind::Map, .map = &keys}; }

ValueType either_type(std::vector<ValueType> alternatives) {
  return {.kind = Kind::Either, .of = std::move(alternatives)};
}

ValueType with_rule(ValueType type, std::string rule) {
  type.rule = std::move(rule);
  return type;
}

std::string in_words(const ValueType& type) {
  switch (type.kind) {
    case Kind::Number:
      return number_in_words(type.range);
    case Kind::Whole:
      return "a whole number from " + std::to_string(static_cast<int>(type.range.low)) + " to " +
             std::to_string(static_cast<int>(type.range.high));
    case Kind::Truth:
      return "true or false";
    case Kind::Text:
      return "a text";
    case Kind::Color:
      return "[r, g, b] in linear light, each from 0 to 1e+09, or \"#rrggbb\" in sRGB";
    case Kind::Choice:
      return "one of " + joined(type.words);
    case Kind::List:
      return list_in_words(type);
    case Kind::Map:
      return "a map";
    case Kind::Either:
      break;
  }
  std::vector<std::string> alternatives;
  for (const ValueType& alternative : type.of) alternatives.push_back(in_words(alternative));
  return listed(alternatives);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

std::string listed(const std::vector<std::string>& words, const std::string& last) {
  if (words.size() < 2) return joined(words);
  return joined({words.begin(), words.end() - 1}) + " " + last + " " + words.back();
}

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace talisman::sequences
