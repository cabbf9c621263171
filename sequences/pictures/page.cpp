// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "layers/check.h"
#include "sequences/files/terminal_text.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/pictures/page_text.h"

namespace talisman::sequences {
namespace {

bool is_text_column(const PageTable& table, std::size_t column) {
  return static_cast<int>(column) < table.text_columns;
}

/// A bar would end the cell.
std::string markdown_cell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + markdown_cell(cell) + " |";
  return row + "\n";
}

struct MarkdownWriter {
  std::string operator()(const Heading& h) const { return std::string(h.level, '#') + " " + h.text + "\n"; }
  std::string operator()(const Paragraph& p) const { return p.text + "\n"; }
  std::string operator()(const PageTable& table) const {
    std::string text = markdown_row(table.header) + "|";
    for (std::size_t k = 0; k < table.header.size(); ++k) text += is_text_column(table, k) ? "---|" : "---:|";
    text += "\n";
    for (const auto& row : table.rows) text += markdown_row(row);
    return text;
  }
  std::string operator()(const Figure& f) const { return "![" + f.caption + "](" + f.file + ")\n"; }
};

/// The picture without its XML prolog, which may only stand at the beginning of a document.
std::string svg_element(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  const std::string text = content.str();
  const std::size_t start = text.find("<svg");
  if (!in || start == std::string::npos) throw OutputError(file + ": is not there, rule: an SVG picture");
  return text.substr(start);
}

/// Identifiers are unique in a page, but gnuplot gives the same ones to each of its pictures.
std::string with_own_ids(std::string svg, const std::string& prefix) {
  for (const std::string mark : {"id=\"", "id='", "href='#", "href=\"#", "url(#"}) {
    for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1))
      svg.insert(at + mark.size(), prefix);
  }
  return svg;
}

/// Writes block after block; headings of the second level can be linked to.
struct HtmlWriter {
  std::string dir;
  int figures = 0, tables = 0, sections = 0;
  std::string heading{}, contents{};

  std::string operator()(const Heading& h) {
    const std::string tag = "h" + std::to_string(h.level);
    heading = h.text;
    if (h.level != 2) return "<" + tag + ">" + escaped(h.text) + "</" + tag + ">\n";
    const std::string id = "s" + std::to_string(++sections);
    contents += "<li><a href=\"#" + id + "\">" + escaped(h.text) + "</a></li>\n";
    return "<h2 id=\"" + id + "\">" + escaped(h.text) + "</h2>\n";
  }
  std::string operator()(const Paragraph& p) const { return "<p>" + escaped(p.text) + "</p>\n"; }
  std::string operator()(const PageTable& table) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& cells : table.rows) {
      TALISMAN_CHECK_EQ(cells.size(), table.header.size());
      rows.push_back(all_escaped(cells));
    }
    const std::string number = std::to_string(++tables);
    return html_table("t" + number, "", all_escaped(table.header), rows, table.text_columns,
                      "table " + number + (heading.empty() ? "" : ": " + escaped(heading)));
  }
  std::string operator()(const Figure& f) {
    const std::string prefix = "f" + std::to_string(++figures) + "-", caption = escaped(f.caption);
    std::string svg = with_own_ids(svg_element(dir + "/" + f.file), prefix);
    if (svg.find(" role=") == std::string::npos)
      svg.insert(std::string("<svg").size(), " role=\"img\" aria-label=\"" + caption + "\"");
    return "<figure>\n" + svg + "\n<figcaption>" + caption + "</figcaption>\n</figure>\n";
  }

 private:
  static std::vector<std::string> all_escaped(std::vector<std::string> cells) {
    for (std::string& cell : cells) cell = escaped(cell);
    return cells;
  }
};

std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string plain_text(const PageTable& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  std::vector<std::vector<std::string>> rows{table.header};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  for (auto& row : rows)
    for (std::string& cell : row) cell = harmless(cell);
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], columns_of(row[k]));
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string space(widths[k] - columns_of(row[k]), ' ');
      line += (k ? "  " : "") + (is_text_column(table, k) ? row[k] + space : space + row[k]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string markdown(const Page& page) {
  std::string text = "# " + page.title + "\n";
  for (const Block& block : page.blocks) text += "\n" + std::visit(MarkdownWriter{}, block);
  return text;
}

std::string html(const Page& page, const std::string& dir) {
  constexpr int kFewSections = 3;
  HtmlWriter writer{dir};
  std::string body;
  for (const Block& block : page.blocks) body += std::visit(writer, block);
  const std::string contents = writer.sections <= kFewSections ? ""
                                                               : "<nav aria-label=\"contents\"><ul>\n" +
                                                                     writer.contents + "</ul></nav>\n";
  return filled(page_asset("experiment.html"), {{"title", escaped(page.title)},
                                                {"css", std::string(page_asset("page.css"))},
                                                {"contents", contents},
                                                {"body", body},
                                                {"script", std::string(page_asset("theme.js"))}});
}

}  // namespace talisman::sequences
