// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include "layers/advance.h"
#include "layers/box_tree.h"
#include "layers/part_box.h"
#include "sequences/experiments/culling/flat_scan.h"
#include "sequences/experiments/culling/measured.h"
#include "sequences/experiments/culling/octree.h"
#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

namespace {

using layers::Box3;

constexpr int kCopies[] = {1'000, 10'000, 100'000};
constexpr double kMovingShares[] = {0, 0.01, 0.1, 1};
constexpr int kMostFrames = 24;

struct Structure {
  const char* name;
  std::unique_ptr<layers::BoxIndex> (*make)();
};

template <typename T, auto... kArguments>
std::unique_ptr<layers::BoxIndex> made() {
  return std::make_unique<T>(kArguments...);
}

constexpr Structure kStructures[] = {{"flat scan", &made<FlatScan>},
                                     {"tree", &made<layers::BoxTree, true>},
                                     {"tree, no cache", &made<layers::BoxTree, false>},
                                     {"octree", &made<Octree, 1>},
                                     {"loose octree", &made<Octree, 2>}};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Boxes, and how they move from frame to frame.
struct Workload {
  std::string name;
  double moving_share = 0;
  std::vector<std::vector<Box3>> boxes;  ///< by frame
  std::vector<std::vector<int>> moved;   ///< by frame; of the first: none
};

Box3 shifted(const Box3& box, const layers::dvec3& by) {
  if (box.empty() || box == layers::kEverywhere) return box;
  Box3 result;
  for (int k = 0; k < 3; ++k)
    result.lo[k] = static_cast<float>(box.lo[k] + by[k]),
    result.hi[k] = static_cast<float>(box.hi[k] + by[k]);
  return result;
}

std::vector<Box3> part_boxes(const layers::Scene& scene, const layers::SceneFrame& frame,
                             const std::vector<layers::MeshBox>& meshes) {
  std::vector<Box3> boxes;
  for (const layers::Part& part : scene.parts) boxes.push_back(part_box(frame, part, meshes[part.mesh]));
  return boxes;
}

Workload own_parts(const layers::Scene& scene, const std::vector<layers::SceneFrame>& frames) {
  const std::vector<layers::MeshBox> meshes = layers::mesh_boxes(scene);
  Workload work{"own parts", 0, {}, {}};
  std::size_t moved = 0;
  for (const layers::SceneFrame& frame : frames) {
    work.boxes.push_back(part_boxes(scene, frame, meshes));
    work.moved.emplace_back();
    if (work.boxes.size() < 2) continue;
    const std::vector<Box3>&before = work.boxes[work.boxes.size() - 2], &now = work.boxes.back();
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i] != before[i]) work.moved.back().push_back(static_cast<int>(i));
    moved += work.moved.back().size();
  }
  const double steps = double(frames.size() - 1) * double(std::max<std::size_t>(scene.parts.size(), 1));
  work.moving_share = steps > 0 ? double(moved) / steps : 0;
  return work;
}

/// `count` copies of the first frame's boxes on a square, the first in its own place, of which a share moves to and fro.
Workload copies(const std::vector<Box3>& boxes, int count, double share, int frames) {
  Workload work{"copies", share, {}, {}};
  Box3 all;
  for (const Box3& box : boxes)
    if (box != layers::kEverywhere) all = layers::joined(all, box);
  const double pitch = all.empty() ? 1 : std::max(all.hi[0] - all.lo[0], all.hi[2] - all.lo[2]);
  const int sets = (count + int(boxes.size()) - 1) / int(boxes.size()),
            row = std::max(1, int(std::ceil(std::sqrt(sets))));
  std::vector<Box3> rest;
  for (int i = 0; i < count; ++i) {
    const int set = i / int(boxes.size());
    rest.push_back(shifted(boxes[i % boxes.size()], pitch * layers::dvec3(set % row, 0, set / row)));
  }
  const int stride = share > 0 ? int(std::lround(1 / share)) : 0;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Box3> now = rest;
    std::vector<int> moved;
    for (int i = 0; stride > 0 && i < count; i += stride) {
      const double by =
          rest[i].empty() ? 0 : 0.5 * std::sin(0.7 * frame + i) * (rest[i].hi[0] - rest[i].lo[0]);
      now[i] = shifted(rest[i], {by, 0, by});
      if (frame > 0) moved.push_back(i);
    }
    work.boxes.push_back(std::move(now));
    work.moved.push_back(std::move(moved));
  }
  return work;
}

CullingResult measure_structure(const Structure& structure, const Workload& work,
                                const std::vector<layers::Region>& views,
                                std::vector<std::vector<int>>& found_by_scan) {
  CullingResult result;
  result.workload = work.name;
  result.parts = int(work.boxes.front().size());
  result.moving_share = work.moving_share;
  result.structure = structure.name;
  const auto index = structure.make();
  const Stopwatch build;
  index->build(work.boxes.front());
  result.build_us = 1e3 * build.ms();
  std::vector<double> update_us, query_us;
  std::vector<int> found;
  layers::QueryCounters counters;
  for (std::size_t frame = 0; frame < views.size(); ++frame) {
    const Stopwatch update;
    index->update(work.boxes[frame], work.moved[frame]);
    update_us.push_back(1e3 * update.ms());
    found.clear();
    const Stopwatch query;
    index->query(views[frame], found, counters);
    query_us.push_back(1e3 * query.ms());
    result.found += double(found.size()) / double(views.size());
    std::sort(found.begin(), found.end());
    if (found_by_scan.size() <= frame) found_by_scan.push_back(found);  // the scan comes first
    for (const int entry : found_by_scan[frame])
      result.missed += !std::binary_search(found.begin(), found.end(), entry);
  }
  const double queries = double(views.size());
  result.update_us = median(update_us), result.query_us = median(query_us);
  result.nodes = double(counters.nodes) / queries, result.tests = double(counters.tests) / queries;
  result.spared = double(counters.spared) / queries;
  return result;
}

}  // namespace

CullingExperiment measure_culling(const Sequence& sequence, const Settings& settings,
                                  const ExperimentFrames& frames, ProgressKind progress) {
  const layers::Scene& scene = *sequence.scene;
  const layers::SceneMotion motion(scene);
  std::vector<layers::SceneFrame> instants;
  std::vector<layers::Region> views;
  for (int frame = frames.first; frame <= frames.last && int(instants.size()) < kMostFrames; ++frame) {
    instants.push_back(instants.empty() ? layers::SceneFrame{} : instants.back());
    motion.advance(instants.back(), frame / settings.fps);
    views.push_back(view_region(instants.back().camera, settings.view.display_px, 0));
  }
  CullingExperiment experiment{sequence.name, settings.view.display_px, int(views.size()), {}};
  std::vector<Workload> works{own_parts(scene, instants)};
  const std::vector<Box3> rest = works.front().boxes.front();
  Progress bar(progress, "workloads", 1 + int(std::size(kCopies) * std::size(kMovingShares)));
  const auto measure = [&](const Workload& work) {
    std::vector<std::vector<int>> found;
    for (const Structure& structure : kStructures)
      experiment.results.push_back(measure_structure(structure, work, views, found));
    bar.advance();
  };
  measure(works.front());
  for (const int count : kCopies)
    for (const double share : kMovingShares)
      if (!rest.empty()) measure(copies(rest, count, share, int(views.size())));
  return experiment;
}

std::vector<const CullingResult*> fastest(const CullingExperiment& experiment) {
  std::vector<const CullingResult*> best;
  for (const CullingResult& r : experiment.results) {
    const bool is_same = !best.empty() && best.back()->workload == r.workload &&
                         best.back()->parts == r.parts && best.back()->moving_share == r.moving_share;
    if (!is_same)
      best.push_back(&r);
    else if (r.frame_us() < best.back()->frame_us())
      best.back() = &r;
  }
  return best;
}

}  // namespace talisman::sequences
