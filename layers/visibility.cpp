// SPDX-License-Identifier: Apache-2.0
//
// One frame: the layers' bodies are placed, the relations between them brought up to date
// (layers/visibility_relations.h), the line of last frame is taken as the start and put in order again where
// relations have changed (layers/visibility_order.h); what is cyclic, or was until lately, is merged.
#include "layers/visibility.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "layers/check.h"
#include "layers/vectors.h"
#include "layers/visibility_order.h"
#include "layers/visibility_relations.h"

namespace talisman::layers {

namespace {

/// Where the search for a short cycle starts; more would not make the report clearer.
constexpr int kCycleStarts = 64;

/// A layer that has been seen, by its id.
struct Known {
  bool present = false;
  OrderGroup group = OrderGroup::Normal;
  std::vector<int> bodies;
  long frame = -1;  ///< when it was last given
};

/// Layers that went round in some frame, and stay merged for a while.
struct HeldCycle {
  std::vector<int> layers;  ///< ascending
  long frame = 0;           ///< when they last did
};

bool is_subset(const std::vector<int>& inner, const std::vector<int>& outer) {
  return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
}

}  // namespace

struct VisibilitySorter::State {
  explicit State(const VisibilityOptions& o)
      : options(o), relations(std::isfinite(o.touch) ? std::clamp(o.touch, 0.0, 0.5) : 0.0) {}

  // Each reads and completes what the one before has left; sort() is the chapter.
  void place(std::span<const Occluder> occluders);
  void place_layer(const Occluder& occluder);
  void line_up();
  double distance(int layer) const;
  std::vector<OrderEdge> relate(const KeptPairs& kept) const;
  std::vector<OrderEdge> hold() const;
  void forget_old_cycles();
  void explain(VisibilityOrder& out, std::span<const OrderEdge> edges);
  std::vector<HeldCycle> explain_component(MergedComponent& component,
                                           std::vector<HeldCycle> held_in_it) const;
  VisibilityOrder arrange(const SortedLine& sorted);
  int group_of(int layer) const;

  VisibilityOptions options;
  OcclusionRelations relations;
  std::vector<Known> known;  ///< by layer id
  std::vector<int> line;     ///< layer ids from back to front
  std::vector<int> rank;     ///< by layer id, in the line that this frame starts from
  std::vector<int> added;    ///< those of this frame that are not in the line yet
  std::vector<HeldCycle> held;
  dvec3 eye{0, 0, 0};
  long frame = 0;
};

int VisibilitySorter::State::group_of(int layer) const {
  if (layer < 0 || layer >= static_cast<int>(known.size()) || !known[layer].present) return kAbsent;
  return static_cast<int>(known[layer].group);
}

/// A layer whose group changes leaves the line and enters it again.
void VisibilitySorter::State::place_layer(const Occluder& occluder) {
  Known& layer = known[occluder.layer];
  TALISMAN_CHECK_LT(layer.frame, frame);
  layer.frame = frame;
  if (layer.present && layer.group != occluder.group) {
    for (const int body : layer.bodies) relations.remove_body(body);
    layer.bodies.clear();
    std::erase(line, occluder.layer);
    layer.present = false;
  }
  if (!layer.present) added.push_back(occluder.layer);
  layer.present = true, layer.group = occluder.group;
  while (layer.bodies.size() > occluder.bodies.size()) {
    relations.remove_body(layer.bodies.back());
    layer.bodies.pop_back();
  }
  while (layer.bodies.size() < occluder.bodies.size())
    layer.bodies.push_back(relations.add_body(occluder.layer, occluder.group));
  for (std::size_t k = 0; k < layer.bodies.size(); ++k)
    relations.place_body(layer.bodies[k], occluder.bodies[k]);
}

void VisibilitySorter::State::place(std::span<const Occluder> occluders) {
  int largest = -1;
  for (const Occluder& o : occluders) {
    TALISMAN_CHECK_GE(o.layer, 0);
    largest = std::max(largest, o.layer);
  }
  if (largest >= static_cast<int>(known.size())) known.resize(largest + 1);
  added.clear();
  for (const Occluder& o : occluders) place_layer(o);
  if (line.size() + added.size() == occluders.size()) return;
  std::erase_if(line, [&](int id) {
    Known& layer = known[id];
    if (layer.frame == frame) return false;
    for (const int body : layer.bodies) relations.remove_body(body);
    layer = Known{};
    return true;
  });
}

/// Of the middle of all its bodies; infinite for a layer without any.
double VisibilitySorter::State::distance(int layer) const {
  WorldBounds all;
  for (const int body : known[layer].bodies) {
    const WorldBounds& b = relations.bounds(body);
    if (b.empty()) continue;
    all.lo = glm::min(all.lo, b.lo), all.hi = glm::max(all.hi, b.hi);
  }
  return all.empty() ? HUGE_VAL : glm::length((all.lo + all.hi) * 0.5 - eye);
}

/// Puts the new layers into last frame's line: each before the first layer of its group that is nearer.
void VisibilitySorter::State::line_up() {
  struct Entry {
    int layer;
    OrderGroup group;
    double distance;
  };
  const auto entry = [&](int layer) { return Entry{layer, known[layer].group, distance(layer)}; };
  const auto before = [](const Entry& a, const Entry& b) {
    return a.group != b.group ? a.group < b.group : a.distance > b.distance;
  };
  if (!added.empty()) {
    std::vector<Entry> fresh, old, all;
    for (const int layer : added) fresh.push_back(entry(layer));
    for (const int layer : line) old.push_back(entry(layer));
    std::sort(fresh.begin(), fresh.end(), [&](const Entry& a, const Entry& b) {
      return before(a, b) || (!before(b, a) && a.layer < b.layer);
    });
    std::merge(old.begin(), old.end(), fresh.begin(), fresh.end(), std::back_inserter(all), before);
    line.clear();
    for (const Entry& e : all) line.push_back(e.layer);
  }
  rank.resize(known.size());
  for (std::size_t i = 0; i < line.size(); ++i) rank[line[i]] = static_cast<int>(i);
}

/// What geometry and the author say, by ranks.
std::vector<OrderEdge> VisibilitySorter::State::relate(const KeptPairs& kept) const {
  std::set<std::pair<int, int>> fixed;
  for (const ExplicitPair& p : kept.pairs) fixed.insert(std::minmax(p.behind, p.front));
  std::vector<OrderEdge> edges;
  edges.reserve(relations.pairs().size());
  for (const auto& pair : relations.pairs()) {
    if (!pair.first_occludes && !pair.second_occludes) continue;
    const int first = relations.layer_of(pair.first), second = relations.layer_of(pair.second);
    if (!fixed.empty() && fixed.contains(std::minmax(first, second))) continue;
    if (pair.first_occludes) edges.push_back({rank[second], rank[first]});
    if (pair.second_occludes) edges.push_back({rank[first], rank[second]});
  }
  for (const ExplicitPair& p : kept.pairs)
    if (known[p.behind].group == known[p.front].group) edges.push_back({rank[p.behind], rank[p.front]});
  return edges;
}

void VisibilitySorter::State::forget_old_cycles() {
  for (HeldCycle& h : held) std::erase_if(h.layers, [&](int layer) { return group_of(layer) == kAbsent; });
  std::erase_if(held, [&](const HeldCycle& h) {
    const auto other_group = [&](int layer) { return group_of(layer) != group_of(h.layers[0]); };
    return h.layers.size() < 2 || frame - h.frame > options.release_frames ||
           std::any_of(h.layers.begin(), h.layers.end(), other_group);
  });
}

/// A ring through the layers of each held cycle keeps them one component.
std::vector<OrderEdge> VisibilitySorter::State::hold() const {
  std::vector<OrderEdge> ring;
  for (const HeldCycle& h : held)
    for (std::size_t k = 0; k < h.layers.size(); ++k)
      ring.push_back({rank[h.layers[k]], rank[h.layers[(k + 1) % h.layers.size()]]});
  return ring;
}

/// The layers of the sorted line, merged ones by their ids.
VisibilityOrder VisibilitySorter::State::arrange(const SortedLine& sorted) {
  VisibilityOrder out;
  const int count = static_cast<int>(sorted.places.size());
  out.order.reserve(sorted.places.size());
  out.groups_back_to_front.reserve(sorted.places.size());
  for (const int place : sorted.places) out.order.push_back(line[place]);
  auto cyclic = sorted.cyclic.begin();
  for (int i = 0; i < count;) {
    const bool merged = cyclic != sorted.cyclic.end() && cyclic->first == i;
    const int size = merged ? (cyclic++)->count : 1;
    const auto first = out.order.begin() + i;
    std::sort(first, first + size);
    out.groups_back_to_front.emplace_back(first, first + size);
    if (merged) out.merged.emplace_back().layers = out.groups_back_to_front.back();
    i += size;
  }
  return out;
}

/// Fills in the relations within each merged component, and why it is one; takes note of the cycles.
void VisibilitySorter::State::explain(VisibilityOrder& out, std::span<const OrderEdge> edges) {
  if (out.merged.empty()) {
    held.clear();
    return;
  }
  std::vector<int> component_of(line.size(), -1);
  for (std::size_t c = 0; c < out.merged.size(); ++c)
    for (const int layer : out.merged[c].layers) component_of[rank[layer]] = static_cast<int>(c);
  for (const OrderEdge& e : edges)
    if (component_of[e.behind] >= 0 && component_of[e.behind] == component_of[e.front])
      out.merged[component_of[e.behind]].relations.push_back({line[e.behind], line[e.front]});
  std::vector<std::vector<HeldCycle>> held_in(out.merged.size());
  for (HeldCycle& h : held) held_in[component_of[rank[h.layers[0]]]].push_back(std::move(h));
  held.clear();
  for (std::size_t c = 0; c < out.merged.size(); ++c)
    for (HeldCycle& h : explain_component(out.merged[c], std::move(held_in[c]))) held.push_back(std::move(h));
}

/// Returns the cycles to hold: those of this frame, and older ones that are not part of one of these.
std::vector<HeldCycle> VisibilitySorter::State::explain_component(MergedComponent& c,
                                                                  std::vector<HeldCycle> held_in_it) const {
  const auto by_layers = [](const ExplicitPair& p, const ExplicitPair& q) {
    return p.behind != q.behind ? p.behind < q.behind : p.front < q.front;
  };
  std::sort(c.relations.begin(), c.relations.end(), by_layers);
  c.relations.erase(std::unique(c.relations.begin(), c.relations.end()), c.relations.end());
  const auto member = [&](int layer) {
    return static_cast<int>(std::lower_bound(c.layers.begin(), c.layers.end(), layer) - c.layers.begin());
  };
  std::vector<OrderEdge> edges;
  for (const ExplicitPair& p : c.relations) edges.push_back({member(p.behind), member(p.front)});
  const int count = static_cast<int>(c.layers.size());
  const SortedLine truly = sort_line(count, edges);
  if (truly.cyclic.empty()) {
    long last = 0;
    for (const HeldCycle& h : held_in_it) last = std::max(last, h.frame);
    c.reason = MergedComponent::Reason::Held;
    c.absent_frames = static_cast<int>(frame - last);
    return held_in_it;
  }
  for (const LineRange& range : truly.cyclic) {
    std::vector<int> layers;
    layers.reserve(range.count);
    for (int k = 0; k < range.count; ++k) layers.push_back(c.layers[truly.places[range.first + k]]);
    std::erase_if(held_in_it, [&](const HeldCycle& h) { return is_subset(h.layers, layers); });
    held_in_it.push_back({std::move(layers), frame});
  }
  for (const int k : short_cycle(count, edges, kCycleStarts)) c.cycle.push_back(c.layers[k]);
  c.reason = c.cycle.size() == 2 ? MergedComponent::Reason::Interpenetration : MergedComponent::Reason::Cycle;
  return held_in_it;
}

namespace {

/// How many layers are not where they were, among those that are in both lines.
int count_swaps(const std::vector<int>& before, const std::vector<int>& now) {
  int swaps = 0;
  for (std::size_t i = 0; i < now.size(); ++i) swaps += before[i] != now[i];
  return swaps;
}

void count_order(VisibilityOrder& out, const KeptPairs& kept) {
  VisibilityCounters& c = out.counters;
  c.layers = static_cast<int>(out.order.size());
  c.components = static_cast<int>(out.groups_back_to_front.size());
  c.merged_components = static_cast<int>(out.merged.size());
  for (const MergedComponent& m : out.merged) {
    c.merged_layers += static_cast<int>(m.layers.size());
    const auto in = [&](int id) { return std::binary_search(m.layers.begin(), m.layers.end(), id); };
    for (const ExplicitPair& p : kept.pairs) c.overruled_pairs += in(p.behind) && in(p.front);
  }
}

}  // namespace

VisibilityOrder VisibilitySorter::sort(const dvec3& eye, std::span<const Occluder> occluders,
                                       std::span<const ExplicitPair> pairs) {
  if (!state_) state_ = std::make_unique<State>(options_);
  State& s = *state_;
  ++s.frame;
  s.eye = is_finite(eye) ? eye : dvec3{0, 0, 0};
  VisibilityCounters counters;
  s.relations.place_eye(s.eye);
  s.place(occluders);
  s.relations.update(counters);
  s.line_up();
  s.forget_old_cycles();
  const KeptPairs kept = keep_pairs(pairs, [&](int layer) { return s.group_of(layer); });
  std::vector<OrderEdge> edges = s.relate(kept);
  const std::vector<OrderEdge> ring = s.hold();
  const std::size_t related = edges.size();
  edges.insert(edges.end(), ring.begin(), ring.end());
  const SortedLine sorted = sort_line(static_cast<int>(s.line.size()), edges);
  VisibilityOrder out = s.arrange(sorted);
  s.explain(out, std::span<const OrderEdge>(edges).first(related));
  counters.sorted = sorted.sorted;
  counters.swaps = count_swaps(s.line, out.order);
  out.counters = counters;
  out.defect = kept.defect;
  count_order(out, kept);
  s.line = out.order;
  return out;
}

VisibilitySorter::VisibilitySorter(const VisibilityOptions& options) : options_(options) {}
VisibilitySorter::VisibilitySorter(const VisibilitySorter& other)
    : options_(other.options_), state_(other.state_ ? std::make_unique<State>(*other.state_) : nullptr) {}
VisibilitySorter::VisibilitySorter(VisibilitySorter&&) noexcept = default;
VisibilitySorter& VisibilitySorter::operator=(VisibilitySorter other) noexcept {
  options_ = other.options_;
  state_ = std::move(other.state_);
  return *this;
}
VisibilitySorter::~VisibilitySorter() = default;

}  // namespace talisman::layers
