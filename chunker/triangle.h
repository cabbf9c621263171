// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A triangle on the sprite's fixed-point lattice, and the planes over it.
///
/// Positions are snapped to 1/256 texel; from there on coverage is integer arithmetic. Depth is 1/w: linear
/// on the screen, larger is nearer, and its float keeps the same relative precision at every distance.
/// Samples lie on 4×4 places per texel (chunker/samples.h), place s = 4j + i at ((2i + 1)/8, (2j + 1)/8). A
/// plane of depth is stored at the texel's centre and evaluated at each sample's place as
///
///   depth(s) = (z + dx · (2i - 3)/8) + dy · (2j - 3)/8
///
/// always in this order of operations: it decides which surface a sample shows.

#include <array>
#include <cstdint>

#include "chunker/float4.h"
#include "chunker/interpolator.h"
#include "chunker/samples.h"

namespace talisman::chunker {

inline constexpr int kSubpixel = 256;               ///< fixed-point units per texel
inline constexpr int kSampleStep = kSubpixel / 4;   ///< distance of the lattice's places
inline constexpr int kFirstSample = kSubpixel / 8;  ///< of a texel

/// Corners are ordered so that the doubled area is positive (clockwise on a display whose y points down).
struct Triangle {
  std::array<std::int32_t, 3> x, y;     ///< 1/256 texel
  std::array<float, 3> depth;           ///< 1/w
  std::array<std::uint32_t, 3> vertex;  ///< attributes, in units of the batch's layout
  std::uint32_t batch = 0;
};

inline std::int64_t doubled_area(const Triangle& t) {
  return static_cast<std::int64_t>(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) -
         static_cast<std::int64_t>(t.y[1] - t.y[0]) * (t.x[2] - t.x[0]);
}

/// Inclusive range of places (or of texels), empty if first > last.
struct LatticeBox {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  bool empty() const { return x0 > x1 || y0 > y1; }
  bool operator==(const LatticeBox&) const = default;
};

inline LatticeBox intersection(const LatticeBox& a, const LatticeBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// The places inside the bounding box; shifts round towards -∞, as texels left of the sprite need.
inline LatticeBox sample_box(const Triangle& t) {
  const auto [xlo, xhi] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [ylo, yhi] = std::minmax({t.y[0], t.y[1], t.y[2]});
  static_assert(kSampleStep == 64 && kFirstSample == 32);
  return {(xlo + kSampleStep - 1 - kFirstSample) >> 6, (ylo + kSampleStep - 1 - kFirstSample) >> 6,
          (xhi - kFirstSample) >> 6, (yhi - kFirstSample) >> 6};
}

inline LatticeBox texels_of(const LatticeBox& samples) {
  return {samples.x0 >> 2, samples.y0 >> 2, samples.x1 >> 2, samples.y1 >> 2};
}

struct DepthPlane {
  float z = 0, dx = 0, dy = 0;
};

inline float sample_offset(int i) { return static_cast<float>(2 * i - 3) * 0.125f; }

inline float depth_at(const DepthPlane& plane, int place) {
  return (plane.z + plane.dx * sample_offset(place & 3)) + plane.dy * sample_offset(place >> 2);
}

/// Derivatives per texel of the barycentric coordinates of corners 1 and 2, and of depth.
struct Gradients {
  double b1x, b1y, b2x, b2y;
  double depth_x, depth_y;
};

inline Gradients gradients_of(const Triangle& t) {
  const double r = kSubpixel / static_cast<double>(doubled_area(t));
  Gradients g;
  g.b1x = (t.y[2] - t.y[0]) * r;
  g.b1y = (t.x[0] - t.x[2]) * r;
  g.b2x = (t.y[0] - t.y[1]) * r;
  g.b2y = (t.x[1] - t.x[0]) * r;
  const double d1 = static_cast<double>(t.depth[1]) - t.depth[0],
               d2 = static_cast<double>(t.depth[2]) - t.depth[0];
  g.depth_x = g.b1x * d1 + g.b2x * d2;
  g.depth_y = g.b1y * d1 + g.b2y * d2;
  return g;
}

/// From the first corner to the corner (x, y) of a texel, in texels; exact.
inline float from_corner(int texel, std::int32_t corner) {
  return static_cast<float>(texel * kSubpixel - corner) * (1.0f / kSubpixel);
}

inline DepthPlane depth_plane(const Triangle& t, const Gradients& g, int x, int y) {
  const double dx = static_cast<double>(from_corner(x, t.x[0])) + 0.5;
  const double dy = static_cast<double>(from_corner(y, t.y[0])) + 0.5;
  const double z = (t.depth[0] + g.depth_x * dx) + g.depth_y * dy;
  return {static_cast<float>(z), static_cast<float>(g.depth_x), static_cast<float>(g.depth_y)};
}

/// `attributes` of the triangle's batch.
inline Interpolator interpolator_of(const Triangle& t, const Gradients& g, const Float4* attributes,
                                    int count) {
  Interpolator p;
  p.q1x = static_cast<float>(g.b1x * t.depth[1]);
  p.q1y = static_cast<float>(g.b1y * t.depth[1]);
  p.q2x = static_cast<float>(g.b2x * t.depth[2]);
  p.q2y = static_cast<float>(g.b2y * t.depth[2]);
  p.s0 = t.depth[0];
  p.sx = static_cast<float>(g.depth_x);
  p.sy = static_cast<float>(g.depth_y);
  p.corner_x = static_cast<float>(t.x[0]) * (1.0f / kSubpixel);
  p.corner_y = static_cast<float>(t.y[0]) * (1.0f / kSubpixel);
  const Float4* corner[3];
  for (int i = 0; i < 3; ++i) corner[i] = attributes + static_cast<std::size_t>(t.vertex[i]) * count;
  for (int k = 0; k < count; ++k) {
    p.a0[k] = corner[0][k];
    p.d1[k] = corner[1][k] - corner[0][k];
    p.d2[k] = corner[2][k] - corner[0][k];
  }
  return p;
}

}  // namespace talisman::chunker
