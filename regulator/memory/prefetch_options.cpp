// SPDX-License-Identifier: Apache-2.0
#include "regulator/memory/prefetch_options.h"

#include <cmath>
#include <cstdio>

namespace talisman::regulator {

namespace {

constexpr double kBytesPerMegabyte = 1e6;
/// Above it a double does not count bytes one by one.
constexpr double kMostBytes = 0x1p53;

std::string memory_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::int64_t whole_bytes(double bytes) {
  return bytes < kMostBytes ? static_cast<std::int64_t>(std::floor(bytes)) : kNoLimit_bytes;
}

}  // namespace

std::int64_t limit_bytes(const MemoryLimits& limits) {
  return whole_bytes(limits.memory_mb * kBytesPerMegabyte);
}

std::int64_t frame_bytes(const MemoryLimits& limits, double fps, int frame) {
  const double each = limits.io_mb_per_s * kBytesPerMegabyte / fps;
  const std::int64_t before = whole_bytes(frame * each), after = whole_bytes((frame + 1.0) * each);
  return after == kNoLimit_bytes || std::isnan(frame * each) ? kNoLimit_bytes : after - before;
}

std::string_view name(RangeCull cull) {
  switch (cull) {
    case RangeCull::Any:
      return "any";
    case RangeCull::Plane:
      return "plane";
    case RangeCull::Frustum:
      return "frustum";
    case RangeCull::Direction:
      return "direction";
  }
  return "";
}

std::string_view name(LookaheadCull cull) {
  switch (cull) {
    case LookaheadCull::Any:
      return "any";
    case LookaheadCull::Plane:
      return "plane";
    case LookaheadCull::Frustum:
      return "frustum";
  }
  return "";
}

std::string_view name(PrefetchUnit unit) { return unit == PrefetchUnit::Object ? "object" : "cell"; }

std::string first_defect(const PrefetchOptions& options) {
  if (options.frames < 0 || options.frames > kMostPrefetchFrames)
    return "prefetch is " + std::to_string(options.frames) + ", must be 0 … " +
           std::to_string(kMostPrefetchFrames) + " frames";
  if (!(options.speed_m_per_s > 0) || !std::isfinite(options.speed_m_per_s))
    return "prefetch_speed is " + memory_number(options.speed_m_per_s) + ", must be above 0 m/s and finite";
  if (!(options.turn_deg_per_s > 0) || !std::isfinite(options.turn_deg_per_s))
    return "prefetch_turn is " + memory_number(options.turn_deg_per_s) +
           ", must be above 0 degrees/s and finite";
  return {};
}

std::string first_defect(const MemoryLimits& limits) {
  if (!(limits.memory_mb >= 0))
    return "memory_mb is " + memory_number(limits.memory_mb) + ", must be at least 0";
  if (!(limits.io_mb_per_s >= 0))
    return "io_mb_per_s is " + memory_number(limits.io_mb_per_s) + ", must be at least 0";
  return {};
}

}  // namespace talisman::regulator
