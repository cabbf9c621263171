// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The words of every command that reads models: --cache, --no-cache and --cache-mb, --import-limit-s and
/// --import-memory-mb.

#include <cstdint>
#include <string>

#include "sequences/import/model_import.h"

namespace CLI {
class App;
}

namespace talisman::sequences {

struct CacheWords {
  std::string folder;  ///< empty: the default
  std::int64_t megabytes = 2048;
  bool none = false;
  ImportLimits import;  ///< of the reader of models
};

/// When the words of the command are read, and before it does anything, its cache is the program's
/// (files/cache.h), and its limits are those of readers; InputError names a word that breaks its rule. `words` must outlive the command.
void add_cache_options(CLI::App& command, CacheWords& words);

/// A line on stderr if entries could not be written into a cache that was asked for.
void warn_of_cache();

}  // namespace talisman::sequences
