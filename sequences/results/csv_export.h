// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of a run as flat tables: one header line, one line per row, RFC 4180 (fields with commas, quotes or
/// line breaks are quoted, lines end in CR LF), nothing where JSON has null. A spreadsheet and pandas.read_csv take
/// them as they are.
///
///   decisions.csv   one row per frame and layer       from decisions.jsonl
///   frames.csv      one per frame                     from frames.jsonl
///   timing.csv      one per frame, wall times         from timing.jsonl
///   layers.csv      one per layer                     from summary.json
///   effects.csv     one per effect                    from summary.json
///   run.csv         one                               from summary.json
///
/// The columns are those of column_tables.h; docs/outputs.md lists them.

#include <string>
#include <vector>

namespace talisman::sequences {

/// Writes the tables beside the results that they are made from; returns the names of the files. Reads line by line:
/// memory does not grow with the run. Throws InputError where `folder` holds no complete run, or a file that is not
/// of one; OutputError where a table cannot be written.
std::vector<std::string> export_csv(const std::string& folder);

/// One field as RFC 4180 has it.
std::string csv_field(const std::string& text);

}  // namespace talisman::sequences
