// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/export_command.h"

#include <fstream>
#include <iterator>
#include <ostream>

#include "sequences/files/atomic_file.h"
#include "sequences/results/columns_doc.h"
#include "sequences/results/exports/csv_export.h"
#include "sequences/results/exports/sqlite_export.h"
#include "sequences/results/exports/trace_export.h"

namespace talisman::sequences {

int run_export(const ExportOptions& options, std::ostream& out) {
  if (!options.csv && !options.trace && !options.sqlite)
    throw InputError("export needs a form, must be --csv, --sqlite or --trace");
  const bool with_timing = !options.no_timing;
  std::vector<std::string> files;
  if (options.csv) files = export_csv(options.folder, with_timing);
  if (options.sqlite) files.push_back(export_sqlite(options.folder, with_timing));
  if (options.trace) files.push_back(export_trace(options.folder, with_timing));
  std::string names;
  for (const std::string& name : files) names += (names.empty() ? "" : ", ") + name;
  out << "wrote " << names << " in " << options.folder << "\n";
  return kSuccess;
}

int update_column_tables(const std::string& markdown_file) {
  std::ifstream in(markdown_file, std::ios::binary);
  if (!in) throw InputError("cannot be read", markdown_file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  write_text_atomically(markdown_file, with_column_tables(text));
  return kSuccess;
}

}  // namespace talisman::sequences
