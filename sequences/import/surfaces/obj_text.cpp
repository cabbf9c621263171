// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/obj_text.h"

#include <algorithm>
#include <utility>

namespace talisman::sequences {

namespace {

constexpr std::size_t kBlock = 1 << 16;
constexpr const char* kMark = "\xEF\xBB\xBF";

/// Statements that hold numbers alone: v, vt, vn, vp, f, fo, l, p, s.
bool is_of_numbers(const std::string& line, std::size_t at) {
  const std::size_t end = line.find_first_of(" \t", at);
  const std::string word = line.substr(at, end == std::string::npos ? end : end - at);
  return word == "v" || word == "vt" || word == "vn" || word == "vp" || word == "f" || word == "fo" ||
         word == "l" || word == "p" || word == "s";
}

}  // namespace

std::string rest_of_line(const std::string& line, std::size_t from) {
  const std::size_t first = line.find_first_not_of(" \t", from), last = line.find_last_not_of(" \t\r");
  return first == std::string::npos || last < first ? std::string() : line.substr(first, last - first + 1);
}

ObjText::ObjText(std::unique_ptr<std::istream> from, const std::string& before) : from_(std::move(from)) {
  if (before.empty()) return;
  text_ = before + "\n";
  setg(text_.data(), text_.data(), text_.data() + text_.size());
}

void ObjText::add_statement(const std::string& line) {
  const std::size_t at = line.find_first_not_of(" \t");
  if (at != std::string::npos &&
      (line.compare(at, 7, "usemtl ") == 0 || line.compare(at, 7, "usemtl\t") == 0)) {
    std::string name = rest_of_line(line, at + 7);
    std::replace(name.begin(), name.end(), ' ', kKeptSpace);
    std::replace(name.begin(), name.end(), '\t', kKeptSpace);
    text_ += "usemtl " + name + '\n';
    return;
  }
  const std::size_t comment = line.find('#');
  const bool is_face = at != std::string::npos && line.compare(at, 3, "fo ") == 0;
  if (is_face || (comment != std::string::npos && at < comment && is_of_numbers(line, at))) {
    std::string clean = line.substr(0, comment);
    if (is_face) clean[at + 1] = ' ';
    text_ += clean;
  } else {
    text_ += line;
  }
  text_ += '\n';
}

/// One line of the file, without its end; there may be others in it that end with a carriage return alone.
void ObjText::add_line(std::string& line) {
  if (is_first_ && line.rfind(kMark, 0) == 0) line.erase(0, 3);
  is_first_ = false;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  for (std::size_t first = 0; first <= line.size();) {
    const std::size_t end = std::min(line.find('\r', first), line.size());
    if (end > first && line[end - 1] == '\\') {
      begun_.append(line, first, end - 1 - first).append(1, ' ');
    } else if (!begun_.empty()) {
      add_statement(begun_.append(line, first, end - first));
      begun_.clear();
    } else {
      add_statement(first == 0 && end == line.size() ? line : line.substr(first, end - first));
    }
    first = end + 1;
  }
}

ObjText::int_type ObjText::underflow() {
  text_.clear();
  while (text_.size() < kBlock && std::getline(*from_, line_)) add_line(line_);
  if (text_.empty() && !begun_.empty()) add_statement(std::exchange(begun_, {}));
  if (text_.empty()) return traits_type::eof();
  setg(text_.data(), text_.data(), text_.data() + text_.size());
  return traits_type::to_int_type(text_[0]);
}

}  // namespace talisman::sequences
