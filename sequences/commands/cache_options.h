// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The words --cache, --no-cache and --cache-mb of every command that reads models.

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace talisman::sequences {

struct CacheWords {
  std::string folder;  ///< empty: the default
  std::int64_t megabytes = 2048;
  bool none = false;
};

/// When the words of the command are read, and before it does anything, its cache is the program's
/// (files/cache.h); InputError names a word that breaks its rule. `words` must outlive the command.
void add_cache_options(CLI::App& command, CacheWords& words);

/// A line on stderr if entries could not be written into a cache that was asked for.
void warn_of_cache();

}  // namespace talisman::sequences
