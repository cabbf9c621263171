// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How is a line of things brought into order again, when a few of the relations between them have changed?
///
/// Things are numbered by their place in the line, back to front. An edge says that one must come before
/// another. Edges that point forward hold already. An edge that points back, from place u to an earlier place
/// v, spoils the stretch v … u and nothing else: stretches that share a place are joined, and
/// - within each, the strongly connected components are put into topological order (Tarjan 1972);
/// - whatever lies outside stays where it is.
/// This is sound, because every edge between a stretch and the rest points forward wherever the members of
/// the stretch stand within it, and complete, because a cycle crosses every gap between its first and its
/// last place backwards at least once, so that all of it lies in one stretch.
///
/// Ties: things that the edges leave open keep their order where possible. The walk starts from the front of
/// a stretch and moves a thing only to just in front of one that must come before it.

#include <span>
#include <string>
#include <vector>

#include "layers/visibility.h"

namespace talisman::layers {

struct OrderEdge {
  int behind = -1, front = -1;
};

/// A run of the new line.
struct LineRange {
  int first = 0, count = 0;
};

struct SortedLine {
  std::vector<int> places;        ///< for each new place, from back to front, the old one
  std::vector<LineRange> cyclic;  ///< the components of more than one, by their new places
  int sorted = 0;                 ///< places within spoiled stretches
};

/// Cost: O(count + edges).
SortedLine sort_line(int count, std::span<const OrderEdge> edges);

/// The shortest cycle through one of the first `starts` things that lie on one; empty: no cycle. Cost:
/// O(starts · edges).
std::vector<int> short_cycle(int count, std::span<const OrderEdge> edges, int starts);

/// The explicit pairs that can be kept together, in their order, and the first that cannot.
struct KeptPairs {
  std::vector<ExplicitPair> pairs;
  std::string defect;
};

/// `group_of(layer)` is the layer's OrderGroup as int, or kAbsent. Cost: O(pairs + largest id), and O(c²) for the c pairs
/// between layers of cyclic_core.
inline constexpr int kAbsent = -100;
template <typename GroupOf>
KeptPairs keep_pairs(std::span<const ExplicitPair> pairs, GroupOf group_of);

/// Does a chain of `pairs` lead from `from` to `to`?
bool leads_to(std::span<const ExplicitPair> pairs, int from, int to);

/// By id: does the layer lie on a cycle of `pairs`, or on a way from one to another? Empty where there is none. Cost: O(pairs
/// + largest id). Ids ≥ 0.
std::vector<char> cyclic_core(std::span<const ExplicitPair> pairs);

template <typename GroupOf>
KeptPairs keep_pairs(std::span<const ExplicitPair> pairs, GroupOf group_of) {
  const auto rule_of_groups = [&](const ExplicitPair& p) -> const char* {
    return p.behind == p.front                      ? "names one layer twice"
           : group_of(p.behind) > group_of(p.front) ? "contradicts the groups of the two"
                                                    : nullptr;
  };
  std::vector<ExplicitPair> present;
  for (const ExplicitPair& p : pairs)
    if (group_of(p.behind) != kAbsent && group_of(p.front) != kAbsent) present.push_back(p);
  std::vector<ExplicitPair> sound;
  for (const ExplicitPair& p : present)
    if (rule_of_groups(p) == nullptr) sound.push_back(p);
  const std::vector<char> core = cyclic_core(sound);  // a pair with an end outside of it closes no cycle
  std::vector<ExplicitPair> kept_in_core;
  KeptPairs kept;
  for (const ExplicitPair& p : present) {
    const char* broken = rule_of_groups(p);
    const bool in_core = !broken && !core.empty() && core[p.behind] && core[p.front];
    if (in_core && leads_to(kept_in_core, p.front, p.behind)) broken = "closes a cycle of explicit pairs";
    if (!broken && in_core) kept_in_core.push_back(p);
    if (!broken) {
      kept.pairs.push_back(p);
    } else if (kept.defect.empty()) {
      kept.defect = "explicit pair: layer " + std::to_string(p.behind) + " behind layer " +
                    std::to_string(p.front) + " " + broken;
    }
  }
  return kept;
}

}  // namespace talisman::layers
