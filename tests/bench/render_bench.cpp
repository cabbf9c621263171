// SPDX-License-Identifier: Apache-2.0
// What does a rendered sprite cost? The workload of the peers' table: a displaced sphere at 1024², 5k / 70k /
// 500k triangles. Mtri/s counts the triangles of the layer, Mpix/s the display pixels that the sphere covers.
#include <numeric>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "chunker/render.h"
#include "tests/support/scenes.h"

namespace {

using namespace talisman;

std::int64_t covered(const chunker::Sprite& sprite) {
  std::int64_t count = 0;
  for (int y = 0; y < sprite.size_px().y; ++y)
    for (int x = 0; x < sprite.size_px().x; ++x) count += sprite.texel(x, y).a > 0 ? 1 : 0;
  return count;
}

/// A checkerboard of 512² texels, as large as the peers' texture.
layers::Scene workload(int triangles) {
  layers::Scene scene = tests::displaced_sphere_scene(triangles);
  scene.textures.assign(1, tests::checker_texture(32, 16));
  for (layers::Material& material : scene.materials) material.texture = 0;
  return scene;
}

void render_scene(benchmark::State& state, const layers::Scene& scene, chunker::Shading shading,
                  std::int64_t thread_count) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, thread_count);
  const chunker::PreparedScene prepared(scene);
  const layers::SceneFrame frame = scene.at(0);
  std::vector<int> parts(scene.parts.size());
  std::iota(parts.begin(), parts.end(), 0);
  layers::SpritePlacement placement;
  placement.size_px = {1024, 1024};
  chunker::RenderOptions options;
  options.shading = shading;
  chunker::RenderResult result;
  for (auto _ : state) {
    result = chunker::render(prepared, frame, parts, placement.size_px, placement, options);
    benchmark::DoNotOptimize(result);
  }
  const double runs = static_cast<double>(state.iterations());
  const auto rate = [&](double count) {
    return benchmark::Counter(count * runs / 1e6, benchmark::Counter::kIsRate);
  };
  state.counters["Mtri/s"] = rate(static_cast<double>(result.counters.polygons_in));
  state.counters["Mpix/s"] = rate(static_cast<double>(covered(result.sprite)));
  state.counters["shaded"] = static_cast<double>(result.counters.pixels_shaded);
  state.counters["fragments"] = static_cast<double>(result.counters.fragments);
  state.counters["merged"] = static_cast<double>(result.counters.fragments_merged);
  state.counters["subdivided"] = static_cast<double>(result.counters.chunk_subdivisions);
}

void RenderGouraud(benchmark::State& state) {
  render_scene(state, workload(static_cast<int>(state.range(0))), chunker::Shading::Gouraud, state.range(1));
}
void RenderPhong(benchmark::State& state) {
  render_scene(state, workload(static_cast<int>(state.range(0))), chunker::Shading::Phong, state.range(1));
}

/// Nothing but filling: one textured, lit square over the whole display.
void FillDisplay(benchmark::State& state) {
  layers::Scene scene = tests::textured_quad_scene();
  for (layers::vec3& p : scene.meshes[scene.parts[0].mesh].positions) p *= 4.0f;
  render_scene(state, scene, chunker::Shading::Gouraud, state.range(0));
}

BENCHMARK(FillDisplay)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(RenderGouraud)
    ->ArgsProduct({{5000, 70000, 500000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(RenderPhong)
    ->ArgsProduct({{5000, 70000, 500000}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
