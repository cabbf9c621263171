// SPDX-License-Identifier: Apache-2.0
#include "layers/foreshortening.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "layers/inline_vector.h"
#include "layers/state.h"

namespace talisman::layers {
namespace {

/// The ratio of depths of one material point: now over then.
double depth_ratio(const MaterialPoint& p) { return p.clip[1].w / p.clip[0].w; }

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

/// A corner, as far as bows depend on it.
struct Corner {
  double depth_ratio = 1;
  dvec2 now_px{0, 0};
};
using Corners = InlineVector<Corner, 8>;

Corners corners_of(std::span<const MaterialPoint> polygon, ivec2 display_px) {
  Corners corners;
  corners.reserve(polygon.size());
  for (const MaterialPoint& p : polygon)
    corners.push_back({depth_ratio(p), screen_from_clip(p.clip[1], display_px)});
  return corners;
}

bool any_can_bow(const Corners& corners) {
  constexpr double kRounding = 1 + 1e-9;  // of the two ways to one distance
  double least = HUGE_VAL, most = 0;
  RectD bounds;
  for (const Corner& corner : corners) {
    least = std::min(least, corner.depth_ratio), most = std::max(most, corner.depth_ratio);
    bounds.include(corner.now_px);
  }
  return can_bow(least, most, kRounding * glm::distance(bounds.lo, bounds.hi));
}

/// Every place between two corners of the polygon that bows enough.
void add_places(std::span<const MaterialPoint> polygon, ivec2 display_px, std::vector<BowedPlace>& places) {
  const Corners corners = corners_of(polygon, display_px);
  if (!any_can_bow(corners)) return;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = i + 1; j < polygon.size(); ++j) {
      const Bow bow = bow_of(corners[j].depth_ratio / corners[i].depth_ratio);
      const double bow_px = bow.share * glm::distance(corners[i].now_px, corners[j].now_px);
      if (bow_px >= kLeastBow_px) add_once({bow_px, at_share(polygon[i], polygon[j], bow.at)}, places);
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

std::vector<MaterialPoint> bowed_places(const PolygonList& polygons, ivec2 display_px) {
  std::vector<BowedPlace> places;
  for (std::size_t i = 0; i < polygons.size(); ++i) add_places(polygons[i], display_px, places);
  std::stable_sort(places.begin(), places.end(),
                   [](const BowedPlace& a, const BowedPlace& b) { return a.bow_px > b.bow_px; });
  std::vector<MaterialPoint> points;
  points.reserve(std::min(places.size(), kMostBowedPlaces));
  for (std::size_t i = 0; i < std::min(places.size(), kMostBowedPlaces); ++i) points.push_back(places[i].at);
  return points;
}

}  // namespace talisman::layers
