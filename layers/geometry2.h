// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Plane geometry of the display and of sprites.
///
/// Conventions (all folders): pixels have x to the right and y down, the centre of pixel (i, j) is at
/// (i + 0.5, j + 0.5); sprite space likewise, in texels. Transforms are named target-from-source.

#include <cmath>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace talisman::layers {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// A 2×3 affine map, [LS97 4.1]:   | a b tx |   p' = (a x + b y + tx, c x + d y + ty)
///                                 | c d ty |
struct Affine2 {
  double a = 1, b = 0, tx = 0;
  double c = 0, d = 1, ty = 0;

  dvec2 operator()(dvec2 p) const { return {a * p.x + b * p.y + tx, c * p.x + d * p.y + ty}; }
  dvec2 linear(dvec2 v) const { return {a * v.x + b * v.y, c * v.x + d * v.y}; }
  double determinant() const { return a * d - b * c; }
  bool operator==(const Affine2&) const = default;
};

/// (outer * inner)(p) = outer(inner(p)).
inline Affine2 operator*(const Affine2& o, const Affine2& i) {
  return {o.a * i.a + o.b * i.c, o.a * i.b + o.b * i.d, o.a * i.tx + o.b * i.ty + o.tx,
          o.c * i.a + o.d * i.c, o.c * i.b + o.d * i.d, o.c * i.tx + o.d * i.ty + o.ty};
}

/// The inverse map; empty when the determinant is zero or not finite.
inline std::optional<Affine2> inverse(const Affine2& m) {
  const double det = m.determinant();
  if (!std::isfinite(det) || det == 0) return std::nullopt;
  const double r = 1 / det;
  if (!std::isfinite(r)) return std::nullopt;
  return Affine2{m.d * r,  -m.b * r, (m.b * m.ty - m.d * m.tx) * r,
                 -m.c * r, m.a * r,  (m.c * m.tx - m.a * m.ty) * r};
}

/// As a 3×3 homogeneous matrix (GLM is column-major: m[column][row]).
inline dmat3 to_mat3(const Affine2& m) { return {m.a, m.c, 0, m.b, m.d, 0, m.tx, m.ty, 1}; }

/// Half-open integer rectangle [x0, x1) × [y0, y1), in pixels or texels.
struct RectI {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 > x0 ? x1 - x0 : 0; }
  int height() const { return y1 > y0 ? y1 - y0 : 0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  bool operator==(const RectI&) const = default;
};

/// Closed real rectangle; empty when lo > hi in either coordinate (the default).
struct RectD {
  dvec2 lo{HUGE_VAL, HUGE_VAL};
  dvec2 hi{-HUGE_VAL, -HUGE_VAL};
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y); }
  double width() const { return empty() ? 0 : hi.x - lo.x; }
  double height() const { return empty() ? 0 : hi.y - lo.y; }
  void include(dvec2 p) {
    lo = {std::fmin(lo.x, p.x), std::fmin(lo.y, p.y)};
    hi = {std::fmax(hi.x, p.x), std::fmax(hi.y, p.y)};
  }
  bool operator==(const RectD&) const = default;
};

inline RectD intersection(const RectD& a, const RectD& b) {
  return {{std::fmax(a.lo.x, b.lo.x), std::fmax(a.lo.y, b.lo.y)},
          {std::fmin(a.hi.x, b.hi.x), std::fmin(a.hi.y, b.hi.y)}};
}

}  // namespace talisman::layers
