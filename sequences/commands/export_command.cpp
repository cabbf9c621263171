// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/export_command.h"

#include <fstream>
#include <iterator>
#include <ostream>

#include "sequences/files/atomic_file.h"
#include "sequences/results/columns_doc.h"
#include "sequences/results/csv_export.h"

namespace talisman::sequences {

int run_export(const ExportOptions& options, std::ostream& out) {
  if (!options.csv) throw InputError("export needs a form, must be --csv");
  std::string names;
  for (const std::string& name : export_csv(options.folder)) names += (names.empty() ? "" : ", ") + name;
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
