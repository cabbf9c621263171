// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/report.h"

#include <ostream>

#include <nlohmann/json.hpp>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/named_values.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

std::string shape_words(const ReproducedRow& row) {
  return std::string(name(row.shape)) + (row.derived ? ", derived" : "");
}

PageTable table_of(const ReproducedItem& item) {
  PageTable table{{"row", "the paper", "ours", "same shape?"}, {}, 4};
  for (const ReproducedRow& row : item.rows)
    table.rows.push_back(
        {row.id.substr(row.id.find('/') + 1), row.paper, row.finding.ours, shape_words(row)});
  return table;
}

/// The sequences on which an item's rows are tried.
std::string sequences_of(const ReproducedItem& item) {
  for (const ReproducedRow& row : item.rows)
    if (!row.sequence.empty()) return row.sequence;
  return {};
}

std::string heading_of(const ReproducedItem& item) {
  const std::string sequence = sequences_of(item);
  return item.id + "  " + item.title + (sequence.empty() ? "" : " (ours: " + sequence + ")");
}

std::string why_words(const ReproducedRow& row) {
  return row.id + " says no (rule: " + row.rule + "); " +
         (row.why.empty() ? "there is no second experiment" : row.why);
}

std::string counts_of(const Reproduction& reproduction) {
  std::string text = std::to_string(reproduction.count(Shape::Same)) + " rows say yes, " +
                     std::to_string(reproduction.count(Shape::Other)) + " no, " +
                     std::to_string(reproduction.count(Shape::NotMeasured)) + " are not measured";
  if (reproduction.left_out > 0)
    text += ", " + std::to_string(reproduction.left_out) + " draw pictures and are left out by --quick";
  return text;
}

Json json_of_row(const ReproducedRow& row) {
  Json json{{"id", row.id}, {"paper", row.paper}, {"ours", row.finding.ours}, {"rule", row.rule}};
  json["same"] = row.shape == Shape::NotMeasured ? Json(nullptr) : Json(row.shape == Shape::Same);
  json["derived"] = row.derived;
  json["must"] = row.must;
  json["sequence"] = row.sequence.empty() ? Json(nullptr) : Json(row.sequence);
  json["why"] = row.why.empty() ? Json(nullptr) : Json(row.why);
  json["numbers"] = Json::object();
  for (const auto& [name, value] : row.finding.numbers) json["numbers"][name] = number_or_null(value);
  return json;
}

std::string numbers_csv(const Reproduction& reproduction) {
  std::string csv = "id,name,value\n";
  for (const ReproducedItem& item : reproduction.items)
    for (const ReproducedRow& row : item.rows)
      for (const auto& [name, value] : row.finding.numbers)
        csv += row.id + "," + quoted(name) + "," + exact(value) + "\n";
  return csv;
}

void add_item(Page& page, const ReproducedItem& item) {
  page.blocks.push_back(Heading{2, heading_of(item)});
  page.blocks.push_back(table_of(item));
  for (const ReproducedRow& row : item.rows)
    if (row.shape == Shape::Other) page.blocks.push_back(Paragraph{why_words(row) + "."});
  for (const PaperFigure& drawing : item.drawings)
    page.blocks.push_back(Figure{drawing.file + ".svg", drawing.caption});
}

Page page_of(const Reproduction& reproduction) {
  Page page;
  page.title = "Results of papers, and ours";
  page.file = "reproduce.html";
  page.verdict = counts_of(reproduction) + ".";
  for (const std::string& paper : reproduction.papers) page.blocks.push_back(Paragraph{paper});
  page.blocks.push_back(
      Paragraph{"The scenes of the papers are lost: what can agree is the shape, by the rule of each row."});
  for (const ReproducedItem& item : reproduction.items) add_item(page, item);
  return page;
}

}  // namespace

std::string reproduction_csv(const Reproduction& reproduction) {
  std::string csv = "id,paper,ours,same,rule,sequence,derived,must,why\n";
  for (const ReproducedItem& item : reproduction.items)
    for (const ReproducedRow& row : item.rows)
      csv += row.id + "," + quoted(row.paper) + "," + quoted(row.finding.ours) + "," +
             quoted(std::string(name(row.shape))) + "," + quoted(row.rule) + "," + row.sequence + "," +
             (row.derived ? "1," : "0,") + (row.must ? "1," : "0,") + quoted(row.why) + "\n";
  return csv;
}

std::string json_of(const Reproduction& reproduction) {
  Json json{
      {"schema", "talisman.reproduce/1"}, {"quick", reproduction.quick}, {"papers", reproduction.papers}};
  json["yes"] = reproduction.count(Shape::Same);
  json["no"] = reproduction.count(Shape::Other);
  json["not_measured"] = reproduction.count(Shape::NotMeasured);
  json["left_out"] = reproduction.left_out;
  json["items"] = Json::array();
  for (const ReproducedItem& item : reproduction.items) {
    Json entry{{"id", item.id}, {"title", item.title}, {"rows", Json::array()}, {"figures", Json::array()}};
    for (const ReproducedRow& row : item.rows) entry["rows"].push_back(json_of_row(row));
    for (const PaperFigure& drawing : item.drawings)
      entry["figures"].push_back({{"file", drawing.file + ".svg"}, {"caption", drawing.caption}});
    json["items"].push_back(entry);
  }
  return json.dump(2) + "\n";
}

void write_report(const Reproduction& reproduction, const std::string& dir) {
  for (const ReproducedItem& item : reproduction.items)
    for (const PaperFigure& drawing : item.drawings) write_plot(dir, drawing.file, drawing.plot, kLargePlot);
  write_text_atomically(dir + "/reproduce.csv", reproduction_csv(reproduction));
  write_text_atomically(dir + "/numbers.csv", numbers_csv(reproduction));
  write_page(page_of(reproduction), dir);
  write_text_atomically(dir + "/reproduce.json", json_of(reproduction));
}

void print_report(const Reproduction& reproduction, std::ostream& out) {
  for (const ReproducedItem& item : reproduction.items) {
    out << heading_of(item) << "\n" << plain_text(table_of(item)) << "\n";
    bool any = false;
    for (const ReproducedRow& row : item.rows) {
      if (row.shape != Shape::Other) continue;
      out << "  " << why_words(row) << "\n";
      any = true;
    }
    if (any) out << "\n";
  }
  out << counts_of(reproduction) << "\n";
}

}  // namespace talisman::sequences
