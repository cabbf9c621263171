// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/DefaultIOSystem.h>

#include "sequences/files/file_uses.h"

namespace talisman::sequences {

/// The file system as assimp sees it, with a record of what it asked for.
class RecordedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit RecordedFiles(FileUses& files) : files_(files) {}
  bool Exists(const char* file) const override {
    files_.look_for(file);
    return DefaultIOSystem::Exists(file);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    files_.look_for(file);
    return DefaultIOSystem::Open(file, mode);
  }

 private:
  FileUses& files_;
};

}  // namespace talisman::sequences
