// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The text of a trace file, read as a stream: by lines, by words or by characters, with the line where it stands.
///
/// What is kept is a buffer of 64 KiB and the line or word at hand, whatever the file: a line that is asked for has at
/// most `kLongestLine` bytes, a word `kLongestWord`. What is longer is an error that names the line.

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sequences/files/errors.h"

namespace talisman::sequences {

inline constexpr std::size_t kLongestLine = 4096, kLongestWord = 256;

class TraceText {
 public:
  /// Throws InputError for what is no file or cannot be opened.
  explicit TraceText(std::string file);
  TraceText(const TraceText&) = delete;
  TraceText& operator=(const TraceText&) = delete;

  /// The next line without its end, valid until the next call; false at the end of the file.
  bool next_line(std::string_view& line);
  /// Past the next line, however long it is.
  void skip_line();
  /// The next word between blanks and line ends; false at the end of the file.
  bool next_word(std::string_view& word);
  int peek();  ///< the next character; -1 at the end of the file
  int get();   ///< likewise, and past it

  int line() const { return line_; }  ///< from 1, of what was read last
  const std::string& file() const { return file_; }
  /// "FILE:LINE: what".
  [[noreturn]] void fail(const std::string& what) const { throw InputError(what, file_, line_); }

 private:
  bool fill();

  std::string file_;
  std::ifstream in_;
  std::vector<char> buffer_;
  std::size_t at_ = 0, end_ = 0;
  int line_ = 1;
  bool line_ended_ = false;  ///< the last character read ended its line
  std::string text_;         ///< the line or word at hand
};

/// Finite, at most 1e9 in magnitude; else nothing. "+1", "1e-3" and ".5" are numbers.
std::optional<double> trace_number(std::string_view word);

/// A time as it is written, to the last digit: stamps of clocks count from 1970, and a double would be 0.2 µs off.
struct Stamp {
  std::int64_t whole_s = 0;
  double fraction_s = 0;  ///< of the same sign
  double since(const Stamp& start) const {
    return static_cast<double>(whole_s - start.whole_s) + (fraction_s - start.fraction_s);
  }
};
/// "1305031102.175304", also with an exponent; nothing for what is no number or beyond ±1e15 s.
std::optional<Stamp> stamp_in_seconds(std::string_view word);
/// Whole nanoseconds.
std::optional<Stamp> stamp_in_nanoseconds(std::string_view word);

/// A word in a message: cut off after 40 bytes, in quotes.
std::string word_in_message(std::string_view word);

/// The words of a line, between any of the characters of `between`; at most `most` of them.
std::vector<std::string_view> words_of(std::string_view line, std::string_view between, std::size_t most);

}  // namespace talisman::sequences
