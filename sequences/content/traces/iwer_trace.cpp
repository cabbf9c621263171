// SPDX-License-Identifier: Apache-2.0
// What the action recorder of npm iwer logs: {"schema": …, "frames": [[ms, px, py, pz, qx, qy, qz, qw, inputs…], …]}.
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "sequences/content/traces/trace_readers.h"

namespace talisman::sequences {

namespace {

/// The characters of a text for the parser. A number or string without end would be held whole: it is an error.
class Characters {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  Characters() = default;
  explicit Characters(TraceText& text) : text_(&text) {}
  char operator*() const { return static_cast<char>(text_->peek()); }
  Characters& operator++() {
    const int c = text_->get();
    if (in_string_ ? c == '"' && !escaped_ : c == '"') in_string_ = !in_string_, run_ = 0;
    escaped_ = in_string_ && c == '\\' && !escaped_;
    const bool ends_word =
        !in_string_ && (c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == ':');
    run_ = ends_word ? 0 : run_ + 1;
    if (run_ > kLongestLine) text_->fail("has a word without end, rule: at most 4096 bytes");
    return *this;
  }
  bool operator==(const Characters& other) const { return at_end() == other.at_end(); }
  bool operator!=(const Characters& other) const { return !(*this == other); }

 private:
  bool at_end() const { return !text_ || text_->peek() < 0; }

  TraceText* text_ = nullptr;
  bool in_string_ = false, escaped_ = false;
  std::size_t run_ = 0;
};

/// Follows the parser: the numbers in the lists that are the entries of `frames` at the top.
class RecordingReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  RecordingReader(const TraceText& text, const PoseSink& sink) : text_(text), sink_(sink) {}

  bool found_frames() const { return found_; }

  bool null() override { return no_number("null"); }
  bool boolean(bool) override { return no_number("a truth"); }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t&) override { return no_number("a text"); }
  bool binary(binary_t&) override { return no_number("bytes"); }
  bool key(string_t& key) override {
    if (depth_ == 1) is_frames_ = key == "frames";
    return true;
  }
  bool start_object(std::size_t) override { return deeper(false); }
  bool end_object() override { return --depth_, true; }
  bool start_array(std::size_t) override { return deeper(true); }
  bool end_array() override {
    const bool ends_entry = in_frames_ && depth_ == 3;
    if (in_frames_ && depth_ == 2) in_frames_ = false;
    --depth_;
    return !ends_entry || pose();
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    text_.fail("is no JSON up to its end, rule: what the action recorder of iwer logs");
  }

 private:
  bool deeper(bool is_list) {
    if (depth_ == 64) text_.fail("has lists in lists in lists …, rule: at most 64 deep");
    if (depth_ == 0 && is_list) text_.fail("is a list, rule: a map with `frames`");
    if (depth_ == 1 && is_frames_) {
      if (!is_list || found_) text_.fail("has `frames` that are no list, or twice, rule: one list of lists");
      found_ = in_frames_ = true;
    } else if (in_frames_ && depth_ == 2) {
      if (!is_list) text_.fail("frame " + std::to_string(frame_) + " is a map, rule: a list of numbers");
      count_ = 0;
    } else if (in_frames_ && depth_ == 3 && count_ < kNumbers) {
      no_number("a list");
    }
    ++depth_;
    return true;
  }
  bool number(double value) {
    if (!in_frames_) return true;
    if (depth_ == 2) no_number("no list");
    if (depth_ != 3 || count_ >= kNumbers) return true;
    if (!(std::fabs(value) <= 1e9)) no_number("a number beyond 1e9");
    numbers_[count_++] = value;
    return true;
  }
  bool no_number(const char* what) const {
    if (in_frames_ && (depth_ == 2 || (depth_ == 3 && count_ < kNumbers)))
      text_.fail("frame " + std::to_string(frame_) + " has " + what + " as value " + std::to_string(count_) +
                 ", rule: a list of ms, px, py, pz, qx, qy, qz, qw and what follows");
    return true;
  }
  bool pose() {
    if (count_ < kNumbers)
      text_.fail("frame " + std::to_string(frame_) + " has " + std::to_string(count_) +
                 " numbers, rule: ms, px, py, pz, qx, qy, qz, qw and what follows");
    ++frame_;
    const double* n = numbers_;
    return sink_({{0, n[0] / 1000}, {n[1], n[2], n[3]}, glm::dquat(n[7], n[4], n[5], n[6]), text_.line()});
  }

  static constexpr int kNumbers = 8;
  const TraceText& text_;
  const PoseSink& sink_;
  int depth_ = 0, count_ = 0, frame_ = 0;
  bool is_frames_ = false, in_frames_ = false, found_ = false;
  double numbers_[kNumbers] = {};
};

}  // namespace

void read_iwer(TraceText& text, const PoseSink& sink) {
  RecordingReader reader(text, sink);
  const bool to_its_end = nlohmann::json::sax_parse(Characters(text), Characters(), &reader);
  if (to_its_end && !reader.found_frames())
    text.fail("has no `frames`, rule: what the action recorder of iwer logs");
}

}  // namespace talisman::sequences
