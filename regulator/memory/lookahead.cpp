// SPDX-License-Identifier: Apache-2.0
#include "regulator/memory/lookahead.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::regulator {

double pixels_of(const Ball& ball, double distance_m, const Observer& observer) {
  if (!(distance_m > ball.radius_m)) return observer.display_px2;
  const double radius_px = ball.radius_m * observer.focal_px / distance_m;
  return std::min(M_PI * radius_px * radius_px, observer.display_px2);
}

int level_for(const StoredThing& thing, double pixels, double px_per_polygon) {
  int level = static_cast<int>(thing.polygons.size()) - 1;
  while (level > 0 && pixels < px_per_polygon * static_cast<double>(thing.polygons[level])) --level;
  return level;
}

/// The wants of one frame.
class Lookahead::Search {
 public:
  Search(Lookahead& of, const Observer& observer) : of_(of), observer_(observer) {
    of_.level_.assign(of_.things_.size(), -1);
    of_.things_wanted_ = of_.range_cells_ = 0;
  }

  /// No more than so near, seen after so many frames.
  void want(int thing, double distance_m, int soonest) {
    const int level = level_for(of_.things_[thing], pixels_of(of_.balls_[thing], distance_m, observer_),
                                of_.px_per_polygon_);
    if (level <= of_.level_[thing]) return;
    of_.things_wanted_ += of_.level_[thing] < 0;
    of_.level_[thing] = level;
    wants_.push_back({of_.things_[thing].item, level, soonest});
  }

  double distance_after(int thing, double frames) const {
    return glm::distance(of_.balls_[thing].middle, observer_.eye) - frames * observer_.step_m;
  }

  void want_seen_from(const RangeCell& from) {
    const int soonest = std::max(1, static_cast<int>(std::ceil(from.frames)));
    const layers::Box3& here = of_.stab_->box_of_cell(from.cell);
    for (const StabEntry& entry : of_.stab_->seen_from(from.cell)) {
      if (!passes(of_.options_.lookahead, of_.stab_->box_of_cell(entry.cell), observer_)) continue;
      const bool whole = of_.options_.unit == PrefetchUnit::Cell;
      for (const int thing : whole ? of_.stab_->things_in(entry.cell) : entry.things)
        want(thing, std::max(gap(here, of_.balls_[thing].middle), distance_after(thing, of_.options_.frames)),
             soonest);
    }
  }

  void want_in_reach(std::span<const int> things) {
    std::vector<std::pair<int, int>> by_time;
    for (const int thing : things) {
      const int frames = frames_until_in_view(of_.balls_[thing], observer_, of_.options_.frames);
      if (frames <= of_.options_.frames && passes(of_.options_.lookahead, of_.things_[thing].box, observer_))
        by_time.push_back({std::max(1, frames), thing});
    }
    std::sort(by_time.begin(), by_time.end());
    for (const auto& [frames, thing] : by_time)
      want(thing, distance_after(thing, of_.options_.frames), frames);
  }

  std::vector<LevelWant> take() { return std::move(wants_); }

 private:
  Lookahead& of_;
  const Observer& observer_;
  std::vector<LevelWant> wants_;
};

Lookahead::Lookahead(std::vector<StoredThing> things, std::shared_ptr<const layers::CellSet> set,
                     const PrefetchOptions& options, double px_per_polygon)
    : things_(std::move(things)), set_(std::move(set)), options_(options), px_per_polygon_(px_per_polygon) {
  std::vector<layers::Box3> boxes;
  for (const StoredThing& thing : things_) {
    boxes.push_back(thing.box);
    balls_.push_back(ball_around(thing.box));
  }
  if (set_ && !set_->cells.empty()) stab_.emplace(set_, boxes);
}

std::vector<LevelWant> Lookahead::wants(const Observer& observer) {
  Search search(*this, observer);
  if (options_.frames == 0) return search.take();
  const std::vector<int> around = stab_ ? cells_around(stab_->set(), observer.eye, 0) : std::vector<int>{};
  if (around.empty()) {
    std::vector<int> all;
    for (std::size_t i = 0; i < things_.size(); ++i)
      if (!things_[i].box.empty()) all.push_back(static_cast<int>(i));
    search.want_in_reach(all);
    return search.take();
  }
  for (const RangeCell& cell :
       regulator::range_cells(stab_->set(), stab_->portals_of(), around, observer, options_)) {
    search.want_seen_from(cell);
    ++range_cells_;
  }
  search.want_in_reach(stab_->outside());
  std::vector<LevelWant> wants = search.take();
  std::stable_sort(wants.begin(), wants.end(),
                   [](const LevelWant& a, const LevelWant& b) { return a.soonest < b.soonest; });
  return wants;
}

LevelWant Lookahead::drawn(int thing, const Observer& observer) const {
  const double distance = glm::distance(balls_[thing].middle, observer.eye);
  return {things_[thing].item,
          level_for(things_[thing], pixels_of(balls_[thing], distance, observer), px_per_polygon_), 0};
}

}  // namespace talisman::regulator
