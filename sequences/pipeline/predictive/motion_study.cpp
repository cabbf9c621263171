// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/predictive/motion_study.h"

#include <algorithm>

#include "layers/rigid_groups.h"

namespace talisman::sequences {

namespace {

std::int64_t triangles_of(const layers::Scene& scene, int part) {
  return scene.meshes[scene.parts[part].mesh].triangle_count();
}

/// Groups as indices of followed parts.
std::vector<std::vector<int>> by_index(const FollowedParts& followed, std::vector<std::vector<int>> groups,
                                       std::size_t parts) {
  std::vector<int> index(parts, -1);
  for (std::size_t i = 0; i < followed.parts.size(); ++i) index[followed.parts[i].part] = static_cast<int>(i);
  for (std::vector<int>& group : groups)
    for (int& part : group) part = index[part];
  return groups;
}

}  // namespace

MotionCounts& MotionCounts::operator+=(const MotionCounts& o) {
  shown += o.shown;
  changes += o.changes;
  could += o.could;
  runs += o.runs;
  draws += o.draws;
  polygons += o.polygons;
  polygons_direct += o.polygons_direct;
  return *this;
}

MotionCounts counts_of(const regulator::MotionWord& word, int first, int frames,
                       const regulator::PlanShape& plan, std::int64_t triangles) {
  MotionCounts counts;
  const int shown = std::min(word.frames(), frames - first);
  counts.shown = shown;
  counts.could = shown - 1;
  counts.runs = word.runs();
  counts.changes = counts.runs - 1;
  for (int frame = 0; frame < shown; ++counts.draws) frame += regulator::draw_due(plan, word, frame).frames;
  counts.polygons = triangles * counts.draws;
  counts.polygons_direct = triangles * shown;
  return counts;
}

MotionStudy study_motion(const layers::Scene& scene, const layers::LayerSet& set,
                         const MotionStudyOptions& options) {
  MotionStudy study{options, followed_parts(scene, set), {}, {}, {}, {}, 0};
  std::vector<int> parts;
  for (const FollowedPart& part : study.followed.parts) parts.push_back(part.part);
  layers::RigidGroups groups(scene.at(0), parts);
  const FrameAt frame_at = [&](int frame) {
    layers::SceneFrame now = scene.at(frame / options.fps);
    groups.follow(now);
    return now;
  };
  study.by_part.resize(parts.size());
  for (int first = 0; first < options.frames; first += options.plan.frames) {
    study.slices.push_back(follow_parts(study.followed, options.display_px, first, options.plan.frames,
                                        options.frames - 1, frame_at, options.motion));
    const MotionSlice& slice = study.slices.back();
    study.vertices += slice.vertices;
    for (std::size_t i = 0; i < parts.size(); ++i)
      study.by_part[i] +=
          counts_of(slice.words[i], first, options.frames, options.plan, triangles_of(scene, parts[i]));
  }
  for (const MotionCounts& counts : study.by_part) study.all += counts;
  study.groups = by_index(study.followed, groups.groups(), scene.parts.size());
  return study;
}

}  // namespace talisman::sequences
