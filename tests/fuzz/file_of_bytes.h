// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Readers that want a file get one: the bytes of an input in a folder of their own, which is gone when the target ends.

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "tests/sequences/temporary_folder.h"

namespace talisman::fuzz {

/// Path of `name` in the target's folder, which holds these bytes now.
inline std::string file_of_bytes(const std::string& name, const std::uint8_t* data, std::size_t size) {
  static const tests::TemporaryFolder folder;
  const std::string path = folder.path() + "/" + name;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}

}  // namespace talisman::fuzz
