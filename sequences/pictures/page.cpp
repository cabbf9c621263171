// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "layers/check.h"
#include "sequences/files/atomic_file.h"
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
  std::string operator()(const Verbatim& v) const { return "```\n" + v.text + "```\n"; }
  std::string operator()(const Figure& f) const { return "![" + f.caption + "](" + f.file + ")\n"; }
};

/// Empty: not in a terminal.
struct TerminalWriter {
  std::string operator()(const Heading& h) const { return harmless(h.text) + "\n"; }
  std::string operator()(const Paragraph& p) const { return harmless(p.text, true) + "\n"; }
  std::string operator()(const PageTable& table) const { return plain_text(table); }
  std::string operator()(const Verbatim& v) const {
    std::string text, line;
    for (std::istringstream lines(v.text); std::getline(lines, line);) text += "    " + harmless(line) + "\n";
    return text;
  }
  std::string operator()(const Figure&) const { return {}; }
};

/// Words stand on what they are about: a heading on anything, a paragraph on a table.
bool stands_on(const Block& above, const Block& below) {
  return std::holds_alternative<Heading>(above) ||
         (std::holds_alternative<Paragraph>(above) && std::holds_alternative<PageTable>(below));
}

/// A picture that was written before the page.
std::string bytes_of_figure(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) throw OutputError(file + ": is not there, rule: a picture");
  return content.str();
}

/// The picture without its XML prolog, which may only stand at the beginning of a document.
std::string svg_element(const std::string& file) {
  const std::string text = bytes_of_figure(file);
  const std::size_t start = text.find("<svg");
  if (start == std::string::npos) throw OutputError(file + ": is no picture, rule: SVG");
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
  int figures = 0, tables = 0, texts = 0, sections = 0;
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
    for (std::size_t k = 0; k < table.links.size(); ++k)
      if (!table.links[k].empty())
        rows[k][0] = "<a href=\"" + escaped(table.links[k]) + "\">" + rows[k][0] + "</a>";
    const std::string number = std::to_string(++tables);
    return html_table("t" + number, "", all_escaped(table.header), rows, table.text_columns,
                      "table " + number + (heading.empty() ? "" : ": " + escaped(heading)));
  }
  std::string operator()(const Verbatim& v) {
    return "<pre class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"lines " +
           std::to_string(++texts) + "\">" + escaped(v.text) + "</pre>\n";
  }
  std::string operator()(const Figure& f) {
    const std::string file = dir + "/" + f.file, caption = escaped(f.caption);
    return in_figure(f.file.ends_with(".png") ? "<img alt=\"" + caption + "\" src=\"data:image/png;base64," +
                                                    base64(bytes_of_figure(file)) + "\">"
                                              : drawing(file, caption, f.links),
                     caption);
  }

 private:
  static std::string in_figure(const std::string& picture, const std::string& caption) {
    return "<figure>\n" + picture + "\n<figcaption>" + caption + "</figcaption>\n</figure>\n";
  }
  /// A picture with links in it is a group of them to who cannot see it.
  std::string drawing(const std::string& file, const std::string& caption,
                      const std::vector<FigureLink>& links) {
    std::string svg = with_own_ids(svg_element(file), "f" + std::to_string(++figures) + "-");
    if (svg.find(" role=") == std::string::npos)
      svg.insert(std::string("<svg").size(), std::string(" role=\"") + (links.empty() ? "img" : "group") +
                                                 "\" aria-label=\"" + caption + "\"");
    std::string places;
    for (const FigureLink& link : links)
      places += "<a href=\"" + escaped(link.href) + "\" aria-label=\"" + escaped(link.words) +
                "\"><circle cx=\"" + fixed(link.x_px, 1) + "\" cy=\"" + fixed(link.y_px, 1) +
                "\" r=\"8\"/><title>" + escaped(link.words) + "</title></a>\n";
    if (const std::size_t end = svg.rfind("</svg>"); end != std::string::npos) svg.insert(end, places);
    return svg;
  }
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

std::string plain_text(const Page& page) {
  std::string text;
  const Block* above = nullptr;
  for (const Block& block : page.blocks) {
    const std::string words = std::visit(TerminalWriter{}, block);
    if (words.empty()) continue;
    text += (above && !stands_on(*above, block) ? "\n" : "") + words;
    above = &block;
  }
  return page.verdict.empty() ? text : text + (above ? "\n" : "") + harmless(page.verdict, true) + "\n";
}

std::string markdown(const Page& page) {
  std::string text = "# " + page.title + "\n";
  if (!page.verdict.empty()) text += "\n**" + page.verdict + "**\n";
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
  const std::string verdict =
      page.verdict.empty() ? "" : "<p class=\"verdict\" id=\"verdict\">" + escaped(page.verdict) + "</p>\n";
  return filled(page_asset("experiment.html"), {{"title", escaped(page.title)},
                                                {"css", std::string(page_asset("page.css"))},
                                                {"verdict", verdict},
                                                {"contents", contents},
                                                {"body", body},
                                                {"script", std::string(page_asset("theme.js"))}});
}

void write_page(const Page& page, const std::string& dir) {
  write_text_atomically(dir + "/" + page.file, html(page, dir));
}

}  // namespace talisman::sequences
