// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/seen_order.h"

#include <algorithm>
#include <optional>

namespace talisman::sequences {

double pixels_in_front(const DepthSamples& depths, const std::vector<int>& front,
                       const std::vector<int>& behind) {
  double sum = 0;
  for (const int f : front)
    for (const int b : behind) sum += depths.in_front(f, b);
  return sum;
}

namespace {

/// Share of the frames in which two of their pieces meet; of those pieces for which it is largest.
double share_of_frames(const DepthSamples& depths, const std::vector<int>& front,
                       const std::vector<int>& behind) {
  double frames = 0, related = 1;
  for (const int f : front)
    for (const int b : behind) {
      frames = std::max<double>(frames, depths.frames_in_front(f, b));
      related = std::max<double>(related, depths.related_frames(f, b));
    }
  return frames / related;
}

double nearest_m(const DepthSamples& depths, const std::vector<int>& pieces) {
  double nearest = HUGE_VAL;
  for (const int piece : pieces) nearest = std::min(nearest, depths.nearest_m(piece));
  return nearest;
}

std::optional<SeenPair> order_of(const DepthSamples& depths, std::span<const std::vector<int>> layers,
                                 std::size_t a, std::size_t b) {
  const double a_first = pixels_in_front(depths, layers[a], layers[b]);
  const double b_first = pixels_in_front(depths, layers[b], layers[a]);
  const double all = a_first + b_first;
  if (all == 0) {
    const bool a_is_nearer = nearest_m(depths, layers[a]) <= nearest_m(depths, layers[b]);
    return SeenPair{a_is_nearer ? SpecPair{b, a} : SpecPair{a, b}, 0};
  }
  const bool a_is_front = a_first > b_first;
  const auto &front = layers[a_is_front ? a : b], &behind = layers[a_is_front ? b : a];
  const double hidden = std::min(a_first, b_first) / all;
  if (hidden > kHidden || share_of_frames(depths, behind, front) > kHiddenFrames) return std::nullopt;
  return SeenPair{a_is_front ? SpecPair{b, a} : SpecPair{a, b}, hidden};
}

/// Can `to` be reached from `from` by going to what is in front?
bool leads_to(const std::vector<std::vector<std::size_t>>& in_front, std::size_t from, std::size_t to) {
  std::vector<bool> reached(in_front.size());
  std::vector<std::size_t> open{from};
  reached[from] = true;
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (at == to) return true;
    for (const std::size_t next : in_front[at])
      if (!reached[next]) reached[next] = true, open.push_back(next);
  }
  return false;
}

}  // namespace

double hidden_share(const DepthSamples& depths, const std::vector<int>& a, const std::vector<int>& b) {
  const double a_first = pixels_in_front(depths, a, b), b_first = pixels_in_front(depths, b, a);
  return a_first + b_first > 0 ? std::min(a_first, b_first) / (a_first + b_first) : 0;
}

std::vector<SeenPair> seen_order(const DepthSamples& depths, std::span<const std::vector<int>> layers,
                                 std::span<const layers::OrderGroup> groups,
                                 std::span<const SpecPair> asked) {
  std::vector<SeenPair> found, kept;
  for (const auto& [a, b] : asked)
    if (groups[a] == groups[b])
      if (const auto pair = order_of(depths, layers, a, b)) found.push_back(*pair);
  // What was seen comes before what is guessed of layers that never met.
  std::stable_sort(found.begin(), found.end(), [&](const SeenPair& one, const SeenPair& other) {
    const auto met = [&](const SeenPair& p) {
      return pixels_in_front(depths, layers[p.pair.second], layers[p.pair.first]) > 0;
    };
    return met(one) > met(other);
  });
  std::vector<std::vector<std::size_t>> in_front(layers.size());
  for (const SeenPair& pair : found) {
    if (leads_to(in_front, pair.pair.second, pair.pair.first)) continue;
    in_front[pair.pair.first].push_back(pair.pair.second);
    kept.push_back(pair);
  }
  std::sort(kept.begin(), kept.end(),
            [](const SeenPair& one, const SeenPair& other) { return one.pair < other.pair; });
  return kept;
}

}  // namespace talisman::sequences
