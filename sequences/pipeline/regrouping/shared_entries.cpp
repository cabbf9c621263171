// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/regrouping/shared_entries.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::sequences {

namespace {

using layers::Layer;

/// The wanted sets of a frame, of which each member that is in view is taken once.
class WantedSets {
 public:
  explicit WantedSets(const PipelineState& state) : in_view_(state.layers.size(), 0) {
    for (const auto& [members, why] : state.regroup.shared)
      for (const int member : members) set_of_[member] = &members;
  }
  bool empty() const { return set_of_.empty(); }
  void note_in_view(int layer) { in_view_[layer] = 1; }
  void note_stretch(const SharedSet& set) { ++stretches_[&set]; }
  /// Does the stretch share a sprite, with others or with members that are out of view?
  bool shares(const SharedSet& set, std::size_t layers) const {
    return layers > 1 || stretches_.at(&set) == 1;
  }
  const SharedSet* of(int layer) const {
    const auto found = set_of_.find(layer);
    return found != set_of_.end() ? found->second : nullptr;
  }
  /// Once: the members that nothing shows in this frame.
  std::vector<int> take_out_of_view(const SharedSet& set) {
    std::vector<int> taken;
    for (const int member : set) {
      if (in_view_[member]) continue;
      in_view_[member] = 1;
      taken.push_back(member);
    }
    return taken;
  }

 private:
  std::map<int, const SharedSet*> set_of_;
  std::map<const SharedSet*, int> stretches_;
  std::vector<char> in_view_;  // by id; or taken
};

std::vector<OrderEntry> entries_of(const layers::VisibilityOrder& visibility) {
  std::vector<OrderEntry> entries;
  auto merged = visibility.merged.begin();
  for (const std::vector<int>& group : visibility.groups_back_to_front) {
    entries.push_back({group});
    if (group.size() == 1) continue;
    TALISMAN_CHECK(merged != visibility.merged.end() && merged->layers == group);
    entries.back().cycle = &*merged++;
  }
  return entries;
}

/// The author's layers of the frame that can share, with a gap where two of them are no neighbours.
std::vector<int> line_of(const Pipeline& pipeline, const std::vector<OrderEntry>& entries) {
  std::vector<int> line;
  for (const OrderEntry& entry : entries) {
    const bool takes_part = entry.cycle == nullptr && may_share(pipeline, entry.layers.front());
    line.push_back(takes_part ? entry.layers.front() : -1);
  }
  return line;
}

}  // namespace

bool may_share(const Pipeline& pipeline, int id) {
  const Layer& layer = pipeline.authored[id];
  if (layer.kind != layers::LayerKind::Geometry || layer.base >= 0 || layer.is_aggregate()) return false;
  if (!(layer.factored == layers::HeldTerms{}) || layer.holds.reflection) return false;
  if (!layer.fade.times_s.empty() || !layer.gain.times_s.empty()) return false;
  return !layer.preferences.whole_extents && !(layer.preferences.motion_blur > 0);
}

bool may_share(const Pipeline& pipeline, int a, int b) {
  const Layer &behind = pipeline.authored[a], &front = pipeline.authored[b];
  return behind.group == front.group && behind.preferences == front.preferences;
}

std::vector<OrderEntry> order_entries(const Pipeline& pipeline, const layers::VisibilityOrder& visibility,
                                      PipelineState& state) {
  std::vector<OrderEntry> entries = entries_of(visibility);
  if (!regulator::regroups(pipeline.settings.regulator)) return entries;
  state.regroup.line = line_of(pipeline, entries);
  WantedSets wanted(state);
  if (wanted.empty()) return entries;
  for (const OrderEntry& entry : entries)
    for (const int layer : entry.layers) wanted.note_in_view(layer);
  std::vector<OrderEntry> joined;
  const SharedSet* before = nullptr;
  for (OrderEntry& entry : entries) {
    const SharedSet* set = entry.cycle == nullptr ? wanted.of(entry.layers.front()) : nullptr;
    if (set != nullptr && set == before) {
      joined.back().layers.push_back(entry.layers.front());
    } else {
      joined.push_back(std::move(entry));
      if (set != nullptr) wanted.note_stretch(*set);
    }
    before = set;
  }
  for (OrderEntry& entry : joined) {
    const SharedSet* set = entry.cycle == nullptr ? wanted.of(entry.layers.front()) : nullptr;
    if (set == nullptr || !wanted.shares(*set, entry.layers.size())) continue;
    for (const int member : wanted.take_out_of_view(*set)) entry.layers.push_back(member);
    if (entry.layers.size() < 2) continue;  // the others are in a cycle
    std::sort(entry.layers.begin(), entry.layers.end());
    entry.why_shared = &state.regroup.shared.at(*set);
  }
  return joined;
}

}  // namespace talisman::sequences
