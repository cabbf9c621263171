// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A file of lines that grows while a run goes on. It is written as NAME.partial, one flushed line at a time,
/// and gets its name only when the run is complete; after a killed run the partial file still holds every
/// line that was finished.

#include <optional>
#include <string>
#include <vector>

#include "sequences/files/output_file.h"

namespace talisman::sequences {

class LineFile {
 public:
  /// Starts NAME.partial with `lines`. Throws OutputError.
  LineFile(std::string path, const std::vector<std::string>& lines = {});
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  void write(const std::string& line);  ///< with a newline, at once; throws OutputError
  void finish();                        ///< syncs and renames to the final name; throws OutputError

 private:
  std::string path_, partial_;
  std::optional<OutputFile> file_;  ///< always, but for the constructor
};

/// Whole lines of NAME.partial, or else of NAME; none if neither exists. A last line without newline (cut by
/// a crash) is left out.
std::vector<std::string> lines_written(const std::string& path);

/// How many these are, without holding them.
std::size_t count_lines_written(const std::string& path);

}  // namespace talisman::sequences
