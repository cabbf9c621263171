// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/memory/walk.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

/// What bounds an observer of this walk.
void note_speeds(MemoryWalk& walk) {
  for (std::size_t frame = 1; frame < walk.cameras.size(); ++frame) {
    const layers::dmat4 &before = walk.cameras[frame - 1].world_from_camera,
                        &now = walk.cameras[frame].world_from_camera;
    const dvec3 turned_from = -glm::normalize(dvec3(before[2])), to = -glm::normalize(dvec3(now[2]));
    const double turn_rad = std::atan2(glm::length(glm::cross(turned_from, to)), glm::dot(turned_from, to));
    walk.speed_m_per_s =
        std::max(walk.speed_m_per_s, glm::distance(dvec3(before[3]), dvec3(now[3])) * walk.fps);
    walk.turn_deg_per_s = std::max(walk.turn_deg_per_s, turn_rad * walk.fps * 180 / M_PI);
  }
  // Of a camera at rest there is no bound that is above 0; and rounding must not put the walk beyond its own.
  walk.speed_m_per_s = 1.0001 * std::max(walk.speed_m_per_s, 1e-3);
  walk.turn_deg_per_s = 1.0001 * std::max(walk.turn_deg_per_s, 1e-3);
}

}  // namespace

std::vector<std::int64_t> ladder_of(std::int64_t polygons) {
  std::vector<std::int64_t> ladder = {std::max<std::int64_t>(polygons, 0)};
  while (ladder.back() > kCoarsestPolygons) ladder.push_back(ladder.back() / kLevelRatio);
  std::reverse(ladder.begin(), ladder.end());
  return ladder;
}

MemoryWalk walk_of(const Sequence& sequence, const Settings& settings, const ExperimentFrames& frames) {
  Settings asked = settings;
  asked.regulator.policy = regulator::Policy::Direct;  // which draws what is seen, and no more
  if (!asked.visibility.any()) asked.visibility.objects = ViewTest::Frustum;
  const layers::Scene& scene = *sequence.scene;
  const Pipeline pipeline = make_pipeline(scene, sequence.layers, asked);
  PipelineState state(pipeline);
  MemoryWalk walk;
  walk.cells = settings.cells;
  walk.display_px = settings.view.display_px;
  walk.fps = sequence.fps;
  std::vector<layers::Box3> boxes(scene.parts.size());
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const SeenParts* seen = seen_at(pipeline, state, frame);
    walk.cameras.push_back(state.culling->now.camera);
    std::vector<int>& now = walk.seen.emplace_back();
    for (std::size_t part = 0; part < boxes.size(); ++part) {
      if (seen->part[part]) now.push_back(static_cast<int>(part));
      boxes[part] = joined(boxes[part], state.culling->boxes[part]);
    }
  }
  for (std::size_t part = 0; part < boxes.size(); ++part) {
    const auto ladder = ladder_of(scene.meshes[scene.parts[part].mesh].triangle_count());
    std::vector<std::int64_t>& bytes = walk.level_bytes.emplace_back();
    for (const std::int64_t polygons : ladder) {
      bytes.push_back(std::llround(kBytesPerPolygon * static_cast<double>(polygons)));
      walk.polygons += polygons, walk.bytes += bytes.back();
    }
    walk.things.push_back({boxes[part], static_cast<int>(part), ladder});
  }
  note_speeds(walk);
  return walk;
}

}  // namespace talisman::sequences
