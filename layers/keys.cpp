// SPDX-License-Identifier: Apache-2.0
#include "layers/animation.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "layers/check.h"

namespace talisman::layers {

namespace {

/// Where a time lies: between keys `index` and `index + 1`, at the share `tau` of the way in time.
struct Place {
  int index = 0;
  double tau = 0;
};

Place locate(const std::vector<double>& times, double t_s) {
  const int last = static_cast<int>(times.size()) - 1;
  if (last < 1 || !(t_s > times.front())) return {0, 0};
  if (t_s >= times.back()) return {last - 1, 1};
  const auto next = std::upper_bound(times.begin(), times.end(), t_s);
  const int index = static_cast<int>(next - times.begin()) - 1;
  const double tau = (t_s - times[index]) / (times[index + 1] - times[index]);
  return {index, tau >= 0 && tau <= 1 ? tau : 0};
}

double length(double v) { return std::fabs(v); }
double length(const dvec3& v) { return std::hypot(v.x, v.y, v.z); }
bool finite(double v) { return std::isfinite(v); }
bool finite(const dvec3& v) { return finite(v.x) && finite(v.y) && finite(v.z); }

template <typename T>
T linear(const T& a, const T& b, double tau) {
  return a == b ? a : (1 - tau) * a + tau * b;
}

/// One span of the centripetal spline with its neighbours. At the ends of the path the neighbour is the end
/// itself, at distance 0.
template <typename T>
struct Span {
  T p0, p1, p2, p3;
  double d01, d12, d23;  ///< knot distances
  double h01, h12, h23;  ///< time distances, s

  Span(const Keys<T>& keys, int i) {
    const int last = static_cast<int>(keys.values.size()) - 1;
    const int before = std::max(i - 1, 0), after = std::min(i + 2, last);
    const auto& p = keys.values;
    const auto& t = keys.times_s;
    p0 = p[before], p1 = p[i], p2 = p[i + 1], p3 = p[after];
    d01 = knot_distance(p0, p1), d12 = knot_distance(p1, p2), d23 = knot_distance(p2, p3);
    h01 = t[i] - t[before], h12 = t[i + 1] - t[i], h23 = t[after] - t[i + 1];
  }

  static double knot_distance(const T& a, const T& b) { return std::sqrt(length(b - a)); }
};

/// Derivative of the spline by its knot parameter at `p`; one-sided where a neighbour coincides.
template <typename T>
T tangent(const T& before, const T& p, const T& after, double d_before, double d_after) {
  if (d_before == 0 && d_after == 0) return T(0);
  if (d_before == 0) return (after - p) / d_after;
  if (d_after == 0) return (p - before) / d_before;
  return (p - before) / d_before - (after - before) / (d_before + d_after) + (after - p) / d_after;
}

/// Slope of the pace at a key (Fritsch & Butland's weighted harmonic mean: monotone), knots per second.
double pace_slope(double d_before, double h_before, double d_after, double h_after) {
  if (h_before == 0) return d_after / h_after;
  if (h_after == 0) return d_before / h_before;
  if (d_before == 0 || d_after == 0) return 0;
  const double w_before = 2 * h_after + h_before, w_after = h_after + 2 * h_before;
  return (w_before + w_after) / (w_before * h_before / d_before + w_after * h_after / d_after);
}

/// Cubic with values a, b and end slopes m, n on 0 … 1.
template <typename T>
T hermite(const T& a, const T& b, const T& m, const T& n, double u) {
  const double v = 1 - u;
  return a * (v * v * (1 + 2 * u)) + b * (u * u * (1 + 2 * v)) + m * (u * v * v) - n * (u * u * v);
}

template <typename T>
T hermite_slope(const T& a, const T& b, const T& m, const T& n, double u) {
  const double v = 1 - u;
  return (b - a) * (6 * u * v) + m * (v * (1 - 3 * u)) + n * (u * (3 * u - 2));
}

/// Share of the span's knot distance that is covered at the share `tau` of its time.
template <typename T>
double pace(const Span<T>& s, double tau) {
  const double per_knot = s.h12 / s.d12;
  const double m = pace_slope(s.d01, s.h01, s.d12, s.h12) * per_knot;
  const double n = pace_slope(s.d12, s.h12, s.d23, s.h23) * per_knot;
  const double u = hermite(0.0, 1.0, m, n, tau);
  return std::isfinite(u) ? std::clamp(u, 0.0, 1.0) : tau;
}

template <typename T>
T catmull_rom(const Keys<T>& keys, const Place& at) {
  const Span<T> s(keys, at.index);
  if (s.p1 == s.p2 || at.tau == 0) return s.p1;
  if (at.tau == 1) return s.p2;
  const T m = tangent(s.p0, s.p1, s.p2, s.d01, s.d12) * s.d12;
  const T n = tangent(s.p1, s.p2, s.p3, s.d12, s.d23) * s.d12;
  const T value = hermite(s.p1, s.p2, m, n, pace(s, at.tau));
  return finite(value) ? value : linear(s.p1, s.p2, at.tau);  // squares of huge values can overflow
}

/// The glTF spline of span `i`; the end value where a square of huge values overflows.
template <typename T>
T cubic_spline(const Keys<T>& keys, const Place& at) {
  const int i = at.index;
  const T &a = keys.values[i], &b = keys.values[i + 1];
  if (at.tau == 0) return a;
  if (at.tau == 1) return b;
  const double span_s = keys.times_s[i + 1] - keys.times_s[i];
  return hermite(a, b, keys.out_tangents[i] * span_s, keys.in_tangents[i + 1] * span_s, at.tau);
}

template <typename T>
T vector_at(const Keys<T>& keys, double t_s) {
  TALISMAN_CHECK(!keys.values.empty());
  TALISMAN_CHECK_EQ(keys.values.size(), keys.times_s.size());
  if (keys.values.size() == 1) return keys.values[0];
  const Place at = locate(keys.times_s, t_s);
  const T& a = keys.values[at.index];
  const T& b = keys.values[at.index + 1];
  switch (keys.interpolation) {
    case Interpolation::Step:
      return at.tau < 1 ? a : b;
    case Interpolation::Linear:
      return linear(a, b, at.tau);
    case Interpolation::CatmullRom:
      return catmull_rom(keys, at);
    case Interpolation::CubicSpline: {
      const T value = cubic_spline(keys, at);
      return finite(value) ? value : linear(a, b, at.tau);
    }
  }
  return a;
}

/// Along the shorter arc: q and −q are the same rotation, so the sign of `b` is chosen next to `a`.
glm::dquat slerp(const glm::dquat& a, glm::dquat b, double tau) {
  if (glm::dot(a, b) < 0) b = -b;
  if (a == b) return a;
  const glm::dquat sum = a + b, difference = b - a;
  const double half = std::atan2(std::sqrt(glm::dot(difference, difference)), std::sqrt(glm::dot(sum, sum)));
  const double sine = std::sin(2 * half);
  if (sine < 1e-9) return unit(a * (1 - tau) + b * tau);  // the arc is straight to double precision
  return unit(a * (std::sin((1 - tau) * 2 * half) / sine) + b * (std::sin(tau * 2 * half) / sine));
}

/// Direction of travel inside a span, not normalised; zero where the path stands still.
dvec3 travel(const Keys<dvec3>& path, const Place& at) {
  const Span<dvec3> s(path, at.index);
  const dvec3 chord = s.p2 - s.p1;
  if (path.interpolation != Interpolation::CatmullRom || s.d12 == 0) return chord;
  const dvec3 m = tangent(s.p0, s.p1, s.p2, s.d01, s.d12) * s.d12;
  const dvec3 n = tangent(s.p1, s.p2, s.p3, s.d12, s.d23) * s.d12;
  const dvec3 slope = hermite_slope(s.p1, s.p2, m, n, pace(s, at.tau));
  return finite(slope) ? slope : chord;
}

/// Unit length, with the vertical part removed first where a horizontal direction is wanted; zero where
/// nothing (or nothing but rounding) is left.
dvec3 direction_of(const dvec3& v, bool horizontal) {
  const double whole = length(v);
  if (!std::isfinite(whole) || whole < 1e-300) return {0, 0, 0};
  dvec3 d = v / whole;
  if (!horizontal) return d;
  d.y = 0;
  const double rest = length(d);
  return rest < 1e-8 ? dvec3{0, 0, 0} : d / rest;
}

}  // namespace

glm::dquat unit(const glm::dquat& q) {
  const double largest = std::max({std::fabs(q.w), std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {1, 0, 0, 0};
  const glm::dquat scaled(q.w / largest, q.x / largest, q.y / largest, q.z / largest);
  const double norm = std::sqrt(glm::dot(scaled, scaled));
  return std::isfinite(norm) ? scaled / norm : glm::dquat(1, 0, 0, 0);
}

dvec3 value_at(const Keys<dvec3>& keys, double t_s) { return vector_at(keys, t_s); }
double value_at(const Keys<double>& keys, double t_s) { return vector_at(keys, t_s); }

glm::dquat value_at(const Keys<glm::dquat>& keys, double t_s) {
  TALISMAN_CHECK(!keys.values.empty());
  TALISMAN_CHECK_EQ(keys.values.size(), keys.times_s.size());
  if (keys.values.size() == 1) return unit(keys.values[0]);
  const Place at = locate(keys.times_s, t_s);
  const glm::dquat a = unit(keys.values[at.index]), b = unit(keys.values[at.index + 1]);
  if (at.tau == 0) return a;
  if (at.tau == 1) return b;
  if (keys.interpolation == Interpolation::CubicSpline) return unit(cubic_spline(keys, at));
  return keys.interpolation == Interpolation::Step ? a : slerp(a, b, at.tau);
}

dvec3 path_direction(const Keys<dvec3>& path, double t_s, bool horizontal) {
  const int spans = static_cast<int>(path.values.size()) - 1;
  if (spans < 1) return {0, 0, -1};
  const Place at = locate(path.times_s, t_s);
  const dvec3 none{0, 0, 0};
  dvec3 found = direction_of(travel(path, at), horizontal);
  if (found == none) found = direction_of(travel(path, {at.index, 0}), horizontal);
  for (int i = at.index - 1; i >= 0 && found == none; --i)
    found = direction_of(travel(path, {i, 1}), horizontal);
  for (int i = at.index; i < spans && found == none; ++i)
    found = direction_of(travel(path, {i, 1}), horizontal);
  return found == none ? dvec3{0, 0, -1} : found;
}

}  // namespace talisman::layers
