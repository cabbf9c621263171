// SPDX-License-Identifier: Apache-2.0

/// What does it cost to follow the light on one layer? One layer, one frame, on one thread, two lights and
/// ambient light. `highlights` adds a specular term.
///
///   capture_unlit   what a layer costs whose light cannot change
///   capture_lit     the same with normals and colours of the characteristic points
///   photometric     both forms of the fiducial, of two captured states
///   turned_faces    the facing fiducial, of the same
///
/// What following the light costs per layer and frame is (capture_lit - capture_unlit) + photometric.

#include <benchmark/benchmark.h>

#include "fiducials/photometric.h"
#include "fiducials/turned_faces.h"
#include "tests/layers/worlds.h"

namespace talisman::tests {
namespace {

struct Workload {
  explicit Workload(const benchmark::State& run, bool lit)
      : world(box_corners({1, 0.5, 2}), static_cast<layers::BoundKind>(run.range(0))) {
    world.lights = {ambient({0.2f, 0.2f, 0.2f}), sun({0, -1, 0}), lamp({4, 3, -2})};
    if (lit) world.bound.surface.emplace();
    if (lit) world.bound.surface->base = {0.5, 0.5, 0.5};
    if (lit && run.range(1) == 1) {
      world.bound.surface->specular = {0.5, 0.5, 0.5};
      world.bound.surface->shininess = 30;
    }
    world.bound.follows_faces = lit;
    frame.scene = &world.scene;
    frame.world_from_node = {moved_by({0, 0, -10}) * turned_by(0.5, {1, 2, 3})};
    frame.lights = world.lights;
    then = capture();
    frame.world_from_node = {moved_by({0.2, 0, -10}) * turned_by(0.6, {1, 2, 3})};
    now = capture();
  }
  layers::LayerState capture() const { return layers::capture(frame, world.layer, world.bound, world.view); }
  World world;
  layers::SceneFrame frame;
  layers::LayerState then, now;
};

void capture_unlit(benchmark::State& run) {
  const Workload work(run, false);
  for (auto _ : run) benchmark::DoNotOptimize(work.capture());
}

void capture_lit(benchmark::State& run) {
  const Workload work(run, true);
  for (auto _ : run) benchmark::DoNotOptimize(work.capture());
}

void photometric(benchmark::State& run) {
  const Workload work(run, true);
  for (auto _ : run)
    benchmark::DoNotOptimize(fiducials::photometric_of(work.then, work.now, work.world.bound));
}

void turned_faces(benchmark::State& run) {
  const Workload work(run, true);
  for (auto _ : run)
    benchmark::DoNotOptimize(fiducials::turned_faces_of(work.then, work.now, work.world.bound.hull));
}

void kinds(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"kind", "highlights"})->ArgsProduct({{0, 1, 2}, {0, 1}});
}
BENCHMARK(capture_unlit)->Apply(kinds);
BENCHMARK(capture_lit)->Apply(kinds);
BENCHMARK(photometric)->Apply(kinds);
BENCHMARK(turned_faces)->Apply(kinds);

}  // namespace
}  // namespace talisman::tests
