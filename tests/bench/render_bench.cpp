// SPDX-License-Identifier: Apache-2.0
// What does a rendered sprite cost? The workload of the peers' table: a displaced sphere at 1024², 5k / 70k /
// 500k triangles. Mtri/s counts the triangles of the layer, Mpix/s the display pixels that the sphere covers.
#include <numeric>
#include <random>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "chunker/render.h"
#include "chunker/shadow_map.h"
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

void render_scene(benchmark::State& state, const layers::Scene& scene, const chunker::RenderOptions& options,
                  std::int64_t thread_count, const chunker::ShadeInputs& inputs = {}) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, thread_count);
  const chunker::PreparedScene prepared(scene);
  const layers::SceneFrame frame = scene.at(0);
  std::vector<int> parts(scene.parts.size());
  std::iota(parts.begin(), parts.end(), 0);
  layers::SpritePlacement placement;
  placement.size_px = {1024, 1024};
  chunker::RenderResult result;
  for (auto _ : state) {
    result = chunker::render(prepared, frame, parts, placement.size_px, placement, options, inputs);
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

chunker::RenderOptions shaded(chunker::Shading shading) {
  chunker::RenderOptions options;
  options.shading = shading;
  return options;
}

void render_gouraud(benchmark::State& state) {
  render_scene(state, workload(static_cast<int>(state.range(0))), shaded(chunker::Shading::Gouraud),
               state.range(1));
}
void render_phong(benchmark::State& state) {
  render_scene(state, workload(static_cast<int>(state.range(0))), shaded(chunker::Shading::Phong),
               state.range(1));
}

/// Nothing but filling: one textured, lit square over the whole display.
void fill_display(benchmark::State& state) {
  layers::Scene scene = tests::textured_quad_scene();
  for (layers::vec3& p : scene.meshes[scene.parts[0].mesh].positions) p *= 4.0f;
  render_scene(state, scene, shaded(chunker::Shading::Gouraud), state.range(0));
}

/// What fewer samples of coverage save.
void render_samples(benchmark::State& state) {
  chunker::RenderOptions options;
  options.samples = static_cast<int>(state.range(0));
  render_scene(state, workload(70000), options, 1);
}

/// Nothing but edges: 200,000 small, slanted triangles in a cube that cross each other wherever they meet.
layers::Scene thicket() {
  layers::Scene scene = tests::displaced_sphere_scene(20);
  layers::Mesh mesh;
  std::mt19937 random(12);
  std::uniform_real_distribution<float> place(-1, 1), side(-0.02f, 0.02f);
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const layers::vec3 at(place(random), place(random), place(random));
    for (std::uint32_t k = 0; k < 3; ++k) {
      mesh.positions.push_back(at + layers::vec3(side(random), side(random), side(random)));
      mesh.normals.emplace_back(0, 0, 1);
      mesh.indices.push_back(3 * i + k);
    }
  }
  scene.meshes[scene.parts[0].mesh] = mesh;
  for (layers::Material& material : scene.materials) material.two_sided = true;
  return scene;
}

void render_thicket_samples(benchmark::State& state) {
  chunker::RenderOptions options;
  options.shading = chunker::Shading::Gouraud;
  options.samples = static_cast<int>(state.range(0));
  render_scene(state, thicket(), options, 1);
}

/// What samples along the line of anisotropy cost.
void render_anisotropic(benchmark::State& state) {
  chunker::RenderOptions options;
  options.max_anisotropy = static_cast<int>(state.range(0));
  render_scene(state, workload(5000), options, 1);
}

/// What a shadow costs: the ball shadows itself; filter radius 0, 1, 3.
void render_shadowed(benchmark::State& state) {
  const layers::Scene scene = workload(70000);
  layers::ShadowMapOptions shadow;
  shadow.pcf_radius = static_cast<int>(state.range(0));
  std::vector<chunker::ShadowMap> maps(scene.lights.size());
  std::vector<const chunker::ShadowMap*> pointers;
  const std::vector<int> casters{0};
  for (int i = 0; i < static_cast<int>(maps.size()); ++i)
    maps[i] = chunker::make_shadow_map(scene.at(0), i, casters, shadow);
  for (const chunker::ShadowMap& map : maps) pointers.push_back(&map);
  chunker::ShadeInputs inputs;
  inputs.shadow_maps = pointers;
  render_scene(state, scene, {}, 1, inputs);
}

/// The map itself, by resolution.
void draw_shadow_map(benchmark::State& state) {
  const layers::Scene scene = workload(70000);
  const layers::SceneFrame frame = scene.at(0);
  layers::ShadowMapOptions shadow;
  shadow.resolution_px = static_cast<int>(state.range(0));
  const std::vector<int> casters{0};
  for (auto _ : state)
    for (int i = 0; i < static_cast<int>(scene.lights.size()); ++i)
      benchmark::DoNotOptimize(chunker::make_shadow_map(frame, i, casters, shadow));
}

BENCHMARK(render_samples)->Arg(1)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(render_thicket_samples)->Arg(1)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(render_anisotropic)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(render_shadowed)->Arg(0)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(draw_shadow_map)->Arg(256)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(fill_display)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(render_gouraud)
    ->ArgsProduct({{5000, 70000, 500000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(render_phong)
    ->ArgsProduct({{5000, 70000, 500000}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
