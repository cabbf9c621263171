// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is to be known of a trace: how often it was sampled, how fast it is, where it is not smooth.
///
/// Quantiles of more than 4096 values are of a histogram in which a bin ends 1 % above its beginning, so they are right to
/// 1 %; memory does not grow with the trace. Of fewer they are exact.

#include <cstdint>
#include <string>
#include <vector>

namespace talisman::sequences {

/// Of values ≥ 0; what is below 1e-9 is 0.
class LogHistogram {
 public:
  void add(double value);
  std::int64_t count() const { return count_; }
  double max() const { return max_; }
  /// The value below which a share `q`, 0 … 1, of the values lies; 0 where there is none.
  double quantile(double q) const;

 private:
  void add_to_bin(double value);

  std::vector<double> first_;  ///< the values, as long as they are few
  std::vector<std::int64_t> bins_;
  std::int64_t count_ = 0, zeros_ = 0;
  double max_ = 0;
};

/// A step between two poses that is longer in time than it should be.
struct TraceGap {
  double at_s = 0;  ///< of the pose before it, after the first pose
  double length_s = 0;
  int line = 0;  ///< of the pose behind it
};

struct TraceJump {
  double at_s = 0;        ///< of the pose behind it, after the first pose
  double turned_deg = 0;  ///< by the step; 0: it is one of place alone
  double moved_m = 0;     ///< 0: of rotation alone
  double times = 0;       ///< as fast as the steps beside it; infinite where these stand still
  int line = 0;           ///< of the pose behind it
};

struct TraceFindings {
  std::int64_t poses = 0;
  double length_s = 0, way_m = 0;
  LogHistogram step_s, speed_m_per_s, turn_deg_per_s;
  std::vector<TraceGap> longest_steps;  ///< at most 1000, the longest first
  std::vector<TraceJump> jumps;         ///< the first 1000
  std::int64_t jump_count = 0;
  std::string remark;  ///< what is to be said of the file; empty: nothing

  double period_s() const { return step_s.quantile(0.5); }
  /// Steps of more than three periods, of `longest_steps`.
  std::vector<TraceGap> gaps() const;
};

}  // namespace talisman::sequences
