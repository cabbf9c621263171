// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The room of tests/support/room.h run through the pipeline: decisions and pictures, frame after frame.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "sequences/pipeline/step.h"
#include "tests/support/room.h"

namespace talisman::tests {

struct Show {
  layers::LayerSet layers;
  std::vector<sequences::FrameReport> reports;

  int renders(const std::string& name) const {
    int n = 0;
    for (const sequences::FrameReport& report : reports)
      for (const regulator::LayerDecision& d : report.plan.decisions)
        n += layers.layers[d.layer].name == name && d.action == regulator::Action::Rerender;
    return n;
  }
  sequences::ShadeCounters passes() const {
    sequences::ShadeCounters sum;
    for (const sequences::FrameReport& report : reports) sum += report.shade;
    return sum;
  }
};

inline Show run(const Room& room, regulator::Policy policy, int frames, bool draw, double geometric_px = 1) {
  Show result{room.layers(), {}};
  sequences::Settings settings;
  settings.view.display_px = {160, 120};
  settings.regulator.policy = policy;
  settings.regulator.thresholds.geometric_px = geometric_px;
  settings.frames = frames;
  const sequences::Pipeline pipeline = sequences::make_pipeline(room.scene, result.layers, settings);
  const chunker::PreparedScene prepared(room.scene);
  sequences::PipelineState state(pipeline);
  for (int frame = 0; frame < frames; ++frame)
    result.reports.push_back(sequences::step(pipeline, state, frame, draw ? &prepared : nullptr));
  return result;
}

/// The room with the ball flying along x, 0.5 m per second.
inline Room with_flying_ball(Room room) {
  layers::FlightTrack flight;
  flight.position = {{0, 2}, {{-0.5, 1, 0}, {0.5, 1, 0}}, layers::Interpolation::Linear};
  room.scene.tracks.push_back({1, flight});
  return room;
}

/// Differences of two pictures in sRGB code values.
struct Difference {
  int max = 0, above_two = 0;
  double mean = 0;
};

inline Difference difference(const chunker::Frame& a, const chunker::Frame& b) {
  const auto x = chunker::srgb_bytes(a), y = chunker::srgb_bytes(b);
  Difference d;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const int off = std::abs(int{x[i]} - int{y[i]});
    d.max = std::max(d.max, off);
    d.above_two += off > 2;
    d.mean += off;
  }
  d.mean /= static_cast<double>(x.size());
  return d;
}

}  // namespace talisman::tests
