// SPDX-License-Identifier: Apache-2.0
// Any bytes in the place of an entry of the cache. The first byte says how much of a right entry is left before them. What is
// loaded is what was stored, or nothing.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "sequences/files/cache.h"
#include "tests/sequences/temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::sequences;
  static const talisman::tests::TemporaryFolder folder;
  static Cache cache({folder.path(), 16});
  if (size == 0) return 0;
  const std::vector<std::uint8_t> stored(data + std::min<std::size_t>(size, 1 + data[0] % 32), data + size);
  const ContentHash key = hash_of({data, size});
  cache.store("fuzz", key, stored);
  if (cache.load("fuzz", key) != stored) std::abort();
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    std::vector<char> bytes(entry.file_size());
    std::ifstream(entry.path(), std::ios::binary)
        .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    const std::size_t left = std::min<std::size_t>(data[0], bytes.size());
    std::vector<char> damaged(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(left));
    damaged.insert(damaged.end(), data + 1, data + size);
    std::ofstream(entry.path(), std::ios::binary)
        .write(damaged.data(), static_cast<std::streamsize>(damaged.size()));
    if (const auto loaded = cache.load("fuzz", key); loaded && *loaded != stored) std::abort();
    std::filesystem::remove(entry.path());
    break;
  }
  return 0;
}
