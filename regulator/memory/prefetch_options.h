// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far ahead is what may be seen brought into memory, and what of it? The parameters of [Fu93 5.2.5].

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace talisman::regulator {

/// Which cells count as ones that the eye may come to [Fu93 5.2.2].
enum class RangeCull {
  Any,        ///< all that it can reach
  Plane,      ///< that lie at least partly before the eye
  Frustum,    ///< that meet what it sees now
  Direction,  ///< that the ray along its direction hits
};
inline constexpr std::array kAllRangeCulls = {RangeCull::Any, RangeCull::Plane, RangeCull::Frustum,
                                              RangeCull::Direction};

/// Which cells that are seen from those count.
enum class LookaheadCull { Any, Plane, Frustum };
inline constexpr std::array kAllLookaheadCulls = {LookaheadCull::Any, LookaheadCull::Plane,
                                                  LookaheadCull::Frustum};

/// What of such a cell is brought.
enum class PrefetchUnit {
  Object,  ///< what can be seen from the cell that the eye may come to
  Cell,    ///< all that is in it
};
inline constexpr std::array kAllPrefetchUnits = {PrefetchUnit::Object, PrefetchUnit::Cell};

struct PrefetchOptions {
  /// 0 … kMostPrefetchFrames: N, frames ahead; 0 brings what is seen alone. More brings things in earlier, and more that
  /// is never seen.
  int frames = 0;
  RangeCull range = RangeCull::Any;
  LookaheadCull lookahead = LookaheadCull::Any;
  PrefetchUnit unit = PrefetchUnit::Object;
  double speed_m_per_s = 1.5;   ///< > 0: the eye moves no faster; more reaches more cells
  double turn_deg_per_s = 120;  ///< > 0: nor turns faster; asked for where there are no cells
  bool operator==(const PrefetchOptions&) const = default;
};
inline constexpr int kMostPrefetchFrames = 1000;

/// What there is to keep things in, and to bring them.
struct MemoryLimits {
  /// ≥ 0; a megabyte is 10⁶ bytes. Less shows coarser things, or fewer.
  double memory_mb = std::numeric_limits<double>::infinity();
  double io_mb_per_s = std::numeric_limits<double>::infinity();  ///< ≥ 0
  bool any() const { return *this != MemoryLimits{}; }
  bool operator==(const MemoryLimits&) const = default;
};

inline constexpr std::int64_t kNoLimit_bytes = std::numeric_limits<std::int64_t>::max();

/// Whole bytes; kNoLimit_bytes for what is infinite or beyond it.
std::int64_t limit_bytes(const MemoryLimits& limits);
/// What can be read during frame `frame` of those that last 1/fps s each: their sum is that of the bandwidth over the time, to a byte.
std::int64_t frame_bytes(const MemoryLimits& limits, double fps, int frame);

std::string_view name(RangeCull cull);      ///< "any", "plane", "frustum", "direction"
std::string_view name(LookaheadCull cull);  ///< "any", "plane", "frustum"
std::string_view name(PrefetchUnit unit);   ///< "object", "cell"

/// First broken rule, or empty.
std::string first_defect(const PrefetchOptions& options);
std::string first_defect(const MemoryLimits& limits);

}  // namespace talisman::regulator
