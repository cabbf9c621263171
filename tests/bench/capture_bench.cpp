// SPDX-License-Identifier: Apache-2.0

/// What does it cost to know where a layer is? One layer, one frame, on one thread.
///
///   capture      state of a rigid layer from its node matrix
///   correspond   matched points of two states, in view and clipped
///   place        sprite rectangle, 16 slab directions
///   frame        capture + correspond; what every layer costs in every frame. `place` is added when it is
///   drawn.

#include <benchmark/benchmark.h>

#include "layers/sprite_transform.h"
#include "tests/layers/worlds.h"

namespace talisman::tests {
namespace {

enum Situation { InView, CutBySide, AroundCamera };

/// Vertices of an ellipsoid, so that all faces of all kinds have an area.
std::vector<dvec3> ellipsoid(const dvec3& half_size) {
  std::mt19937 random(1);
  std::vector<dvec3> points;
  for (int i = 0; i < 500; ++i) points.push_back(half_size * glm::normalize(uniform3(random, -1, 1)));
  return points;
}

struct Workload {
  explicit Workload(const benchmark::State& run)
      : world(ellipsoid(run.range(1) == AroundCamera ? dvec3(3, 3, 400) : dvec3(2.5, 0.6, 0.8)),
              static_cast<layers::BoundKind>(run.range(0))) {
    const dvec3 places[] = {{0.4, 0.3, -8}, {4.2, 0.3, -8}, {0, 1, 0}};
    place = moved_by(places[run.range(1)]) * turned_by(run.range(1) == AroundCamera ? 0 : 0.3, {1, 2, 3});
    then = world.at(place);
    now = world.at(moved_by({0.03, 0.01, 0.05}) * place);
  }
  World world;
  dmat4 place;
  layers::LayerState then, now;
};

void capture_scene(benchmark::State& run) {
  const Workload work(run);
  const layers::SceneFrame frame = work.world.frame_at(work.place);
  for (auto _ : run) {
    benchmark::DoNotOptimize(layers::capture(frame, work.world.layer, work.world.bound, work.world.view));
  }
}

void correspond_points(benchmark::State& run) {
  const Workload work(run);
  std::size_t points = 0;
  for (auto _ : run) points = correspond(work.then, work.now, work.world.bound.hull).point.size();
  run.counters["points"] = static_cast<double>(points);
}

void place_on_display(benchmark::State& run) {
  const Workload work(run);
  for (auto _ : run)
    benchmark::DoNotOptimize(place_sprite(work.then, work.now, work.world.bound.hull, {}, {}));
}

void whole_frame(benchmark::State& run) {
  const Workload work(run);
  const layers::SceneFrame frame = work.world.frame_at(work.place);
  for (auto _ : run) {
    const auto now = layers::capture(frame, work.world.layer, work.world.bound, work.world.view);
    benchmark::DoNotOptimize(correspond(work.then, now, work.world.bound.hull));
  }
}

void situations(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"kind", "situation"})->ArgsProduct({{0, 1, 2}, {InView, CutBySide, AroundCamera}});
}
BENCHMARK(capture_scene)->Apply(situations);
BENCHMARK(correspond_points)->Apply(situations);
BENCHMARK(place_on_display)->Apply(situations);
BENCHMARK(whole_frame)->Apply(situations);

}  // namespace
}  // namespace talisman::tests
