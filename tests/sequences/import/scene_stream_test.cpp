// SPDX-License-Identifier: Apache-2.0
// The stream between the importer and the tool. Its reader meets whatever a crashing or captured child may
// send, so no input may do more than throw InputError.
#include <algorithm>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/import/scene_stream.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::message_of;

/// Every kind of content at least once: skin, textures, all three kinds of tracks, lights, cameras.
ImportedModel full_model() {
  ImportedModel model;
  model.scene = tests::skinned_bar_scene();
  model.scene.textures.push_back(tests::checker_texture(2, 1));
  model.scene.materials[0].texture = static_cast<int>(model.scene.textures.size()) - 1;
  layers::FlightTrack flight;
  flight.position.times_s = {0, 1};
  flight.position.values = {{0, 0, 0}, {1, 2, 3}};
  flight.bank_rad = {{0.5}, {0.25}, layers::Interpolation::Step};
  model.scene.nodes.push_back({"flier", -1, {}});
  model.scene.nodes.push_back({"top", -1, {}});
  const int last = static_cast<int>(model.scene.nodes.size()) - 1;
  model.scene.tracks.push_back({last - 1, flight});
  model.scene.tracks.push_back({last, layers::SpinTrack{{1, 0, 0}, 2}});
  layers::Mesh& mesh = model.scene.meshes[0];
  mesh.colors.assign(mesh.positions.size(), layers::vec3(0.5f));
  mesh.alphas.assign(mesh.positions.size(), 0.25f);
  mesh.emissive_uvs.assign(mesh.positions.size(), layers::vec2(2, 3));
  mesh.morphs.push_back({std::vector<layers::vec3>(mesh.positions.size(), layers::vec3(1, 2, 3)), {}});
  model.scene.nodes.back().morph_weights = {0.75};
  layers::MorphTrack morph;
  morph.weights = {{{0, 1}, {0, 1}, layers::Interpolation::CubicSpline, {0, 2}, {3, 0}}};
  morph.loop_end_s = 5;
  model.scene.tracks.insert(model.scene.tracks.begin(), {last, morph});
  model.scene.materials[0].emissive_texture = 0;
  model.scene.materials[0].alpha_cutoff = 0.5f;
  model.scene.textures[0].wrap_u = layers::Wrap::Clamp;
  model.scene.textures[0].wrap_v = layers::Wrap::Mirror;
  model.scene.textures[0].nearest = true;
  model.scene.textures[0].one_level = true;
  model.scene.lights[1].attenuation = {1, 2, 3};
  model.scene.lights[1].range_m = 4;
  model.warnings = {"one warning", ""};
  model.notes = {"a note"};
  model.layer_tags = {{last, "hull"}};
  model.files = {{FileUse::Kind::Content, "ship.obj", 12, 34, true},
                 {FileUse::Kind::Names, "/tmp", 0, 5, false}};
  return model;
}

/// True if reading ended in an orderly way. Anything but InputError fails the test by leaving it.
bool reads(const std::vector<std::uint8_t>& bytes) {
  try {
    model_from_bytes(bytes);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(SceneStream, ComesBackWithTheSameBytes) {
  const ImportedModel model = full_model();
  ASSERT_EQ(layers::first_defect(model.scene), "");
  const auto bytes = bytes_from_model(model);
  const ImportedModel back = model_from_bytes(bytes);
  EXPECT_EQ(bytes_from_model(back), bytes);
  EXPECT_EQ(back.warnings, model.warnings);
  ASSERT_EQ(back.layer_tags.size(), 1u);
  EXPECT_EQ(back.layer_tags[0].layer, "hull");
}

TEST(SceneStream, FieldsArriveWhereTheyBelong) {
  // Equal bytes on both ways would also hold if two fields of one type were swapped in both; so some are
  // looked at.
  const layers::Scene scene = full_model().scene;
  const layers::Scene back = scene_from_bytes(bytes_from_scene(scene));
  EXPECT_EQ(back.meshes[0].weights, scene.meshes[0].weights);
  EXPECT_EQ(back.meshes[0].normals, scene.meshes[0].normals);
  EXPECT_EQ(back.materials[0].base_color, scene.materials[0].base_color);
  EXPECT_EQ(back.materials[0].specular, scene.materials[0].specular);
  EXPECT_EQ(back.cameras[0].near_m, scene.cameras[0].near_m);
  EXPECT_EQ(back.cameras[0].far_m, scene.cameras[0].far_m);
  EXPECT_EQ(back.lights[1].direction, scene.lights[1].direction);
  EXPECT_EQ(back.lights[1].attenuation, layers::dvec3(1, 2, 3));
  EXPECT_EQ(back.lights[1].range_m, 4);
  EXPECT_EQ(back.meshes[0].emissive_uvs[0], layers::vec2(2, 3));
  EXPECT_EQ(back.meshes[0].alphas[0], 0.25f);
  EXPECT_EQ(back.meshes[0].morphs[0].positions[0], layers::vec3(1, 2, 3));
  EXPECT_EQ(back.materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(back.textures[0].wrap_u, layers::Wrap::Clamp);
  EXPECT_EQ(back.textures[0].wrap_v, layers::Wrap::Mirror);
  EXPECT_TRUE(back.textures[0].nearest);
  EXPECT_FALSE(back.textures[0].nearest_minified);
  EXPECT_FALSE(back.textures[0].finest);
  EXPECT_TRUE(back.textures[0].one_level);
  const auto& morph = std::get<layers::MorphTrack>(back.tracks[0].motion);
  EXPECT_EQ(morph.weights[0].in_tangents, (std::vector<double>{0, 2}));
  EXPECT_EQ(morph.weights[0].out_tangents, (std::vector<double>{3, 0}));
  EXPECT_EQ(morph.loop_end_s, 5);
  const auto& flight = std::get<layers::FlightTrack>(back.tracks[back.tracks.size() - 2].motion);
  EXPECT_EQ(flight.bank_rad.interpolation, layers::Interpolation::Step);
  EXPECT_EQ(flight.position.values[1], layers::dvec3(1, 2, 3));
  EXPECT_EQ(back.duration_s(), scene.duration_s());
}

TEST(SceneStream, EmptySceneIsAScene) { EXPECT_TRUE(scene_from_bytes(bytes_from_scene({})).parts.empty()); }

TEST(SceneStream, EveryTruncationIsRefused) {
  // Each length field, each array and each string is cut in its middle once, for the stream is short enough
  // to try every end.
  const auto bytes = bytes_from_model(full_model());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    ASSERT_FALSE(reads({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)})) << "cut at " << n;
  ASSERT_TRUE(reads(bytes));
}

TEST(SceneStream, BytesTooManyAreRefused) {
  auto bytes = bytes_from_scene(tests::cube_scene());
  bytes.push_back(0);
  EXPECT_THAT(message_of([&] { scene_from_bytes(bytes); }), HasSubstr("1 bytes too many"));
}

TEST(SceneStream, ForeignBytesAndOtherVersionsAreRefused) {
  auto bytes = bytes_from_scene({});
  bytes[4] ^= 1;
  EXPECT_THAT(message_of([&] { scene_from_bytes(bytes); }), HasSubstr("version 4, rule: 5"));
  bytes[0] ^= 1;
  EXPECT_THAT(message_of([&] { scene_from_bytes(bytes); }), HasSubstr("magic"));
}

TEST(SceneStream, FalseLengthsAreNotBelieved) {
  // 2⁶⁴ − 1 and a length whose product with the item size overflows to a small number: neither may be
  // allocated.
  for (const std::uint64_t length :
       {~std::uint64_t{0}, (~std::uint64_t{0} / 12) + 2, std::uint64_t{1} << 40}) {
    auto bytes = bytes_from_scene({});
    std::memcpy(&bytes[8], &length, sizeof length);  // of the list of meshes
    EXPECT_THAT(message_of([&] { scene_from_bytes(bytes); }), HasSubstr("length")) << length;
  }
}

TEST(SceneStream, IndicesAreCheckedAgain) {
  layers::Scene scene = tests::cube_scene();
  scene.meshes[0].indices[5] = 4'000'000'000u;
  EXPECT_THAT(message_of([&] { scene_from_bytes(bytes_from_scene(scene)); }), HasSubstr("index 4000000000"));
  ImportedModel model = full_model();
  model.layer_tags[0].node = 999;
  EXPECT_THAT(message_of([&] { model_from_bytes(bytes_from_model(model)); }), HasSubstr("node 999"));
}

TEST(SceneStream, NotANumberIsRefused) {
  layers::Scene scene = tests::cube_scene();
  scene.meshes[0].positions[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of([&] { scene_from_bytes(bytes_from_scene(scene)); }), HasSubstr("position 3"));
}

TEST(SceneStream, RandomDamageNeverDoesMoreThanThrow) {
  const auto bytes = bytes_from_model(full_model());
  const unsigned seed = 20240817;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  int refused = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    auto damaged = bytes;
    const int flips = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < flips; ++k) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    refused += reads(damaged) ? 0 : 1;
  }
  // Most bytes are numbers that may have any value; but lengths, indices and choices are hit often enough to
  // be noticed.
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace talisman::sequences
