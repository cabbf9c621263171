// SPDX-License-Identifier: Apache-2.0
// One chunk to bytes and back; the format is that of compression.h.
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "chunker/bit_stream.h"
#include "chunker/block_transform.h"
#include "chunker/compression.h"

namespace talisman::chunker {
namespace {

constexpr int kBlocksAcross = kChunkSize / kBlockSide;
constexpr int kBlocks = kBlocksAcross * kBlocksAcross;
constexpr int kChannels = 3;
constexpr int kMiddleGrey = 128;  ///< taken off the luma, so that a block without light is no large number

constexpr std::uint8_t kRawMode = 0;
constexpr std::uint8_t kUnboundMode = 128;  ///< added to the quality

using Steps = std::array<std::array<int, kBlockTexels>, kChannels>;

/// 2^((100 - quality)/10) in sixteenths of a quarter.
int step_of(int quality) {
  constexpr int kTenthsOfAnOctave[] = {16, 17, 18, 20, 21, 23, 24, 26, 28, 30};
  const int halvings = 100 - quality;
  return kTenthsOfAnOctave[halvings % 10] << (halvings / 10);
}

Steps make_steps(int quality) {
  Steps steps;
  for (int channel = 0; channel < kChannels; ++channel)
    for (int i = 0; i < kBlockTexels; ++i) {
      const int slope = 4 + i % kBlockSide + i / kBlockSide, chroma = channel == 0 ? 1 : 2;
      steps[channel][i] = std::max(1, (step_of(quality) * slope * chroma / 4 + 8) / 16);
    }
  return steps;
}

const Steps& steps_for(int quality) {
  static const std::array<Steps, 101> all = [] {
    std::array<Steps, 101> steps;
    for (int q = 1; q <= 100; ++q) steps[q] = make_steps(q);
    return steps;
  }();
  return all[quality];
}

/// The brightest byte that a colour may have at each alpha: encode_sqrt(alpha), in integers.
const std::array<std::uint8_t, 256>& brightest() {
  static const std::array<std::uint8_t, 256> table = [] {
    std::array<std::uint8_t, 256> t{};
    for (int a = 0, v = 0; a < 256; ++a) {
      while (v < 255 && v * v + v < a * 255) ++v;  // (v + 1/2)² < 255 a
      t[a] = static_cast<std::uint8_t>(v);
    }
    return t;
  }();
  return table;
}

/// No brighter than its alpha, which was rounded to a byte: v - 1/2 ≤ √(255 (a + 1/2)).
bool is_bound(Texel t) {
  const int v = std::max({t.r, t.g, t.b});
  return t.a == 0 ? v == 0 : v * v - v <= 255 * t.a + 127;
}

bool is_bound(const Chunk& chunk) {
  return std::all_of(std::begin(chunk.texels), std::end(chunk.texels), [](Texel t) { return is_bound(t); });
}

int straight(int value, int most) { return std::min((value * 255 + most / 2) / most, 255); }
int premultiplied(int value, int most) { return (value * most + 127) / 255; }

Texel* block_at(Chunk& chunk, int block) {
  return chunk.texels + block / kBlocksAcross * kBlockSide * kChunkSize + block % kBlocksAcross * kBlockSide;
}
const Texel* block_at(const Chunk& chunk, int block) { return block_at(const_cast<Chunk&>(chunk), block); }

int offset_of(int i) { return i / kBlockSide * kChunkSize + i % kBlockSide; }

// --- Alpha ---

/// What texel i of a block is expected to be, from those before it.
int predicted_alpha(const Block& alpha, int i, int before) {
  const int x = i % kBlockSide, y = i / kBlockSide;
  if (i == 0) return before;
  if (y == 0) return alpha[i - 1];
  if (x == 0) return alpha[i - kBlockSide];
  const int a = alpha[i - 1], b = alpha[i - kBlockSide], c = alpha[i - kBlockSide - 1];
  return std::clamp(a + b - c, std::min(a, b), std::max(a, b));
}

/// As a byte with a sign: modulo 256, -128 … 127.
int wrapped(int difference) { return ((difference + 128) & 255) - 128; }

void write_alpha(const Block& alpha, int before, BitWriter& out) {
  Block difference;
  for (int i = 0; i < kBlockTexels; ++i)
    difference[i] = wrapped(alpha[i] - predicted_alpha(alpha, i, before));
  out.put_sparse(difference);
}

Block read_alpha(int before, BitReader& in) {
  Block alpha;
  in.get_sparse(alpha);
  for (int i = 0; i < kBlockTexels; ++i)
    alpha[i] = static_cast<std::uint8_t>(alpha[i] + predicted_alpha(alpha, i, before));
  return alpha;
}

// --- Colour ---

struct Colors {
  std::array<Block, kChannels> channel;
};

/// What nobody sees is free: the mean of what is seen, then drawn towards its neighbours (a few sweeps of
/// relaxation), so that the silhouette is no edge for the transform.
void fill_unseen(const std::array<bool, kBlockTexels>& shown, int mean, Block& values) {
  constexpr int kSweeps = 8;
  for (int i = 0; i < kBlockTexels; ++i)
    if (!shown[i]) values[i] = mean;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int i = 0; i < kBlockTexels; ++i) {
      if (shown[i]) continue;
      const int x = i % kBlockSide, y = i / kBlockSide;
      const int left = values[x > 0 ? i - 1 : i], right = values[x + 1 < kBlockSide ? i + 1 : i];
      const int above = values[y > 0 ? i - kBlockSide : i],
                below = values[y + 1 < kBlockSide ? i + kBlockSide : i];
      values[i] = (left + right + above + below + 2) >> 2;
    }
}

/// The block's colours as the transform takes them. In a chunk that is not brighter than its alpha they are
/// straight, and where there is none they are what costs least.
Colors colors_of(const Texel* texels, bool bound) {
  Colors colors;
  std::array<int, kChannels> sum{};
  std::array<bool, kBlockTexels> shown;
  int count = 0;
  for (int i = 0; i < kBlockTexels; ++i) {
    const Texel t = texels[offset_of(i)];
    const int most = bound ? brightest()[t.a] : 255;
    shown[i] = most > 0;
    if (!shown[i]) continue;
    const YCoCg c = ycocg_from({straight(t.r, most), straight(t.g, most), straight(t.b, most)});
    const std::array<int, kChannels> values{c.y - kMiddleGrey, c.co, c.cg};
    for (int k = 0; k < kChannels; ++k) sum[k] += colors.channel[k][i] = values[k];
    ++count;
  }
  if (count == kBlockTexels) return colors;
  for (int k = 0; k < kChannels; ++k) fill_unseen(shown, sum[k] / std::max(count, 1), colors.channel[k]);
  return colors;
}

void show_colors(const Colors& colors, const Block& alpha, bool bound, Texel* texels) {
  for (int i = 0; i < kBlockTexels; ++i) {
    const auto& c = colors.channel;
    const Rgb rgb = rgb_from({c[0][i] + kMiddleGrey, c[1][i], c[2][i]});
    const int most = bound ? brightest()[alpha[i]] : 255;
    const auto byte = [most](int v) {
      return static_cast<std::uint8_t>(premultiplied(std::clamp(v, 0, 255), most));
    };
    texels[offset_of(i)] = {byte(rgb.r), byte(rgb.g), byte(rgb.b), static_cast<std::uint8_t>(alpha[i])};
  }
}

/// Nearest level; a little less than that for what is not the mean, because nothing costs least.
int level_of(int coefficient, int step, bool is_mean) {
  const int size = std::abs(coefficient);
  const int level = is_mean ? (2 * size + step) / (2 * step) : (8 * size + 3 * step) / (8 * step);
  return coefficient < 0 ? -level : level;
}

/// Returns the level of the mean.
int write_channel(const Block& values, const std::array<int, kBlockTexels>& steps, int before,
                  BitWriter& out) {
  const Block coefficients = forward_transform(values);
  Block levels;
  for (int i = 0; i < kBlockTexels; ++i) {
    const int at = zig_zag()[i];
    levels[i] = level_of(coefficients[at], steps[at], i == 0);
  }
  out.put_signed(levels[0] - before);
  out.put_sparse(std::span(levels).subspan(1));
  return levels[0];
}

int read_channel(const std::array<int, kBlockTexels>& steps, int before, BitReader& in, Block& values) {
  Block levels, coefficients;
  // Any bytes may come in: a mean beyond the range is as good as one at its end.
  levels[0] = std::clamp(before + in.get_signed(), -kLargestCoefficient, kLargestCoefficient);
  in.get_sparse(std::span(levels).subspan(1));
  for (int i = 0; i < kBlockTexels; ++i) {
    const int at = zig_zag()[i], level = std::clamp(levels[i], -kLargestCoefficient, kLargestCoefficient);
    coefficients[at] = std::clamp(level * steps[at], -kLargestCoefficient, kLargestCoefficient);
  }
  values = inverse_transform(coefficients);
  return levels[0];
}

// --- Chunk ---

Block alpha_of(const Texel* texels) {
  Block alpha;
  for (int i = 0; i < kBlockTexels; ++i) alpha[i] = texels[offset_of(i)].a;
  return alpha;
}

/// Nothing of the colour is seen, so nothing of it is coded.
bool is_unseen(const Block& alpha, bool bound) {
  return bound && std::all_of(alpha.begin(), alpha.end(), [](int a) { return a == 0; });
}

void write_blocks(const Chunk& chunk, const Steps& steps, bool bound, BitWriter& out) {
  int alpha_before = 0;
  std::array<int, kChannels> mean_before{};
  for (int b = 0; b < kBlocks; ++b) {
    const Block alpha = alpha_of(block_at(chunk, b));
    write_alpha(alpha, alpha_before, out);
    alpha_before = alpha.back();
    if (is_unseen(alpha, bound)) continue;
    const Colors colors = colors_of(block_at(chunk, b), bound);
    for (int k = 0; k < kChannels; ++k)
      mean_before[k] = write_channel(colors.channel[k], steps[k], mean_before[k], out);
  }
  out.finish();
}

DecodeStatus read_blocks(std::span<const std::uint8_t> bytes, const Steps& steps, bool bound, Chunk& chunk) {
  BitReader in(bytes);
  int alpha_before = 0;
  std::array<int, kChannels> mean_before{};
  for (int b = 0; b < kBlocks && in.status() == DecodeStatus::Ok; ++b) {
    const Block alpha = read_alpha(alpha_before, in);
    alpha_before = alpha.back();
    if (is_unseen(alpha, bound)) continue;
    Colors colors;
    for (int k = 0; k < kChannels; ++k)
      mean_before[k] = read_channel(steps[k], mean_before[k], in, colors.channel[k]);
    show_colors(colors, alpha, bound, block_at(chunk, b));
  }
  return in.finish();
}

DecodeStatus read_raw(std::span<const std::uint8_t> bytes, Chunk& chunk) {
  if (bytes.size() < sizeof(Chunk)) return DecodeStatus::Truncated;
  if (bytes.size() > sizeof(Chunk)) return DecodeStatus::Corrupt;
  std::memcpy(chunk.texels, bytes.data(), sizeof(Chunk));
  return DecodeStatus::Ok;
}

DecodeStatus read_chunk(std::span<const std::uint8_t> bytes, Chunk& chunk) {
  if (bytes.empty()) return DecodeStatus::Truncated;
  const int mode = bytes.front(), quality = mode % kUnboundMode;
  if (mode == kRawMode) return read_raw(bytes.subspan(1), chunk);
  if (quality < 1 || quality > 100) return DecodeStatus::Corrupt;
  return read_blocks(bytes.subspan(1), steps_for(quality), mode < kUnboundMode, chunk);
}

}  // namespace

std::vector<std::uint8_t> compress_chunk(const Chunk& chunk, const CompressionOptions& options) {
  const int quality = std::clamp(options.quality, 1, 100);
  const bool bound = is_bound(chunk);
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(quality + (bound ? 0 : kUnboundMode))};
  BitWriter out(bytes);
  write_blocks(chunk, steps_for(quality), bound, out);
  if (bytes.size() <= sizeof(Chunk)) return bytes;
  const auto* raw = reinterpret_cast<const std::uint8_t*>(chunk.texels);
  bytes.assign(1, kRawMode);
  bytes.insert(bytes.end(), raw, raw + sizeof(Chunk));
  return bytes;
}

DecodeStatus decompress_chunk(std::span<const std::uint8_t> bytes, Chunk& chunk) {
  chunk = {};
  const DecodeStatus status = read_chunk(bytes, chunk);
  if (status != DecodeStatus::Ok) chunk = {};
  return status;
}

}  // namespace talisman::chunker
