// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/value_format.h"

#include <filesystem>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "sequences/content/asset_paths.h"

namespace talisman::sequences {

namespace {

std::string in_brackets(const std::vector<double>& numbers) {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(shown(number));
  return "[" + joined(words) + "]";
}

std::string vector_in_brackets(const glm::dvec3& v) { return in_brackets({v.x, v.y, v.z}); }
std::string pair_in_brackets(const glm::dvec2& v) { return in_brackets({v.x, v.y}); }

ValueType pair_type(const Range& range) { return list_type(number_type(range), 2, 2); }
ValueType vector_type(const Range& range = kAnyNumber) { return list_type(number_type(range), 3, 3); }

}  // namespace

Format<double> number(const Range& range) {
  return {number_type(range), [range](const YamlValue& value) { return value.number(range); }, shown};
}

Format<double> zero_or(const Range& range) {
  const auto read = [range](const YamlValue& value) {
    const double number = value.number();
    return number == 0 ? number : value.number(range);
  };
  return {either_type({number_type({0, 0}), number_type(range)}), read, shown};
}

Format<double> degrees(const Range& range) {
  return {number_type(range), [range](const YamlValue& value) { return glm::radians(value.number(range)); },
          [](double radians) { return shown(glm::degrees(radians)); }};
}

Format<int> whole(int low, int high) {
  return {whole_type(low, high), [low, high](const YamlValue& value) { return value.integer(low, high); },
          [](int value) { return std::to_string(value); }};
}

Format<bool> truth() {
  return {{.kind = ValueType::Kind::Truth},
          [](const YamlValue& value) { return value.boolean(); },
          [](bool value) { return value ? "true" : "false"; }};
}

Format<std::string> text() {
  return {{.kind = ValueType::Kind::Text},
          [](const YamlValue& value) { return value.text(); },
          [](const std::string& value) { return value; }};
}

Format<std::vector<std::string>> texts(std::size_t at_least) {
  const auto read = [at_least](const YamlValue& list) {
    std::vector<std::string> texts;
    for (const YamlValue& item : list.items(at_least)) texts.push_back(item.text());
    return texts;
  };
  return {list_type({.kind = ValueType::Kind::Text}, at_least), read};
}

Format<std::string> asset() {
  return {with_rule({.kind = ValueType::Kind::Text}, "a file that is there"),
          [](const YamlValue& value) { return resolve_asset(value.text(), value.file(), value.line()); }};
}

Format<std::vector<std::string>> folders() {
  const char* rule = "folders that are there";
  const auto read = [rule](const YamlValue& list) {
    std::vector<std::string> folders;
    for (const YamlValue& item : list.items(0)) {
      // An absolute path stays as it is.
      const std::filesystem::path folder = std::filesystem::path(item.file()).parent_path() / item.text();
      std::error_code error;
      if (!std::filesystem::is_directory(folder, error)) item.fail(rule);
      folders.push_back(folder.string());
    }
    return folders;
  };
  return {with_rule(list_type({.kind = ValueType::Kind::Text}, 0), rule), read};
}

Format<glm::dvec3> vector() {
  return {vector_type(), [](const YamlValue& value) { return value.vector(); }, vector_in_brackets};
}

Format<glm::dvec3> direction() {
  const char* rule = "not the zero vector";
  const auto read = [rule](const YamlValue& value) {
    const glm::dvec3 direction = value.vector();
    if (glm::length(direction) == 0) value.fail(rule);
    return direction;
  };
  return {with_rule(vector_type(), rule), read, vector_in_brackets};
}

Format<glm::dvec3> sides() {
  const auto read = [](const YamlValue& value) {
    const glm::dvec3 size = value.vector();
    for (int axis = 0; axis < 3; ++axis)
      if (!kPositive.holds(size[axis])) value.fail(in_words(vector_type(kPositive)));
    return size;
  };
  return {vector_type(kPositive), read, vector_in_brackets};
}

Format<glm::dvec2> pair(const Range& range) {
  return {pair_type(range), [range](const YamlValue& value) { return value.pair(range); }, pair_in_brackets};
}

Format<glm::dvec2> interval(const Range& range) {
  const char* rule = "the first below the second";
  const auto read = [range, rule](const YamlValue& value) {
    const glm::dvec2 ends = value.pair(range);
    if (!(ends.x < ends.y)) value.fail(rule);
    return ends;
  };
  return {with_rule(pair_type(range), rule), read, pair_in_brackets};
}

Format<glm::ivec2> whole_pair(int low, int high) {
  const ValueType type = list_type(whole_type(low, high), 2, 2);
  const auto read = [type, low, high](const YamlValue& value) {
    const std::vector<YamlValue> items = value.items(2);
    if (items.size() != 2) value.fail(in_words(type));
    return glm::ivec2(items[0].integer(low, high), items[1].integer(low, high));
  };
  return {type, read, [](const glm::ivec2& v) { return pair_in_brackets(glm::dvec2(v)); }};
}

Format<glm::vec3> color() {
  return {{.kind = ValueType::Kind::Color},
          [](const YamlValue& value) { return value.color(); },
          [](const glm::vec3& v) {
            return in_brackets({v.x, v.y, v.z});
          }};
}

Format<std::string> one_of(const std::vector<std::string>& words) {
  return {choice_type(words), [words](const YamlValue& value) { return words[value.choice(words)]; },
          [](const std::string& word) { return word; }};
}

}  // namespace talisman::sequences
