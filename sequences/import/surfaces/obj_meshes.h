// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which meshes do the faces of an OBJ make, one for each material of a shape?
///
/// Every combination of place, coordinates and normal is one vertex. Where a corner has no normal, or one without a
/// length, it gets the mean of the triangles around its place (obj_scene.h). A triangle that is wound against the normals
/// of all its corners is turned over: the normals say which side is the outside.

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include "layers/scene.h"
#include "sequences/import/surfaces/obj_materials.h"

namespace talisman::sequences {

struct ObjContent {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;  ///< of triangles
  bool has_groups = false;               ///< it says what is smooth: what is in no group is flat
  std::vector<bool> has_color;           ///< by vertex; empty: none has one
};

layers::dvec3 place_of(const tinyobj::attrib_t& attributes, int vertex);

/// Normals of what has none. Cost: O(triangles), 24 bytes per place.
class SmoothNormals {
 public:
  explicit SmoothNormals(const ObjContent& content);
  layers::vec3 at(const tinyobj::mesh_t& mesh, std::size_t face, std::size_t corner);

 private:
  layers::dvec3& sum_at(const tinyobj::mesh_t& mesh, std::size_t face, std::size_t corner);
  layers::dvec3 flat(const tinyobj::mesh_t& mesh, std::size_t face) const;

  const ObjContent& content_;
  std::vector<std::uint32_t> place_;
  std::vector<layers::dvec3> sums_;  ///< by place, of what has no group
  std::unordered_map<std::uint64_t, layers::dvec3> sums_of_groups_;
};

class MeshBuilder {
 public:
  MeshBuilder(const ObjContent& content, const layers::dvec3& origin);

  /// What of `from` has the material `id`, under coordinates as `placing` has them.
  layers::Mesh mesh_of(const tinyobj::mesh_t& from, int id, const MapPlacing& placing);

  /// Of all meshes so far: what the file names and has not, or what lies beside a clamped picture.
  std::vector<std::string> losses() const;

 private:
  struct Known {
    int uv = -1;
    layers::vec3 normal{0};
    std::uint32_t vertex = 0;
    int next = -1;
  };
  struct Corner {
    std::uint32_t vertex = 0;
    bool normal_is_own = false;  ///< the file's
  };

  bool has_own_normal(const tinyobj::index_t& corner, layers::vec3& normal) const;
  void add_triangle(const tinyobj::mesh_t& from, std::size_t face, layers::Mesh& mesh);
  Corner corner_of(const tinyobj::mesh_t& from, std::size_t face, std::size_t k, layers::Mesh& mesh);
  void add_vertex(const tinyobj::index_t& corner, const layers::vec3& normal, layers::Mesh& mesh);
  void add_coordinates(const tinyobj::index_t& corner, layers::Mesh& mesh);
  void add_color(std::size_t place, layers::Mesh& mesh) const;

  const ObjContent& content_;
  layers::dvec3 origin_;
  std::optional<SmoothNormals> smooth_;  ///< made when the first is asked for
  MapPlacing placing_;
  layers::vec3 uncolored_{1};  ///< the colour of vertices that have none, where others have
  std::vector<int> first_;     ///< by place: the last of its combinations; -1: none
  std::vector<Known> known_;
  std::vector<int> used_;
  bool has_uvs_ = false, beside_ = false;
  std::size_t absent_uvs_ = 0, absent_normals_ = 0;
};

}  // namespace talisman::sequences
