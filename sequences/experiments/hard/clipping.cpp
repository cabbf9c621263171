// SPDX-License-Identifier: Apache-2.0
// Clipping and coverage: in weights of the corners every plane is a line, so the polygon that is left is worked out in long
// double from all crossings of all pairs of lines.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "chunker/clip.h"
#include "chunker/coverage.h"
#include "layers/clip.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using Corners = std::array<dvec3, 3>;
using chunker::ClipRegion;

/// a u + b v + c ≥ 0 in the weights (1 - u - v, u, v) of the corners.
struct WeightLine {
  Exact a, b, c;
  Exact height(Exact u, Exact v) const { return a * u + b * v + c; }
  Exact size() const { return std::fabs(a) + std::fabs(b) + std::fabs(c); }
};

struct WeightPoint {
  Exact u, v;
};

/// normal · (X, Y, w) ≥ offset.
WeightLine line_of(const Corners& q, Exact nx, Exact ny, Exact nw, Exact offset) {
  const auto at = [&](const dvec3& p) { return nx * p.x + ny * p.y + nw * p.z - offset; };
  const Exact first = at(q[0]);
  return {at(q[1]) - first, at(q[2]) - first, first};
}

std::vector<WeightLine> lines_of(const Corners& q, const ClipRegion& region) {
  const Exact g = chunker::kGuardBandPx, cx = region.center_px.x, cy = region.center_px.y;
  std::vector<WeightLine> lines{{1, 0, 0},
                                {0, 1, 0},
                                {-1, -1, 1},  // inside the triangle
                                line_of(q, 0, 0, 1, region.near_w),
                                line_of(q, 1, 0, g - cx, 0),
                                line_of(q, -1, 0, g + cx, 0),
                                line_of(q, 0, 1, g - cy, 0),
                                line_of(q, 0, -1, g + cy, 0)};
  if (region.kept)
    lines.push_back(
        line_of(q, region.kept->normal.x, region.kept->normal.y, region.kept->normal.z, region.kept->offset));
  return lines;
}

/// The corners of what all lines leave, in no order.
std::vector<WeightPoint> remaining_corners(const std::vector<WeightLine>& lines) {
  std::vector<WeightPoint> corners;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const WeightLine &l = lines[i], &m = lines[j];
      const Exact det = l.a * m.b - m.a * l.b;
      if (std::fabs(det) <= 1e-18L * (std::fabs(l.a * m.b) + std::fabs(m.a * l.b))) continue;
      const WeightPoint p{(l.b * m.c - m.b * l.c) / det, (m.a * l.c - l.a * m.c) / det};
      bool inside = true;
      for (const WeightLine& line : lines) inside = inside && line.height(p.u, p.v) >= -1e-17L * line.size();
      if (inside) corners.push_back(p);
    }
  return corners;
}

struct Texel2 {
  Exact x, y;
};

Texel2 texel_of(const Corners& q, Exact u, Exact v) {
  const auto mix = [&](int k) { return (1 - u - v) * q[0][k] + u * q[1][k] + v * q[2][k]; };
  return {mix(0) / mix(2), mix(1) / mix(2)};
}

/// The largest distance from a point of either set to the nearest of the other, texels: 0 for polygons that are equal.
Exact apart(const std::vector<Texel2>& a, const std::vector<Texel2>& b) {
  Exact worst = 0;
  for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const Texel2& p : *from) {
      Exact nearest = HUGE_VALL;
      for (const Texel2& q : *to) nearest = std::min(nearest, std::hypot(p.x - q.x, p.y - q.y));
      worst = worse(worst, nearest);
    }
  return worst;
}

/// Both what the polygon's points say and what its weights say, against the exact polygon.
HardOutcome clip_against_lines(const Corners& q, const ClipRegion& region) {
  const chunker::ClippedPolygon polygon = chunker::clip_triangle(q, region);
  std::vector<Texel2> points, weighed, right;
  for (int i = 0; i < polygon.count; ++i) {
    const chunker::ClipVertex& v = polygon.vertices[i];
    points.push_back({Exact(v.point.x) / v.point.z, Exact(v.point.y) / v.point.z});
    weighed.push_back(texel_of(q, v.weights.y, v.weights.z));
  }
  for (const WeightPoint& p : remaining_corners(lines_of(q, region))) right.push_back(texel_of(q, p.u, p.v));
  if (points.empty() || right.empty())
    return {points.empty() == right.empty() ? 0 : HUGE_VAL, points.empty()};
  return {double(worse(apart(points, right), apart(weighed, right))), false};
}

/// A display of 640 × 480 whose focal length is its half height.
constexpr double kFocal_px = 240;

/// The sprite point of a point of the camera's space (looking along -z).
dvec3 sprite_point(double x, double y, double depth) {
  return {kFocal_px * x + 320 * depth, 240 * depth - kFocal_px * y, depth};
}

ClipRegion region_of(double near_w) { return {near_w, {320, 240}, std::nullopt}; }

void add_triangles(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, const Corners& q,
                       double near_w = 0.1, bool refused = false) {
    cases.push_back({HardStage::Clipping,
                     name,
                     special,
                     extreme,
                     {1.0 / 512, "texels", "all pairs of planes, long double", refused},
                     [q, near_w] { return clip_against_lines(q, region_of(near_w)); }});
  };
  add("one corner behind", "an edge through the eye's plane", 1,
      {sprite_point(-1, -1, -3), sprite_point(1, -1, 4), sprite_point(0, 1, 5)});
  add("two corners behind", "1e6 m behind the eye", 1e7,
      {sprite_point(-1e6, -1, -1e6), sprite_point(1e6, -1, -1e6), sprite_point(0, 1, 5)});
  add("corner on near", "a corner on the near plane", 1,
      {sprite_point(0.01, 0, 0.1), sprite_point(1, -1, -4), sprite_point(0, 1, 5)});
  add("all on near", "a triangle in the near plane is kept", 1,
      {sprite_point(-0.05, 0, 0.1), sprite_point(0.05, -0.05, 0.1), sprite_point(0, 0.05, 0.1)});
  add("1e-12 before near", "a corner cut off by 1e-12 m", 1e12,
      {sprite_point(0, 0, 0.1 - 1e-12), sprite_point(1, -1, 4), sprite_point(-1, -1, 4)});
  add("near 1e-9", "depths 1e-9 ... 1e3 in one triangle", 1e12,
      {sprite_point(0, 0, -1), sprite_point(1e-9, 0, 2e-9), sprite_point(100, -300, 1e3)}, 1e-9);
  add("floor of 1e6 m", "1 m below the eye, in all directions", 1e6,
      {sprite_point(-1e6, -1, -1e6), sprite_point(1e6, -1, -1e6), sprite_point(0, -1, 1e6)});
  add("sky of 1e12 m", "a corner 1e12 m away", 1e12,
      {sprite_point(-1e12, 1e11, 1e12), sprite_point(1e12, 1e11, 1e12), sprite_point(0, 1, 1)});
  add("1e9 texels wide", "far beyond the guard band on both sides", 1e9,
      {dvec3(-1e9, -5, 1), dvec3(1e9, 100, 1), dvec3(1e9, 5, 1)});
  add("needle of 1e-6 texels", "1e-6 texels across, through near and guard band", 1e6,
      {dvec3(0, 0, -1), dvec3(8e3, 1, 1), dvec3(8e3, 1 + 1e-6, 1)});
  add("all behind", "nothing is left", 1,
      {sprite_point(-1, 0, -1), sprite_point(1, 0, -2), sprite_point(0, 1, -3)}, 0.1, true);
}

// --- A plane of the world

/// A triangle that lies in the plane, at any angle and distance, stays whole: the share of its area that is lost.
HardOutcome in_the_plane(double size) {
  Random random(3);
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    const auto unit = [&] {
      const dvec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      return v / glm::length(v);
    };
    const dvec3 normal = unit(), along = glm::normalize(glm::cross(normal, unit())),
                across = glm::cross(normal, along);
    const dvec3 origin = dvec3(300, 200, 100) + 3.0 * unit();
    ClipRegion region = region_of(0.1);
    region.kept = chunker::HalfSpace{normal, glm::dot(normal, origin)};
    const Corners q{origin, origin + size * along, origin + size * across};
    const chunker::ClippedPolygon polygon = chunker::clip_triangle(q, region);
    double doubled = 0;
    for (int i = 0; i < polygon.count; ++i) {
      const dvec3 &a = polygon.vertices[i].weights, &b = polygon.vertices[(i + 1) % polygon.count].weights;
      doubled += a.y * b.z - b.y * a.z;
    }
    worst = worse(worst, std::fabs(1 - doubled));
  }
  return {worst, false};
}

/// Two triangles share an edge that is cut: the corners there must be the same to the bit, or there is a crack.
HardOutcome shared_edge() {
  Random random(4);
  int different = 0;
  for (int n = 0; n < 1000; ++n) {
    const auto any = [&](double depth) {
      const double x = random.uniform(-50, 50), y = random.uniform(-50, 50);
      return sprite_point(x, y, depth);
    };
    const dvec3 a = any(random.log_uniform(0.2, 1e6)), b = any(-random.log_uniform(1e-6, 1e6));
    const auto cut_of = [&](const Corners& q) {
      const chunker::ClippedPolygon polygon = chunker::clip_triangle(q, region_of(0.1));
      dvec3 found(NAN);
      for (int i = 0; i < polygon.count; ++i) {
        const chunker::ClipVertex& v = polygon.vertices[i];
        if (v.weights.z == 0 && v.weights.x > 0 && v.weights.y > 0 && !(v.point.z > found.z)) found = v.point;
      }
      return found;
    };
    const dvec3 one = cut_of({a, b, any(7)}), other = cut_of({b, a, any(3)});
    different += !(one == other) && !(std::isnan(one.x) && std::isnan(other.x));
  }
  return {double(different), false};
}

// --- Coverage

/// Triangles around a middle, out to a square: the samples of one chunk that are not covered exactly once.
HardOutcome fan_covers_once(int corners, double radius_px) {
  std::vector<std::int32_t> x, y;
  const auto lattice = [](double v) { return std::int32_t(std::lround(v * chunker::kSubpixel)); };
  for (int i = 0; i < corners; ++i) {
    const double t = 8.0 * i / corners,
                 f = t - std::floor(t);  // along the outline of a square, half a side a step
    const double s[8][2] = {{1, f},   {1 - f, 1},  {-f, 1}, {-1, 1 - f},
                            {-1, -f}, {f - 1, -1}, {f, -1}, {1, f - 1}};
    x.push_back(lattice(16.3 + radius_px * s[int(t)][0]));
    y.push_back(lattice(15.7 + radius_px * s[int(t)][1]));
  }
  std::vector<int> times(32 * 32 * 16, 0);
  chunker::Coverage coverage;
  for (int i = 0; i < corners; ++i) {
    const int j = (i + 1) % corners;
    chunker::Triangle t{{lattice(16.3), x[i], x[j]}, {lattice(15.7), y[i], y[j]}, {1, 1, 1}, {0, 1, 2}, 0};
    if (chunker::doubled_area(t) <= 0) continue;
    chunker::cover<16>(chunker::edges_of(t, 0, 0), {0, 0, 31, 31}, coverage);
    for (int k = 0; k < 32 * 32; ++k) {
      const bool touched = coverage.touched[k / 32] >> (k % 32) & 1,
                 full = coverage.full[k / 32] >> (k % 32) & 1;
      const int mask = full ? 0xffff : touched ? coverage.mask[k] : 0;
      for (int s = 0; s < 16; ++s) times[16 * k + s] += mask >> s & 1;
    }
  }
  return {double(std::count_if(times.begin(), times.end(), [](int n) { return n != 1; })), false};
}

// --- Material points

/// A box that reaches through the eye then, and beside it now: how far a point of what is in view in both lies outside
/// of a plane of either view, relative to its depth.
HardOutcome material_points_in_both_views(double scale) {
  static constexpr std::array<std::array<int, 3>, 12> kBox{{{0, 1, 3},
                                                            {0, 3, 2},
                                                            {4, 6, 7},
                                                            {4, 7, 5},
                                                            {0, 4, 5},
                                                            {0, 5, 1},
                                                            {2, 3, 7},
                                                            {2, 7, 6},
                                                            {0, 2, 6},
                                                            {0, 6, 4},
                                                            {1, 5, 7},
                                                            {1, 7, 3}}};
  std::vector<layers::dvec4> then, now;
  for (int k = 0; k < 8; ++k) {
    const dvec3 p = scale * (dvec3{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 5 : -1} + dvec3{0.2, -0.3, 0.4});
    then.push_back({p.x, p.y, p.z, p.z});
    now.push_back({p.x + 0.1 * scale, 0.9 * p.y, p.z + 0.2 * scale, p.z + 0.2 * scale});
  }
  std::vector<layers::HalfSpace> planes;
  for (const int state : {0, 1})
    for (const layers::HalfSpace& h : layers::view_half_spaces(1e-3 * scale, 0.25, state))
      planes.push_back(h);
  const std::vector<layers::MaterialPoint> points = layers::clip_surface(kBox, then, now, planes);
  Exact worst = points.size() < 4 ? HUGE_VALL : 0;
  for (const layers::MaterialPoint& p : points)
    for (const layers::HalfSpace& h : planes) {
      const layers::dvec4& c = p.clip[h.state];
      const Exact height = Exact(h.x) * c.x + Exact(h.y) * c.y + Exact(h.w) * c.w + h.constant;
      worst = worse(worst, -height / c.w);
    }
  return {double(worst), false};
}

void add_surfaces(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, HardRule rule,
                       std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Clipping, name, special, extreme, rule, std::move(measure)});
  };
  for (const double size : {1e-6, 50.0})
    add(size < 1 ? "in the plane, 1e-6" : "in the plane, 50", "200 triangles in the plane that cuts", size,
        {1e-9, "of the area", "all of it stays"}, [size] { return in_the_plane(size); });
  add("shared edges", "1000 pairs, depths 1e-6 ... 1e6", 1e12, {0, "pairs that differ", "the other triangle"},
      shared_edge);
  add("fan of 997, 20 px", "slivers with one corner", 997, {0, "samples", "each covered once"},
      [] { return fan_covers_once(997, 20); });
  add("fan of 97, 8000 px", "slivers out to the guard band", 8000, {0, "samples", "each covered once"},
      [] { return fan_covers_once(97, 8000); });
  for (const double scale : {1e-6, 1e6})
    add(scale < 1 ? "both views, 1e-6 m" : "both views, 1e6 m", "a box through the eye, cut by ten planes",
        scale, {1e-8, "of the depth", "heights, long double"},
        [scale] { return material_points_in_both_views(scale); });
}

}  // namespace

std::vector<HardCase> hard_clipping() {
  std::vector<HardCase> cases;
  add_triangles(cases);
  add_surfaces(cases);
  return cases;
}

}  // namespace talisman::sequences
