// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The commands `export` and `columns`: results in other forms.

#include <iosfwd>
#include <string>

namespace talisman::sequences {

struct ExportOptions {
  std::string folder;  ///< of a complete run
  bool csv = false;
};

/// Writes the tables into the folder and says which. Throws InputError, OutputError.
int run_export(const ExportOptions& options, std::ostream& out);

/// Makes the column tables of a Markdown file anew, in place (results/columns_doc.h).
int update_column_tables(const std::string& markdown_file);

}  // namespace talisman::sequences
