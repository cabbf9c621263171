// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What lies in memory, what is read next, and what makes room for it [Fu93 5.2.3, 5.2.4]: in simulated time, without threads.
///
/// An *item* (a mesh, a texture, a sprite) has levels, each stored by itself, from the coarsest. In each frame
///
///   claim    what is seen now, the coarse levels of all of it first; then what was looked ahead, soonest first, each with all its
///            levels: up to the limit of memory
///   release  what is not claimed, when room is needed: what was claimed longest ago; of one frame what was wanted latest
///   read     what is claimed and not there, coarse levels first, of these the soonest, as many bytes as the frame has time for. A read goes on in the
///            next frame, unless it is no longer claimed; its room is taken from its start
///   draw     never waits: the finest level that is there and not finer than wanted, else nothing
///
/// so that levels of an item are there from the coarsest on without a gap, and no more bytes than the limit ever are.
/// A frame draws what was read in its own time. Of what is shared there is one item for all who want it.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "regulator/memory/prefetch_options.h"

namespace talisman::regulator {

/// Levels 0 … `level` of an item may be seen in so many frames; 0: they are.
struct LevelWant {
  int item = 0, level = 0, soonest = 0;
  bool operator==(const LevelWant&) const = default;
};

/// One frame. Bytes but for `resident_bytes` are those of this frame.
struct MemoryFrame {
  int skipped_levels = 0;          ///< between those wanted and those drawn, over all that is seen
  int skipped_items = 0;           ///< of which nothing was there
  std::int64_t wanted_bytes = 0;   ///< of all that is seen or looked ahead, whatever the limit
  std::int64_t claimed_bytes = 0;  ///< of it, what was let in
  std::int64_t read_bytes = 0;     ///< that came through, also of reads that are given up later
  std::int64_t released_bytes = 0;
  std::int64_t wasted_bytes = 0;    ///< released, or given up, without the item having been drawn so finely
  std::int64_t resident_bytes = 0;  ///< after it, with the room of a read that is under way
};

class LevelCache {
 public:
  /// `level_bytes`: by item, from the coarsest level, each ≥ 0. `limit_bytes` ≥ 0.
  LevelCache(const std::vector<std::vector<std::int64_t>>& level_bytes, std::int64_t limit_bytes);

  /// `seen`: by the object, what it is drawn with if it is there. `ahead`: in the order in which it is claimed.
  /// `read_bytes` ≥ 0: what can be read until it is drawn. Cost: O((wants + what lies in memory) log).
  MemoryFrame step(std::span<const LevelWant> seen, std::span<const LevelWant> ahead,
                   std::int64_t read_bytes);

  /// By the objects of `seen` of the last step: the level that was drawn, -1: none.
  const std::vector<int>& drawn() const { return drawn_; }
  /// The levels of the item that are there.
  int resident_levels(int item) const { return resident_[item]; }
  std::int64_t resident_bytes() const { return used_bytes_; }

 private:
  struct Level {
    std::int64_t bytes = 0;
    int claimed_frame = -1;  ///< the last in which it was
    int rank = 0;            ///< in the order of that frame's claims
    int soonest = 0;
    bool was_drawn = false;
  };
  struct Read {
    int item = -1, level = 0;
    std::int64_t left_bytes = 0;
  };
  Level& at(int item, int level) { return levels_[first_[item] + level]; }
  bool is_claimed(int item, int level) { return at(item, level).claimed_frame == frame_; }
  bool claim(int item, int level, int soonest, MemoryFrame& report);
  void claim_seen(std::span<const LevelWant> seen, MemoryFrame& report);
  void claim_ahead(std::span<const LevelWant> ahead, MemoryFrame& report);
  void sum_up_wanted(std::span<const LevelWant> seen, std::span<const LevelWant> ahead, MemoryFrame& report);
  std::vector<Read> reads_due();
  void make_room(std::int64_t bytes, MemoryFrame& report);
  void find_victims();
  void read(std::int64_t bytes, MemoryFrame& report);
  void give_up(MemoryFrame& report);
  void draw(std::span<const LevelWant> seen, MemoryFrame& report);

  std::vector<int> first_;  ///< by item, of its levels in levels_; one more at the end
  std::vector<Level> levels_;
  std::vector<int> resident_, claimed_;  ///< by item: levels that are there, that are claimed in this frame
  std::vector<int> touched_;             ///< items with claims in this frame
  std::vector<int> present_;             ///< items with levels that are there
  std::vector<Read> victims_;            ///< of this frame, the first to go last; filled when needed
  bool knows_victims_ = false;
  std::int64_t limit_bytes_, used_bytes_ = 0;
  int frame_ = 0, rank_ = 0;
  Read under_way_;
  std::vector<int> drawn_;
};

/// First broken rule of what a cache is made of ("item 3, level 1: -5 bytes, rule: at least 0"), or empty.
std::string first_defect(const std::vector<std::vector<std::int64_t>>& level_bytes);

}  // namespace talisman::regulator
