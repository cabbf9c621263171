// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/content_hash.h"

#include <xxhash.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

ContentHash from_library(XXH128_hash_t hash) { return {hash.high64, hash.low64}; }

}  // namespace

struct ContentHasher::State {
  State() : xxh(XXH3_createState()) {
    TALISMAN_CHECK(xxh != nullptr);
    XXH3_128bits_reset(xxh);
  }
  ~State() { XXH3_freeState(xxh); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  XXH3_state_t* xxh;
};

std::string ContentHash::hex() const {
  std::array<char, 33> digits;
  std::snprintf(digits.data(), digits.size(), "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return digits.data();
}

ContentHasher::ContentHasher() : state_(std::make_unique<State>()) {}
ContentHasher::~ContentHasher() = default;

void ContentHasher::add_bytes(std::span<const std::uint8_t> bytes) {
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

ContentHasher& ContentHasher::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  add_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return *this;
}

ContentHash ContentHasher::hash() const { return from_library(XXH3_128bits_digest(state_->xxh)); }

ContentHash hash_of(std::span<const std::uint8_t> bytes) {
  return from_library(XXH3_128bits(bytes.data(), bytes.size()));
}

std::optional<ContentHash> hash_of_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  std::vector<char> block(1 << 18);
  ContentHasher hasher;
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0)
    hasher.add_bytes(
        {reinterpret_cast<const std::uint8_t*>(block.data()), static_cast<std::size_t>(in.gcount())});
  if (!in.eof() || in.bad()) return std::nullopt;
  return hasher.hash();
}

}  // namespace talisman::sequences
