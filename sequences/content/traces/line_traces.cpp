// SPDX-License-Identifier: Apache-2.0
// Traces with a pose on each line: TUM and EuRoC.
#include <array>

#include "sequences/content/traces/trace_readers.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kWords = 8;

/// Is there a pose on the line, behind blanks?
bool holds_pose(std::string_view line) {
  const std::size_t at = line.find_first_not_of(" \t");
  return at != std::string_view::npos && line[at] != '#';
}

/// Words 1 … 7.
std::array<double, kWords - 1> numbers_of(const TraceText& text, const std::vector<std::string_view>& words) {
  std::array<double, kWords - 1> numbers{};
  for (std::size_t i = 1; i < kWords; ++i) {
    const std::optional<double> number = trace_number(words[i]);
    if (!number)
      text.fail("word " + std::to_string(i + 1) + " is " + word_in_message(words[i]) +
                ", rule: a number from -1e9 to 1e9");
    numbers[i - 1] = *number;
  }
  return numbers;
}

[[noreturn]] void fail_at_stamp(const TraceText& text, std::string_view word, const char* rule) {
  text.fail("stamp is " + word_in_message(word) + ", rule: " + rule);
}

}  // namespace

void read_tum(TraceText& text, const PoseSink& sink) {
  for (std::string_view line; text.next_line(line);) {
    if (!holds_pose(line)) continue;
    const std::vector<std::string_view> words = words_of(line, " \t", kWords + 1);
    if (words.size() != kWords)
      text.fail("has " + std::string(words.size() > kWords ? "more than 8" : std::to_string(words.size())) +
                " words, rule: t tx ty tz qx qy qz qw");
    const std::optional<Stamp> stamp = stamp_in_seconds(words[0]);
    if (!stamp) fail_at_stamp(text, words[0], "seconds");
    const auto n = numbers_of(text, words);
    if (!sink({*stamp, {n[0], n[1], n[2]}, glm::dquat(n[6], n[3], n[4], n[5]), text.line()})) return;
  }
}

void read_euroc(TraceText& text, const PoseSink& sink) {
  for (std::string_view line; text.next_line(line);) {
    if (!holds_pose(line)) continue;
    const std::vector<std::string_view> words = words_of(line, ", \t", kWords);
    if (words.size() != kWords)
      text.fail("has " + std::to_string(words.size()) +
                " values, rule: t,px,py,pz,qw,qx,qy,qz and what follows");
    const std::optional<Stamp> stamp = stamp_in_nanoseconds(words[0]);
    if (!stamp) fail_at_stamp(text, words[0], "whole nanoseconds");
    const auto n = numbers_of(text, words);
    if (!sink({*stamp, {n[0], n[1], n[2]}, glm::dquat(n[3], n[4], n[5], n[6]), text.line()})) return;
  }
}

}  // namespace talisman::sequences
