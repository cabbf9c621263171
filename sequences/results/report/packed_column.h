// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A column of a table in as few bytes as it takes, without loss: the page unpacks it with what every browser has
/// (`DecompressionStream('deflate')`) and a loop of some lines (page/data.js).
///
///   a row        a double of 8 bytes, NaN for null; or an index of 4 bytes into a list of words
///   predicted    its bits are XORed with those of the same series' row before (the same layer's, one frame ago; 0 before
///                the first): what does not change is zero, what changes slowly has leading zeros
///   in planes    of every kBlock rows first all lowest bytes, then the second ones, …: like lies beside like
///   deflated     zlib, as a stream: memory does not grow with the rows, but for what comes out
///
/// Numbers come out bit by bit as they went in.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace talisman::sequences {

class PackedColumn {
 public:
  static constexpr int kBlock = 4096;  ///< rows

  /// `width`: bytes of a row, 4 or 8.
  explicit PackedColumn(int width);
  ~PackedColumn();
  PackedColumn(PackedColumn&&) noexcept;

  void add(std::size_t series, double value);
  void add(std::size_t series, std::uint32_t index);
  /// The packed bytes; nothing is added after it.
  const std::string& finish();

 private:
  struct Deflater;
  void add_bits(std::size_t series, std::uint64_t bits);
  void flush_block();

  int width_;
  std::vector<std::uint64_t> before_;  ///< by series
  std::vector<std::uint64_t> block_;
  std::unique_ptr<Deflater> deflater_;
};

}  // namespace talisman::sequences
