// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An OBJ as its readers want it: one statement per line.
///
///   - UTF-8 without a byte order mark; UTF-16 becomes it (wide_text.h)
///   - a line that ends with '\' goes on in the next one; ends of lines are those of any system
///   - what follows '#' is left out where numbers stand (names may hold one); "fo" is "f"
///
/// Source: Wavefront, "Advanced Visualizer manual", appendix B1 (1995).

#include <istream>
#include <memory>
#include <streambuf>
#include <string>

namespace talisman::sequences {

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
