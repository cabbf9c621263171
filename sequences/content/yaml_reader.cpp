// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/yaml_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

constexpr std::uintmax_t kMaxBytes = 16 << 20;  // no sequence is written by hand that is longer
constexpr std::size_t kShownCharacters = 60;

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string in_words(const Range& range) {
  const bool bounded = range.high < std::numeric_limits<double>::max();
  if (range.low == -std::numeric_limits<double>::max()) return "a finite number";
  std::string text = (range.above ? "a number above " : "a number from ") + shown(range.low);
  if (bounded) return text + (range.above ? ", at most " : " to ") + shown(range.high);
  return text + (range.above ? "" : " upwards");
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

}  // namespace

// --- Values ---

YamlValue::YamlValue(const YAML::Node& node, std::string path, std::string file)
    : node_(std::make_shared<const YAML::Node>(node)), path_(std::move(path)), file_(std::move(file)) {}

std::string YamlValue::written() const {
  if (node_->IsScalar()) return std::string("'").append(node_->Scalar(), 0, kShownCharacters).append("'");
  if (node_->IsSequence()) return "a list of " + std::to_string(node_->size());
  return node_->IsMap() ? "a map" : "nothing";
}

int YamlValue::line() const { return node_->Mark().line + 1; }

void YamlValue::fail(const std::string& rule) const {
  const std::string what = path_.empty() ? "the file" : path_;
  throw InputError(what + " is " + written() + ", rule: " + rule, file_, line());
}

double YamlValue::number(const Range& range) const {
  double value = 0;
  if (!node_->IsScalar() || !YAML::convert<double>::decode(*node_, value)) fail(in_words(range));
  const bool inside =
      std::isfinite(value) && value <= range.high && (range.above ? value > range.low : value >= range.low);
  if (!inside) fail(in_words(range));
  return value;
}

int YamlValue::integer(int low, int high) const {
  const std::string rule = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  int value = 0;
  if (!node_->IsScalar() || !YAML::convert<int>::decode(*node_, value)) fail(rule);
  if (value < low || value > high) fail(rule);
  return value;
}

bool YamlValue::boolean() const {
  bool value = false;
  if (!node_->IsScalar() || !YAML::convert<bool>::decode(*node_, value)) fail("true or false");
  return value;
}

std::string YamlValue::text() const {
  if (!node_->IsScalar() || node_->Scalar().empty()) fail("a text");
  return node_->Scalar();
}

glm::dvec3 YamlValue::vector() const {
  if (!node_->IsSequence() || node_->size() != 3) fail("a list of 3 numbers");
  const std::vector<YamlValue> v = items();
  return {v[0].number(), v[1].number(), v[2].number()};
}

glm::dvec2 YamlValue::pair(const Range& range) const {
  if (!node_->IsSequence() || node_->size() != 2) fail("a list of 2 numbers");
  const std::vector<YamlValue> v = items();
  return {v[0].number(range), v[1].number(range)};
}

glm::vec3 YamlValue::color() const {
  const char* rule = "[r, g, b] in linear light, each at least 0, or \"#rrggbb\" in sRGB";
  if (node_->IsSequence() && node_->size() == 3) {
    const std::vector<YamlValue> v = items();
    return {v[0].number(kNotNegative), v[1].number(kNotNegative), v[2].number(kNotNegative)};
  }
  const std::string hex = node_->IsScalar() ? node_->Scalar() : "";
  if (hex.size() != 7 || hex[0] != '#' ||
      hex.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    fail(rule);
  glm::vec3 linear;
  for (int k = 0; k < 3; ++k)
    linear[k] =
        linear_from_srgb(static_cast<float>(std::stoi(hex.substr(1 + 2 * k, 2), nullptr, 16)) / 255.0f);
  return linear;
}

bool YamlValue::is_list() const { return node_->IsSequence(); }

std::vector<YamlValue> YamlValue::items(std::size_t at_least) const {
  if (!node_->IsSequence() || node_->size() < at_least)
    fail("a list of " + std::to_string(at_least) + " or more");
  std::vector<YamlValue> items;
  for (std::size_t i = 0; i < node_->size(); ++i)
    items.emplace_back((*node_)[i], std::string(path_).append("[").append(std::to_string(i)).append("]"),
                       file_);
  return items;
}

YamlMap YamlValue::map() const {
  if (!node_->IsMap()) fail("a map");
  std::map<std::string, YamlValue> values;
  for (const auto& entry : *node_) {
    if (!entry.first.IsScalar()) fail("keys are texts");
    const std::string key = entry.first.Scalar();
    const YamlValue value(entry.second, path_.empty() ? key : path_ + "." + key, file_);
    if (!values.emplace(key, value).second) value.fail("each key only once");
  }
  return YamlMap(std::move(values), *this);
}

int YamlValue::choice(const std::vector<std::string>& names) const {
  const auto found = node_->IsScalar() ? std::find(names.begin(), names.end(), node_->Scalar()) : names.end();
  if (found == names.end()) fail("one of " + joined(names));
  return static_cast<int>(found - names.begin());
}

// --- Maps ---

YamlMap::YamlMap(std::map<std::string, YamlValue> values, YamlValue self)
    : values_(std::move(values)), self_(std::move(self)) {}

namespace {

/// Equal but for one letter that was changed, left out or added.
bool is_one_edit_away(const std::string& a, const std::string& b) {
  const std::string &shorter = a.size() < b.size() ? a : b, &longer = a.size() < b.size() ? b : a;
  if (longer.size() - shorter.size() > 1) return false;
  std::size_t same = 0;
  while (same < shorter.size() && shorter[same] == longer[same]) ++same;
  const std::size_t skip = longer.size() == shorter.size() ? 1 : 0;
  return shorter.compare(std::min(same + skip, shorter.size()), std::string::npos, longer, same + 1,
                         std::string::npos) == 0;
}

}  // namespace

const YamlValue* YamlMap::find(const std::string& key) {
  known_.insert(key);
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : &found->second;
}

const YamlValue& YamlMap::need(const std::string& key) {
  if (const YamlValue* value = find(key)) return *value;
  // A misspelt key is both missing and unknown; the line to show is the one where it was written.
  for (const auto& [written, value] : values_)
    if (!known_.count(written) && is_one_edit_away(written, key))
      value.fail("key '" + written + "' is not known here; did you mean '" + key + "'");
  self_.fail("has the key '" + key + "'");
}

void YamlMap::read(const std::string& key, double& into, const Range& range) {
  if (const YamlValue* value = find(key)) into = value->number(range);
}
void YamlMap::read(const std::string& key, int& into, int low, int high) {
  if (const YamlValue* value = find(key)) into = value->integer(low, high);
}
void YamlMap::read(const std::string& key, bool& into) {
  if (const YamlValue* value = find(key)) into = value->boolean();
}
void YamlMap::read(const std::string& key, std::string& into) {
  if (const YamlValue* value = find(key)) into = value->text();
}
void YamlMap::read(const std::string& key, glm::dvec3& into) {
  if (const YamlValue* value = find(key)) into = value->vector();
}
void YamlMap::read_color(const std::string& key, glm::vec3& into) {
  if (const YamlValue* value = find(key)) into = value->color();
}

std::vector<std::string> YamlMap::texts(const std::string& key) {
  std::vector<std::string> texts;
  if (const YamlValue* value = find(key))
    for (const YamlValue& item : value->items(0)) texts.push_back(item.text());
  return texts;
}

void YamlMap::finish() const {
  for (const auto& [key, value] : values_)
    if (!known_.count(key))
      value.fail("key '" + key + "' is not known here; keys are " + joined({known_.begin(), known_.end()}));
}

void YamlMap::replace_by(const YamlMap& over) {
  for (const auto& [key, value] : over.values_) values_.insert_or_assign(key, value);
}

// --- Files ---

YamlMap read_yaml_text(const std::string& text, const std::string& file) {
  try {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap())
      throw InputError("is not a map of keys and values, rule: a sequence file is a YAML map", file, 1);
    return YamlValue(root, "", file).map();
  } catch (const YAML::Exception& e) {
    throw InputError("not YAML: " + e.msg, file, e.mark.line + 1);
  }
}

YamlMap read_yaml_file(const std::string& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw InputError("cannot be read: " + error.message(), file);
  if (size > kMaxBytes)
    throw InputError("has " + std::to_string(size) + " bytes, rule: at most " + std::to_string(kMaxBytes),
                     file);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw InputError("cannot be read", file);
  return read_yaml_text(text.str(), file);
}

}  // namespace talisman::sequences
