// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/obj_meshes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "sequences/import/surfaces/bare_surface.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

using layers::dvec3;
using layers::vec3;

dvec3 place_of(const tinyobj::attrib_t& attributes, int vertex) {
  const std::size_t at = 3 * static_cast<std::size_t>(vertex);
  return {attributes.vertices[at], attributes.vertices[at + 1], attributes.vertices[at + 2]};
}

SmoothNormals::SmoothNormals(const ObjContent& content) : content_(content) {
  std::vector<dvec3> places;
  const int count = static_cast<int>(content.attributes.vertices.size() / 3);
  places.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) places.push_back(place_of(content.attributes, i));
  place_ = place_numbers(places);
  sums_.resize(places.size(), dvec3(0));
  for (const tinyobj::shape_t& shape : content.shapes)
    for (std::size_t f = 0; 3 * f < shape.mesh.indices.size(); ++f) {
      const dvec3 n = flat(shape.mesh, f);
      for (std::size_t k = 0; k < 3; ++k) sum_at(shape.mesh, f, k) += n;
    }
}

vec3 SmoothNormals::at(const tinyobj::mesh_t& mesh, std::size_t face, std::size_t corner) {
  const bool is_flat = content_.has_groups && mesh.smoothing_group_ids[face] == 0;
  const dvec3 n = is_flat ? flat(mesh, face) : sum_at(mesh, face, corner);
  const double length = glm::length(n);
  return length > 1e-12 ? vec3(n / length) : vec3(0, 1, 0);
}

dvec3& SmoothNormals::sum_at(const tinyobj::mesh_t& mesh, std::size_t face, std::size_t corner) {
  const std::uint32_t place = place_[static_cast<std::size_t>(mesh.indices[3 * face + corner].vertex_index)];
  const std::uint64_t group = content_.has_groups ? mesh.smoothing_group_ids[face] : 0;
  return group == 0 ? sums_[place] : sums_of_groups_[group << 32 | place];
}

dvec3 SmoothNormals::flat(const tinyobj::mesh_t& mesh, std::size_t face) const {
  dvec3 p[3];
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = place_of(content_.attributes, mesh.indices[3 * face + k].vertex_index);
  const dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double length = glm::length(n);
  return length > 0 ? n / length : dvec3(0);
}

MeshBuilder::MeshBuilder(const ObjContent& content, const dvec3& origin)
    : content_(content), origin_(origin), first_(content.attributes.vertices.size() / 3, -1) {}

layers::Mesh MeshBuilder::mesh_of(const tinyobj::mesh_t& from, int id, const MapPlacing& placing) {
  layers::Mesh mesh;
  known_.clear(), used_.clear();
  has_uvs_ = false;
  placing_ = placing;
  uncolored_ = id < 0 ? default_obj_material().look.base_color : vec3(1);  // a material has its own
  for (std::size_t f = 0; 3 * f < from.indices.size(); ++f)
    if (from.material_ids[f] == id) add_triangle(from, f, mesh);
  for (const int place : used_) first_[static_cast<std::size_t>(place)] = -1;
  if (!has_uvs_) mesh.uvs.clear();
  return mesh;
}

void MeshBuilder::add_triangle(const tinyobj::mesh_t& from, std::size_t face, layers::Mesh& mesh) {
  Corner corners[3];
  bool own = true;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = corner_of(from, face, k, mesh);
    own &= corners[k].normal_is_own;
    mesh.indices.push_back(corners[k].vertex);
  }
  if (own) turn_last_to_normals(mesh);
}

bool MeshBuilder::has_own_normal(const tinyobj::index_t& corner, vec3& normal) const {
  const auto& n = content_.attributes.normals;
  const std::size_t at = 3 * static_cast<std::size_t>(std::max(corner.normal_index, 0));
  if (corner.normal_index < 0 || at + 2 >= n.size()) return false;
  const dvec3 given(n[at], n[at + 1], n[at + 2]);
  const double length = glm::length(given);
  if (!(length > 1e-12 && std::isfinite(length))) return false;
  normal = vec3(given / length);
  return true;
}

MeshBuilder::Corner MeshBuilder::corner_of(const tinyobj::mesh_t& from, std::size_t face, std::size_t k,
                                           layers::Mesh& mesh) {
  const tinyobj::index_t& corner = from.indices[3 * face + k];
  const auto place = static_cast<std::size_t>(corner.vertex_index);
  vec3 normal;
  const bool own = has_own_normal(corner, normal);
  if (!own) {
    const auto count = static_cast<int>(content_.attributes.normals.size() / 3);
    absent_normals_ += corner.normal_index >= count ? 1 : 0;
    if (!smooth_) smooth_.emplace(content_);
    normal = smooth_->at(from, face, k);
  }
  for (int at = first_[place]; at >= 0; at = known_[static_cast<std::size_t>(at)].next) {
    const Known& known = known_[static_cast<std::size_t>(at)];
    if (known.uv == corner.texcoord_index && known.normal == normal) return {known.vertex, own};
  }
  if (first_[place] < 0) used_.push_back(corner.vertex_index);
  const auto number = static_cast<std::uint32_t>(mesh.positions.size());
  known_.push_back({corner.texcoord_index, normal, number, first_[place]});
  first_[place] = static_cast<int>(known_.size()) - 1;
  add_vertex(corner, normal, mesh);
  return {number, own};
}

void MeshBuilder::add_coordinates(const tinyobj::index_t& corner, layers::Mesh& mesh) {
  const auto& uv = content_.attributes.texcoords;
  const std::size_t at = 2 * static_cast<std::size_t>(std::max(corner.texcoord_index, 0));
  const bool has_uv = corner.texcoord_index >= 0 && at + 1 < uv.size();
  absent_uvs_ += corner.texcoord_index >= 0 && !has_uv ? 1 : 0;
  has_uvs_ |= has_uv;
  layers::dvec2 placed(0);
  if (has_uv)
    placed =
        layers::dvec2(uv[at], uv[at + 1]) * layers::dvec2(placing_.scale) + layers::dvec2(placing_.offset);
  constexpr double kSlack = 1e-3;
  for (int k = 0; placing_.clamped && has_uv && k < 2; ++k)
    beside_ |= placed[k] < -kSlack || placed[k] > 1 + kSlack;
  mesh.uvs.emplace_back(placed.x, has_uv ? 1 - placed.y : 0);
}

void MeshBuilder::add_vertex(const tinyobj::index_t& corner, const vec3& normal, layers::Mesh& mesh) {
  mesh.positions.emplace_back(place_of(content_.attributes, corner.vertex_index) - origin_);
  mesh.normals.push_back(normal);
  add_coordinates(corner, mesh);
  add_color(static_cast<std::size_t>(corner.vertex_index), mesh);
}

void MeshBuilder::add_color(std::size_t place, layers::Mesh& mesh) const {
  const auto& c = content_.attributes.colors;
  if (content_.has_color.empty() || 3 * place + 2 >= c.size()) return;
  mesh.colors.push_back(uncolored_);
  if (!content_.has_color[place]) return;
  for (std::size_t k = 0; k < 3; ++k)
    mesh.colors.back()[static_cast<int>(k)] =
        linear_from_srgb(static_cast<float>(std::max(0.0, c[3 * place + k])));
}

std::vector<std::string> MeshBuilder::losses() const {
  std::vector<std::string> losses;
  const std::string rule = " that the file has not (it has ";
  const auto& attributes = content_.attributes;
  if (absent_uvs_ > 0)
    losses.push_back("faces name texture coordinates" + rule +
                     std::to_string(attributes.texcoords.size() / 2) + "); they are taken for 0 0");
  if (absent_normals_ > 0)
    losses.push_back("faces name normals" + rule + std::to_string(attributes.normals.size() / 3) +
                     "); those of their triangles are taken");
  if (beside_) losses.emplace_back("beside a picture with -clamp on its edge goes on, not the plain colour");
  return losses;
}

}  // namespace talisman::sequences
