// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "sequences/experiments/memory/measured.h"

namespace talisman::sequences {

namespace {

using regulator::LevelWant;
using regulator::LookaheadCull;
using regulator::MemoryFrame;
using regulator::PrefetchUnit;
using regulator::RangeCull;

constexpr double kBytesPerMb = 1e6;

/// What a frame of the walk asks for, now and ahead.
class WalkWants {
 public:
  WalkWants(const MemoryWalk& walk, const MemorySetting& setting)
      : walk_(walk),
        setting_(setting),
        ahead_(walk.things, walk.cells, setting.prefetch, regulator::kPixelsPerPolygon) {}

  std::vector<LevelWant> seen(int frame) const {
    const regulator::Observer who = observer_at(frame);
    std::vector<LevelWant> wants;
    for (const int thing : walk_.seen[frame]) wants.push_back(ahead_.drawn(thing, who));
    return wants;
  }

  std::vector<LevelWant> ahead(int frame) {
    if (!setting_.knows_motion) return ahead_.wants(observer_at(frame));
    std::vector<LevelWant> wants;
    const int last = std::min(frame + setting_.prefetch.frames, static_cast<int>(walk_.cameras.size()) - 1);
    for (int next = frame + 1; next <= last; ++next)
      for (LevelWant want : seen(next)) {
        want.soonest = next - frame;
        wants.push_back(want);
      }
    return wants;
  }
  int range_cells() const { return ahead_.range_cells(); }

 private:
  regulator::Observer observer_at(int frame) const {
    return regulator::observer(walk_.cameras[frame], walk_.display_px, setting_.prefetch, walk_.fps);
  }
  const MemoryWalk& walk_;
  const MemorySetting& setting_;
  regulator::Lookahead ahead_;
};

int items_of(const std::vector<LevelWant>& wants) {
  std::vector<int> items;
  for (const LevelWant& want : wants) items.push_back(want.item);
  std::sort(items.begin(), items.end());
  return static_cast<int>(std::unique(items.begin(), items.end()) - items.begin());
}

void add(MemoryResult& sum, const MemoryFrame& frame, int things, int range_cells) {
  sum.skipped += frame.skipped_levels;
  sum.skipped_most = std::max(sum.skipped_most, double(frame.skipped_levels));
  sum.skipped_things += frame.skipped_items;
  sum.range_cells += range_cells;
  sum.things += things;
  sum.things_most = std::max(sum.things_most, double(things));
  sum.wanted_mb += double(frame.wanted_bytes) / kBytesPerMb;
  sum.wasted_mb += double(frame.wasted_bytes) / kBytesPerMb;
  sum.resident_most_mb = std::max(sum.resident_most_mb, double(frame.resident_bytes) / kBytesPerMb);
}

/// One curve over all depths.
void add_group(std::vector<MemorySetting>& settings, const std::string& group, MemorySetting like) {
  like.group = group;
  for (const int frames : kPrefetchDepths) {
    like.prefetch.frames = frames;
    settings.push_back(like);
  }
}

}  // namespace

std::vector<MemorySetting> memory_settings(bool with_cells, const regulator::MemoryLimits& limits) {
  MemorySetting own, cell, direction, frugal, known;
  for (MemorySetting* setting : {&own, &cell, &direction, &frugal, &known}) setting->limits = limits;
  cell.prefetch.unit = PrefetchUnit::Cell;
  direction.prefetch.range = frugal.prefetch.range = RangeCull::Direction;
  frugal.prefetch.lookahead = LookaheadCull::Frustum;
  known.knows_motion = true;
  MemorySetting half = own, twice = own, all;
  half.limits.memory_mb /= 2, twice.limits.memory_mb *= 2;
  all.limits = {};
  std::vector<MemorySetting> settings;
  add_group(settings, "by object", own);
  if (with_cells) {
    add_group(settings, "by cell", cell);
    add_group(settings, "direction + any", direction);
    add_group(settings, "direction + frustum", frugal);
  }
  add_group(settings, "known motion", known);
  add_group(settings, "half the memory", half);
  add_group(settings, "twice the memory", twice);
  add_group(settings, "no limits", all);
  return settings;
}

MemoryResult walk_with(const MemoryWalk& walk, const MemorySetting& asked) {
  MemoryResult result{asked};
  result.setting.prefetch.speed_m_per_s = walk.speed_m_per_s;
  result.setting.prefetch.turn_deg_per_s = walk.turn_deg_per_s;
  const MemorySetting& setting = result.setting;
  WalkWants wants(walk, setting);
  regulator::LevelCache cache(walk.level_bytes, limit_bytes(setting.limits));
  const int frames = static_cast<int>(walk.cameras.size());
  cache.step(wants.seen(0), {}, regulator::kNoLimit_bytes);
  double read_bytes = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const std::vector<LevelWant> seen = wants.seen(frame), ahead = wants.ahead(frame);
    const MemoryFrame report = cache.step(seen, ahead, frame_bytes(setting.limits, walk.fps, frame));
    add(result, report, items_of(ahead), wants.range_cells());
    read_bytes += double(report.read_bytes);
  }
  result.read_mb = read_bytes / kBytesPerMb;
  for (double* mean :
       {&result.skipped, &result.skipped_things, &result.range_cells, &result.things, &result.wanted_mb})
    *mean /= std::max(frames, 1);
  return result;
}

MemoryExperiment measure_memory(const Sequence& sequence, const Settings& settings,
                                const ExperimentFrames& frames, const regulator::MemoryLimits& limits,
                                ProgressKind progress) {
  const MemoryWalk walk = walk_of(sequence, settings, frames);
  MemoryExperiment experiment{sequence.name, settings.view.display_px, frames, limits};
  experiment.total_mb = double(walk.bytes) / kBytesPerMb;
  experiment.polygons = walk.polygons;
  experiment.things = static_cast<int>(walk.things.size());
  experiment.cells = walk.cells ? static_cast<int>(walk.cells->cells.size()) : 0;
  experiment.speed_m_per_s = walk.speed_m_per_s, experiment.turn_deg_per_s = walk.turn_deg_per_s;
  for (const std::vector<int>& seen : walk.seen) experiment.seen += double(seen.size());
  experiment.seen /= double(std::max<std::size_t>(walk.seen.size(), 1));
  MemorySetting now;
  now.limits = {};
  experiment.seen_mb = walk_with(walk, now).wanted_mb;
  const std::vector<MemorySetting> tried = memory_settings(experiment.cells > 0, limits);
  Progress bar(progress, "settings", static_cast<int>(tried.size()));
  for (const MemorySetting& setting : tried) {
    experiment.results.push_back(walk_with(walk, setting));
    bar.advance();
  }
  return experiment;
}

std::vector<double> skipped_over_depths(const MemoryExperiment& experiment, const std::string& group) {
  std::vector<double> skipped;
  for (const MemoryResult& result : experiment.results)
    if (result.setting.group == group) skipped.push_back(result.skipped);
  return skipped;
}

}  // namespace talisman::sequences
