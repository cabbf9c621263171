// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where are sequences and their content?
///
/// The sequences that come with the program lie in the folder sequences/ of files/program_folder.h's
/// `data_folder`. Content of Debian packages lies in `<assets>/<package>/`, where <assets> is the folder that the
/// environment variable TALISMAN_ASSETS names; without it, `assets/` of the source tree; for an installed program
/// `talisman/assets/` in $XDG_DATA_HOME (~/.local/share), since what is installed need not be writable.
/// sequences/fetch-assets puts it there by the same rule. A path in a sequence file is either
/// `package:/path/inside/the/package` or relative to that file.

#include <string>
#include <vector>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// The command that fetches the content of sequence (or experiment) `name`, as a user types it.
std::string fetch_command(const std::string& name);

/// The file that `path`, written in `sequence_file`, means. Throws InputError when it is missing; for content
/// of a package the error names the command that fetches it.
std::string resolve_asset(const std::string& path, const std::string& sequence_file, int line = 0);

/// The same of a folder; empty: that of the sequence file.
std::string resolve_folder(const std::string& path, const std::string& sequence_file, int line = 0);

/// What results call the file `path` that belongs to `sequence_file`: "package:/path" in the folder of assets, else
/// the path from the sequence file's folder. The same on every machine.
std::string content_name(const std::string& path, const std::string& sequence_file);

/// sequences/<name>/<name>.yaml, or sequences/<name>/<variant>.yaml for "<name>/<variant>"; empty when there
/// is none.
std::string sequence_file_of(const std::string& name);

/// Names that `sequence_file_of` knows, sorted: "canyon", "canyon/background".
std::vector<std::string> sequence_names();

}  // namespace talisman::sequences
