// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A page of results, written once and shown three ways: as one self-contained HTML file with its figures inside, in
/// a terminal, and as Markdown.

#include <string>
#include <variant>
#include <vector>

#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

struct Heading {
  int level = 2;  ///< 1 … 4
  std::string text;
};
/// Its lines stay lines.
struct Paragraph {
  std::string text;
};
/// Every row has as many cells as the header. Columns after the first `text_columns` are right-aligned.
struct PageTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  int text_columns = 1;
  std::vector<std::string> links{};  ///< what the first cell of each row opens; empty: no row opens anything
};
/// As it is, to be copied.
struct Verbatim {
  std::string text;
};
/// A place of an SVG picture that opens something, in the pixels of its viewBox.
struct FigureLink {
  double x_px = 0, y_px = 0;
  std::string words, href;
};
/// DIR/<file>, an SVG or PNG picture.
struct Figure {
  std::string file, caption;
  std::vector<FigureLink> links{};
};
using Block = std::variant<Heading, Paragraph, PageTable, Verbatim, Figure>;

struct Page {
  std::string title;
  std::vector<Block> blocks{};
  std::string
      verdict{};  ///< what was found, in one sentence: on top of the page, last in a terminal; empty: none
  std::string file{};  ///< of the HTML in its folder: "tune.html"
};

/// The table in columns for a terminal. UTF-8 aware: one column per code point.
std::string plain_text(const PageTable& table);

/// The page without its pictures, for a terminal.
std::string plain_text(const Page& page);

/// Figures are references to their files, which lie beside the page.
std::string markdown(const Page& page);

/// Figures are read from `dir` and put into the page. Throws OutputError when one is not there.
std::string html(const Page& page, const std::string& dir);

/// The same as DIR/<page.file>. Throws OutputError.
void write_page(const Page& page, const std::string& dir);

}  // namespace talisman::sequences
