// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of a run as flat tables (finished_tables.h), NAME.csv each: one header line, one line per row, RFC 4180
/// (fields with commas, quotes or line breaks are quoted, lines end in CR LF), nothing where JSON has null. A
/// spreadsheet and pandas.read_csv take them as they are.

#include <string>
#include <vector>

namespace talisman::sequences {

/// Writes the tables beside the results that they are made from; returns the names of the files. Reads line by line:
/// memory does not grow with the run. Throws InputError where `folder` holds no complete run, or a file that is not
/// of one; OutputError where a table cannot be written.
std::vector<std::string> export_csv(const std::string& folder, bool with_timing);

/// One field as RFC 4180 has it.
std::string csv_field(const std::string& text);

}  // namespace talisman::sequences
