// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/bare_surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

#include "sequences/files/errors.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::vec3;

/// Coordinates larger than this many sizes keep fewer than 13 bits for the size in a float.
constexpr double kFarAway = 2000;
constexpr float kBareGrey = 0.6f;  // sRGB

struct PlaceHash {
  std::size_t operator()(const dvec3& p) const {
    std::uint64_t hash = 0, bits = 0;
    for (int k = 0; k < 3; ++k) {
      std::memcpy(&bits, &p[k], sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Of each vertex: the mean of the triangles around its place; up where they have none.
std::vector<vec3> made_normals(const BareSurface& surface) {
  const std::vector<std::uint32_t> place = place_numbers(surface.positions);
  std::vector<dvec3> sums(surface.positions.size(), dvec3(0));
  const auto& index = surface.indices;
  for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
    const dvec3 a = surface.positions[index[i]];
    const dvec3 n = glm::cross(surface.positions[index[i + 1]] - a, surface.positions[index[i + 2]] - a);
    const double length = glm::length(n);
    for (std::size_t k = 0; length > 0 && k < 3; ++k) sums[place[index[i + k]]] += n / length;
  }
  std::vector<vec3> normals;
  normals.reserve(place.size());
  for (const std::uint32_t number : place) {
    const double length = glm::length(sums[number]);
    normals.push_back(length > 1e-12 ? vec3(sums[number] / length) : vec3(0, 1, 0));
  }
  return normals;
}

std::vector<vec3> normals_of(const BareSurface& surface) {
  if (surface.normals.empty()) return made_normals(surface);
  std::vector<vec3> normals = surface.normals, made;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const float length = glm::length(normals[i]);
    const bool usable = length > 1e-12f && std::isfinite(length);
    if (!usable && made.empty()) made = made_normals(surface);
    normals[i] = usable ? normals[i] / length : made[i];
  }
  return normals;
}

layers::Mesh mesh_of(const BareSurface& surface, const dvec3& origin) {
  layers::Mesh mesh;
  mesh.name = surface.name;
  mesh.positions.reserve(surface.positions.size());
  for (const dvec3& p : surface.positions) mesh.positions.emplace_back(p - origin);
  mesh.normals = normals_of(surface);
  mesh.uvs = surface.uvs;
  mesh.colors = surface.colors;
  mesh.alphas = surface.alphas;
  mesh.indices.reserve(surface.indices.size());
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    mesh.indices.insert(mesh.indices.end(), &surface.indices[i], &surface.indices[i] + 3);
    if (!surface.normals.empty()) turn_last_to_normals(mesh);
  }
  return mesh;
}

}  // namespace

std::vector<std::uint32_t> place_numbers(std::span<const dvec3> positions) {
  std::unordered_map<dvec3, std::uint32_t, PlaceHash> number_of;
  number_of.reserve(positions.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(positions.size());
  for (const dvec3& p : positions)  // -0 is 0
    numbers.push_back(number_of.emplace(p + 0.0, static_cast<std::uint32_t>(number_of.size())).first->second);
  return numbers;
}

dvec3 local_origin(const dvec3& lo, const dvec3& hi) {
  const double size = glm::length(hi - lo), away = glm::length(glm::max(glm::abs(lo), glm::abs(hi)));
  return size > 0 && std::isfinite(away) && away > kFarAway * size ? glm::round(0.5 * (lo + hi)) : dvec3(0);
}

void turn_last_to_normals(layers::Mesh& mesh) {
  const auto last = mesh.indices.end() - 3;
  const vec3 a = mesh.positions[last[0]];
  const vec3 n = glm::cross(mesh.positions[last[1]] - a, mesh.positions[last[2]] - a);
  if (std::all_of(last, mesh.indices.end(),
                  [&](std::uint32_t vertex) { return glm::dot(n, mesh.normals[vertex]) < 0; }))
    std::swap(last[1], last[2]);
}

layers::Material bare_look() {
  layers::Material look;
  look.name = "DefaultMaterial";
  look.base_color = vec3(linear_from_srgb(kBareGrey));
  look.two_sided = true;
  return look;
}

void add_surfaces(const ModelPlace& place, const std::vector<BareSurface>& surfaces,
                  const layers::Material& look, layers::Scene& scene) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const BareSurface& surface : surfaces)
    for (const dvec3& p : surface.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
  const std::string file = std::filesystem::path(place.path).filename().string();
  const dvec3 origin = local_origin(lo, hi);
  scene.nodes.push_back({file, -1, {origin}});
  scene.materials.push_back(look);
  for (const BareSurface& surface : surfaces) {
    if (surface.indices.empty()) continue;
    layers::Part part;
    part.name = surface.name.empty() ? file : file + "/" + surface.name;
    part.node = 0;
    part.mesh = static_cast<int>(scene.meshes.size());
    part.material = 0;
    scene.meshes.push_back(mesh_of(surface, origin));
    scene.parts.push_back(part);
  }
  if (scene.parts.empty()) throw InputError("has no triangles, rule: a model has at least one");
}

}  // namespace talisman::sequences
