// SPDX-License-Identifier: Apache-2.0
#include "warp/color.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"
#include "warp/fit.h"

namespace talisman::warp {
namespace {

using layers::dvec3;

/// A colour that the fit can square: finite, not negative, not beyond any light source.
constexpr double kBrightest = 1e25;
bool is_colour(double channel) { return channel >= 0 && channel <= kBrightest; }

struct Channel {
  double multiplier = 1;
  ColorStatus status = ColorStatus::Black;
};

Channel fit_channel(std::span<const dvec3> then, std::span<const dvec3> now, int channel, double largest) {
  double brightest = 0;  // the unit of the sums: dark sprites keep all their digits
  for (const dvec3& c : then) brightest = std::max(brightest, c[channel]);
  for (std::size_t i = 0; i < then.size(); ++i)
    if (!is_colour(then[i][channel]) || !is_colour(now[i][channel])) return {1, ColorStatus::NotFinite};
  if (!(brightest > 0)) return {1, ColorStatus::Black};
  const auto same = [channel](const dvec3& a, const dvec3& b) { return a[channel] == b[channel]; };
  if (std::equal(then.begin(), then.end(), now.begin(), same))
    return {1, ColorStatus::Converged};  // exactly, at rest
  double products = 0, squares = 0;
  for (std::size_t i = 0; i < then.size(); ++i) {
    const double share = then[i][channel] / brightest;
    products += share * now[i][channel];
    squares += share * share;
  }
  const double multiplier = products / squares / brightest;
  if (!(multiplier <= largest)) return {largest, ColorStatus::Limited};
  return {multiplier, ColorStatus::Converged};
}

void measure(std::span<const dvec3> then, std::span<const dvec3> now, ColorFit& fitted) {
  double sum = 0, largest = -1;
  for (std::size_t i = 0; i < then.size(); ++i) {
    const dvec3 r = fitted.multiplier * then[i] - now[i];
    double squared = r.x * r.x + r.y * r.y + r.z * r.z;
    if (!(squared <= kHugePx * kHugePx)) squared = kHugePx * kHugePx;  // also NaN
    sum += squared;
    if (squared > largest) largest = squared, fitted.worst_point = static_cast<int>(i);
  }
  if (then.empty()) return;
  fitted.rms = std::fmin(std::sqrt(sum / static_cast<double>(then.size())), kHugePx);
  fitted.max = std::sqrt(largest);
}

}  // namespace

std::string_view name(ColorStatus status) {
  switch (status) {
    case ColorStatus::Converged:
      return "converged";
    case ColorStatus::Limited:
      return "limited";
    case ColorStatus::Black:
      return "black";
    case ColorStatus::NotFinite:
      return "not finite";
  }
  TALISMAN_CHECK(false && "no such status");
}

ColorFit fit_color(std::span<const dvec3> then_linear, std::span<const dvec3> now_linear,
                   const ColorOptions& options) {
  TALISMAN_CHECK_EQ(then_linear.size(), now_linear.size());
  TALISMAN_CHECK(options.largest_multiplier > 0);
  ColorFit fitted;
  for (int channel = 0; channel < 3; ++channel) {
    const Channel best = fit_channel(then_linear, now_linear, channel, options.largest_multiplier);
    fitted.multiplier[channel] = best.multiplier;
    fitted.status[channel] = best.status;
  }
  measure(then_linear, now_linear, fitted);
  return fitted;
}

}  // namespace talisman::warp
