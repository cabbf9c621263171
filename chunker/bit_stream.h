// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers as bits, first bit highest: the entropy code of compressed chunks.
///
///   Exp-Golomb, order 0    n ≥ 0 as the n + 1 written in binary, behind as many zeros as follow its first
///                          bit: 0 → 1, 1 → 010, 2 → 011, 3 → 00100
///   sparse run             count of values that are not zero; for each of them the zeros before it, its size
///                          less one, and a sign bit
///
/// The reader takes any bytes: what is wrong sets its status, after which it only returns zeros.

#include <cstdint>
#include <span>
#include <vector>

#include "chunker/compression.h"

namespace talisman::chunker {

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  /// The lowest `count` ≤ 32 bits of `value`.
  void put(std::uint32_t value, int count);
  void put_number(std::uint32_t n);  ///< n < 2^16
  void put_signed(int v);            ///< 0, -1, 1, -2, 2 … as 0, 1, 2, 3, 4 …; |v| < 2^15
  void put_sparse(std::span<const int> values);
  void finish();  ///< fills the last byte with zeros

 private:
  std::vector<std::uint8_t>& bytes_;
  std::uint64_t pending_ = 0;
  int pending_bits_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint32_t get(int count);  ///< ≤ 32 bits
  std::uint32_t get_number();
  int get_signed();
  void get_sparse(std::span<int> values);
  DecodeStatus status() const { return status_; }
  /// Ok only if all that is left is the filling of the last byte.
  DecodeStatus finish();

 private:
  void fail(DecodeStatus status);

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;  ///< in bits
  DecodeStatus status_ = DecodeStatus::Ok;
};

}  // namespace talisman::chunker
