// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Are these the same bytes as before? 128 bits that say so.
///
/// XXH3-128 of Debian's libxxhash: it reads memory about as fast as memory can be read, so that a checked file
/// costs hardly more than an unchecked one, and by chance two of 2⁶⁴ files have the same hash. It is no
/// signature: whoever wants two files with one hash can make them, and thereby deceives nobody but himself.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace talisman::sequences {

struct ContentHash {
  std::uint64_t high = 0, low = 0;
  bool operator==(const ContentHash&) const = default;
  std::string hex() const;  ///< 32 digits
};

/// The hash of several things, one after the other. Each text goes in behind its length, so that "ab", "c" is
/// not "a", "bc".
class ContentHasher {
 public:
  ContentHasher();
  ~ContentHasher();
  ContentHasher(const ContentHasher&) = delete;
  ContentHasher& operator=(const ContentHasher&) = delete;

  ContentHasher& add(std::string_view text);
  template <typename Number>
  requires std::is_arithmetic_v<Number> ContentHasher& add(Number number) {
    add_bytes({reinterpret_cast<const std::uint8_t*>(&number), sizeof number});
    return *this;
  }
  ContentHasher& add(const ContentHash& hash) { return add(hash.high).add(hash.low); }
  void add_bytes(std::span<const std::uint8_t> bytes);  ///< without their number
  ContentHash hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

ContentHash hash_of(std::span<const std::uint8_t> bytes);

/// Of a regular file that can be read to its end; else nothing.
std::optional<ContentHash> hash_of_file(const std::string& path);

}  // namespace talisman::sequences
