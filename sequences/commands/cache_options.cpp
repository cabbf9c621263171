// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/cache_options.h"

#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "sequences/commands/option_group.h"
#include "sequences/files/cache.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {
namespace {

constexpr std::int64_t kMostMegabytes = 1'000'000'000;  ///< a petabyte
constexpr std::int64_t kLeastMegabytes = 64;
constexpr int kLongest_s = 86'400;

void open_cache(const CLI::App& command, const CacheWords& words) {
  const bool is_chosen = command.count("--cache") > 0;
  if (is_chosen && words.folder.empty()) throw InputError("--cache is empty, rule: a folder");
  if (words.megabytes < 1 || words.megabytes > kMostMegabytes)
    throw InputError("--cache-mb is " + std::to_string(words.megabytes) + ", rule: from 1 to " +
                     std::to_string(kMostMegabytes));
  if (words.import.seconds < 1 || words.import.seconds > kLongest_s)
    throw InputError("--import-limit-s is " + std::to_string(words.import.seconds) + ", rule: from 1 to " +
                     std::to_string(kLongest_s));
  if (words.import.megabytes < kLeastMegabytes || words.import.megabytes > kMostMegabytes)
    throw InputError("--import-memory-mb is " + std::to_string(words.import.megabytes) + ", rule: from " +
                     std::to_string(kLeastMegabytes) + " to " + std::to_string(kMostMegabytes));
  use_import_limits(words.import);
  if (words.none) return use_cache({});
  use_cache({is_chosen ? words.folder : default_cache_folder(), words.megabytes});
}

}  // namespace

void add_cache_options(CLI::App& command, CacheWords& words) {
  OptionGroup(command, "Cache")
      .option("--cache", words.folder, "folder of models that were read and ground that was painted before",
              "$XDG_CACHE_HOME/talisman, else ~/.cache/talisman")
      .option("--cache-mb", words.megabytes,
              "size of the cache in megabytes; what was used least recently is dropped",
              std::to_string(words.megabytes))
      .flag("--no-cache", words.none, "read and paint all anew, and keep nothing");
  OptionGroup(command, "Reading models")
      .option("--import-limit-s", words.import.seconds,
              "processor time that reading one model may take, seconds", std::to_string(words.import.seconds))
      .option("--import-memory-mb", words.import.megabytes,
              "address space that its reader may take, megabytes", std::to_string(words.import.megabytes));
  command.parse_complete_callback([&command, &words] { open_cache(command, words); });
}

void warn_of_cache() {
  const Cache& cache = program_cache();
  if (cache.trouble().empty() || cache.options().folder == default_cache_folder()) return;
  std::fprintf(stderr, "warning: cache %s; nothing is kept for the next time\n", cache.trouble().c_str());
}

}  // namespace talisman::sequences
