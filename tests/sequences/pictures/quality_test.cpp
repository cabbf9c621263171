// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <opencv2/imgproc.hpp>

#include "sequences/files/child_process.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

Image8 flat(int width, int height, std::array<std::uint8_t, 3> color) {
  Image8 image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  return image;
}

/// Smooth shapes with some hard edges.
Image8 picture(int width, int height) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool inside =
          (x - width / 2) * (x - width / 2) + (y - height / 2) * (y - height / 2) < width * height / 16;
      image.rgb.push_back(static_cast<std::uint8_t>(128 + 100 * std::sin(x * 0.11)));
      image.rgb.push_back(static_cast<std::uint8_t>(inside ? 220 : 255 * y / height));
      image.rgb.push_back(static_cast<std::uint8_t>(inside ? 30 : 128 + 90 * std::cos(y * 0.07 + x * 0.03)));
    }
  return image;
}

Image8 noisy(Image8 image, int amplitude, unsigned seed) {
  std::mt19937 random(seed);
  for (auto& v : image.rgb)
    v = static_cast<std::uint8_t>(
        std::clamp(int{v} + static_cast<int>(random() % (2 * amplitude + 1)) - amplitude, 0, 255));
  return image;
}

Image8 random_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image8 image{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(random()));
  return image;
}

Image8 transposed(const Image8& image) {
  Image8 out{image.height, image.width, std::vector<std::uint8_t>(image.rgb.size())};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.rgb[(x * image.height + y) * 3 + c] = image.rgb[(y * image.width + x) * 3 + c];
  return out;
}

/// FLIP once more, as the publication writes it: filters in the plane, everything in double, std::pow. Slow
/// and obvious.
namespace oracle {

using Field = std::vector<double>;
constexpr double kPi = 3.14159265358979323846;

struct Stencil {
  int radius;
  Field weights;  // (2 radius + 1)²
};

template <typename Weight>
Stencil stencil(int radius, Weight weight) {
  Stencil s{radius, {}};
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) s.weights.push_back(weight(x, y));
  return s;
}

Field convolve(const Field& in, int width, int height, const Stencil& s) {
  Field out(in.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      auto w = s.weights.begin();
      for (int j = -s.radius; j <= s.radius; ++j)
        for (int i = -s.radius; i <= s.radius; ++i, ++w)
          sum += *w * in[std::clamp(y + j, 0, height - 1) * width + std::clamp(x + i, 0, width - 1)];
      out[y * width + x] = sum;
    }
  return out;
}

Stencil csf(double a1, double b1, double a2, double b2, double ppd) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd));
  Stencil s = stencil(radius, [&](int x, int y) {
    const double d2 = (x * x + y * y) / (ppd * ppd);
    return a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * d2 / b1) +
           a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * d2 / b2);
  });
  double sum = 0;
  for (const double w : s.weights) sum += w;
  for (double& w : s.weights) w /= sum;
  return s;
}

Stencil detector(bool edge, bool along_x, double ppd) {
  const double sd = 0.5 * 0.082 * ppd;
  Stencil s = stencil(static_cast<int>(std::ceil(3 * sd)), [&](int x, int y) {
    const double g = std::exp(-(x * x + y * y) / (2 * sd * sd)), u = along_x ? x : y;
    return edge ? -u * g : (u * u / (sd * sd) - 1) * g;
  });
  double positive = 0, negative = 0;
  for (const double w : s.weights) (w > 0 ? positive : negative) += w;
  for (double& w : s.weights) w /= w > 0 ? positive : (w < 0 ? -negative : 1);
  return s;
}

using Triple = std::array<double, 3>;
const double (&kToXyz)[3][3] = flip_constants::kXyzFromRgb;
double white(int r) { return kToXyz[r][0] + kToXyz[r][1] + kToXyz[r][2]; }

Triple xyz(const Triple& rgb) {
  Triple out{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out[r] += kToXyz[r][c] * rgb[c] / white(r);
  return out;
}

/// Digits of the inverse matrix as they are published, not computed.
Triple rgb(const Triple& relative) {
  constexpr double kInverse[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                     {-0.969224334, 1.875930071, 0.041554224},
                                     {0.055639423, -0.204011202, 1.057148933}};
  Triple out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out[r] += kInverse[r][c] * relative[c] * white(c);
    out[r] = std::clamp(out[r], 0.0, 1.0);
  }
  return out;
}

Triple hunt_lab(const Triple& relative) {
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : t * 841 / 108 + 4.0 / 29; };
  const double l = 116 * f(relative[1]) - 16;
  return {l, 0.01 * l * 500 * (f(relative[0]) - f(relative[1])),
          0.01 * l * 200 * (f(relative[1]) - f(relative[2]))};
}

double hyab(const Triple& a, const Triple& b) {
  return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

double color_error(double distance) {
  const double largest = std::pow(hyab(hunt_lab(xyz({0, 1, 0})), hunt_lab(xyz({0, 0, 1}))), 0.7);
  const double p = std::pow(distance, 0.7), knee = 0.4 * largest;
  return p < knee ? 0.95 / knee * p : 0.95 + (p - knee) / (largest - knee) * 0.05;
}

struct Seen {
  std::vector<Triple> lab;
  Field edge, point;
};

double linear(std::uint8_t v) {
  return v / 255.0 <= 0.04045 ? v / 255.0 / 12.92 : std::pow((v / 255.0 + 0.055) / 1.055, 2.4);
}

Seen see(const Image8& image, double ppd) {
  const int w = image.width, h = image.height;
  Field y(w * h), cx(w * h), cz(w * h);
  for (int i = 0; i < w * h; ++i) {
    const Triple t =
        xyz({linear(image.rgb[i * 3]), linear(image.rgb[i * 3 + 1]), linear(image.rgb[i * 3 + 2])});
    y[i] = 116 * t[1] - 16, cx[i] = 500 * (t[0] - t[1]), cz[i] = 200 * (t[1] - t[2]);
  }
  const Field fy = convolve(y, w, h, csf(1, 0.0047, 0, 1e-5, ppd)),
              fx = convolve(cx, w, h, csf(1, 0.0053, 0, 1e-5, ppd)),
              fz = convolve(cz, w, h, csf(34.1, 0.04, 13.5, 0.025, ppd));
  Seen seen;
  for (int i = 0; i < w * h; ++i) {
    const double t = (fy[i] + 16) / 116;
    seen.lab.push_back(hunt_lab(xyz(rgb({t + fx[i] / 500, t, t - fz[i] / 200}))));
  }
  Field luminance(w * h);
  for (int i = 0; i < w * h; ++i) luminance[i] = (y[i] + 16) / 116;
  const auto magnitude = [&](bool edge) {
    Field along_x = convolve(luminance, w, h, detector(edge, true, ppd));
    const Field along_y = convolve(luminance, w, h, detector(edge, false, ppd));
    for (std::size_t i = 0; i < along_x.size(); ++i) along_x[i] = std::hypot(along_x[i], along_y[i]);
    return along_x;
  };
  seen.edge = magnitude(true), seen.point = magnitude(false);
  return seen;
}

Field flip(const Image8& test, const Image8& reference, double ppd) {
  const Seen t = see(test, ppd), r = see(reference, ppd);
  Field out;
  for (std::size_t i = 0; i < t.lab.size(); ++i) {
    const double f = std::max(std::fabs(t.edge[i] - r.edge[i]), std::fabs(t.point[i] - r.point[i]));
    out.push_back(std::pow(color_error(hyab(t.lab[i], r.lab[i])), 1 - std::sqrt(f / std::sqrt(2.0))));
  }
  return out;
}

/// SSIM by the definition: weighted moments of an 11×11 window around each pixel.
double ssim(const Image8& a, const Image8& b) {
  const int w = a.width, h = a.height;
  const Stencil gauss = stencil(5, [](int x, int y) { return std::exp(-(x * x + y * y) / 4.5); });
  const auto luma = [](const Image8& i, int p) {
    return 0.299 * i.rgb[p * 3] + 0.587 * i.rgb[p * 3 + 1] + 0.114 * i.rgb[p * 3 + 2];
  };
  double total = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
      auto g = gauss.weights.begin();
      for (int j = -5; j <= 5; ++j)
        for (int i = -5; i <= 5; ++i, ++g) {
          const int p = std::clamp(y + j, 0, h - 1) * w + std::clamp(x + i, 0, w - 1);
          const double u = luma(a, p), v = luma(b, p);
          n += *g, sa += *g * u, sb += *g * v, saa += *g * u * u, sbb += *g * v * v, sab += *g * u * v;
        }
      const double ma = sa / n, mb = sb / n, va = saa / n - ma * ma, vb = sbb / n - mb * mb,
                   cov = sab / n - ma * mb;
      total +=
          (2 * ma * mb + 6.5025) * (2 * cov + 58.5225) / ((ma * ma + mb * mb + 6.5025) * (va + vb + 58.5225));
    }
  return total / (w * h);
}

}  // namespace oracle

/// The largest deviation of the fast map from the slow one.
double largest_deviation(const Image8& test, const Image8& reference, double ppd) {
  const auto fast = flip_map(test, reference, ppd);
  const auto slow = oracle::flip(test, reference, ppd);
  double worst = 0;
  for (std::size_t i = 0; i < slow.size(); ++i) worst = std::max(worst, std::fabs(fast[i] - slow[i]));
  return worst;
}

/// Rounding of float against double; the powers magnify it where an error is nearly zero. Seen: 4e-6,
/// once 3.5e-5.
constexpr double kRounding = 1e-4;

TEST(Flip, EqualsTheDefinitionOnPictures) {
  const Image8 reference = picture(60, 47);
  EXPECT_LT(largest_deviation(noisy(reference, 20, 3), reference, 67.02), kRounding);
  EXPECT_LT(largest_deviation(transposed(picture(47, 60)), reference, 67.02), kRounding);
}

// White noise drives every clamp and both branches of every curve; small and large eyes change the radii.
TEST(Flip, EqualsTheDefinitionOnNoiseAtAnyDistance) {
  for (unsigned seed = 1; seed <= 3; ++seed)
    for (const double ppd : {2.0, 20.0, 67.02, 100.0})
      EXPECT_LT(largest_deviation(random_image(33, 29, seed), random_image(33, 29, seed + 100), ppd),
                kRounding)
          << "seed " << seed << ", pixels per degree " << ppd;
}

// Narrower than a vector register, narrower than the filter, one pixel.
TEST(Flip, EqualsTheDefinitionOnTinyPictures) {
  for (const auto& [w, h] : {std::pair{1, 1}, {1, 40}, {40, 1}, {15, 2}, {16, 16}, {17, 3}})
    EXPECT_LT(largest_deviation(random_image(w, h, 5), random_image(w, h, 6), 67.02), kRounding)
        << w << "x" << h;
}

TEST(Flip, ZeroOnlyWhereNothingDiffers) {
  const Image8 image = picture(40, 30);
  for (const float e : flip_map(image, image)) EXPECT_EQ(e, 0.0f);
  Image8 dot = image;
  dot.rgb[(15 * 40 + 20) * 3] ^= 0x40;
  const auto map = flip_map(dot, image);
  EXPECT_GT(map[15 * 40 + 20], 0.01f);
  EXPECT_LT(map[0], 1e-3f);  // further away than any filter reaches
}

TEST(Flip, SymmetricInItsArguments) {
  const Image8 a = picture(50, 40), b = noisy(a, 30, 9);
  EXPECT_EQ(flip_map(a, b), flip_map(b, a));
}

// The detectors look along both axes, so a transposed pair has the transposed map (to float rounding).
TEST(Flip, TransposedPicturesGiveTheTransposedMap) {
  const Image8 a = picture(50, 40), b = noisy(a, 30, 9);
  const auto map = flip_map(a, b), other = flip_map(transposed(a), transposed(b));
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 50; ++x) ASSERT_NEAR(map[y * 50 + x], other[x * 40 + y], 2e-4) << x << ", " << y;
}

// Flat pictures have no features, so FLIP is the colour error alone, which can be worked out by hand: black
// against white has distance 100, and green against blue the largest distance there is.
TEST(Flip, FlatPicturesAreTheColorErrorAlone) {
  const Image8 black = flat(20, 20, {0, 0, 0}), white = flat(20, 20, {255, 255, 255});
  EXPECT_NEAR(flip_map(black, white)[210], oracle::color_error(100), 1e-4);
  EXPECT_NEAR(flip_map(flat(20, 20, {0, 255, 0}), flat(20, 20, {0, 0, 255}))[210], 1.0, 1e-4);
}

TEST(Flip, GrowsWithTheError) {
  const Image8 reference = picture(64, 64);
  double before = 0;
  for (const int amplitude : {2, 8, 24, 64}) {
    const double now = mean(flip_map(noisy(reference, amplitude, 11), reference));
    EXPECT_GT(now, before) << "amplitude " << amplitude;
    before = now;
  }
  EXPECT_LT(before, 1);
}

// From far away the eye averages noise out.
TEST(Flip, SmallerFromFurtherAway) {
  const Image8 reference = flat(96, 96, {128, 128, 128}), test = noisy(reference, 40, 12);
  EXPECT_LT(mean(flip_map(test, reference, 120)), mean(flip_map(test, reference, 30)));
}

TEST(Flip, ExtremeDistancesStayFinite) {
  const Image8 a = random_image(24, 20, 1), b = random_image(24, 20, 2);
  for (const double ppd : {1e-3, 0.1, 1.0, 600.0})
    for (const float e : flip_map(a, b, ppd)) ASSERT_TRUE(e >= 0 && e <= 1) << e << " at " << ppd;
}

TEST(Flip, SameBytesForAnyNumberOfThreads) {
  const Image8 a = picture(200, 150), b = noisy(a, 10, 1);
  const auto many = flip_map(a, b);
  const double many_ssim = ssim(a, b);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(flip_map(a, b), many);
  EXPECT_EQ(ssim(a, b), many_ssim);
}

TEST(FlipDeathTest, MisuseIsAProgrammerError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Image8 a = flat(4, 4, {0, 0, 0}), b = flat(5, 4, {0, 0, 0});
  EXPECT_DEATH(flip_map(a, b), "check failed");
  EXPECT_DEATH(flip_map(a, a, 0), "check failed");
  EXPECT_DEATH(flip_map(a, a, NAN), "check failed");
  EXPECT_DEATH(compare(a, b), "check failed");
}

TEST(HeatMap, LightnessRisesAndHostileValuesAreClamped) {
  std::vector<float> ramp;
  for (int i = 0; i <= 100; ++i) ramp.push_back(i / 100.0f);
  const Image8 map = heat_map(ramp, 101, 1);
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const double luma = 0.299 * map.rgb[i * 3] + 0.587 * map.rgb[i * 3 + 1] + 0.114 * map.rgb[i * 3 + 2];
    EXPECT_GT(luma, before - 0.5) << i;  // bytes round
    before = luma;
  }
  EXPECT_GT(before, 240);
  const Image8 hostile = heat_map({NAN, -5, 7, HUGE_VALF}, 4, 1);
  EXPECT_EQ(hostile.rgb[1], map.rgb[1]);
  EXPECT_EQ(hostile.rgb[4], map.rgb[1]);
  EXPECT_EQ(hostile.rgb[7], map.rgb[301]);
  EXPECT_EQ(hostile.rgb[10], map.rgb[301]);
}

TEST(Ssim, EqualsTheDefinition) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Image8 a = picture(37, 28), b = noisy(a, 40, seed);
    EXPECT_NEAR(ssim(b, a), oracle::ssim(b, a), 2e-5) << "seed " << seed;
  }
  EXPECT_NEAR(ssim(random_image(3, 2, 1), random_image(3, 2, 2)),
              oracle::ssim(random_image(3, 2, 1), random_image(3, 2, 2)), 2e-5);
}

// Bright flat pictures: E[x²] - E[x]² cancels worst here.
TEST(Ssim, NearlyFlatBrightPicturesDoNotCancel) {
  const Image8 a = flat(40, 40, {250, 250, 250}), b = noisy(a, 1, 4);
  EXPECT_NEAR(ssim(a, b), oracle::ssim(a, b), 1e-3);
  EXPECT_NEAR(ssim(a, a), 1, 1e-3);
}

TEST(Ssim, EqualsOpenCvBlurs) {
  const Image8 a = picture(90, 70), b = noisy(a, 25, 5);
  const auto luma = [](const Image8& image) {
    cv::Mat out(image.height, image.width, CV_64F);
    for (int i = 0; i < image.width * image.height; ++i)
      out.at<double>(i) =
          0.299 * image.rgb[i * 3] + 0.587 * image.rgb[i * 3 + 1] + 0.114 * image.rgb[i * 3 + 2];
    return out;
  };
  const auto blurred = [](const cv::Mat& m) {
    cv::Mat out;
    cv::GaussianBlur(m, out, {11, 11}, 1.5, 1.5, cv::BORDER_REPLICATE);
    return out;
  };
  const cv::Mat x = luma(a), y = luma(b), mx = blurred(x), my = blurred(y);
  const cv::Mat vx = blurred(x.mul(x)) - mx.mul(mx), vy = blurred(y.mul(y)) - my.mul(my),
                cov = blurred(x.mul(y)) - mx.mul(my);
  const cv::Mat map = (2 * mx.mul(my) + 6.5025).mul(2 * cov + 58.5225) /
                      (mx.mul(mx) + my.mul(my) + 6.5025).mul(vx + vy + 58.5225);
  EXPECT_NEAR(ssim(a, b), cv::mean(map)[0], 2e-5);
}

TEST(Compare, IdenticalPicturesAreExactlyPerfect) {
  const Image8 image = picture(30, 20);
  const Quality q = compare(image, image);
  EXPECT_TRUE(std::isinf(q.psnr_db));
  EXPECT_EQ(q.ssim, 1);
  EXPECT_EQ(q.flip, 0);
  EXPECT_EQ(q.max_difference, 0);
  EXPECT_EQ(q.changed_pixels, 0);
}

TEST(Compare, EmptyPicturesAreIdentical) {
  const Quality q = compare(Image8{}, Image8{});
  EXPECT_TRUE(std::isinf(q.psnr_db));
  EXPECT_EQ(q.ssim, 1);
  EXPECT_EQ(q.flip, 0);
  EXPECT_EQ(q.changed_pixels, 0);
}

// One channel of one pixel in a hundred, off by 51: MSE = 51² / 300.
TEST(Compare, OneChangedChannelByHand) {
  const Image8 reference = flat(10, 10, {100, 100, 100});
  Image8 test = reference;
  test.rgb[3 * 42 + 1] = 151;
  const Quality q = compare(test, reference);
  EXPECT_NEAR(q.psnr_db, 10 * std::log10(255.0 * 255 * 300 / (51.0 * 51)), 1e-9);
  EXPECT_EQ(q.max_difference, 51);
  EXPECT_DOUBLE_EQ(q.changed_pixels, 0.01);
  EXPECT_LT(q.ssim, 1);
  EXPECT_GT(q.flip, 0);
}

TEST(Compare, WhatIsNotAskedForIsNotComputed) {
  const Image8 a = picture(20, 20), b = noisy(a, 30, 1);
  QualityOptions options;
  options.flip = options.ssim = false;
  const Quality q = compare(b, a, options);
  EXPECT_EQ(q.ssim, 1);
  EXPECT_EQ(q.flip, 0);
  EXPECT_LT(q.psnr_db, 40);
}

/// What ffmpeg's filter says of two pictures: the number after `key` in its summary line.
double ffmpeg_says(const std::string& filter, const std::string& key, const Image8& a, const Image8& b) {
  const tests::TemporaryFolder folder;
  write_png(folder / "a.png", a);
  write_png(folder / "b.png", b);
  const ChildResult child = run_child({"ffmpeg", "-hide_banner", "-nostdin", "-i", folder / "a.png", "-i",
                                       folder / "b.png", "-lavfi", filter, "-f", "null", "-"});
  const auto at = child.output.rfind(key);
  return at == std::string::npos ? NAN : std::atof(child.output.c_str() + at + key.size());
}

TEST(Compare, PsnrEqualsFfmpeg) {
  const Image8 a = picture(96, 64), b = noisy(a, 12, 8);
  EXPECT_NEAR(compare(a, b).psnr_db, ffmpeg_says("psnr", "average:", a, b), 0.01);
}

// ffmpeg takes flat 8×8 windows every 4 pixels, so only the neighbourhood of the number can agree.
TEST(Compare, SsimIsNearFfmpegs) {
  Image8 a = picture(160, 128), b = noisy(a, 30, 8);
  for (Image8* image : {&a, &b})
    for (std::size_t i = 0; i < image->rgb.size(); i += 3)
      image->rgb[i] = image->rgb[i + 2] = image->rgb[i + 1];
  const double theirs = ffmpeg_says("[0:v]format=gray[a];[1:v]format=gray[b];[a][b]ssim", "All:", a, b);
  EXPECT_NEAR(compare(a, b).ssim, theirs, 0.05);
  EXPECT_LT(theirs, 0.95);
}

}  // namespace
}  // namespace talisman::sequences
