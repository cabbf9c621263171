// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/box_placement.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

using layers::dvec2;
using layers::ivec2;
using layers::RectI;

double squared(double v) { return v * v; }

/// Places in one direction that would overlap a taken box: lo < place < hi.
struct Blocked {
  int lo = 0, hi = 0;
};

/// The nearest place to `wish` in first … last that nothing blocks.
std::optional<int> nearest_free(double wish, int first, int last, std::vector<Blocked>& blocked) {
  const int start = static_cast<int>(std::lround(std::clamp(wish, double(first), double(last))));
  int above = start, below = start;
  std::sort(blocked.begin(), blocked.end(), [](const Blocked& a, const Blocked& b) { return a.lo < b.lo; });
  for (const Blocked& b : blocked)
    if (b.lo < below && below < b.hi) below = b.hi;
  std::sort(blocked.begin(), blocked.end(), [](const Blocked& a, const Blocked& b) { return a.hi > b.hi; });
  for (const Blocked& b : blocked)
    if (b.lo < above && above < b.hi) above = b.lo;
  if (above < first && below > last) return std::nullopt;
  if (above < first) return below;
  if (below > last) return above;
  return wish - above <= below - wish ? above : below;
}

/// The wish, moved into first … last, and what lies there of `sides`: nearest first, each once.
std::vector<int> columns_by_distance(double wish, int first, int last, std::vector<int> sides) {
  sides.push_back(static_cast<int>(std::lround(std::clamp(wish, double(first), double(last)))));
  std::erase_if(sides, [&](int side) { return side < first || side > last; });
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  std::stable_sort(sides.begin(), sides.end(),
                   [&](int a, int b) { return squared(a - wish) < squared(b - wish); });
  return sides;
}

struct Place {
  RectI box;
  double distance = HUGE_VAL;
};

class Placer {
 public:
  Placer(const RectI& area, const std::vector<RectI>& obstacles) : area_(area), taken_(obstacles) {}

  std::optional<RectI> place(const BoxWish& wish) {
    TALISMAN_CHECK(wish.size_px.x >= 0 && wish.size_px.y >= 0);
    if (wish.size_px.x > area_.x1 - area_.x0 || wish.size_px.y > area_.y1 - area_.y0) return std::nullopt;
    Place best;
    for (const dvec2& at : wish.at)
      if (std::isfinite(at.x) && std::isfinite(at.y)) nearest(at, wish.size_px, best);
    if (best.distance == HUGE_VAL) return std::nullopt;
    taken_.push_back(best.box);
    return best.box;
  }

 private:
  /// Makes `best` better, if a free place is nearer to this wish.
  void nearest(dvec2 wish, ivec2 size, Place& best) const {
    // So far away that squares would not be finite: the direction is all that counts.
    constexpr double kFarthest = 1e9;
    wish = {std::clamp(wish.x, -kFarthest, kFarthest), std::clamp(wish.y, -kFarthest, kFarthest)};
    std::vector<int> sides;
    for (const RectI& t : taken_) sides.insert(sides.end(), {t.x0 - size.x, t.x1});
    for (const int x : columns_by_distance(wish.x, area_.x0, area_.x1 - size.x, std::move(sides))) {
      if (squared(x - wish.x) >= best.distance) break;  // the columns after it are farther still
      std::vector<Blocked> blocked;
      for (const RectI& t : taken_)
        if (t.x0 < x + size.x && x < t.x1) blocked.push_back({t.y0 - size.y, t.y1});
      const auto y = nearest_free(wish.y, area_.y0, area_.y1 - size.y, blocked);
      if (!y) continue;
      const double distance = squared(x - wish.x) + squared(*y - wish.y);
      if (distance < best.distance) best = {{x, *y, x + size.x, *y + size.y}, distance};
    }
  }

  RectI area_;
  std::vector<RectI> taken_;
};

}  // namespace

bool overlap(const RectI& a, const RectI& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

std::vector<std::optional<RectI>> place_boxes(const RectI& area, const std::vector<RectI>& obstacles,
                                              const std::vector<BoxWish>& wishes) {
  Placer placer(area, obstacles);
  std::vector<std::optional<RectI>> places;
  for (const BoxWish& wish : wishes) places.push_back(placer.place(wish));
  return places;
}

}  // namespace talisman::sequences
