// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What every pose of a trace passes, whichever format it was read from: checks, conventions, what is to be said of it
/// (trace.h). A pose comes out when the two behind it are known, since these decide whether it jumped.

#include <deque>
#include <functional>

#include "sequences/content/traces/trace.h"
#include "sequences/content/traces/trace_text.h"

namespace talisman::sequences {

/// As a reader has it: body→world in the axes of the file.
struct RawPose {
  Stamp stamp;
  layers::dvec3 position{0};
  glm::dquat rotation{1, 0, 0, 0};
  int line = 0;
};

/// Takes the next pose; false: no more of them are wanted.
using PoseSink = std::function<bool(const RawPose&)>;

struct TracePose {
  double t_s = 0;  ///< since the first pose
  layers::dvec3 position{0};
  glm::dquat rotation{1, 0, 0, 0};
};

class PoseSieve {
 public:
  using Out = std::function<bool(const TracePose&)>;
  PoseSieve(const TraceOptions& options, Out out);

  /// Throws InputError for a pose that cannot be one.
  bool add(const RawPose& pose);
  /// What is still held back comes out. Throws InputError where there were less than two.
  void finish();
  const TraceFindings& findings() const { return findings_; }

 private:
  /// A pose with the step that led to it.
  struct Held {
    TracePose pose;
    double step_s = 0, moved_m = 0, turned_deg = 0;  ///< 0 of the first pose
    int line = 0;
    double speed() const { return step_s > 0 ? moved_m / step_s : 0; }
    double turn() const { return step_s > 0 ? turned_deg / step_s : 0; }
  };

  glm::dquat checked(const RawPose& pose) const;
  void note_step(const Held& held);
  bool release(std::size_t index);
  TracePose clipped(const TracePose& pose, bool moved, bool turned);
  double beside(std::size_t index, double (Held::*speed)() const) const;

  TraceOptions options_;
  BodyFrame frame_;
  Out out_;
  TraceFindings findings_;
  std::optional<Stamp> first_;
  std::deque<Held> held_;     ///< at most five: two before, the next to come out, two behind
  std::size_t released_ = 0;  ///< of these
  bool wanted_ = true;
  std::vector<TracePose> shown_;  ///< the last two that came out, where jumps are clipped
  layers::dvec3 moved_by_{0};     ///< by clipped jumps
  glm::dquat turned_by_{1, 0, 0, 0};
};

}  // namespace talisman::sequences
