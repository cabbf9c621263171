// SPDX-License-Identifier: Apache-2.0
// Any bytes in the place of a compressed chunk. A status comes out; what is rejected is clear; what is
// accepted can be compressed again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "chunker/compression.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::chunker;
  Chunk chunk;
  if (decompress_chunk({data, size}, chunk) != DecodeStatus::Ok) {
    const auto is_clear = [](const Texel& t) { return t == Texel{}; };
    if (!std::all_of(std::begin(chunk.texels), std::end(chunk.texels), is_clear)) std::abort();
    return 0;
  }
  Chunk again;
  if (decompress_chunk(compress_chunk(chunk, {data[0] % 101}), again) != DecodeStatus::Ok) std::abort();
  return 0;
}
