// SPDX-License-Identifier: Apache-2.0
#include "layers/foreshortening.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <glm/geometric.hpp>

#include "layers/inline_vector.h"
#include "layers/place_set.h"
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

/// Places that bow, each once.
class BowedPlaces {
 public:
  void add(double bow_px, const MaterialPoint& at) {
    if (places_.add(at)) bows_px_.push_back(bow_px);
  }
  std::vector<MaterialPoint> largest_first(std::size_t at_most) const {
    std::vector<std::size_t> order(bows_px_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return bows_px_[a] > bows_px_[b]; });
    order.resize(std::min(order.size(), at_most));
    std::vector<MaterialPoint> points;
    points.reserve(order.size());
    for (const std::size_t i : order) points.push_back(places_.places()[i]);
    return points;
  }

 private:
  PlaceSet places_{kMostBowedPlaces};
  std::vector<double> bows_px_;
};

/// A corner, as far as bows depend on it.
struct Corner {
  double depth_ratio = 1, root = 1;  // and its square root
  dvec2 now_px{0, 0};
};

constexpr double kRounding = 1 - 1e-9;  // of two ways to one bow

/// False: what lies between the two, or between what has these roots and is nowhere farther apart, bows less than
/// kLeastBow_px. Without a root or a division: nearly all bow less.
bool may_bow(double root_a, double root_b, const dvec2& apart_px) {
  const double difference = root_a - root_b, sum = root_a + root_b;
  return difference * difference * glm::dot(apart_px, apart_px) >=
         kRounding * kLeastBow_px * kLeastBow_px * sum * sum;
}

/// The corners of polygons. Those of the body belong to several and are worked out once.
class Corners {
 public:
  using OfPolygon = InlineVector<Corner, 8>;

  explicit Corners(ivec2 display_px) : display_px_(display_px) {}

  OfPolygon of(std::span<const MaterialPoint> polygon) {
    OfPolygon corners;
    corners.reserve(polygon.size());
    for (const MaterialPoint& p : polygon) corners.push_back(p.point < 0 ? worked_out(p) : known(p));
    return corners;
  }

 private:
  Corner worked_out(const MaterialPoint& p) const {
    const double ratio = depth_ratio(p);
    return {ratio, std::sqrt(ratio), screen_from_clip(p.clip[1], display_px_)};
  }
  const Corner& known(const MaterialPoint& p) {
    const auto i = static_cast<std::size_t>(p.point);
    if (i >= known_.size()) known_.resize(i + 1), is_known_.resize(i + 1);
    if (!is_known_[i]) known_[i] = worked_out(p), is_known_[i] = true;
    return known_[i];
  }

  ivec2 display_px_;
  std::vector<Corner> known_;  // by MaterialPoint::point
  std::vector<char> is_known_;
};

bool any_may_bow(const Corners::OfPolygon& corners) {
  double least = HUGE_VAL, most = 0;
  RectD bounds;
  for (const Corner& corner : corners) {
    least = std::min(least, corner.root), most = std::max(most, corner.root);
    bounds.include(corner.now_px);
  }
  return may_bow(least, most, bounds.hi - bounds.lo);
}

/// Every place between two corners of the polygon that bows enough.
void add_places(std::span<const MaterialPoint> polygon, const Corners::OfPolygon& corners,
                BowedPlaces& places) {
  if (!any_may_bow(corners)) return;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = i + 1; j < polygon.size(); ++j) {
      if (!may_bow(corners[i].root, corners[j].root, corners[j].now_px - corners[i].now_px)) continue;
      const Bow bow = bow_of(corners[j].depth_ratio / corners[i].depth_ratio);
      const double bow_px = bow.share * glm::distance(corners[i].now_px, corners[j].now_px);
      if (bow_px >= kLeastBow_px) places.add(bow_px, at_share(polygon[i], polygon[j], bow.at));
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
  BowedPlaces places;
  Corners corners(display_px);
  for (std::size_t i = 0; i < polygons.size(); ++i) add_places(polygons[i], corners.of(polygons[i]), places);
  return places.largest_first(kMostBowedPlaces);
}

}  // namespace talisman::layers
