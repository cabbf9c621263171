// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman reproduce` says, and its files:
///
/// - reproduce.csv: id, paper, ours, same, rule, sequence, derived, must, why
/// - numbers.csv: id, name, value: what the words of `ours` are made of
/// - reproduce.json: talisman.reproduce/1, all of it
/// - TAG-ITEM….svg and .csv: the figures, in the axes of the paper
/// - reproduce.html: tables and figures in one file
///
/// The same bytes in every run.

#include <iosfwd>
#include <string>

#include "sequences/experiments/reproduction/reproduction.h"

namespace talisman::sequences {

std::string reproduction_csv(const Reproduction& reproduction);
std::string json_of(const Reproduction& reproduction);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const Reproduction& reproduction, const std::string& dir);

/// The table: paper, ours, same shape? Below it why a row says no, and how many say what.
void print_report(const Reproduction& reproduction, std::ostream& out);

}  // namespace talisman::sequences
