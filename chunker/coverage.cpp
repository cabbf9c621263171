// SPDX-License-Identifier: Apache-2.0
// This file is compiled once per instruction set: foreach_target.h includes it again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chunker/coverage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "chunker/coverage.h"

HWY_BEFORE_NAMESPACE();
namespace talisman::chunker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes32 = hn::CappedTag<std::int32_t, kPlaces>;
using Vec = hn::Vec<Lanes32>;

/// One bit per lane where the sign is clear.
template <class D>
HWY_INLINE std::uint32_t non_negative_bits(D d, hn::Vec<D> v) {
  HWY_ALIGN std::uint8_t bytes[8];
  hn::StoreMaskBits(d, hn::Gt(v, hn::Set(d, -1)), bytes);
  if (hn::MaxLanes(d) <= 8) return bytes[0];
  std::uint16_t bits;
  std::memcpy(&bits, bytes, sizeof(bits));
  return bits;
}

/// The edges, with what is needed to judge whole texels: the largest and least of the sample offsets.
template <int kCount>
struct EdgeVectors {
  HWY_ALIGN std::int32_t sample[3][kPlaces];
  std::int32_t outer[3], inner[3];
};

template <int kCount>
HWY_INLINE void make_edge_vectors(const EdgeSet& edges, EdgeVectors<kCount>& v) {
  for (int k = 0; k < 3; ++k) {
    const std::int32_t a = edges.a[k], b = edges.b[k];
    for (int s = 0; s < kCount; ++s) {
      const int place = Samples<kCount>::place(s);
      v.sample[k][s] = a * (place & 3) + b * (place >> 2);
    }
    if constexpr (kCount == kPlaces) {  // at the corners of the lattice
      v.outer[k] = std::max(0, 3 * a) + std::max(0, 3 * b);
      v.inner[k] = std::min(0, 3 * a) + std::min(0, 3 * b);
    } else {
      v.outer[k] = *std::max_element(v.sample[k], v.sample[k] + kCount);
      v.inner[k] = *std::min_element(v.sample[k], v.sample[k] + kCount);
    }
  }
}

/// The mask of one texel whose first place has the edge values e.
template <int kCount>
HWY_INLINE std::uint16_t mask_of(const EdgeVectors<kCount>& v, std::int32_t e0, std::int32_t e1,
                                 std::int32_t e2) {
  const hn::CappedTag<std::int32_t, kCount> d;
  std::uint32_t mask = 0;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int s = 0; s < kCount; s += lanes) {
    const auto v0 = hn::Add(hn::Set(d, e0), hn::Load(d, v.sample[0] + s));
    const auto v1 = hn::Add(hn::Set(d, e1), hn::Load(d, v.sample[1] + s));
    const auto v2 = hn::Add(hn::Set(d, e2), hn::Load(d, v.sample[2] + s));
    mask |= non_negative_bits(d, hn::Or(hn::Or(v0, v1), v2)) << s;
  }
  return static_cast<std::uint16_t>(mask);
}

/// What an edge gains from the first texel of a group of lanes to each of them.
struct Ramps {
  Vec edge0, edge1, edge2;
};

HWY_INLINE Vec ramp(Lanes32 d, std::int32_t a) { return hn::Mul(hn::Iota(d, 0), hn::Set(d, 4 * a)); }

/// Texels [x0, x1] of one row that may be touched, and those that are full, many texels at a time. Lanes
/// beyond the chunk may wrap around; their bits are cut off at the end.
template <int kCount>
HWY_INLINE void classify_row(Lanes32 d, const EdgeSet& edges, const EdgeVectors<kCount>& v,
                             const Ramps& ramps, const std::int32_t e[3], int x0, int x1,
                             std::uint32_t& touched, std::uint32_t& full) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::uint64_t some = 0, all = 0;
  for (int x = x0; x <= x1; x += lanes) {
    const Vec at0 = hn::Add(hn::Set(d, e[0] + 4 * x * edges.a[0]), ramps.edge0);
    const Vec at1 = hn::Add(hn::Set(d, e[1] + 4 * x * edges.a[1]), ramps.edge1);
    const Vec at2 = hn::Add(hn::Set(d, e[2] + 4 * x * edges.a[2]), ramps.edge2);
    const Vec outer =
        hn::Or(hn::Or(hn::Add(at0, hn::Set(d, v.outer[0])), hn::Add(at1, hn::Set(d, v.outer[1]))),
               hn::Add(at2, hn::Set(d, v.outer[2])));
    const Vec inner =
        hn::Or(hn::Or(hn::Add(at0, hn::Set(d, v.inner[0])), hn::Add(at1, hn::Set(d, v.inner[1]))),
               hn::Add(at2, hn::Set(d, v.inner[2])));
    some |= static_cast<std::uint64_t>(non_negative_bits(d, outer)) << x;
    all |= static_cast<std::uint64_t>(non_negative_bits(d, inner)) << x;
  }
  const std::uint64_t inside = (std::uint64_t{2} << x1) - (std::uint64_t{1} << x0);
  touched = static_cast<std::uint32_t>(some & inside);
  full = static_cast<std::uint32_t>(all & inside);
}

template <int kCount>
HWY_INLINE void cover_box(const EdgeSet& edges, const LatticeBox& box, Coverage& out) {
  const Lanes32 d;
  EdgeVectors<kCount> v;
  make_edge_vectors(edges, v);
  const Ramps ramps{ramp(d, edges.a[0]), ramp(d, edges.a[1]), ramp(d, edges.a[2])};
  for (int y = box.y0; y <= box.y1; ++y) {
    std::int32_t e[3];
    for (int k = 0; k < 3; ++k) e[k] = edges.e[k] + 4 * y * edges.b[k];
    std::uint32_t touched, full;
    classify_row(d, edges, v, ramps, e, box.x0, box.x1, touched, full);
    for (std::uint32_t left = touched & ~full; left != 0; left &= left - 1) {
      const int x = __builtin_ctz(left);
      const std::uint16_t mask =
          mask_of(v, e[0] + 4 * x * edges.a[0], e[1] + 4 * x * edges.a[1], e[2] + 4 * x * edges.a[2]);
      out.mask[y * kChunkSize + x] = mask;
      if (mask == 0) touched &= ~(1u << x);
    }
    out.touched[y] = touched;
    out.full[y] = full;
  }
}

void cover_1(const EdgeSet& edges, const LatticeBox& box, Coverage& out) { cover_box<1>(edges, box, out); }
void cover_4(const EdgeSet& edges, const LatticeBox& box, Coverage& out) { cover_box<4>(edges, box, out); }
void cover_16(const EdgeSet& edges, const LatticeBox& box, Coverage& out) { cover_box<16>(edges, box, out); }

}  // namespace talisman::chunker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talisman::chunker {
namespace {

constexpr std::int64_t kClampEdge = std::int64_t{1} << 30;

std::int32_t start_of_edge(const Triangle& t, int from, int to, int x, int y) {
  const std::int64_t dx = t.x[to] - t.x[from], dy = t.y[to] - t.y[from];
  const std::int64_t sx = static_cast<std::int64_t>(x) * kSubpixel + kFirstSample - t.x[from];
  const std::int64_t sy = static_cast<std::int64_t>(y) * kSubpixel + kFirstSample - t.y[from];
  const bool owned = dy < 0 || (dy == 0 && dx > 0);
  const std::int64_t e = (dx * sy - dy * sx - (owned ? 0 : 1)) >> 6;
  return static_cast<std::int32_t>(std::clamp(e, -kClampEdge, kClampEdge));
}

}  // namespace

EdgeSet edges_of(const Triangle& t, int x, int y) {
  EdgeSet edges;
  for (int k = 0; k < 3; ++k) {
    const int to = k == 2 ? 0 : k + 1;
    edges.a[k] = t.y[k] - t.y[to];
    edges.b[k] = t.x[to] - t.x[k];
    edges.e[k] = start_of_edge(t, k, to, x, y);
  }
  return edges;
}

bool may_cover(const EdgeSet& edges, const LatticeBox& box) {
  for (int k = 0; k < 3; ++k) {
    const std::int32_t a = edges.a[k], b = edges.b[k];
    const std::int32_t best =
        edges.e[k] + a * (a > 0 ? 4 * box.x1 + 3 : 4 * box.x0) + b * (b > 0 ? 4 * box.y1 + 3 : 4 * box.y0);
    if (best < 0) return false;
  }
  return true;
}

HWY_EXPORT(cover_1);
HWY_EXPORT(cover_4);
HWY_EXPORT(cover_16);

template <>
void cover<1>(const EdgeSet& edges, const LatticeBox& box, Coverage& out) {
  HWY_DYNAMIC_DISPATCH(cover_1)(edges, box, out);
}
template <>
void cover<4>(const EdgeSet& edges, const LatticeBox& box, Coverage& out) {
  HWY_DYNAMIC_DISPATCH(cover_4)(edges, box, out);
}
template <>
void cover<16>(const EdgeSet& edges, const LatticeBox& box, Coverage& out) {
  HWY_DYNAMIC_DISPATCH(cover_16)(edges, box, out);
}

}  // namespace talisman::chunker
#endif  // HWY_ONCE
