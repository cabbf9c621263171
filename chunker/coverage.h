// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which samples of each texel of a chunk does a triangle cover?
///
///   E(x, y) = (xb - xa)(y - ya) - (yb - ya)(x - xa) ≥ 0    for its three edges a → b, in 1/256 texel
///
/// A sample on an edge belongs to the triangle only if the edge is a top edge (dy = 0, dx > 0) or a left edge
/// (dy < 0), so of two triangles that share an edge exactly one covers it: E - 1 ≥ 0 is asked of all other
/// edges.
///
/// Samples lie on a lattice of 64 units (chunker/samples.h), so E = E₀ + 64 (A i + B j), and the sign of E is
/// that of ⌊E₀/64⌋ + A i + B j. Inside a chunk that fits 32 bits: |A| + |B| ≤ 2²³ times 127 lattice steps is
/// less than 2³⁰, and an E₀ beyond ±2³⁰ can be clamped there without changing a sign. So eight texels are
/// classified at once, in integers.

#include <array>
#include <cstdint>

#include "chunker/pixel.h"
#include "chunker/triangle.h"

namespace talisman::chunker {

/// ⌊E₀/64⌋ at the first place of a chunk, and the steps per place to the right and down.
struct EdgeSet {
  std::array<std::int32_t, 3> e, a, b;
};

/// (x, y): the chunk's first texel.
EdgeSet edges_of(const Triangle& t, int x, int y);

/// True if some place of the box (texels of the chunk) may be covered: no edge has all of it outside.
bool may_cover(const EdgeSet& edges, const LatticeBox& box);

/// Coverage of the rows of a box. Bit x of `touched[y]`: some sample of texel (x, y) is covered; of
/// `full[y]`: all are; `mask` is valid where a texel is touched and not full.
struct Coverage {
  std::array<std::uint32_t, kChunkSize> touched, full;
  std::array<std::uint16_t, kChunkSize * kChunkSize> mask;
};

/// `box`: texels of the chunk, 0 … 31, not empty. Only its rows are written. The bits are those of
/// `cover_scalar` on every processor. With one sample a texel that is touched is full.
template <int kCount>
void cover(const EdgeSet& edges, const LatticeBox& box, Coverage& out);

/// The definition, sample by sample.
template <int kCount>
void cover_scalar(const EdgeSet& edges, const LatticeBox& box, Coverage& out) {
  for (int y = box.y0; y <= box.y1; ++y) {
    out.touched[y] = out.full[y] = 0;
    for (int x = box.x0; x <= box.x1; ++x) {
      std::uint16_t mask = 0;
      for (int s = 0; s < kCount; ++s) {
        const int i = 4 * x + (Samples<kCount>::place(s) & 3), j = 4 * y + (Samples<kCount>::place(s) >> 2);
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside = inside && edges.e[k] + edges.a[k] * i + edges.b[k] * j >= 0;
        mask = static_cast<std::uint16_t>(mask | (inside ? 1 << s : 0));
      }
      if (mask != 0) out.touched[y] |= 1u << x;
      if (mask == Samples<kCount>::kFull)
        out.full[y] |= 1u << x;
      else
        out.mask[y * kChunkSize + x] = mask;
    }
  }
}

}  // namespace talisman::chunker
