// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/hard/number_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "layers/state.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"
#include "warp/fit.h"

namespace talisman::sequences {
namespace {

using Exact = long double;

// --- Fits

constexpr int kFitPoints = 14;
constexpr double kSpriteHalf_px = 100;

/// A sprite about (offset, offset) and a planted affine map about its middle.
struct PlantedSprite {
  Exact offset = 0;
  std::vector<dvec2> local;  ///< px about the middle
  dvec2 moved(dvec2 p) const { return {1.01 * p.x + 0.02 * p.y + 3, -0.015 * p.x + 0.99 * p.y - 2}; }
};

PlantedSprite planted_sprite(double ratio) {
  PlantedSprite sprite{Exact(ratio) * kSpriteHalf_px, {}};
  Random random(19);
  for (int i = 0; i < kFitPoints; ++i) sprite.local.push_back(random.in_square(kSpriteHalf_px));
  return sprite;
}

template <typename Real>
struct AffineIn {
  Real a = 0, b = 0, tx = 0, c = 0, d = 0, ty = 0;
};

/// In pixels, against the planted map: the largest over the points.
template <typename Real>
double planted_error(const PlantedSprite& sprite, const AffineIn<Real>& fitted) {
  Exact worst = 0;
  for (const dvec2& p : sprite.local) {
    const Exact x = Real(sprite.offset + p.x),
                y = Real(sprite.offset + p.y);  // the points as this width holds them
    const Exact u = Exact(fitted.a) * x + Exact(fitted.b) * y + fitted.tx - sprite.offset;
    const Exact v = Exact(fitted.c) * x + Exact(fitted.d) * y + fitted.ty - sprite.offset;
    worst = worse(worst, std::hypot(u - sprite.moved(p).x, v - sprite.moved(p).y));
  }
  return double(worst);
}

/// Solves m x = r by elimination with pivots; not finite where m is singular.
template <typename Real, int N>
std::array<Real, N> eliminated(std::array<std::array<Real, N>, N> m, std::array<Real, N> r) {
  for (int k = 0; k < N; ++k) {
    int pivot = k;
    for (int i = k + 1; i < N; ++i)
      if (std::fabs(m[i][k]) > std::fabs(m[pivot][k])) pivot = i;
    std::swap(m[k], m[pivot]), std::swap(r[k], r[pivot]);
    for (int i = k + 1; i < N; ++i) {
      const Real factor = m[i][k] / m[k][k];
      for (int j = k; j < N; ++j) m[i][j] -= factor * m[k][j];
      r[i] -= factor * r[k];
    }
  }
  for (int k = N - 1; k >= 0; --k) {
    for (int j = k + 1; j < N; ++j) r[k] -= m[k][j] * r[j];
    r[k] /= m[k][k];
  }
  return r;
}

/// The normal equations of (x, y, 1), about (cx, cy) then and (mx, my) now, lengths over `unit`.
template <typename Real>
AffineIn<Real> normal_equations(const std::vector<std::array<Real, 4>>& rows, Real cx, Real cy, Real mx,
                                Real my, Real unit) {
  std::array<std::array<Real, 3>, 3> m{};
  std::array<Real, 3> ru{}, rv{};
  for (const auto& [x, y, u, v] : rows) {
    const std::array<Real, 3> q{(x - cx) / unit, (y - cy) / unit, 1};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) m[i][j] += q[i] * q[j];
      ru[i] += q[i] * ((u - mx) / unit), rv[i] += q[i] * ((v - my) / unit);
    }
  }
  const auto a = eliminated<Real, 3>(m, ru), b = eliminated<Real, 3>(m, rv);
  return {a[0], a[1], a[2] * unit + mx - (a[0] * cx + a[1] * cy),
          b[0], b[1], b[2] * unit + my - (b[0] * cx + b[1] * cy)};
}

template <typename Real>
double error_of_fit(double ratio, bool centred) {
  const PlantedSprite sprite = planted_sprite(ratio);
  std::vector<std::array<Real, 4>> rows;
  Real cx = 0, cy = 0, mx = 0, my = 0;
  for (const dvec2& p : sprite.local) {
    const dvec2 q = sprite.moved(p);
    rows.push_back({Real(sprite.offset + p.x), Real(sprite.offset + p.y), Real(sprite.offset + q.x),
                    Real(sprite.offset + q.y)});
    if (!centred) continue;
    const auto& [x, y, u, v] = rows.back();
    cx += x / kFitPoints, cy += y / kFitPoints, mx += u / kFitPoints, my += v / kFitPoints;
  }
  return planted_error(
      sprite, normal_equations<Real>(rows, cx, cy, mx, my, centred ? Real(kSpriteHalf_px) : Real(1)));
}

double error_of_tool_fit(double ratio) {
  const PlantedSprite sprite = planted_sprite(ratio);
  std::vector<dvec2> then_px, now_px;
  for (const dvec2& p : sprite.local) {
    const dvec2 middle(double(sprite.offset));
    then_px.push_back(middle + p);
    now_px.push_back(middle + sprite.moved(p));
  }
  const layers::Affine2 map = warp::fit(then_px, now_px, warp::Curve::aff).warp.affine();
  return planted_error<double>(sprite, {map.a, map.b, map.tx, map.c, map.d, map.ty});
}

// --- Projections

constexpr double kBoxHalf_m = 1, kAway_m = 8;

/// A camera turned by 0.5 rad about y, `kAway_m` from a box at (offset, offset, offset).
struct FarBox {
  Exact offset = 0;
  Exact cosine = std::cos(Exact(0.5)), sine = std::sin(Exact(0.5));
  Exact focal_px = 512 / std::tan(Exact(0.45));
  /// The camera's axes by rows: right, up, back.
  std::array<std::array<Exact, 3>, 3> axes() const {
    return {{{cosine, 0, -sine}, {0, 1, 0}, {sine, 0, cosine}}};
  }
  std::array<Exact, 3> eye() const { return {offset + kAway_m * sine, offset, offset + kAway_m * cosine}; }
  std::vector<std::array<Exact, 3>> corners() const {
    std::vector<std::array<Exact, 3>> all;
    for (int k = 0; k < 8; ++k)
      all.push_back(
          {offset + (k & 1 ? 1 : -0.9L), offset + (k & 2 ? 0.8L : -1), offset + (k & 4 ? 0.7L : -1)});
    return all;
  }
};

/// Places of the corners in this width, by one matrix or from the eye, against those of long double.
template <typename Real>
double error_of_projection(double ratio, bool eye_first) {
  const FarBox box{Exact(ratio) * kBoxHalf_m};
  const auto axes = box.axes();
  const auto eye = box.eye();
  Exact worst = 0;
  for (const auto& corner : box.corners()) {
    Exact right[3];
    Real got[3];
    for (int k = 0; k < 3; ++k) {
      right[k] = 0;
      for (int i = 0; i < 3; ++i) right[k] += axes[k][i] * (corner[i] - eye[i]);
      Real sum = 0, shift = 0;
      for (int i = 0; i < 3; ++i) {
        const Real axis = Real(axes[k][i]), p = Real(corner[i]), e = Real(eye[i]);
        sum += eye_first ? axis * (p - e) : axis * p;
        shift += axis * e;
      }
      got[k] = eye_first ? sum : sum - shift;
    }
    const Exact dx = box.focal_px * (Exact(got[0]) / -got[2] - right[0] / -right[2]);
    const Exact dy = box.focal_px * (Exact(got[1]) / -got[2] - right[1] / -right[2]);
    worst = worse(worst, std::hypot(dx, dy));
  }
  return double(worst);
}

/// The decision side's own matrix and division.
double error_of_tool_projection(double ratio) {
  const FarBox box{Exact(ratio) * kBoxHalf_m};
  const auto axes = box.axes();
  const auto eye = box.eye();
  layers::CameraState camera;
  camera.fov_y_rad = 0.9;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) camera.world_from_camera[k][i] = double(axes[k][i]);
  for (int i = 0; i < 3; ++i) camera.world_from_camera[3][i] = double(eye[i]);
  const layers::ivec2 display{1024, 1024};
  const layers::dmat4 clip_from_world = layers::clip_from_world(camera, display);
  Exact worst = 0;
  for (const auto& corner : box.corners()) {
    Exact right[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) right[k] += axes[k][i] * (corner[i] - eye[i]);
    const layers::dvec4 clip =
        clip_from_world * layers::dvec4(double(corner[0]), double(corner[1]), double(corner[2]), 1);
    const dvec2 got = layers::screen_from_clip(clip, display);
    worst = worse(worst, std::hypot(got.x - (512 + box.focal_px * right[0] / -right[2]),
                                    got.y - (512 - box.focal_px * right[1] / -right[2])));
  }
  return double(worst);
}

WidthCurve curve_of(const std::string& name, const std::function<double(double)>& error_at) {
  WidthCurve curve{name, {}};
  for (int half_decade = 0; half_decade <= 24; ++half_decade) {
    const double ratio = std::pow(10, half_decade / 2.0);
    curve.points.push_back({ratio, error_at(ratio)});
  }
  return curve;
}

}  // namespace

WidthCurves measure_number_widths() {
  WidthCurves curves;
  curves.fits = {curve_of("as printed, float", [](double r) { return error_of_fit<float>(r, false); }),
                 curve_of("as printed, double", [](double r) { return error_of_fit<double>(r, false); }),
                 curve_of("centred, float", [](double r) { return error_of_fit<float>(r, true); }),
                 curve_of("centred, double", [](double r) { return error_of_fit<double>(r, true); }),
                 curve_of("the tool's aff", error_of_tool_fit)};
  curves.projections = {
      curve_of("one matrix, float", [](double r) { return error_of_projection<float>(r, false); }),
      curve_of("one matrix, double", [](double r) { return error_of_projection<double>(r, false); }),
      curve_of("eye first, float", [](double r) { return error_of_projection<float>(r, true); }),
      curve_of("eye first, double", [](double r) { return error_of_projection<double>(r, true); }),
      curve_of("the tool's capture", error_of_tool_projection)};
  return curves;
}

}  // namespace talisman::sequences
