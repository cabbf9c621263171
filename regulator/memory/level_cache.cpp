// SPDX-License-Identifier: Apache-2.0
#include "regulator/memory/level_cache.h"

#include <algorithm>
#include <tuple>

#include "layers/check.h"

namespace talisman::regulator {

LevelCache::LevelCache(const std::vector<std::vector<std::int64_t>>& level_bytes, std::int64_t limit_bytes)
    : resident_(level_bytes.size(), 0), claimed_(level_bytes.size(), 0), limit_bytes_(limit_bytes) {
  TALISMAN_CHECK_EQ(first_defect(level_bytes), "");
  for (const std::vector<std::int64_t>& item : level_bytes) {
    first_.push_back(static_cast<int>(levels_.size()));
    for (const std::int64_t bytes : item) levels_.push_back({bytes});
  }
  first_.push_back(static_cast<int>(levels_.size()));
}

MemoryFrame LevelCache::step(std::span<const LevelWant> seen, std::span<const LevelWant> ahead,
                             std::int64_t read_bytes) {
  MemoryFrame report;
  for (const int item : touched_) claimed_[item] = 0;
  touched_.clear();
  knows_victims_ = false;
  ++frame_, rank_ = 0;
  sum_up_wanted(seen, ahead, report);
  claim_seen(seen, report);
  claim_ahead(ahead, report);
  give_up(report);
  read(read_bytes, report);
  draw(seen, report);
  report.resident_bytes = used_bytes_;
  return report;
}

void LevelCache::sum_up_wanted(std::span<const LevelWant> seen, std::span<const LevelWant> ahead,
                               MemoryFrame& report) {
  std::vector<std::pair<int, int>> finest;
  for (const auto& wants : {seen, ahead})
    for (const LevelWant& want : wants) finest.push_back({want.item, -want.level});
  std::sort(finest.begin(), finest.end());
  for (std::size_t i = 0; i < finest.size(); ++i) {
    if (i > 0 && finest[i].first == finest[i - 1].first) continue;
    for (int level = 0; level <= -finest[i].second; ++level)
      report.wanted_bytes += at(finest[i].first, level).bytes;
  }
}

/// Levels of the item up to `level`, as far as they fit. False: one does not.
bool LevelCache::claim(int item, int level, int soonest, MemoryFrame& report) {
  while (claimed_[item] <= level) {
    Level& next = at(item, claimed_[item]);
    if (next.bytes > limit_bytes_ - report.claimed_bytes) return false;
    if (claimed_[item] == 0) touched_.push_back(item);
    report.claimed_bytes += next.bytes;
    next.claimed_frame = frame_;
    next.rank = rank_++;
    next.soonest = soonest;
    ++claimed_[item];
  }
  return true;
}

/// A level that does not fit leaves its item's finer ones out, and nothing else.
void LevelCache::claim_seen(std::span<const LevelWant> seen, MemoryFrame& report) {
  int finest = -1;
  for (const LevelWant& want : seen) finest = std::max(finest, want.level);
  for (int level = 0; level <= finest; ++level)
    for (const LevelWant& want : seen)
      if (want.level >= level && claimed_[want.item] == level) claim(want.item, level, want.soonest, report);
}

void LevelCache::claim_ahead(std::span<const LevelWant> ahead, MemoryFrame& report) {
  for (const LevelWant& want : ahead)
    if (!claim(want.item, want.level, want.soonest, report)) return;
}

void LevelCache::give_up(MemoryFrame& report) {
  if (under_way_.item < 0 || is_claimed(under_way_.item, under_way_.level)) return;
  const std::int64_t bytes = at(under_way_.item, under_way_.level).bytes;
  used_bytes_ -= bytes;
  report.wasted_bytes += bytes - under_way_.left_bytes;
  under_way_ = {};
}

std::vector<LevelCache::Read> LevelCache::reads_due() {
  std::vector<Read> due;
  for (const int item : touched_)
    for (int level = resident_[item]; level < claimed_[item]; ++level)
      if (under_way_.item != item || under_way_.level != level)
        due.push_back({item, level, at(item, level).bytes});
  std::sort(due.begin(), due.end(), [this](const Read& a, const Read& b) {
    const Level &x = at(a.item, a.level), &y = at(b.item, b.level);
    return std::tie(a.level, x.soonest, x.rank) < std::tie(b.level, y.soonest, y.rank);
  });
  return due;
}

void LevelCache::find_victims() {
  std::erase_if(present_, [this](int item) { return resident_[item] == 0; });
  std::sort(present_.begin(), present_.end());  // one that went and came back is noted twice
  present_.erase(std::unique(present_.begin(), present_.end()), present_.end());
  victims_.clear();
  for (const int item : present_)
    for (int level = claimed_[item]; level < resident_[item]; ++level) victims_.push_back({item, level, 0});
  std::sort(victims_.begin(), victims_.end(), [this](const Read& a, const Read& b) {
    const Level &x = at(a.item, a.level), &y = at(b.item, b.level);
    return std::tie(y.claimed_frame, x.rank) < std::tie(x.claimed_frame, y.rank);
  });
  knows_victims_ = true;
}

void LevelCache::make_room(std::int64_t bytes, MemoryFrame& report) {
  while (bytes > limit_bytes_ - used_bytes_) {
    if (!knows_victims_) find_victims();
    TALISMAN_CHECK(!victims_.empty());  // all that is claimed fits
    const Read victim = victims_.back();
    victims_.pop_back();
    const Level& level = at(victim.item, victim.level);
    used_bytes_ -= level.bytes;
    report.released_bytes += level.bytes;
    if (!level.was_drawn) report.wasted_bytes += level.bytes;
    resident_[victim.item] = victim.level;
  }
}

void LevelCache::read(std::int64_t bytes, MemoryFrame& report) {
  const std::vector<Read> due = reads_due();
  std::size_t next = 0;
  while (true) {
    if (under_way_.item < 0) {
      if (next == due.size() || (bytes == 0 && due[next].left_bytes > 0)) return;
      under_way_ = due[next++];
      make_room(under_way_.left_bytes, report);
      used_bytes_ += under_way_.left_bytes;
    }
    const std::int64_t now = std::min(bytes, under_way_.left_bytes);
    bytes -= now, under_way_.left_bytes -= now, report.read_bytes += now;
    if (under_way_.left_bytes > 0) return;
    const int item = under_way_.item;
    if (resident_[item]++ == 0) present_.push_back(item);
    at(item, under_way_.level).was_drawn = false;
    under_way_ = {};
  }
}

void LevelCache::draw(std::span<const LevelWant> seen, MemoryFrame& report) {
  drawn_.clear();
  for (const LevelWant& want : seen) {
    const int best = std::min(resident_[want.item] - 1, want.level);
    drawn_.push_back(best);
    report.skipped_levels += want.level - best;
    report.skipped_items += best < 0;
    for (int level = 0; level <= best; ++level) at(want.item, level).was_drawn = true;
  }
}

std::string first_defect(const std::vector<std::vector<std::int64_t>>& level_bytes) {
  for (std::size_t item = 0; item < level_bytes.size(); ++item) {
    if (level_bytes[item].empty()) return "item " + std::to_string(item) + ": no level, rule: one or more";
    for (std::size_t level = 0; level < level_bytes[item].size(); ++level)
      if (level_bytes[item][level] < 0)
        return "item " + std::to_string(item) + ", level " + std::to_string(level) + ": " +
               std::to_string(level_bytes[item][level]) + " bytes, rule: at least 0";
  }
  return {};
}

}  // namespace talisman::regulator
