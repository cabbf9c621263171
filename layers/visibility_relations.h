// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which bodies can occlude which, kept from frame to frame. The relation is defined in layers/visibility.h.
///
/// Three things make a frame of small motion cheap:
/// - *Extents with a margin.* The tree (layers/extent_tree.h) holds every body's angular extents, widened by
///   what the body is expected to move in the next frames. While the extents stay within, the pairs that the
///   body takes part in are those it had; only when they leave, it is looked up again. How far body and eye
///   may move before they can leave is known too, so mostly they are not even computed.
/// - *Answers with a term.* An exact test says by how much its bodies (and the eye) may move before the answer
///   can change: the gap to the plane that parts them, or the radius of the ball by which they overlap
///   (layers/convex.h). Each body sums up the largest step of its points; while the sums of a pair stay below the
///   sums at the test plus that term, the answer holds. The eye has a gap of its own: tiles that share an edge have
///   next to none between them, and as long as they rest need none, however the eye moves on its side of the plane.
/// - *Witnesses.* When the term is over, the extents along the axes are tried, then what showed the answer
///   last time: the plane that parted the bodies, or the four corners that enclosed the origin. Only where
///   that fails the search is run, from that plane.
/// None of them changes an answer: they only save asking.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "layers/convex.h"
#include "layers/extent_tree.h"
#include "layers/visibility.h"

namespace talisman::layers {

/// Sums of travels: those up to which an answer holds, or those so far.
struct Term {
  double bodies = -1;    ///< of the two bodies
  double with_eye = -1;  ///< of the two bodies and the eye
  bool holds_at(const Term& travel) const { return travel.bodies <= bodies && travel.with_eye <= with_eye; }
};

class OcclusionRelations {
 public:
  /// Two bodies of different layers of one group whose widened extents overlap.
  struct Pair {
    int first = -1, second = -1;  ///< -1: no pair
    bool first_occludes = false, second_occludes = false;
    Term term;  ///< up to which both answers hold
  };

  explicit OcclusionRelations(double touch) : touch_(touch) {}

  /// Body numbers are reused after removal.
  int add_body(int layer, OrderGroup group);
  void remove_body(int body);

  /// A frame: first the eye, then each body, then the relations between them.
  void place_eye(const dvec3& eye);
  /// Points that are not finite (or beyond ±1e60) make the body empty for this frame.
  void place_body(int body, std::span<const dvec3> points);
  /// Brings all pairs up to date, and counts into `counters`.
  void update(VisibilityCounters& counters);

  const std::vector<Pair>& pairs() const { return pairs_; }
  int layer_of(int body) const { return layer_of_[body]; }
  /// Of the box around the body; empty if it is.
  const WorldBounds& bounds(int body) const { return bodies_[body].bounds; }

 private:
  struct Body {
    OrderGroup group = OrderGroup::Normal;
    bool placed_anew = true;    ///< its points do not continue those of the last frame
    std::vector<dvec3> points;  ///< none: empty
    WorldBounds bounds;
    double size = 0, step = 0;  ///< largest extent; largest step of a point since the last frame
    double reach = 0;           ///< largest coordinate
    WorldBounds bounds_before;  ///< of the last frame; empty: there was none, or the body was empty
    double extents_term = -1;   ///< sum of the travels up to which the extents stay within the widened ones
    std::vector<int> pairs;
  };
  /// How far the two bodies may move together before an answer may change because of them, and how far they and the
  /// eye may before it may because of the eye.
  struct Slack {
    double bodies = 0, with_eye = 0;
    double least() const { return std::min(bodies, with_eye); }
  };
  /// What is known of "one of the pair can occlude the other".
  struct Answer {
    bool occludes = false;
    Slack slack;
  };
  /// Of one direction of a pair: the plane that parted the one from the other and the eye.
  struct Witness {
    dvec3 plane{0, 0, 0};
    std::optional<Enclosure> enclosure;  ///< or the corners that show that they are not
    double found_slack = 0;              ///< when it was searched for
    Term term;                           ///< up to which the answer holds
  };
  struct Witnesses {
    Witness first, second;  ///< of the first body, or the second, as the one in front
  };

  void follow_extents(int body);
  void widen(int body, const DirectionBox& before, const DirectionBox& now);
  void look_up(int body, VisibilityCounters& counters);
  void add_pair(int first, int second);
  void drop_pair(int pair);
  void test(int pair, const Term& travel, VisibilityCounters& counters);
  Slack slack_of(const dvec3& plane, const Body& front, const Body& behind, double tolerance) const;
  Answer occludes(const Body& front, const Body& behind, Witness& witness, VisibilityCounters& counters,
                  bool& exact) const;

  double touch_;
  dvec3 eye_{0, 0, 0}, eye_before_{0, 0, 0};
  bool seen_before_ = false;
  double eye_travel_ = 0, eye_step_ = 0;
  std::vector<Body> bodies_;
  std::vector<int> layer_of_;          ///< per body; -1: a free number
  std::vector<double> travel_;         ///< per body: sum of its steps
  std::vector<DirectionBox> widened_;  ///< per body
  std::vector<int> free_bodies_, free_pairs_;
  std::vector<Pair> pairs_;
  std::vector<Witnesses> witnesses_;
  ExtentTree tree_;
  bool other_bodies_ = false;      ///< since the tree was built
  std::vector<int> to_look_up_;    ///< bodies that have left their widened extents in this frame
  std::vector<int> found_, mark_;  ///< of one query; per body: the query that has met it
  int mark_count_ = 0;
};

}  // namespace talisman::layers
