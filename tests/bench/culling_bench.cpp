// SPDX-License-Identifier: Apache-2.0

/// What does it cost to find what is in view? 100,000 boxes, uniform or clustered, one thread; the share of them
/// that a query finds is in the name. Warm: the same query again; cold: 64 MB are written between two. The flat scan tests four
/// boxes at once as the tree does. `advance`: 100,000 nodes at rest and ten that move. `plan`: frames of 14,000 layers of which
/// some 300 are in view, culled by the frustum and not, and of those 300 alone.

#include <benchmark/benchmark.h>

#include <glm/geometric.hpp>

#include "layers/advance.h"
#include "layers/box_tree.h"
#include "sequences/experiments/culling/flat_scan.h"
#include "sequences/experiments/culling/octree.h"
#include "sequences/pipeline/step.h"
#include "tests/layers/boxes_by_lot.h"
#include "tests/support/fleet.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

constexpr int kParts = 100'000;

/// A cube around the middle of one box that holds about `share` of them, as six planes turned by a little.
layers::Region region_with(double share, std::span<const layers::Box3> boxes) {
  const layers::Box3& one = boxes[12'345];
  const layers::dvec3 middle(one.lo[0], one.lo[1], one.lo[2]);
  double size = 0.1;
  layers::Region region;
  for (;; size *= 1.1) {
    region.clear();
    for (int k = 0; k < 6; ++k) {
      layers::dvec3 n(0.05, 0.02, 0.03);
      n[k / 2] += k % 2 == 0 ? 1 : -1;
      region.push_back({n, size - glm::dot(n, middle)});
    }
    if (size > 1e3 || layers::met_slowly(region, boxes).size() >= share * double(boxes.size())) return region;
  }
}

template <typename Index>
void query(benchmark::State& run, Index index, bool clustered, double share, bool cold) {
  const auto boxes = layers::boxes_by_lot(kParts, 100, clustered, 19);
  index.build(boxes);
  const layers::Region region = region_with(share, boxes);
  std::vector<char> other(64 << 20);
  std::vector<int> found;
  layers::QueryCounters counters;
  for (auto _ : run) {
    if (cold) {
      run.PauseTiming();
      for (std::size_t i = 0; i < other.size(); i += 64) ++other[i];
      run.ResumeTiming();
    }
    found.clear();
    counters = {};
    index.query(region, found, counters);
    benchmark::DoNotOptimize(found.data());
  }
  run.counters["found"] = double(found.size());
  run.counters["nodes"] = double(counters.nodes);
}

void register_queries() {
  for (const bool cold : {false, true})
    for (const bool clustered : {false, true})
      for (const double share : {0.001, 0.01, 0.1, 1.0}) {
        const auto add = [&](const char* name, const auto& index) {
          const std::string title = std::string("query/") + name + (clustered ? "/clustered/" : "/uniform/") +
                                    std::to_string(share * 100).substr(0, 5) + "%" + (cold ? "/cold" : "");
          benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& run) {
            query(run, index, clustered, share, cold);
          })->Unit(benchmark::kMicrosecond);
        };
        add("tree", layers::BoxTree());
        add("flat", sequences::FlatScan());
        if (cold) continue;
        add("octree", sequences::Octree(1));
        add("loose", sequences::Octree(2));
      }
}

void advance(benchmark::State& run) {
  layers::Scene scene = fleet_scene(10, 1);
  for (int i = 0; i < kParts; ++i) scene.nodes.push_back({"", -1, {}});
  const layers::SceneMotion motion(scene);
  layers::SceneFrame frame = scene.at(0);
  double t = 0;
  for (auto _ : run) motion.advance(frame, t += 0.04);
  run.counters["moving"] = double(motion.moving_nodes().size());
}
BENCHMARK(advance)->Unit(benchmark::kMicrosecond);

/// Cubes in a slab around a camera that sways a little: `everywhere`, or only where it ever looks.
layers::Scene cubes_around(bool everywhere) {
  layers::Scene scene = cube_scene();
  scene.parts.clear();
  scene.nodes = {{"camera", -1, {}}};
  scene.cameras = {{"camera", 0, 0.75, 0.1, 1e4}};
  layers::FlightTrack flight;
  flight.position = {{0, 5, 10}, {{0, 0, 0}, {0.5, 0, 0}, {0, 0.2, 0}}};
  flight.target = {{0}, {{0, 0, -100}}};
  scene.tracks = {{0, flight}};
  constexpr int kSide = 59;  // 59² · 4 = 13,924
  for (int i = 0; i < 4 * kSide * kSide; ++i) {
    const layers::dvec3 at(6.0 * (i % kSide - kSide / 2), 3.0 * (i / (kSide * kSide) - 1.5),
                           6.0 * (i / kSide % kSide - kSide / 2));
    if (!everywhere && (at.z > -3 || std::fabs(at.x) > -0.62 * at.z + 3 || at.z < -80)) continue;
    if (everywhere && at.z < -80 && std::fabs(at.x) < 2000) continue;
    layers::Node node;
    node.local.translation = at;
    scene.parts.push_back({"cube " + std::to_string(i), static_cast<int>(scene.nodes.size()), 0, 0});
    scene.nodes.push_back(node);
  }
  return scene;
}

void plan(benchmark::State& run, bool everywhere, bool culls) {
  const layers::Scene scene = cubes_around(everywhere);
  sequences::Settings settings;
  settings.regulator.policy = regulator::Policy::Threshold;
  settings.cycles = sequences::Cycles::Keep;
  settings.view.display_px = {640, 480};
  settings.frames = 240;
  if (culls) settings.visibility.objects = sequences::ViewTest::Frustum;
  const sequences::Pipeline pipeline =
      sequences::make_pipeline(scene, layers::factor(scene, one_layer_per_part(scene)), settings);
  sequences::PipelineState state(pipeline);
  double plan_ms = 0, in_view = 0;
  int frame = 0;
  for (auto _ : run) {
    const sequences::FrameReport report =
        sequences::step(pipeline, state, frame++ % settings.frames, nullptr);
    plan_ms += report.times.plan_ms;
    for (const regulator::LayerAssessment& a : report.assessments) in_view += a.in_view;
  }
  run.counters["plan_ms"] = plan_ms / double(run.iterations());
  run.counters["in_view"] = in_view / double(run.iterations());
  run.counters["layers"] = double(pipeline.authored.size());
}
BENCHMARK_CAPTURE(plan, all, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, all_culled, true, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, those_in_view, false, false)->Unit(benchmark::kMillisecond);

[[maybe_unused]] const bool kRegistered = (register_queries(), true);

}  // namespace
}  // namespace talisman::tests
