// SPDX-License-Identifier: Apache-2.0
// OBJ files of others: what our reader makes of them against what assimp does, where they are fetched
// (sequences/fetch-assets models).
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <glm/geometric.hpp>

#include "sequences/import/model_import.h"

namespace talisman::sequences {
namespace {

using Place = std::array<float, 3>;

/// What a material covers.
struct Covered {
  int triangles = 0;  ///< with an area
  double area = 0;
  std::set<Place> places;
  layers::dvec3 sum() const {
    layers::dvec3 total(0);
    for (const Place& p : places) total += layers::dvec3(p[0], p[1], p[2]);
    return total;
  }
  void add(const layers::dvec3 (&p)[3]) {
    const double doubled = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    if (!(doubled > 0)) return;
    ++triangles;
    area += doubled / 2;
    for (const layers::dvec3& q : p)
      places.insert({static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
  }
};
using ByMaterial = std::map<std::string, Covered>;

ByMaterial of_ours(const layers::Scene& scene) {
  ByMaterial result;
  for (const layers::Part& part : scene.parts) {
    const layers::Mesh& mesh = scene.meshes[static_cast<std::size_t>(part.mesh)];
    Covered& covered = result[scene.materials[static_cast<std::size_t>(part.material)].name];
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
      layers::dvec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[t + k]];
      covered.add(p);
    }
  }
  return result;
}

ByMaterial of_assimp(const aiScene& scene) {
  ByMaterial result;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    Covered& covered = result[scene.mMaterials[mesh.mMaterialIndex]->GetName().C_Str()];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices != 3) continue;
      layers::dvec3 p[3];
      for (int k = 0; k < 3; ++k) {
        const aiVector3D& v = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
        p[k] = {v.x, v.y, v.z};
      }
      covered.add(p);
    }
  }
  std::erase_if(result, [](const auto& entry) { return entry.second.triangles == 0; });
  return result;
}

/// Of a material that no library has, assimp makes another default than ours: then all of the file together.
ByMaterial merged(const ByMaterial& by_material) {
  Covered all;
  for (const auto& [material, covered] : by_material) {
    all.triangles += covered.triangles;
    all.area += covered.area;
    all.places.insert(covered.places.begin(), covered.places.end());
  }
  return {{"all", all}};
}

bool have_same_names(const ByMaterial& a, const ByMaterial& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return x.first == y.first; });
}

/// A polygon that goes 234 times around its square.
bool is_no_simple_polygon(const std::string& file) {
  return std::filesystem::path(file).filename() == "box_longline.obj";
}

std::vector<std::string> obj_files() {
  const char* given = std::getenv("TALISMAN_ASSETS");
  const std::filesystem::path assets = given ? given : TALISMAN_SOURCE_DIR "/assets";
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(assets / "assimp-testmodels", none))
    if (entry.path().extension() == ".obj") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

void compare(const std::string& file, const ByMaterial& ours, const ByMaterial& theirs) {
  SCOPED_TRACE(file);
  EXPECT_EQ(ours.size(), theirs.size());
  for (const auto& [material, expected] : theirs) {
    SCOPED_TRACE(material);
    const auto found = ours.find(material);
    if (found == ours.end()) {
      ADD_FAILURE() << "no triangle of ours has this material";
      continue;
    }
    EXPECT_EQ(found->second.triangles, expected.triangles);
    EXPECT_NEAR(found->second.area, expected.area, 1e-4 * expected.area);
    EXPECT_EQ(found->second.places.size(), expected.places.size());
    for (int k = 0; k < 3; ++k)  // the readers round the last bit of a number differently
      EXPECT_NEAR(found->second.sum()[k], expected.sum()[k], 1e-4 * (1 + std::abs(expected.sum()[k])));
  }
}

TEST(ReadObj, AgreesWithAssimpOnItsTestModels) {
  const std::vector<std::string> files = obj_files();
  if (files.empty()) GTEST_SKIP() << "sequences/fetch-assets models";
  int compared = 0;
  for (const std::string& file : files) {
    Assimp::Importer importer;
    const aiScene* theirs = importer.ReadFile(file, aiProcess_Triangulate | aiProcess_SortByPType);
    std::string refusal;
    ImportedModel ours;
    try {
      ours = import_model(file);
    } catch (const InputError& error) {
      refusal = error.what();
    }
    const ByMaterial expected = theirs ? of_assimp(*theirs) : ByMaterial{};
    EXPECT_TRUE(refusal.empty() || expected.empty()) << file << ": " << refusal;
    if (!refusal.empty() || expected.empty() || is_no_simple_polygon(file)) continue;
    const ByMaterial found = of_ours(ours.scene);
    if (have_same_names(found, expected))
      compare(file, found, expected);
    else
      compare(file, merged(found), merged(expected));
    ++compared;
  }
  EXPECT_GE(compared, 15);
}

}  // namespace
}  // namespace talisman::sequences
