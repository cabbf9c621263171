// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>

#include "sequences/import/texture_search.h"
#include "sequences/import/wide_text.h"

namespace talisman::sequences {

/// The file system as assimp sees it: the model, and what find_file lets it have, text in UTF-8; with a record of what
/// it asked for.
class RecordedFiles : public Assimp::DefaultIOSystem {
 public:
  RecordedFiles(const ModelPlace& model, FileUses& files) : model_(model), files_(files) {}
  bool Exists(const char* file) const override { return !found(file).empty(); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    const std::string path = found(file);
    if (path.empty()) return nullptr;
    if (const auto text = utf8_of_wide_file(path)) {
      auto* bytes = new std::uint8_t[text->size()];  // it belongs to the stream
      std::copy(text->begin(), text->end(), bytes);
      return new Assimp::MemoryIOStream(bytes, text->size(), true);
    }
    return DefaultIOSystem::Open(path.c_str(), mode);
  }

 private:
  std::string found(const char* file) const {
    if (model_.path != file) return find_file(model_, std::filesystem::absolute(file).string(), files_);
    files_.look_for(file);
    return file;
  }

  const ModelPlace& model_;
  FileUses& files_;
};

}  // namespace talisman::sequences
