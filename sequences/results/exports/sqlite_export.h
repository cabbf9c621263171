// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of a run as one SQLite file, `results.sqlite`: the tables of finished_tables.h with their columns, each
/// with its unit and meaning as a comment in the schema (`.schema decisions` prints them), null where JSON has null,
/// truth values as 0 and 1. Decisions have an index by layer and frame.

#include <string>

namespace talisman::sequences {

/// Writes the file beside the results that it is made from; returns its name. Memory does not grow with the run.
/// Throws InputError where `folder` holds no complete run, OutputError where the file cannot be written.
std::string export_sqlite(const std::string& folder, bool with_timing);

}  // namespace talisman::sequences
