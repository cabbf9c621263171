// SPDX-License-Identifier: Apache-2.0
#include "layers/foreshortening.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "layers/state.h"

namespace talisman::layers {
namespace {

/// The ratio of depths of one material point: now over then.
double depth_ratio(const MaterialPoint& p) { return p.clip[1].w / p.clip[0].w; }

double apart_px(const MaterialPoint& a, const MaterialPoint& b, ivec2 display_px) {
  return glm::distance(screen_from_clip(a.clip[1], display_px), screen_from_clip(b.clip[1], display_px));
}

/// The material point that was at this share of the edge on the display then.
MaterialPoint at_share(const MaterialPoint& a, const MaterialPoint& b, double share) {
  const double from_a = (1 - share) * b.clip[0].w, from_b = share * a.clip[0].w;
  const double t = from_b / (from_a + from_b);
  return {{a.clip[0] + t * (b.clip[0] - a.clip[0]), a.clip[1] + t * (b.clip[1] - a.clip[1])}, -1};
}

struct BowedPlace {
  double bow_px = 0;
  MaterialPoint at;
};

void add_once(const BowedPlace& candidate, std::vector<BowedPlace>& places) {
  const auto is_candidate = [&](const BowedPlace& p) { return is_same_place(p.at, candidate.at); };
  if (std::none_of(places.begin(), places.end(), is_candidate)) places.push_back(candidate);
}

/// Every place between two corners of the polygon that bows enough.
void add_places(std::span<const MaterialPoint> polygon, ivec2 display_px, std::vector<BowedPlace>& places) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = i + 1; j < polygon.size(); ++j) {
      const MaterialPoint &a = polygon[i], &b = polygon[j];
      const Bow bow = bow_of(depth_ratio(b) / depth_ratio(a));
      const double bow_px = bow.share * apart_px(a, b, display_px);
      if (bow_px >= kLeastBow_px) add_once({bow_px, at_share(a, b, bow.at)}, places);
    }
}

}  // namespace

Bow bow_of(double ratio) {
  const double root = std::sqrt(ratio);
  return {1 / (1 + root), std::fabs(root - 1) / (root + 1)};
}

bool can_bow(double least_ratio, double most_ratio, double apart_px) {
  return least_ratio > 0 && bow_of(most_ratio / least_ratio).share * apart_px >= kLeastBow_px;
}

std::vector<MaterialPoint> bowed_places(std::span<const std::array<int, 3>> triangles,
                                        std::span<const dvec4> clip_then, std::span<const dvec4> clip_now,
                                        std::span<const HalfSpace> half_spaces, ivec2 display_px) {
  std::vector<BowedPlace> places;
  clip_polygons(triangles, clip_then, clip_now, half_spaces,
                [&](std::span<const MaterialPoint> polygon) { add_places(polygon, display_px, places); });
  std::stable_sort(places.begin(), places.end(),
                   [](const BowedPlace& a, const BowedPlace& b) { return a.bow_px > b.bow_px; });
  std::vector<MaterialPoint> points;
  for (std::size_t i = 0; i < std::min(places.size(), kMostBowedPlaces); ++i) points.push_back(places[i].at);
  return points;
}

}  // namespace talisman::layers
