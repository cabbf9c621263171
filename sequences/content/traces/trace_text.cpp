// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/traces/trace_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <utility>

namespace talisman::sequences {

namespace {

constexpr std::size_t kBuffer_bytes = std::size_t{1} << 16U;
constexpr double kMostOfTrace = 1e9;

bool is_blank(int c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The digits of a decimal number and where its point stands among them.
struct Decimal {
  bool negative = false;
  std::string digits;
  long point = 0;
};

/// The exponent behind 'e'; nothing for what is none, or of no use.
std::optional<long> exponent_of(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  return whole && value >= -60 && value <= 60 ? std::optional(value) : std::nullopt;
}

std::optional<Decimal> decimal_of(std::string_view text) {
  Decimal decimal;
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    decimal.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  bool seen_point = false;
  std::size_t at = 0;
  for (; at < text.size() && (is_digit(text[at]) || text[at] == '.'); ++at) {
    if (text[at] != '.') {
      decimal.digits += text[at];
      decimal.point += !seen_point;
    } else if (std::exchange(seen_point, true)) {
      return std::nullopt;
    }
  }
  if (decimal.digits.empty()) return std::nullopt;
  if (at == text.size()) return decimal;
  if (text[at] != 'e' && text[at] != 'E') return std::nullopt;
  const std::optional<long> exponent = exponent_of(text.substr(at + 1));
  if (!exponent) return std::nullopt;
  decimal.point += *exponent;
  return decimal;
}

}  // namespace

TraceText::TraceText(std::string file) : file_(std::move(file)), buffer_(kBuffer_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file_, error)) throw InputError("is no file, rule: a trace", file_);
  in_.open(file_, std::ios::binary);
  if (!in_) throw InputError("cannot be opened, rule: a file that can be read", file_);
  if (peek() != 0xEF) return;
  for (int mark = 0; mark < 3; ++mark) get();  // of the byte order, as some editors leave it
}

bool TraceText::fill() {
  in_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  at_ = 0, end_ = static_cast<std::size_t>(in_.gcount());
  if (end_ == 0 && in_.bad()) fail("cannot be read any further, rule: a file that can be read");
  return end_ > 0;
}

int TraceText::peek() {
  if (at_ == end_ && !fill()) return -1;
  return static_cast<unsigned char>(buffer_[at_]);
}

int TraceText::get() {
  const int c = peek();
  if (c < 0) return c;
  ++at_;
  line_ += line_ended_;
  line_ended_ = c == '\n';
  return c;
}

bool TraceText::next_line(std::string_view& line) {
  if (peek() < 0) return false;
  text_.clear();
  for (int c = get(); c >= 0 && c != '\n'; c = get()) {
    if (text_.size() == kLongestLine)
      fail("has a line of more than " + std::to_string(kLongestLine) + " bytes, rule: shorter ones");
    text_ += static_cast<char>(c);
  }
  if (!text_.empty() && text_.back() == '\r') text_.pop_back();
  line = text_;
  return true;
}

void TraceText::skip_line() {
  for (int c = get(); c >= 0 && c != '\n'; c = get()) {
  }
}

bool TraceText::next_word(std::string_view& word) {
  while (is_blank(peek())) get();
  if (peek() < 0) return false;
  text_.clear();
  while (peek() >= 0 && !is_blank(peek())) {
    if (text_.size() == kLongestWord)
      fail("has a word of more than " + std::to_string(kLongestWord) + " bytes, rule: shorter ones");
    text_ += static_cast<char>(get());
  }
  word = text_;
  return true;
}

std::optional<double> trace_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && !word.empty() && end == word.data() + word.size();
  return whole && std::fabs(value) <= kMostOfTrace ? std::optional(value) : std::nullopt;
}

std::optional<Stamp> stamp_in_seconds(std::string_view word) {
  const std::optional<Decimal> decimal = decimal_of(word);
  if (!decimal) return std::nullopt;
  // Zeros in front and behind, so that the point stands among the digits.
  std::string digits = decimal->digits;
  long point = decimal->point;
  if (point < 0) digits.insert(0, static_cast<std::size_t>(-point), '0'), point = 0;
  const auto whole_digits = static_cast<std::size_t>(point);
  if (whole_digits > digits.size()) digits.append(whole_digits - digits.size(), '0');
  const std::string whole = "0" + digits.substr(0, whole_digits);
  Stamp stamp;
  const auto [end, error] = std::from_chars(whole.data(), whole.data() + whole.size(), stamp.whole_s);
  if (error != std::errc() || end != whole.data() + whole.size() || stamp.whole_s > 1'000'000'000'000'000)
    return std::nullopt;
  const std::string fraction = "0." + digits.substr(whole_digits) + "0";
  std::from_chars(fraction.data(), fraction.data() + fraction.size(), stamp.fraction_s);
  if (decimal->negative) stamp = {-stamp.whole_s, -stamp.fraction_s};
  return stamp;
}

std::optional<Stamp> stamp_in_nanoseconds(std::string_view word) {
  constexpr std::int64_t kPerSecond = 1'000'000'000;
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), ns);
  if (error != std::errc() || word.empty() || end != word.data() + word.size()) return std::nullopt;
  return Stamp{ns / kPerSecond, static_cast<double>(ns % kPerSecond) / kPerSecond};
}

std::string word_in_message(std::string_view word) {
  constexpr std::size_t kShown = 40;
  return "'" + std::string(word.substr(0, kShown)) + (word.size() > kShown ? "…'" : "'");
}

std::vector<std::string_view> words_of(std::string_view line, std::string_view between, std::size_t most) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(between); at != std::string_view::npos && words.size() < most;
       at = line.find_first_not_of(between, at)) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

}  // namespace talisman::sequences
