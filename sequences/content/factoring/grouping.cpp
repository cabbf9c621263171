// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/grouping.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>

#include "regulator/profile.h"
#include "sequences/content/factoring/seen_order.h"

namespace talisman::sequences {

namespace {

using layers::RectD;

constexpr double kRefresh_per_s = 75;  // of the published machine

/// Share of the frames in which two pieces meet on the display that makes them one body.
constexpr double kMutualShare = 0.5;

double area_of(const RectD& rect) { return rect.width() * rect.height(); }

RectD united(const RectD& a, const RectD& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)};
}

/// A group at each instant.
struct Group {
  std::vector<int> pieces;
  int polygons = 0;
  bool free = true;
  std::vector<double> renders;  // of the frames that the instant stands for; 0 out of view
  std::vector<RectD> bounds;    // empty out of view
  double touched_px = 0;        // on average over the instants in view
  double ms = 0, area_px = 0;   // area: added up over the instants
  bool is_dead = false;
};

double render_ms(int polygons, double texels) {
  const regulator::HardwareProfile& profile = regulator::talisman_1996();
  return 1e3 * (polygons / profile.polygons_per_s + texels / profile.renderer_pixels_per_s);
}

/// Work, given how often and how large it is drawn. What is seen at all is drawn once.
double work_ms(int polygons, const std::vector<double>& renders, const std::vector<RectD>& bounds) {
  double count = 0, ms = 0, largest_ms = 0;
  for (std::size_t s = 0; s < renders.size(); ++s) {
    if (bounds[s].empty()) continue;
    const double once_ms = render_ms(polygons, area_of(bounds[s]));
    count += renders[s];
    ms += renders[s] * once_ms;
    largest_ms = std::max(largest_ms, once_ms);
  }
  return ms + std::max(0.0, 1 - count) * largest_ms;
}

class Grouping {
 public:
  Grouping(const GroupingData& data, const GroupingOptions& options) : data_(data), options_(options) {
    most_shown_px_ = regulator::talisman_1996().compositor_pixels_per_s / kRefresh_per_s *
                     static_cast<double>(data.motion.instants());
  }

  Group group_of(std::vector<int> pieces) const {
    Group group;
    std::sort(pieces.begin(), pieces.end());
    group.pieces = std::move(pieces);
    const std::size_t instants = data_.motion.instants();
    double in_view = 0;
    for (const int piece : group.pieces) {
      group.polygons += data_.pieces.layers[piece].polygons;
      group.free = group.free && data_.pieces.is_free(piece);
    }
    for (std::size_t s = 0; s < instants; ++s) {
      RectD bounds;
      double touched = 0;
      for (const int piece : group.pieces) {
        if (!data_.motion.in_view(piece, s)) continue;
        bounds = united(bounds, data_.motion.bounds(piece, s));
        touched += data_.depths.touched_px(piece, static_cast<int>(s));
      }
      const double frames = static_cast<double>(data_.frames) / static_cast<double>(instants);
      group.renders.push_back(bounds.empty() ? 0 : frames / data_.motion.reuse_frames(group.pieces, s));
      group.bounds.push_back(bounds);
      group.area_px += area_of(bounds);
      group.touched_px += std::min(touched, area_of(bounds));
      in_view += !bounds.empty();
    }
    if (in_view > 0) group.touched_px /= in_view;
    group.ms = work_ms(group.polygons, group.renders, group.bounds);
    return group;
  }

  std::vector<std::vector<int>> run(const std::vector<std::vector<int>>& start) {
    for (const std::vector<int>& group : options_.only_limit ? start : joined_bodies(start))
      add(group_of(group));
    for (std::size_t piece = data_.pieces.free; piece < data_.pieces.layers.size(); ++piece)
      add(group_of({static_cast<int>(piece)}));
    for (std::size_t i = 0; i < groups_.size(); ++i)
      for (std::size_t k = i + 1; k < groups_.size(); ++k) consider(i, k);
    for (const Group& group : groups_)
      if (!group.is_dead && group.free) free_ms_ += kFree * group.ms;
    while (!pairs_.empty() && join_next()) {
    }
    std::vector<std::vector<int>> result;
    for (const Group& group : groups_)
      if (!group.is_dead && group.free) result.push_back(group.pieces);
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  /// Two groups, and by how much the work grows where they are joined: exactly, or at least.
  struct Pair {
    double more_ms = 0;
    std::size_t a = 0, b = 0;
    bool is_exact = false;
    auto operator<=>(const Pair&) const = default;
  };

  void add(Group group) {
    free_groups_ += group.free;
    shown_px_ += group.area_px;
    groups_.push_back(std::move(group));
  }

  void replace(std::size_t a, std::size_t b, Group joined) {
    for (const std::size_t i : {a, b}) {
      groups_[i].is_dead = true;
      --free_groups_;
      shown_px_ -= groups_[i].area_px;
    }
    add(std::move(joined));
  }

  Group joined(std::size_t a, std::size_t b) const {
    std::vector<int> pieces = groups_[a].pieces;
    pieces.insert(pieces.end(), groups_[b].pieces.begin(), groups_[b].pieces.end());
    return group_of(std::move(pieces));
  }

  bool is_behind(const std::vector<int>& pieces) const {
    return !data_.behind.empty() && data_.behind[pieces.front()];
  }

  bool have_no_order(const std::vector<int>& a, const std::vector<int>& b) const {
    if (is_behind(a) != is_behind(b)) return false;
    if (hidden_share(data_.depths, a, b) <= kHidden) return false;
    double mutual = 0, related = 0;
    for (const int one : a)
      for (const int other : b) {
        mutual = std::max<double>(mutual, data_.depths.mutual_frames(one, other));
        related = std::max<double>(related, data_.depths.related_frames(one, other));
      }
    return mutual >= kMutualShare * related;
  }

  /// Would something that each of the two has an order with lie between them?
  bool encloses_another(const std::vector<int>& both, std::size_t a, std::size_t b) const {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const Group& other = groups_[i];
      if (i == a || i == b || other.is_dead || hidden_share(data_.depths, both, other.pieces) <= kHidden)
        continue;
      if (hidden_share(data_.depths, groups_[a].pieces, other.pieces) <= kHidden &&
          hidden_share(data_.depths, groups_[b].pieces, other.pieces) <= kHidden)
        return true;
    }
    return false;
  }

  /// What lies before and behind each other at once, most of the time, would be merged all the same.
  std::vector<std::vector<int>> joined_bodies(const std::vector<std::vector<int>>& start) const {
    std::vector<std::size_t> root(start.size());
    std::iota(root.begin(), root.end(), 0);
    for (std::size_t i = 0; i < start.size(); ++i)
      for (std::size_t k = i + 1; k < start.size(); ++k)
        if (root[i] != root[k] && have_no_order(start[i], start[k]))
          std::replace(root.begin(), root.end(), std::max(root[i], root[k]), std::min(root[i], root[k]));
    std::vector<std::vector<int>> bodies(start.size());
    for (std::size_t i = 0; i < start.size(); ++i)
      bodies[root[i]].insert(bodies[root[i]].end(), start[i].begin(), start[i].end());
    std::erase_if(bodies, [](const std::vector<int>& body) { return body.empty(); });
    return bodies;
  }

  /// Puts a pair among those to look at, with a lower bound of what joining it costs.
  void consider(std::size_t a, std::size_t b) {
    const Group &one = groups_[a], &other = groups_[b];
    if (one.is_dead || other.is_dead || !one.free || !other.free) return;
    if (is_behind(one.pieces) != is_behind(other.pieces)) return;
    std::vector<double> renders(one.renders.size());
    std::vector<RectD> bounds(renders.size());
    for (std::size_t s = 0; s < renders.size(); ++s) {
      renders[s] = std::max(one.renders[s], other.renders[s]);
      bounds[s] = united(one.bounds[s], other.bounds[s]);
    }
    pairs_.push({work_ms(one.polygons + other.polygons, renders, bounds) - one.ms - other.ms, a, b, false});
  }

  bool too_many() const { return free_groups_ > static_cast<std::size_t>(options_.max_groups); }
  bool shows_too_much() const { return shown_px_ > most_shown_px_; }

  /// Is it mostly clear, and more so than its members?
  bool is_too_clear(const Group& group, const Group& a, const Group& b) const {
    const auto clear = [&](const Group& g) {
      const auto in_view = static_cast<double>(
          std::count_if(g.bounds.begin(), g.bounds.end(), [](const RectD& r) { return !r.empty(); }));
      return g.touched_px > 0 && in_view > 0 ? g.area_px / in_view / g.touched_px : 1.0;
    };
    return clear(group) > std::max({kMostClear, clear(a), clear(b)});
  }

  /// Looks at the best pair; false: nothing more is joined.
  bool join_next() {
    const Pair pair = pairs_.top();
    const bool forced = too_many() || (!options_.only_limit && shows_too_much());
    if (!forced && (options_.only_limit || pair.more_ms > free_ms_)) return false;
    pairs_.pop();
    const Group &a = groups_[pair.a], &b = groups_[pair.b];
    if (a.is_dead || b.is_dead) return true;
    Group group = joined(pair.a, pair.b);
    if (!pair.is_exact) {
      Pair exact{group.ms - a.ms - b.ms, pair.a, pair.b, true};
      // What is mostly clear, or would have to be merged with others, comes last, and only where there are too many.
      if (is_too_clear(group, a, b) || encloses_another(group.pieces, pair.a, pair.b))
        exact.more_ms += kLast_ms;
      pairs_.push(exact);
      return true;
    }
    if (!too_many() && pair.more_ms > free_ms_ && group.area_px >= a.area_px + b.area_px)
      return true;  // the compositor would gain nothing
    replace(pair.a, pair.b, std::move(group));
    for (std::size_t i = 0; i + 1 < groups_.size(); ++i) consider(i, groups_.size() - 1);
    return true;
  }

  static constexpr double kLast_ms = 1e15;

  const GroupingData& data_;
  GroupingOptions options_;
  std::vector<Group> groups_;
  std::size_t free_groups_ = 0;
  double shown_px_ = 0, most_shown_px_ = 0;  // added up over the instants
  double free_ms_ = 0;                       // a join may cost
  std::priority_queue<Pair, std::vector<Pair>, std::greater<>> pairs_;
};

}  // namespace

GroupWork work_of(const GroupingData& data, const std::vector<int>& pieces) {
  const Group group = Grouping(data, {}).group_of(pieces);
  GroupWork work{0, group.ms,
                 group.area_px / static_cast<double>(std::max<std::size_t>(1, data.motion.instants()))};
  bool is_seen = false;
  for (std::size_t s = 0; s < group.renders.size(); ++s) {
    work.renders += group.renders[s];
    is_seen = is_seen || !group.bounds[s].empty();
  }
  if (is_seen) work.renders = std::max(work.renders, 1.0);
  return work;
}

std::vector<std::vector<int>> grouped(const GroupingData& data, const GroupingOptions& options,
                                      const std::vector<std::vector<int>>& start) {
  return Grouping(data, options).run(start);
}

}  // namespace talisman::sequences
