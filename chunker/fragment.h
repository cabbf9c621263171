// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a chunk's texels hold while it is drawn.
///
/// A texel has at most one *base*, an opaque surface that covers it wholly, and a list of *fragments*:
/// partial cover, translucency, and opaque cover that crosses the base inside the texel. What is wholly
/// behind the base is never stored, and a new base drops the fragments that it hides. A fragment merges with
/// the last one stored for its texel when their masks are disjoint, their planes differ by no more than
/// `depth` relative to their depth anywhere in the texel, and their colours by no more than `color` per
/// channel [A §1 row 9, US 5,990,904]; the stored colour and plane stay. Both tolerances 0: nothing merges.
///
/// The buffer has a limit; a fragment beyond it is refused, and the caller draws smaller pieces [A §1 row 8,
/// EP0850462B1].

#include <array>
#include <cstdint>
#include <vector>

#include "chunker/pixel.h"
#include "chunker/triangle.h"
#include "layers/built_effects.h"

namespace talisman::chunker {

/// A coloured piece of surface over one texel.
struct Fragment {
  Float4 color{0, 0, 0, 0};  ///< premultiplied
  DepthPlane depth;
  std::uint32_t order = 0;  ///< of its triangle: at equal depth the earlier one is in front
  std::int32_t next = -1;   ///< of the same texel, -1: none
  std::uint16_t mask = 0;
  bool opaque() const { return !layers::is_built(layers::Effect::Translucency) || color[3] >= 1; }
};

struct MergeTolerance {
  float depth = 0, color = 0;
  bool any() const { return depth > 0 || color > 0; }
};

/// Samples where a is strictly nearer than b.
template <int kCount>
std::uint16_t nearer_samples(const DepthPlane& a, const DepthPlane& b);

/// Front-to-back accumulation of one sample.
struct SampleSum {
  Float4 color{0, 0, 0, 0};
  float through = 1;
  void add_behind(Float4 c) {
    color += c * splat(through);
    through *= 1 - c[3];
  }
};

/// A surface in one sample.
struct SampleEntry {
  float depth;
  const Fragment* surface;
};

enum class Added { Stored, Merged, BecameBase, Refused };

/// Of texels with `kCount` samples: 1, 4 or 16.
template <int kCount>
class FragmentBuffer {
 public:
  FragmentBuffer();

  /// Empties all texels of the box and sets the limit for what follows.
  void clear(const LatticeBox& box, int max_fragments, MergeTolerance merge);

  /// True if the base hides all of `mask` of a surface that comes later.
  bool hides(int texel, std::uint16_t mask, const DepthPlane& depth) const {
    const Fragment& base = base_[texel];
    return has_base(texel) && (nearer_samples<kCount>(depth, base.depth) & mask) == 0;
  }

  /// `fragment` comes after all that were added before. `kOpaque`: it is known to be opaque.
  template <bool kOpaque = false>
  Added add(int texel, const Fragment& fragment) {
    const bool opaque = kOpaque || fragment.opaque();
    const bool whole = fragment.mask == kFull && opaque;
    if constexpr (!kOpaque) translucent_ = translucent_ || !opaque;
    if (!whole || !is_clear(texel)) return add_to_busy(texel, fragment, whole);
    set_base(texel, fragment);
    return Added::BecameBase;
  }

  /// Premultiplied colour of a texel: in each sample front to back, then the mean of them.
  Float4 resolve(int texel) const {
    if (first_[texel] >= 0) return resolve_busy(texel);
    return has_base(texel) ? base_[texel].color : splat(0);
  }
  bool is_clear(int texel) const { return first_[texel] < 0 && !has_base(texel); }
  /// Where the only sample is, by which surfaces are told apart then; of more of them at the texel's centre.
  static float depth_of(const DepthPlane& plane) {
    if constexpr (kCount == 1)
      return depth_at(plane, Samples<kCount>::place(0));
    else
      return plane.z;
  }
  /// The surface that is nearest there, the earlier one where two are; null where the texel is clear.
  const Fragment* nearest(int texel) const {
    const Fragment* front = has_base(texel) ? &base_[texel] : nullptr;
    for (std::int32_t i = first_[texel]; i >= 0; i = pool_[i].next) {
      const Fragment& other = pool_[i];
      const float ahead = front == nullptr ? 1 : depth_of(other.depth) - depth_of(front->depth);
      if (ahead > 0 || (ahead == 0 && other.order < front->order)) front = &other;
    }
    return front;
  }

  int live_fragments() const { return live_; }

 private:
  static constexpr std::uint16_t kFull = Samples<kCount>::kFull;
  using Colors = std::array<Float4, kCount>;  ///< by sample

  bool has_base(int texel) const { return covered_[texel / kChunkSize] >> (texel % kChunkSize) & 1; }
  void set_base(int texel, const Fragment& fragment) {
    // Field by field: a copy as a whole would load wide what was just stored narrow, and wait for it.
    Fragment& base = base_[texel];
    base.color = fragment.color;
    base.depth.z = fragment.depth.z;
    base.depth.dx = fragment.depth.dx;
    base.depth.dy = fragment.depth.dy;
    base.order = fragment.order;
    base.next = fragment.next;
    base.mask = fragment.mask;
    covered_[texel / kChunkSize] |= 1u << (texel % kChunkSize);
  }
  Float4 resolve_busy(int texel) const;
  Added add_to_busy(int texel, const Fragment& fragment, bool whole);
  bool fill_disjoint(int texel, Colors& samples) const;
  bool merge(Fragment& last, const Fragment& fragment) const;
  void drop_hidden(int texel);
  std::int32_t allocate();
  Float4 resolve_opaque(int texel) const;
  Float4 resolve_translucent(int texel) const;

  std::array<std::uint32_t, kChunkSize> covered_{};          ///< bit x of row y: the texel has a base
  std::array<Fragment, kChunkSize * kChunkSize> base_;       ///< valid where covered
  std::array<std::int32_t, kChunkSize * kChunkSize> first_;  ///< the last one stored; -1: none
  std::vector<Fragment> pool_;
  std::int32_t free_ = -1;
  int live_ = 0, limit_ = 0;
  bool translucent_ = false;  ///< something that was added since the last clear() can be seen through
  MergeTolerance merge_;
  mutable std::vector<SampleEntry> surfaces_,
      entries_;  ///< of the texel that is being resolved; kept for their memory
};

/// Pairwise; unrolled, it stays in registers.
template <std::size_t kCount>
Float4 sum_of_samples(const Float4* samples) {
  if constexpr (kCount == 1)
    return samples[0];
  else
    return sum_of_samples<kCount / 2>(samples) + sum_of_samples<kCount / 2>(samples + kCount / 2);
}

/// Equal samples give exactly their value.
template <std::size_t kCount>
Float4 mean_of_samples(const std::array<Float4, kCount>& samples) {
  return sum_of_samples<kCount>(samples.data()) * splat(1.0f / kCount);
}

}  // namespace talisman::chunker
