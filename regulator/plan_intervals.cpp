// SPDX-License-Identifier: Apache-2.0
#include "regulator/plan_intervals.h"

#include <algorithm>
#include <limits>

#include "layers/check.h"

namespace talisman::regulator {

namespace {

/// One number for each interval a … b - 1 of 0 … frames - 1.
class IntervalTable {
 public:
  explicit IntervalTable(int frames) : side_(frames + 1), values_(static_cast<std::size_t>(side_) * side_) {}
  std::int64_t& at(int a, int b) { return values_[static_cast<std::size_t>(a) * side_ + b]; }
  std::int64_t at(int a, int b) const { return values_[static_cast<std::size_t>(a) * side_ + b]; }

 private:
  int side_;
  std::vector<std::int64_t> values_;
};

/// R(a, b).
IntervalTable rests_by_weight(int frames, std::span<const MotionWord> words,
                              std::span<const std::int64_t> weights) {
  IntervalTable rests(frames);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::int64_t weight = weights.empty() ? 1 : weights[i];
    int change = frames;  // the first one after a
    for (int a = frames - 1; a >= 0; --a) {
      rests.at(a, change) += weight;
      if (words[i].changes_at(a)) change = a;
    }
  }
  for (int a = 0; a < frames; ++a)  // what rests up to b rests up to all before
    for (int b = frames - 1; b > a; --b) rests.at(a, b) += rests.at(a, b + 1);
  return rests;
}

/// The cheapest cuts of all intervals, level by level.
class Cuts {
 public:
  Cuts(int frames, int levels, IntervalTable rests)
      : frames_(frames),
        rests_(std::move(rests)),
        below_(static_cast<std::size_t>(std::max(levels - 1, 0)), IntervalTable(frames)) {
    const std::int64_t all = rests_.at(0, 1);
    for (int level = levels - 2; level >= 0; --level)
      for (int a = 0; a < frames_; ++a)
        for (int b = a + 1; b <= frames_; ++b)
          below_[level].at(a, b) =
              level == levels - 2 ? (b - a) * (all - rests_.at(a, b)) : cut(level, a, b).cost;
  }

  /// Ends of the intervals of the next level within a … b - 1 of `level`; every frame where that is the last but one.
  std::vector<int> ends(int level, int a, int b) const {
    std::vector<int> ends;
    if (level + 2 > static_cast<int>(below_.size())) {
      for (int frame = a; frame < b; ++frame) ends.push_back(frame + 1);
      return ends;
    }
    const Path path = cut(level, a, b);
    for (int end = b; end > a; end = a + path.before[end - a]) ends.push_back(end);
    std::reverse(ends.begin(), ends.end());
    return ends;
  }

 private:
  struct Path {
    std::int64_t cost = 0;
    std::vector<int> before;  ///< by end - a: where the interval with that end begins, less a
  };

  Path cut(int level, int a, int b) const {
    const std::int64_t above = rests_.at(a, b);
    const IntervalTable& next = below_[level + 1];
    std::vector<std::int64_t> least(b - a + 1, std::numeric_limits<std::int64_t>::max());
    Path path{0, std::vector<int>(b - a + 1, 0)};
    least[0] = 0;
    for (int end = a + 1; end <= b; ++end)
      for (int begin = a; begin < end; ++begin) {
        const std::int64_t cost = least[begin - a] + rests_.at(begin, end) - above + next.at(begin, end);
        if (cost >= least[end - a]) continue;
        least[end - a] = cost;
        path.before[end - a] = begin - a;
      }
    path.cost = least[b - a];
    return path;
  }

  int frames_;
  IntervalTable rests_;
  std::vector<IntervalTable> below_;  ///< by level: drawings below an interval of it
};

}  // namespace

std::string_view name(Intervals intervals) { return intervals == Intervals::Fixed ? "fixed" : "data"; }

PlanIntervals::PlanIntervals(const PlanShape& shape) : frames_(shape.frames) {
  for (int level = 0, width = shape.frames; level < shape.levels(); ++level, width /= shape.children) {
    std::vector<int>&first = firsts_.emplace_back(), &end = ends_.emplace_back();
    for (int frame = 0; frame < frames_; ++frame) {
      first.push_back(frame - frame % width);
      end.push_back(first.back() + width);
    }
  }
}

PlannedDraw PlanIntervals::draw_shown(const MotionWord& word, int frame) const {
  for (int level = 0; level + 1 < levels(); ++level) {
    const int a = first(level, frame), b = end(level, frame);
    if (word.rests_over(a + 1, b - 1)) return {a, level, b - a};
  }
  return {frame, levels() - 1, 1};
}

std::vector<PlannedDraw> PlanIntervals::planned_draws(const MotionWord& word) const {
  std::vector<PlannedDraw> draws;
  for (int frame = 0; frame < frames_; frame += draws.back().frames) draws.push_back(draw_shown(word, frame));
  return draws;
}

PlanIntervals fitted_intervals(const PlanShape& shape, std::span<const MotionWord> words,
                               std::span<const std::int64_t> weights) {
  TALISMAN_CHECK_LE(shape.frames, kLongestCut_frames);
  PlanIntervals fitted(shape);
  const int levels = shape.levels(), frames = shape.frames;
  if (levels < 3 || words.empty()) return fitted;  // there is nothing to choose
  const Cuts cuts(frames, levels, rests_by_weight(frames, words, weights));
  for (int level = 0; level + 2 < levels; ++level)
    for (int a = 0; a < frames; a = fitted.end(level, a)) {
      int begin = a;
      for (const int end : cuts.ends(level, a, fitted.end(level, a))) {
        for (int frame = begin; frame < end; ++frame) {
          fitted.firsts_[level + 1][frame] = begin;
          fitted.ends_[level + 1][frame] = end;
        }
        begin = end;
      }
    }
  return fitted;
}

}  // namespace talisman::regulator
