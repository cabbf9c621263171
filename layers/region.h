// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is a box inside a convex region, outside, or both? The one frustum test of the project [AA 9.4].
///
/// A region is an intersection of half-spaces of the world. With a plane n · p + d (≥ 0 inside) and a box of
/// centre c and half extents e,
///
///   s = n · c + d,   r = Σ |n_k| e_k        s < -r: outside,   s > r: inside,   else the plane cuts the box
///
/// which is the sign of the largest and of the smallest height of a corner. What is outside of one plane is
/// outside of the region; what is inside of a plane need never be tested against it again, nor need anything
/// in it: the planes that are left to test are a mask, handed down a tree. A box that is outside of the region
/// near one of its edges without being outside of a plane counts as cut: the test errs only on that side.
///
/// So it does with rounding. A box holds floats, rounded outwards; a plane is moved outwards by kSlack of all
/// that went into its height before anything is called outside. What is called inside is so to rounding only,
/// which harms nothing: it is not tested again.
///
/// Four boxes are tested at once (vectors of four floats: the same bits on every processor).

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "layers/inline_vector.h"
#include "layers/state.h"

namespace talisman::layers {

/// An axis-aligned box of the world, rounded outwards. lo > hi: nothing, which is outside of every region.
struct Box3 {
  std::array<float, 3> lo{HUGE_VALF, HUGE_VALF, HUGE_VALF};
  std::array<float, 3> hi{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
  bool empty() const { return !(lo[0] <= hi[0] && lo[1] <= hi[1] && lo[2] <= hi[2]); }
  bool operator==(const Box3&) const = default;
};

/// Of what has no known bounds: a region that is not empty meets it.
inline constexpr Box3 kEverywhere{{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
                                   std::numeric_limits<float>::lowest()},
                                  {std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                                   std::numeric_limits<float>::max()}};

/// lo … hi rounded outwards; kEverywhere where something is not finite or beyond a float.
Box3 box_of(const dvec3& lo, const dvec3& hi);
/// Around points; empty where there are none.
Box3 box_of(std::span<const dvec3> points);
/// The box of a box under an affine map. Cost: O(1).
Box3 transformed(const dmat4& world_from_box, const Box3& box);
Box3 joined(const Box3& a, const Box3& b);
/// Do they share a point?
bool meet(const Box3& a, const Box3& b);
Box3 intersection(const Box3& a, const Box3& b);
/// Twice the area of three faces that meet: what a query pays for.
double half_area(const Box3& box);

/// n · p + offset ≥ 0 is inside. The normal may have any length.
struct Plane {
  dvec3 normal{0, 0, 0};
  double offset = 0;
  double height(const dvec3& p) const { return normal.x * p.x + normal.y * p.y + normal.z * p.z + offset; }
};

/// As many planes as a mask has bits.
inline constexpr int kMostPlanes = 32;
using PlaneMask = std::uint32_t;

using Region = InlineVector<Plane, 12>;

/// What a camera shows of the world, its display larger by `margin` displays on each side: the half-spaces of
/// layers/clip.h (there is no far plane), the near plane first. A point that those count as on a plane is inside.
/// Camera and display are such that something can be seen; else the region is what the numbers make of it.
Region view_region(const CameraState& camera, ivec2 display_px, double margin);

/// The largest coordinate of the boxes, in size; what is beyond a float's half counts for nothing: it is inside of all.
double reach_of(std::span<const Box3> boxes);

enum class Side { Outside, Cut, Inside };

/// A region made ready for boxes within `reach_m` of the origin: kSlack · (|n| reach · √3 + |d|) is added to d.
inline constexpr double kSlack = 6e-7;

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

/// Four boxes, coordinate by coordinate: lo x, y, z, hi x, y, z.
struct BoxLanes {
  std::array<Float4, 6> side;
  void put(int lane, const Box3& box);
  Box3 at(int lane) const;
};

class RegionTest {
 public:
  /// At most kMostPlanes planes count; leaving some out errs on the side of what is seen.
  RegionTest(std::span<const Plane> region, double reach_m);

  int planes() const { return count_; }
  PlaneMask all() const { return count_ == kMostPlanes ? ~PlaneMask{0} : (PlaneMask{1} << count_) - 1; }

  /// Bit k: box k is outside of plane `plane`.
  unsigned outside(int plane, const BoxLanes& boxes) const;
  /// Bit k: box k is inside of it.
  unsigned inside(int plane, const BoxLanes& boxes) const;

  /// `mask`: the planes to test; on return those that cut the box. Cost: O(planes in the mask).
  Side side_of(const Box3& box, PlaneMask& mask) const;
  bool misses(const Box3& box) const {
    PlaneMask mask = all();
    return side_of(box, mask) == Side::Outside;
  }

 private:
  struct Ready {
    Float4 x, y, z, outer, inner;           ///< normal, and the offset moved outwards and as it is
    std::array<std::uint8_t, 3> far, near;  ///< which sides of a box are highest and lowest
  };
  std::array<Ready, kMostPlanes> ready_;
  int count_ = 0;
};

namespace region_detail {
/// Bit k: lane k is set.
inline unsigned bits_of(Int4 lanes) {
#if defined(__SSE__)
  return static_cast<unsigned>(__builtin_ia32_movmskps(std::bit_cast<Float4>(lanes)));
#else
  return (lanes[0] & 1u) | (lanes[1] & 2u) | (lanes[2] & 4u) | (lanes[3] & 8u);
#endif
}
}  // namespace region_detail

inline unsigned RegionTest::outside(int plane, const BoxLanes& boxes) const {
  const Ready& p = ready_[plane];
  const Float4 highest =
      p.x * boxes.side[p.far[0]] + p.y * boxes.side[p.far[1]] + (p.z * boxes.side[p.far[2]] + p.outer);
  return region_detail::bits_of(highest < Float4{0, 0, 0, 0});
}

inline unsigned RegionTest::inside(int plane, const BoxLanes& boxes) const {
  const Ready& p = ready_[plane];
  const Float4 lowest =
      p.x * boxes.side[p.near[0]] + p.y * boxes.side[p.near[1]] + (p.z * boxes.side[p.near[2]] + p.inner);
  return region_detail::bits_of(lowest > Float4{0, 0, 0, 0});
}

}  // namespace talisman::layers
