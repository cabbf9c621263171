// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which order must layers be composited, while they move? The visibility sort [LS97 2.2], after Snyder &
/// Lengyel, "Visibility Sorting and Compositing without Splitting for Image Layer Decompositions" (1998).
///
/// Every layer is bounded by convex bodies. Body A *can occlude* body B from the eye e if some point of A
/// lies on a segment from e to a point of B before it. For convex bodies that do not meet this is
///
///   A ∩ conv({e} ∪ B) ≠ ∅,
///
/// and it holds in one direction at most: a plane between A and B has the eye on one side, and what is on the
/// eye's side cannot be occluded across it. With the depth of two convex sets, the least way by which one
/// must be shifted to leave the other,
///
///   depth(A, C) = min over unit n of ( max a·n - min c·n )        negative: their distance,
///
/// and a tolerance t = `touch` · (size of the smaller body) the definition used here is
///
///   A can occlude B   ⇔   depth(A, conv({e} ∪ B)) > t.
///
/// What follows from it:
/// - bodies that overlap by no more than t are taken as touching: at most one occludes the other, and flat
///   bodies in one plane are unrelated;
/// - bodies that overlap by more occlude each other: a binary cycle;
/// - all directions of view count alike, so that what is behind the camera, or around it, needs no care: it
///   is ordered like the rest and cannot disturb what is in view;
/// - a body that contains the eye is in front of every body that it does not meet; with one that it meets it
///   forms a binary cycle (its bound does not tell which of the two is nearer). A room or a sky therefore
///   wants OrderGroup::Background, an explicit pair, or one body per wall.
/// - bodies without points, or with a point that is not finite, are related to nothing.
/// A layer can occlude another if one of its bodies can occlude one of the other's.
///
/// The order. Groups come first (background, normal, foreground), then the author's explicit pairs, each of
/// which replaces what geometry says about these two layers, then geometry. Strongly connected components of
/// this relation have no order; their layers are *merged*, that is rendered into one sprite, where a z-buffer
/// decides [LS97 2.2, footnote 4]. What the relation leaves open keeps the order of the last frame, which is
/// the hysteresis against an order that flickers between equals; layers that are new come by the distance of
/// their centre (far first), then by id. A component that was merged stays merged for another
/// `release_frames` frames after its cycle has gone; layers that lie between its members are merged with it
/// meanwhile.
///
/// How it is kept from frame to frame: layers/visibility.cpp.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "layers/layer.h"

namespace talisman::layers {

/// What the sort has to know of one layer at one time. The points are only read during the call.
struct Occluder {
  int layer = -1;  ///< ≥ 0, once per call; memory grows with the largest, so let it be an index
  OrderGroup group = OrderGroup::Normal;
  std::vector<std::span<const dvec3>> bodies;  ///< each the convex hull of its points, world space, metres
};

/// The author's order of two layers. It replaces what geometry says about the two (so two parts that
/// interpenetrate need not be merged), and nothing else.
struct ExplicitPair {
  int behind = -1, front = -1;
  bool operator==(const ExplicitPair&) const = default;
};

struct VisibilityOptions {
  /// Bodies that overlap by no more than this share of the smaller one's size (its largest extent along an
  /// axis) are taken as touching. Range [0, 0.5], default 0.001. Raising it merges fewer layers, and lets as
  /// much of one show through the other; it costs no time.
  double touch = 1e-3;
  /// Frames for which layers stay merged after the last frame with a cycle. Range ≥ 0, default 4; 0 splits at
  /// once. Raising it avoids flicker between merged and split (each change renders the layers anew)
  /// and costs the rendering of merged layers for longer.
  int release_frames = 4;
};

/// Layers that have to be drawn into one sprite, and why.
struct MergedComponent {
  enum class Reason { Interpenetration, Cycle, Held };
  std::vector<int> layers;  ///< ascending
  /// Interpenetration: some two of them occlude each other (their bodies meet, or a body of each lies before
  /// one of the other's); Cycle: no two do, but three or more go round; Held: no cycle now, but one was there
  /// at most `release_frames` frames ago.
  Reason reason = Reason::Cycle;
  std::vector<int> cycle;  ///< a short one, each behind the next and the last behind the first; Held: empty
  int absent_frames = 0;   ///< frames since the last cycle among them; 0: there is one now
  std::vector<ExplicitPair> relations;  ///< all pairs of them that are related, by geometry or the author
};

/// What one call did. All are counts.
struct VisibilityCounters {
  int layers = 0, bodies = 0;
  int queries = 0;      ///< bodies whose possible occluders were looked up in the tree
  int pairs = 0;        ///< pairs of bodies that extents cannot tell apart in view
  int exact_tests = 0;  ///< of these, tested on the hulls; the others' last answer still holds
  int undecided = 0;    ///< exact tests that rounding left open; they count as occlusion
  int edges = 0;        ///< pairs of bodies, in either direction, of which one can occlude the other
  int sorted = 0;       ///< layers in the stretches of last frame's order that no longer hold
  int swaps = 0;        ///< layers that the sort moved within last frame's line (with the new layers put in)
  int components = 0;   ///< single layers and merged components together
  int merged_components = 0, merged_layers = 0;
  int overruled_pairs = 0;  ///< explicit pairs within a merged component, where the z-buffer decides
};

struct VisibilityOrder {
  /// Empty, or the first explicit pair that cannot be kept: it closes a cycle of such pairs, contradicts the
  /// groups, or names one layer twice. It is left out, and the order is valid all the same. A pair that names
  /// a layer that is not there is no defect.
  std::string defect;
  std::vector<std::vector<int>> groups_back_to_front;  ///< one layer, or a merged component (ascending)
  std::vector<int> order;                              ///< the same, flattened
  std::vector<MergedComponent> merged;                 ///< in the order of groups_back_to_front
  VisibilityCounters counters;
};

/// Sorts frame after frame. A value: a copy goes on independently from the same frame, so that a plan can
/// look ahead. Equal sequences of calls give equal results. Layers may come and go between calls, and change
/// their group or their bodies.
///
/// Cost per call, n bodies of p points, m pairs that overlap in view: O(n p + m) cheap steps for what moves
/// little, and O(p · iterations) for each pair whose last answer may no longer hold; memory O(n p + m).
class VisibilitySorter {
 public:
  explicit VisibilitySorter(const VisibilityOptions& options = {});  ///< keeps nothing before the first sort
  VisibilitySorter(const VisibilitySorter& other);
  VisibilitySorter(VisibilitySorter&& other) noexcept;
  VisibilitySorter& operator=(VisibilitySorter other) noexcept;
  ~VisibilitySorter();

  /// A non-finite eye counts as the origin.
  VisibilityOrder sort(const dvec3& eye, std::span<const Occluder> occluders,
                       std::span<const ExplicitPair> pairs = {});

 private:
  struct State;
  VisibilityOptions options_;
  std::unique_ptr<State> state_;  ///< null before the first sort
};

}  // namespace talisman::layers
