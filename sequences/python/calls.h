// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What Python calls, in terms of the tool: the same words, the same checks, the same frames, but no files.

#include <functional>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/files/image_io.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

/// One run of `plan` or `render`, as far as it is known before its first frame.
class Call {
 public:
  /// `words` are those of the command line: {"--policy=budget", "--budget-polygons=20000"}. Throws
  /// InputError with the message of the tool; words about files and progress are refused.
  Call(const std::string& sequence, const std::vector<std::string>& words, bool plan_only);

  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Called once per frame, also for those before the range; what it throws ends the run.
  using BeforeFrame = std::function<void()>;
  /// Called once per frame of the range.
  using Planned = std::function<void(const PipelineState&, const FrameReport&)>;

  /// Plans the frames up to the last of the range.
  void plan(const BeforeFrame& before_frame, const Planned& planned) const;
  /// Frame `frame` as `talisman render` writes it. Throws InputError for a frame that the sequence has not.
  Image8 draw(int frame, const BeforeFrame& before_frame) const;

 private:
  Sequence sequence_;
  std::vector<std::string> warnings_;
  Settings settings_;
  int first_frame_ = 0, last_frame_ = 0;
  int threads_ = 0;
};

}  // namespace talisman::sequences
