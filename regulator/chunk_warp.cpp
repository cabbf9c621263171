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

ChunkWarp chunk_warp(const std::vector<ChunkPlace>& places, layers::ivec2 count, const ChunkLimits& limits) {
  ChunkWarp best{fit_to(places, limits), static_cast<int>(places.size())};
  const auto take_if_better = [&](const warp::FitResult& fitted) {
    const std::size_t within_it = within(places, fitted.warp.affine(), limits.geometric_px).size();
    const int off = static_cast<int>(places.size() - within_it);
    if (off < best.off || !is_sound(best.fitted)) best = {fitted, off};
  };
  if (is_sound(best.fitted)) take_if_better(best.fitted);
  for (int beginning = 0; beginning < kBeginnings; ++beginning) {
    std::vector<ChunkPlace> some;
    for (const ChunkPlace& place : places)
      if (begins(beginning, place, count)) some.push_back(place);
    for (const double share : kWithin) {
      if (some.size() < kFewestPlaces) break;
      const warp::FitResult fitted = fit_to(some, limits);
      if (!is_sound(fitted)) break;
      if (share == kWithin.back()) take_if_better(fitted);
      some = within(places, fitted.warp.affine(), share * limits.geometric_px);
    }
  }
  return best;
}

}  // namespace talisman::regulator
