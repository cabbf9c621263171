// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Models that were read before, in the program's cache (files/cache.h).
///
///   key      path and content of the model file, the program that reads it, the limits, the further folders
///   content  the number of files that it used, what each of them was (file_uses.h), the scene stream
///
/// So a model is read anew when a texture, a .bin or an .mtl beside it changes, when one that was missing is
/// there, or when one with a similar name might be taken in its place. Only what was read without an error is
/// kept; its warnings come with it.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sequences/files/content_hash.h"
#include "sequences/import/model_import.h"

namespace talisman::sequences {

class CachedModel {
 public:
  /// `reader`: the program's file. Without a cache nothing is found and nothing kept.
  CachedModel(std::string path, const ImportLimits& limits, const std::string& reader,
              const std::vector<std::string>& folders);

  std::optional<ImportedModel> find() const;
  /// `stream` is what the reader sent, and `model` what it says. Not kept if one of the files may have changed
  /// since it was read.
  void keep(std::span<const std::uint8_t> stream, const ImportedModel& model) const;

 private:
  std::string path_;
  std::optional<ContentHash> key_;
};

}  // namespace talisman::sequences
