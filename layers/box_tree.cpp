// SPDX-License-Identifier: Apache-2.0
#include "layers/box_tree.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>

#include "layers/check.h"

namespace talisman::layers {
namespace {

/// Twice the middle along an axis; what is everywhere or empty stands in the middle of nowhere, not at infinity.
double twice_middle(const Box3& box, int axis) {
  const double sum = double(box.lo[axis]) + box.hi[axis];
  return std::isfinite(sum) ? sum : 0;
}

/// What a query pays for a box. One that is everywhere is always paid for, and would hide what the others cost.
double cost_of(const Box3& box) { return box.hi[0] < kEverywhere.hi[0] ? half_area(box) : 0; }

int widest_axis(std::span<const Box3> boxes, std::span<const int> entries) {
  std::array<double, 3> least, most;
  least.fill(HUGE_VAL), most.fill(-HUGE_VAL);
  for (const int entry : entries)
    for (int k = 0; k < 3; ++k) {
      const double middle = twice_middle(boxes[entry], k);
      least[k] = std::min(least[k], middle), most[k] = std::max(most[k], middle);
    }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (most[k] - least[k] > most[axis] - least[axis]) axis = k;
  return axis;
}

/// Puts the lower half of the entries, by their middles along the widest axis, before the others.
void halve(std::span<const Box3> boxes, std::span<int> entries) {
  const int axis = widest_axis(boxes, entries);
  std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2),
                   entries.end(), [&](int a, int b) {
                     const double ma = twice_middle(boxes[a], axis), mb = twice_middle(boxes[b], axis);
                     return ma != mb ? ma < mb : a < b;  // a total order: every library builds the same tree
                   });
}

}  // namespace

void BoxTree::build(std::span<const Box3> boxes) {
  nodes_.clear();
  nodes_.reserve(boxes.size() / 2 + 1);
  entries_.resize(boxes.size());
  std::iota(entries_.begin(), entries_.end(), 0);
  place_.assign(boxes.size(), {});
  area_ = 0;
  empty_ = 0;
  reach_m_ = reach_of(boxes);
  if (!boxes.empty()) split(boxes, 0, static_cast<int>(boxes.size()), {});
  built_area_ = area_;
  ++times_built_;
}

void BoxTree::put_child(std::span<const Box3> boxes, int node, int lane, int first, int count) {
  nodes_[node].first[lane] = first;
  nodes_[node].count[lane] = count;
  if (count > 1) {
    const int child = split(boxes, first, count, {node, lane});
    nodes_[node].child[lane] = child;
    fit_above(child);
  } else {
    place_[entries_[first]] = {node, lane};
    empty_ += boxes[entries_[first]].empty();
    set_child_box(node, lane, boxes[entries_[first]]);
  }
}

int BoxTree::split(std::span<const Box3> boxes, int first, int count, Place above) {
  const int node = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  nodes_[node].parent = above.node, nodes_[node].lane = above.lane;
  if (count <= kWidth) {
    for (int lane = 0; lane < count; ++lane) put_child(boxes, node, lane, first + lane, 1);
    return node;
  }
  const std::span<int> entries = std::span(entries_).subspan(first, count);
  halve(boxes, entries);
  const int half = count / 2, rest = count - half, low = half / 2, high = rest / 2;
  halve(boxes, entries.subspan(0, half));
  halve(boxes, entries.subspan(half));
  put_child(boxes, node, 0, first, low);
  put_child(boxes, node, 1, first + low, half - low);
  put_child(boxes, node, 2, first + half, high);
  put_child(boxes, node, 3, first + half + high, rest - high);
  return node;
}

void BoxTree::set_child_box(int node, int lane, const Box3& box) {
  Node& n = nodes_[node];
  const unsigned bit = 1u << lane;
  if (n.lanes & bit) area_ -= cost_of(n.boxes.at(lane));
  n.boxes.put(lane, box);
  n.lanes = static_cast<std::uint8_t>(box.empty() ? n.lanes & ~bit : n.lanes | bit);
  if (!box.empty()) area_ += cost_of(box);
}

/// The box of a node, in the node above it; and so on, as long as something changes.
void BoxTree::fit_above(int node) {
  while (nodes_[node].parent >= 0) {
    Box3 box;
    for (unsigned lanes = nodes_[node].lanes; lanes != 0; lanes &= lanes - 1)
      box = joined(box, nodes_[node].boxes.at(std::countr_zero(lanes)));
    const int parent = nodes_[node].parent, lane = nodes_[node].lane;
    const bool is_there = nodes_[parent].lanes >> lane & 1u;
    if (is_there ? nodes_[parent].boxes.at(lane) == box : box.empty()) return;
    set_child_box(parent, lane, box);
    node = parent;
  }
}

void BoxTree::note_reach(const Box3& box) { reach_m_ = std::max(reach_m_, reach_of({&box, 1})); }

void BoxTree::update(std::span<const Box3> boxes, std::span<const int> moved) {
  TALISMAN_CHECK_EQ(boxes.size(), place_.size());
  for (const int entry : moved) {
    const Place place = place_[entry];
    note_reach(boxes[entry]);
    const bool was_there = nodes_[place.node].lanes >> place.lane & 1u;
    empty_ += static_cast<int>(boxes[entry].empty()) - static_cast<int>(!was_there);
    set_child_box(place.node, place.lane, boxes[entry]);
    fit_above(place.node);
  }
  if (!(worsening() <= kWorse)) build(boxes);
}

double BoxTree::worsening() const { return built_area_ > 0 ? area_ / built_area_ : 1; }

/// The children that are not outside, and of each the planes that cut it.
unsigned BoxTree::cut_lanes(Node& node, const RegionTest& test, PlaneMask mask,
                            std::array<PlaneMask, kWidth>& left, QueryCounters& counters) const {
  unsigned alive = node.lanes;
  left.fill(mask);
  const auto try_plane = [&](int plane) {
    ++counters.tests;
    const unsigned out = test.outside(plane, node.boxes) & alive;
    if (out != 0) node.last_plane = static_cast<std::uint8_t>(plane);
    alive &= ~out;
    for (unsigned in = alive & test.inside(plane, node.boxes); in != 0; in &= in - 1)
      left[std::countr_zero(in)] &= ~(PlaneMask{1} << plane);
  };
  PlaneMask to_test = mask;
  if (const PlaneMask last = PlaneMask{1} << node.last_plane; coherent_ && (to_test & last)) {
    try_plane(node.last_plane);
    to_test &= ~last;
  }
  for (; to_test != 0 && alive != 0; to_test &= to_test - 1) try_plane(std::countr_zero(to_test));
  return alive;
}

void BoxTree::take_whole(int first, int count, std::vector<int>& found) const {
  const auto begin = entries_.begin() + first, end = begin + count;
  const auto is_there = [&](int entry) {
    return nodes_[place_[entry].node].lanes >> place_[entry].lane & 1u;
  };
  if (empty_ == 0)
    found.insert(found.end(), begin, end);
  else
    std::copy_if(begin, end, std::back_inserter(found), is_there);
}

void BoxTree::query(std::span<const Plane> region, std::vector<int>& found, QueryCounters& counters) {
  if (nodes_.empty()) return;
  const RegionTest test(region, reach_m_);
  struct Visit {
    std::int32_t node;
    PlaneMask mask;
  };
  InlineVector<Visit, 128> stack{{0, test.all()}};
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    Node& node = nodes_[visit.node];
    std::array<PlaneMask, kWidth> left;
    ++counters.nodes;
    counters.spared += test.planes() - std::popcount(visit.mask);
    for (unsigned alive = cut_lanes(node, test, visit.mask, left, counters); alive != 0; alive &= alive - 1) {
      const int lane = std::countr_zero(alive);
      if (node.child[lane] < 0) {
        found.push_back(entries_[node.first[lane]]);
      } else if (left[lane] != 0) {
        stack.push_back({node.child[lane], left[lane]});
      } else {
        take_whole(node.first[lane], node.count[lane], found);
        counters.whole += node.count[lane];
      }
    }
  }
}

}  // namespace talisman::layers
