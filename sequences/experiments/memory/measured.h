// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far ahead is best read what may be seen? `talisman accuracy --memory SEQUENCE`, as [Fu93 5.2.5].
///
/// A walk (walk.h) with some memory for descriptions and some bandwidth to bring them, those of [Fu93] unless others are asked for, over
///
///   N           1, 4, 8, 16, 32, 64 frames ahead, by object and by cell, and with culls of where the eye may come to and of
///               what it may see there
///   known       the same N with the walk itself known ahead: what nobody can do better than by looking
///   memory      half and double of it, and room for all with no limit of reading
///
/// The quality is *levels skipped* in a frame: how much coarser than asked for the things are that are drawn. The walk begins with
/// what its first frame asks for already read, coarse levels first, as far as there is room. All times are simulated.

#include <cstdint>
#include <string>
#include <vector>

#include "regulator/memory/prefetch_options.h"
#include "sequences/content/sequence.h"
#include "sequences/experiments/memory/walk.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

inline constexpr double kMemory_mb = 12, kIo_mb_per_s = 0.45;
inline constexpr const char* kDisplayOfFu93 = "1280x1024";
inline constexpr int kPrefetchDepths[] = {1, 4, 8, 16, 32, 64};

struct MemorySetting {
  std::string group;  ///< "by object", "known motion": a curve
  regulator::PrefetchOptions prefetch;
  regulator::MemoryLimits limits{kMemory_mb, kIo_mb_per_s};
  bool knows_motion = false;
};

struct MemoryResult {
  MemorySetting setting;
  double skipped = 0, skipped_most = 0;  ///< levels in a frame: mean, most
  double skipped_things = 0;             ///< that were not drawn at all, mean
  double range_cells = 0;                ///< mean
  double things = 0, things_most = 0;    ///< looked ahead to: mean, most
  double wanted_mb = 0;                  ///< of all that is wanted in a frame, mean
  double read_mb = 0, wasted_mb = 0;     ///< over the walk; of it, what went without having been drawn
  double resident_most_mb = 0;
};

struct MemoryExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  regulator::MemoryLimits limits;
  double seen = 0, seen_mb = 0;  ///< things in a frame, and what they ask for: mean
  double total_mb = 0, speed_m_per_s = 0, turn_deg_per_s = 0;
  std::int64_t polygons = 0;
  int things = 0, cells = 0;
  std::vector<MemoryResult> results{};
};

/// All that is tried, of a sequence with cells or without.
std::vector<MemorySetting> memory_settings(bool with_cells, const regulator::MemoryLimits& limits = {
                                                                kMemory_mb, kIo_mb_per_s});
MemoryResult walk_with(const MemoryWalk& walk, const MemorySetting& setting);
MemoryExperiment measure_memory(const Sequence& sequence, const Settings& settings,
                                const ExperimentFrames& frames, const regulator::MemoryLimits& limits,
                                ProgressKind progress);

/// The levels skipped of a group, over the depths; empty: it is not there.
std::vector<double> skipped_over_depths(const MemoryExperiment& experiment, const std::string& group);

/// memory.csv, memory.json, and plots of levels skipped and of bytes read over N; what is printed and memory.html (published.h).
void write_report(const MemoryExperiment& experiment, const std::string& dir);
Page page_of(const MemoryExperiment& experiment);

}  // namespace talisman::sequences
