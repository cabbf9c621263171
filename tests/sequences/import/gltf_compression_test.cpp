// SPDX-License-Identifier: Apache-2.0
// Compressed glTF: files made by the encoders of the libraries that the reader decodes with.
#include <cmath>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::Gltf;
using tests::Json;

using Bytes = std::vector<std::uint8_t>;

layers::Mesh first_mesh(const Gltf& file) {
  const ImportedModel model = file.import();
  EXPECT_THAT(model.warnings, ElementsAre());
  return model.scene.meshes.at(model.scene.parts.at(0).mesh);
}

// --- EXT_meshopt_compression

template <typename T>
Bytes encoded_vertices(const std::vector<T>& values, std::size_t stride) {
  const std::size_t count = values.size() * sizeof(T) / stride;
  Bytes bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), count, stride));
  return bytes;
}

Bytes encoded_triangles(const std::vector<unsigned>& indices) {
  Bytes bytes(meshopt_encodeIndexBufferBound(indices.size(), 4));
  bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
  return bytes;
}

/// Accessor `index` gets its content from a compressed view, whose own buffer is not there.
void compress(Gltf& file, int index, const Bytes& encoded, std::size_t stride, std::size_t count,
              const std::string& mode, const std::string& filter = "NONE") {
  const int view = file.view(encoded);
  Json& json = file.json["bufferViews"][view];
  const Json meshopt = {{"buffer", 0},
                        {"byteOffset", json["byteOffset"]},
                        {"byteLength", encoded.size()},
                        {"byteStride", stride},
                        {"count", count},
                        {"mode", mode},
                        {"filter", filter}};
  json = {
      {"buffer", 1}, {"byteLength", stride * count}, {"extensions", {{"EXT_meshopt_compression", meshopt}}}};
  if (mode == "ATTRIBUTES") json["byteStride"] = stride;
  file.json["accessors"][index]["bufferView"] = view;
  file.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
}

const std::vector<float> kCorners = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};

Json& meshopt_of_last_view(Gltf& file) {
  return file.json["bufferViews"].back()["extensions"]["EXT_meshopt_compression"];
}

TEST(GltfMeshopt, AttributesAreTheEncodedOnes) {
  Gltf file;
  compress(file, 0, encoded_vertices(kCorners, 12), 12, 4, "ATTRIBUTES");
  EXPECT_THAT(first_mesh(file).positions, ElementsAre(layers::vec3(-1, -1, 0), layers::vec3(1, -1, 0),
                                                      layers::vec3(1, 1, 0), layers::vec3(-1, 1, 0)));
}

TEST(GltfMeshopt, TrianglesOfBothVersionsKeepTheirCorners) {
  for (const int version : {0, 1}) {
    meshopt_encodeIndexVersion(version);
    Gltf file;
    compress(file, 1, encoded_triangles({0, 1, 2, 0, 2, 3}), 2, 6, "TRIANGLES");
    // The codec may begin a triangle with another of its corners.
    const layers::Mesh mesh = first_mesh(file);
    ASSERT_EQ(mesh.indices.size(), 6u);
    for (std::size_t t = 0; t < 6; t += 3) {
      const auto& v = mesh.indices;
      const std::size_t least = v[t] < v[t + 1] ? (v[t] < v[t + 2] ? 0 : 2) : (v[t + 1] < v[t + 2] ? 1 : 2);
      EXPECT_EQ(v[t + least], 0u);
      EXPECT_EQ(v[t + (least + 1) % 3], t == 0 ? 1u : 2u);
      EXPECT_EQ(v[t + (least + 2) % 3], t == 0 ? 2u : 3u);
    }
  }
}

TEST(GltfMeshopt, IndexSequencesKeepTheirOrder) {
  const std::vector<unsigned> strip = {0, 1, 3, 2};
  Bytes bytes(meshopt_encodeIndexSequenceBound(strip.size(), 4));
  bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), strip.data(), strip.size()));
  Gltf file;
  file.primitive()["mode"] = 5;
  file.json["accessors"][1]["count"] = 4;
  file.json["accessors"][1]["componentType"] = 5125;
  compress(file, 1, bytes, 4, 4, "INDICES");
  EXPECT_THAT(first_mesh(file).indices, ElementsAre(0, 1, 3, 1, 2, 3));
}

TEST(GltfMeshopt, OctahedralFilterGivesUnitVectors) {
  const std::vector<float> normals = {0, 0, 1, 0, 0.6f, 0, 0.8f, 0, -1, 0, 0, 0, 0, -0.8f, -0.6f, 0};
  std::vector<std::int8_t> filtered(16);
  meshopt_encodeFilterOct(filtered.data(), 4, 4, 8, normals.data());
  Gltf file;
  const int accessor = file.add<std::int8_t>(std::vector<std::int8_t>(12, 0), 5120, "VEC3", true);
  file.primitive()["attributes"]["NORMAL"] = accessor;
  compress(file, accessor, encoded_vertices(filtered, 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
  const layers::Mesh mesh = first_mesh(file);
  ASSERT_EQ(mesh.normals.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(mesh.normals[i][k], normals[4 * i + static_cast<std::size_t>(k)], 0.02);
}

TEST(GltfMeshopt, ExponentialFilterGivesFloats) {
  std::vector<std::uint32_t> filtered(12);
  meshopt_encodeFilterExp(filtered.data(), 4, 12, 15, kCorners.data());
  Gltf file;
  compress(file, 0, encoded_vertices(filtered, 12), 12, 4, "ATTRIBUTES", "EXPONENTIAL");
  EXPECT_NEAR(first_mesh(file).positions[2].x, 1, 1e-3);
  EXPECT_NEAR(first_mesh(file).positions[0].y, -1, 1e-3);
}

TEST(GltfMeshopt, QuaternionFilterTurnsANode) {
  // Two keys: at rest, and half a turn about z. Components x, y, z, w.
  const std::vector<float> turns = {0, 0, 0, 1, 0, 0, 1, 0};
  std::vector<std::int16_t> filtered(8);
  meshopt_encodeFilterQuat(filtered.data(), 2, 8, 16, turns.data());
  Gltf file;
  const int times = file.add<float>({0, 1}, 5126, "SCALAR");
  const int values = file.add<std::int16_t>(std::vector<std::int16_t>(8, 0), 5122, "VEC4", true);
  compress(file, values, encoded_vertices(filtered, 8), 8, 2, "ATTRIBUTES", "QUATERNION");
  file.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", times}, {"output", values}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}})}}});
  const ImportedModel model = file.import();
  const auto corner = layers::world_positions(model.scene.at(0.999999), model.scene.parts.at(0)).at(0);
  EXPECT_NEAR(corner.x, 1, 1e-3);  // (-1, -1) after half a turn
  EXPECT_NEAR(corner.y, 1, 1e-3);
}

TEST(GltfMeshopt, LaterCodecVersionIsRefusedByItsNumber) {
  Gltf file;
  Bytes bytes = encoded_vertices(kCorners, 12);
  bytes[0] = 0xa1;
  compress(file, 0, bytes, 12, 4, "ATTRIBUTES");
  EXPECT_THAT(file.refusal(), HasSubstr("codec version 1 of ATTRIBUTES, rule: 0"));
}

TEST(GltfMeshopt, EveryTruncationIsRefused) {
  const Bytes whole = encoded_vertices(kCorners, 12);
  for (std::size_t size : {std::size_t{1}, whole.size() / 2, whole.size() - 1}) {
    Gltf file;
    compress(file, 0, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), 12, 4,
             "ATTRIBUTES");
    EXPECT_THAT(file.refusal(), HasSubstr("EXT_meshopt_compression: ")) << size;
    EXPECT_THAT(file.refusal(), HasSubstr("damaged")) << size;
  }
}

TEST(GltfMeshopt, WhatTheDecoderTakesForGrantedIsChecked) {
  const std::vector<std::pair<Json, std::string>> wrong = {
      {{{"byteStride", 6}}, "stride 6 of ATTRIBUTES"},
      {{{"byteStride", 260}}, "stride 260 of ATTRIBUTES"},
      {{{"count", 5}}, "5 elements of 12 bytes"},
      {{{"mode", "TRIANGLES"}}, "stride 12 of TRIANGLES"},
      {{{"mode", "LINES"}}, "mode LINES"},
      {{{"filter", "QUATERNION"}}, "stride 12 with filter QUATERNION"},
      {{{"filter", "OCTAHEDRAL"}}, "stride 12 with filter OCTAHEDRAL"},
      {{{"filter", "COLOR"}}, "filter COLOR"}};
  for (const auto& [change, what] : wrong) {
    Gltf file;
    compress(file, 0, encoded_vertices(kCorners, 12), 12, 4, "ATTRIBUTES");
    meshopt_of_last_view(file).update(change);
    EXPECT_THAT(file.refusal(), HasSubstr(what));
  }
}

// --- KHR_draco_mesh_compression

struct Encoded {
  Bytes bytes;
  int position_id = 0, uv_id = 0;
};

/// The square of the builder, with coordinates (0, 0) … (1, 1).
Encoded draco_square() {
  const float corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const float uvs[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  for (int t = 0; t < 2; ++t) {
    const draco::FaceIndex face(static_cast<std::uint32_t>(t));
    const int* v = triangles[t];
    builder.SetAttributeValuesForFace(position, face, corners[v[0]], corners[v[1]], corners[v[2]]);
    builder.SetAttributeValuesForFace(uv, face, uvs[v[0]], uvs[v[1]], uvs[v[2]]);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {Bytes(buffer.data(), buffer.data() + buffer.size()),
          static_cast<int>(mesh->attribute(position)->unique_id()),
          static_cast<int>(mesh->attribute(uv)->unique_id())};
}

/// A file whose one primitive is compressed, as encoders write it: accessors without views.
Gltf draco_file(const Encoded& square, const Bytes& bytes) {
  Gltf file;
  file.json["accessors"] = Json::array({{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                                        {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}},
                                        {{"componentType", 5126}, {"count", 4}, {"type", "VEC2"}}});
  const int view = file.view(bytes);
  Json& primitive = file.primitive();
  primitive = {{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}}, {"indices", 1}, {"material", 0}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", square.position_id}, {"TEXCOORD_0", square.uv_id}}}};
  const std::string picture = "P6\n1 1\n255\nabc";
  file.json["images"] = Json::array(
      {{{"bufferView", file.view(Bytes(picture.begin(), picture.end()))}, {"mimeType", "image/x-ppm"}}});
  file.json["textures"] = Json::array({{{"source", 0}}});
  file.json["materials"] = Json::array(
      {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}}});
  file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

TEST(GltfDraco, AttributesAndTrianglesAreTheEncodedOnes) {
  const Encoded square = draco_square();
  const layers::Mesh mesh = first_mesh(draco_file(square, square.bytes));
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.uvs.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {  // whatever their order: u, v = (p + 1) / 2
    EXPECT_NEAR(mesh.uvs[i].x, (mesh.positions[i].x + 1) / 2, 1e-6);
    EXPECT_NEAR(mesh.uvs[i].y, (mesh.positions[i].y + 1) / 2, 1e-6);
  }
  double area = 0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const layers::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                       c = mesh.positions[mesh.indices[t + 2]];
    area += 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  EXPECT_NEAR(area, 4, 1e-6);  // both triangles, both counter-clockwise
}

TEST(GltfDraco, DamageIsRefusedAndCrashesNothing) {
  const Encoded square = draco_square();
  for (std::size_t size = 0; size < square.bytes.size(); size += 5) {
    const Bytes cut(square.bytes.begin(), square.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THAT(draco_file(square, cut).refusal(), HasSubstr("KHR_draco_mesh_compression: ")) << size;
  }
  for (std::size_t at = 0; at < square.bytes.size(); at += 7) {
    Bytes changed = square.bytes;
    changed[at] ^= 0xff;
    EXPECT_THAT(draco_file(square, changed).refusal(), ::testing::Not(HasSubstr("crashed"))) << at;
  }
}

TEST(GltfDraco, AttributeThatIsNotThereIsRefused) {
  Encoded square = draco_square();
  square.uv_id = 77;
  EXPECT_THAT(draco_file(square, square.bytes).refusal(), HasSubstr("TEXCOORD_0 names an attribute"));
}

TEST(GltfDraco, CountsMustBeThoseOfTheAccessors) {
  const Encoded square = draco_square();
  Gltf file = draco_file(square, square.bytes);
  file.json["accessors"][0]["count"] = 5;
  EXPECT_THAT(file.refusal(), HasSubstr("an attribute has 4 elements, rule: as its accessor says, 5"));
}

}  // namespace
}  // namespace talisman::sequences
