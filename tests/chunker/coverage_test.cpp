// SPDX-License-Identifier: Apache-2.0
#include "chunker/coverage.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "chunker/bin.h"
#include "chunker/clip.h"

namespace talisman::chunker {
namespace {

constexpr LatticeBox kWholeChunk{0, 0, 31, 31};
constexpr std::int32_t kReach = static_cast<std::int32_t>(kGuardBandPx) * kSubpixel;

Triangle triangle(std::array<std::int32_t, 3> x, std::array<std::int32_t, 3> y) {
  Triangle t;
  t.x = x;
  t.y = y;
  t.depth = {1, 1, 1};
  t.vertex = {0, 0, 0};
  if (doubled_area(t) < 0) {
    std::swap(t.x[1], t.x[2]);
    std::swap(t.y[1], t.y[2]);
  }
  return t;
}

/// The rule itself, in 64 bits and with no lattice: what all of this must agree with.
bool covers_sample(const Triangle& t, std::int64_t x, std::int64_t y) {
  for (int k = 0; k < 3; ++k) {
    const int to = (k + 1) % 3;
    const std::int64_t dx = t.x[to] - t.x[k], dy = t.y[to] - t.y[k];
    const std::int64_t e = dx * (y - t.y[k]) - dy * (x - t.x[k]);
    if (e < 0 || (e == 0 && !(dy < 0 || (dy == 0 && dx > 0)))) return false;
  }
  return true;
}

template <int kCount = 16>
std::uint16_t mask_in(const Coverage& c, int x, int y) {
  if (!(c.touched[y] >> x & 1)) return 0;
  return c.full[y] >> x & 1 ? Samples<kCount>::kFull : c.mask[y * kChunkSize + x];
}

Triangle random_triangle(std::mt19937& random, std::int32_t reach) {
  std::uniform_int_distribution<std::int32_t> at(-reach, reach);
  std::array<std::int32_t, 3> x, y;
  const std::int32_t cx = at(random) / 2 + 4096, cy = at(random) / 2 + 4096;
  for (int k = 0; k < 3; ++k) {
    x[k] = std::clamp(cx + at(random) / 2, -kReach, kReach);
    y[k] = std::clamp(cy + at(random) / 2, -kReach, kReach);
  }
  return triangle(x, y);
}

// From slivers below one sample to triangles that span the whole guard band, where the 32-bit edges are at
// their limit.
template <int kCount>
void compare_with_the_rule(const Triangle& t, const std::string& what) {
  const EdgeSet edges = edges_of(t, 0, 0);
  Coverage fast{}, slow{};
  cover<kCount>(edges, kWholeChunk, fast);
  cover_scalar<kCount>(edges, kWholeChunk, slow);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      std::uint16_t mask = 0;
      for (int s = 0; s < kCount; ++s) {
        const int place = Samples<kCount>::place(s);
        if (covers_sample(t, x * 256 + 32 + 64 * (place & 3), y * 256 + 32 + 64 * (place >> 2)))
          mask = static_cast<std::uint16_t>(mask | 1 << s);
      }
      ASSERT_EQ(mask_in<kCount>(slow, x, y), mask) << kCount << what;
      ASSERT_EQ(mask_in<kCount>(fast, x, y), mask) << kCount << what;
    }
}

TEST(Cover, AgreesWithTheRuleAndWithScalarAtEverySize) {
  const unsigned seed = 4711;
  std::mt19937 random(seed);
  for (const std::int32_t reach : {40, 200, 1000, 8192, 100000, kReach}) {
    for (int n = 0; n < 150; ++n) {
      const Triangle t = random_triangle(random, reach);
      if (doubled_area(t) <= 0) continue;
      const std::string what = " samples, seed " + std::to_string(seed) + " reach " + std::to_string(reach) +
                               " n " + std::to_string(n);
      compare_with_the_rule<16>(t, what);
      compare_with_the_rule<4>(t, what);
      compare_with_the_rule<1>(t, what);
    }
  }
}

// Four samples, no two of them in a row or column; each centroid is their mean, and the full one the centre.
TEST(CentroidOf, FourSamplesSpreadOverRowsAndColumns) {
  unsigned rows = 0, columns = 0;
  for (int s = 0; s < 4; ++s) {
    rows |= 1u << (Samples<4>::place(s) >> 2);
    columns |= 1u << (Samples<4>::place(s) & 3);
  }
  EXPECT_EQ(rows, 15u);
  EXPECT_EQ(columns, 15u);
  for (unsigned mask = 1; mask < 16; ++mask) {
    unsigned sixteen = 0;
    for (int s = 0; s < 4; ++s) sixteen |= (mask >> s & 1) << Samples<4>::place(s);
    const Centroid four = centroid_of<4>(static_cast<std::uint16_t>(mask)),
                   same = centroid_of<16>(static_cast<std::uint16_t>(sixteen));
    EXPECT_EQ(four.x, same.x) << mask;
    EXPECT_EQ(four.y, same.y) << mask;
  }
  EXPECT_EQ(centroid_of<4>(15).x, 0.5f);
  EXPECT_EQ(centroid_of<4>(15).y, 0.5f);
}

// A box is a window on the coverage, whatever its place relative to the lanes.
TEST(Cover, AnyBoxShowsTheSameBits) {
  std::mt19937 random(99);
  for (int n = 0; n < 300; ++n) {
    const Triangle t = random_triangle(random, 8192);
    if (doubled_area(t) <= 0) continue;
    const EdgeSet edges = edges_of(t, 0, 0);
    Coverage whole{}, part{};
    cover<16>(edges, kWholeChunk, whole);
    const int x0 = static_cast<int>(random() % 32), x1 = x0 + static_cast<int>(random() % (32 - x0));
    const int y0 = static_cast<int>(random() % 32), y1 = y0 + static_cast<int>(random() % (32 - y0));
    cover<16>(edges, {x0, y0, x1, y1}, part);
    for (int y = y0; y <= y1; ++y)
      for (int x = 0; x < 32; ++x)
        ASSERT_EQ(mask_in(part, x, y), x >= x0 && x <= x1 ? mask_in(whole, x, y) : 0) << n;
  }
}

/// A region of jittered cells, each cut into two triangles along a random diagonal; `lattice` > 1 puts the
/// vertices on multiples of it.
std::vector<Triangle> random_tessellation(std::mt19937& random, int cells, std::int32_t side,
                                          std::int32_t lattice) {
  const std::int32_t cell = side / cells;
  const auto jitter = [&] { return static_cast<std::int32_t>(random() % (cell / 2)) - cell / 4; };
  const auto snapped = [&](std::int32_t v) { return v / lattice * lattice; };
  std::vector<std::array<std::int32_t, 2>> p;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const bool border = i == 0 || j == 0 || i == cells || j == cells;
      p.push_back({snapped(i * cell + (border ? 0 : jitter())), snapped(j * cell + (border ? 0 : jitter()))});
    }
  std::vector<Triangle> mesh;
  const auto add = [&](int a, int b, int c) {
    const Triangle t = triangle({p[a][0], p[b][0], p[c][0]}, {p[a][1], p[b][1], p[c][1]});
    if (doubled_area(t) > 0) mesh.push_back(t);
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      if (random() % 2) {
        add(a, b, d);
        add(a, d, c);
      } else {
        add(a, b, c);
        add(b, d, c);
      }
    }
  return mesh;
}

// Vertices on multiples of 32 put many edges exactly through samples: only the top-left rule keeps those
// single.
TEST(Cover, EverySampleOfATessellatedRegionIsCoveredExactlyOnce) {
  const unsigned seed = 31337;
  std::mt19937 random(seed);
  for (const std::int32_t lattice : {1, 32, 64})
    for (const int cells : {1, 2, 7, 24, 60}) {
      const std::int32_t side = cells * (32 * kSubpixel / cells / 64) * 64;
      std::vector<int> hits(128 * 128, 0);
      for (const Triangle& t : random_tessellation(random, cells, side, lattice)) {
        Coverage c{};
        cover<16>(edges_of(t, 0, 0), kWholeChunk, c);
        for (int i = 0; i < 128 * 128; ++i) {
          const int x = i % 128, y = i / 128, s = (y % 4) * 4 + x % 4;
          hits[i] += mask_in(c, x / 4, y / 4) >> s & 1;
        }
      }
      const int inside = side / 64;
      for (int i = 0; i < 128 * 128; ++i)
        ASSERT_EQ(hits[i], i % 128 < inside && i / 128 < inside ? 1 : 0)
            << "seed " << seed << " lattice " << lattice << " cells " << cells << " sample " << i;
    }
}

// Neighbouring chunks must continue each other: the edges are set up anew in each.
TEST(EdgesOf, ChunksShareOneRule) {
  const Triangle t = triangle({-3000, 50000, 7000}, {100, 9000, 60001});
  for (int cy = 0; cy < 8; ++cy)
    for (int cx = 0; cx < 8; ++cx) {
      Coverage c{};
      cover<16>(edges_of(t, cx * 32, cy * 32), kWholeChunk, c);
      for (int i = 0; i < 1024; ++i) {
        const int x = cx * 32 + i % 32, y = cy * 32 + i / 32;
        ASSERT_EQ(mask_in(c, i % 32, i / 32) & 1, covers_sample(t, x * 256 + 32, y * 256 + 32) ? 1 : 0);
      }
    }
}

TEST(MayCover, NeverRejectsWhatIsCovered) {
  std::mt19937 random(5);
  int rejected = 0;
  for (int n = 0; n < 3000; ++n) {
    const Triangle t = random_triangle(random, n % 2 ? 3000 : 60000);
    if (doubled_area(t) <= 0) continue;
    const EdgeSet edges = edges_of(t, 0, 0);
    if (may_cover(edges, kWholeChunk)) continue;
    ++rejected;
    Coverage c{};
    cover_scalar<16>(edges, kWholeChunk, c);
    for (int y = 0; y < 32; ++y) ASSERT_EQ(c.touched[y], 0u);
  }
  EXPECT_GT(rejected, 100);
}

// A triangle between the samples must cost nothing; one that just reaches a sample must not be lost.
TEST(SampleBox, IsEmptyBetweenSamplesAndNotAtThem) {
  EXPECT_TRUE(sample_box(triangle({33, 95, 60}, {33, 40, 95})).empty());
  EXPECT_EQ(sample_box(triangle({32, 95, 60}, {32, 40, 95})), (LatticeBox{0, 0, 0, 0}));
  EXPECT_EQ(sample_box(triangle({-32, 96, 60}, {-97, 40, 96})), (LatticeBox{-1, -2, 1, 1}));
}

TEST(CentroidOf, IsTheMeanOfTheSamplesForEveryMask) {
  for (int mask = 1; mask < 65536; ++mask) {
    double x = 0, y = 0, n = 0;
    for (int s = 0; s < 16; ++s)
      if (mask >> s & 1) {
        x += (2 * (s % 4) + 1) / 8.0;
        y += (2 * (s / 4) + 1) / 8.0;
        ++n;
      }
    const Centroid c = centroid_of<16>(static_cast<std::uint16_t>(mask));
    ASSERT_NEAR(c.x, x / n, 1e-6) << mask;
    ASSERT_NEAR(c.y, y / n, 1e-6) << mask;
  }
  EXPECT_EQ(centroid_of<16>(Samples<16>::kFull).x,
            0.5f);  // full texels skip the sum: both must be the same point
  EXPECT_EQ(centroid_of<16>(Samples<16>::kFull).y, 0.5f);
}

TEST(DepthPlaneOf, PassesThroughTheCorners) {
  Triangle t = triangle({256, 2560, 512}, {0, 512, 4096});
  t.depth = {0.5f, 0.25f, 2};
  const Gradients g = gradients_of(t);
  for (int k = 0; k < 3; ++k) {
    const DepthPlane p = depth_plane(t, g, t.x[k] / 256, t.y[k] / 256);
    EXPECT_NEAR(p.z - 0.5f * p.dx - 0.5f * p.dy, t.depth[k], 1e-6) << k;
  }
}

// The bins must hold every pair that has a covered sample, in the order of the triangles, and nothing outside
// the sprite.
TEST(BinTriangles, HoldsEveryCoveredPairInOrder) {
  std::mt19937 random(12);
  std::vector<Triangle> triangles;
  const layers::ivec2 size(150, 97);
  const LatticeBox sprite{0, 0, 4 * size.x - 1, 4 * size.y - 1};
  while (triangles.size() < 200) {
    const Triangle t = random_triangle(random, triangles.size() % 2 ? 60000 : 2000);
    if (doubled_area(t) > 0 && !intersection(sample_box(t), sprite).empty()) triangles.push_back(t);
  }
  const Bins bins = bin_triangles(triangles, size);
  EXPECT_EQ(bins.chunks, layers::ivec2(5, 4));
  for (int chunk = 0; chunk < 20; ++chunk) {
    const auto bin = bins.of(chunk);
    EXPECT_TRUE(std::is_sorted(bin.begin(), bin.end()));
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      Coverage c{};
      cover<16>(edges_of(triangles[i], chunk % 5 * 32, chunk / 5 * 32), kWholeChunk, c);
      std::uint32_t any = 0;
      for (int y = 0; y < std::min(32, size.y - chunk / 5 * 32); ++y) any |= c.touched[y];
      if (chunk % 5 == 4) any &= (1u << (150 - 128)) - 1;
      if (any != 0) {
        ASSERT_TRUE(std::binary_search(bin.begin(), bin.end(), i)) << chunk << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace talisman::chunker
