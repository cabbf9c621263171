// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What was worked out once need not be worked out again: a folder of results by the hash of what they came
/// from. A cache changes how long things take and never what comes out, so that every doubt is a miss.
///
///   DIR/KIND-KEY.entry    8 bytes magic, key, hash of the content, its length, the content
///
/// KEY is the hash of everything that the content depends on: content files, reader and its version, options.
/// An entry is written to a temporary name and renamed, and read only if its key and its own hash are right;
/// one that is damaged, cut or empty is removed. So any number of programs may use one folder at a time, and
/// may be killed at any moment. An entry that is used becomes the youngest; when all of them are more than the
/// limit, the oldest are removed.

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sequences/files/content_hash.h"

namespace talisman::sequences {

struct CacheOptions {
  std::string folder;             ///< made when the first entry is written; empty: no cache
  std::int64_t megabytes = 2048;  ///< ≥ 1; all entries together
};

/// $XDG_CACHE_HOME/talisman, else $HOME/.cache/talisman; empty where neither is an absolute path.
std::string default_cache_folder();

class Cache {
 public:
  explicit Cache(CacheOptions options = {});

  /// Is there one? Only then it is worth working out a key.
  bool is_on() const { return !options_.folder.empty(); }
  const CacheOptions& options() const { return options_; }

  /// The content of the entry, if there is one that is whole. `kind`: letters.
  std::optional<std::vector<std::uint8_t>> load(const std::string& kind, const ContentHash& key);
  /// Never throws: a cache that cannot be written is a slow one.
  void store(const std::string& kind, const ContentHash& key, std::span<const std::uint8_t> content);
  /// Why an entry could not be written, "FOLDER: reason"; empty: all could.
  std::string trouble() const;

 private:
  std::string path_of(const std::string& kind, const ContentHash& key) const;
  void set_trouble(const std::string& reason);
  void drop_least_recently_used();

  CacheOptions options_;
  mutable std::mutex mutex_;
  std::string trouble_;
};

/// The cache of this program, which readers deep inside ask: none until `use_cache`, which is called before
/// anything is read.
Cache& program_cache();
void use_cache(const CacheOptions& options);

}  // namespace talisman::sequences
