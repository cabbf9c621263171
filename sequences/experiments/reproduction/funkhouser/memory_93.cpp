// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/funkhouser/memory_93.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "sequences/experiments/memory/measured.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using regulator::LookaheadCull;
using regulator::PrefetchUnit;
using regulator::RangeCull;

constexpr const char* kWalk93 = "hall/walk";
constexpr const char* kTurn93 = "hall/turn";
constexpr layers::ivec2 kDisplay93_px{1280, 1024};

const MemoryWalk& walk_93(PaperBench& bench, const char* name) {
  return bench.once(std::string("Fu93 walk ") + name, [&bench, name] {
    const OpenSequence& open = bench.sequence(name);
    Settings settings = open.settings;
    settings.view.display_px = kDisplay93_px;
    settings.cells = open.sequence.cells;
    return walk_of(open.sequence, settings, {0, open.sequence.frames - 1, 1});
  });
}

/// One curve of `accuracy --memory`, over the depths.
const std::vector<MemoryResult>& curve_93(PaperBench& bench, const char* name, const std::string& group) {
  return bench.once("Fu93 memory " + group + " " + name, [&] {
    std::vector<MemoryResult> results;
    for (const MemorySetting& setting : memory_settings(true))
      if (setting.group == group) results.push_back(walk_with(walk_93(bench, name), setting));
    return results;
  });
}

std::vector<double> skipped_93(PaperBench& bench, const char* name, const std::string& group) {
  std::vector<double> skipped;
  for (const MemoryResult& result : curve_93(bench, name, group)) skipped.push_back(result.skipped);
  return skipped;
}

std::string levels_in_words(const std::vector<double>& skipped) {
  std::string text;
  for (const double levels : skipped) text += (text.empty() ? "" : " ") + fixed(levels, 2);
  return text;
}

Claim depth_claim() {
  Claim claim{"depth", "1.20 1.07 0.90 0.79 1.42 2.29 levels skipped with N = 1, 4, 8, 16, 32, 64",
              "least with N of 8 or 16, both ends at least 1.2 times that",
              [](PaperBench& bench) { return depth_finding_93(skipped_93(bench, kWalk93, "by object")); }};
  claim.must = true;
  return claim;
}

Claim cell_claim() {
  return {"cell",
          "by cell 0.063 to 0.187 s of reading a frame and not 0.034 to 0.105, and 3.97 levels skipped with "
          "N = 64",
          "more is asked for at each N, and more is skipped with N = 64", [](PaperBench& bench) {
            const auto &object = curve_93(bench, kWalk93, "by object"),
                       &cell = curve_93(bench, kWalk93, "by cell");
            bool asks_more = true;
            for (std::size_t i = 0; i < object.size(); ++i)
              asks_more = asks_more && cell[i].wanted_mb >= object[i].wanted_mb;
            return Finding{formatted("%.1f to %.1f MB and not %.1f to %.1f, %.2f levels",
                                     cell.front().wanted_mb, cell.back().wanted_mb, object.front().wanted_mb,
                                     object.back().wanted_mb, cell.back().skipped),
                           asks_more && cell.back().skipped > object.back().skipped,
                           {{"wanted_mb_n1", cell.front().wanted_mb}, {"skipped_n64", cell.back().skipped}}};
          }};
}

Claim direction_claim() {
  return {"direction", "where only the way ahead counts, 0.92 levels are skipped with N = 64 and not 2.29",
          "less is skipped with N = 64", [](PaperBench& bench) {
            const double any = skipped_93(bench, kWalk93, "by object").back(),
                         ahead = skipped_93(bench, kWalk93, "direction + any").back();
            return Finding{
                formatted("%.2f and not %.2f", ahead, any), ahead < any, {{"any", any}, {"ahead", ahead}}};
          }};
}

Claim turn_claim() {
  Claim claim{"turn", "57 levels skipped at a sharp turn with direction and frustum, 19 with any and any",
              "a third or less", [](PaperBench& bench) {
                const std::size_t n4 = 1;
                return turn_finding_93(skipped_93(bench, kTurn93, "by object")[n4],
                                       skipped_93(bench, kTurn93, "direction + frustum")[n4]);
              }};
  claim.sequence = kTurn93;
  claim.must = true;
  return claim;
}

/// A walk's polygons, each so dear that the second stage takes `mean_s` on average.
std::vector<double> render_times_93(const MemoryWalk& walk, double mean_s) {
  std::vector<double> times;
  for (const std::vector<int>& seen : walk.seen) {
    double polygons = 0;
    for (const int thing : seen) polygons += double(walk.things[thing].polygons.front());
    times.push_back(polygons);
  }
  const double mean = std::accumulate(times.begin(), times.end(), 0.0) / double(times.size());
  for (double& time : times) time *= mean_s / mean;
  return times;
}

}  // namespace

Finding depth_finding_93(const std::vector<double>& skipped) {
  const auto least = std::min_element(skipped.begin(), skipped.end());
  const int frames = kPrefetchDepths[least - skipped.begin()];
  return {levels_in_words(skipped) + formatted(", least with N = %d", frames),
          frames > 4 && frames < 32 && skipped.front() >= 1.2 * *least && skipped.back() >= 1.2 * *least,
          {{"least_n", double(frames)}, {"least", *least}, {"n1", skipped.front()}, {"n64", skipped.back()}}};
}

Finding turn_finding_93(double any, double frugal) {
  return {formatted("%.2f levels in a frame with direction and frustum, %.2f with any and any", frugal, any),
          frugal > 0 && 3 * any <= frugal,
          {{"any", any}, {"frugal", frugal}}};
}

QueueTimes queue_times(std::span<const double> first_s, std::span<const double> second_s, int depth) {
  std::vector<double> front(first_s.size()), back(first_s.size());
  QueueTimes times;
  for (std::size_t k = 0; k < first_s.size(); ++k) {
    double start = k > 0 ? front[k - 1] : 0;
    if (k > static_cast<std::size_t>(depth)) start = std::max(start, back[k - depth - 1]);
    front[k] = start + first_s[k];
    back[k] = std::max(front[k], k > 0 ? back[k - 1] : 0) + second_s[k];
    times.response_s += (back[k] - start) / double(first_s.size());
  }
  if (!back.empty()) times.frame_s = back.back() / double(back.size());
  return times;
}

Item prefetch_93() {
  Item item{"5.1",
            "Tables 5.1, 5.3 and 5.7: levels skipped with 12 MB, flattened, 0.45 MB/s",
            {depth_claim(), cell_claim(), direction_claim(), turn_claim()}};
  for (Claim& claim : item.claims)
    if (claim.sequence.empty()) claim.sequence = kWalk93;
  Claim all{"all", "what was looked ahead to and read is there",
            "with room for all and no limit of reading nothing is skipped", [](PaperBench& bench) {
              const std::vector<double> skipped = skipped_93(bench, kWalk93, "no limits");
              const double most = *std::max_element(skipped.begin(), skipped.end());
              return Finding{formatted("%g levels", most), most == 0, {{"most", most}}};
            }};
  all.sequence = kWalk93;
  all.must = all.derived = true;
  item.claims.push_back(all);
  return item;
}

Finding queue_finding_93(const QueueTimes& few, const QueueTimes& more, const QueueTimes& most) {
  return {formatted("after %.3f, %.3f, %.3f s, frames of %.3f to %.3f s", few.response_s, more.response_s,
                    most.response_s, most.frame_s, few.frame_s),
          few.response_s < more.response_s && more.response_s < most.response_s &&
              most.response_s >= 2 * few.response_s && most.frame_s >= 0.8 * few.frame_s,
          {{"response_4_s", few.response_s},
           {"response_16_s", more.response_s},
           {"response_64_s", most.response_s}}};
}

Item queues_93() {
  Claim response{"response",
                 "a queue of 4, 16, 64 frames before the renderer: answers after 0.291, 0.544, 1.158 s, "
                 "frames of 0.12 s",
                 "later with each, twice as late with 64 as with 4; frames at most a fifth sooner",
                 [](PaperBench& bench) {
                   // Of [Fu93]: 0.097 s for interface, visibility and detail, 0.083 s for rendering, here as the
                   // polygons go.
                   const std::vector<double> second = render_times_93(walk_93(bench, kWalk93), 0.083),
                                             first(second.size(), 0.097);
                   return queue_finding_93(queue_times(first, second, 4), queue_times(first, second, 16),
                                           queue_times(first, second, 64));
                 }};
  response.sequence = kWalk93;
  response.derived = true;
  return {"6.4", "Table 6.4: queues between stages, by the formula", {response}};
}

}  // namespace talisman::sequences
