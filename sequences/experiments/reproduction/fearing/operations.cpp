// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/fearing/operations.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

struct Cost {
  double multiplications = 0, additions = 0;
};
constexpr Cost kConcatenation{64, 48}, kVertex{12, 12}, kNormal{9, 6}, kLocalLight{60, 18},
    kInfiniteLight{15, 7}, kSecondVertex{8, 6}, kViewport{2, 2};
constexpr double kThings = 1000, kLights = 4, kSumOfLights = 9, kClipTests = 6, kProjection = 11,
                 kPredictedProjection = 10, kSubtractions = 2, kComparisons = 5, kBytes = 4;

double kilobytes(double numbers) { return numbers * kBytes / 1024; }

/// Collects the cells of one table.
class Cells {
 public:
  Cells(std::vector<OperationCell>& all, std::string table) : all_(all), table_(std::move(table)) {}
  Cells& cell(const std::string& what, double printed, double ours, double tolerance = 0) {
    all_.push_back({table_, what, printed, ours, tolerance});
    return *this;
  }
  Cells& pair(const std::string& what, Cost printed, double elements, Cost each) {
    return cell(what + ", mults", printed.multiplications, elements * each.multiplications)
        .cell(what + ", adds", printed.additions, elements * each.additions);
  }

 private:
  std::vector<OperationCell>& all_;
  std::string table_;
};

using PerScenario = std::array<Cost, 4>;

/// A table with a row of multiplications and additions for each scenario.
void add_pairs(std::vector<OperationCell>& all, const std::string& table, const PerScenario& printed,
               double (*elements)(const Scenario96&), Cost each, const std::string& kind = "") {
  Cells cells(all, table);
  for (std::size_t i = 0; i < printed.size(); ++i)
    cells.pair(scenarios_96()[i].name + kind, printed[i], elements(scenarios_96()[i]), each);
}

double vertices(const Scenario96& s) { return s.vertices(); }
double normals(const Scenario96& s) { return s.normals; }
double polygons(const Scenario96& s) { return s.polygons; }
double things(const Scenario96&) { return kThings; }
double predicted(const Scenario96& s) { return s.prediction_vertices; }

void add_sizes(std::vector<OperationCell>& all) {
  const std::array<double, 4> counts{1e3, 6e3, 144e3, 300e3}, corners{4e3, 24e3, 576e3, 1.2e6};
  const std::array<double, 4> rendered_kb{93.8, 351.6, 13500, 28125}, predicted_kb{46.9, 93.8, 70.3, 70.3};
  const std::array<double, 4> rendered{24e3, 90e3, 3'456e3, 7.2e6}, floats{12e3, 24e3, 18e3, 18e3};
  for (std::size_t i = 0; i < 4; ++i) {
    const Scenario96& s = scenarios_96()[i];
    Cells(all, "4.2")
        .cell(s.name + ", polygons", counts[i], s.polygons)
        .cell(s.name + ", vertices", corners[i], s.vertices());
    const double numbers = 3 * (s.vertices() + s.normals);
    Cells(all, "4.3")
        .cell(s.name + ", floats", rendered[i], numbers)
        .cell(s.name + ", KB", rendered_kb[i], kilobytes(numbers), 0.06);
    const double few = 3 * s.prediction_vertices;
    Cells(all, "4.4")
        .cell(s.name + ", floats", floats[i], few)
        .cell(s.name + ", KB", predicted_kb[i], kilobytes(few), 0.06);
  }
}

void add_stages(std::vector<OperationCell>& all) {
  const PerScenario worst{{{64e3, 48e3}, {384e3, 288e3}, {9'216e3, 6'912e3}, {19.2e6, 14.4e6}}};
  const PerScenario once{{{64e3, 48e3}, {64e3, 48e3}, {64e3, 48e3}, {64e3, 48e3}}};
  add_pairs(all, "4.5", worst, polygons, kConcatenation, " (worst)");
  add_pairs(all, "4.5", once, things, kConcatenation, " (better)");
  add_pairs(all, "4.6", once, things, kConcatenation);
  add_pairs(all, "4.7", {{{48e3, 48e3}, {288e3, 288e3}, {6'912e3, 6'912e3}, {14.4e6, 14.4e6}}}, vertices,
            kVertex);
  add_pairs(all, "4.8", {{{48e3, 48e3}, {96e3, 96e3}, {72e3, 72e3}, {72e3, 72e3}}}, predicted, kVertex);
  add_pairs(all, "4.9", {{{36e3, 24e3}, {54e3, 36e3}, {5'184e3, 3'456e3}, {10.8e6, 7.2e6}}}, normals,
            kNormal);
  add_pairs(all, "4.10", {{{240e3, 72e3}, {1'440e3, 432e3}, {34'560e3, 10'368e3}, {72.2e6, 21.6e6}}},
            vertices, kLocalLight, " (local)");
  add_pairs(all, "4.10", {{{60e3, 28e3}, {360e3, 168e3}, {8'640e3, 4'032e3}, {18e6, 8.4e6}}}, vertices,
            kInfiniteLight, " (infinite)");
  add_pairs(all, "4.11", {{{960e3, 324e3}, {5'760e3, 1'944e3}, {138'240e3, 46'656e3}, {288e6, 97.2e6}}},
            vertices, {kLights * 60, kLights * 18 + kSumOfLights}, " (local)");
  add_pairs(all, "4.11", {{{240e3, 148e3}, {1'440e3, 888e3}, {34'560e3, 21'130e3}, {72e6, 44.4e6}}}, vertices,
            {kLights * 15, kLights * 7 + kSumOfLights}, " (infinite)");
  add_pairs(all, "4.12", {{{32e3, 24e3}, {192e3, 144e3}, {4'608e3, 3'456e3}, {9.6e6, 7.2e6}}}, vertices,
            kSecondVertex);
  add_pairs(all, "4.16", {{{8e3, 8e3}, {48e3, 48e3}, {1'152e3, 1'152e3}, {2.4e6, 2.4e6}}}, vertices,
            kViewport);
}

void add_tests(std::vector<OperationCell>& all) {
  const std::array<double, 4> clip{24e3, 144e3, 3'456e3, 7.2e6}, project{44e3, 264e3, 6'336e3, 13.2e6};
  const std::array<double, 4> few{40e3, 80e3, 60e3, 60e3}, subtract{8e3, 16e3, 12e3, 12e3},
      compare{20e3, 40e3, 30e3, 30e3};
  for (std::size_t i = 0; i < 4; ++i) {
    const Scenario96& s = scenarios_96()[i];
    Cells(all, "4.13").cell(s.name + ", comparisons", clip[i], kClipTests * s.vertices());
    Cells(all, "4.14").cell(s.name + ", mults", project[i], kProjection * s.vertices());
    Cells(all, "4.15").cell(s.name + ", mults", few[i], kPredictedProjection * s.prediction_vertices);
    Cells(all, "4.17")
        .cell(s.name + ", subtractions", subtract[i], kSubtractions * s.prediction_vertices)
        .cell(s.name + ", comparisons", compare[i], kComparisons * s.prediction_vertices);
  }
}

/// Sums over the stages of one processor.
struct Totals {
  double multiplications, additions, comparisons, kb;
};

Totals rendering(const Scenario96& s) {
  const double v = s.vertices();
  return {v * (12 + kLights * 60 + 8 + kProjection + 2) + 9 * s.normals,
          v * (12 + kLights * 18 + kSumOfLights + 6 + 2) + 6 * s.normals, kClipTests * v,
          kilobytes(3 * (v + s.normals))};
}

Totals prediction(const Scenario96& s) {
  const double p = s.prediction_vertices;
  return {64 * kThings + p * (12 + kPredictedProjection), 48 * kThings + p * (12 + kSubtractions),
          kComparisons * p, 2 * kilobytes(3 * p)};
}

void add_totals(std::vector<OperationCell>& all, const std::string& table, const Scenario96& s,
                const Totals& rend, const Totals& pred, const Totals& percent) {
  const Totals r = rendering(s), p = prediction(s);
  Cells(all, table)
      .cell("totals, mults (rend)", rend.multiplications, r.multiplications)
      .cell("totals, mults (pred)", pred.multiplications, p.multiplications)
      .cell("totals, adds (rend)", rend.additions, r.additions)
      .cell("totals, adds (pred)", pred.additions, p.additions)
      .cell("totals, comps (rend)", rend.comparisons, r.comparisons)
      .cell("totals, comps (pred)", pred.comparisons, p.comparisons)
      .cell("totals, KB (rend)", rend.kb, r.kb, 0.06)
      .cell("totals, KB (pred)", pred.kb, p.kb, 0.11)
      .cell("%, mults", percent.multiplications, 100 * p.multiplications / r.multiplications, 0.0499)
      .cell("%, adds", percent.additions, 100 * p.additions / r.additions, 0.0499)
      .cell("%, comps", percent.comparisons, 100 * p.comparisons / r.comparisons, 0.0499)
      .cell("%, data", percent.kb, 100 * p.kb / r.kb, 0.0499);
}

void add_all_totals(std::vector<OperationCell>& all) {
  const std::vector<Scenario96>& s = scenarios_96();
  add_totals(all, "4.18", s[0], {1'128e3, 426e3, 24e3, 93.8}, {152e3, 104e3, 20e3, 93.8},
             {13.5, 24.4, 83.3, 100});
  add_totals(all, "4.19", s[1], {6'606e3, 2'460e3, 144e3, 351.6}, {240e3, 160e3, 40e3, 187.6},
             {3.6, 6.5, 27.8, 53.3});
  // The one stage whose row does not repeat what a table before it says.
  Cells(all, "4.20").cell("2nd vertex trans, mults (rend)", 4'604e3, 8 * s[2].vertices());
  add_totals(all, "4.20", s[2], {162'428e3, 61'632e3, 3'456e3, 13500}, {196e3, 132e3, 30e3, 140.6},
             {0.1, 0.2, 0.9, 1.0});
  add_totals(all, "4.21", s[3], {338.4e6, 128.4e6, 7.2e6, 28125}, {196e3, 132e3, 30e3, 140.6},
             {0.05, 0.1, 0.4, 0.55});
}

/// A pipeline of geometry engines: the costs by engine.
void add_engines(std::vector<OperationCell>& all, const std::string& table, const Scenario96& s,
                 const std::array<double, 11>& printed) {
  const double v = s.vertices(), p = s.prediction_vertices;
  Cells(all, table)
      .cell("trans, mults (rend)", printed[0], 20 * v + 9 * s.normals)
      .cell("trans, mults (pred)", printed[1], 64 * kThings + 12 * p)
      .cell("trans, adds (rend)", printed[2], 18 * v + 6 * s.normals)
      .cell("trans, adds (pred)", printed[3], 48 * kThings + 12 * p)
      .cell("lighting, mults (rend)", printed[4], kLights * 60 * v)
      .cell("lighting, adds (rend)", printed[5], (kLights * 18 + kSumOfLights) * v)
      .cell("clipping, comps (rend)", printed[6], kClipTests * v)
      .cell("perspective, mults (rend)", printed[7], kProjection * v)
      .cell("perspective, mults (pred)", printed[8], kPredictedProjection * p)
      .cell("viewport, adds (pred)", printed[9], kSubtractions * p)
      .cell("viewport, comps (pred)", printed[10], kComparisons * p);
}

std::string grouped(double value) {
  if (value != std::floor(value)) return formatted("%.2f", value);
  std::string text = formatted("%.0f", value);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

}  // namespace

const std::vector<Scenario96>& scenarios_96() {
  static const std::vector<Scenario96> scenarios{{"random", 1e3, 4e3, 4e3},
                                                 {"blocks", 6e3, 6e3, 8e3},
                                                 {"particles", 144e3, 576e3, 6e3},
                                                 {"molecules", 300e3, 1.2e6, 6e3}};
  return scenarios;
}

bool OperationCell::agrees() const { return std::abs(printed - ours) <= tolerance; }

std::vector<OperationCell> operation_cells() {
  std::vector<OperationCell> all;
  add_sizes(all);
  add_stages(all);
  add_tests(all);
  add_all_totals(all);
  add_engines(all, "4.22", scenarios_96()[0],
              {116e3, 128e3, 96e3, 96e3, 960e3, 324e3, 24e3, 44e3, 40e3, 8e3, 24e3});
  add_engines(all, "4.23", scenarios_96()[3],
              {34.8e6, 136e3, 28.8e6, 120e3, 288e6, 97.2e6, 7.2e6, 13.2e6, 60e3, 12e3, 36e3});
  return all;
}

bool is_known_misprint(const OperationCell& cell) {
  static const std::vector<std::pair<std::string, std::string>> misprints{
      {"4.10", "molecules (local), mults"},
      {"4.11", "particles (infinite), adds"},
      {"4.18", "totals, adds (rend)"},
      {"4.18", "%, adds"},
      {"4.20", "2nd vertex trans, mults (rend)"},
      {"4.20", "totals, mults (rend)"},
      {"4.21", "%, data"},
      {"4.22", "trans, mults (pred)"},
      {"4.22", "viewport, comps (pred)"},
      {"4.23", "viewport, comps (pred)"}};
  return std::find(misprints.begin(), misprints.end(), std::pair(cell.table, cell.what)) != misprints.end();
}

Finding operations_of(const std::string& table, const std::vector<OperationCell>& cells) {
  Finding finding{"", true, {}};
  int count = 0, equal = 0;
  std::string corrected;
  for (const OperationCell& cell : cells) {
    if (cell.table != table) continue;
    ++count;
    equal += cell.agrees();
    finding.same = finding.same && cell.agrees() != is_known_misprint(cell);
    finding.numbers.emplace_back(cell.what, cell.ours);
    if (!cell.agrees())
      corrected += (corrected.empty() ? "; corrected: " : ", ") + cell.what + " " + grouped(cell.ours) +
                   " for " + grouped(cell.printed);
  }
  finding.same = finding.same && count > 0;
  finding.ours = std::to_string(equal) + " of " + std::to_string(count) + " cells as printed" + corrected;
  return finding;
}

Item operation_counts_96() {
  Item item{"4", "Tables 4.2 to 4.23: operations of prediction beside rendering", {}};
  for (int number = 2; number <= 23; ++number) {
    const std::string table = "4." + std::to_string(number);
    item.claims.push_back({table, "Table " + table, "every cell, but for known misprints",
                           [table](PaperBench&) { return operations_of(table, operation_cells()); }});
    item.claims.back().must = true;
    item.claims.back().derived = false;
  }
  return item;
}

}  // namespace talisman::sequences
