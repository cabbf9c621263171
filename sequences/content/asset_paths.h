// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where are sequences and their content?
///
/// The root of the repository is the nearest folder above the running program (else above the working
/// directory) that holds `sequences/fetch-assets`. Content of Debian packages lies in `assets/<package>/`
/// under the root, or under the folder that the environment variable TALISMAN_ASSETS names. A path in a
/// sequence file is either `package:/path/inside/the/package` or relative to that file.

#include <string>
#include <vector>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Empty when there is none (the program was moved out of its repository).
std::string repository_root();

/// The file that `path`, written in `sequence_file`, means. Throws InputError when it is missing; for content
/// of a package the error names the command that fetches it.
std::string resolve_asset(const std::string& path, const std::string& sequence_file, int line = 0);

/// What results call the file `path` that belongs to `sequence_file`: "package:/path" in the folder of assets, else
/// the path from the sequence file's folder. The same on every machine.
std::string content_name(const std::string& path, const std::string& sequence_file);

/// sequences/<name>/<name>.yaml, or sequences/<name>/<variant>.yaml for "<name>/<variant>"; empty when there
/// is none.
std::string sequence_file_of(const std::string& name);

/// Names that `sequence_file_of` knows, sorted: "canyon", "canyon/background".
std::vector<std::string> sequence_names();

}  // namespace talisman::sequences
