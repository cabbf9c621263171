// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A page of results, written once and printed twice: as Markdown, and as one self-contained HTML file with
/// its figures inside.

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
struct Paragraph {
  std::string text;
};
/// Every row has as many cells as the header. Columns after the first `text_columns` are right-aligned.
struct PageTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  int text_columns = 1;
};
/// DIR/<file>, an SVG picture.
struct Figure {
  std::string file, caption;
};
using Block = std::variant<Heading, Paragraph, PageTable, Figure>;

struct Page {
  std::string title;
  std::vector<Block> blocks;
};

/// The table in columns for a terminal. UTF-8 aware: one column per code point.
std::string plain_text(const PageTable& table);

/// Figures are references to their files, which lie beside the page.
std::string markdown(const Page& page);

/// Figures are read from `dir` and put into the page. Throws OutputError when one is not there.
std::string html(const Page& page, const std::string& dir);

}  // namespace talisman::sequences
