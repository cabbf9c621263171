// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An OBJ as its readers want it: one statement per line.
///
///   - UTF-8 without a byte order mark; UTF-16 becomes it (wide_text.h)
///   - a line that ends with '\' goes on in the next one; ends of lines are those of any system
///   - what follows '#' is left out where numbers stand (names may hold one); "fo" is "f"
///   - the name of a material ("usemtl dark red") is one word: its spaces are kKeptSpace
///
/// Source: Wavefront, "Advanced Visualizer manual", appendix B1 (1995).

#include <istream>
#include <memory>
#include <streambuf>
#include <string>

namespace talisman::sequences {

/// Of two materials "dark red" and "dark blue" the geometry's reader would make one, "dark".
inline constexpr char kKeptSpace = '\x1F';

/// What is in `line` from there on, without the space around it.
std::string rest_of_line(const std::string& line, std::size_t from);

/// Cleans while it is read, some thousand bytes at a time.
class ObjText : public std::streambuf {
 public:
  /// `before`: a line of our own, before those of the file; empty: none.
  explicit ObjText(std::unique_ptr<std::istream> from, const std::string& before = "");

 protected:
  int_type underflow() override;

 private:
  void add_line(std::string& line);
  void add_statement(const std::string& line);

  std::unique_ptr<std::istream> from_;
  bool is_first_ = true;
  std::string line_, begun_, text_;
};

}  // namespace talisman::sequences
