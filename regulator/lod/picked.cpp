// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/picked.h"

#include <algorithm>

namespace talisman::regulator {
namespace {

constexpr int kMostExchanges = 32;

struct Move {
  double slope = -1;  ///< benefit per time
  int layer = -1, to = -1;
  bool found() const { return to >= 0; }
  /// Later on the heap.
  bool operator<(const Move& other) const {
    return slope != other.slope ? slope < other.slope : layer > other.layer;
  }
};

/// The best raise of a layer that costs at most `left` more.
Move best_raise(const WholeProblem& problem, int layer, int at, std::int64_t left) {
  Move best{-1, layer, -1};
  const auto now = static_cast<std::size_t>(at);
  const auto first = static_cast<std::size_t>(problem.first[static_cast<std::size_t>(layer)]);
  const auto last = static_cast<std::size_t>(problem.first[static_cast<std::size_t>(layer) + 1]);
  for (std::size_t k = first; k < last; ++k) {
    const std::int64_t more = problem.costs[k] - problem.costs[now];
    if (more > left || problem.costs[k] >= kNeverTaken || !(problem.benefits[k] > problem.benefits[now]))
      continue;
    const double slope =
        (problem.benefits[k] - problem.benefits[now]) / static_cast<double>(std::max<std::int64_t>(more, 1));
    if (slope > best.slope) best = {slope, layer, static_cast<int>(k)};
  }
  return best;
}

void apply(const WholeProblem& problem, const Move& move, Picked& picked) {
  int& at = picked.at[static_cast<std::size_t>(move.layer)];
  const auto from = static_cast<std::size_t>(at), to = static_cast<std::size_t>(move.to);
  picked.cost += problem.costs[to] - problem.costs[from];
  picked.benefit += problem.benefits[to] - problem.benefits[from];
  at = move.to;
}

/// The lowering that loses least per time saved, of all layers but one.
Move best_lowering(const WholeProblem& problem, const Picked& picked, int held) {
  Move best;
  for (int layer = 0; layer < problem.layers(); ++layer) {
    if (layer == held) continue;
    const auto now = static_cast<std::size_t>(picked.at[static_cast<std::size_t>(layer)]);
    for (int k = problem.first[static_cast<std::size_t>(layer)];
         k < problem.first[static_cast<std::size_t>(layer) + 1]; ++k) {
      const auto to = static_cast<std::size_t>(k);
      const std::int64_t saved = problem.costs[now] - problem.costs[to];
      if (saved <= 0) continue;
      const double lost = (problem.benefits[now] - problem.benefits[to]) / static_cast<double>(saved);
      if (!best.found() || lost < best.slope) best = {lost, layer, k};
    }
  }
  return best;
}

/// With one layer put to a choice; not found: costs more than the budget even so.
Picked forced(const WholeProblem& problem, Picked picked, int layer, int to) {
  apply(problem, {0, layer, to}, picked);
  while (picked.cost > problem.budget) {
    const Move lower = best_lowering(problem, picked, layer);
    if (!lower.found()) return picked;
    apply(problem, lower, picked);
  }
  return filled(problem, std::move(picked), layer);
}

}  // namespace

Picked priced(const WholeProblem& problem, std::vector<int> at) {
  Picked picked{std::move(at), 0, 0};
  for (const int k : picked.at) {
    picked.cost += problem.costs[static_cast<std::size_t>(k)];
    picked.benefit += problem.benefits[static_cast<std::size_t>(k)];
  }
  return picked;
}

Picked filled(const WholeProblem& problem, Picked picked, int held) {
  std::vector<Move> heap;
  const auto offer = [&](int layer) {
    if (layer == held) return;
    const Move move =
        best_raise(problem, layer, picked.at[static_cast<std::size_t>(layer)], problem.budget - picked.cost);
    if (move.found()) heap.push_back(move);
  };
  for (int layer = 0; layer < problem.layers(); ++layer) offer(layer);
  std::make_heap(heap.begin(), heap.end());
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end());
    const Move move = heap.back();
    heap.pop_back();
    const auto now = static_cast<std::size_t>(picked.at[static_cast<std::size_t>(move.layer)]);
    if (picked.cost + problem.costs[static_cast<std::size_t>(move.to)] - problem.costs[now] <= problem.budget)
      apply(problem, move, picked);
    const std::size_t before = heap.size();
    offer(move.layer);
    if (heap.size() > before) std::push_heap(heap.begin(), heap.end());
  }
  return picked;
}

Picked exchanged(const WholeProblem& problem, Picked picked, double upper_bound) {
  for (int round = 0; round < kMostExchanges && picked.benefit < upper_bound; ++round) {
    Picked best = picked;
    for (int layer = 0; layer < problem.layers(); ++layer)
      for (int k = problem.first[static_cast<std::size_t>(layer)];
           k < problem.first[static_cast<std::size_t>(layer) + 1]; ++k) {
        if (k == picked.at[static_cast<std::size_t>(layer)] ||
            problem.costs[static_cast<std::size_t>(k)] >= kNeverTaken)
          continue;
        Picked trial = forced(problem, picked, layer, k);
        if (trial.cost <= problem.budget && trial.benefit > best.benefit) best = std::move(trial);
      }
    if (!(best.benefit > picked.benefit)) return picked;
    picked = std::move(best);
  }
  return picked;
}

}  // namespace talisman::regulator
