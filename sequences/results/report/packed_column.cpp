// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/packed_column.h"

#include <bit>
#include <cmath>

#include <zlib.h>

#include "layers/check.h"

namespace talisman::sequences {

struct PackedColumn::Deflater {
  z_stream stream{};
  std::string out;
  bool is_finished = false;

  Deflater() {
    const int status = deflateInit(&stream, 6);
    TALISMAN_CHECK_EQ(status, Z_OK);
  }
  ~Deflater() { deflateEnd(&stream); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  void write(std::vector<unsigned char>& bytes, int flush) {
    std::array<unsigned char, 16384> buffer;
    stream.next_in = bytes.data();
    stream.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream.next_out = buffer.data();
      stream.avail_out = static_cast<uInt>(buffer.size());
      deflate(&stream, flush);
      out.append(buffer.begin(), buffer.end() - static_cast<std::ptrdiff_t>(stream.avail_out));
    } while (stream.avail_out == 0);
  }
};

PackedColumn::PackedColumn(int width) : width_(width), deflater_(std::make_unique<Deflater>()) {}
PackedColumn::~PackedColumn() = default;
PackedColumn::PackedColumn(PackedColumn&&) noexcept = default;

void PackedColumn::add_bits(std::size_t series, std::uint64_t bits) {
  if (series >= before_.size()) before_.resize(series + 1, 0);
  block_.push_back(bits ^ before_[series]);
  before_[series] = bits;
  if (block_.size() == kBlock) flush_block();
}

void PackedColumn::add(std::size_t series, double value) {
  TALISMAN_CHECK_EQ(width_, 8);
  // One NaN of the many.
  add_bits(series, std::isnan(value) ? 0x7ff8000000000000U : std::bit_cast<std::uint64_t>(value));
}

void PackedColumn::add(std::size_t series, std::uint32_t index) {
  TALISMAN_CHECK_EQ(width_, 4);
  add_bits(series, index);
}

void PackedColumn::flush_block() {
  std::vector<unsigned char> planes;
  planes.reserve(block_.size() * static_cast<std::size_t>(width_));
  for (int byte = 0; byte < width_; ++byte)
    for (const std::uint64_t bits : block_)
      planes.push_back(static_cast<unsigned char>((bits >> (8 * byte)) & 0xff));
  deflater_->write(planes, Z_NO_FLUSH);
  block_.clear();
}

const std::string& PackedColumn::finish() {
  if (!deflater_->is_finished) {
    flush_block();
    std::vector<unsigned char> nothing;
    deflater_->write(nothing, Z_FINISH);
    deflater_->is_finished = true;
  }
  return deflater_->out;
}

}  // namespace talisman::sequences
