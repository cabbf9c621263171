// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

bool is_text_column(const Table& table, std::size_t column) {
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
  std::string operator()(const Table& table) const {
    std::string text = markdown_row(table.header) + "|";
    for (std::size_t k = 0; k < table.header.size(); ++k) text += is_text_column(table, k) ? "---|" : "---:|";
    text += "\n";
    for (const auto& row : table.rows) text += markdown_row(row);
    return text;
  }
  std::string operator()(const Figure& f) const { return "![" + f.caption + "](" + f.file + ")\n"; }
};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

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

struct HtmlWriter {
  std::string dir;
  int figures = 0;

  std::string operator()(const Heading& h) const {
    const std::string tag = "h" + std::to_string(h.level);
    return "<" + tag + ">" + escaped(h.text) + "</" + tag + ">\n";
  }
  std::string operator()(const Paragraph& p) const { return "<p>" + escaped(p.text) + "</p>\n"; }
  std::string operator()(const Table& table) const {
    std::string text = "<table>\n" + row(table, table.header, "th");
    for (const auto& cells : table.rows) text += row(table, cells, "td");
    return text + "</table>\n";
  }
  std::string operator()(const Figure& f) {
    const std::string prefix = "f" + std::to_string(++figures) + "-";
    return "<figure>\n" + with_own_ids(svg_element(dir + "/" + f.file), prefix) + "\n<figcaption>" +
           escaped(f.caption) + "</figcaption>\n</figure>\n";
  }

 private:
  static std::string row(const Table& table, const std::vector<std::string>& cells, const std::string& tag) {
    TALISMAN_CHECK_EQ(cells.size(), table.header.size());
    std::string text = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k)
      text += "<" + tag + (is_text_column(table, k) ? "" : " class=\"n\"") + ">" + escaped(cells[k]) + "</" +
              tag + ">";
    return text + "</tr>\n";
  }
};

std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string plain_text(const Table& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  std::vector<std::vector<std::string>> rows{table.header};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
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
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + escaped(page.title) +
      "</title>\n<style>\nbody { font: 15px/1.45 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 "
      "1em; }\n"
      "table { border-collapse: collapse; margin: 1em 0; }\nth, td { border-bottom: 1px solid #ccc; "
      "padding: 0.2em 0.7em; text-align: left; vertical-align: top; }\n.n { text-align: right; "
      "font-variant-numeric: tabular-nums; }\nfigure { margin: 1.5em 0; }\nfigcaption { color: #444; }\n"
      "svg { max-width: 100%; height: auto; }\n</style>\n</head>\n<body>\n<h1>" +
      escaped(page.title) + "</h1>\n";
  HtmlWriter writer{dir};
  for (const Block& block : page.blocks) text += std::visit(writer, block);
  return text + "</body>\n</html>\n";
}

}  // namespace talisman::sequences
