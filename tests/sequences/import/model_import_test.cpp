// SPDX-License-Identifier: Apache-2.0
// Models through the child process. The files are written here, so that the tests need no assets.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/import/model_import.h"
#include "tests/sequences/import/gltf_builder.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::base64;
using tests::message_of;
using tests::TemporaryFolder;

/// Two triangles with a material: a square of 2 units.
std::string square_obj(const std::string& head = "") {
  return head +
         "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "o square\nusemtl paint\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
}

/// 2 × 1 pixels: red, green (binary PPM).
std::string red_green_ppm() {
  return std::string("P6\n2 1\n255\n") + '\xff' + '\0' + '\0' + '\0' + '\xff' + '\0';
}

template <typename T>
void put(std::string& bytes, std::initializer_list<T> values) {
  for (const T& v : values) bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
}

/// A triangle on a node that moves from x = 0 to x = 10 in 2 s, below a node with extras.layer, with a
/// metallic material.
std::string moving_gltf() {
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});  // positions, 36 bytes
  put<float>(bytes, {0, 2});                       // times, 8 bytes
  put<float>(bytes, {0, 0, 0, 10, 0, 0});          // translations, 24 bytes
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"ship","children":[1],"extras":{"layer":"hull"}},{"name":"wing","mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"name":"gold","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,1],"metallicFactor":1,"roughnessFactor":0.5}}],
"animations":[{"samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},
{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},{"buffer":0,"byteOffset":44,"byteLength":24}],
"buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}]}";
}

TEST(ImportModel, ReadsTrianglesNormalsAndColours) {
  const TemporaryFolder folder;
  folder.write("square.mtl", "newmtl paint\nKd 0.5 0.25 1\nd 0.75\nKs 1 1 1\nNs 40\n");
  const ImportedModel model = import_model(folder.write("square.obj", square_obj("mtllib square.mtl\n")));
  ASSERT_EQ(model.scene.parts.size(), 1u);
  const layers::Mesh& mesh = model.scene.meshes[model.scene.parts[0].mesh];
  EXPECT_EQ(mesh.triangle_count(), 2);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_NEAR(mesh.normals[0].z, 1, 1e-6);
  const layers::Material& paint = model.scene.materials[model.scene.parts[0].material];
  EXPECT_NEAR(paint.base_color.x, 0.21404, 1e-4);  // 0.5 in sRGB
  EXPECT_NEAR(paint.base_color.z, 1, 1e-6);
  EXPECT_NEAR(paint.opacity, 0.75, 1e-6);
  EXPECT_NEAR(paint.shininess, 40, 1e-4);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(ImportModel, FindsTexturesUnderOtherNames) {
  // As written; other letter case; in ../textures; with the stem cut to 8 characters, as 3DS files have it;
  // by another extension.
  const std::vector<std::pair<std::string, std::string>> written_and_stored = {
      {"paint.ppm", "models/paint.ppm"},
      {"PAINT.PPM", "models/paint.ppm"},
      {"c:\\art\\Paint.ppm", "models/paint.ppm"},
      {"paint.ppm", "textures/Paint.PPM"},
      {"longname.ppm", "textures/longname_of_it.ppm"},
      {"paint.rgb", "textures/paint.ppm"}};
  for (const auto& [written, stored] : written_and_stored) {
    const TemporaryFolder folder;
    folder.write(stored, red_green_ppm());
    folder.write("models/square.mtl", "newmtl paint\nmap_Kd " + written + "\n");
    const ImportedModel model =
        import_model(folder.write("models/square.obj", square_obj("mtllib square.mtl\n")));
    EXPECT_THAT(model.warnings, IsEmpty()) << written;
    ASSERT_EQ(model.scene.textures.size(), 1u) << written << " should be found as " << stored;
    EXPECT_EQ(model.scene.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}));
  }
}

TEST(ImportModel, MissingTextureIsAWarningAndAPlainColour) {
  const TemporaryFolder folder;
  folder.write("square.mtl", "newmtl paint\nKd 1 0 0\nmap_Kd nowhere.png\n");
  const ImportedModel model = import_model(folder.write("square.obj", square_obj("mtllib square.mtl\n")));
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_THAT(model.warnings[0], HasSubstr("'nowhere.png': is missing"));
  EXPECT_EQ(model.scene.materials[model.scene.parts[0].material].texture, -1);
}

TEST(ImportModel, TextureCoordinatesGrowDownwards) {
  // OBJ has v upwards: the corner (-1, -1) with v = 0 must get v = 1 here.
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("square.obj", square_obj()));
  const layers::Mesh& mesh = model.scene.meshes[0];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_NEAR(mesh.uvs[i].y, mesh.positions[i].y < 0 ? 1 : 0, 1e-6);
}

/// The triangle of moving_gltf, lit by a spot on a node that is turned to shine along +x.
std::string spot_gltf(const std::string& spot) {
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","name":"lamp","color":[1,0.5,0.25],"intensity":1,"spot":)" +
         spot + R"(}]}},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"name":"leaf","mesh":0},{"name":"lamp","translation":[1,2,3],"rotation":[0,-0.70710678,0,0.70710678],
"extensions":{"KHR_lights_punctual":{"light":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}]}";
}

TEST(ImportModel, GltfSpotKeepsItsConeAndItsDirection) {
  const TemporaryFolder folder;
  const ImportedModel model =
      import_model(folder.write("spot.gltf", spot_gltf(R"({"innerConeAngle":0.2,"outerConeAngle":0.5})")));
  ASSERT_EQ(model.scene.lights.size(), 1u);
  const layers::Light& lamp = model.scene.lights[0];
  EXPECT_EQ(lamp.kind, layers::Light::Kind::Spot);
  EXPECT_NEAR(lamp.inner_cone_rad, 0.2, 1e-6);  // glTF measures from the axis, as we do
  EXPECT_NEAR(lamp.outer_cone_rad, 0.5, 1e-6);
  const layers::LightState now = model.scene.at(0).lights.at(0);
  EXPECT_NEAR(now.direction.x, 1, 1e-5);
  EXPECT_NEAR(now.position.y, 2, 1e-5);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(ImportModel, GltfSpotWithoutAnglesHasTheDefaultsOfTheFormat) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("spot.gltf", spot_gltf("{}")));
  ASSERT_EQ(model.scene.lights.size(), 1u);
  EXPECT_NEAR(model.scene.lights[0].inner_cone_rad, 0, 1e-6);
  EXPECT_NEAR(model.scene.lights[0].outer_cone_rad, std::acos(-1.0) / 4, 1e-6);
}

TEST(ImportModel, SpotConesOfAnyFileAreInRange) {
  // Wider than a half-space, no cone at all, less than none: what scenes do not allow.
  for (const char* spot :
       {R"({"innerConeAngle":0.1,"outerConeAngle":3})", R"({"innerConeAngle":0,"outerConeAngle":0})",
        R"({"innerConeAngle":-1,"outerConeAngle":0.3})"}) {
    const TemporaryFolder folder;
    const ImportedModel model = import_model(folder.write("spot.gltf", spot_gltf(spot)));
    ASSERT_EQ(model.scene.lights.size(), 1u) << spot;
    const layers::Light& lamp = model.scene.lights[0];
    EXPECT_LE(0, lamp.inner_cone_rad) << spot;
    EXPECT_LE(lamp.inner_cone_rad, lamp.outer_cone_rad) << spot;
    EXPECT_GT(lamp.outer_cone_rad, 0) << spot;
    EXPECT_LE(lamp.outer_cone_rad, std::acos(-1.0) / 2) << spot;
  }
}

TEST(ImportModel, SpotWhoseInnerConeIsTheWiderIsRefused) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("spot.gltf", spot_gltf(R"({"innerConeAngle":0.9,"outerConeAngle":0.3})"));
  EXPECT_THAT(message_of([&] { import_model(path); }), HasSubstr("spot.gltf: cannot be read as a model"));
}

TEST(ImportModel, ColladaSpotGivesTheWholeCone) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("spot.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_lights><light id="lamp" name="lamp"><technique_common><spot><color>1 1 1</color>
<falloff_angle>60</falloff_angle><falloff_exponent>2</falloff_exponent></spot></technique_common></light></library_lights>
<library_geometries><geometry id="leaf"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="leaf"><instance_geometry url="#leaf"/></node>
<node id="lamp" name="lamp"><instance_light url="#lamp"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)"));
  ASSERT_EQ(model.scene.lights.size(), 1u);
  EXPECT_EQ(model.scene.lights[0].kind, layers::Light::Kind::Spot);
  EXPECT_NEAR(model.scene.lights[0].inner_cone_rad, 30 * std::acos(-1.0) / 180, 1e-5);
  EXPECT_GT(model.scene.lights[0].outer_cone_rad, model.scene.lights[0].inner_cone_rad);
}

TEST(ImportModel, GltfBringsMotionLayerTagAndLinearColour) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("moving.gltf", moving_gltf()));
  EXPECT_NEAR(model.scene.duration_s(), 2, 1e-6);
  const layers::Part& part = model.scene.parts.at(0);
  EXPECT_NEAR(model.scene.at(1.0).world_from_node[part.node][3].x, 5, 1e-5);
  ASSERT_EQ(model.layer_tags.size(), 1u);
  EXPECT_EQ(model.layer_tags[0].layer, "hull");
  EXPECT_EQ(model.scene.nodes[model.layer_tags[0].node].name, "ship");
  const layers::Material& gold = model.scene.materials[part.material];
  EXPECT_NEAR(gold.base_color.x, 0.225, 1e-6);  // 0.5 not decoded from sRGB, of which a metal keeps 0.45
  EXPECT_TRUE(gold.two_sided);
  EXPECT_NEAR(gold.shininess, 30, 1e-3);       // 2 / 0.5⁴ − 2
  EXPECT_NEAR(gold.specular.x, 0.9375, 1e-6);  // base · 2.5 · (1 − 0.5²)
}

TEST(ImportModel, NotANumberPositionsNameTheMesh) {
  const TemporaryFolder folder;
  const std::string file = folder.write("bad.obj", "o sail\nv nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string message = message_of([&] { import_model(file); });
  EXPECT_THAT(message, HasSubstr(file));
  EXPECT_THAT(message, ::testing::AnyOf(HasSubstr("sail"), HasSubstr("mesh")));
}

TEST(ImportModel, WhatIsNoModelIsRefusedWithItsName) {
  const TemporaryFolder folder;
  const std::string points = folder.write("points.obj", "v 0 0 0\nv 1 0 0\n");
  for (const std::string& file :
       {folder.path() + "/missing.obj", folder.path(), folder.write("empty.obj", ""), points,
        folder.write("noise.3ds", std::string(300, '\x7f')),
        folder.write("half.gltf", moving_gltf().substr(0, 500)), folder.write("text.xyz", "hello")}) {
    const std::string message = message_of([&] { import_model(file); });
    EXPECT_THAT(message, HasSubstr(file)) << file << " was not refused";
  }
}

TEST(ImportModel, EveryTruncationOfAModelEndsInOrder) {
  // A truncated file may still be a model; but it never takes the tool down, and what comes is without
  // defects.
  const TemporaryFolder folder;
  const std::string whole = moving_gltf();
  int refused = 0;
  for (std::size_t n = 100; n < whole.size(); n += 160) {
    const std::string file = folder.write("cut.gltf", whole.substr(0, n));
    try {
      import_model(file);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ImportModel, MemoryOfTheReaderIsLimited) {
  // 20 MB of vertices cannot be read in 64 MB of address space, of which the libraries take more already.
  const TemporaryFolder folder;
  std::string obj;
  for (int i = 0; i < 400000; ++i) obj += "v " + std::to_string(i) + " 0 " + std::to_string(i % 7) + "\n";
  for (int i = 1; i < 399998; i += 3)
    obj.append("f ")
        .append(std::to_string(i))
        .append(" ")
        .append(std::to_string(i + 1))
        .append(" ")
        .append(std::to_string(i + 2))
        .append("\n");
  const std::string file = folder.write("big.obj", obj);
  EXPECT_THROW(import_model(file, {.seconds = 60, .megabytes = 64}), InputError);
}
#endif

TEST(ImportModel, MissingTextureIsNotReplacedByASimilarOne) {
  // Same first 8 letters, but a name of more than 8 is not one that DOS cut.
  const TemporaryFolder folder;
  folder.write("textures/texture_metal.ppm", red_green_ppm());
  folder.write("textures/wood.txt", "no picture");
  for (const char* written : {"texture_wood.ppm", "wood.ppm"}) {
    folder.write("square.mtl", std::string("newmtl paint\nmap_Kd ") + written + "\n");
    const ImportedModel model = import_model(folder.write("square.obj", square_obj("mtllib square.mtl\n")));
    ASSERT_EQ(model.warnings.size(), 1u) << written;
    EXPECT_THAT(model.warnings[0], HasSubstr("is missing"));
  }
}

TEST(ImportModel, VertexColoursOfObjAreSrgbAndAlone) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(
      folder.write("c.obj", "v 0 0 0 0.5 0.25 0\nv 1 0 0 0.5 0.25 0\nv 0 1 0 0.5 0.25 0\nf 1 2 3\n"));
  const layers::Part& part = model.scene.parts.at(0);
  EXPECT_NEAR(model.scene.meshes[part.mesh].colors.at(0).x, 0.21404, 1e-4);  // 0.5 in sRGB
  EXPECT_EQ(model.scene.materials[part.material].base_color, layers::vec3(1));
}

TEST(ImportModel, FarOriginKeepsSmallSizes) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write(
      "utm.obj", "v 500000.1 4600000.2 0\nv 500000.3 4600000.2 0\nv 500000.1 4600000.4 0\nf 1 2 3\n"));
  const auto world = layers::world_positions(model.scene.at(0), model.scene.parts.at(0));
  double wide = 0;
  for (const layers::dvec3& p : world) wide = std::max(wide, p.x);
  EXPECT_NEAR(wide, 500000.3, 1e-6);  // a float at 5e5 resolves 0.03
}

TEST(LoadModel, BareModelIsFramedAtAnyUnit) {
  for (const double unit : {1e-4, 1.0, 1e6}) {
    SCOPED_TRACE(unit);
    const TemporaryFolder folder;
    std::ostringstream obj;
    obj << "v " << 3 * unit << " 0 0\nv " << 4 * unit << " 0 0\nv " << 3 * unit << " " << unit
        << " 0\nf 1 2 3\n";
    const Sequence sequence = load_sequence(folder.write("thing.obj", obj.str()));
    EXPECT_EQ(sequence.name, "thing");
    ASSERT_EQ(sequence.layers.layers.size(), 3u);  // the ground and its shadow
    EXPECT_EQ(layers::first_defect(*sequence.scene), "");
    double widest = 0;
    for (int f = 0; f < sequence.frames; f += 10) {
      const layers::SceneFrame frame = sequence.scene->at(f / sequence.fps);
      const glm::dmat4 camera_from_world = glm::inverse(frame.camera.world_from_camera);
      for (const layers::dvec3& p : layers::world_positions(frame, sequence.scene->parts[0])) {
        const glm::dvec4 c = camera_from_world * glm::dvec4(p, 1);
        ASSERT_GT(-c.z, frame.camera.near_m);
        ASSERT_LT(-c.z, frame.camera.far_m);
        const double reach =
            std::max(std::abs(c.x), std::abs(c.y)) / (-c.z * std::tan(frame.camera.fov_y_rad / 2));
        ASSERT_LT(reach, 1) << "out of the picture at frame " << f;
        widest = std::max(widest, reach);
      }
    }
    EXPECT_GT(widest, 0.5) << "too small in the picture";
  }
}

TEST(LoadModel, OrbitIsClosedAfterItsFrames) {
  const TemporaryFolder folder;
  const Sequence sequence = load_sequence(folder.write("square.obj", square_obj()));
  const auto first = sequence.scene->at(0).camera.world_from_camera;
  const auto after = sequence.scene->at(sequence.frames / sequence.fps).camera.world_from_camera;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(first[c][r], after[c][r], 1e-9);
}

TEST(LoadModel, AnimationGivesTheLengthAndTagsTheLayer) {
  const TemporaryFolder folder;
  const Sequence sequence = load_sequence(folder.write("moving.gltf", moving_gltf()));
  EXPECT_EQ(sequence.frames, 48);
  ASSERT_EQ(sequence.layers.layers.size(), 3u);  // the ground and its shadow
  EXPECT_EQ(sequence.layers.layers[0].name, "hull");
  EXPECT_EQ(sequence.layers.unassigned_parts, 0);
}

}  // namespace
}  // namespace talisman::sequences
