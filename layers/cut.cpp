// SPDX-License-Identifier: Apache-2.0
#include "layers/cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "layers/check.h"
#include "layers/mesh_subset.h"

namespace talisman::layers {

namespace {

using CutTriangles = std::vector<std::uint32_t>;

/// Where a triangle is and where it faces: the middle of its bounds over the size of the mesh, and half its normal.
using CutPlace = std::array<double, 6>;

/// Axes in the order in which they are cut where several are as long: directions first.
constexpr std::array<std::size_t, 6> kCutAxes = {3, 4, 5, 0, 1, 2};

std::vector<CutPlace> places_of(const Mesh& mesh) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const vec3& p : mesh.positions) lo = glm::min(lo, dvec3(p)), hi = glm::max(hi, dvec3(p));
  const dvec3 extent = hi - lo;
  const double size = std::max({extent.x, extent.y, extent.z});
  std::vector<CutPlace> places(static_cast<std::size_t>(mesh.triangle_count()));
  for (std::size_t t = 0; t < places.size(); ++t) {
    const auto corner = [&](std::size_t k) { return dvec3(mesh.positions[mesh.indices[3 * t + k]]); };
    const dvec3 a = corner(0), b = corner(1), c = corner(2);
    const dvec3 middle = 0.5 * (glm::min(glm::min(a, b), c) + glm::max(glm::max(a, b), c)) - lo;
    const dvec3 normal = size > 0 ? glm::cross((b - a) / size, (c - a) / size) : dvec3(0);
    const double length = glm::length(normal);
    for (int k = 0; k < 3; ++k) {
      places[t][static_cast<std::size_t>(k)] = size > 0 ? middle[k] / size : 0;
      places[t][static_cast<std::size_t>(k) + 3] = length > 0 ? 0.5 * normal[k] / length : 0;
    }
  }
  return places;
}

/// CutTriangles that are together, and how they are next divided.
struct CutPiece {
  CutTriangles triangles;
  std::size_t axis = 0;
  double length = 0, middle = 0;  ///< along the axis on which they are farthest apart

  CutPiece(CutTriangles of, const std::vector<CutPlace>& places) : triangles(std::move(of)) {
    for (const std::size_t k : kCutAxes) {
      double lo = HUGE_VAL, hi = -HUGE_VAL;
      for (const std::uint32_t t : triangles)
        lo = std::min(lo, places[t][k]), hi = std::max(hi, places[t][k]);
      if (hi - lo > length) axis = k, length = hi - lo, middle = 0.5 * (lo + hi);
    }
  }
  /// The longest is divided first; of what is all in one place what has most triangles.
  bool operator<(const CutPiece& other) const {
    return length != other.length ? length < other.length : triangles.size() < other.triangles.size();
  }
};

/// Takes the upper half away from a piece of more than one triangle.
CutTriangles upper_half(const std::vector<CutPlace>& places, CutTriangles& triangles, const CutPiece& piece) {
  auto end = std::stable_partition(triangles.begin(), triangles.end(),
                                   [&](std::uint32_t t) { return places[t][piece.axis] <= piece.middle; });
  if (end == triangles.begin() || end == triangles.end())  // in one place, or as good as
    end = triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2);
  CutTriangles upper(end, triangles.end());
  triangles.erase(end, triangles.end());
  return upper;
}

/// All triangles in `count` pieces, which there are no more of than triangles.
std::vector<CutPiece> divided(const Mesh& mesh, std::size_t count) {
  const std::vector<CutPlace> places = places_of(mesh);
  CutTriangles all(places.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<CutPiece> pieces;
  pieces.emplace_back(std::move(all), places);
  while (pieces.size() < count) {
    const auto most =
        std::max_element(pieces.begin(), pieces.end(), [](const CutPiece& a, const CutPiece& b) {
          const bool can_a = a.triangles.size() > 1, can_b = b.triangles.size() > 1;
          return can_a != can_b ? can_b : a < b;
        });
    CutTriangles lower = most->triangles, upper = upper_half(places, lower, *most);
    *most = CutPiece(std::move(lower), places);
    pieces.emplace_back(std::move(upper), places);
  }
  return pieces;
}

/// The triangles, in their old order.
Mesh mesh_of(const Mesh& from, const CutTriangles& triangles) {
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t t : triangles)
    for (std::size_t k = 0; k < 3; ++k) indices.push_back(from.indices[3 * std::size_t{t} + k]);
  return with_triangles(from, indices);
}

}  // namespace

std::string cut_piece_name(const std::string& part, int k) { return part + "~" + std::to_string(k); }

std::string cut_defect(const Scene& scene, int part) {
  const Part& of = scene.parts[static_cast<std::size_t>(part)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(of.mesh)];
  if (of.skin >= 0) return "has a skin";
  return mesh.morphs.empty() ? "" : "has morph targets";
}

int cut_part(Scene& scene, int part, int pieces) {
  TALISMAN_CHECK(cut_defect(scene, part).empty());
  const Part whole = scene.parts[static_cast<std::size_t>(part)];
  const Mesh from = scene.meshes[static_cast<std::size_t>(whole.mesh)];
  const int count = std::min({pieces, from.triangle_count(), kMostCutPieces});
  if (count <= 1) return 1;
  const std::vector<CutPiece> found = divided(from, static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < found.size(); ++k) {
    Part piece = whole;
    piece.name = cut_piece_name(whole.name, static_cast<int>(k) + 1);
    piece.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(mesh_of(from, found[k].triangles));
    if (k == 0)
      scene.parts[static_cast<std::size_t>(part)] = std::move(piece);
    else
      scene.parts.push_back(std::move(piece));
  }
  return count;
}

}  // namespace talisman::layers
