// SPDX-License-Identifier: Apache-2.0
// Walks with little memory, and what [Fu93] is judged by.
#include "sequences/experiments/memory/measured.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "sequences/content/own_settings.h"
#include "sequences/content/sequence.h"
#include "sequences/experiments/reproduction/funkhouser/culling_93.h"
#include "sequences/experiments/reproduction/funkhouser/memory_93.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;

TEST(MemoryWalk, LevelsHaveAQuarterOfThePolygonsOfTheOneAbove) {
  EXPECT_EQ(ladder_of(20), (std::vector<std::int64_t>{20}));
  EXPECT_EQ(ladder_of(21), (std::vector<std::int64_t>{5, 21}));
  EXPECT_EQ(ladder_of(1312), (std::vector<std::int64_t>{20, 82, 328, 1312}));
  EXPECT_EQ(ladder_of(0), (std::vector<std::int64_t>{0}));
}

/// Along a row of twelve rooms of 4 m with doors, 0.2 m a frame, eyes ahead; `things` of them in each.
MemoryWalk walk_along_rooms(int things) {
  MemoryWalk walk;
  auto set = std::make_shared<layers::CellSet>();
  for (int i = 0; i < 12; ++i)
    set->cells.push_back({"room " + std::to_string(i), {4.0 * i, 0, 0}, {4.0 * i + 4, 3, 4}});
  for (int i = 1; i < 12; ++i) {
    const double x = 4.0 * i;
    set->portals.push_back({{i - 1, i}, {{x, 0, 1.5}, {x, 2, 1.5}, {x, 2, 2.5}, {x, 0, 2.5}}});
  }
  std::mt19937 lot(3);
  const auto within = [&lot](double low, double high) { return low + (high - low) * (lot() / 4294967296.0); };
  for (int i = 0; i < 12 * things; ++i) {
    const dvec3 lo(4.0 * (i / things) + within(0.2, 3.2), 0, within(0.2, 3.2));
    const int item = static_cast<int>(walk.things.size());
    walk.things.push_back({layers::box_of(lo, lo + dvec3(0.6)), item, ladder_of(400)});
    walk.level_bytes.push_back({4'000, 16'000, 63'000});
    for (const std::int64_t bytes : walk.level_bytes.back()) walk.bytes += bytes;
  }
  walk.display_px = {1280, 1024}, walk.fps = 10;
  walk.speed_m_per_s = 2.01, walk.turn_deg_per_s = 1;
  for (int frame = 0; frame < 200; ++frame) {
    layers::CameraState camera{layers::dmat4(1), 1, 0.05, 100};
    camera.world_from_camera[0] = {0, 0, 1, 0}, camera.world_from_camera[2] = {-1, 0, 0, 0};  // along +x
    camera.world_from_camera[3] = {1 + 0.2 * frame, 1.6, 2, 1};
    walk.cameras.push_back(camera);
    std::vector<int>& seen = walk.seen.emplace_back();  // those of its room and the next that lie ahead
    for (int i = 0; i < static_cast<int>(walk.things.size()); ++i) {
      const double ahead_m = walk.things[i].box.hi[0] - camera.world_from_camera[3].x;
      if (ahead_m > 0 && ahead_m < 6) seen.push_back(i);
    }
  }
  walk.cells = std::move(set);
  return walk;
}

TEST(MemoryExperiment, WithoutLimitsNothingIsSkippedAndEachByteIsReadOnce) {
  const MemoryWalk walk = walk_along_rooms(10);
  for (const MemorySetting& setting : memory_settings(true)) {
    if (setting.group != "no limits") continue;
    const MemoryResult result = walk_with(walk, setting);
    EXPECT_EQ(result.skipped_most, 0);
    EXPECT_LE(result.read_mb, 1e-6 * double(walk.bytes));
    EXPECT_EQ(result.wasted_mb, 0);
  }
}

TEST(MemoryExperiment, NoSettingHoldsOrReadsMoreThanItMay) {
  const MemoryWalk walk = walk_along_rooms(40);
  for (MemorySetting setting : memory_settings(true)) {
    if (setting.group == "no limits") continue;
    setting.limits.memory_mb /= 4;
    const MemoryResult result = walk_with(walk, setting);
    EXPECT_LE(result.resident_most_mb, setting.limits.memory_mb) << setting.group;
    EXPECT_LE(result.read_mb, 20 * setting.limits.io_mb_per_s + 1e-9) << setting.group;
    EXPECT_LE(result.wasted_mb, result.read_mb + setting.limits.memory_mb) << setting.group;
    EXPECT_GE(result.skipped_most, result.skipped);
  }
}

TEST(MemoryExperiment, KnowingTheWalkSkipsLessThanKnowingItsBounds) {
  const MemoryWalk walk = walk_along_rooms(20);
  MemorySetting bounds, known;
  bounds.prefetch.frames = known.prefetch.frames = 16;
  known.knows_motion = true;
  const MemoryResult blind = walk_with(walk, {}), ahead = walk_with(walk, known);
  EXPECT_GT(blind.skipped, 0) << "nothing is looked ahead to";
  EXPECT_LT(ahead.skipped, walk_with(walk, bounds).skipped);
  EXPECT_LT(ahead.skipped, blind.skipped);
  EXPECT_EQ(ahead.range_cells, 0);
}

TEST(MemoryExperiment, WithoutCellsThereAreNoSettingsOfCells) {
  for (const MemorySetting& setting : memory_settings(false)) {
    EXPECT_EQ(setting.prefetch.unit, regulator::PrefetchUnit::Object);
    EXPECT_EQ(setting.prefetch.range, regulator::RangeCull::Any);
  }
  EXPECT_GT(memory_settings(true).size(), memory_settings(false).size());
  MemoryWalk walk = walk_along_rooms(3);
  walk.cells = nullptr;
  MemorySetting setting;
  setting.limits = {}, setting.prefetch.frames = 8;
  EXPECT_EQ(walk_with(walk, setting).skipped, 0);
}

// --- [Fu93] ---

/// By `group`, over the depths, on a shipped walk with the display of the paper.
std::vector<MemoryResult> on_the_walk(const char* file, std::initializer_list<const char*> groups) {
  const Sequence sequence = load_sequence(std::string(TALISMAN_SOURCE_DIR "/sequences/hall/") + file);
  Settings settings = own_settings(sequence);
  settings.cells = sequence.cells;
  settings.view.display_px = {1280, 1024};
  const MemoryWalk walk = walk_of(sequence, settings, {0, sequence.frames - 1, 1});
  std::vector<MemoryResult> results;
  for (const char* group : groups)
    for (const MemorySetting& setting : memory_settings(true))
      if (setting.group == group) results.push_back(walk_with(walk, setting));
  return results;
}

TEST(Funkhouser93, LevelsSkippedOnTheWalkAreAValley) {
  std::vector<double> skipped;
  for (const MemoryResult& result : on_the_walk("walk.yaml", {"by object"})) {
    skipped.push_back(result.skipped);
    EXPECT_LE(result.resident_most_mb, kMemory_mb);
  }
  const Finding finding = depth_finding_93(skipped);
  EXPECT_TRUE(finding.same) << finding.ours;
}

TEST(Funkhouser93, TheSharpTurnCostsThreeTimesAsMuchWithDirectionAndFrustum) {
  const auto results = on_the_walk("turn.yaml", {"by object", "direction + frustum"});
  ASSERT_EQ(results.size(), 12u);
  for (int depth = 0; depth < 6; ++depth) {
    const Finding finding = turn_finding_93(results[depth].skipped, results[6 + depth].skipped);
    EXPECT_TRUE(finding.same) << kPrefetchDepths[depth] << ": " << finding.ours;
  }
}

TEST(Funkhouser93, TheDepthHasToBeAValley) {
  EXPECT_TRUE(depth_finding_93({1.20, 1.07, 0.90, 0.79, 1.42, 2.29}).same) << "the paper's own";
  EXPECT_FALSE(depth_finding_93({0.79, 0.90, 1.07, 1.20, 1.42, 2.29}).same) << "least at the near end";
  EXPECT_FALSE(depth_finding_93({2.29, 1.42, 1.20, 1.07, 0.90, 0.79}).same) << "at the far end";
  EXPECT_FALSE(depth_finding_93({0.90, 0.85, 0.80, 0.79, 1.42, 2.29}).same) << "hardly worse without looking";
  EXPECT_FALSE(depth_finding_93({1.20, 1.07, 0.90, 0.79, 0.85, 0.90}).same) << "nor with looking far";
}

TEST(Funkhouser93, TheTurnHasToCostThreeTimesAsMuch) {
  EXPECT_TRUE(turn_finding_93(19, 57).same);
  EXPECT_FALSE(turn_finding_93(19.1, 57).same);
  EXPECT_FALSE(turn_finding_93(0, 0).same) << "nothing was skipped at all";
}

TEST(Funkhouser93, EachWayHasToLeaveLess) {
  EXPECT_TRUE(order_finding_93({0.156, 0.0328, 0.0106, 0.0055}).same);
  EXPECT_FALSE(order_finding_93({0.156, 0.0100, 0.0106, 0.0055}).same);
  EXPECT_FALSE(order_finding_93({0.156, 0.0328, 0.0106, 0.0106}).same);
  EXPECT_FALSE(order_finding_93({0.156, 0.0328, 0.0106, 0}).same) << "nothing was seen";
}

TEST(Funkhouser93, LongerQueuesHaveToAnswerLater) {
  EXPECT_TRUE(queue_finding_93({0.123, 0.291}, {0.122, 0.544}, {0.122, 1.158}).same) << "the paper's own";
  EXPECT_FALSE(queue_finding_93({0.123, 0.544}, {0.122, 0.291}, {0.122, 1.158}).same);
  EXPECT_FALSE(queue_finding_93({0.123, 0.291}, {0.122, 0.4}, {0.122, 0.5}).same) << "hardly later";
  EXPECT_FALSE(queue_finding_93({0.123, 0.291}, {0.122, 0.544}, {0.09, 1.158}).same) << "and much faster";
}

TEST(Funkhouser93, AQueueThatIsFullAnswersAfterAllThatIsInIt) {
  const std::vector<double> fast(500, 0.01), slow(500, 0.1);
  for (const int depth : {1, 4, 16}) {
    const QueueTimes full = queue_times(fast, slow, depth);
    EXPECT_NEAR(full.frame_s, 0.1, 1e-3) << "the slower stage sets it";
    EXPECT_NEAR(full.response_s, 0.1 * (depth + 1), 1e-3 + 2e-4 * depth * depth)
        << depth << ", until it is full";
    EXPECT_NEAR(queue_times(slow, fast, depth).response_s, 0.11, 1e-9)
        << "nothing waits before the faster stage";
  }
  const QueueTimes none = queue_times(fast, slow, 0);
  EXPECT_NEAR(none.frame_s, 0.11, 1e-9) << "one after the other";
  EXPECT_NEAR(none.response_s, 0.11, 1e-9);
  EXPECT_EQ(queue_times({}, {}, 4).response_s, 0);
}

}  // namespace
}  // namespace talisman::sequences
