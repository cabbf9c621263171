// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/planned.h"

#include "sequences/content/seams.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

void plan_in(const Pipeline& pipeline, const FrameRange& range,
             const std::function<void(const FrameReport&, const PipelineState&)>& show) {
  PipelineState state(pipeline);
  for (int frame = 0; frame <= range.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    if (frame >= range.first) show(report, state);
  }
}

}  // namespace

void plan_frames(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                 const std::function<void(const FrameReport&, const PipelineState&)>& show) {
  plan_in(make_pipeline(*sequence.scene, sequence.layers, settings), range, show);
}

Summary planned(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                const std::function<void(const FrameReport&)>& also) {
  const Sequence seamed = with_seams_for(sequence, settings);
  const Pipeline pipeline = make_pipeline(*seamed.scene, seamed.layers, settings);
  Summary summary = start_summary(pipeline, sequence.name);
  summary.planned_only = true;
  plan_in(pipeline, range, [&](const FrameReport& report, const PipelineState& state) {
    add_decisions(summary, report, state);
    summary.frames.push_back(line_of(report));
    if (also) also(report);
  });
  return summary;
}

}  // namespace talisman::sequences
