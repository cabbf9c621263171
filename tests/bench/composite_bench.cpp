// SPDX-License-Identifier: Apache-2.0
/// How many pixels does the compositor lay per second, and how does a general image library do on the same
/// work?
///
/// Workload: 1344×1024; 10, 80 or 119 sprites whose rectangles add up to 2, 4 or 8 displays; turned by ±5°,
/// scaled by 0.9 … 1.1, bilinear; super-elliptic alpha with soft edges, every fourth sprite translucent.
/// Mpixel/s = display pixels inside sprite rectangles per second. Peer: OpenCV warpAffine of 8-bit
/// premultiplied RGBA into the sprite's rectangle, then over, written plainly. It is single-threaded and 8
/// bit where we are 16-bit linear. Both run in turn in each repetition, so compare the ratio, not the
/// absolute values.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "chunker/composite.h"
#include "chunker/span_composite.h"

namespace talisman::chunker {
namespace {

constexpr layers::ivec2 kDisplay{1344, 1024};
constexpr layers::vec3 kBackground{0.05f, 0.05f, 0.05f};

struct Workload {
  std::vector<Sprite> sprites;
  std::vector<cv::Mat> pictures;  ///< the same texels, 8-bit premultiplied RGBA
  std::vector<PlacedSprite> stack;
};

Texel shaded(double u, double v, bool translucent) {
  const double edge = (1 - std::pow(std::abs(u), 6) - std::pow(std::abs(v), 6)) * 6;
  const double alpha = std::clamp(edge, 0.0, 1.0) * (translucent ? 0.5 : 1);
  const auto channel = [&](double c) { return static_cast<float>(alpha * c); };
  return encode(
      {channel(0.5 + 0.5 * u), channel(0.5 + 0.5 * v), channel(0.5 + 0.4 * std::sin(9 * u)), channel(1)});
}

/// Texel (x, y) of a sprite goes to both representations.
void add_sprite(Workload& work, layers::ivec2 size, bool translucent) {
  Sprite sprite(size);
  cv::Mat picture(size.y, size.x, CV_8UC4);
  for (int row = 0; row < sprite.chunks().y; ++row) {
    for (int column = 0; column < sprite.chunks().x; ++column) {
      Chunk chunk;
      for (int i = 0; i < kChunkSize * kChunkSize; ++i) {
        const int x = column * kChunkSize + i % kChunkSize, y = row * kChunkSize + i / kChunkSize;
        if (x >= size.x || y >= size.y) continue;
        const Texel t = shaded(2 * (x + 0.5) / size.x - 1, 2 * (y + 0.5) / size.y - 1, translucent);
        chunk.texels[i] = t;
        picture.at<cv::Vec4b>(y, x) = {t.r, t.g, t.b, t.a};
      }
      sprite.store(column, row, chunk);
    }
  }
  work.sprites.push_back(std::move(sprite));
  work.pictures.push_back(picture);
}

Workload make_workload(int count, int displays, bool unwarped) {
  std::mt19937_64 engine(count * 100 + displays);
  std::uniform_real_distribution<double> unit(0, 1);
  Workload work;
  const double area = static_cast<double>(displays) * kDisplay.x * kDisplay.y / count;
  for (int i = 0; i < count; ++i) {
    const double aspect = std::exp(0.7 * (unit(engine) - 0.5));
    const layers::ivec2 size{std::min(static_cast<int>(std::sqrt(area * aspect)), kDisplay.x),
                             std::min(static_cast<int>(std::sqrt(area / aspect)), kDisplay.y)};
    add_sprite(work, size, i % 4 == 3);
  }
  for (const Sprite& sprite : work.sprites) {
    const double angle = (unit(engine) - 0.5) * 10 * M_PI / 180, scale = 0.9 + 0.2 * unit(engine);
    const double c = scale * std::cos(angle), s = scale * std::sin(angle);
    const double x = unit(engine) * (kDisplay.x - sprite.size_px().x),
                 y = unit(engine) * (kDisplay.y - sprite.size_px().y);
    PlacedSprite placed;
    placed.sprite = &sprite;
    const layers::Affine2 warped{c, -s, x, s, c, y}, lattice{1, 0, std::floor(x), 0, 1, std::floor(y)};
    placed.screen_from_sprite = layers::to_mat3(unwarped ? lattice : warped);
    work.stack.push_back(placed);
  }
  return work;
}

/// Display rectangle of a warped sprite.
cv::Rect bounds(const PlacedSprite& placed) {
  const layers::ivec2 size = placed.sprite->size_px();
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
  for (const auto& corner : {layers::dvec3(0, 0, 1), layers::dvec3(size.x, 0, 1), layers::dvec3(0, size.y, 1),
                             layers::dvec3(size, 1)}) {
    const layers::dvec3 p = placed.screen_from_sprite * corner;
    x0 = std::min(x0, p.x), y0 = std::min(y0, p.y), x1 = std::max(x1, p.x), y1 = std::max(y1, p.y);
  }
  const cv::Point lo(static_cast<int>(std::floor(x0)), static_cast<int>(std::floor(y0)));
  const cv::Point hi(static_cast<int>(std::ceil(x1)), static_cast<int>(std::ceil(y1)));
  return cv::Rect(lo, hi) & cv::Rect(0, 0, kDisplay.x, kDisplay.y);
}

void over_row(const std::uint8_t* source, std::uint8_t* below, int pixels) {
  for (int i = 0; i < pixels; ++i) {
    const std::uint32_t through = 255u - source[4 * i + 3];
    for (int c = 0; c < 4; ++c) {
      const std::uint32_t product = below[4 * i + c] * through + 128;
      below[4 * i + c] =
          static_cast<std::uint8_t>(std::min(255u, source[4 * i + c] + ((product + (product >> 8)) >> 8)));
    }
  }
}

void opencv_composite(const Workload& work, cv::Mat& frame, cv::Mat& warped) {
  frame.setTo(cv::Scalar(64, 64, 64, 255));
  for (std::size_t i = 0; i < work.stack.size(); ++i) {
    const cv::Rect rect = bounds(work.stack[i]);
    const layers::dmat3& m = work.stack[i].screen_from_sprite;
    // OpenCV's pixel centres are at whole numbers.
    const cv::Matx23d map(m[0][0], m[1][0], m[2][0] + 0.5 * (m[0][0] + m[1][0]) - 0.5 - rect.x, m[0][1],
                          m[1][1], m[2][1] + 0.5 * (m[0][1] + m[1][1]) - 0.5 - rect.y);
    cv::Mat target = warped(cv::Rect(0, 0, rect.width, rect.height));
    cv::warpAffine(work.pictures[i], target, map, target.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    for (int y = 0; y < rect.height; ++y)
      over_row(target.ptr(y), frame.ptr(rect.y + y) + 4 * rect.x, rect.width);
  }
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
  return v[v.size() / 2];
}

template <typename F>
double seconds(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Arguments: sprites, area in displays, threads.
void composite_beside_opencv(benchmark::State& state) {
  const Workload work =
      make_workload(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), false);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, state.range(2));
  cv::setNumThreads(1);
  cv::Mat frame(kDisplay.y, kDisplay.x, CV_8UC4), warped(kDisplay.y, kDisplay.x, CV_8UC4);
  std::vector<double> ours, peers;
  std::int64_t pixels = 0;
  Frame target;
  for (auto _ : state) {
    ours.push_back(seconds(
        [&] { pixels = composite_into(target, work.stack, kDisplay, kBackground).pixels_composited; }));
    state.SetIterationTime(ours.back());
    peers.push_back(seconds([&] { opencv_composite(work, frame, warped); }));
  }
  state.counters["Mpx/s"] = pixels / median(ours) * 1e-6;
  state.counters["OpenCV_Mpx/s"] = pixels / median(peers) * 1e-6;
  state.counters["ratio"] = median(peers) / median(ours);
}
BENCHMARK(composite_beside_opencv)
    ->ArgsProduct({{10, 80, 119}, {2, 4, 8}, {1}})
    ->Args({80, 4, 2})
    ->Iterations(11)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Sprites shown as they were drawn, on the display's lattice.
void composite_unwarped(benchmark::State& state) {
  const Workload work =
      make_workload(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), true);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
  std::int64_t pixels = 0;
  Frame target;
  for (auto _ : state) pixels += composite_into(target, work.stack, kDisplay, kBackground).pixels_composited;
  state.counters["Mpx/s"] = benchmark::Counter(pixels * 1e-6, benchmark::Counter::kIsRate);
}
BENCHMARK(composite_unwarped)->Args({80, 4})->Unit(benchmark::kMillisecond)->MinTime(0.3);

/// The same workload on each instruction set, one thread.
void composite_by_instruction_set(benchmark::State& state) {
  const std::vector<std::int64_t> sets = instruction_sets();
  if (static_cast<std::size_t>(state.range(0)) >= sets.size())
    return state.SkipWithError("not on this machine");
  const Workload work = make_workload(80, 4, false);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
  use_instruction_set(sets[state.range(0)]);
  state.SetLabel(instruction_set_name(sets[state.range(0)]));
  std::int64_t pixels = 0;
  Frame target;
  for (auto _ : state) pixels += composite_into(target, work.stack, kDisplay, kBackground).pixels_composited;
  state.counters["Mpx/s"] = benchmark::Counter(pixels * 1e-6, benchmark::Counter::kIsRate);
  use_instruction_set(0);
}
BENCHMARK(composite_by_instruction_set)->DenseRange(0, 4)->Unit(benchmark::kMillisecond)->MinTime(0.3);

/// A perspective map divides per pixel.
void composite_perspective(benchmark::State& state) {
  Workload work = make_workload(80, 4, false);
  for (PlacedSprite& placed : work.stack) placed.screen_from_sprite[0][2] = 1e-5;
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
  std::int64_t pixels = 0;
  Frame target;
  for (auto _ : state) pixels += composite_into(target, work.stack, kDisplay, kBackground).pixels_composited;
  state.counters["Mpx/s"] = benchmark::Counter(pixels * 1e-6, benchmark::Counter::kIsRate);
}
BENCHMARK(composite_perspective)->Unit(benchmark::kMillisecond)->MinTime(0.3);

}  // namespace
}  // namespace talisman::chunker
