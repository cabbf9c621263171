// SPDX-License-Identifier: Apache-2.0
#include "regulator/memory/observer_range.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include <glm/geometric.hpp>

#include "layers/vectors.h"

namespace talisman::regulator {

namespace {

using layers::Box3;
using layers::dvec3;

constexpr double kRadiansPerDegree = M_PI / 180;
/// Of lengths and angles: what rounding may take away.
constexpr double kRangeSlack = 1e-9;

dvec3 low_of(const Box3& box) { return {box.lo[0], box.lo[1], box.lo[2]}; }
dvec3 high_of(const Box3& box) { return {box.hi[0], box.hi[1], box.hi[2]}; }

/// Does the ray from the eye meet the box? By its slabs.
bool is_hit(const Box3& box, const Observer& observer) {
  double from = 0, to = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const double lo = box.lo[k] - observer.eye[k], hi = box.hi[k] - observer.eye[k], d = observer.forward[k];
    if (d == 0) {
      if (lo > 0 || hi < 0) return false;
      continue;
    }
    from = std::max(from, std::min(lo / d, hi / d));
    to = std::min(to, std::max(lo / d, hi / d));
  }
  return from <= to * (1 + kRangeSlack);
}

bool is_before(const Box3& box, const Observer& observer) {
  double height = 0;
  for (int k = 0; k < 3; ++k)
    height += observer.forward[k] * ((observer.forward[k] > 0 ? box.hi[k] : box.lo[k]) - observer.eye[k]);
  return height >= 0 || box == layers::kEverywhere;
}

bool is_in_view(const Box3& box, const Observer& observer) {
  double reach = layers::reach_of({&box, 1});
  for (int k = 0; k < 3; ++k) reach = std::max(reach, std::fabs(observer.eye[k]));
  return !layers::RegionTest(observer.view, reach).misses(box);
}

/// Dijkstra's search over ways: a portal and the cell that it leads into.
class RangeSearch {
 public:
  RangeSearch(const layers::CellSet& set, const std::vector<std::vector<int>>& portals_of,
              const Observer& observer, const PrefetchOptions& options)
      : set_(set),
        portals_of_(portals_of),
        observer_(observer),
        options_(options),
        most_m_(options.frames * observer.step_m),
        verdicts_(set.cells.size(), Verdict::Open),
        is_done_(2 * set.portals.size(), false) {
    for (const layers::Portal& portal : set.portals) boxes_.push_back(layers::box_of(portal.corners));
  }

  std::vector<RangeCell> run(std::span<const int> around_eye) {
    for (const int cell : around_eye) enter(cell, 0), verdicts_[cell] = Verdict::Taken;
    for (const int cell : around_eye) look_on(cell, -1, 0);
    while (!waiting_.empty()) {
      const auto [way_m, way] = waiting_.top();
      waiting_.pop();
      if (is_done_[way]) continue;
      is_done_[way] = true;
      const int cell = set_.portals[way / 2].cells[way % 2];
      if (verdicts_[cell] == Verdict::Open) judge(cell, way_m);
      if (verdicts_[cell] == Verdict::Taken) look_on(cell, way / 2, way_m);
    }
    std::stable_sort(found_.begin(), found_.end(), [](const RangeCell& a, const RangeCell& b) {
      return std::tie(a.frames, a.cell) < std::tie(b.frames, b.cell);
    });
    return std::move(found_);
  }

 private:
  enum class Verdict : char { Open, Taken, Culled };
  using Waiting = std::pair<double, int>;

  void enter(int cell, double way_m) { found_.push_back({cell, way_m > 0 ? way_m / observer_.step_m : 0}); }
  void judge(int cell, double way_m) {
    const Box3 box = layers::box_of(set_.cells[cell].lo, set_.cells[cell].hi);
    verdicts_[cell] = passes(options_.range, box, observer_) ? Verdict::Taken : Verdict::Culled;
    if (verdicts_[cell] == Verdict::Taken) enter(cell, way_m);
  }
  void look_on(int cell, int by, double way_m) {
    for (const int portal : portals_of_[cell]) {
      if (portal == by) continue;
      const double between = by < 0 ? 0 : gap(boxes_[by], boxes_[portal]);
      const double next_m = std::max(way_m + between, gap(boxes_[portal], observer_.eye));
      const int way = 2 * portal + (set_.portals[portal].cells[0] == cell);
      if (next_m <= most_m_ * (1 + kRangeSlack) && !is_done_[way]) waiting_.push({next_m, way});
    }
  }

  const layers::CellSet& set_;
  const std::vector<std::vector<int>>& portals_of_;
  const Observer& observer_;
  const PrefetchOptions& options_;
  double most_m_;
  std::vector<Box3> boxes_;  ///< of the portals
  std::vector<Verdict> verdicts_;
  std::vector<bool> is_done_;  ///< by way
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
  std::vector<RangeCell> found_;
};

/// After n frames, by the formula of the header.
bool may_be_seen(const Ball& ball, const Observer& observer, double n) {
  const dvec3 to = ball.middle - observer.eye;
  const double distance = glm::length(to), reach = (ball.radius_m + n * observer.step_m) * (1 + kRangeSlack);
  if (!(distance > reach)) return true;
  const double off_axis = std::acos(std::clamp(glm::dot(to, observer.forward) / distance, -1.0, 1.0));
  return off_axis <= observer.half_diagonal_rad + n * observer.turn_rad + std::asin(reach / distance) + 1e-7;
}

}  // namespace

Ball ball_around(const Box3& box) {
  if (box == layers::kEverywhere) return {{0, 0, 0}, HUGE_VAL};
  return {0.5 * (low_of(box) + high_of(box)), 0.5 * glm::length(high_of(box) - low_of(box))};
}

Observer observer(const layers::CameraState& camera, layers::ivec2 display_px, const PrefetchOptions& options,
                  double fps) {
  Observer who;
  who.eye = dvec3(camera.world_from_camera[3]);
  who.forward = layers::direction_or_zero(-dvec3(camera.world_from_camera[2]));
  const double tan_y = std::tan(camera.fov_y_rad / 2), tan_x = tan_y * display_px.x / display_px.y;
  who.half_diagonal_rad = std::atan(std::hypot(tan_x, tan_y));
  who.focal_px = display_px.y / (2 * tan_y);
  who.display_px2 = static_cast<double>(display_px.x) * display_px.y;
  who.view = view_region(camera, display_px, 0);
  who.step_m = options.speed_m_per_s / fps;
  who.turn_rad = options.turn_deg_per_s * kRadiansPerDegree / fps;
  return who;
}

std::vector<RangeCell> range_cells(const layers::CellSet& set,
                                   const std::vector<std::vector<int>>& portals_of,
                                   std::span<const int> around_eye, const Observer& observer,
                                   const PrefetchOptions& options) {
  return RangeSearch(set, portals_of, observer, options).run(around_eye);
}

bool passes(RangeCull cull, const Box3& box, const Observer& observer) {
  switch (cull) {
    case RangeCull::Any:
      return true;
    case RangeCull::Plane:
      return is_before(box, observer);
    case RangeCull::Frustum:
      return is_in_view(box, observer);
    case RangeCull::Direction:
      return is_hit(box, observer);
  }
  return true;
}

bool passes(LookaheadCull cull, const Box3& box, const Observer& observer) {
  const RangeCull same[] = {RangeCull::Any, RangeCull::Plane, RangeCull::Frustum};
  return passes(same[static_cast<int>(cull)], box, observer);
}

int frames_until_in_view(const Ball& ball, const Observer& observer, int most) {
  int from = 0, to = most + 1;  // it is seen after `to`, or `to` is beyond the last
  while (from < to) {
    const int middle = (from + to) / 2;
    if (middle <= most && may_be_seen(ball, observer, middle))
      to = middle;
    else
      from = middle + 1;
  }
  return to;
}

double gap(const Box3& box, const dvec3& p) {
  return glm::length(glm::max(dvec3(0), glm::max(low_of(box) - p, p - high_of(box))));
}

double gap(const Box3& a, const Box3& b) {
  return glm::length(glm::max(dvec3(0), glm::max(low_of(a) - high_of(b), low_of(b) - high_of(a))));
}

}  // namespace talisman::regulator
