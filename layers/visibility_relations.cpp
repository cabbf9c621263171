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
/// A witness is as good as its slack is positive. One that fails within a frame is given up for a search only
/// if the last search found one for so many frames: trying the old one costs a tenth of a search.
constexpr double kWorthASearch = 16;
/// A search goes on for better bounds if they can last for so many frames.
constexpr double kWorthABound = 2;
/// The margin of the extents: so many frames of their change, at least that share of their width for new
/// bodies, at most that share.
constexpr float kMarginFrames = 12, kFirstMargin = 0.05f, kMostMargin = 0.25f;
/// The tree is built anew when its nodes have grown by this factor.
constexpr double kWorn = 1.3;
/// Above the rounding of a support, relative to the largest coordinate.
constexpr double kRoundingOfPlanes = 1e-14;
constexpr double kLargest = 1e60;
/// Where the eye takes no part in an answer it may go as far as its reach leaves the rounding what it is.
constexpr double kWhereverTheEye = 1e10;

/// What one pass over the points of a body finds.
struct Pass {
  WorldBounds bounds;
  double step2 = 0, reach = 0;
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
  pass.reach = std::max({-lo.x, -lo.y, -lo.z, hi.x, hi.y, hi.z});
  pass.usable = bad == 0 && !points.empty() && pass.reach <= kLargest;
  return pass;
}

struct SeparatingPlane {
  double bodies = HUGE_VAL, eye = HUGE_VAL;  ///< by how much the one, or the eye, is not beyond it
  dvec3 normal{0, 0, 0};
  double h() const { return std::max(bodies, eye); }
};

/// The best plane across an axis between a and conv({e} ∪ b).
SeparatingPlane axis_plane(const WorldBounds& a, const WorldBounds& b, const dvec3& eye) {
  SeparatingPlane best;
  for (int k = 0; k < 3; ++k)
    for (const double side : {1.0, -1.0}) {
      const double low = side > 0 ? a.hi[k] : -a.lo[k], high = side > 0 ? b.lo[k] : -b.hi[k];
      SeparatingPlane plane{low - high, low - side * eye[k], {0, 0, 0}};
      if (plane.h() >= best.h()) continue;
      plane.normal[k] = side;
      best = plane;
    }
  return best;
}

double largest_along(const dvec3& n, std::span<const dvec3> points) {
  double most = -HUGE_VAL;
  for (const dvec3& p : points) most = std::max(most, p.x * n.x + p.y * n.y + p.z * n.z);
  return most;
}

bool uses_apex(const Enclosure& enclosure) {
  return std::find(enclosure.c.begin(), enclosure.c.end(), Enclosure::kApex) != enclosure.c.end();
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

/// How far `inner` may grow on each side and stay within `outer`.
float least_room(const DirectionBox& outer, const DirectionBox& inner) {
  float least = HUGE_VALF;
  for (int k = 0; k < 3; ++k) least = std::min({least, inner.lo[k] - outer.lo[k], outer.hi[k] - inner.hi[k]});
  return least;
}

double distance_to(const WorldBounds& box, const dvec3& eye) {
  dvec3 d;
  for (int k = 0; k < 3; ++k) d[k] = std::max({0.0, box.lo[k] - eye[k], eye[k] - box.hi[k]});
  return glm::length(d);
}

float width(const DirectionBox& box) {
  return std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}

}  // namespace

int OcclusionRelations::add_body(int layer, OrderGroup group) {
  if (free_bodies_.empty()) {
    free_bodies_.push_back(static_cast<int>(bodies_.size()));
    bodies_.emplace_back();
    layer_of_.push_back(-1);
    travel_.push_back(0);
    widened_.emplace_back();
    mark_.push_back(0);
  }
  const int body = free_bodies_.back();
  free_bodies_.pop_back();
  bodies_[body] = Body{};
  bodies_[body].group = group;
  layer_of_[body] = layer;
  other_bodies_ = true;
  return body;
}

void OcclusionRelations::remove_body(int body) {
  while (!bodies_[body].pairs.empty()) drop_pair(bodies_[body].pairs.back());
  bodies_[body] = Body{};
  widened_[body] = DirectionBox{};
  layer_of_[body] = -1;
  free_bodies_.push_back(body);
  other_bodies_ = true;
}

void OcclusionRelations::place_eye(const dvec3& eye) {
  eye_step_ = seen_before_ ? glm::length(eye - eye_) : 0;
  eye_travel_ += eye_step_;
  eye_before_ = eye_;
  eye_ = eye, seen_before_ = true;
}

void OcclusionRelations::place_body(int body, std::span<const dvec3> points) {
  Body& b = bodies_[body];
  const bool anew = b.points.size() != points.size();
  const Pass pass = pass_over(points, anew ? points : std::span<const dvec3>(b.points));
  b.bounds_before = b.bounds;
  if (pass.usable) {
    b.placed_anew = b.placed_anew || anew;
    b.points.assign(points.begin(), points.end());
    b.bounds = pass.bounds, b.reach = pass.reach;
    const dvec3 d = b.bounds.hi - b.bounds.lo;
    b.size = std::max({d.x, d.y, d.z});
    b.step = std::sqrt(pass.step2);
    travel_[body] += b.step;
  } else {
    b.placed_anew = true;
    b.points.clear();
    b.bounds = WorldBounds{};
  }
  follow_extents(body);
}

/// Widens the body's extents anew where they have left the widened ones.
///
/// Where points and eye move by S together, a point of the box around the body, at the distance d from the
/// eye or farther, moves by √3 S relative to the eye at most, and its direction by √3 S / (d - √3 S). That is
/// within the room m that is left while S ≤ m d / (√3 (1 + m)).
void OcclusionRelations::follow_extents(int body) {
  Body& b = bodies_[body];
  if (b.points.empty()) {
    if (!widened_[body].empty()) widen(body, {}, {});
    return;
  }
  const double travel = travel_[body] + eye_travel_;
  if (!b.placed_anew && travel <= b.extents_term) return;
  const DirectionBox now = directions_to(eye_, b.bounds.lo, b.bounds.hi);
  if (b.placed_anew || !contains(widened_[body], now)) {
    const WorldBounds& before = b.bounds_before;
    widen(body, before.empty() ? DirectionBox{} : directions_to(eye_before_, before.lo, before.hi), now);
  }
  constexpr double kSqrt3 = 1.7320508075688774, kRoundingOfExtents = 1e-6;
  const double room = least_room(widened_[body], now) - kRoundingOfExtents;
  b.extents_term =
      room > 0 ? travel + 0.999 * room * distance_to(b.bounds, eye_) / (kSqrt3 * (1 + room)) : -1;
}

/// Gives the body a new place in the tree, `before` being its extents in the last frame.
void OcclusionRelations::widen(int body, const DirectionBox& before, const DirectionBox& now) {
  to_look_up_.push_back(body);
  other_bodies_ = other_bodies_ || widened_[body].empty() || now.empty();
  widened_[body] = now;
  if (now.empty()) return;
  const float margin = before.empty()
                           ? kFirstMargin * width(now)
                           : std::min(kMostMargin * width(now), kMarginFrames * largest_change(before, now));
  for (int k = 0; k < 3; ++k) {
    widened_[body].lo[k] -= margin;
    widened_[body].hi[k] += margin;
  }
}

void OcclusionRelations::add_pair(int first, int second) {
  if (free_pairs_.empty()) {
    free_pairs_.push_back(static_cast<int>(pairs_.size()));
    pairs_.emplace_back();
    witnesses_.emplace_back();
  }
  const int pair = free_pairs_.back();
  free_pairs_.pop_back();
  pairs_[pair] = Pair{};
  pairs_[pair].first = first, pairs_[pair].second = second;
  witnesses_[pair] = Witnesses{};
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
    if (!b.placed_anew || pairs_[pair].first < 0) continue;
    pairs_[pair].term = {};
    witnesses_[pair] = Witnesses{};
  }
  if (widened_[body].empty()) return;
  ++counters.queries;
  found_.clear();
  tree_.query(widened_[body], widened_, found_);
  for (const int other : found_)
    if (mark_[other] != mark_count_ && bodies_[other].group == b.group && layer_of_[other] != layer_of_[body])
      add_pair(body, other);
}

OcclusionRelations::Slack OcclusionRelations::slack_of(const dvec3& plane, const Body& front,
                                                       const Body& behind, double tolerance) const {
  const double room = tolerance - largest_along(plane, front.points);
  return {room - largest_along(-plane, behind.points), room + glm::dot(plane, eye_)};
}

OcclusionRelations::Answer OcclusionRelations::occludes(const Body& front, const Body& behind,
                                                        Witness& witness, VisibilityCounters& counters,
                                                        bool& exact) const {
  const double eye_reach = std::max({std::fabs(eye_.x), std::fabs(eye_.y), std::fabs(eye_.z)});
  const double smaller = std::min(front.size, behind.size);
  const double rounding = kRoundingOfPlanes * std::max({front.reach, behind.reach, eye_reach});
  const double t = touch_ * smaller + rounding;
  const double own_steps = front.step + behind.step, steps = own_steps + eye_step_;
  const SeparatingPlane axis = axis_plane(front.bounds, behind.bounds, eye_);
  const Slack by_axis{t - axis.bodies, t - axis.eye};
  if (by_axis.bodies > rounding && by_axis.bodies >= kFramesAhead * own_steps &&
      by_axis.with_eye >= std::max(kFramesAhead * steps, kFirstSlack * smaller))
    return {false, by_axis};
  exact = true;
  const ConvexSet a{front.points}, c{behind.points, &eye_};
  const auto still_good = [&](const Slack& slack) {
    return slack.least() > rounding && ((slack.bodies >= own_steps && slack.with_eye >= steps) ||
                                        witness.found_slack < kWorthASearch * steps);
  };
  if (witness.enclosure) {
    const double depth = depth_within(*witness.enclosure, a, c) - t;
    const Slack slack{depth, uses_apex(*witness.enclosure) ? depth : kWhereverTheEye * depth};
    if (still_good(slack)) return {true, slack};
  } else if (witness.plane != dvec3{0, 0, 0}) {
    const Slack slack = slack_of(witness.plane, front, behind, t);
    if (still_good(slack)) return {false, slack};
    if (still_good(by_axis)) return {false, by_axis};
  }
  const DepthDecision d = decide_depth(a, c, t, witness.plane, kWorthABound * steps);
  if (!d.decided) ++counters.undecided;
  witness.plane = d.normal;
  witness.enclosure = d.deeper ? d.enclosure : std::nullopt;
  const Answer answer = d.deeper ? Answer{true, {d.lower - t, d.lower - t}}
                                 : Answer{false, slack_of(d.normal, front, behind, t)};
  witness.found_slack = answer.slack.least();
  return answer;
}

void OcclusionRelations::test(int index, const Term& travel, VisibilityCounters& counters) {
  Pair& pair = pairs_[index];
  const Body &a = bodies_[pair.first], &b = bodies_[pair.second];
  auto& [first, second] = witnesses_[index];
  bool exact = false;
  const auto renew = [&](const Body& front, const Body& behind, Witness& witness, bool& occluded) {
    if (witness.term.holds_at(travel)) return;
    const Answer answer = occludes(front, behind, witness, counters, exact);
    // The tolerance itself follows the bodies' sizes, by twice their steps at most.
    const double share = 0.999 / (1 + 2 * touch_);
    witness.term = {travel.bodies + std::max(0.0, answer.slack.bodies) * share,
                    travel.with_eye + std::max(0.0, answer.slack.with_eye) * share};
    occluded = answer.occludes;
  };
  renew(a, b, first, pair.first_occludes);
  renew(b, a, second, pair.second_occludes);
  counters.exact_tests += exact;
  pair.term = {std::min(first.term.bodies, second.term.bodies),
               std::min(first.term.with_eye, second.term.with_eye)};
}

void OcclusionRelations::update(VisibilityCounters& counters) {
  counters.bodies += static_cast<int>(bodies_.size() - free_bodies_.size());
  if (other_bodies_ || (!to_look_up_.empty() && tree_.refit(widened_) > kWorn)) tree_.build(widened_);
  other_bodies_ = false;
  for (const int body : to_look_up_) look_up(body, counters);
  for (const int body : to_look_up_) bodies_[body].placed_anew = bodies_[body].points.empty();
  to_look_up_.clear();
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) {
    const Pair& pair = pairs_[i];
    if (pair.first < 0) continue;
    const double of_bodies = travel_[pair.first] + travel_[pair.second];
    const Term travel{of_bodies, of_bodies + eye_travel_};
    if (!pair.term.holds_at(travel)) test(i, travel, counters);
    counters.edges += pair.first_occludes + pair.second_occludes;
  }
  counters.pairs += static_cast<int>(pairs_.size() - free_pairs_.size());
}

}  // namespace talisman::layers
