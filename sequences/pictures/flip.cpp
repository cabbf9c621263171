// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/flip.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "chunker/pixel.h"
#include "layers/check.h"

namespace talisman::sequences {
namespace {

using namespace flip_constants;

struct Color3 {
  float x = 0, y = 0, z = 0;
};

struct Matrix3 {
  std::array<std::array<float, 3>, 3> m;
  Color3 operator()(Color3 c) const {
    return {m[0][0] * c.x + m[0][1] * c.y + m[0][2] * c.z, m[1][0] * c.x + m[1][1] * c.y + m[1][2] * c.z,
            m[2][0] * c.x + m[2][1] * c.y + m[2][2] * c.z};
  }
};

/// log₂ of a positive normal number: the exponent, and 2/ln 2 · artanh((m - 1)/(m + 1)) of a mantissa
/// in [√½, √2).
inline float log2_of(float x) {
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x) - kSqrtHalf;
  const float exponent = static_cast<float>(bits >> 23);
  const float mantissa = std::bit_cast<float>((bits & 0x007fffff) + kSqrtHalf);
  const float t = (mantissa - 1) / (mantissa + 1), t2 = t * t;
  const float series = 1 + t2 * (1.0f / 3 + t2 * (1.0f / 5 + t2 * (1.0f / 7 + t2 * (1.0f / 9))));
  return exponent + 2.8853900818f * t * series;
}

/// 2^x for -126 ≤ x ≤ 126.
inline float exp2_of(float x) {
  // 1.5 · 2²³: adding and subtracting it leaves the nearest integer.
  constexpr float kRoundToInteger = 12582912.0f;
  const float whole = (x + kRoundToInteger) - kRoundToInteger;
  const float f = (x - whole) * 0.69314718056f;
  const float e =
      1 + f * (1 + f * (1.0f / 2 + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
  return e * std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
}

/// base^exponent for 0 ≤ base ≤ 1e6 and 0 ≤ exponent ≤ 1. 1e-30 and below count as 0, except to the power 0.
inline float power(float base, float exponent) {
  const float p = exp2_of(exponent * log2_of(std::max(base, 1e-30f)));
  return base > 1e-30f ? p : (exponent > 0 ? 0.0f : 1.0f);
}

double white(int row) { return kXyzFromRgb[row][0] + kXyzFromRgb[row][1] + kXyzFromRgb[row][2]; }

/// XYZ relative to white, from linear RGB.
Matrix3 relative_xyz_from_rgb() {
  Matrix3 result{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) result.m[r][c] = static_cast<float>(kXyzFromRgb[r][c] / white(r));
  return result;
}

Matrix3 rgb_from_relative_xyz() {
  double m[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m[r][c] = kXyzFromRgb[r][c] / white(r);
  const auto cofactor = [&m](int r, int c) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double det = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  Matrix3 inverse{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) inverse.m[r][c] = static_cast<float>(cofactor(c, r) / det);
  return inverse;
}

/// The opponent channels without their scale factors, which cancel: y = Y/Yn (the luminance of the feature
/// pipeline too), cx = X/Xn - Y/Yn, cz = Y/Yn - Z/Zn.
struct Opponent {
  Plane y, cx, cz;
};

Opponent opponent_from(const Image8& image) {
  std::array<float, 256> linear;
  for (int v = 0; v < 256; ++v) linear[v] = chunker::linear_from_srgb(static_cast<std::uint8_t>(v));
  const Matrix3 to_xyz = relative_xyz_from_rgb();
  const Plane empty(image.width, image.height);
  Opponent out{empty, empty, empty};
  for_each_row(image.height, [&](int row) {
    const std::uint8_t* rgb = image.rgb.data() + static_cast<std::size_t>(row) * image.width * 3;
    for (int x = 0; x < image.width; ++x, rgb += 3) {
      const Color3 xyz = to_xyz({linear[rgb[0]], linear[rgb[1]], linear[rgb[2]]});
      out.y.row(row)[x] = xyz.y;
      out.cx.row(row)[x] = xyz.x - xyz.y;
      out.cz.row(row)[x] = xyz.y - xyz.z;
    }
  });
  return out;
}

/// exp(-π² d² / b) with d in degrees is a Gaussian of this σ, in pixels.
double csf_sigma_px(double b, double pixels_per_degree) {
  return std::sqrt(b / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree;
}

/// All channels are cut at the radius of the widest Gaussian. Taps too small to change a float sum
/// are left out.
Kernel csf_kernel(double b, double pixels_per_degree) {
  const int radius = static_cast<int>(std::ceil(3 * csf_sigma_px(kBlueYellowB1, pixels_per_degree)));
  Kernel kernel = gaussian_kernel(csf_sigma_px(b, pixels_per_degree), radius);
  while (kernel.weights.size() > 1 && kernel.weights.back() < 1e-10f * kernel.weights.front())
    kernel.weights.pop_back();
  return kernel;
}

/// Volume under a₁ √(π/b₁) exp(…) once its one-dimensional kernel has been normalised: w₀ is
/// 1 / (sum along a line).
double csf_volume(double a, double b, const Kernel& kernel) {
  const double line = 1.0 / kernel.weights[0];
  return a * std::sqrt(std::numbers::pi / b) * line * line;
}

/// The blue-yellow sensitivity is a sum of two Gaussians: both are applied and mixed by their volumes.
Plane blur_blue_yellow(const Plane& cz, double pixels_per_degree) {
  const Kernel wide = csf_kernel(kBlueYellowB1, pixels_per_degree),
               narrow = csf_kernel(kBlueYellowB2, pixels_per_degree);
  const double wide_volume = csf_volume(kBlueYellowA1, kBlueYellowB1, wide);
  const double narrow_volume = csf_volume(kBlueYellowA2, kBlueYellowB2, narrow);
  const float wide_share = static_cast<float>(wide_volume / (wide_volume + narrow_volume));
  Plane out = blur(cz, wide);
  const Plane other = blur(cz, narrow);
  for_each_row(cz.height, [&](int y) {
    for (int x = 0; x < cz.width; ++x)
      out.row(y)[x] = wide_share * out.row(y)[x] + (1 - wide_share) * other.row(y)[x];
  });
  return out;
}

inline float lab_curve(float t) {
  constexpr float kDelta = 6.0f / 29;
  const float line = t * (1 / (3 * kDelta * kDelta)) + 4.0f / 29;
  return t > kDelta * kDelta * kDelta ? power(t, 1.0f / 3) : line;
}

/// L*a*b* with the Hunt adjustment, from XYZ relative to white.
inline Color3 hunt_lab(Color3 xyz) {
  const float fx = lab_curve(xyz.x), fy = lab_curve(xyz.y), fz = lab_curve(xyz.z);
  const float lightness = 116 * fy - 16, hunt = 0.01f * lightness;
  return {lightness, hunt * 500 * (fx - fy), hunt * 200 * (fy - fz)};
}

inline float clamp01(float v) { return v > 0 ? (v < 1 ? v : 1.0f) : 0.0f; }

struct HuntLab {
  Plane l, a, b;
};

/// What the eye sees of the colours, in a space where distances are comparable.
HuntLab seen_colors(const Opponent& in, double pixels_per_degree) {
  HuntLab seen{blur(in.y, csf_kernel(kAchromaticB, pixels_per_degree)),
               blur(in.cx, csf_kernel(kRedGreenB, pixels_per_degree)),
               blur_blue_yellow(in.cz, pixels_per_degree)};
  const Matrix3 to_rgb = rgb_from_relative_xyz(), to_xyz = relative_xyz_from_rgb();
  for_each_row(in.y.height, [&](int row) {
    float *l = seen.l.row(row), *a = seen.a.row(row), *b = seen.b.row(row);
    for (int x = 0; x < in.y.width; ++x) {
      const Color3 rgb = to_rgb({l[x] + a[x], l[x], l[x] - b[x]});
      const Color3 lab = hunt_lab(to_xyz({clamp01(rgb.x), clamp01(rgb.y), clamp01(rgb.z)}));
      l[x] = lab.x, a[x] = lab.y, b[x] = lab.z;
    }
  });
  return seen;
}

inline float hyab(float dl, float da, float db) { return std::fabs(dl) + std::sqrt(da * da + db * db); }

/// The largest distance that counts: between pure green and pure blue.
float largest_color_distance() {
  const Matrix3 to_xyz = relative_xyz_from_rgb();
  const Color3 green = hunt_lab(to_xyz({0, 1, 0})), blue = hunt_lab(to_xyz({0, 0, 1}));
  return power(hyab(green.x - blue.x, green.y - blue.y, green.z - blue.z),
               static_cast<float>(kColorExponent));
}

/// Distances up to the knee take most of 0 … 1: beyond it, colours are just "very different".
inline float color_error(float distance, float largest) {
  constexpr float kKnee = static_cast<float>(kKneeDistance), kAtKnee = static_cast<float>(kKneeError);
  const float p = power(distance, static_cast<float>(kColorExponent)), knee = kKnee * largest;
  const float below = kAtKnee / knee * p, above = kAtKnee + (p - knee) / (largest - knee) * (1 - kAtKnee);
  return p < knee ? below : above;
}

/// First (odd) or second (even) derivative of a Gaussian; positive weights sum to 1, negative ones to -1.
Kernel detector_kernel(double sigma_px, int radius, bool odd) {
  std::vector<double> w(radius + 1);
  double positive = 0, negative = 0;
  for (int k = 0; k <= radius; ++k) {
    const double g = std::exp(-0.5 * k * k / (sigma_px * sigma_px)), copies = k == 0 ? 1 : 2;
    w[k] = odd ? k * g : (k * k / (sigma_px * sigma_px) - 1) * g;
    (w[k] > 0 ? positive : negative) += (odd ? 1 : copies) * std::fabs(w[k]);
  }
  Kernel kernel{{}, odd};
  for (const double v : w)
    kernel.weights.push_back(v == 0 ? 0.0f : static_cast<float>(v / (v > 0 ? positive : negative)));
  return kernel;
}

void to_magnitude(Plane& along_x, const Plane& along_y) {
  for_each_row(along_x.height, [&](int row) {
    float* out = along_x.row(row);
    const float* other = along_y.row(row);
    for (int x = 0; x < along_x.width; ++x) out[x] = std::sqrt(out[x] * out[x] + other[x] * other[x]);
  });
}

struct Features {
  Plane edge, point;
};

Features features_of(const Plane& luminance, double pixels_per_degree) {
  const double sigma_px = 0.5 * kFeatureWidthDeg * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma_px));
  const Kernel smooth = gaussian_kernel(sigma_px, radius);
  const Plane smooth_rows = filter_rows(luminance, smooth);
  const auto magnitude = [&](const Kernel& derivative) {
    Plane along_x = filter_columns(filter_rows(luminance, derivative), smooth);
    to_magnitude(along_x, filter_columns(smooth_rows, derivative));
    return along_x;
  };
  return {magnitude(detector_kernel(sigma_px, radius, true)),
          magnitude(detector_kernel(sigma_px, radius, false))};
}

struct Seen {
  HuntLab colors;
  Features features;
};

Seen see(const Image8& image, double pixels_per_degree) {
  const Opponent opponent = opponent_from(image);
  return {seen_colors(opponent, pixels_per_degree), features_of(opponent.y, pixels_per_degree)};
}

void combine_row(const Seen& t, const Seen& r, float largest, int row, float* out) {
  const float *tl = t.colors.l.row(row), *ta = t.colors.a.row(row), *tb = t.colors.b.row(row);
  const float *rl = r.colors.l.row(row), *ra = r.colors.a.row(row), *rb = r.colors.b.row(row);
  const float *te = t.features.edge.row(row), *tp = t.features.point.row(row);
  const float *re = r.features.edge.row(row), *rp = r.features.point.row(row);
  constexpr float kHalfSqrt2 = 0.70710678f;
  static_assert(kFeatureExponent == 0.5, "the power is taken by a square root");
  for (int x = 0; x < t.colors.l.width; ++x) {
    const float color = color_error(hyab(tl[x] - rl[x], ta[x] - ra[x], tb[x] - rb[x]), largest);
    const float edge = std::fabs(te[x] - re[x]), point = std::fabs(tp[x] - rp[x]);
    const float feature = std::sqrt(kHalfSqrt2 * (edge > point ? edge : point));
    out[x] = clamp01(power(clamp01(color), 1 - clamp01(feature)));
  }
}

}  // namespace

std::vector<float> flip_map(const Image8& test, const Image8& reference, double pixels_per_degree) {
  TALISMAN_CHECK_EQ(test.width, reference.width);
  TALISMAN_CHECK_EQ(test.height, reference.height);
  TALISMAN_CHECK(pixels_per_degree > 0 && pixels_per_degree <= 10000);
  std::vector<float> error(static_cast<std::size_t>(test.width) * test.height, 0.0f);
  if (test.rgb == reference.rgb) return error;
  const Seen t = see(test, pixels_per_degree), r = see(reference, pixels_per_degree);
  const float largest = largest_color_distance();
  for_each_row(test.height, [&](int row) {
    combine_row(t, r, largest, row, error.data() + static_cast<std::size_t>(row) * test.width);
  });
  return error;
}

Image8 heat_map(const std::vector<float>& error, int width, int height) {
  TALISMAN_CHECK_EQ(error.size(), static_cast<std::size_t>(width) * height);
  constexpr int kStops = 6;
  constexpr float kPalette[kStops][3] = {{0, 0, 4},     {58, 16, 104},   {137, 38, 124},
                                         {220, 74, 96}, {253, 154, 106}, {252, 253, 200}};
  Image8 image{width, height, {}};
  image.rgb.reserve(error.size() * 3);
  for (const float e : error) {
    const float at = clamp01(e) * (kStops - 1);
    const int stop = std::min(static_cast<int>(at), kStops - 2);
    for (int c = 0; c < 3; ++c) {
      const float v = kPalette[stop][c] + (at - stop) * (kPalette[stop + 1][c] - kPalette[stop][c]);
      image.rgb.push_back(static_cast<std::uint8_t>(v + 0.5f));
    }
  }
  return image;
}

}  // namespace talisman::sequences
