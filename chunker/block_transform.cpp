// SPDX-License-Identifier: Apache-2.0
#include "chunker/block_transform.h"

namespace talisman::chunker {
namespace {

constexpr int kFixedBits = 12;
constexpr int kFractionBits = 2;

using Matrix = std::array<std::array<int, kBlockSide>, kBlockSide>;

/// round(4096 · cos(m π/16) / 2) for m = 0 … 8, and its symmetries.
constexpr int half_cosine(int m) {
  constexpr int kQuarter[] = {2048, 2009, 1892, 1703, 1448, 1138, 784, 400, 0};
  m %= 32;
  if (m > 16) m = 32 - m;
  return m <= 8 ? kQuarter[m] : -kQuarter[16 - m];
}

constexpr Matrix make_matrix() {
  Matrix t{};
  for (int k = 0; k < kBlockSide; ++k)
    for (int n = 0; n < kBlockSide; ++n) t[k][n] = k == 0 ? 1448 : half_cosine((2 * n + 1) * k);
  return t;
}

constexpr Matrix transposed(const Matrix& m) {
  Matrix t{};
  for (int k = 0; k < kBlockSide; ++k)
    for (int n = 0; n < kBlockSide; ++n) t[n][k] = m[k][n];
  return t;
}

constexpr Matrix kTransform = make_matrix();
constexpr Matrix kTransposed = transposed(kTransform);

/// (M f)ᵀ, rounded by `shift` bits. Twice that with the same M is M f Mᵀ.
Block multiplied(const Matrix& m, const Block& f, int shift) {
  Block result;
  for (int k = 0; k < kBlockSide; ++k) {
    std::array<int, kBlockSide> sum;
    sum.fill(1 << (shift - 1));
    for (int n = 0; n < kBlockSide; ++n)
      for (int x = 0; x < kBlockSide; ++x) sum[x] += m[k][n] * f[n * kBlockSide + x];
    for (int x = 0; x < kBlockSide; ++x) result[x * kBlockSide + k] = sum[x] >> shift;
  }
  return result;
}

std::array<int, kBlockTexels> make_zig_zag() {
  std::array<int, kBlockTexels> order;
  int i = 0;
  for (int diagonal = 0; diagonal < 2 * kBlockSide - 1; ++diagonal)
    for (int step = 0; step <= diagonal; ++step) {
      const int x = diagonal % 2 == 0 ? step : diagonal - step, y = diagonal - x;
      if (x < kBlockSide && y < kBlockSide) order[i++] = y * kBlockSide + x;
    }
  return order;
}

}  // namespace

Block forward_transform(const Block& f) {
  return multiplied(kTransform, multiplied(kTransform, f, kFixedBits - kFractionBits), kFixedBits);
}

Block inverse_transform(const Block& coefficients) {
  return multiplied(kTransposed, multiplied(kTransposed, coefficients, kFixedBits),
                    kFixedBits + kFractionBits);
}

const std::array<int, kBlockTexels>& zig_zag() {
  static const std::array<int, kBlockTexels> order = make_zig_zag();
  return order;
}

}  // namespace talisman::chunker
