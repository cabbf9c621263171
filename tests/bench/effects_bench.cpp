// SPDX-License-Identifier: Apache-2.0

/// What does an effect cost that a scene does not call for? One process of that measurement: a sequence that
/// calls for every effect but a policy (tests/support/sequences.h), one effect taken away from it
/// (sequences/experiments/effect_removal.h), is planned, drawn and composited on one thread. tests/bench/effect_builds
/// runs it in the normal build and in one that was configured without the effect, and compares.
///
///   effects_bench EFFECT|none [--frames N] [--repeats N] [--size WxH]
///
/// prints one line of JSON:
///
///   cpu_ms            processor time of each repetition: scene preparation, pipeline, N frames
///   allocations       calls of operator new in one repetition; exact, the same in every run
///   peak_bytes        most bytes that were held at one time, beyond what was held before it
///   frame_hash        of the pictures of all frames
///   polygons, pixels  counters, so that nobody compares runs that drew nothing
///
/// The repetition is one function, effects_bench_run, on which `valgrind --tool=callgrind
/// --toggle-collect=effects_bench_run` can be limited.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "sequences/commands/missing_effects.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "tests/support/sequences.h"

namespace {

/// What operator new has handed out, in the bytes that were asked for. One thread only.
struct Heap {
  long long allocations = 0;
  long long live_bytes = 0, peak_bytes = 0;
} heap;

constexpr std::size_t kHeader = 16;  ///< before each block, or its alignment where that is more

/// A block whose size is written before it.
void* take(std::size_t size, std::size_t align) {
  const std::size_t before = std::max(kHeader, align);
  char* memory =
      static_cast<char*>(std::aligned_alloc(before, (before + size + before - 1) / before * before));
  if (memory == nullptr) throw std::bad_alloc();
  ++heap.allocations;
  heap.live_bytes += static_cast<long long>(size);
  heap.peak_bytes = std::max(heap.peak_bytes, heap.live_bytes);
  std::memcpy(memory + before - kHeader, &size, sizeof size);
  return memory + before;
}

void give_back(void* block, std::size_t align) {
  if (block == nullptr) return;
  std::size_t size = 0;
  std::memcpy(&size, static_cast<char*>(block) - kHeader, sizeof size);
  heap.live_bytes -= static_cast<long long>(size);
  std::free(static_cast<char*>(block) - std::max(kHeader, align));
}

std::size_t bytes(std::align_val_t align) { return static_cast<std::size_t>(align); }

}  // namespace

void* operator new(std::size_t size) { return take(size, kHeader); }
void* operator new[](std::size_t size) { return take(size, kHeader); }
void* operator new(std::size_t size, std::align_val_t align) { return take(size, bytes(align)); }
void* operator new[](std::size_t size, std::align_val_t align) { return take(size, bytes(align)); }
void operator delete(void* block) noexcept { give_back(block, kHeader); }
void operator delete[](void* block) noexcept { give_back(block, kHeader); }
void operator delete(void* block, std::size_t) noexcept { give_back(block, kHeader); }
void operator delete[](void* block, std::size_t) noexcept { give_back(block, kHeader); }
void operator delete(void* block, std::align_val_t align) noexcept { give_back(block, bytes(align)); }
void operator delete[](void* block, std::align_val_t align) noexcept { give_back(block, bytes(align)); }
void operator delete(void* block, std::size_t, std::align_val_t align) noexcept {
  give_back(block, bytes(align));
}
void operator delete[](void* block, std::size_t, std::align_val_t align) noexcept {
  give_back(block, bytes(align));
}

/// What a repetition leaves behind.
struct Drawn {
  std::string frame_hash;
  long long polygons = 0, pixels = 0;
};

/// A run as `talisman render` does it, without files.
extern "C" __attribute__((noinline)) void effects_bench_run(const talisman::sequences::Variant& variant,
                                                            int frames, Drawn& drawn) {
  using namespace talisman;
  const sequences::Pipeline pipeline =
      sequences::make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  const chunker::PreparedScene prepared(*variant.sequence.scene, variant.settings.render);
  sequences::PipelineState state(pipeline);
  for (int frame = 0; frame < frames; ++frame) {
    const sequences::FrameReport report = sequences::step(pipeline, state, frame, &prepared);
    drawn.polygons += report.render.polygons_drawn;
    drawn.pixels += report.render.pixels_shaded;
    drawn.frame_hash += sequences::hash_of(report.picture);
  }
}

namespace talisman::tests {
namespace {

struct Options {
  std::string effect;
  int frames = 12, repeats = 1, width = 160, height = 120;
};

Options options_from(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (word == "--frames")
      options.frames = std::atoi(value), ++i;
    else if (word == "--repeats")
      options.repeats = std::atoi(value), ++i;
    else if (word == "--size")
      std::sscanf(value, "%dx%d", &options.width, &options.height), ++i;
    else
      options.effect = word;
  }
  return options;
}

/// The sequence that calls for everything, without one effect.
sequences::Variant workload(const Options& options) {
  sequences::Variant variant = every_effect(options.frames);
  variant.settings.view.display_px = variant.sequence.display_px = {options.width, options.height};
  for (const layers::Effect effect : layers::kAllEffects)
    if (layers::name(effect) == options.effect) return sequences::without_effect(variant, effect);
  if (options.effect != "none") throw sequences::InputError("'" + options.effect + "' is no effect");
  return variant;
}

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// FNV-1a 64 of the hashes of all frames.
unsigned long long joined(const std::string& text) {
  unsigned long long hash = 1469598103934665603ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

int measure(const Options& options) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const sequences::Variant variant = workload(options);
  sequences::require_built_effects(variant.sequence, variant.settings);
  std::string times;
  Drawn drawn;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    drawn = {};
    heap.allocations = 0;
    heap.peak_bytes = heap.live_bytes;
    const long long before = heap.live_bytes;
    const double start = cpu_ms();
    effects_bench_run(variant, options.frames, drawn);
    const double end = cpu_ms();
    heap.peak_bytes -= before;
    times += (repeat > 0 ? ", " : "") + std::to_string(end - start);
    if (repeat + 1 < options.repeats) continue;
    const long long allocations = heap.allocations, peak = heap.peak_bytes;
    std::printf(
        "{\"effect\": \"%s\", \"frames\": %d, \"cpu_ms\": [%s], \"allocations\": %lld, \"peak_bytes\": %lld, "
        "\"frame_hash\": \"%016llx\", \"polygons\": %lld, \"pixels\": %lld}\n",
        options.effect.c_str(), options.frames, times.c_str(), allocations, peak, joined(drawn.frame_hash),
        drawn.polygons, drawn.pixels);
  }
  return sequences::kSuccess;
}

}  // namespace
}  // namespace talisman::tests

int main(int argc, char** argv) try {
  return talisman::tests::measure(talisman::tests::options_from(argc, argv));
} catch (const talisman::sequences::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return talisman::sequences::kBadInput;
}
