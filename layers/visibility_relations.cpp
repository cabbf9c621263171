// SPDX-License-Identifier: Apache-2.0
#include "layers/visibility_relations.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "layers/convex.h"

namespace talisman::layers {

namespace {

/// A plane is kept if the pair can move like this for so many frames before it fails; otherwise a better one
/// is searched for.
constexpr double kFramesAhead = 8;
/// The same for pairs whose motion is not known yet, relative to the smaller body.
constexpr double kFirstSlack = 0.02;
/// The margin of the extents: so many frames of their change, at least that share of their width for new
/// bodies, at most that share.
constexpr float kMarginFrames = 12, kFirstMargin = 0.05f, kMostMargin = 0.25f;
/// The tree is built anew when its nodes have grown by this factor.
constexpr double kWorn = 1.3;
/// Above the rounding of a support, relative to the largest coordinate.
constexpr double kRounding = 1e-14;
constexpr double kLargest = 1e60;

/// What one pass over the points of a body finds.
struct Pass {
  WorldBounds bounds;
  double step2 = 0;
  bool usable = true;
};

Pass pass_over(std::span<const dvec3> points, std::span<const dvec3> before) {
  Pass pass;
  dvec3 lo = pass.bounds.lo, hi = pass.bounds.hi;
  double bad = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec3& p = points[i];
    const dvec3 d = p - before[i];
    pass.step2 = std::max(pass.step2, d.x * d.x + d.y * d.y + d.z * d.z);
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    bad += p.x * 0 + p.y * 0 + p.z * 0;  // NaN for what is not finite, which min and max may pass over
  }
  pass.bounds = {lo, hi};
  const double largest = std::max({-lo.x, -lo.y, -lo.z, hi.x, hi.y, hi.z});
  pass.usable = bad == 0 && !points.empty() && largest <= kLargest;
  return pass;
}

double largest_coordinate(const WorldBounds& b) {
  return std::max({std::fabs(b.lo.x), std::fabs(b.lo.y), std::fabs(b.lo.z), std::fabs(b.hi.x),
                   std::fabs(b.hi.y), std::fabs(b.hi.z)});
}

struct Plane {
  double h = HUGE_VAL;
  dvec3 normal{0, 0, 0};
};

/// The best plane across an axis between a and conv({e} ∪ b).
Plane axis_plane(const WorldBounds& a, const WorldBounds& b, const dvec3& eye) {
  Plane best;
  for (int k = 0; k < 3; ++k) {
    const double up = a.hi[k] - std::min(b.lo[k], eye[k]), down = std::max(b.hi[k], eye[k]) - a.lo[k];
    if (std::min(up, down) >= best.h) continue;
    best = {std::min(up, down), {0, 0, 0}};
    best.normal[k] = up <= down ? 1 : -1;
  }
  return best;
}

double largest_along(const dvec3& n, std::span<const dvec3> points) {
  double most = -HUGE_VAL;
  for (const dvec3& p : points) most = std::max(most, p.x * n.x + p.y * n.y + p.z * n.z);
  return most;
}

void erase_value(std::vector<int>& values, int value) {
  const auto at = std::find(values.begin(), values.end(), value);
  *at = values.back();
  values.pop_back();
}

float largest_change(const DirectionBox& a, const DirectionBox& b) {
  float most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max({most, std::fabs(a.lo[k] - b.lo[k]), std::fabs(a.hi[k] - b.hi[k])});
  return most;
}

float width(const DirectionBox& box) {
  return std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}

}  // namespace

int OcclusionRelations::add_body(int layer, OrderGroup group) {
  if (free_bodies_.empty()) {
    free_bodies_.push_back(static_cast<int>(bodies_.size()));
    bodies_.emplace_back();
    travel_.push_back(0);
    widened_.emplace_back();
    mark_.push_back(0);
  }
  const int body = free_bodies_.back();
  free_bodies_.pop_back();
  bodies_[body] = Body{};
  bodies_[body].layer = layer, bodies_[body].group = group;
  other_bodies_ = true;
  return body;
}

void OcclusionRelations::remove_body(int body) {
  while (!bodies_[body].pairs.empty()) drop_pair(bodies_[body].pairs.back());
  bodies_[body] = Body{};
  widened_[body] = DirectionBox{};
  free_bodies_.push_back(body);
  other_bodies_ = true;
}

void OcclusionRelations::place_body(int body, std::span<const dvec3> points) {
  Body& b = bodies_[body];
  const bool anew = b.points.size() != points.size();
  const Pass pass = pass_over(points, anew ? points : std::span<const dvec3>(b.points));
  if (!pass.usable) {
    b.points.clear();
    b.bounds = WorldBounds{};
    return;
  }
  b.placed_anew = b.placed_anew || anew;
  b.points.assign(points.begin(), points.end());
  b.bounds = pass.bounds;
  const dvec3 d = b.bounds.hi - b.bounds.lo;
  b.size = std::max({d.x, d.y, d.z});
  b.step = std::sqrt(pass.step2);
  travel_[body] += b.step;
}

/// True if the body is where the tree has it; otherwise it gets a new place there.
bool OcclusionRelations::same_extents(int body) {
  Body& b = bodies_[body];
  if (b.points.empty()) {
    const bool same = widened_[body].empty();
    b.placed_anew = true;
    b.extents = widened_[body] = DirectionBox{};
    other_bodies_ = other_bodies_ || !same;
    return same;
  }
  const DirectionBox now = directions_to(eye_, b.bounds.lo, b.bounds.hi);
  const DirectionBox before = b.extents;
  b.extents = now;
  if (!b.placed_anew && contains(widened_[body], now)) return true;
  const float most = kMostMargin * width(now);
  const float margin = before.empty() ? kFirstMargin * width(now)
                                      : std::min(most, kMarginFrames * largest_change(before, now));
  other_bodies_ = other_bodies_ || widened_[body].empty();
  for (int k = 0; k < 3; ++k) {
    widened_[body].lo[k] = now.lo[k] - margin;
    widened_[body].hi[k] = now.hi[k] + margin;
  }
  return false;
}

void OcclusionRelations::add_pair(int first, int second) {
  if (free_pairs_.empty()) {
    free_pairs_.push_back(static_cast<int>(pairs_.size()));
    pairs_.emplace_back();
    witnesses_.emplace_back();
  }
  const int pair = free_pairs_.back();
  free_pairs_.pop_back();
  pairs_[pair] = Pair{first, second};
  witnesses_[pair] = Witness{};
  bodies_[first].pairs.push_back(pair);
  bodies_[second].pairs.push_back(pair);
}

void OcclusionRelations::drop_pair(int pair) {
  erase_value(bodies_[pairs_[pair].first].pairs, pair);
  erase_value(bodies_[pairs_[pair].second].pairs, pair);
  pairs_[pair] = Pair{};
  free_pairs_.push_back(pair);
}

void OcclusionRelations::look_up(int body, VisibilityCounters& counters) {
  Body& b = bodies_[body];
  ++mark_count_;
  mark_[body] = mark_count_;
  for (std::size_t i = b.pairs.size(); i-- > 0;) {
    const int pair = b.pairs[i];
    const int other = pairs_[pair].first == body ? pairs_[pair].second : pairs_[pair].first;
    if (!overlap(widened_[body], widened_[other]))
      drop_pair(pair);
    else
      mark_[other] = mark_count_;
    if (b.placed_anew && pairs_[pair].first >= 0) pairs_[pair].term = -1;
  }
  if (widened_[body].empty()) return;
  ++counters.queries;
  found_.clear();
  tree_.query(widened_[body], widened_, found_);
  for (const int other : found_)
    if (mark_[other] != mark_count_ && bodies_[other].group == b.group && bodies_[other].layer != b.layer)
      add_pair(body, other);
}

double OcclusionRelations::tolerance(const Body& a, const Body& b) const {
  const double coordinates = std::max({largest_coordinate(a.bounds), largest_coordinate(b.bounds),
                                       std::fabs(eye_.x), std::fabs(eye_.y), std::fabs(eye_.z)});
  return touch_ * std::min(a.size, b.size) + kRounding * coordinates;
}

OcclusionRelations::Answer OcclusionRelations::occludes(const Body& front, const Body& behind, dvec3& plane,
                                                        VisibilityCounters& counters, bool& exact) const {
  const double t = tolerance(front, behind);
  const double steps = front.step + behind.step + eye_step_;
  const double wanted = std::max(kFramesAhead * steps, kFirstSlack * std::min(front.size, behind.size));
  const Plane axis = axis_plane(front.bounds, behind.bounds, eye_);
  if (t - axis.h >= wanted) return {false, t - axis.h};
  exact = true;
  if (plane != dvec3{0, 0, 0}) {
    const double low = largest_along(plane, front.points);
    const double high = -std::max(largest_along(-plane, behind.points), glm::dot(-plane, eye_));
    if (t - (low - high) >= wanted) return {false, t - (low - high)};
  }
  const DepthDecision d = decide_depth({front.points}, {behind.points, &eye_}, t, plane);
  plane = d.normal;
  if (!d.decided) ++counters.undecided;
  return d.deeper ? Answer{true, d.lower - t} : Answer{false, t - d.upper};
}

void OcclusionRelations::test(int index, VisibilityCounters& counters) {
  Pair& pair = pairs_[index];
  const Body &a = bodies_[pair.first], &b = bodies_[pair.second];
  bool exact = false;
  const Answer first = occludes(a, b, witnesses_[index].first, counters, exact);
  const Answer second = occludes(b, a, witnesses_[index].second, counters, exact);
  counters.exact_tests += exact;
  pair.first_occludes = first.occludes, pair.second_occludes = second.occludes;
  // The tolerance itself follows the bodies' sizes, by twice their steps at most.
  const double slack = std::max(0.0, std::min(first.slack, second.slack)) * 0.999 / (1 + 2 * touch_);
  pair.term = travel_[pair.first] + travel_[pair.second] + eye_travel_ + slack;
}

void OcclusionRelations::update(const dvec3& eye, VisibilityCounters& counters) {
  eye_step_ = seen_before_ ? glm::length(eye - eye_) : 0;
  eye_travel_ += eye_step_;
  eye_ = eye, seen_before_ = true;
  looked_up_.clear();
  for (int body = 0; body < static_cast<int>(bodies_.size()); ++body) {
    if (bodies_[body].layer < 0) continue;
    ++counters.bodies;
    if (!same_extents(body)) looked_up_.push_back(body);
  }
  if (other_bodies_ || (!looked_up_.empty() && tree_.refit(widened_) > kWorn)) tree_.build(widened_);
  other_bodies_ = false;
  for (const int body : looked_up_) look_up(body, counters);
  for (const int body : looked_up_) bodies_[body].placed_anew = bodies_[body].points.empty();
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) {
    const Pair& pair = pairs_[i];
    if (pair.first < 0) continue;
    ++counters.pairs;
    if (travel_[pair.first] + travel_[pair.second] + eye_travel_ > pair.term) test(i, counters);
    counters.edges += pairs_[i].first_occludes + pairs_[i].second_occludes;
  }
}

}  // namespace talisman::layers
