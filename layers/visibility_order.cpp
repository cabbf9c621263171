// SPDX-License-Identifier: Apache-2.0
#include "layers/visibility_order.h"

#include <algorithm>
#include <numeric>

namespace talisman::layers {

namespace {

/// The edges that leave each thing, one after the other.
struct Successors {
  std::vector<int> begin, to;

  template <typename Keep>
  Successors(int count, std::span<const OrderEdge> edges, Keep keep) : begin(count + 2, 0) {
    for (const OrderEdge& e : edges)
      if (keep(e)) ++begin[e.behind + 2];
    for (int i = 0; i < count; ++i) begin[i + 2] += begin[i + 1];
    to.resize(begin[count + 1]);
    for (const OrderEdge& e : edges)
      if (keep(e)) to[begin[e.behind + 1]++] = e.front;
  }
  std::span<const int> of(int i) const {
    return std::span<const int>(to).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

/// For each place the number of its stretch, or -1.
struct Stretches {
  std::vector<int> of;
  int places = 0;

  Stretches(int count, std::span<const OrderEdge> edges) : of(count, -1) {
    std::vector<int> change(count + 1, 0);  // in the number of backward edges across the gap after a place
    for (const OrderEdge& e : edges)
      if (e.behind > e.front) ++change[e.front], --change[e.behind];
    int across = 0, stretch = 0;
    for (int i = 0; i < count; ++i) {
      const bool before = across > 0;
      across += change[i];
      if (!before && across > 0) ++stretch;
      if (before || across > 0) of[i] = stretch, ++places;
    }
  }
};

/// Tarjan's walk over the spoiled stretches, from the front of the line to the back, so that components come
/// out in the reverse of the order wanted and fill the line from its front.
class Walk {
 public:
  Walk(int count, std::span<const OrderEdge> edges, const Stretches& stretches)
      : successors_(count, edges,
                    [&](const OrderEdge& e) {
                      return stretches.of[e.behind] >= 0 && stretches.of[e.behind] == stretches.of[e.front];
                    }),
        states_(count) {
    result_.places.resize(count);
    result_.sorted = stretches.places;
    next_ = count;
    for (int i = count; i-- > 0;) {
      if (stretches.of[i] < 0)
        result_.places[--next_] = i;
      else if (states_[i].index < 0)
        walk_from(i);
    }
    std::reverse(result_.cyclic.begin(), result_.cyclic.end());
  }
  SortedLine take() { return std::move(result_); }

 private:
  struct State {
    int index = -1, low = -1, edge = 0;
    bool done = false;
  };

  void enter(int i) {
    states_[i].index = states_[i].low = count_++;
    open_.push_back(i);
    path_.push_back(i);
  }

  void walk_from(int root) {
    enter(root);
    while (!path_.empty()) {
      const int i = path_.back();
      const auto successors = successors_.of(i);
      if (states_[i].edge == static_cast<int>(successors.size())) {
        leave(i);
        continue;
      }
      const int next = successors[states_[i].edge++];
      if (states_[next].index < 0)
        enter(next);
      else if (!states_[next].done)
        states_[i].low = std::min(states_[i].low, states_[next].index);
    }
  }

  void leave(int i) {
    path_.pop_back();
    if (!path_.empty()) states_[path_.back()].low = std::min(states_[path_.back()].low, states_[i].low);
    if (states_[i].low != states_[i].index) return;
    const int end = next_;
    int member = -1;
    do {
      member = open_.back();
      open_.pop_back();
      states_[member].done = true;
      result_.places[--next_] = member;
    } while (member != i);
    if (end - next_ == 1) return;
    std::sort(result_.places.begin() + next_, result_.places.begin() + end);
    result_.cyclic.push_back({next_, end - next_});
  }

  Successors successors_;
  std::vector<State> states_;
  std::vector<int> open_, path_;
  int count_ = 0, next_ = 0;
  SortedLine result_;
};

/// A shortest cycle through `start` that is shorter than `limit` things; empty: none.
std::vector<int> cycle_through(int start, const Successors& successors, std::vector<int>& from, int limit) {
  std::fill(from.begin(), from.end(), -1);
  std::vector<int> front{start}, next;
  for (int length = 1; !front.empty() && length < limit; ++length) {
    next.clear();
    for (const int i : front)
      for (const int to : successors.of(i)) {
        if (from[to] >= 0) continue;
        from[to] = i;
        next.push_back(to);
      }
    std::swap(front, next);
    if (from[start] < 0) continue;
    std::vector<int> cycle;
    for (int i = from[start]; i != start; i = from[i]) cycle.push_back(i);
    cycle.push_back(start);
    std::reverse(cycle.begin(), cycle.end());
    return cycle;
  }
  return {};
}

}  // namespace

SortedLine sort_line(int count, std::span<const OrderEdge> edges) {
  return Walk(count, edges, Stretches(count, edges)).take();
}

std::vector<int> short_cycle(int count, std::span<const OrderEdge> edges, int starts) {
  const Successors successors(count, edges, [](const OrderEdge&) { return true; });
  std::vector<int> from(count), best;
  const SortedLine line = sort_line(count, edges);
  std::vector<int> on_cycle;
  for (const LineRange& range : line.cyclic)
    on_cycle.insert(on_cycle.end(), line.places.begin() + range.first,
                    line.places.begin() + range.first + range.count);
  std::sort(on_cycle.begin(), on_cycle.end());
  for (int k = 0; k < std::min(starts, static_cast<int>(on_cycle.size())); ++k) {
    const int limit = best.empty() ? count + 1 : static_cast<int>(best.size());
    std::vector<int> cycle = cycle_through(on_cycle[k], successors, from, limit);
    if (!cycle.empty()) best = std::move(cycle);
    if (best.size() == 2) break;
  }
  return best;
}

bool leads_to(std::span<const ExplicitPair> pairs, int from, int to) {
  std::vector<int> reached{from};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i] == to) return true;
    for (const ExplicitPair& p : pairs)
      if (p.behind == reached[i] && std::find(reached.begin(), reached.end(), p.front) == reached.end())
        reached.push_back(p.front);
  }
  return false;
}

namespace {

/// Gives up, one after the other, the layers at which no pair ends (`to`) that begins (`from`) at one that is left.
void peel(std::span<const ExplicitPair> pairs, int ExplicitPair::*from, int ExplicitPair::*to,
          std::vector<char>& left) {
  const std::size_t ids = left.size();
  std::vector<std::size_t> first(ids + 1, 0), waits_for(ids, 0);  // leaving id: first[id] … first[id + 1]
  const auto counts = [&left](const ExplicitPair& p) { return left[p.behind] && left[p.front]; };
  for (const ExplicitPair& p : pairs) {
    if (!counts(p)) continue;
    ++first[p.*from + 1];
    ++waits_for[p.*to];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> ends(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const ExplicitPair& p : pairs)
    if (counts(p)) ends[next[p.*from]++] = p.*to;
  std::vector<int> given_up;
  for (std::size_t id = 0; id < ids; ++id)
    if (left[id] && waits_for[id] == 0) given_up.push_back(static_cast<int>(id));
  for (std::size_t i = 0; i < given_up.size(); ++i) {
    const int id = given_up[i];
    left[id] = 0;
    for (std::size_t k = first[id]; k < first[id + 1]; ++k)
      if (--waits_for[ends[k]] == 0) given_up.push_back(ends[k]);
  }
}

}  // namespace

std::vector<char> cyclic_core(std::span<const ExplicitPair> pairs) {
  std::size_t ids = 0;
  for (const ExplicitPair& p : pairs)
    ids = std::max({ids, static_cast<std::size_t>(p.behind) + 1, static_cast<std::size_t>(p.front) + 1});
  std::vector<char> left(ids, 1);
  peel(pairs, &ExplicitPair::behind, &ExplicitPair::front, left);
  peel(pairs, &ExplicitPair::front, &ExplicitPair::behind, left);
  if (std::find(left.begin(), left.end(), 1) == left.end()) left.clear();
  return left;
}

}  // namespace talisman::layers
