// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a paper say, and what comes out here?
///
/// A paper is a table of items (a figure, a table, a section), an item a table of claims. A claim has what the paper
/// says, a function that measures ours in this run, and a rule that the measured numbers keep or break: whoever adds a paper
/// adds such a table (papers.h). The scenes of the papers are lost, so what can agree is the shape: an order, a
/// range, a ratio, what rises and what falls.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sequences/experiments/reproduction/paper_bench.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// Numbers of a row for CSV and JSON, by name.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

struct Finding {
  std::string ours;  ///< in words, every number computed in this run
  bool same = false;
  NamedNumbers numbers{};
};

struct Claim {
  std::string id;     ///< within its item: "falling"
  std::string paper;  ///< what it says
  std::string rule;   ///< when the shape is the same
  std::function<Finding(PaperBench&)> ours;
  /// The second experiment, where `ours` says no: why, in words and numbers.
  std::function<std::string(PaperBench&)> why = nullptr;
  std::string sequence = "";  ///< on which it is tried; empty: on none, or on several that it names itself
  bool must = false;          ///< a run in which it says no has failed
  bool derived = false;       ///< not said by the paper: worked out from what it says of the machine
  bool pictures = false;      ///< has to draw: left out of a quick run
};

struct PaperFigure {
  std::string file;     ///< without ".svg"; unique
  std::string caption;  ///< which figure of the paper it is beside, and of which content
  Plot plot;
};

struct Item {
  std::string id;     ///< within its paper: "22"
  std::string title;  ///< "Fig. 22: barnyard, resource use"
  std::vector<Claim> claims;
  std::function<std::vector<PaperFigure>(PaperBench&)> draw = nullptr;
};

struct Paper {
  std::string tag;    ///< "LS97"
  std::string title;  ///< authors, title, year
  std::vector<Item> items;
};

/// "LS97:22".
inline std::string full_id(const Paper& paper, const Item& item) { return paper.tag + ":" + item.id; }

}  // namespace talisman::sequences
