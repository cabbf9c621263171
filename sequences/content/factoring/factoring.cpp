// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/factoring.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <optional>
#include <set>

#include <tbb/parallel_for.h>

#include "sequences/content/factoring/backdrops.h"
#include "sequences/content/factoring/motion_groups.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using layers::LayerSpec;

/// Layers times frames that a comparison plans, of each factoring: a second or two of the longest.
constexpr int kMostPlanned = 60'000;

/// Rounds in which pairs that are missing are added. Each may uncover others behind them.
constexpr int kOrderRounds = 3;

/// Share of the frames in which layers share a sprite anyway that makes them one.
constexpr double kSharedShare = 0.9;

/// What is joined may meet others; what is split may be split again.
constexpr int kJoinRounds = 2, kSplitRounds = 2;

/// What a factoring with a background may cost of one without.
constexpr double kWorthABackground = 0.8;

using Groups = std::vector<std::vector<int>>;

std::vector<double> times_of(const std::vector<int>& frames, double fps) {
  std::vector<double> times;
  for (const int frame : frames) times.push_back(frame / fps);
  return times;
}

/// As many as the triangles allow, all of which are looked at in each.
std::vector<int> instants_of(const Unfactored& scene) {
  std::int64_t triangles = 1;
  for (const layers::Part& part : scene.scene.parts)
    triangles += scene.scene.meshes[part.mesh].triangle_count();
  const auto affordable = std::max<std::int64_t>(4, kMostDepthTriangles / triangles);
  return spread_frames(scene.settings.frames,
                       static_cast<int>(std::min<std::int64_t>(kMostInstants, affordable)));
}

/// A piece for each node as groups of pieces: those of which the parts are in it.
Groups groups_by_node(const layers::Scene& scene, const Pieces& pieces, const Pieces& nodes) {
  std::vector<int> node_of(scene.parts.size(), -1);
  for (std::size_t i = 0; i < nodes.free; ++i)
    for (const int part : nodes.layers[i].parts) node_of[part] = static_cast<int>(i);
  Groups groups(nodes.free);
  for (std::size_t i = 0; i < pieces.free; ++i) {
    const int node = node_of[pieces.layers[i].parts.front()];
    if (node >= 0) groups[node].push_back(static_cast<int>(i));
  }
  std::erase_if(groups, [](const std::vector<int>& group) { return group.empty(); });
  return groups;
}

/// By which factorings are compared: a background, which may be drawn behind what it hides, must be worth it.
double dearness_ms(const Factoring& f) {
  return f.plan.work_ms() / (f.has_background ? kWorthABackground : 1);
}

bool is_cheaper(const Factoring& a, const Factoring& b) { return dearness_ms(a) < dearness_ms(b); }

/// Groups to be looked at, and after them those that share a sprite anyway as one (`is_joined`).
struct Candidate {
  Groups groups;
  bool has_background = false, is_joined = false;
};

class Study {
 public:
  Study(const Unfactored& scene, const AutoLayers& options)
      : scene_(scene), options_(options), instants_(instants_of(scene)) {
    pieces_ = pieces_of(scene.scene, scene.kept);
    node_pieces_ = node_pieces_of(scene.scene, scene.kept, scene.nodes);
    nodes_ = groups_by_node(scene.scene, pieces_, node_pieces_);
    if (pieces_.free > kMostFactoredPieces) {
      pieces_ = node_pieces_;
      nodes_.clear();
      for (std::size_t i = 0; i < pieces_.free; ++i) nodes_.push_back({static_cast<int>(i)});
    }
  }

  FactoringStudy run() {
    if (options_.way == FactoringWay::Amortised) return as_they_are("amortised", alone());
    if (options_.way == FactoringWay::Motion)
      return as_they_are("motion", groups_that_move_as_one(scene_.scene, pieces_, scene_.settings));
    const bool by_node = options_.way == FactoringWay::Node;
    if (pieces_.free > 1 && pieces_.free <= kMostFactoredPieces && (!by_node || too_many_nodes())) look();
    if (data_) behind_ = pieces_behind(scene_.scene, pieces_, data_->depths);
    std::vector<Factoring> all = by_node || !data_ ? by_nodes() : by_velocity();
    FactoringStudy result;
    const auto best = std::min_element(all.begin(), all.end(), is_cheaper);
    result.chosen = std::move(*best);
    all.erase(best);
    std::erase_if(all, [](const Factoring& f) { return f.how == "velocity"; });
    result.others = std::move(all);
    if (data_) result.nearest_joins = nearest_joins(result.chosen);
    result.pieces = std::move(pieces_);
    result.instants = data_ ? instants_ : std::vector<int>{};
    return result;
  }

 private:
  struct Data {
    PieceMotion motion;
    DepthSamples depths;
  };

  /// Nothing is compared: all that is looked at is the order where the bounds know none.
  FactoringStudy as_they_are(const std::string& how, const Groups& groups) {
    FactoringStudy result;
    if (pieces_.free > 1 && pieces_.free <= kMostFactoredPieces) {
      look();
      result.chosen = in_order({groups, false, false}).factoring;
      result.instants = instants_;
    } else {
      result.chosen = factoring_of(how, groups);
      result.chosen.set = layers::factor(scene_.scene, result.chosen.specs);
    }
    result.chosen.how = how;
    result.pieces = std::move(pieces_);
    return result;
  }

  bool too_many_nodes() const { return nodes_.size() > static_cast<std::size_t>(options_.limit()); }

  void begin(const std::string& what) const {
    if (scene_.begins) scene_.begins(what);
  }

  void look() {
    begin(formatted("looking at motion and depth of %zu pieces", pieces_.free));
    data_.emplace(Data{{scene_.scene, pieces_.layers, scene_.settings, instants_},
                       {scene_.scene, pieces_.layers, times_of(instants_, scene_.settings.fps),
                        scene_.settings.view.display_px}});
  }
  GroupingData data(bool background = false) const {
    return {pieces_, data_->motion, data_->depths, scene_.settings.frames,
            background ? behind_ : std::vector<bool>{}};
  }
  bool any_behind() const { return std::find(behind_.begin(), behind_.end(), true) != behind_.end(); }

  Groups alone() const {
    Groups groups;
    for (int piece = 0; piece < static_cast<int>(pieces_.free); ++piece) groups.push_back({piece});
    return groups;
  }

  /// The nodes, and of what lies behind a group for each piece: one warp does not carry a land.
  Groups nodes_on_tiles() const {
    Groups groups;
    for (const std::vector<int>& node : nodes_) {
      std::vector<int> before;
      for (const int piece : node)
        if (behind_[piece])
          groups.push_back({piece});
        else
          before.push_back(piece);
      groups.push_back(std::move(before));
    }
    std::erase_if(groups, [](const std::vector<int>& group) { return group.empty(); });
    return groups;
  }

  std::vector<int> everything() const {
    std::vector<int> all(pieces_.free);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  /// Nodes as pieces, joined where there are too many.
  Groups limited_nodes() const { return grouped(data(), {options_.limit(), true}, nodes_); }

  /// Of nodes that are too many to look at: the largest, and one layer for the rest.
  Groups largest_nodes() const {
    Groups groups = nodes_;
    const auto most = static_cast<std::size_t>(options_.limit());
    if (groups.size() <= most) return groups;
    const auto polygons = [&](const std::vector<int>& group) {
      int sum = 0;
      for (const int piece : group) sum += pieces_.layers[piece].polygons;
      return sum;
    };
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const auto& a, const auto& b) { return polygons(a) > polygons(b); });
    for (; groups.size() > most; groups.pop_back())
      groups[most - 1].insert(groups[most - 1].end(), groups.back().begin(), groups.back().end());
    return groups;
  }

  Factoring factoring_of(const std::string& how, const Groups& groups) const {
    Factoring f;
    f.how = how;
    f.specs = scene_.kept;
    const std::vector<LayerSpec> own =
        specs_of_groups(scene_.scene, scene_.kept, pieces_, groups, node_pieces_);
    f.specs.insert(f.specs.end(), own.begin(), own.end());
    for (std::size_t i = pieces_.free; i < pieces_.layers.size(); ++i)
      f.pieces.push_back({static_cast<int>(i)});
    f.pieces.insert(f.pieces.end(), groups.begin(), groups.end());
    return f;
  }

  int frames_planned(std::size_t layers) const {
    return std::clamp(kMostPlanned / static_cast<int>(std::max<std::size_t>(layers, 1)), 1,
                      std::max(scene_.settings.frames, 1));
  }

  void plan(Factoring& f, double enough_ms = HUGE_VAL) const {
    f.plan = plan_of(scene_.scene, f.set, f.pairs(), scene_.settings, frames_, enough_ms);
  }

  Sharing sharing(const Factoring& f) const {
    return sharing_of(scene_.scene, f.set, f.pairs(), scene_.settings, instants_);
  }

  /// Puts what lies behind all else into the background.
  void put_behind(Factoring& f) const {
    f.has_background = true;
    for (std::size_t i = scene_.kept.size(); i < f.specs.size(); ++i)
      if (behind_[f.pieces[i].front()]) f.specs[i].group = layers::OrderGroup::Background;
    for (std::size_t i = scene_.kept.size(); i < f.specs.size(); ++i)
      for (std::size_t k = 0; k < f.specs.size(); ++k) {
        const bool crosses = f.specs[i].group == layers::OrderGroup::Background &&
                             f.specs[k].group == layers::OrderGroup::Normal;
        const double hidden = crosses ? share_in_front(f.pieces[i], f.pieces[k]) : 0;
        if (hidden > 0) f.over.push_back({{i, k}, hidden});
      }
  }

  double share_in_front(const std::vector<int>& a, const std::vector<int>& b) const {
    const double first = pixels_in_front(data_->depths, a, b), second = pixels_in_front(data_->depths, b, a);
    return first > 0 ? first / (first + second) : 0;
  }

  /// With pairs where the bounds know no order, and what then shares a sprite.
  struct Ordered {
    Factoring factoring;
    Sharing sharing;
  };
  Ordered in_order(const Candidate& candidate) const {
    Factoring f = factoring_of("velocity", candidate.groups);
    if (candidate.has_background) put_behind(f);
    f.set = layers::factor(scene_.scene, f.specs);
    std::vector<layers::OrderGroup> places;
    for (const LayerSpec& spec : f.specs) places.push_back(spec.group);
    Sharing shared = sharing(f);
    for (int round = 0; round < kOrderRounds; ++round) {
      std::set<SpecPair> asked(f.asked.begin(), f.asked.end());
      for (const auto& [pair, frames] : shared.frames) asked.insert(pair);
      if (asked.size() == f.asked.size()) break;
      f.asked.assign(asked.begin(), asked.end());
      f.order = seen_order(data_->depths, f.pieces, places, f.asked);
      shared = sharing(f);
    }
    return {std::move(f), std::move(shared)};
  }

  Factoring as_one_of(const std::string& how, const Groups& groups) const {
    Factoring f = factoring_of(how, groups);
    f.set = layers::factor(scene_.scene, f.specs);
    plan(f);
    return f;
  }

  std::vector<Factoring> by_nodes() {
    const Groups groups = data_ ? limited_nodes() : largest_nodes();
    frames_ = frames_planned(scene_.kept.size() + groups.size());
    return {as_one_of("node", groups)};
  }

  /// All over the same frames.
  std::vector<Factoring> by_velocity() {
    const Groups bodies = bodies_of(scene_.scene, pieces_);
    frames_ = frames_planned(std::max(bodies.size(), nodes_.size()) + scene_.kept.size());
    std::vector<Factoring> all;
    begin("grouping");
    std::vector<Candidate> open = starts(bodies);
    for (int round = 0; round <= kJoinRounds; ++round) open = look_at(std::move(open), all);
    for (int round = 0; round < kSplitRounds; ++round) {
      const auto best = std::min_element(all.begin(), all.end(), is_cheaper);
      const std::size_t before = all.size();
      look_at({{split_where_cheaper(*best, bodies), best->has_background, false}}, all);
      if (all.size() == before) break;
    }
    if (nodes_.size() <= static_cast<std::size_t>(options_.limit())) all.push_back(as_one_of("node", nodes_));
    all.push_back(as_one_of("one", {everything()}));
    return all;
  }

  /// What is grouped by motion, and the bodies as they are before a background.
  std::vector<Candidate> starts(const Groups& bodies) const {
    const std::vector<Groups> at_first{alone(), bodies, nodes_};
    std::vector<Groups> cut;
    if (any_behind())
      for (const Groups& start : {alone(), bodies, nodes_, nodes_on_tiles()})
        cut.push_back(cut_by(behind_, start));
    std::vector<Candidate> found(at_first.size() + cut.size());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
      const bool is_cut = i >= at_first.size();
      const Groups& start = is_cut ? cut[i - at_first.size()] : at_first[i];
      found[i] = {grouped(data(is_cut), {options_.limit(), false}, start), is_cut, true};
    });
    const auto most = static_cast<std::size_t>(options_.limit());
    std::erase_if(found, [&](const Candidate& c) {  // both sides may be too many
      return c.has_background && c.groups.size() > most;
    });
    for (Groups& groups : cut)
      if (groups.size() <= most) found.push_back({std::move(groups), true, false});
    return found;
  }

  bool is_among(const Candidate& candidate, const std::vector<Factoring>& all) const {
    const auto first = static_cast<std::ptrdiff_t>(scene_.kept.size());
    return std::any_of(all.begin(), all.end(), [&](const Factoring& f) {
      return f.has_background == candidate.has_background &&
             std::equal(f.pieces.begin() + first, f.pieces.end(), candidate.groups.begin(),
                        candidate.groups.end());
    });
  }

  /// Those that are not among `all`, each once.
  std::vector<Candidate> new_ones(std::vector<Candidate> open, const std::vector<Factoring>& all) const {
    std::vector<Candidate> kept;
    for (Candidate& candidate : open) {
      std::sort(candidate.groups.begin(), candidate.groups.end());
      const auto same = std::find_if(kept.begin(), kept.end(), [&](const Candidate& other) {
        return other.has_background == candidate.has_background && other.groups == candidate.groups;
      });
      if (same != kept.end())
        same->is_joined |= candidate.is_joined;
      else if (!is_among(candidate, all))
        kept.push_back(std::move(candidate));
    }
    return kept;
  }

  /// Orders and plans what is new, each until it is dearer than the cheapest that is known: that is never chosen. Returns
  /// what comes of those that are joined.
  std::vector<Candidate> look_at(std::vector<Candidate> open, std::vector<Factoring>& all) const {
    open = new_ones(std::move(open), all);
    if (!open.empty()) begin(formatted("ordering and planning %zu factorings", open.size()));
    std::atomic<double> least_ms = HUGE_VAL;
    for (const Factoring& f : all) least_ms = std::min(least_ms.load(), dearness_ms(f));
    std::vector<Factoring> found(open.size());
    std::vector<Candidate> next(open.size());
    tbb::parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
      Ordered ordered = in_order(open[i]);
      Factoring& f = found[i] = std::move(ordered.factoring);
      plan(f, least_ms * (f.has_background ? kWorthABackground : 1));
      double known = least_ms;
      while (dearness_ms(f) < known && !least_ms.compare_exchange_weak(known, dearness_ms(f))) {
      }
      if (open[i].is_joined)
        next[i] = {joined_where_shared(f, ordered.sharing), open[i].has_background, true};
    });
    all.insert(all.end(), std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
    std::erase_if(next, [](const Candidate& c) { return !c.is_joined; });
    return next;
  }

  /// The same with groups apart again that a plan, in which each layer is alone, shows to be dearer than the bodies in
  /// them: where the estimate was wrong.
  Groups split_where_cheaper(const Factoring& f, const Groups& bodies) const {
    const std::size_t first = scene_.kept.size();
    Groups looked_at;
    std::vector<std::size_t> owner;  // the group of which each is a part, or itself
    for (std::size_t i = first; i < f.pieces.size(); ++i) {
      const std::size_t before = looked_at.size();
      looked_at.push_back(f.pieces[i]);
      for (const std::vector<int>& body : bodies)
        if (body.size() < f.pieces[i].size() &&
            std::includes(f.pieces[i].begin(), f.pieces[i].end(), body.begin(), body.end()))
          looked_at.push_back(body);
      std::size_t covered = 0;
      for (std::size_t k = before + 1; k < looked_at.size(); ++k) covered += looked_at[k].size();
      if (covered < f.pieces[i].size()) looked_at.resize(before + 1);
      owner.resize(looked_at.size(), before);
    }
    begin(formatted("planning %zu groups, each by itself", looked_at.size()));
    const std::vector<PlannedFactoring> plans = plans_of_parts(looked_at);
    Groups groups;
    for (std::size_t i = 0; i < looked_at.size();) {
      std::size_t end = i + 1;
      double parts_ms = 0;
      for (; end < looked_at.size() && owner[end] == i; ++end) parts_ms += plans[end].work_ms();
      const bool is_split = end > i + 1 && parts_ms < plans[i].work_ms() &&
                            groups.size() + (end - i - 1) <= static_cast<std::size_t>(options_.limit());
      if (is_split)
        groups.insert(groups.end(), looked_at.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                      looked_at.begin() + static_cast<std::ptrdiff_t>(end));
      else
        groups.push_back(looked_at[i]);
      i = end;
    }
    return groups.size() <= static_cast<std::size_t>(options_.limit())
               ? groups
               : Groups(f.pieces.begin() + static_cast<std::ptrdiff_t>(first), f.pieces.end());
  }

  std::vector<PlannedFactoring> plans_of_parts(const Groups& groups) const {
    std::vector<LayerSpec> specs;
    for (const std::vector<int>& group : groups)
      specs.push_back(specs_of_groups(scene_.scene, {}, pieces_, {group}).front());
    return plans_apart(scene_.scene, specs, scene_.settings, frames_);
  }

  Groups joined_where_shared(const Factoring& f, const Sharing& sharing) const {
    const std::size_t first = scene_.kept.size();
    std::vector<std::size_t> root(f.specs.size());
    std::iota(root.begin(), root.end(), 0);
    for (const auto& [pair, frames] : sharing.frames) {
      const auto [a, b] = pair;
      const int shown = std::min(sharing.frames_shown[a], sharing.frames_shown[b]);
      if (a < first || b < first || frames < kSharedShare * shown || root[a] == root[b]) continue;
      const std::size_t from = std::max(root[a], root[b]), to = std::min(root[a], root[b]);
      std::replace(root.begin(), root.end(), from, to);
    }
    Groups groups(f.specs.size());
    for (std::size_t i = first; i < f.specs.size(); ++i)
      groups[root[i]].insert(groups[root[i]].end(), f.pieces[i].begin(), f.pieces[i].end());
    std::erase_if(groups, [](const std::vector<int>& group) { return group.empty(); });
    for (std::vector<int>& group : groups) std::sort(group.begin(), group.end());
    return groups;
  }

  std::vector<SpecPair> nearest_joins(const Factoring& f) const {
    const std::size_t first = scene_.kept.size();
    std::vector<double> ms(f.specs.size());
    for (std::size_t i = first; i < ms.size(); ++i) ms[i] = work_of(data(), f.pieces[i]).ms;
    std::vector<std::pair<double, SpecPair>> joins;
    for (std::size_t i = first; i < ms.size(); ++i)
      for (std::size_t k = i + 1; k < ms.size(); ++k) {
        std::vector<int> both = f.pieces[i];
        both.insert(both.end(), f.pieces[k].begin(), f.pieces[k].end());
        joins.push_back({work_of(data(), both).ms - ms[i] - ms[k], {i, k}});
      }
    std::sort(joins.begin(), joins.end());
    joins.resize(std::min(joins.size(), kNearestJoins));
    std::vector<SpecPair> pairs;
    for (const auto& [more_ms, pair] : joins) pairs.push_back(pair);
    return pairs;
  }

  const Unfactored& scene_;
  AutoLayers options_;
  std::vector<int> instants_;
  Pieces pieces_, node_pieces_;
  Groups nodes_;
  std::optional<Data> data_;
  std::vector<bool> behind_;  ///< by piece (backdrops.h)
  int frames_ = 1;            ///< that comparisons plan
};

}  // namespace

std::vector<SpecPair> Factoring::pairs() const {
  std::vector<SpecPair> pairs;
  for (const SeenPair& seen : order) pairs.push_back(seen.pair);
  return pairs;
}

std::vector<std::string> hidden_in_words(const Factoring& factoring) {
  std::vector<std::string> lines;
  const auto say = [&](const SeenPair& seen, double more_than) {
    if (!(seen.hidden > more_than)) return;
    const std::string &front = factoring.specs[seen.pair.second].name,
                      &behind = factoring.specs[seen.pair.first].name;
    lines.push_back(formatted(
        "layer '%s' is drawn over '%s', which hides it at %.2g %% of the pixels at which both were seen",
        front.c_str(), behind.c_str(), 100 * seen.hidden));
  };
  for (const SeenPair& seen : factoring.order) say(seen, 0);
  for (const SeenPair& seen : factoring.over) say(seen, kHidden);
  return lines;
}

FactoringStudy study(const Unfactored& scene, const AutoLayers& options) {
  return Study(scene, options).run();
}

}  // namespace talisman::sequences
