// SPDX-License-Identifier: Apache-2.0
// Cameras and lights of formats of which assimp says less than the file does.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/import/model_import.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

void expect_near(const layers::dvec4& v, const layers::dvec3& expected) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(v[k], expected[k], 1e-5) << k;
}

/// A triangle, and a camera at (-10, 0, 5) that looks along x with z up: its own -z, so its rows are -y, z, -x.
const char* const kAse = R"(*3DSMAX_ASCIIEXPORT	200
*GEOMOBJECT {
	*NODE_NAME "Tri"
	*NODE_TM {
		*NODE_NAME "Tri"
		*TM_ROW0 1 0 0
		*TM_ROW1 0 1 0
		*TM_ROW2 0 0 1
		*TM_ROW3 0 0 0
	}
	*MESH {
		*MESH_NUMVERTEX 3
		*MESH_NUMFACES 1
		*MESH_VERTEX_LIST {
			*MESH_VERTEX 0 0 0 0
			*MESH_VERTEX 1 0 1 0
			*MESH_VERTEX 2 0 0 1
		}
		*MESH_FACE_LIST {
			*MESH_FACE 0: A: 0 B: 1 C: 2 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 *MESH_MTLID 0
		}
	}
}
*CAMERAOBJECT {
	*NODE_NAME "Eye"
	*CAMERA_TYPE Free
	*NODE_TM {
		*NODE_NAME "Eye"
		*TM_ROW0 0 -1 0
		*TM_ROW1 0 0 1
		*TM_ROW2 -1 0 0
		*TM_ROW3 -10 0 5
	}
	*CAMERA_SETTINGS {
		*CAMERA_FOV 0.5
	}
}
)";

TEST(AseCamera, LooksAlongItsOwnMinusZ) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("eye.ase", kAse));
  const layers::CameraState camera = model.scene.at(0).camera;
  expect_near(camera.world_from_camera[3], {-10, 5, 0});  // y is up
  expect_near(-camera.world_from_camera[2], {1, 0, 0});
  expect_near(camera.world_from_camera[1], {0, 1, 0});
  EXPECT_NEAR(camera.fov_y_rad, 0.5, 1e-6);
}

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Id, length with the head, content.
std::string chunk(std::uint16_t id, const std::string& content) {
  return bytes_of<std::uint16_t>({id}) +
         bytes_of<std::uint32_t>({static_cast<std::uint32_t>(content.size() + 6)}) + content;
}

std::string name(const std::string& text) { return text + std::string(1, '\0'); }

/// A triangle, and a camera: eye, target, bank, lens.
std::string studio_file(const std::vector<float>& camera) {
  const std::string vertices = bytes_of<std::uint16_t>({3}) + bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 0, 1});
  const std::string faces = bytes_of<std::uint16_t>({1, 0, 1, 2, 7});
  const std::string mesh = chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces));
  return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, name("tri") + mesh) +
                                         chunk(0x4000, name("eye") + chunk(0x4700, bytes_of(camera)))));
}

TEST(StudioCamera, LooksAtItsTarget) {
  const TemporaryFolder folder;
  // 2400 / 60 = 40 degrees.
  const ImportedModel model = import_model(folder.write("eye.3ds", studio_file({0, -10, 3, 0, 0, 3, 0, 60})));
  ASSERT_EQ(model.scene.cameras.size(), 1u);
  const layers::CameraState camera = model.scene.at(0).camera;
  expect_near(camera.world_from_camera[3], {0, 3, 10});  // z of the file is y, y is -z
  expect_near(-camera.world_from_camera[2], {0, 0, -1});
  expect_near(camera.world_from_camera[1], {0, 1, 0});
  EXPECT_NEAR(camera.fov_y_rad, 40 * std::acos(-1) / 180, 1e-6);
}

TEST(StudioCamera, WithoutADirectionIsLeftOut) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      import_model(folder.write("eye.3ds", studio_file({1, 2, 3, 1, 2, 3, 0, 60}))).scene.cameras.empty());
  EXPECT_TRUE(
      import_model(folder.write("nan.3ds", studio_file({NAN, 2, 3, 1, 2, 3, 0, 60}))).scene.cameras.empty());
}

TEST(StudioCamera, LensOutOfRangeIsThatOf45Degrees) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("eye.3ds", studio_file({0, -10, 3, 0, 0, 3, 0, 0})));
  EXPECT_NEAR(model.scene.at(0).camera.fov_y_rad, std::acos(-1) / 4, 1e-6);
}

/// COLLADA in centimetres: a triangle and a lamp.
struct Collada {
  std::string lamp = "1 0 0", libraries, nodes, bound;
  std::string text() const;
};

std::string Collada::text() const {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01" name="centimeter"/><up_axis>Y_UP</up_axis></asset>)" +
         libraries + "<library_lights><light id=\"l\"><technique_common><point><color>" + lamp +
         R"(</color></point></technique_common></light></library_lights>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION"
source="#p"/></vertices><triangles count="1" material="paint"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n" name="n">
<instance_geometry url="#g">)" +
         bound +
         R"(</instance_geometry></node><node id="lamp" name="lamp"><instance_light url="#l"/></node>)" +
         nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#s\"/></scene></COLLADA>";
}

/// With a camera at z = 50 cm whose lens is `optics`.
ImportedModel with_collada_camera(const std::string& optics) {
  const TemporaryFolder folder;
  Collada file;
  file.libraries = "<library_cameras><camera id=\"c\"><optics><technique_common>" + optics +
                   "</technique_common></optics></camera></library_cameras>";
  file.nodes = R"(<node id="eye" name="eye"><translate>0 0 50</translate><instance_camera url="#c"/></node>)";
  return import_model(folder.write("eye.dae", file.text()));
}

TEST(ColladaCamera, StandsInTheUnitsOfTheFileWithItsPlanes) {
  const layers::CameraState camera =
      with_collada_camera(
          "<perspective><xfov>40</xfov><yfov>40</yfov><znear>10</znear><zfar>1000</zfar></perspective>")
          .scene.at(0)
          .camera;
  expect_near(camera.world_from_camera[3], {0, 0, 0.5});
  EXPECT_NEAR(camera.near_m, 0.1, 1e-7);
  EXPECT_NEAR(camera.far_m, 10, 1e-5);
}

// assimp takes one that says yfov alone for pi/4 degrees.
TEST(ColladaCamera, SeesTheAnglesOfTheFile) {
  const auto fov_deg = [](const std::string& words) {
    const ImportedModel model = with_collada_camera("<perspective>" + words + "</perspective>");
    return model.scene.cameras.at(0).fov_y_rad * 180 / M_PI;
  };
  EXPECT_NEAR(fov_deg("<yfov>90</yfov>"), 90, 1e-9);
  EXPECT_NEAR(fov_deg("<yfov>60</yfov><aspect_ratio>2</aspect_ratio>"), 60, 1e-9);
  EXPECT_NEAR(fov_deg("<xfov>90</xfov><aspect_ratio>2</aspect_ratio>"), 2 * std::atan(0.5) * 180 / M_PI,
              1e-9);
  EXPECT_NEAR(fov_deg("<xfov>50</xfov>"), 50, 1e-9);
  EXPECT_NEAR(fov_deg("<xfov>70</xfov><yfov>30</yfov>"), 30, 1e-9);
  for (const char* none : {"<yfov>0</yfov>", "<yfov>180</yfov>", "<yfov>nan</yfov>", ""}) {
    EXPECT_GT(fov_deg(none), 10) << none;
    EXPECT_LT(fov_deg(none), 100) << none;
  }
}

TEST(ColladaCamera, OrthographicIsSaid) {
  EXPECT_THAT(with_collada_camera("<orthographic><xmag>2</xmag></orthographic>").warnings,
              ::testing::Contains(HasSubstr("camera 'eye' is orthographic")));
}

/// A library of materials of a transparency each, the first of them on the triangle.
Collada with_transparencies(const std::vector<std::string>& values) {
  Collada file;
  std::string effects, materials;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string id = std::to_string(i);
    effects += "<effect id=\"e" + id +
               "\"><profile_COMMON><technique sid=\"t\"><lambert><diffuse><color>1 1 1 1</color>" +
               "</diffuse><transparent><color>1 1 1 1</color></transparent><transparency><float>" +
               values[i] + "</float></transparency></lambert></technique></profile_COMMON></effect>";
    materials += "<material id=\"m" + id + "\" name=\"m" + id + "\"><instance_effect url=\"#e" + id +
                 "\"/></material>";
  }
  file.libraries = "<library_effects>" + effects + "</library_effects><library_materials>" + materials +
                   "</library_materials>";
  file.bound =
      "<bind_material><technique_common><instance_material symbol=\"paint\" "
      "target=\"#m0\"/></technique_common>"
      "</bind_material>";
  return file;
}

// 0 is clear by the format. Where nothing is opaque and something is clear the exporter meant the opposite.
TEST(ColladaTransparency, IsTurnedOverWhereNothingWouldBeOpaque) {
  const TemporaryFolder folder;
  const auto first_opacity = [&](const std::vector<std::string>& values, std::size_t warnings) {
    const ImportedModel model = import_model(folder.write("t.dae", with_transparencies(values).text()));
    EXPECT_EQ(model.warnings.size(), warnings);
    const auto material = static_cast<std::size_t>(model.scene.parts.at(0).material);
    return model.scene.materials.at(material).opacity;
  };
  EXPECT_FLOAT_EQ(first_opacity({"0"}, 1), 1);
  EXPECT_FLOAT_EQ(first_opacity({"0.25", "0"}, 1), 0.75f);
  EXPECT_FLOAT_EQ(first_opacity({"0", "1"}, 0), 0);
  EXPECT_FLOAT_EQ(first_opacity({"0.25"}, 0), 0.25f);
}

void replace_in(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

std::string coordinate_source(const std::string& id, const std::string& values) {
  return "<source id=\"" + id + "\"><float_array id=\"" + id + "a\" count=\"6\">" + values +
         "</float_array><technique_common><accessor source=\"#" + id +
         "a\" count=\"3\" stride=\"2\"><param name=\"S\" type=\"float\"/><param name=\"T\" "
         "type=\"float\"/></accessor></technique_common></source>";
}

std::string coordinate_input(const std::string& source, const std::string& set) {
  return "<input semantic=\"TEXCOORD\" source=\"#" + source + "\" offset=\"0\" set=\"" + set + "\"/>";
}

/// A picture on a triangle whose coordinates reach 2 in set 0 and 1 in set 1.
ImportedModel with_sampler(const std::string& sampler, int set) {
  const TemporaryFolder folder;
  folder.write("t.ppm", "P6\n1 1\n255\nabc");
  std::string text = with_transparencies({"1"}).text();
  replace_in(text, "<library_effects>",
             "<library_images><image "
             "id=\"i\"><init_from>t.ppm</init_from></image></library_images><library_effects>");
  replace_in(text, "<profile_COMMON>",
             "<profile_COMMON><newparam sid=\"face\"><surface "
             "type=\"2D\"><init_from>i</init_from></surface></newparam>"
             "<newparam sid=\"look\"><sampler2D><source>face</source>" +
                 sampler + "</sampler2D></newparam>");
  replace_in(text, "<diffuse><color>1 1 1 1</color>",
             "<diffuse><texture texture=\"look\" texcoord=\"MAP\"/>");
  replace_in(text, "<vertices",
             coordinate_source("u0", "0 0 2 0 0 2") + coordinate_source("u1", "0 0 1 0 0 1") + "<vertices");
  replace_in(text, "<p>", coordinate_input("u0", "0") + coordinate_input("u1", "1") + "<p>");
  replace_in(text, "target=\"#m0\"/>",
             "target=\"#m0\"><bind_vertex_input semantic=\"MAP\" input_semantic=\"TEXCOORD\" input_set=\"" +
                 std::to_string(set) + "\"/></instance_material>");
  return import_model(folder.write("map.dae", text));
}

TEST(ColladaMap, WrapsAsItsSamplerSays) {
  const auto wraps = [](const std::string& sampler) {
    const layers::Texture texture = with_sampler(sampler, 0).scene.textures.at(0);
    return std::pair(texture.wrap_u, texture.wrap_v);
  };
  using layers::Wrap;
  EXPECT_EQ(wraps(""), std::pair(Wrap::Repeat, Wrap::Repeat));
  EXPECT_EQ(wraps("<wrap_s>CLAMP</wrap_s><wrap_t>MIRROR</wrap_t>"), std::pair(Wrap::Clamp, Wrap::Mirror));
  EXPECT_EQ(wraps("<wrap_s>WRAP</wrap_s><wrap_t>BORDER</wrap_t>"), std::pair(Wrap::Repeat, Wrap::Clamp));
}

TEST(ColladaMap, IsLookedUpByTheSetItIsBoundTo) {
  for (const int set : {0, 1}) {
    float widest = 0;
    const ImportedModel model = with_sampler("", set);
    for (const layers::vec2& uv : model.scene.meshes.at(0).uvs) widest = std::max(widest, uv.x);
    EXPECT_EQ(widest, set == 0 ? 2 : 1);
  }
}

TEST(ForeignText, ColladaIn16BitsIsReadWithItsNames) {
  const TemporaryFolder folder;
  std::string text = Collada().text(), wide = "\xFF\xFE";
  text.replace(text.find("id=\"n\""), 6, "id=\"@\"");
  for (const char c : text) wide += c == '@' ? std::string("\xE9\0", 2) : std::string{c, '\0'};  // é
  const ImportedModel model = import_model(folder.write("wide.dae", wide));
  ASSERT_EQ(model.scene.parts.size(), 1u);
  EXPECT_THAT(model.scene.parts[0].name, HasSubstr("\u00e9"));
}

TEST(ForeignLight, WithoutColourIsLeftOutAndSaid) {
  const TemporaryFolder folder;
  EXPECT_EQ(import_model(folder.write("lit.dae", Collada().text())).scene.lights.size(), 1u);
  Collada unlit;
  unlit.lamp = "0 0 0";
  const ImportedModel dark = import_model(folder.write("dark.dae", unlit.text()));
  EXPECT_TRUE(dark.scene.lights.empty());
  EXPECT_THAT(dark.warnings, Contains(HasSubstr("'lamp' gives no light")));
}

}  // namespace
}  // namespace talisman::sequences
