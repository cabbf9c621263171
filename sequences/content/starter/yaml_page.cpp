// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/starter/yaml_page.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <sstream>

#include "sequences/content/value_type.h"
#include "sequences/files/utf8.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kCommentColumn = 36, kWidth = 118;

/// Letters, digits and what has no meaning in YAML inside a word; words that YAML reads as something else are not.
bool is_plain(const std::string& text) {
  static constexpr std::array kOther{"true", "false", "yes", "no",  "on", "off",
                                     "null", "y",     "n",   "nan", "inf"};
  std::string lower;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (!std::isalnum(u) && std::string_view("_-./").find(c) == std::string_view::npos) return false;
    lower += static_cast<char>(std::tolower(u));
  }
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) &&
         std::find(kOther.begin(), kOther.end(), lower) == kOther.end();
}

template <typename Number>
std::string shortest(Number value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// The words of a text in lines of at most `width` characters, the first of which may be another.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    if (!line.empty() && line.size() + 1 + word.size() > width)
      lines.push_back(word);
    else
      line += (line.empty() ? "" : " ") + word;
  }
  return lines;
}

}  // namespace

std::string yaml_text(const std::string& text) {
  if (is_plain(text)) return text;
  const bool is_utf8 = !first_not_utf8(text);
  std::string quoted = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    std::array<char, 8> code{};
    std::snprintf(code.data(), code.size(), "\\x%02x", u);
    if (c == '"' || c == '\\')
      quoted += std::string("\\") + c;
    else if (u < 0x20 || u == 0x7f)
      quoted += code.data();
    else
      quoted += u >= 0x80 && !is_utf8 ? '?' : c;
  }
  return quoted + "\"";
}

std::string yaml_number(double value) { return shortest(value); }
std::string yaml_number(float value) { return shortest(value); }

std::string yaml_vector(const layers::dvec3& v) {
  return yaml_list({yaml_number(v.x), yaml_number(v.y), yaml_number(v.z)});
}

std::string yaml_color(const layers::vec3& color) {
  return yaml_list({yaml_number(color.x), yaml_number(color.y), yaml_number(color.z)});
}

std::string yaml_list(const std::vector<std::string>& items) { return "[" + joined(items) + "]"; }

void YamlPage::key(const std::string& prefix, const std::string& key, const std::string& value,
                   const std::string& comment) {
  std::string line = prefix + key + ":" + (value.empty() ? "" : " " + value);
  if (comment.empty()) return this->line(line);
  line.resize(std::max(line.size() + 1, kCommentColumn), ' ');
  const std::size_t column = std::min(line.size(), kCommentColumn);
  const std::vector<std::string> lines = wrapped(comment, kWidth - kCommentColumn - 2);
  this->line(line + "# " + lines.front());
  for (std::size_t k = 1; k < lines.size(); ++k) this->line(std::string(column, ' ') + "# " + lines[k]);
}

void YamlPage::comment(const std::string& prefix, const std::string& text) {
  for (const std::string& line : wrapped(text, kWidth - prefix.size() - 2))
    this->line(prefix + "#" + (line.empty() ? "" : " " + line));
}

void YamlPage::list(const std::string& indent, const std::string& key, const std::vector<std::string>& items,
                    const std::string& comment) {
  const std::string in_one = yaml_list(items);
  if (indent.size() + key.size() + in_one.size() + 2 <= kWidth)
    return this->key(indent, key, in_one, comment);
  this->key(indent, key, "", comment);
  for (const std::string& item : items) line(indent + "  - " + item);
}

}  // namespace talisman::sequences
