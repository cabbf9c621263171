// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How many operations does prediction take beside rendering? [F96 4, Tables 4.2 to 4.23]
///
/// A model of a fixed-function pipeline: each element costs what one of its kind does,
///
///   concatenation 64 mul 48 add; vertex 12/12; normal 9/6; light, local 60/18, infinite 15/7, and 9 adds for four; second
///   vertex transform 8/6; clip test 6 comparisons; projection 11 mul, predicted 10; viewport 2/2; compare 2 sub, 5
///   comparisons; 4 bytes a number
///
/// and a table is those costs times the elements of a scenario. Every cell is worked out and set beside the printed one.
/// Those that differ are misprints; which they are is part of the rule.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// The elements of a scenario: 1,000 things.
struct Scenario96 {
  std::string name;
  double polygons = 0, normals = 0, prediction_vertices = 0;
  double vertices() const { return 4 * polygons; }
};
const std::vector<Scenario96>& scenarios_96();

struct OperationCell {
  std::string table;  ///< "4.18"
  std::string what;   ///< "random, lighting, adds"
  double printed = 0, ours = 0;
  double tolerance = 0;  ///< of what is printed rounded: KB, per cent
  bool agrees() const;
};

/// All cells of the tables, in their order.
std::vector<OperationCell> operation_cells();

/// The same with an error in print: tables and cells that are known.
bool is_known_misprint(const OperationCell& cell);

/// Of the cells of one table: all agree, but those that are known misprints, which do not.
Finding operations_of(const std::string& table, const std::vector<OperationCell>& cells);

Item operation_counts_96();

}  // namespace talisman::sequences
