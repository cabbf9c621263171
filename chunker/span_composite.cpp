// SPDX-License-Identifier: Apache-2.0
#include "chunker/span_composite.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chunker/span_composite.cpp"
#include <hwy/foreach_target.h>  // compiles the rest of this file once per instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talisman::chunker {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The texels that the pixels of a line show, one each: of one row of two chunks side by side.
struct TexelRow {
  const Texel *left, *right;  ///< the first texel of the row; null: clear
  int split;             ///< pixel k shows left[kChunkSize - split + k] below it, right[k - split] from it on
  bool may_read_beside;  ///< a vector's texels before and after the row are texels of its chunk, too
  Texel at(int k) const {
    if (k < split) return left ? left[kChunkSize - split + k] : Texel{};
    return right ? right[k - split] : Texel{};
  }
};

#if HWY_TARGET == HWY_SCALAR

// For machines without byte shuffles: the formulas of the header, a pixel at a time.
using Channels = std::array<std::uint32_t, 4>;

Channels channels(PackedPixel p) {
  const auto channel = [&](int c) { return static_cast<std::uint32_t>(p >> (16 * c)) & 0xFFFF; };
  return {channel(0), channel(1), channel(2), channel(3)};
}

Channels multiplier_lanes(const Multiplier& multiplier) {
  return {multiplier.m.r, multiplier.m.g, multiplier.m.b, multiplier.m.a};
}

std::uint32_t scaled(std::uint32_t v, std::uint32_t m) { return (v * m + kOne / 2) / kOne; }

/// Weight pairs are (256 - w) | w << 16.
std::uint32_t filtered(std::uint32_t a, std::uint32_t b, std::uint32_t weights) {
  return (a * (weights & 0xFFFF) + b * (weights >> 16) + 128) >> 8;
}

std::uint32_t decoded(const std::uint8_t* texel, int channel) {
  return texel[channel] * (channel == 3 ? 255u : texel[channel]);
}

template <bool kScaled>
void finish(Channels source, const Channels& multiplier, PackedPixel* destination) {
  for (int c = 0; kScaled && c < 4; ++c) source[c] = scaled(source[c], multiplier[c]);
  const Channels below = channels(*destination);
  PackedPixel sum = 0;
  for (int c = 0; c < 4; ++c) {
    const std::uint32_t v = source[c] + scaled(below[c], kOne - source[3]);
    sum |= static_cast<PackedPixel>(v < kOne ? v : kOne) << (16 * c);
  }
  *destination = sum;
}

template <bool kScaled>
void blend_footprints(const Footprints& f, PixelRange range, const Channels& multiplier,
                      PackedPixel* destination) {
  for (int k = range.first; k < range.last; ++k) {
    std::uint8_t top[8], bottom[8];
    std::memcpy(top, &f.top[k], sizeof top);
    std::memcpy(bottom, &f.bottom[k], sizeof bottom);
    Channels source;
    for (int c = 0; c < 4; ++c) {
      const std::uint32_t upper = filtered(decoded(top, c), decoded(top + 4, c), f.weight_x[k]);
      const std::uint32_t lower = filtered(decoded(bottom, c), decoded(bottom + 4, c), f.weight_x[k]);
      source[c] = filtered(upper, lower, f.weight_y[k]);
    }
    finish<kScaled>(source, multiplier, destination + k);
  }
}

void locate(const TileJob& job, const LineJob& line, Footprints& f, std::uint32_t* offsets) {
  for (std::uint32_t k = 0; k < kRunPixels; ++k) {
    const std::uint32_t x = line.x + k * job.step_x, y = line.y + k * job.step_y;
    f.weight_x[k] = weight_pair(static_cast<int>(x >> 8 & 255));
    f.weight_y[k] = weight_pair(static_cast<int>(y >> 8 & 255));
    offsets[k] = (y >> 16) * job.stride + (x >> 16);
  }
}

template <bool kScaled>
void blend_texel_row(const TexelRow& texels, PixelRange range, const Channels& multiplier,
                     PackedPixel* destination) {
  for (int k = range.first; k < range.last; ++k) {
    const Texel t = texels.at(k);
    Channels source;
    for (int c = 0; c < 4; ++c) source[c] = decoded(&t.r, c);
    finish<kScaled>(source, multiplier, destination + k);
  }
}

#else

// A pixel is one 64-bit lane: four 16-bit channels, or two 32-bit ones. At most 8 pixels per vector, at least
// the two that make a 128-bit block, inside which the byte shuffles work.
using Pixels = hn::CappedTag<std::uint64_t, 8>;
using Words = hn::Repartition<std::uint32_t, Pixels>;
using Ints = hn::Repartition<std::int32_t, Pixels>;
using Halves = hn::Repartition<std::uint16_t, Pixels>;
using Shorts = hn::Repartition<std::int16_t, Pixels>;
using Bytes = hn::Repartition<std::uint8_t, Pixels>;
using VPixels = hn::Vec<Pixels>;
using VHalves = hn::Vec<Halves>;
using VWords = hn::Vec<Words>;
using VShorts = hn::Vec<Shorts>;
using VInts = hn::Vec<Ints>;
using VBytes = hn::Vec<Bytes>;

constexpr std::uint64_t kSameInAll =
    0x0001000100010001u;  // times a 16-bit value: that value in all four channels

HWY_INLINE VHalves halves(std::uint64_t pixel) { return hn::BitCast(Halves(), hn::Set(Pixels(), pixel)); }

/// A 16-byte pattern in every 128-bit block.
HWY_INLINE VBytes block_pattern(const std::uint8_t* pattern) { return hn::LoadDup128(Bytes(), pattern); }

/// Even 16-bit lanes of `even`, and those of `odd` moved up to the odd lanes.
HWY_INLINE VHalves interleave_low_halves(VWords even, VWords odd) {
  return hn::OddEven(hn::BitCast(Halves(), hn::ShiftLeft<16>(odd)), hn::BitCast(Halves(), even));
}

/// round(n / kOne) of 32-bit lanes, n ≤ kOne². 2164359683 = ⌈2⁴⁷ / kOne⌉ is exact for all n below 4.4 · 10⁹.
HWY_INLINE VWords rounded_quotient(VWords n) {
  const VWords biased = hn::Add(n, hn::Set(Words(), kOne / 2));
  const VWords magic = hn::Set(Words(), 2164359683u);
  const VPixels even = hn::MulEven(biased, magic);
  const VPixels odd =
      hn::MulEven(hn::BitCast(Words(), hn::ShiftRight<32>(hn::BitCast(Pixels(), biased))), magic);
  return hn::OddEven(hn::BitCast(Words(), hn::ShiftRight<15>(odd)),
                     hn::BitCast(Words(), hn::ShiftRight<47>(even)));
}

/// round(v · m / kOne) of 16-bit lanes.
HWY_INLINE VHalves scaled(VHalves v, VHalves m) {
  const VHalves low = hn::Mul(v, m), high = hn::MulHigh(v, m);
  const VHalves even = interleave_low_halves(hn::BitCast(Words(), low), hn::BitCast(Words(), high));
  const VHalves odd = hn::OddEven(high, hn::BitCast(Halves(), hn::ShiftRight<16>(hn::BitCast(Words(), low))));
  return interleave_low_halves(rounded_quotient(hn::BitCast(Words(), even)),
                               rounded_quotient(hn::BitCast(Words(), odd)));
}

/// The one blend operation, on the pixels at `destination`.
HWY_INLINE void over(VHalves source, PackedPixel* destination) {
  alignas(16) static constexpr std::uint8_t kAlpha[16] = {6,  7,  6,  7,  6,  7,  6,  7,
                                                          14, 15, 14, 15, 14, 15, 14, 15};
  const VHalves alpha = hn::TableLookupBytes(source, hn::BitCast(Halves(), block_pattern(kAlpha)));
  const VHalves one = halves(kOne * kSameInAll);
  if (hn::AllTrue(Halves(), hn::Eq(alpha, one))) {
    hn::Store(hn::BitCast(Pixels(), source), Pixels(), destination);
    return;
  }
  const VHalves below = hn::BitCast(Halves(), hn::Load(Pixels(), destination));
  const VHalves shining_through = scaled(below, hn::Sub(one, alpha));
  const VHalves sum = hn::Min(hn::SaturatedAdd(source, shining_through), one);
  hn::Store(hn::BitCast(Pixels(), sum), Pixels(), destination);
}

template <bool kScaled>
HWY_INLINE void finish(VHalves source, VHalves multiplier, PackedPixel* destination) {
  over(kScaled ? scaled(source, multiplier) : source, destination);
}

/// (a · (256 - w) + b · w + 128) >> 8 for pairs (a, b) of lanes biased by -2¹⁵, so that they fit the signed
/// multiply; the result has the same bias.
HWY_INLINE VInts filtered(VShorts pairs, VShorts weights) {
  VInts odd = hn::Zero(Ints());
  const VInts sum = hn::ReorderWidenMulAccumulate(Ints(), pairs, weights, hn::Set(Ints(), 128), odd);
  return hn::ShiftRight<8>(hn::RearrangeToOddPlusEven(sum, odd));
}

HWY_INLINE VShorts biased(VHalves v) {
  return hn::BitCast(Shorts(), hn::Xor(v, halves(0x8000u * kSameInAll)));
}

struct RowSums {
  VInts red_blue, green_alpha;  // horizontally filtered, biased
};

/// Decodes two texels per pixel and filters them horizontally.
HWY_INLINE RowSums filtered_row(VPixels texel_pairs, VShorts weights) {
  constexpr std::uint8_t x = 0x80;  // zero
  alignas(16) static constexpr std::uint8_t kRedBlue[16] = {0, x, 4,  x, 2,  x, 6,  x,
                                                            8, x, 12, x, 10, x, 14, x};
  alignas(16) static constexpr std::uint8_t kGreenAlpha[16] = {1, x, 5,  x, 3,  x, 7,  x,
                                                               9, x, 13, x, 11, x, 15, x};
  const VBytes bytes = hn::BitCast(Bytes(), texel_pairs);
  const VHalves rb = hn::BitCast(Halves(), hn::TableLookupBytesOr0(bytes, block_pattern(kRedBlue)));
  const VHalves ga = hn::BitCast(Halves(), hn::TableLookupBytesOr0(bytes, block_pattern(kGreenAlpha)));
  // Colour is squared and alpha times 255: a byte or'ed with 255 is 255.
  const VHalves factor = hn::Or(ga, halves(0x00FF00FF00000000u));
  return {filtered(biased(hn::Mul(rb, rb)), weights), filtered(biased(hn::Mul(ga, factor)), weights)};
}

/// Filters two rows vertically, one channel pair.
HWY_INLINE VWords filtered_rows(VInts top, VInts bottom, VShorts weights) {
  const VHalves pairs = interleave_low_halves(hn::BitCast(Words(), top), hn::BitCast(Words(), bottom));
  return hn::BitCast(Words(), filtered(hn::BitCast(Shorts(), pairs), weights));
}

/// The weight pair of each pixel, in both its 32-bit lanes.
HWY_INLINE VShorts load_weights(const std::uint32_t* pairs) {
  const VPixels w = hn::PromoteTo(Pixels(), hn::Load(hn::Rebind<std::uint32_t, Pixels>(), pairs));
  return hn::BitCast(Shorts(), hn::Or(w, hn::ShiftLeft<32>(w)));
}

/// Filter and over for the pixels first … last-1, rounded out to whole vectors.
template <bool kScaled>
HWY_INLINE void blend_footprints(const Footprints& f, PixelRange range, VHalves multiplier,
                                 PackedPixel* destination) {
  const int lanes = static_cast<int>(hn::Lanes(Pixels()));
  for (int k = range.first & -lanes; k < range.last; k += lanes) {
    const VPixels top = hn::Load(Pixels(), f.top + k), bottom = hn::Load(Pixels(), f.bottom + k);
    if (hn::AllTrue(Pixels(), hn::Eq(hn::Or(top, bottom), hn::Zero(Pixels())))) continue;
    const VShorts across = load_weights(f.weight_x + k), down = load_weights(f.weight_y + k);
    const RowSums upper = filtered_row(top, across), lower = filtered_row(bottom, across);
    const VWords rb = filtered_rows(upper.red_blue, lower.red_blue, down);
    const VWords ga = filtered_rows(upper.green_alpha, lower.green_alpha, down);
    const VHalves source = hn::Xor(interleave_low_halves(rb, ga), halves(0x8000u * kSameInAll));
    finish<kScaled>(source, multiplier, destination + k);
  }
}

HWY_INLINE VWords weight_pairs(VWords position) {
  const VWords w = hn::And(hn::ShiftRight<8>(position), hn::Set(Words(), 255));
  return hn::Add(hn::Sub(hn::Set(Words(), 256), w), hn::ShiftLeft<16>(w));
}

/// Weights of a whole run, and where in the window each footprint starts.
HWY_INLINE void locate(const TileJob& job, const LineJob& line, Footprints& f, std::uint32_t* offsets) {
  const Words d;
  const VWords stride = hn::Set(d, job.stride);
  for (std::size_t k = 0; k < kRunPixels; k += hn::Lanes(d)) {
    const VWords steps = hn::Iota(d, static_cast<std::uint32_t>(k));
    const VWords x = hn::Add(hn::Set(d, line.x), hn::Mul(steps, hn::Set(d, job.step_x)));
    const VWords y = hn::Add(hn::Set(d, line.y), hn::Mul(steps, hn::Set(d, job.step_y)));
    hn::Store(weight_pairs(x), d, f.weight_x + k);
    hn::Store(weight_pairs(y), d, f.weight_y + k);
    hn::Store(hn::Add(hn::Mul(hn::ShiftRight<16>(y), stride), hn::ShiftRight<16>(x)), d, offsets + k);
  }
}

/// round(v · b / 255) of 16-bit lanes, b ≤ 255, v ≤ kOne. (b · 257) / 2¹⁶ is b / 255 less one part in 2¹⁶, so that the quotient is
/// short by less than 1 + 65025 / 2¹⁶: the remainder is below 508 and says how often to add one.
HWY_INLINE VHalves scaled_by_byte(VHalves v, VHalves b) {
  const VHalves quotient = hn::MulHigh(v, hn::Or(b, hn::ShiftLeft<8>(b)));
  const VHalves rest = hn::Sub(hn::Mul(v, b), hn::Mul(quotient, halves(255 * kSameInAll)));
  const auto signed_rest = hn::BitCast(Shorts(), rest);
  const auto once = hn::VecFromMask(Shorts(), hn::Gt(signed_rest, hn::Set(Shorts(), 127)));
  const auto twice = hn::VecFromMask(Shorts(), hn::Gt(signed_rest, hn::Set(Shorts(), 382)));
  return hn::Sub(quotient, hn::BitCast(Halves(), hn::Add(once, twice)));  // minus minus one
}

/// Lays whole texels over the pixels at `destination`. An alpha of one byte leaves 255 (255 - a) of kOne = 255² to what is below, so that
/// `over` needs to divide by 255 alone.
template <bool kScaled>
HWY_INLINE void lay_texels(VHalves v, VHalves multiplier, PackedPixel* destination) {
  alignas(16) static constexpr std::uint8_t kAlpha[16] = {6,  7,  6,  7,  6,  7,  6,  7,
                                                          14, 15, 14, 15, 14, 15, 14, 15};
  const VHalves source = hn::Mul(v, hn::Or(v, halves(0x00FF000000000000u)));  // 16-bit linear
  if constexpr (kScaled) return finish<true>(source, multiplier, destination);
  const VHalves alpha = hn::TableLookupBytes(v, hn::BitCast(Halves(), block_pattern(kAlpha)));
  const VHalves left = hn::Xor(alpha, halves(255 * kSameInAll));
  if (hn::AllTrue(Halves(), hn::Eq(left, hn::Zero(Halves())))) {
    hn::Store(hn::BitCast(Pixels(), source), Pixels(), destination);
    return;
  }
  const VHalves below = hn::BitCast(Halves(), hn::Load(Pixels(), destination));
  const VHalves sum =
      hn::Min(hn::SaturatedAdd(source, scaled_by_byte(below, left)), halves(kOne * kSameInAll));
  hn::Store(hn::BitCast(Pixels(), sum), Pixels(), destination);
}

/// Bytes of as many texels as there are pixels in a vector, in 16 bits each; null: clear.
HWY_INLINE VHalves load_texels(const Texel* texels) {
  if (!texels) return hn::Zero(Halves());
  return hn::PromoteTo(Halves(), hn::LoadU(hn::Rebind<std::uint8_t, Halves>(), &texels->r));
}

/// Where a vector shows both chunks.
HWY_INLINE VHalves load_across(const TexelRow& row, int k, int lanes) {
  if (!row.may_read_beside) {
    Texel texels[8];
    for (int i = 0; i < lanes; ++i) texels[i] = row.at(k + i);
    return load_texels(texels);
  }
  const VHalves left = load_texels(row.left ? row.left + (kChunkSize - row.split + k) : nullptr);
  const VHalves right = load_texels(row.right ? row.right + (k - row.split) : nullptr);
  const auto is_left = hn::FirstN(Pixels(), static_cast<std::size_t>(row.split - k));
  return hn::BitCast(Halves(),
                     hn::IfThenElse(is_left, hn::BitCast(Pixels(), left), hn::BitCast(Pixels(), right)));
}

/// No filter, no gathering. Pixels beside `range` show texels outside the sprite, which are clear.
template <bool kScaled>
HWY_INLINE void blend_texel_row(const TexelRow& row, PixelRange range, VHalves multiplier,
                                PackedPixel* destination) {
  const int lanes = static_cast<int>(hn::Lanes(Pixels()));
  int k = range.first & -lanes;
  for (; k + lanes <= row.split && k < range.last; k += lanes)
    if (row.left)
      lay_texels<kScaled>(load_texels(row.left + (kChunkSize - row.split + k)), multiplier, destination + k);
  if (k < row.split && k < range.last) {
    lay_texels<kScaled>(load_across(row, k, lanes), multiplier, destination + k);
    k += lanes;
  }
  for (; k < range.last && row.right; k += lanes)
    lay_texels<kScaled>(load_texels(row.right + (k - row.split)), multiplier, destination + k);
}

VHalves multiplier_lanes(const Multiplier& multiplier) {
  std::uint64_t packed;
  std::memcpy(&packed, &multiplier.m, sizeof packed);
  return halves(packed);
}

#endif  // HWY_TARGET == HWY_SCALAR

/// Fills the footprints of a line; those beside the sprite in the vectors that will be blended are clear.
HWY_INLINE void fetch(const TileJob& job, const LineJob& line, Footprints& f) {
  alignas(64) std::uint32_t offsets[kRunPixels];
  locate(job, line, f, offsets);
  constexpr int kMostLanes = 8;
  const auto clear = [&](int from, int to) {
    for (int k = from; k < to; ++k) f.top[k] = f.bottom[k] = 0;
  };
  clear(line.pixels.first & -kMostLanes, line.pixels.first);
  for (int k = line.pixels.first; k < line.pixels.last; ++k) {
    const Texel* at = job.window + offsets[k];
    std::memcpy(&f.top[k], at, sizeof(std::uint64_t));
    std::memcpy(&f.bottom[k], at + job.stride, sizeof(std::uint64_t));
  }
  clear(line.pixels.last, (line.pixels.last + kMostLanes - 1) & -kMostLanes);
}

template <bool kScaled>
void blend_lines(const TileJob& job, PackedPixel* tile) {
  const auto multiplier = multiplier_lanes(job.multiplier);
  Footprints footprints;
  for (int row = 0; row < kBandLines; ++row) {
    LineJob line = job.lines[row];
    if (line.pixels.empty()) continue;
    line.x -= job.origin_x;
    line.y -= job.origin_y;
    PackedPixel* destination = tile + row * kRunPixels;
    fetch(job, line, footprints);
    blend_footprints<kScaled>(footprints, line.pixels, multiplier, destination);
  }
}

template <bool kScaled>
void blend_lattice_lines(const LatticeJob& job, PackedPixel* tile) {
  const auto multiplier = multiplier_lanes(job.multiplier);
  for (int k = job.lines.first; k < job.lines.last; ++k) {
    const int below = job.row + k >= kChunkSize, row = (job.row + k) % kChunkSize;
    const auto start = [row](const Texel* chunk) { return chunk ? chunk + row * kChunkSize : nullptr; };
    const TexelRow texels{start(job.chunks[below][0]), start(job.chunks[below][1]), kChunkSize - job.column,
                          row > 0 && row < kChunkSize - 1};
    blend_texel_row<kScaled>(texels, job.columns, multiplier, tile + k * kRunPixels);
  }
}

void blend_lattice_lanes(const LatticeJob& job, PackedPixel* tile) {
  job.multiplier.is_one() ? blend_lattice_lines<false>(job, tile) : blend_lattice_lines<true>(job, tile);
}

void blend_tile_lanes(const TileJob& job, PackedPixel* tile) {
  job.multiplier.is_one() ? blend_lines<false>(job, tile) : blend_lines<true>(job, tile);
}

void blend_run_lanes(const Footprints& f, const Multiplier& multiplier, PackedPixel* destination) {
  const PixelRange all{0, kRunPixels};
  const auto lanes = multiplier_lanes(multiplier);
  multiplier.is_one() ? blend_footprints<false>(f, all, lanes, destination)
                      : blend_footprints<true>(f, all, lanes, destination);
}

}  // namespace HWY_NAMESPACE
}  // namespace talisman::chunker
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talisman::chunker {

HWY_EXPORT(blend_tile_lanes);
HWY_EXPORT(blend_run_lanes);
HWY_EXPORT(blend_lattice_lanes);

void blend_tile(const TileJob& job, PackedPixel* tile) { HWY_DYNAMIC_DISPATCH(blend_tile_lanes)(job, tile); }

void blend_lattice(const LatticeJob& job, PackedPixel* tile) {
  HWY_DYNAMIC_DISPATCH(blend_lattice_lanes)(job, tile);
}

void blend_run(const Footprints& footprints, const Multiplier& multiplier, PackedPixel* destination) {
  HWY_DYNAMIC_DISPATCH(blend_run_lanes)(footprints, multiplier, destination);
}

std::vector<std::int64_t> instruction_sets() { return hwy::SupportedAndGeneratedTargets(); }

const char* instruction_set_name(std::int64_t set) { return hwy::TargetName(set); }

void use_instruction_set(std::int64_t set) {
  hwy::SetSupportedTargetsForTest(set);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace talisman::chunker
#endif  // HWY_ONCE
