// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "layers/check.h"
#include "layers/layer.h"

namespace talisman::layers {

namespace {

/// A layer that has something to draw, with what the pair tests need.
struct Box {
  dvec3 lo, hi;
  double farthest = 0, nearest = 0;  ///< distance from the eye to the box's points
  int id = -1;
};

enum class Verdict { Unrelated, FirstBehind, SecondBehind };
Verdict opposite(Verdict v) {
  if (v == Verdict::Unrelated) return v;
  return v == Verdict::FirstBehind ? Verdict::SecondBehind : Verdict::FirstBehind;
}

Box make_box(const dvec3& eye, const WorldBounds& bounds, int id) {
  const auto far_axis = [&](int k) {
    return std::fmax(std::fabs(eye[k] - bounds.lo[k]), std::fabs(bounds.hi[k] - eye[k]));
  };
  const auto near_axis = [&](int k) {
    return std::fmax(0, std::fmax(bounds.lo[k] - eye[k], eye[k] - bounds.hi[k]));
  };
  return {bounds.lo, bounds.hi, std::hypot(far_axis(0), far_axis(1), far_axis(2)),
          std::hypot(near_axis(0), near_axis(1), near_axis(2)), id};
}

/// Farthest points first (as Newell, Newell & Sancha sort), so that what contains comes before what it
/// contains.
bool farther(const Box& a, const Box& b) {
  if (a.farthest != b.farthest) return a.farthest > b.farthest;
  if (a.nearest != b.nearest) return a.nearest > b.nearest;
  return a.id < b.id;
}

/// What the planes between two boxes say. Across a plane between `low` and `high`, the one on the eye's far
/// side cannot occlude the other; an eye between the two boxes sees neither before the other.
struct Planes {
  bool separated = false;
  bool first_can_occlude = true, second_can_occlude = true;
};

Planes separating_planes(const dvec3& eye, const Box& a, const Box& b) {
  Planes p;
  for (int k = 0; k < 3; ++k) {
    const bool a_low = a.hi[k] <= b.lo[k], b_low = b.hi[k] <= a.lo[k];
    if (a_low == b_low) continue;  // overlapping, or two flat boxes in one plane
    p.separated = true;
    const Box& low = a_low ? a : b;
    const Box& high = a_low ? b : a;
    if (eye[k] <= high.lo[k]) (a_low ? p.second_can_occlude : p.first_can_occlude) = false;
    if (eye[k] >= low.hi[k]) (a_low ? p.first_can_occlude : p.second_can_occlude) = false;
  }
  return p;
}

/// Boxes that overlap. Where a plane would cut less than half of the thinner one, they are taken as two
/// bodies that touch at the middle of the overlap; otherwise one more or less contains the other.
Verdict judge_overlapping(const dvec3& eye, const Box& a, const Box& b) {
  constexpr double kTouching = 0.5;
  double least = kTouching;
  int axis = -1;
  for (int k = 0; k < 3; ++k) {
    const double overlap = std::fmin(a.hi[k], b.hi[k]) - std::fmax(a.lo[k], b.lo[k]);
    const double share = overlap / std::fmin(a.hi[k] - a.lo[k], b.hi[k] - b.lo[k]);
    if (share < least) least = share, axis = k;
  }
  if (axis < 0) return farther(a, b) ? Verdict::FirstBehind : Verdict::SecondBehind;
  const double middle = (std::fmin(a.hi[axis], b.hi[axis]) + std::fmax(a.lo[axis], b.lo[axis])) / 2;
  const bool first_is_low = a.lo[axis] < b.lo[axis];
  return first_is_low == (eye[axis] > middle) ? Verdict::FirstBehind : Verdict::SecondBehind;
}

enum class Trust { Certain, Likely };  ///< separating planes only, or judgements about overlapping boxes too

Verdict judge(const dvec3& eye, const Box& a, const Box& b, Trust trust) {
  const Planes p = separating_planes(eye, a, b);
  if (!p.separated) {
    if (trust == Trust::Certain) return Verdict::Unrelated;
    return a.id < b.id ? judge_overlapping(eye, a, b) : opposite(judge_overlapping(eye, b, a));
  }
  if (p.first_can_occlude == p.second_can_occlude) return Verdict::Unrelated;
  return p.first_can_occlude ? Verdict::SecondBehind : Verdict::FirstBehind;
}

/// Strongly connected components of "lies behind", each before those in front of it (Tarjan; edges are judged
/// when they are walked and never stored, so memory stays linear). Time O(n²) judgements.
class Components {
 public:
  Components(const dvec3& eye, const std::vector<Box>& boxes, Trust trust)
      : eye_(eye), boxes_(boxes), trust_(trust), states_(boxes.size()) {
    // The components come out front to back, so the walk starts at what is near.
    for (std::size_t i = boxes.size(); i-- > 0;)
      if (states_[i].index < 0) walk_from(static_cast<int>(i));
    std::reverse(found_.begin(), found_.end());
  }
  const std::vector<std::vector<int>>& back_to_front() const { return found_; }

 private:
  struct State {
    int index = -1, low = -1;
    bool done = false;
    int next = 0;  ///< the next box to look at
  };

  void enter(int box) {
    states_[box].index = states_[box].low = count_++;
    open_.push_back(box);
    path_.push_back(box);
  }

  void walk_from(int root) {
    enter(root);
    while (!path_.empty()) {
      const int box = path_.back();
      const int next = next_in_front(box);
      if (next < 0) {
        leave(box);
      } else if (states_[next].index < 0) {
        enter(next);
      } else {
        states_[box].low = std::min(states_[box].low, states_[next].index);
      }
    }
  }

  /// The next box in front of `box` that is not finished; -1: no more.
  int next_in_front(int box) {
    for (int& next = states_[box].next; next < static_cast<int>(boxes_.size());) {
      const int other = next++;
      if (other == box || states_[other].done) continue;
      if (judge(eye_, boxes_[box], boxes_[other], trust_) == Verdict::FirstBehind) return other;
    }
    return -1;
  }

  void leave(int box) {
    path_.pop_back();
    if (!path_.empty()) states_[path_.back()].low = std::min(states_[path_.back()].low, states_[box].low);
    if (states_[box].low != states_[box].index) return;
    std::vector<int> component;
    do {
      component.push_back(open_.back());
      states_[open_.back()].done = true;
      open_.pop_back();
    } while (component.back() != box);
    found_.push_back(std::move(component));
  }

  const dvec3& eye_;
  const std::vector<Box>& boxes_;
  Trust trust_;
  std::vector<State> states_;
  std::vector<int> open_, path_;
  int count_ = 0;
  std::vector<std::vector<int>> found_;
};

/// Appends the ids of `boxes` from back to front. A cycle is sorted again by what is certain alone; a cycle
/// of certain occlusions has no order, and goes by distance.
void sort_boxes(const dvec3& eye, std::vector<Box> boxes, Trust trust, std::vector<int>& ids) {
  std::sort(boxes.begin(), boxes.end(), farther);
  const Components components(eye, boxes, trust);
  for (const std::vector<int>& component : components.back_to_front()) {
    std::vector<Box> members;
    for (const int i : component) members.push_back(boxes[i]);
    if (members.size() > 1 && trust == Trust::Likely) {
      sort_boxes(eye, std::move(members), Trust::Certain, ids);
    } else {
      std::sort(members.begin(), members.end(), farther);
      for (const Box& box : members) ids.push_back(box.id);
    }
  }
}

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

std::vector<int> back_to_front(const dvec3& eye, std::span<const Layer> layers,
                               std::span<const WorldBounds> bounds) {
  TALISMAN_CHECK_EQ(layers.size(), bounds.size());
  const dvec3 from = finite(eye) ? eye : dvec3{0, 0, 0};
  std::vector<int> ids;
  for (const OrderGroup group : {OrderGroup::Background, OrderGroup::Normal, OrderGroup::Foreground}) {
    std::vector<Box> boxes;
    const std::size_t first = ids.size();
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (layers[i].group != group) continue;
      if (bounds[i].empty())
        ids.push_back(layers[i].id);
      else
        boxes.push_back(make_box(from, bounds[i], layers[i].id));
    }
    std::sort(ids.begin() + static_cast<std::ptrdiff_t>(first), ids.end());
    sort_boxes(from, std::move(boxes), Trust::Likely, ids);
  }
  return ids;
}

}  // namespace talisman::layers
