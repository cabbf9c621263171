// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/tuning/search.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "sequences/experiments/tuning/layer_moves.h"

namespace talisman::sequences {

namespace {

/// Of the frames that may be drawn: until when settings are tried one after the other, and what stays for the
/// layers' own thresholds.
constexpr int kRendersOfTrying = 5, kRendersOfCommon = 7;

/// The measure of pictures where the goal is none of theirs.
TuneGoal picture_goal(const TuneGoal& goal) {
  return goal.is_of_pictures() ? goal : TuneGoal{GoalKind::Flip, 1, false};
}

class Search {
 public:
  Search(const Sequence& sequence, const Settings& settings, const std::string& folder, ProgressKind progress,
         TuneReport& report, const std::atomic<bool>& stop)
      : sequence_(sequence),
        settings_(settings),
        report_(report),
        stop_(stop),
        progress_(progress),
        probe_(sequence, settings, report.range, picture_goal(report.goal), folder,
               {kMostFullRenders * report.frames(), &stop}) {}

  void run() {
    plan_grid();
    if (stop_) return;
    report_.goal.is_of_pictures() ? find_common_of_pictures() : find_common_of_time();
    if (report_.common && report_.common->holds && !stop_) find_per_layer();
    report_.frames_drawn = probe_.frames_drawn();
  }

 private:
  bool fits_time(const PlannedThresholds& plan) const { return report_.goal.holds(plan.frame_ms); }

  void plan_grid() {
    Settings reference = settings_;
    reference.regulator.policy = regulator::Policy::Reference;
    report_.reference_ms = plan_of(sequence_, reference, report_.range, {}).cost_ms;
    Progress progress(progress_, "planned", kTunedGrid);
    for (const double px : tuned_grid()) {
      if (stop_) return;
      report_.curve.push_back(
          {plan_of(sequence_, settings_, report_.range, {px, report_.given_weights}), {}});
      progress.advance();
    }
    order_.resize(report_.curve.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return cost(a) < cost(b); });
  }

  double cost(int index) const { return report_.curve[index].plan.cost_ms; }
  TunePoint& point(int place) { return report_.curve[order_[place]]; }
  int frames_of(int renders) const { return renders * report_.frames(); }

  /// What is drawn at the same times looks the same: it is measured once.
  Verdict measured(TunePoint& point) {
    if (point.quality.verdict != Verdict::Unknown) return point.quality.verdict;
    for (const TunePoint& other : report_.curve)
      if (other.plan.decisions == point.plan.decisions && other.quality.verdict == Verdict::Fails)
        point.quality = other.quality;
    if (point.quality.verdict == Verdict::Unknown) point.quality = probe_.probe(point.plan, true);
    return point.quality.verdict;
  }

  void answer(TunePoint& point) { report_.common = TuneAnswer{point, true}; }

  /// From the cheapest on, until one holds.
  void find_common_of_pictures() {
    int failed = -1;
    if (!report_.goal.of_mean) {
      Progress progress(progress_, "tried", static_cast<int>(order_.size()));
      for (int place = 0; place < static_cast<int>(order_.size()) && !stop_; ++place) {
        if (probe_.frames_drawn() > frames_of(kRendersOfTrying)) break;
        const Verdict verdict = measured(point(place));
        if (verdict == Verdict::Holds) return answer(point(place));
        if (verdict == Verdict::Fails) failed = place;
        progress.advance();
      }
    }
    if (!stop_) halve(failed);
  }

  /// Between one that failed and the dearest.
  void halve(int failed) {
    int holds = static_cast<int>(order_.size());  // behind the last: nothing is known to hold
    Progress progress(progress_, "halved", kMostHalvings);
    while (holds - failed > 1 && !stop_ &&
           probe_.frames_left() > frames_of(kMostFullRenders - kRendersOfCommon)) {
      const int middle = (failed + holds) / 2;
      (measured(point(middle)) == Verdict::Holds ? holds : failed) = middle;
      progress.advance();
    }
    if (stop_) return;
    if (holds < static_cast<int>(order_.size())) return answer(point(holds));
    finest();
  }

  /// Nothing that was tried holds: what reuses only what is identical does, or nothing does.
  void finest() {
    TunePoint& last = report_.curve.front();
    last.quality = probe_.probe(last.plan, false);
    report_.common = TuneAnswer{last, last.quality.verdict == Verdict::Holds};
  }

  /// The finest that fits; where none does, the one that comes nearest.
  void find_common_of_time() {
    std::size_t best = 0;
    const auto badness = [&](std::size_t k) {
      const std::vector<double>& ms = report_.curve[k].plan.frame_ms;
      return report_.goal.of_mean ? mean_of(ms) : worst_of(ms);
    };
    for (std::size_t k = 1; k < report_.curve.size() && !fits_time(report_.curve[best].plan); ++k)
      if (badness(k) < badness(best)) best = k;
    TunePoint& found = report_.curve[best];
    found.quality = probe_.probe(found.plan, false);
    if (!stop_) report_.common = TuneAnswer{found, fits_time(found.plan)};
  }

  /// Does the move hold, and of what quality is it?
  bool holds(const PlannedThresholds& plan, ProbedQuality& quality) {
    if (!report_.goal.is_of_pictures()) return fits_time(plan);
    quality = probe_.probe(plan, true);
    return quality.verdict == Verdict::Holds;
  }

  /// The first of the neighbours that holds becomes `here`.
  bool move(TunePoint& here, MoveTowards towards, Progress& progress) {
    for (const PlannedThresholds& plan :
         layer_moves(sequence_, settings_, report_.range, towards, here.plan)) {
      if (stop_ || tried_ == kMostLayerMoves || probe_.frames_left() < kLeastToGoOn) return false;
      if (!refused_.insert(plan.decisions).second) continue;
      ++tried_;
      progress.advance();
      ProbedQuality quality;
      if (!holds(plan, quality)) continue;
      here = {plan, quality};
      return true;
    }
    return false;
  }

  void find_per_layer() {
    const bool is_looser = report_.goal.is_of_pictures();
    TunePoint here = report_.common->point;
    Progress progress(progress_, "layers tried", kMostLayerMoves);
    bool has_moved = false;
    while (move(here, is_looser ? MoveTowards::Looser : MoveTowards::Stricter, progress)) has_moved = true;
    if (!has_moved) return;
    if (!is_looser) here.quality = probe_.probe(here.plan, false);
    if (here.quality.is_whole()) report_.per_layer = TuneAnswer{here, true};
  }

  static constexpr int kMostHalvings = 6, kMostLayerMoves = 40, kLeastToGoOn = 4;

  const Sequence& sequence_;
  const Settings& settings_;
  TuneReport& report_;
  const std::atomic<bool>& stop_;
  ProgressKind progress_;
  QualityProbe probe_;
  std::vector<int> order_;           ///< of the curve, by cost
  int tried_ = 0;                    ///< thresholds of layers
  std::set<std::uint64_t> refused_;  ///< decisions that were tried among these
};

}  // namespace

TuneReport tune(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                const TuneGoal& goal, const std::string& folder, ProgressKind progress,
                const std::atomic<bool>& stop) {
  TuneReport report;
  report.sequence = sequence.name;
  report.file = sequence.file;
  report.display_px = settings.view.display_px;
  report.range = range;
  report.policy = regulator::name(settings.regulator.policy);
  report.goal = goal;
  for (const layers::LayerSpec& spec : sequence.layer_specs) {
    report.layers.push_back(spec.name);
    report.given_weights.push_back(spec.preferences.importance.geometric);
  }
  Search(sequence, settings, folder, progress, report, stop).run();
  report.is_stopped = stop;
  return report;
}

}  // namespace talisman::sequences
