// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which bodies can occlude which, kept from frame to frame. The relation is defined in layers/visibility.h.
///
/// Three things make a frame of small motion cheap:
/// - *Extents with a margin.* The tree (layers/extent_tree.h) holds every body's angular extents, widened by
///   what the body is expected to move in the next frames. While the extents stay within, the pairs that the
///   body takes part in are those it had; only when they leave, it is looked up again.
/// - *Answers with a term.* An exact test says by how much its bodies (and the eye) may move before the answer
///   can change: the gap to the plane that parts them, or the radius of the ball by which they overlap
///   (layers/convex.h). Each body sums up the largest step of its points; while the three sums of a pair stay
///   below the sum at the test plus that term, the answer holds.
/// - *Witnesses.* When the term is over, the extents along the axes are tried, then last time's plane, and only
///   then the search is run, from that plane.
/// None of them changes an answer: they only save asking.

#include <cstdint>
#include <span>
#include <vector>

#include "layers/extent_tree.h"
#include "layers/visibility.h"

namespace talisman::layers {

class OcclusionRelations {
 public:
  /// Two bodies of different layers of one group whose widened extents overlap.
  struct Pair {
    int first = -1, second = -1;  ///< -1: no pair
    bool first_occludes = false, second_occludes = false;
    double term = -1;  ///< sum of the travels up to which the answer holds
  };

  explicit OcclusionRelations(double touch) : touch_(touch) {}

  /// Body numbers are reused after removal.
  int add_body(int layer, OrderGroup group);
  void remove_body(int body);
  /// Where the body is now. Points that are not finite (or beyond ±1e60) make it empty for this frame.
  void place_body(int body, std::span<const dvec3> points);

  /// Brings all pairs up to date, and counts into `counters`.
  void update(const dvec3& eye, VisibilityCounters& counters);

  const std::vector<Pair>& pairs() const { return pairs_; }
  int layer_of(int body) const { return bodies_[body].layer; }
  /// Of the box around the body; empty if it is.
  const WorldBounds& bounds(int body) const { return bodies_[body].bounds; }

 private:
  struct Body {
    int layer = -1;  ///< -1: a free number
    OrderGroup group = OrderGroup::Normal;
    std::vector<dvec3> points;  ///< none: empty
    WorldBounds bounds;
    double size = 0, step = 0;  ///< largest extent; largest step of a point since the last frame
    bool placed_anew = true;    ///< its points do not continue those of the last frame
    DirectionBox extents;
    std::vector<int> pairs;
  };
  /// Planes that parted the first body from the second and the eye, and the other way round.
  struct Witness {
    dvec3 first{0, 0, 0}, second{0, 0, 0};
  };
  struct Answer {
    bool occludes = false;
    double slack = 0;
  };

  bool same_extents(int body);
  void look_up(int body, VisibilityCounters& counters);
  void add_pair(int first, int second);
  void drop_pair(int pair);
  void test(int pair, VisibilityCounters& counters);
  Answer occludes(const Body& front, const Body& behind, dvec3& plane, VisibilityCounters& counters,
                  bool& exact) const;
  double tolerance(const Body& a, const Body& b) const;

  double touch_;
  dvec3 eye_{0, 0, 0};
  bool seen_before_ = false;
  double eye_travel_ = 0, eye_step_ = 0;
  std::vector<Body> bodies_;
  std::vector<double> travel_;          ///< per body: sum of its steps
  std::vector<DirectionBox> widened_;   ///< per body
  std::vector<int> free_bodies_, free_pairs_;
  std::vector<Pair> pairs_;
  std::vector<Witness> witnesses_;
  ExtentTree tree_;
  bool other_bodies_ = false;  ///< since the tree was built
  std::vector<int> looked_up_, found_, mark_;
  int mark_count_ = 0;
};

}  // namespace talisman::layers
