// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/starter/starter.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/regulator_keys.h"
#include "sequences/content/sequence_file.h"
#include "sequences/content/starter/part_globs.h"
#include "sequences/content/starter/yaml_page.h"
#include "sequences/content/yaml_reader.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// --- Scalars

TEST(YamlText, ReadsBackAsItWas) {
  for (const std::string text : {"arm", "arm/left-1.2", "arm: left",      "true", "No",
                                 "12",  "1e3",          "0x10",           ".inf", "~",
                                 "",    "a\"b\\c",      "tab\tand\nline", "käse", "#1",
                                 "- a", "[x]",          "*all",           "&a",   " led by a blank",
                                 "a #b"}) {
    if (text.empty()) continue;  // no key takes it
    const YamlMap map = read_yaml_text("a: " + yaml_text(text) + "\n", "t.yaml");
    EXPECT_EQ(map.find("a")->text(), text);
  }
}

TEST(YamlText, BytesThatAreNoUtf8AreQuestionMarks) { EXPECT_EQ(yaml_text("b\xf6se"), "\"b?se\""); }

TEST(YamlNumber, ReadsBackToTheSameBits) {
  for (const double value : {0.1, 1.0 / 3, 1e-20, 6.02e8, -0.0, 4.9e-324, 24.0}) {
    const YamlMap map = read_yaml_text("a: " + yaml_number(value) + "\n", "t.yaml");
    EXPECT_EQ(map.find("a")->number(), value);
  }
  EXPECT_EQ(yaml_number(0.28f), "0.28");
  EXPECT_EQ(yaml_number(24.0), "24");
}

// --- Globs

std::vector<layers::Layer> layers_of(const std::vector<std::vector<int>>& parts) {
  std::vector<layers::Layer> layers;
  for (const std::vector<int>& list : parts) {
    layers.emplace_back();
    layers.back().parts = list;
  }
  return layers;
}

TEST(PartGlobs, NameTheWholeOfAModelByItsBeginning) {
  EXPECT_THAT(part_globs(layers_of({{0, 1, 2}}), {"m/a", "m/b", "m/b#1"}), ElementsAre(ElementsAre("m/*")));
}

TEST(PartGlobs, SeveralPartsWithABeginningOfTheirOwnAreOneGlob) {
  EXPECT_THAT(part_globs(layers_of({{0, 1}, {2, 3}}), {"m/arm/up", "m/arm/low", "m/leg/up", "m/leg/low"}),
              ElementsAre(ElementsAre("m/arm/*"), ElementsAre("m/*")));
}

// "m/arm*" would take the armour, which is another layer's: there is no shorter way than the names.
TEST(PartGlobs, BeginningsThatOthersShareAreNotTaken) {
  EXPECT_THAT(part_globs(layers_of({{0, 2}, {1}}), {"m/arm", "m/armour", "m/arm#1"}),
              ElementsAre(ElementsAre("m/arm", "m/arm#1"), ElementsAre("m/armour")));
}

TEST(PartGlobs, StarsInNamesAreNoWildcards) {
  EXPECT_THAT(part_globs(layers_of({{0}}), {"m/a*b", "m/axxb"}), ElementsAre(ElementsAre("m/a\\*b")));
}

// --- The file

/// Every key of the tables below `keys`, but for those of maps that are met once already.
void for_each_key(const MapKeys& keys, const std::function<void(const std::string&)>& see) {
  for (const KeyRow& row : keys.rows) see(row.key);
  for (const Branch& branch : keys.branches) for_each_key(branch.keys, see);
}

TEST(Starter, NamesEveryKeyOfTheSequenceAndOfWhatDecides) {
  const TemporaryFolder folder;
  const std::string yaml = starter_sequence(folder.write("t.obj", kTriangle)).yaml;
  for (const MapKeys* keys : {&sequence_keys().keys(), &regulator_keys().keys()})
    for_each_key(*keys, [&](const std::string& key) { EXPECT_THAT(yaml, HasSubstr(key + ":")); });
}

TEST(Starter, EveryDefaultThatItSaysIsTheDefault) {
  const TemporaryFolder folder;
  const std::string model = folder.write("t.obj", kTriangle);
  const SequenceFile read = read_sequence_file(folder.write("s.yaml", starter_sequence(model).yaml));
  const Sequence usual;
  EXPECT_EQ(read.settings.regulator, regulator::RegulatorOptions());
  EXPECT_EQ(read.settings.display_px, usual.display_px);
  EXPECT_EQ(read.settings.warp, usual.warp);
  EXPECT_EQ(read.settings.bound, usual.bound);
  EXPECT_EQ(read.settings.cycles, usual.cycles);
  EXPECT_EQ(read.settings.compositor, usual.compositor);
  EXPECT_EQ(read.settings.material_points, usual.material_points);
  EXPECT_EQ(read.settings.extents.expected_reuse_frames, usual.extents.expected_reuse_frames);
  EXPECT_EQ(read.settings.extents.max_growth, usual.extents.max_growth);
  EXPECT_EQ(read.settings.placement.slab_directions, usual.placement.slab_directions);
  EXPECT_EQ(read.settings.placement.max_sprite_px, usual.placement.max_sprite_px);
  EXPECT_FALSE(read.settings.compression.has_value());
}

// What stands behind a # and has a value is right, too: without the # it is read.
TEST(Starter, KeysOfTheFirstLayerAreReadWithoutTheirSign) {
  const TemporaryFolder folder;
  std::string yaml = starter_sequence(folder.write("t.obj", kTriangle)).yaml;
  for (const std::string key : {"group: normal", "casts_shadows: true"}) {
    const std::size_t at = yaml.find("    # " + key);
    ASSERT_NE(at, std::string::npos) << key;
    yaml.replace(at, 6, "    ");
  }
  const SequenceFile read = read_sequence_file(folder.write("s.yaml", yaml));
  EXPECT_EQ(read.layers.front().spec.group, layers::OrderGroup::Normal);
}

// --- What the file can say of a model's own cameras and lights

TEST(ModelLights, FallOffWithTheScaleOfTheModel) {
  const TemporaryFolder folder;
  // A point light 1 m above a square of 2 m; a tenth as large, 0.1 m above it, the light on it is the same.
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":10,"range":4}]}},
"nodes":[{"name":"lamp","translation":[0,1,0],"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
  folder.write("lamp.gltf", gltf);
  const auto light = [&](const std::string& scale) {
    const Sequence sequence = load_sequence(folder.write(
        "s.yaml", "frames: 1\nmodels: [{id: a, file: lamp.gltf, lights: true, scale: " + scale + "}]\n"));
    EXPECT_EQ(sequence.scene->lights.size(), 1u);
    return sequence.scene->lights.front();
  };
  const layers::Light whole = light("1"), tenth = light("0.1");
  const auto left = [](const layers::Light& l, double d) {
    return std::fmax(0, 1 - std::pow(d / l.range_m, 4)) /
           (l.attenuation.x + l.attenuation.y * d + l.attenuation.z * d * d);
  };
  EXPECT_EQ(tenth.color, whole.color);
  EXPECT_NEAR(left(tenth, 0.1), left(whole, 1), 1e-12);
  EXPECT_NEAR(left(tenth, 0.3), left(whole, 3), 1e-12);
}

TEST(ModelCamera, IsFoundByModelAndNameOrRefusedWithWhatThereIs) {
  const TemporaryFolder folder;
  folder.write("t.obj", kTriangle);
  const auto message = [&](const std::string& camera) {
    const std::string file =
        folder.write("s.yaml", "frames: 1\nmodels: [{id: ship, file: t.obj}]\ncamera: {" + camera + "}\n");
    return tests::message_of([&] { load_sequence(file); });
  };
  EXPECT_THAT(message("model: shp"), HasSubstr("s.yaml:3: camera is of model 'shp'"));
  EXPECT_THAT(message("model: ship, fov_deg: 20"), HasSubstr("fov_deg"));
  EXPECT_THAT(message("named: x"), HasSubstr("model"));
  EXPECT_THAT(message("orbit: {distance_m: 2}, position: [0, 0, 1]"), HasSubstr("position"));
}

TEST(OrbitOfASequence, GoesRoundItsCentreInTheSecondsOfTurntable) {
  const TemporaryFolder folder;
  const Sequence sequence = load_sequence(
      folder.write("s.yaml",
                   "frames: 1\nturntable: 8\nshapes: [{id: a, box: [1, 1, 1]}]\n"
                   "camera: {orbit: {center: [1, 2, 3], distance_m: 10, elevation_deg: 30}}\n"));
  // 10 sin 30° = 5 above the centre, 10 cos 30° beside it: towards +z first, towards +x after a quarter turn.
  const auto at = [&](double t) { return layers::dvec3(sequence.scene->at(t).camera.world_from_camera[3]); };
  const double beside = 10 * std::cos(M_PI / 6);
  EXPECT_NEAR(glm::distance(at(0), layers::dvec3(1, 7, 3 + beside)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(at(2), layers::dvec3(1 + beside, 7, 3)), 0, 1e-12);
}

}  // namespace
}  // namespace talisman::sequences
