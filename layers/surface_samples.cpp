// SPDX-License-Identifier: Apache-2.0
#include "layers/surface_samples.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr int kInstants = 8;
constexpr double kLeastDuration_s = 2;  ///< of spins, which have no end
constexpr double kFacing = 0.25;        ///< a normal that turns by 60° counts as a quarter of the extent
/// Triangles larger than this share of all area have candidates inside.
constexpr double kLargeShare = 1.0 / 256;
constexpr int kMostCells = 8;  ///< of the grid inside one triangle, along each side
constexpr std::size_t kMostCandidates = 20'000;

using CornerIndices = std::array<std::uint32_t, 3>;

double area_of_corners(const std::vector<dvec3>& positions, const CornerIndices& t) {
  return glm::length(cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]])) / 2;
}

CornerIndices corners_at(const Mesh& mesh, std::size_t first) {
  return {mesh.indices[first], mesh.indices[first + 1], mesh.indices[first + 2]};
}

/// Every vertex that a triangle names, once.
void add_vertices(int part, const Mesh& mesh, std::vector<SurfaceSample>& candidates) {
  std::vector<char> named(mesh.positions.size(), 0);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const CornerIndices t = corners_at(mesh, i);
    for (int k = 0; k < 3; ++k) {
      if (named[t[k]]) continue;
      named[t[k]] = 1;
      candidates.push_back({part, {t[k], t[(k + 1) % 3], t[(k + 2) % 3]}, {1, 0, 0}});
    }
  }
}

/// A grid inside the triangles that are large among all.
void add_insides(int part, const Mesh& mesh, const std::vector<dvec3>& positions, double all_area,
                 std::vector<SurfaceSample>& candidates) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const CornerIndices t = corners_at(mesh, i);
    const double share = area_of_corners(positions, t) / all_area;
    if (!(share > kLargeShare)) continue;
    const int cells = std::min(kMostCells, static_cast<int>(std::ceil(std::sqrt(share / kLargeShare))) + 1);
    for (int a = 0; a < cells; ++a)
      for (int b = 0; a + b < cells; ++b) {
        const dvec3 weight = dvec3(a + 1.0 / 3, b + 1.0 / 3, 0) / static_cast<double>(cells);
        candidates.push_back({part, t, {1 - weight.x - weight.y, weight.x, weight.y}});
      }
  }
}

/// Candidates of all parts, thinned out evenly where there are many.
std::vector<SurfaceSample> candidates_of(const Scene& scene, std::span<const int> parts) {
  const SceneFrame frame = scene.at(0);
  std::vector<std::vector<dvec3>> positions;
  double area = 0;
  for (const int part : parts) {
    positions.push_back(world_positions(frame, scene.parts[part]));
    const Mesh& mesh = scene.meshes[scene.parts[part].mesh];
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      area += area_of_corners(positions.back(), corners_at(mesh, i));
  }
  std::vector<SurfaceSample> candidates;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Mesh& mesh = scene.meshes[scene.parts[parts[k]].mesh];
    add_vertices(parts[k], mesh, candidates);
    if (area > 0 && std::isfinite(area)) add_insides(parts[k], mesh, positions[k], area, candidates);
  }
  if (candidates.size() <= kMostCandidates) return candidates;
  std::vector<SurfaceSample> thinned;
  for (std::size_t i = 0; i < kMostCandidates; ++i)
    thinned.push_back(candidates[i * candidates.size() / kMostCandidates]);
  return thinned;
}

std::vector<SurfacePlace> places_at(const Scene& scene, double t_s,
                                    const std::vector<SurfaceSample>& samples) {
  std::vector<SurfacePlace> places;
  append_sample_places(scene.at(t_s), samples, places);
  return places;
}

dvec3 mean_position(const std::vector<SurfacePlace>& places) {
  dvec3 sum(0.0);
  for (const SurfacePlace& place : places) sum += place.position;
  return sum / static_cast<double>(places.size());
}

/// What the best affine map from `rest` to `now` leaves over, per sample. Flat and straight bodies have no
/// third direction, which a little on the diagonal stands for.
std::vector<dvec3> own_motion(const std::vector<SurfacePlace>& rest, const std::vector<SurfacePlace>& now) {
  constexpr double kRidge = 1e-9;
  const dvec3 from = mean_position(rest), to = mean_position(now);
  dmat3 square(0.0), product(0.0);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const dvec3 p = rest[i].position - from;
    square += glm::outerProduct(p, p);
    product += glm::outerProduct(now[i].position - to, p);
  }
  const double trace = square[0][0] + square[1][1] + square[2][2];
  const dmat3 map = product * glm::inverse(square + dmat3(kRidge * trace));
  std::vector<dvec3> left;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const dvec3 r = now[i].position - to - map * (rest[i].position - from);
    left.push_back(layers::is_finite(r) ? r : dvec3(0.0));
  }
  return left;
}

double extent_of(const std::vector<SurfacePlace>& places) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const SurfacePlace& place : places) lo = min(lo, place.position), hi = max(hi, place.position);
  return places.empty() ? 0 : glm::length(hi - lo);
}

/// One of the two distances, and how far each candidate is from what was chosen so far.
class Spread {
 public:
  explicit Spread(std::size_t candidates) : nearest_(candidates, HUGE_VAL) {}

  template <typename Distance>
  void choose(std::size_t chosen, Distance distance) {
    for (std::size_t i = 0; i < nearest_.size(); ++i)
      nearest_[i] = std::min(nearest_[i], distance(i, chosen));
  }
  /// The first of the farthest; its distance is 0 where nothing new is left.
  std::size_t farthest() const {
    return static_cast<std::size_t>(std::max_element(nearest_.begin(), nearest_.end()) - nearest_.begin());
  }
  double distance(std::size_t i) const { return nearest_[i]; }

 private:
  std::vector<double> nearest_;
};

struct Candidates {
  std::vector<SurfacePlace> rest;
  std::vector<std::vector<dvec3>> own;  ///< by instant
  double extent = 0;

  double apart(std::size_t i, std::size_t k) const {
    return glm::distance(rest[i].position, rest[k].position) / extent +
           kFacing * glm::distance(rest[i].normal, rest[k].normal);
  }
  double moved_apart(std::size_t i, std::size_t k) const {
    double most = 0;
    for (const std::vector<dvec3>& at : own) most = std::max(most, glm::distance(at[i], at[k]));
    return most;
  }
};

/// Own motion below this share of the extent is rounding.
constexpr double kStill = 1e-7;

std::vector<std::size_t> chosen_of(const Candidates& candidates, std::size_t count) {
  const std::size_t size = candidates.rest.size();
  Spread places(size), motions(size);
  std::vector<std::size_t> chosen;
  const dvec3 middle = mean_position(candidates.rest);
  std::size_t next = 0;
  for (std::size_t i = 0; i < size; ++i)
    if (glm::distance(candidates.rest[i].position, middle) >
        glm::distance(candidates.rest[next].position, middle))
      next = i;
  while (chosen.size() < count) {
    chosen.push_back(next);
    places.choose(next, [&](std::size_t i, std::size_t k) { return candidates.apart(i, k); });
    if (!candidates.own.empty())
      motions.choose(next, [&](std::size_t i, std::size_t k) { return candidates.moved_apart(i, k); });
    const bool by_motion = !candidates.own.empty() && chosen.size() % 2 == 1 &&
                           motions.distance(motions.farthest()) > kStill * candidates.extent;
    next = by_motion ? motions.farthest() : places.farthest();
    if (!(places.distance(next) > 0)) break;
  }
  return chosen;
}

SurfacePlace place_of(const SurfaceSample& sample, const dvec3* corner, double sign) {
  const dvec3 normal = direction_or_zero(cross(corner[1] - corner[0], corner[2] - corner[0]));
  return {sample.weight.x * corner[0] + sample.weight.y * corner[1] + sample.weight.z * corner[2],
          sign * normal};
}

}  // namespace

std::vector<SurfaceSample> spread_samples(const Scene& scene, std::span<const int> parts, int count,
                                          bool of_motion) {
  if (count <= 0) return {};
  const std::vector<SurfaceSample> samples = candidates_of(scene, parts);
  Candidates candidates;
  candidates.rest = places_at(scene, 0, samples);
  candidates.extent = extent_of(candidates.rest);
  if (samples.empty() || !(candidates.extent > 0 && std::isfinite(candidates.extent))) return {};
  const double duration_s = std::max(scene.duration_s(), kLeastDuration_s);
  for (int k = 1; of_motion && k < kInstants; ++k)
    candidates.own.push_back(
        own_motion(candidates.rest, places_at(scene, duration_s * k / kInstants, samples)));
  std::vector<std::size_t> chosen = chosen_of(candidates, static_cast<std::size_t>(count));
  std::sort(chosen.begin(), chosen.end());  // candidates are in the order of the parts
  std::vector<SurfaceSample> result;
  result.reserve(chosen.size());
  for (const std::size_t i : chosen) result.push_back(samples[i]);
  return result;
}

void append_sample_places(const SceneFrame& frame, std::span<const SurfaceSample> samples,
                          std::vector<SurfacePlace>& places) {
  places.reserve(places.size() + samples.size());
  std::vector<std::uint32_t> vertices;
  for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
    const Part& part = frame.scene->parts[samples[first].part];
    vertices.clear();
    for (end = first; end < samples.size() && samples[end].part == samples[first].part; ++end)
      vertices.insert(vertices.end(), samples[end].vertex.begin(), samples[end].vertex.end());
    const std::vector<dvec3> corners = world_positions(frame, part, vertices);
    const bool mirrors =
        part.node >= 0 && part.skin < 0 && glm::determinant(dmat3(frame.world_from_node[part.node])) < 0;
    for (std::size_t i = first; i < end; ++i)
      places.push_back(place_of(samples[i], &corners[3 * (i - first)], mirrors ? -1 : 1));
  }
}

}  // namespace talisman::layers
