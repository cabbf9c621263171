// SPDX-License-Identifier: Apache-2.0
/// How many pixels does the compositor lay per second? The workload is that of the peers (peers/sprite_stack.h);
/// tests/bench/run sets ours beside theirs. Mpixel/s = display pixels inside sprite rectangles per second.

#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "chunker/span_composite.h"
#include "tests/bench/peers/sprite_stack.h"

namespace talisman::bench {
namespace {

void composite_stack(benchmark::State& state, const SpriteStack& stack, int thread_count = 1) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(thread_count));
  std::int64_t pixels = 0;
  chunker::Frame target;
  for (auto _ : state)
    pixels += chunker::composite_into(target, stack.placed, kDisplay, kBackground).pixels_composited;
  state.counters["Mpx/s"] =
      benchmark::Counter(static_cast<double>(pixels) * 1e-6, benchmark::Counter::kIsRate);
}

/// Arguments: sprites, area in displays, threads.
void composite_warped(benchmark::State& state) {
  composite_stack(
      state, make_sprite_stack(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), false),
      static_cast<int>(state.range(2)));
}
BENCHMARK(composite_warped)
    ->ArgsProduct({{10, 80, 119}, {2, 4, 8}, {1}})
    ->Args({1000, 4, 1})
    ->Args({80, 4, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.3);

/// Sprites shown as they were drawn, on the display's lattice.
void composite_unwarped(benchmark::State& state) { composite_stack(state, make_sprite_stack(80, 4, true)); }
BENCHMARK(composite_unwarped)->Unit(benchmark::kMillisecond)->MinTime(0.3);

/// The same workload on each instruction set, one thread.
void composite_by_instruction_set(benchmark::State& state) {
  const std::vector<std::int64_t> sets = chunker::instruction_sets();
  if (static_cast<std::size_t>(state.range(0)) >= sets.size())
    return state.SkipWithError("not on this machine");
  chunker::use_instruction_set(sets[state.range(0)]);
  state.SetLabel(chunker::instruction_set_name(sets[state.range(0)]));
  composite_stack(state, make_sprite_stack(80, 4, false));
  chunker::use_instruction_set(0);
}
BENCHMARK(composite_by_instruction_set)->DenseRange(0, 4)->Unit(benchmark::kMillisecond)->MinTime(0.3);

/// A perspective map divides per pixel.
void composite_perspective(benchmark::State& state) {
  SpriteStack stack = make_sprite_stack(80, 4, false);
  for (chunker::PlacedSprite& placed : stack.placed) placed.screen_from_sprite[0][2] = 1e-5;
  composite_stack(state, stack);
}
BENCHMARK(composite_perspective)->Unit(benchmark::kMillisecond)->MinTime(0.3);

}  // namespace
}  // namespace talisman::bench
