// SPDX-License-Identifier: Apache-2.0
#include "chunker/bit_stream.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "layers/check.h"

namespace talisman::chunker {
namespace {

/// Bits behind the first one of the largest number that may be written.
constexpr int kLongestNumber = 16;

}  // namespace

void BitWriter::put(std::uint32_t value, int count) {
  const std::uint64_t mask = (std::uint64_t{1} << count) - 1;
  pending_ = pending_ << count | (value & mask);
  pending_bits_ += count;
  for (; pending_bits_ >= 8; pending_bits_ -= 8)
    bytes_.push_back(static_cast<std::uint8_t>(pending_ >> (pending_bits_ - 8)));
}

void BitWriter::put_number(std::uint32_t n) {
  const int length = std::bit_width(n + 1) - 1;
  TALISMAN_CHECK_LE(length, kLongestNumber);
  put(0, length);
  put(n + 1, length + 1);
}

void BitWriter::put_signed(int v) {
  put_number(v < 0 ? 2 * static_cast<std::uint32_t>(-v) - 1 : 2 * static_cast<std::uint32_t>(v));
}

void BitWriter::put_sparse(std::span<const int> values) {
  put_number(static_cast<std::uint32_t>(values.size() - std::count(values.begin(), values.end(), 0)));
  std::uint32_t zeros = 0;
  for (const int value : values) {
    if (value == 0) {
      ++zeros;
      continue;
    }
    put_number(zeros);
    put_number(static_cast<std::uint32_t>(std::abs(value)) - 1);
    put(value < 0, 1);
    zeros = 0;
  }
}

void BitWriter::finish() {
  if (pending_bits_ > 0) put(0, 8 - pending_bits_);
}

void BitReader::fail(DecodeStatus status) {
  if (status_ == DecodeStatus::Ok) status_ = status;
}

std::uint32_t BitReader::get(int count) {
  if (status_ != DecodeStatus::Ok) return 0;
  if (position_ + count > bytes_.size() * 8) {
    fail(DecodeStatus::Truncated);
    return 0;
  }
  std::uint32_t value = 0;
  for (int left = count; left > 0;) {
    const int in_byte = 8 - static_cast<int>(position_ % 8), taken = std::min(left, in_byte);
    const std::uint32_t piece = bytes_[position_ / 8] >> (in_byte - taken) & ((1u << taken) - 1);
    value = value << taken | piece;
    position_ += taken;
    left -= taken;
  }
  return value;
}

std::uint32_t BitReader::get_number() {
  int length = 0;
  while (status_ == DecodeStatus::Ok && get(1) == 0) {
    if (++length > kLongestNumber) fail(DecodeStatus::Corrupt);
  }
  if (status_ != DecodeStatus::Ok) return 0;
  const std::uint32_t rest = get(length);
  return status_ == DecodeStatus::Ok ? (1u << length) + rest - 1 : 0;
}

int BitReader::get_signed() {
  const std::uint32_t n = get_number();
  return n % 2 == 1 ? -static_cast<int>((n + 1) / 2) : static_cast<int>(n / 2);
}

void BitReader::get_sparse(std::span<int> values) {
  std::fill(values.begin(), values.end(), 0);
  const std::uint32_t count = get_number();
  if (count > values.size()) return fail(DecodeStatus::Corrupt);
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < count && status_ == DecodeStatus::Ok; ++i, ++at) {
    at += get_number();
    const int size = static_cast<int>(get_number()) + 1;
    const bool negative = get(1) != 0;
    if (at >= values.size()) return fail(DecodeStatus::Corrupt);
    values[at] = negative ? -size : size;
  }
}

DecodeStatus BitReader::finish() {
  const std::size_t left = bytes_.size() * 8 - position_;
  if (status_ == DecodeStatus::Ok && (left >= 8 || get(static_cast<int>(left)) != 0))
    fail(DecodeStatus::Corrupt);
  return status_;
}

}  // namespace talisman::chunker
