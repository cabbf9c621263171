// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The column tables as Markdown, for docs/outputs.md: what stands between the lines
///
///   <!-- columns: frames -->
///   <!-- end of columns -->
///
/// is made from column_tables.h, and a test says so when the two differ.

#include <string>

namespace talisman::sequences {

/// The text with all its tables made anew. Throws InputError, with the line, for the name of a table that there is
/// not, or a beginning without end.
std::string with_column_tables(const std::string& markdown);

}  // namespace talisman::sequences
