// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The 2-D maps that carry an old picture to a new one [LS97 4, 4.2].
///
/// A `Warp` maps display pixels at the layer's last render (`then`) to display pixels now. Its matrix acts on
/// homogeneous columns (x, y, 1) and, for the perspective family only, divides by the third component. A
/// homography is the same under any positive scale; those of the fits are scaled to a denominator of 1 at the
/// centroid of the points then.
///
///   translation     isotropic        x/y scale        affine           perspective
///   1 0 tx          s 0 tx           a 0 tx           a b tx           a b tx
///   0 1 ty          0 s ty           0 d ty           c d ty           c d ty
///   0 0 1           0 0 1            0 0 1            0 0 1            g h 1
///   2 unknowns      3                4                6                8

#include <array>
#include <optional>
#include <string_view>

#include "layers/geometry2.h"

namespace talisman::warp {

using layers::Affine2;
using layers::dmat3;
using layers::dvec2;
using layers::dvec3;

enum class Family { Translation, Isotropic, XyScale, Affine, Perspective };

/// The curves of [LS97 4.2] and our extras (iso, isoi, per2i). "i" is the maximum norm, otherwise the sum of
/// squares; per and peri measure in homogeneous space, per2 and per2i after the divide; pers is Shade's
/// quadrilateral, pers2 refines it.
enum class Curve { trn, trni, iso, isoi, so, soi, aff, affi, per, peri, per2, per2i, pers, pers2 };
inline constexpr std::array kAllCurves{Curve::trn,  Curve::trni,  Curve::iso,  Curve::isoi, Curve::so,
                                       Curve::soi,  Curve::aff,   Curve::affi, Curve::per,  Curve::peri,
                                       Curve::per2, Curve::per2i, Curve::pers, Curve::pers2};

std::string_view name(Family family);
std::string_view name(Curve curve);
std::optional<Curve> curve_from_name(std::string_view name);
Family family_of(Curve curve);
/// Unknowns of the family: 2, 3, 4, 6, 8.
int degrees_of_freedom(Family family);

struct Warp {
  Family family = Family::Translation;
  dmat3 now_from_then{1.0};

  /// The image of a point. For perspective the denominator must be positive (see denominator()).
  dvec2 operator()(dvec2 p) const {
    const dmat3& m = now_from_then;
    const dvec2 image{m[0].x * p.x + m[1].x * p.y + m[2].x, m[0].y * p.x + m[1].y * p.y + m[2].y};
    return is_affine() ? image : image / denominator(p);
  }
  /// Third homogeneous component at p; 1 for all families but perspective.
  double denominator(dvec2 p) const {
    const dmat3& m = now_from_then;
    return is_affine() ? 1 : m[0].z * p.x + m[1].z * p.y + m[2].z;
  }
  bool is_identity() const;
  bool is_affine() const { return family != Family::Perspective; }
  /// The 2×3 part. Programmer error for a perspective warp.
  Affine2 affine() const;
  bool operator==(const Warp&) const = default;
};

Warp from_affine(Family family, const Affine2& map);

/// (outer after inner); the family is the more general of the two.
Warp compose(const Warp& outer, const Warp& inner);
/// Empty if singular or not finite.
std::optional<Warp> inverse(const Warp& warp);

}  // namespace talisman::warp
