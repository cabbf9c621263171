// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which of the 16 samples of each texel of a chunk does a triangle cover?
///
///   E(x, y) = (xb - xa)(y - ya) - (yb - ya)(x - xa) ≥ 0    for its three edges a → b, in 1/256 texel
///
/// A sample on an edge belongs to the triangle only if the edge is a top edge (dy = 0, dx > 0) or a left edge
/// (dy < 0), so of two triangles that share an edge exactly one covers it: E - 1 ≥ 0 is asked of all other
/// edges.
///
/// The samples lie on a lattice of 64 units, so E = E₀ + 64 (A i + B j) and the sign of E is that of ⌊E₀/64⌋
/// + A i + B j. Inside a chunk that fits 32 bits: |A| + |B| ≤ 2²³ times 127 lattice steps is less than 2³⁰,
/// and an E₀ beyond ±2³⁰ can be clamped there without changing a sign. So eight texels are classified at
/// once, in integers.

#include <array>
#include <cstdint>

#include "chunker/pixel.h"
#include "chunker/triangle.h"

namespace talisman::chunker {

/// ⌊E₀/64⌋ at the first sample of a chunk, and the steps per sample to the right and down.
struct EdgeSet {
  std::array<std::int32_t, 3> e, a, b;
};

/// (x, y): the chunk's first texel.
EdgeSet edges_of(const Triangle& t, int x, int y);

/// True if some sample of the box (texels of the chunk) may be covered: no edge has all of it outside.
bool may_cover(const EdgeSet& edges, const LatticeBox& box);

/// Coverage of the rows of a box. Bit x of `touched[y]`: some sample of texel (x, y) is covered; of
/// `full[y]`: all are; `mask` is valid where a texel is touched and not full.
struct Coverage {
  std::array<std::uint32_t, kChunkSize> touched, full;
  std::array<std::uint16_t, kChunkSize * kChunkSize> mask;
};

/// `box`: texels of the chunk, 0 … 31, not empty. Only its rows are written. The bits are those of
/// `cover_scalar` on every processor.
void cover(const EdgeSet& edges, const LatticeBox& box, Coverage& out);

/// With 1 or 4 samples per texel instead of 16, each stands for its share of the mask: sample 5, at (3/8,
/// 3/8), for all of it; samples 1, 7, 8 and 14 (no two in one column) for the row they are in.
inline constexpr int kOnlySample = 5;
inline std::uint16_t reduced_mask(std::uint16_t mask, int samples) {
  if (samples == 1) return mask >> kOnlySample & 1 ? kFullMask : 0;
  unsigned reduced = 0;
  for (const int sample : {1, 7, 8, 14})
    if (mask >> sample & 1) reduced |= 0xfu << (sample & ~3);
  return static_cast<std::uint16_t>(reduced);
}

/// Applies reduced_mask() to what cover() wrote. `samples` is 1 or 4.
void reduce_samples(const LatticeBox& box, int samples, Coverage& coverage);

/// The definition, sample by sample.
void cover_scalar(const EdgeSet& edges, const LatticeBox& box, Coverage& out);

}  // namespace talisman::chunker
