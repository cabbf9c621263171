// SPDX-License-Identifier: Apache-2.0
// Predictive rendering beside OpenCV: motion of prediction vertices, and joins of buffers with depth.
//
//   vertices   projected and compared with where they were: per vertex and frame; peer: perspectiveTransform,
//              absdiff, and the largest difference
//   joins      of two whole buffers of colour, depth and part: into one that is nearer everywhere, and into a fresh one, half
//              of which is behind; peers: compare and copyTo with its mask, of each of the
//              three; memcpy of the bytes that a join reads and writes
//   kalman     the pose that 32 poses lead to; peer: cv::KalmanFilter, one for each of the six coordinates
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/core.hpp>
#ifdef TALISMAN_OPENCV_VIDEO
#include <opencv2/video/tracking.hpp>
#endif

#include "chunker/plan_buffer.h"
#include "layers/predict_kalman.h"
#include "regulator/projected_motion.h"

namespace talisman {
namespace {

constexpr int kVertices = 8;  // of a block
constexpr layers::ivec2 kDisplay{300, 300};

std::vector<layers::dvec3> random_points(int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<layers::dvec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(unit(random), unit(random), unit(random) - 30);
  return points;
}

layers::dmat4 clip_matrix() {
  layers::CameraState camera;
  camera.fov_y_rad = 0.8;
  return layers::clip_from_world(camera, kDisplay);
}

/// As the words take it: a primitive after the other.
void motion_of_vertices(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const std::vector<layers::dvec3> points = random_points(count);
  const layers::dmat4 clip = clip_matrix();
  std::vector<layers::dvec4> then;
  for (const layers::dvec3& p : points) then.push_back(clip * layers::dvec4(p, 1));
  const regulator::DisplayScale scale({}, kDisplay);
  std::array<layers::dvec4, kVertices> now;
  for (auto _ : state) {
    int beyond = 0;
    for (int first = 0; first + kVertices <= count; first += kVertices) {
      for (int k = 0; k < kVertices; ++k) now[k] = clip * layers::dvec4(points[first + k], 1);
      beyond += regulator::sides_outside(now) == 0 &&
                regulator::is_beyond(regulator::projected_motion({&then[first], kVertices}, now, scale), 0.01,
                                     regulator::MotionNorm::Euclid);
    }
    benchmark::DoNotOptimize(beyond);
  }
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK(motion_of_vertices)->Arg(8000);

/// The same points, and where they were.
struct PointsInOpenCv {
  cv::Mat from, then, matrix = cv::Mat(4, 4, CV_64F);

  explicit PointsInOpenCv(int count) : from(count, 1, CV_64FC3) {
    const std::vector<layers::dvec3> points = random_points(count);
    for (int i = 0; i < count; ++i) from.at<cv::Vec3d>(i) = {points[i].x, points[i].y, points[i].z};
    const layers::dmat4 clip = clip_matrix();
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) matrix.at<double>(row, column) = clip[column][row];
    cv::perspectiveTransform(from, then, matrix);
  }
};

void motion_of_vertices_opencv(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const PointsInOpenCv points(count);
  cv::Mat now, difference, mask;
  for (auto _ : state) {
    int beyond = 0;
    for (int first = 0; first + kVertices <= count; first += kVertices) {
      const cv::Range range(first, first + kVertices);
      cv::perspectiveTransform(points.from.rowRange(range), now, points.matrix);
      cv::absdiff(now, points.then.rowRange(range), difference);
      cv::compare(difference.reshape(1), 0.01 / 150, mask, cv::CMP_GT);
      beyond += cv::countNonZero(mask) > 0;
    }
    benchmark::DoNotOptimize(beyond);
  }
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK(motion_of_vertices_opencv)->Arg(8000);

/// The same at once: what OpenCV is best at.
void motion_of_all_vertices_opencv(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const PointsInOpenCv points(count);
  cv::Mat now, difference, mask;
  for (auto _ : state) {
    cv::perspectiveTransform(points.from, now, points.matrix);
    cv::absdiff(now, points.then, difference);
    cv::compare(difference.reshape(1), 0.01 / 150, mask, cv::CMP_GT);
    benchmark::DoNotOptimize(cv::countNonZero(mask));
  }
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK(motion_of_all_vertices_opencv)->Arg(8000);

struct Layered {
  explicit Layered(layers::ivec2 size_px, unsigned seed) : buffer(size_px) {
    std::mt19937 random(seed);
    for (int place = 0; place < buffer.chunks().x * buffer.chunks().y; ++place) {
      chunker::Chunk color{};
      chunker::DepthChunk depth;
      for (int i = 0; i < chunker::kChunkSize * chunker::kChunkSize; ++i) {
        const unsigned roll = random();
        color.texels[i] = {static_cast<std::uint8_t>(roll), 1, 2, 255};
        depth.z[i] = 1.0f / static_cast<float>(1 + roll % 1000);
        depth.part[i] = roll % 7;
      }
      buffer.put(place, color, depth);
    }
  }
  chunker::PlanBuffer buffer;
};

void join_buffers(benchmark::State& state) {
  const layers::ivec2 size(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  Layered a(size, 1), b(size, 2);
  chunker::JoinCounters counters;
  for (auto _ : state) a.buffer.join(b.buffer, counters);
  state.SetItemsProcessed(counters.pixels_compared);
  state.SetBytesProcessed(counters.pixels_compared * 3 * 12);
}
BENCHMARK(join_buffers)->Args({300, 300})->Args({1344, 1024});

/// What is joined into is as it was before each time.
void join_fresh_buffers(benchmark::State& state) {
  const layers::ivec2 size(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const Layered a(size, 1), b(size, 2);
  chunker::PlanBuffer joined(size);
  chunker::JoinCounters counters, copies;
  for (auto _ : state) {
    state.PauseTiming();
    joined.copy(a.buffer, copies);
    state.ResumeTiming();
    joined.join(b.buffer, counters);
  }
  state.SetItemsProcessed(counters.pixels_compared);
  state.SetBytesProcessed(counters.pixels_compared * 3 * 12);
}
BENCHMARK(join_fresh_buffers)->Args({300, 300})->Args({1344, 1024});

struct BuffersInOpenCv {
  BuffersInOpenCv(int width, int height) {
    for (int i = 0; i < 2; ++i) {
      z[i].create(height, width, CV_32F);
      color[i].create(height, width, CV_8UC4);
      part[i].create(height, width, CV_32S);
      cv::randu(z[i], 0, 1);
      cv::randu(color[i], 0, 255);
      cv::randu(part[i], 0, 7);
    }
  }
  void join() {
    cv::compare(z[1], z[0], mask, cv::CMP_GT);
    z[1].copyTo(z[0], mask);
    color[1].copyTo(color[0], mask);
    part[1].copyTo(part[0], mask);
  }
  cv::Mat z[2], color[2], part[2], mask;
};

void join_buffers_opencv(benchmark::State& state) {
  BuffersInOpenCv buffers(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  for (auto _ : state) {
    buffers.join();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(1));
}
BENCHMARK(join_buffers_opencv)->Args({300, 300})->Args({1344, 1024});

void join_fresh_buffers_opencv(benchmark::State& state) {
  BuffersInOpenCv buffers(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const cv::Mat z = buffers.z[0].clone(), color = buffers.color[0].clone(), part = buffers.part[0].clone();
  for (auto _ : state) {
    state.PauseTiming();
    z.copyTo(buffers.z[0]);
    color.copyTo(buffers.color[0]);
    part.copyTo(buffers.part[0]);
    state.ResumeTiming();
    buffers.join();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(1));
}
BENCHMARK(join_fresh_buffers_opencv)->Args({300, 300})->Args({1344, 1024});

/// As many bytes as a join reads and writes: 24 in, 12 out for each pixel, half of which a copy reads.
void join_bytes_memcpy(benchmark::State& state) {
  const std::size_t pixels = static_cast<std::size_t>(state.range(0) * state.range(1)), bytes = pixels * 18;
  std::vector<char> from(bytes, 1), to(bytes, 2);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), bytes);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pixels));
}
BENCHMARK(join_bytes_memcpy)->Args({300, 300})->Args({1344, 1024});

/// A head that turns and walks, 4 ms apart.
std::vector<layers::dmat4> tracked_poses(int count) {
  std::vector<layers::dmat4> poses;
  for (int k = 0; k < count; ++k) {
    const double t_s = 0.004 * k, angle = 0.4 * std::sin(3 * t_s), c = std::cos(angle), s = std::sin(angle);
    layers::dmat4 pose(1.0);
    pose[0] = {c, 0, -s, 0};
    pose[2] = {s, 0, c, 0};
    pose[3] = {1.4 * t_s, 1.7 + 0.02 * std::sin(12 * t_s), 0.1 * t_s * t_s, 1};
    poses.push_back(pose);
  }
  return poses;
}

void kalman(benchmark::State& state) {
  const std::vector<layers::dmat4> poses = tracked_poses(static_cast<int>(state.range(0)));
  layers::KalmanNoise noise;
  noise.coast_s = noise.push_s = state.range(1) != 0 ? 0.1 : 0;
  for (auto _ : state) benchmark::DoNotOptimize(layers::predict_kalman(poses, 0.004, 0.05, noise));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(kalman)->Args({32, 0})->Args({32, 1});

#ifdef TALISMAN_OPENCV_VIDEO
/// Six coordinates alone, without the logarithms of rotations: predicted and corrected pose by pose, with the same matrices.
void kalman_opencv(benchmark::State& state) {
  const int poses = static_cast<int>(state.range(0));
  const double h = 0.004, r = 2e-4, q = 50;
  for (auto _ : state) {
    double ahead = 0;
    for (int axis = 0; axis < 6; ++axis) {
      cv::KalmanFilter filter(3, 1, 0, CV_64F);
      filter.transitionMatrix = (cv::Mat_<double>(3, 3) << 1, h, h * h / 2, 0, 1, h, 0, 0, 1);
      filter.measurementMatrix = (cv::Mat_<double>(1, 3) << 1, 0, 0);
      filter.processNoiseCov =
          q * q *
          (cv::Mat_<double>(3, 3) << std::pow(h, 5) / 20, std::pow(h, 4) / 8, std::pow(h, 3) / 6,
           std::pow(h, 4) / 8, std::pow(h, 3) / 3, h * h / 2, std::pow(h, 3) / 6, h * h / 2, h);
      filter.measurementNoiseCov = (cv::Mat_<double>(1, 1) << r * r);
      filter.errorCovPost = (cv::Mat_<double>(3, 3) << r * r, 0, 0, 0, 1e4, 0, 0, 0, 1e6);
      cv::Mat_<double> measured(1, 1);
      for (int k = 1; k < poses; ++k) {
        measured(0) = 0.01 * k + 0.001 * axis;
        filter.predict();
        filter.correct(measured);
      }
      ahead += filter.statePost.at<double>(0) + 0.05 * filter.statePost.at<double>(1);
    }
    benchmark::DoNotOptimize(ahead);
  }
  state.SetItemsProcessed(state.iterations() * poses);
}
BENCHMARK(kalman_opencv)->Arg(32);
#endif

}  // namespace
}  // namespace talisman
