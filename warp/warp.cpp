// SPDX-License-Identifier: Apache-2.0
#include "warp/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/matrix.hpp>

#include "layers/check.h"

namespace talisman::warp {
namespace {

struct CurveEntry {
  Curve curve;
  std::string_view name;
  Family family;
};

constexpr std::array<CurveEntry, 14> kCurves{{{Curve::trn, "trn", Family::Translation},
                                              {Curve::trni, "trni", Family::Translation},
                                              {Curve::iso, "iso", Family::Isotropic},
                                              {Curve::isoi, "isoi", Family::Isotropic},
                                              {Curve::so, "so", Family::XyScale},
                                              {Curve::soi, "soi", Family::XyScale},
                                              {Curve::aff, "aff", Family::Affine},
                                              {Curve::affi, "affi", Family::Affine},
                                              {Curve::per, "per", Family::Perspective},
                                              {Curve::peri, "peri", Family::Perspective},
                                              {Curve::per2, "per2", Family::Perspective},
                                              {Curve::per2i, "per2i", Family::Perspective},
                                              {Curve::pers, "pers", Family::Perspective},
                                              {Curve::pers2, "pers2", Family::Perspective}}};

const CurveEntry& entry(Curve curve) {
  const auto found =
      std::find_if(kCurves.begin(), kCurves.end(), [&](const auto& e) { return e.curve == curve; });
  TALISMAN_CHECK(found != kCurves.end());
  return *found;
}

bool all_finite(const dmat3& m) {
  for (int column = 0; column < 3; ++column)
    if (!std::isfinite(m[column].x) || !std::isfinite(m[column].y) || !std::isfinite(m[column].z))
      return false;
  return true;
}

double largest_entry(const dmat3& m) {
  double largest = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) largest = std::fmax(largest, std::fabs(m[column][row]));
  return largest;
}

std::optional<Warp> inverse_perspective(const Warp& warp) {
  const double scale = largest_entry(warp.now_from_then);
  if (!(scale > 0) || !std::isfinite(scale)) return std::nullopt;
  const dmat3 scaled = warp.now_from_then * (1 / scale);  // the determinant of the raw matrix may underflow
  if (!(std::fabs(glm::determinant(scaled)) > 0)) return std::nullopt;
  Warp back{Family::Perspective, glm::inverse(scaled) * (1 / scale)};
  if (!all_finite(back.now_from_then)) return std::nullopt;
  return back;
}

}  // namespace

std::string_view name(Family family) {
  switch (family) {
    case Family::Translation:
      return "translation";
    case Family::Isotropic:
      return "isotropic";
    case Family::XyScale:
      return "xy-scale";
    case Family::Affine:
      return "affine";
    case Family::Perspective:
      return "perspective";
  }
  TALISMAN_CHECK(false && "no such family");
}

std::string_view name(Curve curve) { return entry(curve).name; }

std::optional<Curve> curve_from_name(std::string_view name) {
  for (const auto& e : kCurves)
    if (e.name == name) return e.curve;
  return std::nullopt;
}

Family family_of(Curve curve) { return entry(curve).family; }

int degrees_of_freedom(Family family) {
  switch (family) {
    case Family::Translation:
      return 2;
    case Family::Isotropic:
      return 3;
    case Family::XyScale:
      return 4;
    case Family::Affine:
      return 6;
    case Family::Perspective:
      return 8;
  }
  TALISMAN_CHECK(false && "no such family");
}

bool Warp::is_identity() const {
  const double scale = now_from_then[2].z;
  return scale > 0 && now_from_then == dmat3(scale);
}

Affine2 Warp::affine() const {
  TALISMAN_CHECK(is_affine());
  const dmat3& m = now_from_then;
  return {m[0].x, m[1].x, m[2].x, m[0].y, m[1].y, m[2].y};
}

Warp from_affine(Family family, const Affine2& map) { return {family, layers::to_mat3(map)}; }

Warp compose(const Warp& outer, const Warp& inner) {
  const Family family = std::max(outer.family, inner.family);
  if (family != Family::Perspective) return from_affine(family, outer.affine() * inner.affine());
  return {family, outer.now_from_then * inner.now_from_then};
}

std::optional<Warp> inverse(const Warp& warp) {
  if (!all_finite(warp.now_from_then)) return std::nullopt;
  if (!warp.is_affine()) return inverse_perspective(warp);
  const auto back = layers::inverse(warp.affine());
  if (!back || !all_finite(layers::to_mat3(*back))) return std::nullopt;
  return from_affine(warp.family, *back);
}

}  // namespace talisman::warp
