// SPDX-License-Identifier: Apache-2.0
#include "chunker/compression.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "chunker/bit_stream.h"
#include "chunker/block_transform.h"

namespace talisman::chunker {
namespace {

constexpr int kTexels = kChunkSize * kChunkSize;

std::uint8_t byte(double v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0, 255.0) + 0.5); }

/// A soft picture under an antialiased disc: what a typical sprite's chunk looks like. Colours are
/// premultiplied.
Chunk disc_chunk(double radius = 12, double phase = 0) {
  Chunk chunk;
  for (int y = 0; y < kChunkSize; ++y)
    for (int x = 0; x < kChunkSize; ++x) {
      const double a = std::clamp(radius - std::hypot(x - 15.5, y - 15.5) + 0.5, 0.0, 1.0);
      const auto shade = [&](double f) {
        return static_cast<float>(a * (0.5 + 0.4 * std::sin(f * x + 0.1 * y + phase)));
      };
      chunk.texels[y * kChunkSize + x] = encode({shade(0.2), shade(0.15), shade(0.1), static_cast<float>(a)});
    }
  return chunk;
}

Chunk noise_chunk(unsigned seed) {
  std::mt19937 random(seed);
  Chunk chunk;
  for (Texel& t : chunk.texels)
    t = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
         static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random())};
  return chunk;
}

Chunk uniform_chunk(Texel t) {
  Chunk chunk;
  for (Texel& texel : chunk.texels) texel = t;
  return chunk;
}

Chunk there_and_back(const Chunk& chunk, int quality) {
  const auto bytes = compress_chunk(chunk, {quality});
  Chunk decoded = uniform_chunk({1, 2, 3, 4});  // whatever was there before is replaced
  EXPECT_EQ(decompress_chunk(bytes, decoded), DecodeStatus::Ok);
  return decoded;
}

int largest_difference(const Chunk& a, const Chunk& b) {
  int largest = 0;
  for (int i = 0; i < kTexels; ++i)
    for (const int d :
         {a.texels[i].r - b.texels[i].r, a.texels[i].g - b.texels[i].g, a.texels[i].b - b.texels[i].b})
      largest = std::max(largest, std::abs(d));
  return largest;
}

void expect_same_alpha(const Chunk& a, const Chunk& b) {
  for (int i = 0; i < kTexels; ++i) ASSERT_EQ(a.texels[i].a, b.texels[i].a) << "texel " << i;
}

Sprite sprite_of(const std::vector<Chunk>& chunks) {
  Sprite sprite({static_cast<int>(chunks.size()) * kChunkSize, kChunkSize});
  for (std::size_t i = 0; i < chunks.size(); ++i) sprite.store(static_cast<int>(i), 0, chunks[i]);
  return sprite;
}

double psnr(const Chunk& chunk, int quality) {
  const Sprite sprite = sprite_of({chunk});
  return compression_error(sprite, decompress(compress(sprite, {quality}))).color_psnr_db();
}

// --- The parts ---

TEST(BlockTransform, IsThatOfTheTextbookInFloatingPoint) {
  std::mt19937 random(71);
  Block f;
  for (int& v : f) v = static_cast<int>(random() % 511) - 255;
  const Block fixed = forward_transform(f);
  for (int v = 0; v < kBlockSide; ++v)
    for (int u = 0; u < kBlockSide; ++u) {
      double sum = 0;
      for (int y = 0; y < kBlockSide; ++y)
        for (int x = 0; x < kBlockSide; ++x)
          sum += f[y * kBlockSide + x] * std::cos((2 * x + 1) * u * M_PI / 16) *
                 std::cos((2 * y + 1) * v * M_PI / 16);
      sum *= (u == 0 ? std::sqrt(0.125) : 0.5) * (v == 0 ? std::sqrt(0.125) : 0.5);
      EXPECT_NEAR(fixed[v * kBlockSide + u] / 4.0, sum, 1) << u << " " << v;
    }
}

TEST(BlockTransform, ThereAndBackIsOffByAtMostOne) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    Block f;
    // Both ends of the range in one block are the hardest.
    for (int& v : f)
      v = seed % 2 == 0 ? static_cast<int>(random() % 511) - 255 : (random() % 2 == 0 ? 255 : -255);
    const Block back = inverse_transform(forward_transform(f));
    for (int i = 0; i < kBlockTexels; ++i) ASSERT_LE(std::abs(back[i] - f[i]), 1) << "seed " << seed;
  }
}

TEST(BlockTransform, TheLargestCoefficientsDoNotOverflow) {
  // At the first place all 64 basis functions add up; a sum that wraps would be far from theirs.
  Block F;
  F.fill(kLargestCoefficient);
  const Block f = inverse_transform(F);
  double row = std::sqrt(0.125);
  for (int k = 1; k < kBlockSide; ++k) row += 0.5 * std::cos(k * M_PI / 16);
  EXPECT_NEAR(f[0], row * row * kLargestCoefficient / 4, 100);
  for (const int v : f) EXPECT_LT(std::abs(v), 1 << 18);
}

TEST(BlockTransform, TheZigZagVisitsEveryPlaceOnceFromLowToHigh) {
  std::array<int, kBlockTexels> visits{};
  int frequency = 0;
  for (const int at : zig_zag()) {
    ++visits[at];
    const int now = at % kBlockSide + at / kBlockSide;
    EXPECT_GE(now, frequency);
    EXPECT_LE(now, frequency + 1);
    frequency = now;
  }
  for (const int n : visits) EXPECT_EQ(n, 1);
  EXPECT_EQ(zig_zag()[0], 0);
  EXPECT_EQ(zig_zag()[63], 63);
}

TEST(YCoCg, EveryCornerAndRandomColorsAreReversible) {
  std::mt19937 random(5);
  for (int i = 0; i < 4096; ++i) {
    const auto channel = [&](int bit) {
      return i < 8 ? (i >> bit & 1) * 255 : static_cast<int>(random() % 256);
    };
    const Rgb c{channel(0), channel(1), channel(2)};
    const YCoCg y = ycocg_from(c);
    EXPECT_TRUE(y.y >= 0 && y.y <= 255) << y.y;
    const Rgb back = rgb_from(y);
    EXPECT_TRUE(back.r == c.r && back.g == c.g && back.b == c.b) << c.r << " " << c.g << " " << c.b;
  }
}

TEST(BitStream, NumbersAndRunsComeBack) {
  std::vector<std::uint8_t> bytes;
  BitWriter out(bytes);
  const std::vector<int> sparse{0, 0, -5, 0, 1, 128, 0, 0};
  for (const std::uint32_t n : {0u, 1u, 2u, 3u, 7u, 8u, 65535u}) out.put_number(n);
  for (const int v : {0, -1, 1, -32767, 32767}) out.put_signed(v);
  out.put_sparse(sparse);
  out.put(0xdeadbeef, 32);
  out.finish();

  BitReader in(bytes);
  for (const std::uint32_t n : {0u, 1u, 2u, 3u, 7u, 8u, 65535u}) EXPECT_EQ(in.get_number(), n);
  for (const int v : {0, -1, 1, -32767, 32767}) EXPECT_EQ(in.get_signed(), v);
  std::vector<int> back(sparse.size(), 9);
  in.get_sparse(back);
  EXPECT_EQ(back, sparse);
  EXPECT_EQ(in.get(32), 0xdeadbeef);
  EXPECT_EQ(in.finish(), DecodeStatus::Ok);
}

TEST(BitStream, TheCodesAreThoseOfTheHeader) {
  std::vector<std::uint8_t> bytes;
  BitWriter out(bytes);
  for (const std::uint32_t n : {0u, 1u, 2u, 3u}) out.put_number(n);  // 1 010 011 00100
  out.finish();
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0b10100110, 0b01000000}));
}

TEST(BitStream, WhatIsWrongIsSaidOnceAndReadsAsZero) {
  const std::vector<std::uint8_t> zeros(8, 0);
  BitReader endless(zeros);  // a number without end
  EXPECT_EQ(endless.get_number(), 0u);
  EXPECT_EQ(endless.status(), DecodeStatus::Corrupt);
  EXPECT_EQ(endless.get(8), 0u);
  EXPECT_EQ(endless.finish(), DecodeStatus::Corrupt);

  BitReader empty({});
  EXPECT_EQ(empty.get(1), 0u);
  EXPECT_EQ(empty.status(), DecodeStatus::Truncated);

  const std::vector<std::uint8_t> filled{0b10000001};  // the filling is not zero
  BitReader odd(filled);
  odd.get_number();
  EXPECT_EQ(odd.finish(), DecodeStatus::Corrupt);
}

TEST(BitStream, RunsBeyondTheirBlockAreCorrupt) {
  const auto status_of = [](const std::vector<std::uint32_t>& numbers) {
    std::vector<std::uint8_t> bytes;
    BitWriter out(bytes);
    for (const std::uint32_t n : numbers) out.put_number(n);
    out.put(0, 32);
    BitReader in(bytes);
    std::vector<int> values(4);
    in.get_sparse(values);
    return in.status();
  };
  EXPECT_EQ(status_of({5}), DecodeStatus::Corrupt) << "more values than there are places";
  EXPECT_EQ(status_of({1, 4, 0}), DecodeStatus::Corrupt) << "a place behind the last";
  EXPECT_EQ(status_of({1, 3, 0}), DecodeStatus::Ok);
}

// --- Chunks ---

TEST(CompressChunk, AlphaIsLosslessAtEveryQuality) {
  for (const int quality : {1, 50, 80, 100})
    for (const Chunk& chunk :
         {disc_chunk(), disc_chunk(3, 1), disc_chunk(40), uniform_chunk({40, 30, 20, 128})})
      expect_same_alpha(there_and_back(chunk, quality), chunk);
}

TEST(CompressChunk, HighestQualityIsOffByACodeValueOrTwo) {
  for (const Chunk& chunk :
       {disc_chunk(), disc_chunk(20, 2), uniform_chunk({255, 0, 0, 255}), uniform_chunk({0, 0, 0, 255})})
    EXPECT_LE(largest_difference(there_and_back(chunk, 100), chunk), 2);
}

TEST(CompressChunk, MoreQualityIsMoreBytesAndLessError) {
  const Chunk chunk = disc_chunk(14);
  std::size_t bytes = 0;
  double db = 0;
  for (const int quality : {20, 40, 60, 80, 100}) {
    const std::size_t now = compress_chunk(chunk, {quality}).size();
    EXPECT_GT(now, bytes) << quality;
    EXPECT_GT(psnr(chunk, quality), db) << quality;
    bytes = now;
    db = psnr(chunk, quality);
  }
}

TEST(CompressChunk, AVariedChunkAtTheDefaultIsAFifthAndLooksTheSame) {
  // Waves of another length in each channel leave the chroma nothing to save; real sprites get smaller.
  const auto bytes = compress_chunk(disc_chunk(40), {});
  EXPECT_LT(bytes.size(), sizeof(Chunk) / 5);
  EXPECT_GT(psnr(disc_chunk(40), CompressionOptions{}.quality), 50);
}

TEST(CompressChunk, QualityBeyondItsRangeCountsAsTheNearestEnd) {
  EXPECT_EQ(compress_chunk(disc_chunk(), {-7}), compress_chunk(disc_chunk(), {1}));
  EXPECT_EQ(compress_chunk(disc_chunk(), {1000}), compress_chunk(disc_chunk(), {100}));
}

TEST(CompressChunk, UniformChunksTakeSomeBytes) {
  EXPECT_LE(compress_chunk(uniform_chunk({120, 60, 30, 255}), {}).size(), 40u);
  EXPECT_LE(compress_chunk(uniform_chunk({0, 0, 0, 128}), {}).size(), 40u) << "a shadow";
}

// A sprite of one texel is a chunk that is clear but for one corner.
TEST(CompressChunk, OneTexelComesBack) {
  for (const int place : {0, 31, 31 * 32, 1023, 500}) {
    Chunk chunk{};
    chunk.texels[place] = {200, 100, 50, 255};
    const Chunk back = there_and_back(chunk, 80);
    EXPECT_LE(largest_difference(back, chunk), 2) << place;
    expect_same_alpha(back, chunk);
    EXPECT_LE(compress_chunk(chunk, {}).size(), 24u);
  }
}

TEST(CompressChunk, AnAntialiasedEdgeCostsTheColorNothing) {
  // Half of the chunk is a constant colour; premultiplied, its edge is a ramp. Straight colours make it flat.
  Chunk chunk{};
  for (int y = 0; y < kChunkSize; ++y)
    for (int x = 0; x < kChunkSize; ++x) {
      const float a = static_cast<float>(std::clamp(16.3 + 0.3 * y - x, 0.0, 1.0));
      chunk.texels[y * kChunkSize + x] = encode({a * 0.8f, a * 0.3f, a * 0.1f, a});
    }
  EXPECT_GT(psnr(chunk, 40), 38);
  EXPECT_LT(compress_chunk(chunk, {40}).size(), 260u);
}

TEST(CompressChunk, NeverBrighterThanAlpha) {
  // Hard edges at the lowest quality ring as much as they can. Light comes from premultiplied white.
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    Chunk chunk{};
    for (Texel& t : chunk.texels) {
      const float a = static_cast<float>(random() % 5) / 4;
      t = encode({a * static_cast<float>(random() % 2), a, a * static_cast<float>(random() % 3) / 2, a});
    }
    const Chunk back = there_and_back(chunk, 1 + static_cast<int>(seed));
    for (const Texel t : back.texels) {
      const int most = encode_sqrt(static_cast<float>(t.a) / 255);
      ASSERT_LE(std::max({t.r, t.g, t.b}), most) << "seed " << seed << " alpha " << int{t.a};
    }
  }
}

TEST(CompressChunk, ColorRoundedAboveASmallAlphaIsStillBound) {
  // White at alpha 1.4/255: alpha rounds down to 1, the colour up to 19, which is brighter than 1/255.
  const float a = 1.4f / 255;
  const Chunk chunk = uniform_chunk(encode({a, a, a, a}));
  ASSERT_GT(int{chunk.texels[0].r}, int{encode_sqrt(1.0f / 255)});
  EXPECT_LE(largest_difference(there_and_back(chunk, 100), chunk), 4);
  EXPECT_EQ(int{there_and_back(chunk, 100).texels[0].r}, int{encode_sqrt(1.0f / 255)});
}

TEST(CompressChunk, LightWithoutAlphaIsKept) {
  // A highlight sprite: alpha 0 everywhere, so that over becomes plus. It must not be clamped to its alpha.
  Chunk chunk{};
  for (int y = 0; y < kChunkSize; ++y)
    for (int x = 0; x < kChunkSize; ++x) {
      const std::uint8_t v = byte(250 * std::exp(-0.02 * (std::pow(x - 16, 2) + std::pow(y - 16, 2))));
      chunk.texels[y * kChunkSize + x] = {v, v, static_cast<std::uint8_t>(v / 2), 0};
    }
  EXPECT_LE(largest_difference(there_and_back(chunk, 80), chunk), 8);
  EXPECT_LT(compress_chunk(chunk, {80}).size(), sizeof(Chunk) / 4);
  expect_same_alpha(there_and_back(chunk, 80), chunk);
}

TEST(CompressChunk, NoiseIsStoredAsItIs) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Chunk chunk = noise_chunk(seed);
    const auto bytes = compress_chunk(chunk, {100});
    EXPECT_EQ(bytes.size(), sizeof(Chunk) + 1) << "seed " << seed;
    EXPECT_EQ(largest_difference(there_and_back(chunk, 100), chunk), 0) << "seed " << seed;
  }
}

// --- Hostile bytes ---

TEST(DecompressChunk, EveryTruncationIsRejected) {
  for (const Chunk& chunk : {disc_chunk(), noise_chunk(1)}) {
    const auto bytes = compress_chunk(chunk, {80});
    for (std::size_t length = 0; length<bytes.size(); length += bytes.size()> 4000 ? 97 : 1) {
      Chunk decoded = disc_chunk();
      ASSERT_EQ(decompress_chunk(std::span(bytes).first(length), decoded), DecodeStatus::Truncated) << length;
      ASSERT_EQ(largest_difference(decoded, Chunk{}), 0) << "a rejected chunk is clear";
    }
  }
}

TEST(DecompressChunk, BytesLeftOverAreCorrupt) {
  for (const Chunk& chunk : {disc_chunk(), noise_chunk(1)}) {
    auto bytes = compress_chunk(chunk, {80});
    bytes.push_back(0);
    Chunk decoded;
    EXPECT_EQ(decompress_chunk(bytes, decoded), DecodeStatus::Corrupt);
  }
}

TEST(DecompressChunk, UnknownModesAreCorrupt) {
  for (const int mode : {101, 127, 128, 229, 255}) {
    std::vector<std::uint8_t> bytes(100, 0xff);
    bytes[0] = static_cast<std::uint8_t>(mode);
    Chunk decoded;
    EXPECT_EQ(decompress_chunk(bytes, decoded), DecodeStatus::Corrupt) << mode;
  }
}

TEST(DecompressChunk, RandomAndDamagedBytesNeverCrash) {
  int accepted = 0, rejected = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(random() % 600);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    if (seed % 2 == 0) {
      bytes = compress_chunk(disc_chunk(2 + seed % 20), {static_cast<int>(seed % 100)});
      for (int flips = 0; flips < 3; ++flips) bytes[random() % bytes.size()] ^= 1u << random() % 8;
    }
    Chunk decoded;
    const DecodeStatus status = decompress_chunk(bytes, decoded);
    ++(status == DecodeStatus::Ok ? accepted : rejected);
    if (status == DecodeStatus::Ok) continue;
    ASSERT_EQ(largest_difference(decoded, Chunk{}), 0) << "seed " << seed;
  }
  EXPECT_GT(rejected, 1000);
  EXPECT_GT(accepted, 0) << "some damage is only another picture";
}

// --- Sprites ---

TEST(CompressSprite, ClearChunksCostTheirReferenceOnly) {
  Sprite sprite({5 * kChunkSize, 3 * kChunkSize});
  const CompressedSprite clear = compress(sprite, {});
  EXPECT_EQ(clear.bytes(), 15 * 4);
  EXPECT_EQ(clear.stored_chunks(), 0);
  EXPECT_EQ(decompress(clear).stored_chunks(), 0);

  sprite.store(3, 1, disc_chunk());
  const CompressedSprite one = compress(sprite, {});
  EXPECT_EQ(one.bytes(), 15 * 4 + static_cast<std::int64_t>(compress_chunk(disc_chunk(), {}).size()));
  EXPECT_EQ(one.stored_chunks(), 1);
  EXPECT_TRUE(one.chunk_bytes(2, 1).empty());
}

TEST(CompressSprite, WithoutTexelsIsNothing) {
  const CompressedSprite empty = compress(Sprite(), {});
  EXPECT_EQ(empty.bytes(), 0);
  EXPECT_EQ(decompress(empty).size_px(), layers::ivec2(0, 0));
  EXPECT_EQ(compression_error(Sprite(), Sprite()).color_psnr_db(), HUGE_VAL);
}

TEST(CompressSprite, EachChunkIsFoundAndDecodedAlone) {
  Sprite sprite({4 * kChunkSize, 4 * kChunkSize});
  for (int i = 0; i < 16; i += 3) sprite.store(i % 4, i / 4, disc_chunk(4 + i, i));
  const CompressedSprite compressed = compress(sprite, {60});
  for (int i = 15; i >= 0; --i) {  // in another order than they were written in
    Chunk decoded;
    ASSERT_EQ(decompress_chunk(compressed, i % 4, i / 4, decoded), DecodeStatus::Ok);
    const Chunk alone = i % 3 == 0 ? there_and_back(disc_chunk(4 + i, i), 60) : Chunk{};
    EXPECT_EQ(std::memcmp(&decoded, &alone, sizeof(Chunk)), 0) << "chunk " << i;
  }
  EXPECT_EQ(decompress(compressed).stored_chunks(), 6);
}

TEST(CompressSprite, TexelsOutsideStayClear) {
  // Light without alpha has nothing that masks it: what the quantisation leaves outside must be cut off.
  Sprite sprite({5, 7});
  Chunk chunk{};
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 5; ++x) chunk.texels[y * kChunkSize + x] = {200, 90, 10, 0};
  sprite.store(0, 0, chunk);
  const Sprite shown = decompress(compress(sprite, {20}));
  ASSERT_NE(shown.chunk(0, 0), nullptr);
  for (int y = 0; y < kChunkSize; ++y)
    for (int x = y < 7 ? 5 : 0; x < kChunkSize; ++x)
      EXPECT_EQ(shown.chunk(0, 0)->texels[y * kChunkSize + x], Texel{}) << x << " " << y;
}

TEST(CompressSprite, OneTexelSpriteSurvives) {
  Sprite sprite({1, 1});
  Chunk chunk{};
  chunk.texels[0] = {180, 180, 180, 255};
  sprite.store(0, 0, chunk);
  const Texel back = decompress(compress(sprite, {})).texel(0, 0);
  EXPECT_EQ(back.a, 255);
  EXPECT_NEAR(back.r, 180, 2);
}

TEST(CompressSprite, CountsChunksThatDidNotGetSmaller) {
  EXPECT_EQ(compress(sprite_of({disc_chunk(), noise_chunk(3), noise_chunk(4)}), {90}).raw_chunks(), 2);
}

TEST(CompressionError, IsThatOfAPlainSum) {
  Chunk a{}, b{};
  a.texels[0] = {10, 20, 30, 255};
  b.texels[0] = {13, 20, 26, 250};
  a.texels[1] = {50, 0, 0, 0};  // light without alpha counts in full
  b.texels[1] = {52, 0, 0, 0};
  const CompressionError e = compression_error(sprite_of({a}), sprite_of({b}));
  EXPECT_EQ(e.color_squared, 255 * (9 + 16) + 255 * 4);
  EXPECT_EQ(e.color_weight, 255 * 3 * 2);
  EXPECT_EQ(e.alpha_squared, 25);
  EXPECT_EQ(e.texels, kTexels);
  EXPECT_DOUBLE_EQ(e.color_psnr_db(), 10 * std::log10(65025.0 * 6 / 29));
  EXPECT_DOUBLE_EQ(e.alpha_psnr_db(), 10 * std::log10(65025.0 * 1024 / 25));
}

// The bytes are part of what is the same on every machine.
TEST(CompressSprite, TheBytesDoNotChange) {
  std::uint64_t hash = 1469598103934665603ull;
  for (const int quality : {1, 37, 80, 100}) {
    Chunk chunk;  // integers only, so that no libm takes part
    for (int i = 0; i < kTexels; ++i) {
      const int x = i % 32, y = i / 32, a = x + y < 20 ? 0 : x + y < 24 ? (x + y - 19) * 50 : 255;
      chunk.texels[i] = {static_cast<std::uint8_t>(a * (x * 7 % 256) / 1024),
                         static_cast<std::uint8_t>(a * y / 64), static_cast<std::uint8_t>(a / 3),
                         static_cast<std::uint8_t>(a)};
    }
    for (const std::uint8_t b : compress_chunk(chunk, {quality})) hash = (hash ^ b) * 1099511628211ull;
  }
  EXPECT_EQ(hash, 4274664190836436731ull);
}

}  // namespace
}  // namespace talisman::chunker
