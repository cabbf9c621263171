// SPDX-License-Identifier: Apache-2.0
// The shading of a glTF surface against the definition, GGX over Lambert (glTF 2.0, appendix B), integrated over 10⁴
// directions: a sphere under one light and light from everywhere.
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/import/pbr_surface.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using glm::dvec3;

constexpr double kBase = 0.8, kLight = 0.7, kAmbient = 0.3;
constexpr int kSamples = 10000, kSide = 20, kAngles = 24;
const dvec3 kToEye(0, 0, 1), kToLight = glm::normalize(dvec3(0.5, 0.6, 0.62));
constexpr std::array kSteps = {0.0, 0.25, 0.5, 0.75, 1.0};

double code_value(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

/// G / (4 (N·L) (N·V)) of Smith's height-correlated GGX; `a` = roughness².
double visibility(double nl, double nv, double a) {
  return 0.5 /
         (nl * std::sqrt(nv * nv * (1 - a * a) + a * a) + nv * std::sqrt(nl * nl * (1 - a * a) + a * a));
}

double schlick(double f0, double vh) { return f0 + (1 - f0) * std::pow(1 - vh, 5); }

struct Surface {
  double metallic, roughness;
  double a() const { return std::max(roughness * roughness, 1e-3); }
  double f0() const { return 0.04 + (kBase - 0.04) * metallic; }
  double diffuse() const { return kBase * (1 - metallic); }
};

/// The share of even light from everywhere that the highlight term sends to the eye at cosine `nv`: sampled by the
/// distribution of half vectors.
double mirrored_share(const Surface& s, double nv) {
  const double a = s.a(), nx = std::sqrt(1 - nv * nv);
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double u = (i + 0.5) / kSamples, phi = 2 * M_PI * std::fmod(i * 0.6180339887498949, 1.0);
    const double cosine = std::sqrt((1 - u) / (1 + (a * a - 1) * u)), sine = std::sqrt(1 - cosine * cosine);
    const dvec3 h(sine * std::cos(phi), sine * std::sin(phi), cosine), v(nx, 0, nv);
    const double vh = glm::dot(v, h), nl = 2 * vh * h.z - nv;
    if (nl > 0 && vh > 0) sum += schlick(s.f0(), vh) * 4 * nl * visibility(nl, nv, a) * vh / h.z;
  }
  return sum / kSamples;
}

/// Radiance of a white Lambert surface that faces the light is kLight.
double right_radiance(const Surface& s, const dvec3& n, double mirrored) {
  const double nl = std::max(0.0, glm::dot(n, kToLight)), nv = glm::dot(n, kToEye);
  const dvec3 h = glm::normalize(kToLight + kToEye);
  const double nh = std::max(0.0, glm::dot(n, h)), f = schlick(s.f0(), glm::dot(kToEye, h)), a = s.a();
  const double d = a * a / std::pow(nh * nh * (a * a - 1) + 1, 2);  // π D
  const double direct = nl > 0 ? (s.diffuse() * (1 - f) + d * visibility(nl, nv, a) * f) * nl : 0;
  return kLight * direct + kAmbient * (s.diffuse() * (1 - mirrored) + mirrored);
}

double our_radiance(const PbrSurface& s, const dvec3& n) {
  const double nl = glm::dot(n, kToLight), nh = std::max(0.0, glm::dot(n, glm::normalize(kToLight + kToEye)));
  const double highlight = nl > 0 ? s.specular.x * std::pow(nh, s.shininess) : 0;
  return s.color.x * (kAmbient + kLight * std::max(0.0, nl)) + kLight * highlight;
}

/// Mean difference in code values over the sphere.
double difference(const Surface& s) {
  std::array<double, kAngles> mirrored;
  for (int k = 0; k < kAngles; ++k) mirrored[k] = mirrored_share(s, std::max(0.02, k / (kAngles - 1.0)));
  const PbrSurface ours = pbr_surface(layers::vec3(kBase), layers::vec3(0.04f), s.metallic, s.roughness);
  double sum = 0;
  int count = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      dvec3 n((2 * x + 1.0) / kSide - 1, (2 * y + 1.0) / kSide - 1, 0);
      const double flat = n.x * n.x + n.y * n.y;
      if (flat > 0.96) continue;
      n.z = std::sqrt(1 - flat);
      const double right = right_radiance(s, n, mirrored[std::lround(n.z * (kAngles - 1))]);
      sum += std::abs(code_value(our_radiance(ours, n)) - code_value(right));
      ++count;
    }
  return sum / count;
}

TEST(PbrSurface, IsNearGgxOverLambertAsThePageSays) {
  const std::string page = tests::content(std::string(TALISMAN_SOURCE_DIR) + "/docs/models.md");
  std::vector<double> all;
  std::string table;
  for (const double metallic : kSteps) {
    char cell[32];
    std::snprintf(cell, sizeof cell, "| %.2f |", metallic);
    std::string row = cell;
    for (const double roughness : kSteps) {
      all.push_back(difference({metallic, roughness}));
      std::snprintf(cell, sizeof cell, " %.0f |", all.back());
      row += cell;
    }
    EXPECT_NE(page.find(row), std::string::npos) << "docs/models.md should say\n" << row;
  }
  std::sort(all.begin(), all.end());
  EXPECT_LE(all[all.size() / 2], 12) << "median";
  EXPECT_LE(all.back(), 25) << "worst";
}

TEST(PbrSurface, MetalIsNotBlackUnderLightFromEverywhere) {
  for (const double roughness : kSteps) {
    const PbrSurface gold = pbr_surface({1, 0.77f, 0.34f}, layers::vec3(0.04f), 1, roughness);
    EXPECT_NEAR(gold.color.x, 0.45, 1e-6);
    EXPECT_NEAR(gold.color.z, 0.153, 1e-6);  // it keeps its hue
  }
}

TEST(PbrSurface, RoughDielectricIsItsBaseAlone) {
  const PbrSurface clay = pbr_surface({0.5f, 0.25f, 1}, layers::vec3(0.04f), 0, 1);
  EXPECT_EQ(clay.color, layers::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(clay.specular, layers::vec3(0));
}

}  // namespace
}  // namespace talisman::sequences
