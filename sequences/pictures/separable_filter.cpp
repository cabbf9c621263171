// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/separable_filter.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

/// Four floats that the compiler keeps in one register, on any target.
using Float4 = float __attribute__((vector_size(16)));
constexpr int kLanes = 4;
constexpr int kRegisters = 4;  // enough independent sums to hide the latency of an addition
constexpr int kBlock = kLanes * kRegisters;

Float4 load4(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

/// The samples that a kernel meets around an output row: before[k] and after[k] are the rows shifted by -k
/// and +k.
struct Taps {
  std::vector<const float*> before, after;
};

template <bool kOdd>
void sum_block(const Taps& taps, const Kernel& kernel, int x, float* out) {
  std::array<Float4, kRegisters> sums{};
  if constexpr (!kOdd)
    for (int i = 0; i < kRegisters; ++i) sums[i] = load4(taps.before[0] + x + i * kLanes) * kernel.weights[0];
  for (int k = 1; k <= kernel.radius(); ++k) {
    const float* before = taps.before[k] + x;
    const float* after = taps.after[k] + x;
    for (int i = 0; i < kRegisters; ++i) {
      const Float4 a = load4(after + i * kLanes), b = load4(before + i * kLanes);
      sums[i] += (kOdd ? a - b : a + b) * kernel.weights[k];
    }
  }
  std::memcpy(out + x, sums.data(), sizeof sums);
}

template <bool kOdd>
void sum_single(const Taps& taps, const Kernel& kernel, int x, float* out) {
  float sum = kOdd ? 0.0f : taps.before[0][x] * kernel.weights[0];
  for (int k = 1; k <= kernel.radius(); ++k)
    sum += (kOdd ? taps.after[k][x] - taps.before[k][x] : taps.after[k][x] + taps.before[k][x]) *
           kernel.weights[k];
  out[x] = sum;
}

template <bool kOdd>
void sum_row(const Taps& taps, const Kernel& kernel, int width, float* out) {
  int x = 0;
  for (; x + kBlock <= width; x += kBlock) sum_block<kOdd>(taps, kernel, x, out);
  for (; x < width; ++x) sum_single<kOdd>(taps, kernel, x, out);
}

void weighted_sum(const Taps& taps, const Kernel& kernel, int width, float* out) {
  if (kernel.odd)
    sum_row<true>(taps, kernel, width, out);
  else
    sum_row<false>(taps, kernel, width, out);
}

void pad_row(const float* row, int width, int radius, std::vector<float>& padded) {
  padded.resize(width + 2 * static_cast<std::size_t>(radius));
  std::fill_n(padded.begin(), radius, row[0]);
  std::copy_n(row, width, padded.begin() + radius);
  std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
}

}  // namespace

void for_each_row(int height, const std::function<void(int)>& row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, 16), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) row(y);
  });
}

Kernel gaussian_kernel(double sigma_px, int radius) {
  std::vector<double> samples(radius + 1);
  double sum = 0;
  for (int k = 0; k <= radius; ++k) {
    samples[k] = std::exp(-0.5 * k * k / (sigma_px * sigma_px));
    sum += k == 0 ? samples[k] : 2 * samples[k];
  }
  Kernel kernel;
  for (const double s : samples) kernel.weights.push_back(static_cast<float>(s / sum));
  return kernel;
}

Plane filter_rows(const Plane& in, const Kernel& kernel) {
  TALISMAN_CHECK_GE(kernel.radius(), 0);
  Plane out(in.width, in.height);
  if (in.values.empty()) return out;
  const int radius = kernel.radius();
  tbb::parallel_for(tbb::blocked_range<int>(0, in.height, 16), [&](const tbb::blocked_range<int>& rows) {
    std::vector<float> padded(in.width + 2 * static_cast<std::size_t>(radius));
    Taps taps;
    for (int k = 0; k <= radius; ++k) {
      taps.before.push_back(padded.data() + radius - k);
      taps.after.push_back(padded.data() + radius + k);
    }
    for (int y = rows.begin(); y != rows.end(); ++y) {
      pad_row(in.row(y), in.width, radius, padded);
      weighted_sum(taps, kernel, in.width, out.row(y));
    }
  });
  return out;
}

Plane filter_columns(const Plane& in, const Kernel& kernel) {
  TALISMAN_CHECK_GE(kernel.radius(), 0);
  Plane out(in.width, in.height);
  if (in.values.empty()) return out;
  for_each_row(in.height, [&](int y) {
    Taps taps;
    for (int k = 0; k <= kernel.radius(); ++k) {
      taps.before.push_back(in.row(std::max(y - k, 0)));
      taps.after.push_back(in.row(std::min(y + k, in.height - 1)));
    }
    weighted_sum(taps, kernel, in.width, out.row(y));
  });
  return out;
}

Plane blur(const Plane& in, const Kernel& kernel) { return filter_columns(filter_rows(in, kernel), kernel); }

}  // namespace talisman::sequences
