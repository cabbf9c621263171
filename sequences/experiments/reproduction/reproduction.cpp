// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/reproduction.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::sequences {

namespace {

ReproducedRow measured_row(const std::string& item, const Claim& claim, PaperBench& bench) {
  ReproducedRow row{
      item + "/" + claim.id, claim.paper, claim.rule, claim.sequence, claim.derived, claim.must, {},
      Shape::NotMeasured,    {}};
  try {
    row.finding = claim.ours(bench);
    row.shape = row.finding.same ? Shape::Same : Shape::Other;
    if (row.shape == Shape::Other && claim.why) row.why = claim.why(bench);
  } catch (const InputError& error) {
    row.finding = {error.what(), false, {}};
    row.shape = Shape::NotMeasured;
  }
  return row;
}

std::vector<PaperFigure> drawn_figures(const Item& item, PaperBench& bench) {
  if (!item.draw) return {};
  try {
    return item.draw(bench);
  } catch (const InputError&) {
    return {};  // its rows say why
  }
}

}  // namespace

std::string_view name(Shape shape) {
  switch (shape) {
    case Shape::Same:
      return "yes";
    case Shape::Other:
      return "no";
    case Shape::NotMeasured:
      return "not measured";
  }
  TALISMAN_CHECK(false && "no such shape");
}

int Reproduction::count(Shape shape) const {
  int rows = 0;
  for (const ReproducedItem& item : items)
    rows += static_cast<int>(std::count_if(item.rows.begin(), item.rows.end(),
                                           [shape](const ReproducedRow& row) { return row.shape == shape; }));
  return rows;
}

int Reproduction::failed() const {
  int rows = 0;
  for (const ReproducedItem& item : items)
    rows += static_cast<int>(std::count_if(item.rows.begin(), item.rows.end(), [](const ReproducedRow& row) {
      return row.must && row.shape == Shape::Other;
    }));
  return rows;
}

Reproduction reproduce(const std::vector<Paper>& papers, PaperBench& bench, bool quick,
                       ProgressKind progress_kind) {
  Reproduction result;
  result.quick = quick;
  int steps = 0;
  for (const Paper& paper : papers)
    for (const Item& item : paper.items) steps += static_cast<int>(item.claims.size()) + 1;
  Progress progress(progress_kind, "reproduced", steps);
  for (const Paper& paper : papers) {
    result.papers.push_back(paper.tag + ": " + paper.title);
    for (const Item& item : paper.items) {
      ReproducedItem measured_item{full_id(paper, item), item.title, {}, {}};
      for (const Claim& claim : item.claims) {
        if (claim.pictures && quick)
          ++result.left_out;
        else
          measured_item.rows.push_back(measured_row(measured_item.id, claim, bench));
        progress.advance();
      }
      measured_item.drawings = drawn_figures(item, bench);
      progress.advance();
      if (!measured_item.rows.empty()) result.items.push_back(std::move(measured_item));
    }
  }
  return result;
}

}  // namespace talisman::sequences
