// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence run frame by frame, for tests that look between the frames.

#include <optional>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/step.h"

namespace talisman::tests {

struct Playback {
  Playback(const sequences::Sequence& s, const sequences::Settings& settings, bool draw = false)
      : sequence(s),
        pipeline(sequences::make_pipeline(*sequence.scene, sequence.layers, settings)),
        state(pipeline) {
    if (draw) prepared.emplace(*sequence.scene);
  }
  sequences::FrameReport next() {
    return sequences::step(pipeline, state, frame++, prepared ? &*prepared : nullptr);
  }
  /// Up to `frames`, those that were played before left out.
  std::vector<sequences::FrameReport> all(int frames) {
    std::vector<sequences::FrameReport> reports;
    while (frame < frames) reports.push_back(next());
    return reports;
  }

  sequences::Sequence sequence;
  sequences::Pipeline pipeline;
  sequences::PipelineState state;
  std::optional<chunker::PreparedScene> prepared;
  int frame = 0;
};

}  // namespace talisman::tests
