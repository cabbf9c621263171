// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The commands `export` and `columns`: results in other forms.

#include <iosfwd>
#include <string>

namespace talisman::sequences {

struct ExportOptions {
  std::string folder;  ///< of a complete run
  bool csv = false, trace = false, sqlite = false;
  bool no_timing = false;  ///< nothing that was measured: the same bytes on every machine
};

/// Writes every form asked for into the folder and says which files. Throws InputError, OutputError.
int run_export(const ExportOptions& options, std::ostream& out);

/// Makes the column tables of a Markdown file anew, in place (results/columns_doc.h).
int update_column_tables(const std::string& markdown_file);

}  // namespace talisman::sequences
