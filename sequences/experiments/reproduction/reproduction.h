// SPDX-License-Identifier: Apache-2.0
#pragma once

/// All claims of the papers that were asked for, measured one after the other.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

enum class Shape {
  Same,
  Other,       ///< the rule is broken
  NotMeasured  ///< content is not there
};
std::string_view name(Shape shape);  ///< "yes", "no", "not measured"

struct ReproducedRow {
  std::string id;  ///< "LS97:22/falling-polygons"
  std::string paper, rule, sequence;
  bool derived = false, must = false;
  Finding finding;  ///< not measured: `ours` says why
  Shape shape = Shape::NotMeasured;
  std::string why;  ///< of Other: what the second experiment found
};

struct ReproducedItem {
  std::string id, title;
  std::vector<ReproducedRow> rows;
  std::vector<PaperFigure> drawings;
};

struct Reproduction {
  bool quick = false;
  std::vector<std::string> papers;  ///< titles, with their tags
  std::vector<ReproducedItem> items;
  int left_out = 0;  ///< rows that a quick run does not measure
  int count(Shape shape) const;
  /// Rows that say no and must not.
  int failed() const;
};

/// Cost: with `quick`, which draws no picture, some seconds a sequence; else some minutes. A row whose content is not
/// there is not measured.
Reproduction reproduce(const std::vector<Paper>& papers, PaperBench& bench, bool quick,
                       ProgressKind progress);

}  // namespace talisman::sequences
