// SPDX-License-Identifier: Apache-2.0
#include "regulator/chunk_warp.h"

#include <algorithm>
#include <array>

namespace talisman::regulator {

namespace {

using layers::Affine2;
using layers::dvec2;

constexpr std::array<double, 4> kWithin{4, 2, 1, 0.7};  ///< of δ
constexpr int kBeginnings = 7;
constexpr std::size_t kFewestPlaces = 4;

warp::FitResult fit_to(const std::vector<ChunkPlace>& places, const ChunkLimits& limits) {
  std::vector<dvec2> then_px, now_px;
  for (const ChunkPlace& place : places) {
    then_px.push_back(place.then_px);
    now_px.push_back(place.now_px);
  }
  return warp::fit(then_px, now_px, limits.curve, limits.fit);
}

std::vector<ChunkPlace> within(const std::vector<ChunkPlace>& all, const Affine2& warp, double px) {
  std::vector<ChunkPlace> near;
  for (const ChunkPlace& place : all)
    if (glm::distance(warp(place.then_px), place.now_px) <= px) near.push_back(place);
  return near;
}

bool begins(int beginning, const ChunkPlace& place, layers::ivec2 count) {
  const double x = (place.chunk % count.x + 0.5) / count.x, y = (place.chunk / count.x + 0.5) / count.y;
  switch (beginning) {
    case 1:
      return y < 1.0 / 3;
    case 2:
      return y >= 1.0 / 3 && y < 2.0 / 3;
    case 3:
      return y >= 2.0 / 3;
    case 4:
      return x < 0.5;
    case 5:
      return x >= 0.5;
    case 6:
      return place.is_first;
    default:
      return true;
  }
}

}  // namespace

bool is_sound(const warp::FitResult& fitted) {
  if (fitted.status != warp::FitStatus::Converged && fitted.status != warp::FitStatus::NotConverged)
    return false;
  if (!fitted.warp.is_affine()) return false;
  const Affine2 map = fitted.warp.affine();
  return map.determinant() > 0 && inverse(map).has_value();
}

ChunkWarps chunk_warps(const std::vector<ChunkPlace>& places, layers::ivec2 count,
                       const ChunkLimits& limits) {
  std::size_t most = 0;
  ChunkWarps found;
  for (int beginning = 0; beginning < kBeginnings; ++beginning) {
    std::vector<ChunkPlace> some;
    for (const ChunkPlace& place : places)
      if (begins(beginning, place, count)) some.push_back(place);
    for (const double share : kWithin) {
      if (some.size() < kFewestPlaces) break;
      const warp::FitResult fitted = fit_to(some, limits);
      if (!is_sound(fitted)) break;
      some = within(places, fitted.warp.affine(), share * limits.geometric_px);
      if (share != kWithin.back() || some.size() <= most) continue;
      most = some.size();
      found.warps.assign(1, fitted);
    }
  }
  found.warps.push_back(fit_to(places, limits));
  std::size_t most_within = 0;
  for (const warp::FitResult& fitted : found.warps)
    if (is_sound(fitted))
      most_within = std::max(most_within, within(places, fitted.warp.affine(), limits.geometric_px).size());
  found.fewest_off = static_cast<int>(places.size() - most_within);
  return found;
}

}  // namespace talisman::regulator
