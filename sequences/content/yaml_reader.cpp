// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/yaml_reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "sequences/content/nearest_word.h"
#include "sequences/files/utf8.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

constexpr std::uintmax_t kMaxFile_bytes = 16 << 20;  // no sequence is written by hand that is longer
constexpr std::size_t kMaxShown_chars = 60;

}  // namespace

// --- Values ---

YamlValue::YamlValue(const YAML::Node& node, std::string path, std::string file)
    : node_(std::make_shared<const YAML::Node>(node)), path_(std::move(path)), file_(std::move(file)) {}

std::string YamlValue::written() const {
  if (node_->IsScalar()) return std::string("'").append(node_->Scalar(), 0, kMaxShown_chars).append("'");
  if (node_->IsSequence()) return "a list of " + std::to_string(node_->size());
  return node_->IsMap() ? "a map" : "nothing";
}

int YamlValue::line() const { return node_->Mark().line + 1; }

void YamlValue::fail(const std::string& rule) const { fail_as("is " + written(), rule); }

void YamlValue::fail_as(const std::string& is, const std::string& rule) const {
  const std::string what = path_.empty() ? "the file" : path_;
  throw InputError(what + " " + is + ", rule: " + rule, file_, line());
}

double YamlValue::number(const Range& range) const {
  double value = 0;
  const bool is_number = node_->IsScalar() && YAML::convert<double>::decode(*node_, value);
  if (!is_number || !range.holds(value)) fail(in_words(number_type(range)));
  return value;
}

int YamlValue::integer(int low, int high) const {
  int value = 0;
  const bool is_whole = node_->IsScalar() && YAML::convert<int>::decode(*node_, value);
  if (!is_whole || value < low || value > high) fail(in_words(whole_type(low, high)));
  return value;
}

bool YamlValue::boolean() const {
  bool value = false;
  if (!node_->IsScalar() || !YAML::convert<bool>::decode(*node_, value))
    fail(in_words({.kind = ValueType::Kind::Truth}));
  return value;
}

std::string YamlValue::text() const {
  if (!node_->IsScalar() || node_->Scalar().empty()) fail(in_words({.kind = ValueType::Kind::Text}));
  return node_->Scalar();
}

glm::dvec3 YamlValue::vector() const {
  if (!node_->IsSequence() || node_->size() != 3) fail(in_words(list_type(number_type(), 3, 3)));
  const std::vector<YamlValue> v = items();
  return {v[0].number(), v[1].number(), v[2].number()};
}

glm::dvec2 YamlValue::pair(const Range& range) const {
  if (!node_->IsSequence() || node_->size() != 2) fail(in_words(list_type(number_type(range), 2, 2)));
  const std::vector<YamlValue> v = items();
  return {v[0].number(range), v[1].number(range)};
}

glm::vec3 YamlValue::color() const {
  if (node_->IsSequence() && node_->size() == 3) {
    const std::vector<YamlValue> v = items();
    return {v[0].number(kNotNegative), v[1].number(kNotNegative), v[2].number(kNotNegative)};
  }
  const std::string hex = node_->IsScalar() ? node_->Scalar() : "";
  if (hex.size() != 7 || hex[0] != '#' ||
      hex.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    fail(in_words({.kind = ValueType::Kind::Color}));
  glm::vec3 linear;
  for (int k = 0; k < 3; ++k)
    linear[k] =
        linear_from_srgb(static_cast<float>(std::stoi(hex.substr(1 + 2 * k, 2), nullptr, 16)) / 255.0f);
  return linear;
}

bool YamlValue::is_list() const { return node_->IsSequence(); }
bool YamlValue::is_map() const { return node_->IsMap(); }

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
    const auto [first, is_new] = values.emplace(key, value);
    if (!is_new) value.fail("each key only once, and it is in line " + std::to_string(first->second.line()));
  }
  return YamlMap(std::move(values), *this);
}

std::size_t YamlValue::choice(const std::vector<std::string>& words) const {
  const std::string word = node_->IsScalar() ? node_->Scalar() : "";
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) fail(in_words(choice_type(words)) + did_you_mean(word, words));
  return static_cast<std::size_t>(found - words.begin());
}

// --- Maps ---

YamlMap::YamlMap(std::map<std::string, YamlValue> values, YamlValue self)
    : values_(std::move(values)), self_(std::move(self)) {}

const YamlValue* YamlMap::find(const std::string& key) const {
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : &found->second;
}

void YamlMap::replace_by(const YamlMap& over) {
  for (const auto& [key, value] : over.values_) values_.insert_or_assign(key, value);
}

// --- Files ---

namespace {

void check_encoding(const std::string& text, const std::string& file) {
  const std::optional<std::size_t> wrong = first_not_utf8(text);
  if (!wrong) return;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(*wrong), '\n');
  throw InputError("byte " + std::to_string(static_cast<std::uint8_t>(text[*wrong])) +
                       " is no UTF-8 here, rule: a sequence file is UTF-8 text",
                   file, static_cast<int>(line));
}

/// In which line the content of each document begins.
class DocumentLines : public YAML::EventHandler {
 public:
  std::vector<int> lines;

  void OnDocumentStart(const YAML::Mark&) override { is_first_ = true; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { note(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { note(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string&) override {
    note(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnMapEnd() override {}

 private:
  void note(const YAML::Mark& mark) {
    if (is_first_) lines.push_back(mark.line + 1);
    is_first_ = false;
  }
  bool is_first_ = false;
};

/// Is nothing of the text behind the document, by what is seen of it at once? A map whose keys stand in the first column ends with the
/// text, or at a mark of documents in that column.
bool is_plainly_all(const YAML::Node& document, const std::string& text) {
  if (!document.IsMap() || document.Style() != YAML::EmitterStyle::Block || document.size() == 0)
    return false;
  if (document.begin()->first.Mark().column != 0) return false;
  for (const char* mark : {"---", "..."})
    if (text.rfind(mark, 0) == 0 || text.find(std::string("\n") + mark) != std::string::npos ||
        text.find(std::string("\r") + mark) != std::string::npos)
      return false;
  return true;
}

/// There may be no second document. YAML::LoadAll would find out, but makes documents for ever from a comma that begins one.
void check_documents(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  DocumentLines found;
  for (int k = 0; k < 2 && parser.HandleNextDocument(found); ++k) continue;
  if (found.lines.size() > 1)
    throw InputError("a second document, rule: one YAML document in a file", file,
                     std::max(1, found.lines[1]));
}

}  // namespace

YamlMap read_yaml_text(const std::string& text, const std::string& file) {
  check_encoding(text, file);
  try {
    const YAML::Node document = YAML::Load(text);
    if (!is_plainly_all(document, text)) check_documents(text, file);
    if (document.IsNull()) throw InputError("is empty, rule: a sequence file is a YAML map", file);
    if (!document.IsMap())
      throw InputError("is not a map of keys and values, rule: a sequence file is a YAML map", file, 1);
    return YamlValue(document, "", file).map();
  } catch (const YAML::Exception& e) {
    throw InputError("not YAML: " + e.msg, file, e.mark.line + 1);
  }
}

YamlMap read_yaml_file(const std::string& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw InputError("cannot be read: " + error.message(), file);
  if (size > kMaxFile_bytes)
    throw InputError(
        "has " + std::to_string(size) + " bytes, rule: at most " + std::to_string(kMaxFile_bytes), file);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw InputError("cannot be read", file);
  return read_yaml_text(text.str(), file);
}

}  // namespace talisman::sequences
