// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/regrouping/regroup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/regrouping/shared_entries.h"
#include "sequences/pipeline/regrouping/sprite_runs.h"

namespace talisman::sequences {

namespace {

using layers::RectD;
using regulator::RegroupVerdict;
using regulator::SpritePrice;

/// A change that pays: neighbours `first` and `second` are merged, or `first` is cut before its member `cut`.
struct Change {
  std::size_t first = 0, second = 0;  // sprites of the line
  std::size_t cut = 0;                // 0: merged
  RegroupVerdict verdict;
};

SharedSet as_set(std::span<const int> layers) {
  SharedSet set(layers.begin(), layers.end());
  std::sort(set.begin(), set.end());
  return set;
}

/// What one sprite for some neighbours would be.
struct Stretch {
  std::int64_t polygons = 0;
  RectD bounds_px;        ///< of what it shows, on the display and beside it
  double run_frames = 1;  ///< that it would last
  double density = 1;     ///< texels a pixel, each axis, that their authors ask for
};

Stretch joined(const Stretch& behind, const Stretch& front, double run_of_both_frames) {
  Stretch both = behind;
  both.polygons += front.polygons;
  if (!front.bounds_px.empty()) {
    both.bounds_px.include(front.bounds_px.lo);
    both.bounds_px.include(front.bounds_px.hi);
  }
  both.run_frames = std::min({behind.run_frames, front.run_frames, run_of_both_frames});
  return both;
}

/// What is needed to weigh a change in one frame. Cost: O(layers · log layers).
class Weighing {
 public:
  Weighing(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
           std::span<const LineSprite> sprites)
      : options_(pipeline.settings.regulator.regroup),
        pipeline_(pipeline),
        memory_(state.regroup),
        frame_(report.frame),
        display_{{0, 0}, layers::dvec2(report.display_px)},
        sprites_(sprites),
        states_(captured_states(pipeline, state, report.frame)) {
    for (const LineSprite& sprite : sprites_) {
      wholes_.push_back(before(sprite.members).back());
      wholes_.back().run_frames = known_run(sprite.members, wholes_.back().run_frames);
    }
  }

  /// All that pay.
  std::vector<Change> changes() const {
    std::vector<Change> found;
    for (std::size_t i = 0; i < sprites_.size(); ++i) {
      if (sprites_[i].members.size() > 1) weigh_cuts(i, found);
      if (i + 1 < sprites_.size() && !sprites_[i].ends_stretch) weigh_merging(i, found);
    }
    return found;
  }

 private:
  Stretch one(int layer) const {
    const layers::Layer& own = pipeline_.authored[layer];
    const auto runs = memory_.layers.find(layer);
    return {own.polygons, states_[layer].screen_bounds_px,
            runs != memory_.layers.end() ? runs->second.run.expected() : 1, own.preferences.resolution_scale};
  }

  double pair_run(int behind, int front) const {
    const auto pair = memory_.pairs.find({behind, front});
    return pair != memory_.pairs.end() ? pair->second.run.expected() : 1;
  }

  /// Of these layers as a set, where they have been one.
  double known_run(std::span<const int> layers, double otherwise) const {
    const auto known = layers.size() > 1 ? memory_.sets.find(as_set(layers)) : memory_.sets.end();
    return known != memory_.sets.end() ? std::min(otherwise, known->second.run.expected()) : otherwise;
  }

  /// [k]: the members up to k.
  std::vector<Stretch> before(std::span<const int> members) const {
    std::vector<Stretch> stretches = {one(members.front())};
    for (std::size_t k = 1; k < members.size(); ++k)
      stretches.push_back(joined(stretches.back(), one(members[k]), pair_run(members[k - 1], members[k])));
    return stretches;
  }

  /// [k]: the members from k on.
  std::vector<Stretch> after(std::span<const int> members) const {
    std::vector<Stretch> stretches(members.size());
    stretches.back() = one(members.back());
    for (std::size_t k = members.size() - 1; k-- > 0;)
      stretches[k] = joined(one(members[k]), stretches[k + 1], pair_run(members[k], members[k + 1]));
    return stretches;
  }

  SpritePrice price_of(const Stretch& stretch) const {
    const RectD shown = layers::intersection(stretch.bounds_px, display_);
    const double shown_px = shown.empty() ? 0 : shown.width() * shown.height();
    return regulator::modelled_price(stretch.polygons,
                                     std::llround(shown_px * stretch.density * stretch.density), shown_px,
                                     stretch.run_frames);
  }

  /// May its grouping change again?
  bool is_free(std::span<const int> layers) const {
    return std::all_of(layers.begin(), layers.end(), [&](int layer) {
      const auto runs = memory_.layers.find(layer);
      return runs == memory_.layers.end() || runs->second.changed < 0 ||
             runs->second.changed + options_.dwell_frames <= frame_;
    });
  }

  bool is_barred(const SharedSet& set) const {
    const auto known = memory_.sets.find(set);
    return known != memory_.sets.end() && known->second.not_before > frame_;
  }

  void weigh_merging(std::size_t i, std::vector<Change>& found) const {
    const std::vector<int>&behind = sprites_[i].members, &front = sprites_[i + 1].members;
    if (!may_share(pipeline_, behind.back(), front.front()) || !is_free(behind) || !is_free(front)) return;
    std::vector<int> members = behind;
    members.insert(members.end(), front.begin(), front.end());
    if (is_barred(as_set(members))) return;
    Stretch both = joined(wholes_[i], wholes_[i + 1], pair_run(behind.back(), front.front()));
    both.run_frames = known_run(members, both.run_frames);
    const RegroupVerdict verdict = regulator::weigh_merge(price_of(wholes_[i]), price_of(wholes_[i + 1]),
                                                          price_of(both), options_, options_.ceiling_ms);
    if (verdict.pays) found.push_back({i, i + 1, 0, verdict});
  }

  /// Of the part's own sprite, if it has none that serves.
  double render_ms(std::span<const int> part, const SpritePrice& price) const {
    const auto runs = memory_.layers.find(part.front());
    const bool serves =
        part.size() == 1 && runs != memory_.layers.end() && runs->second.own && runs->second.own->is_stored;
    return serves ? 0 : price.render_ms;
  }

  void weigh_cuts(std::size_t i, std::vector<Change>& found) const {
    const std::span<const int> members = sprites_[i].members;
    if (!is_free(members)) return;
    const std::vector<Stretch> behind = before(members), front = after(members);
    const SpritePrice together = price_of(wholes_[i]);
    std::optional<Change> best;
    for (std::size_t cut = 1; cut < members.size(); ++cut) {
      const std::array<SpritePrice, 2> apart = {price_of(behind[cut - 1]), price_of(front[cut])};
      const double renders_ms =
          render_ms(members.first(cut), apart[0]) + render_ms(members.subspan(cut), apart[1]);
      const RegroupVerdict verdict =
          regulator::weigh_split(together, apart, renders_ms, options_, options_.ceiling_ms);
      if (verdict.pays && (!best || verdict.saved_ms() > best->verdict.saved_ms()))
        best = Change{i, i, cut, verdict};
    }
    if (best) found.push_back(*best);
  }

  const regulator::RegroupOptions& options_;
  const Pipeline& pipeline_;
  const RegroupMemory& memory_;
  int frame_;
  RectD display_;
  std::span<const LineSprite> sprites_;
  const std::vector<layers::LayerState>& states_;
  std::vector<Stretch> wholes_;  // by sprite
};

/// Those that are made: the best first, none of which touches another, as far as the ceiling reaches.
std::vector<Change> chosen(std::vector<Change> changes, double ceiling_ms, RegroupMemory& memory) {
  const auto is_better = [](const Change& a, const Change& b) {
    return a.verdict.saved_ms() / a.verdict.frames > b.verdict.saved_ms() / b.verdict.frames;
  };
  std::stable_sort(changes.begin(), changes.end(), is_better);
  std::vector<Change> made;
  double left_ms = ceiling_ms;
  memory.changes_above_ceiling = 0;
  for (const Change& change : changes) {
    const bool is_touched = std::any_of(made.begin(), made.end(), [&](const Change& other) {
      return change.first <= other.second && other.first <= change.second;
    });
    if (is_touched) continue;
    if (change.verdict.terms.once_ms > left_ms) {
      ++memory.changes_above_ceiling;
      continue;
    }
    left_ms -= change.verdict.terms.once_ms;
    made.push_back(change);
  }
  return made;
}

void note_change(std::span<const int> layers, int frame, RegroupMemory& memory) {
  for (const int layer : layers) memory.layers[layer].changed = frame;
}

/// The wanted set of which the layer is a member is given up. Returns it, or an empty one.
SharedSet give_up(int layer, RegroupMemory& memory) {
  for (auto it = memory.shared.begin(); it != memory.shared.end(); ++it) {
    if (!std::binary_search(it->first.begin(), it->first.end(), layer)) continue;
    SharedSet set = it->first;
    memory.shared.erase(it);
    return set;
  }
  return {};
}

void merge(const Change& change, std::span<const LineSprite> sprites, int frame, RegroupMemory& memory) {
  std::vector<int> both = sprites[change.first].members;
  const std::vector<int>& front = sprites[change.second].members;
  both.insert(both.end(), front.begin(), front.end());
  for (const int layer : both) give_up(layer, memory);
  const SharedSet set = as_set(both);
  memory.sets[set] = {regulator::RunLength(change.verdict.frames), memory.sets[set].splits, -1, frame};
  memory.shared[set] = "cheaper together: " + in_words(change.verdict);
  note_change(both, frame, memory);
}

void split(const Change& change, std::span<const LineSprite> sprites, int frame, int dwell,
           RegroupMemory& memory) {
  constexpr int kMostDoublings = 6;
  const std::span<const int> members = sprites[change.first].members;
  const SharedSet wanted = give_up(members.front(), memory);
  SetRuns& set = memory.sets[wanted.empty() ? as_set(members) : wanted];
  set.seen = frame;
  set.not_before = frame + dwell * (1 << std::min(++set.splits, kMostDoublings));
  const std::string why = "cheaper apart: " + in_words(change.verdict);
  for (const auto& part : {members.first(change.cut), members.subspan(change.cut)})
    if (part.size() > 1) memory.shared[as_set(part)] = why;
  for (const int layer : members) memory.why_split[layer] = why;
  note_change(members, frame, memory);
}

}  // namespace

void regroup(const Pipeline& pipeline, PipelineState& state, const FrameReport& report) {
  const regulator::RegroupOptions& options = pipeline.settings.regulator.regroup;
  RegroupMemory& memory = state.regroup;
  const std::vector<LineSprite> sprites = line_sprites(state, report);
  count_runs(pipeline, state, report, sprites);
  for (const Change& change :
       chosen(Weighing(pipeline, state, report, sprites).changes(), options.ceiling_ms, memory)) {
    if (change.cut == 0)
      merge(change, sprites, report.frame, memory);
    else
      split(change, sprites, report.frame, options.dwell_frames, memory);
  }
}

}  // namespace talisman::sequences
