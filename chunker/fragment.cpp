// SPDX-License-Identifier: Apache-2.0
#include "chunker/fragment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace talisman::chunker {
namespace {

/// Half the range of a plane over the lattice, at most.
float spread_of(const DepthPlane& p) { return 0.375f * (std::abs(p.dx) + std::abs(p.dy)); }

bool in_front(const SampleEntry& a, const SampleEntry& b) {
  return a.depth > b.depth || (a.depth == b.depth && a.surface->order < b.surface->order);
}

Float4 composite_sorted(const std::vector<SampleEntry>& entries) {
  SampleSum sum;
  for (const SampleEntry& entry : entries) {
    sum.add_behind(entry.surface->color);
    if (entry.surface->opaque()) break;
  }
  return sum.color;
}

void insert_sorted(std::vector<SampleEntry>& entries, const SampleEntry& entry) {
  entries.push_back(entry);
  for (std::size_t i = entries.size() - 1; i > 0 && in_front(entries[i], entries[i - 1]); --i)
    std::swap(entries[i], entries[i - 1]);
}

using Int4 = std::int32_t __attribute__((vector_size(16)));

Int4 chosen(Int4 where, Int4 a, Int4 b) { return (where & a) | (~where & b); }
Float4 chosen(Int4 where, Float4 a, Float4 b) {
  return std::bit_cast<Float4>(chosen(where, std::bit_cast<Int4>(a), std::bit_cast<Int4>(b)));
}

/// The nearest opaque surface in each sample, four samples at a time.
template <int kCount>
class NearestSurfaces {
 public:
  NearestSurfaces() {
    depth_.fill(splat(-1));
    order_.fill(Int4{});
    surface_.fill(Int4{-1, -1, -1, -1});
  }
  void begin_with(const Fragment& base) {
    const auto order = static_cast<std::int32_t>(base.order);
    for (int group = 0; group < kGroups; ++group) {
      depth_[group] = depths(base.depth, group);
      order_[group] = Int4{order, order, order, order};
    }
  }
  void add(const Fragment& fragment, std::int32_t surface) {
    const auto order = static_cast<std::int32_t>(fragment.order);
    const Int4 orders{order, order, order, order}, surfaces{surface, surface, surface, surface};
    for (int group = 0; group < kGroups; ++group) {
      const std::int32_t bits = fragment.mask >> (4 * group) & 15;
      const Int4 here = (Int4{bits, bits, bits, bits} & Int4{1, 2, 4, 8}) != 0;
      const Float4 depth = depths(fragment.depth, group);
      const Int4 nearer = (depth > depth_[group]) | ((depth == depth_[group]) & (orders < order_[group]));
      const Int4 take = here & nearer;
      depth_[group] = chosen(take, depth, depth_[group]);
      order_[group] = chosen(take, orders, order_[group]);
      surface_[group] = chosen(take, surfaces, surface_[group]);
    }
  }
  /// -1: the first one, or none.
  std::int32_t surface(int sample) const { return surface_[sample / 4][sample % 4]; }

 private:
  static constexpr int kGroups = (kCount + 3) / 4;

  /// depth_at() in the samples of a group; of one sample, in four equal lanes.
  static Float4 depths(const DepthPlane& plane, int group) {
    const auto at = [group](int lane) { return Samples<kCount>::place((4 * group + lane) % kCount); };
    const Float4 x{sample_offset(at(0) & 3), sample_offset(at(1) & 3), sample_offset(at(2) & 3),
                   sample_offset(at(3) & 3)};
    const Float4 y{sample_offset(at(0) >> 2), sample_offset(at(1) >> 2), sample_offset(at(2) >> 2),
                   sample_offset(at(3) >> 2)};
    return (splat(plane.z) + splat(plane.dx) * x) + splat(plane.dy) * y;
  }

  std::array<Float4, kGroups> depth_;
  std::array<Int4, kGroups> order_, surface_;
};

}  // namespace

template <int kCount>
std::uint16_t nearer_samples(const DepthPlane& a, const DepthPlane& b) {
  const float difference = a.z - b.z;
  const float spread = spread_of(a) + spread_of(b);
  // Beyond the spread, room for the rounding of depth_at: the bounds decide only what comparisons one by one
  // would.
  const float slack = spread + 1e-6f * (std::abs(a.z) + std::abs(b.z) + spread);
  if (difference > slack) return Samples<kCount>::kFull;
  if (difference < -slack) return 0;
  std::uint32_t mask = 0;
  for (int s = 0; s < kCount; ++s) {
    const int place = Samples<kCount>::place(s);
    mask |= (depth_at(a, place) > depth_at(b, place) ? 1u : 0u) << s;
  }
  return static_cast<std::uint16_t>(mask);
}

template <int kCount>
FragmentBuffer<kCount>::FragmentBuffer() {
  first_.fill(-1);
}

template <int kCount>
void FragmentBuffer<kCount>::clear(const LatticeBox& box, int max_fragments, MergeTolerance merge) {
  for (int y = box.y0; y <= box.y1; ++y) {
    covered_[y] = 0;
    std::fill_n(&first_[y * kChunkSize], kChunkSize, -1);
  }
  pool_.clear();
  free_ = -1;
  live_ = 0;
  translucent_ = false;
  limit_ = max_fragments;
  merge_ = merge;
}

template <int kCount>
Added FragmentBuffer<kCount>::add_to_busy(int texel, const Fragment& fragment, bool whole) {
  if (whole && (!has_base(texel) || nearer_samples<kCount>(fragment.depth, base_[texel].depth) == kFull)) {
    set_base(texel, fragment);
    if (first_[texel] >= 0) drop_hidden(texel);
    return Added::BecameBase;
  }
  const std::int32_t last = first_[texel];
  if (last >= 0 && merge_.any() && merge(pool_[last], fragment)) return Added::Merged;
  if (live_ >= limit_) return Added::Refused;
  const std::int32_t place = allocate();
  pool_[place] = fragment;
  pool_[place].next = last;
  first_[texel] = place;
  return Added::Stored;
}

template <int kCount>
bool FragmentBuffer<kCount>::merge(Fragment& last, const Fragment& fragment) const {
  if (last.mask & fragment.mask) return false;
  const DepthPlane &a = last.depth, &b = fragment.depth;
  const float apart = std::abs(a.z - b.z) + 0.5f * (std::abs(a.dx - b.dx) + std::abs(a.dy - b.dy));
  if (!(apart <= merge_.depth * std::max(a.z, b.z))) return false;
  for (int i = 0; i < 4; ++i)
    if (!(std::abs(last.color[i] - fragment.color[i]) <= merge_.color)) return false;
  last.mask = static_cast<std::uint16_t>(last.mask | fragment.mask);
  return true;
}

template <int kCount>
void FragmentBuffer<kCount>::drop_hidden(int texel) {
  const DepthPlane& base = base_[texel].depth;
  std::int32_t* link = &first_[texel];
  while (*link >= 0) {
    const std::int32_t place = *link;
    Fragment& fragment = pool_[place];
    // At equal depth the fragment, being earlier, stays in front.
    if (fragment.mask & ~nearer_samples<kCount>(base, fragment.depth)) {
      link = &fragment.next;
      continue;
    }
    *link = fragment.next;
    fragment.next = free_;
    free_ = place;
    --live_;
  }
}

template <int kCount>
std::int32_t FragmentBuffer<kCount>::allocate() {
  ++live_;
  if (free_ < 0) {
    pool_.emplace_back();
    return static_cast<std::int32_t>(pool_.size()) - 1;
  }
  const std::int32_t place = free_;
  free_ = pool_[place].next;
  return place;
}

template <int kCount>
Float4 FragmentBuffer<kCount>::resolve_busy(int texel) const {
  if (!layers::is_built(layers::Effect::Translucency) || !translucent_) return resolve_opaque(texel);
  for (std::int32_t i = first_[texel]; i >= 0; i = pool_[i].next)
    if (!pool_[i].opaque()) return resolve_translucent(texel);
  return resolve_opaque(texel);
}

/// Pieces of one surface side by side, nothing behind: no sample is covered twice, so no depth is asked for.
template <int kCount>
bool FragmentBuffer<kCount>::fill_disjoint(int texel, Colors& samples) const {
  if (has_base(texel)) return false;
  unsigned covered = 0;
  for (std::int32_t i = first_[texel]; i >= 0; i = pool_[i].next) {
    if (covered & pool_[i].mask) return false;
    covered |= pool_[i].mask;
    for (unsigned left = pool_[i].mask; left != 0; left &= left - 1)
      samples[__builtin_ctz(left)] = pool_[i].color;
  }
  for (unsigned left = kFull & ~covered; left != 0; left &= left - 1) samples[__builtin_ctz(left)] = splat(0);
  return true;
}

template <int kCount>
Float4 FragmentBuffer<kCount>::resolve_opaque(int texel) const {
  Colors samples;
  if (fill_disjoint(texel, samples)) return mean_of_samples(samples);
  NearestSurfaces<kCount> nearest;
  const bool covered = has_base(texel);
  if (covered) nearest.begin_with(base_[texel]);
  for (std::int32_t i = first_[texel]; i >= 0; i = pool_[i].next) nearest.add(pool_[i], i);
  for (int s = 0; s < kCount; ++s) {
    const std::int32_t surface = nearest.surface(s);
    samples[s] = surface >= 0 ? pool_[surface].color : covered ? base_[texel].color : splat(0);
  }
  return mean_of_samples(samples);
}

template <int kCount>
Float4 FragmentBuffer<kCount>::resolve_translucent(int texel) const {
  Colors samples;
  // Sorted once by the depth at the centre: the order in each sample is nearly the same.
  surfaces_.clear();
  if (has_base(texel)) surfaces_.push_back({base_[texel].depth.z, &base_[texel]});
  for (std::int32_t i = first_[texel]; i >= 0; i = pool_[i].next)
    surfaces_.push_back({pool_[i].depth.z, &pool_[i]});
  std::sort(surfaces_.begin(), surfaces_.end(), in_front);
  for (int s = 0; s < kCount; ++s) {
    entries_.clear();
    for (const SampleEntry& entry : surfaces_)
      if (entry.surface->mask >> s & 1)
        insert_sorted(entries_, {depth_at(entry.surface->depth, Samples<kCount>::place(s)), entry.surface});
    samples[s] = composite_sorted(entries_);
  }
  return mean_of_samples(samples);
}

template class FragmentBuffer<1>;
template class FragmentBuffer<4>;
template class FragmentBuffer<16>;
template std::uint16_t nearer_samples<1>(const DepthPlane&, const DepthPlane&);
template std::uint16_t nearer_samples<4>(const DepthPlane&, const DepthPlane&);
template std::uint16_t nearer_samples<16>(const DepthPlane&, const DepthPlane&);

}  // namespace talisman::chunker
