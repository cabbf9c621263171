// SPDX-License-Identifier: Apache-2.0
#include "layers/scene.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/animation.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool finite(const dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

std::map<std::string, Scene> all_scenes() {
  return {{"cube", tests::cube_scene()},
          {"quad", tests::textured_quad_scene()},
          {"sphere", tests::sphere_scene()},
          {"displaced", tests::displaced_sphere_scene(5000)},
          {"smallest", tests::displaced_sphere_scene(1)},
          {"moving", tests::moving_scene()},
          {"bar", tests::skinned_bar_scene()},
          {"tiny", tests::tiny_scene()},
          {"huge", tests::huge_scene()}};
}

// --- The workloads themselves ---

TEST(SupportScenes, HaveNoDefect) {
  for (const auto& [name, scene] : all_scenes()) EXPECT_EQ(first_defect(scene), "") << name;
}

// Every edge of a closed mesh, by position, is walked once in each direction; so its triangles agree on what
// is outside.
TEST(SupportScenes, CubeAndSpheresAreClosed) {
  using Key = std::tuple<float, float, float>;
  const auto key = [](const vec3& p) { return Key{p.x, p.y, p.z}; };
  for (const Mesh& mesh : {tests::cube_mesh(), tests::sphere_mesh(2, 3), tests::sphere_mesh(9, 14),
                           tests::sphere_mesh(20, 40, 1, 0.1)}) {
    std::map<std::pair<Key, Key>, int> walked;
    double volume = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      std::array<vec3, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[i + k]];
      for (int k = 0; k < 3; ++k) ++walked[{key(p[k]), key(p[(k + 1) % 3])}];
      volume += glm::dot(glm::cross(p[0], p[1]), p[2]) / 6;
    }
    EXPECT_GT(volume, 0) << "counter-clockwise from outside";
    for (const auto& [edge, count] : walked) {
      EXPECT_EQ(count, 1) << mesh.name;
      EXPECT_EQ(walked.count({edge.second, edge.first}), 1u) << mesh.name;
    }
  }
}

TEST(SupportScenes, DisplacedSphereHasAboutTheTrianglesAskedFor) {
  for (const int wanted : {8, 1000, 10000, 123456}) {
    const int made = tests::displaced_sphere_scene(wanted).meshes[0].triangle_count();
    EXPECT_NEAR(made, wanted, wanted < 5000 ? 0.02 * wanted : 0.005 * wanted);
  }
}

TEST(SupportScenes, NormalsPointOutwards) {
  const Mesh mesh = tests::sphere_mesh(12, 24, 2, 0.2);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(glm::length(mesh.normals[i]), 1, 1e-6);
    EXPECT_GT(glm::dot(mesh.normals[i], glm::normalize(mesh.positions[i])), 0.5f);
  }
}

TEST(SupportScenes, ScalingScalesWhatTheCameraSees) {
  const Scene one = tests::moving_scene();
  for (const double factor : {1e-4, 1e6}) {
    const Scene other = tests::scaled(one, factor);
    for (const double t_s : {0.0, 1.3, 4.0}) {
      const SceneFrame a = one.at(t_s), b = other.at(t_s);
      for (std::size_t i = 0; i < a.world_from_node.size(); ++i) {
        EXPECT_LT(glm::distance(a.world_from_node[i][3] * dvec4(factor, factor, factor, 1),
                                b.world_from_node[i][3]),
                  1e-9 * factor);
        EXPECT_LT(glm::distance(a.world_from_node[i][0], b.world_from_node[i][0]), 1e-9);
      }
    }
  }
}

// --- Scene::at ---

TEST(SceneAt, EmptySceneIsAFrame) {
  const Scene scene;
  const SceneFrame frame = scene.at(3);
  EXPECT_EQ(frame.scene, &scene);
  EXPECT_TRUE(frame.world_from_node.empty());
  EXPECT_TRUE(frame.lights.empty());
  EXPECT_EQ(frame.camera, CameraState{});
  EXPECT_EQ(scene.duration_s(), 0);
}

TEST(SceneAt, ChildrenFollowTheirParents) {
  Scene scene;
  scene.nodes.resize(3);
  scene.nodes[0].local.translation = {1, 0, 0};
  scene.nodes[0].local.rotation = glm::angleAxis(std::numbers::pi / 2, dvec3{0, 0, 1});
  scene.nodes[1].parent = 0;
  scene.nodes[1].local.translation = {2, 0, 0};
  scene.nodes[1].local.scale = {3, 3, 3};
  scene.nodes[2].parent = 1;
  scene.nodes[2].local.translation = {1, 0, 0};
  const dvec3 at = dvec3(scene.at(0).world_from_node[2][3]);
  EXPECT_LT(glm::distance(at, dvec3{1, 5, 0}), 1e-12);
}

TEST(SceneAt, IsPure) {
  const Scene scene = tests::moving_scene();
  const SceneFrame first = scene.at(1.7);
  scene.at(-5);
  const SceneFrame again = scene.at(1.7);
  EXPECT_EQ(first.world_from_node, again.world_from_node);
  EXPECT_EQ(first.camera, again.camera);
  EXPECT_EQ(first.lights, again.lights);
}

TEST(SceneAt, IsFiniteAtAllTimes) {
  for (const auto& [name, scene] : all_scenes())
    for (const double t_s : {-1e300, -1e9, -1.0, 0.0, 5e-324, 1.5, 1e9, 1e300}) {
      const SceneFrame frame = scene.at(t_s);
      for (const dmat4& matrix : frame.world_from_node) EXPECT_TRUE(finite(matrix)) << name << " at " << t_s;
      EXPECT_TRUE(finite(frame.camera.world_from_camera)) << name << " at " << t_s;
    }
}

// Ten thousand frames of looking at a fixed point: nothing accumulates, so frame 10,000 is as exact as
// frame 1.
TEST(SceneAt, DoesNotDriftOverTenThousandLoops) {
  const Scene scene = tests::skinned_bar_scene();
  const dmat4 once = scene.at(0.5).world_from_node.back();
  const dmat4 late = scene.at(0.5 + 2 * 10000).world_from_node.back();
  for (int column = 0; column < 4; ++column) EXPECT_LT(glm::distance(once[column], late[column]), 1e-11);
}

TEST(SceneAt, ZeroScaleHidesAndKeepsCameraAndLightUsable) {
  Scene scene = tests::cube_scene();
  scene.nodes[0].local.scale = {0, 0, 0};
  scene.cameras[0].node = 0;
  scene.lights[1].node = 0;
  EXPECT_EQ(first_defect(scene), "") << "a thing may vanish";
  const SceneFrame frame = scene.at(0);
  EXPECT_EQ(frame.camera.world_from_camera, dmat4(1));
  EXPECT_EQ(frame.lights[1].direction, (dvec3{0, -1, 0}));
  for (const dvec3& p : world_positions(frame, scene.parts[0])) EXPECT_EQ(p, (dvec3{0, 0, 0}));
}

// Exporters put cameras below nodes that convert inches or centimetres, or mirror.
TEST(SceneAt, ScaleAboveACameraDoesNotReachItsMatrix) {
  Scene scene = tests::cube_scene();
  const dmat4 plain = scene.at(0).camera.world_from_camera;
  scene.nodes[scene.cameras[0].node].local.scale = {0.0254, 3, 100};
  const dmat4 scaled = scene.at(0).camera.world_from_camera;
  for (int column = 0; column < 4; ++column) EXPECT_LT(glm::distance(plain[column], scaled[column]), 1e-12);
}

TEST(SceneAt, CameraBasisIsOrthonormalUnderShear) {
  Scene scene = tests::cube_scene();
  scene.nodes[0].local.scale = {1, 7, 0.1};
  Node& camera = scene.nodes[scene.cameras[0].node];
  camera.parent = 0;
  camera.local.rotation = unit({0.5, 0.3, -0.2, 0.7});
  const dmat4 m = scene.at(0).camera.world_from_camera;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(glm::dot(m[a], m[b]), a == b ? 1 : 0, 1e-12);
  EXPECT_GT(glm::dot(glm::cross(dvec3(m[0]), dvec3(m[1])), dvec3(m[2])), 0) << "right-handed";
}

TEST(SceneAt, LightsFollowTheirNodesWithUnitDirections) {
  Scene scene;
  scene.nodes.resize(1);
  scene.nodes[0].local.translation = {5, 0, 0};
  scene.nodes[0].local.rotation = glm::angleAxis(std::numbers::pi / 2, dvec3{0, 0, 1});
  Light lamp;
  lamp.kind = Light::Kind::Point;
  lamp.node = 0;
  lamp.position = {1, 0, 0};
  lamp.direction = {0, -7, 0};
  scene.lights = {lamp};
  const LightState state = scene.at(0).lights[0];
  EXPECT_EQ(state.kind, Light::Kind::Point);
  EXPECT_LT(glm::distance(state.position, dvec3{5, 1, 0}), 1e-12);
  EXPECT_LT(glm::distance(state.direction, dvec3{1, 0, 0}), 1e-12);
}

// Each factor is finite, their product is not.
TEST(SceneAt, OverflowingProductStaysWithItsParent) {
  Scene scene;
  scene.nodes.resize(2);
  scene.nodes[0].local.scale = {1e300, 1e300, 1e300};
  scene.nodes[1].parent = 0;
  scene.nodes[1].local.scale = {1e300, 1, 1};
  const SceneFrame frame = scene.at(0);
  EXPECT_EQ(frame.world_from_node[1], frame.world_from_node[0]);
}

TEST(SceneAt, SeveralTracksOfANodeApplyInTheirOrder) {
  Scene scene;
  scene.nodes.resize(1);
  TransformTrack lift;
  lift.translation = {{0, 1}, {{0, 0, 0}, {0, 2, 0}}, Interpolation::Linear};
  scene.tracks = {{0, lift}, {0, SpinTrack{{0, 1, 0}, std::numbers::pi / 2}}};
  const dmat4 world = scene.at(1).world_from_node[0];
  EXPECT_LT(glm::distance(dvec3(world[3]), dvec3{0, 2, 0}), 1e-12);
  EXPECT_LT(glm::distance(dvec3(world[0]), dvec3{0, 0, -1}), 1e-12);
}

TEST(SceneAtDeathTest, TimeThatIsNoNumberIsAProgrammersMistake) {
  EXPECT_DEATH(Scene{}.at(kNan), "check failed");
}

TEST(DurationS, IsTheLastKeyOfAnyTrackAndIgnoresSpins) {
  EXPECT_EQ(tests::moving_scene().duration_s(), 4);
  EXPECT_EQ(tests::skinned_bar_scene().duration_s(), 2);
  EXPECT_EQ(tests::displaced_sphere_scene(100).duration_s(), 0) << "only a spin";
}

TEST(IsAnimated, InheritsFromAncestorsOnly) {
  const Scene scene = tests::moving_scene();
  EXPECT_FALSE(is_animated(scene, 0)) << "ground";
  EXPECT_TRUE(is_animated(scene, 1)) << "cube";
  EXPECT_TRUE(is_animated(scene, 3)) << "the moon is moved by its orbit";
  EXPECT_FALSE(is_animated(scene, -1));
}

// --- first_defect ---

struct Broken {
  std::function<void(Scene&)> harm;
  std::string message;
};

const Broken kBroken[] = {
    {[](Scene& s) { s.meshes[1].indices[7] = 24; },
     "mesh 'cube': index 24 of triangle 2, rule: below 24 vertices"},
    {[](Scene& s) { s.meshes[1].indices.pop_back(); }, "mesh 'cube': 35 indices, rule: three per triangle"},
    {[](Scene& s) { s.meshes[1].uvs.pop_back(); },
     "mesh 'cube': 23 uvs, rule: none or as many as positions, 24"},
    {[](Scene& s) { s.meshes[1].positions[3].y = NAN; },
     "mesh 'cube': position 3 has component nan, rule: finite"},
    {[](Scene& s) { s.meshes[0].normals[0].x = HUGE_VALF; },
     "mesh 'ground': normal 0 has component inf, rule: finite"},
    {[](Scene& s) { s.meshes[0].name.clear(), s.meshes[0].positions[0].x = NAN; }, "mesh 0: position 0"},
    {[](Scene& s) { s.meshes[0].joints.resize(s.meshes[0].positions.size()); },
     "mesh 'ground': 81 joints and 0 weights, rule: as many joints as weights"},
    {[](Scene& s) { s.textures[0].rgba.pop_back(); },
     "texture 'checker': 16383 bytes, rule: 4 · width · height"},
    {[](Scene& s) { s.textures[0].width = 0; }, "texture 'checker': size 0 × 64, rule: at least 1 × 1"},
    {[](Scene& s) { s.materials[0].texture = 1; }, "material 'ground': texture 1, rule: from -1 to below 1"},
    {[](Scene& s) { s.materials[1].opacity = 1.5f; }, "material 'cube': opacity 1.5, rule: from 0 to 1"},
    {[](Scene& s) { s.materials[1].opacity = NAN; }, "material 'cube': opacity nan, rule: from 0 to 1"},
    {[](Scene& s) { s.materials[1].base_color.y = -1; },
     "material 'cube': base color has component -1, rule: at least 0"},
    {[](Scene& s) { s.nodes[3].parent = 4; }, "node 'moon': parent 4, rule: -1 or a node before it, below 3"},
    {[](Scene& s) { s.nodes[3].parent = 3; }, "node 'moon': parent 3, rule: -1 or a node before it, below 3"},
    {[](Scene& s) { s.nodes[3].parent = -2; }, "node 'moon': parent -2"},
    {[](Scene& s) { s.nodes[1].local.translation.z = kNan; },
     "node 'cube': translation has component nan, rule: finite"},
    {[](Scene& s) {
       s.nodes[1].local.rotation = {0, 0, 0, 0};
     },
     "node 'cube': rotation is zero, rule: not zero"},
    {[](Scene& s) { s.tracks[0].node = 99; }, "track of node 0: node 99, rule: from 0 to below 5"},
    {[](Scene& s) {
       std::get<SpinTrack>(s.tracks[0].motion).axis = {0, 0, 0};
     },
     "track of node 'cube': spin axis is zero, rule: not zero"},
    {[](Scene& s) { std::get<FlightTrack>(s.tracks[2].motion).position.times_s[2] = 1; },
     "track of node 'camera': position time 2 is 1, rule: above the one before, 1"},
    {[](Scene& s) { std::get<FlightTrack>(s.tracks[2].motion).position.times_s.pop_back(); },
     "track of node 'camera': position has 4 times and 5 values, rule: as many"},
    {[](Scene& s) { std::get<FlightTrack>(s.tracks[2].motion).position = {}; },
     "track of node 'camera': flight with 0 positions, rule: at least 1"},
    {[](Scene& s) {
       std::get<FlightTrack>(s.tracks[2].motion).bank_rad = {{0}, {kNan}, Interpolation::Linear};
     },
     "track of node 'camera': bank key 0 is nan, rule: finite"},
    {[](Scene& s) {
       s.lights[1].direction = {0, 0, 0};
     },
     "light 'sun': direction is zero, rule: not zero"},
    {[](Scene& s) { s.lights[1].node = 5; }, "light 'sun': node 5, rule: from -1 to below 5"},
    {[](Scene& s) { s.cameras[0].near_m = 0; },
     "camera 'camera': near_m 0 and far_m 100, rule: 0 < near < far"},
    {[](Scene& s) { s.cameras[0].fov_y_rad = 3.2; },
     "camera 'camera': fov_y_rad 3.2, rule: above 0 and below pi"},
    {[](Scene& s) { s.parts[2].mesh = 3; }, "part 'orbit/moon': mesh 3, rule: from 0 to below 3"},
    {[](Scene& s) { s.parts[2].material = -1; }, "part 'orbit/moon': material -1, rule: from 0 to below 3"},
    {[](Scene& s) { s.parts[2].skin = 0; }, "part 'orbit/moon': skin 0, rule: from -1 to below 0"},
    {[](Scene& s) { s.background.x = NAN; }, "scene: background has component nan, rule: finite"},
    {[](Scene& s) { s.active_camera = 1; }, "scene: active camera 1, rule: from 0 to below 1"},
};

TEST(FirstDefect, NamesItemValueAndRule) {
  for (const Broken& broken : kBroken) {
    Scene scene = tests::moving_scene();
    broken.harm(scene);
    EXPECT_THAT(first_defect(scene), HasSubstr(broken.message));
  }
}

TEST(FirstDefect, NamesWhatIsWrongWithASkin) {
  const Broken cases[] = {
      {[](Scene& s) { s.skins[0].joints[1] = 9; }, "skin 'bar': joint node 9, rule: from 0 to below 4"},
      {[](Scene& s) { s.skins[0].joint_from_mesh.pop_back(); },
       "skin 'bar': 2 joints and 1 matrices, rule: as many"},
      {[](Scene& s) { s.skins[0].joint_from_mesh[1][3][2] = kNan; },
       "skin 'bar': matrix of joint 1 has component nan, rule: finite"},
      {[](Scene& s) { s.meshes[0].joints[5].z = 2; },
       "part 'bar': joint 2 of vertex 5, rule: below 2 of its skin"},
      {[](Scene& s) { s.meshes[0].joints.clear(), s.meshes[0].weights.clear(); },
       "part 'bar': mesh 0 has 0 joints"},
      {[](Scene& s) { s.meshes[0].weights[5].x = -1; },
       "mesh 'bar': weight of vertex 5 is -1, rule: at least 0"},
      {[](Scene& s) {
         std::get<TransformTrack>(s.tracks[0].motion).rotation.values[1] = {0, 0, 0, 0};
       },
       "track of node 'upper': rotation key 1 is zero, rule: not zero"},
  };
  for (const Broken& broken : cases) {
    Scene scene = tests::skinned_bar_scene();
    broken.harm(scene);
    EXPECT_THAT(first_defect(scene), HasSubstr(broken.message));
  }
}

// Squares of distances are floats where points are lit: 5e18 m apart along each axis they are 3e38.
TEST(FirstDefect, PlacesThatTheRendererCannotHoldAreRefused) {
  Scene right;
  right.meshes.resize(1);
  right.meshes[0].positions = {{5e18f, 0, 0}};
  right.nodes.resize(1);
  right.nodes[0].local.translation = {0, -5e18, 0};
  right.cameras.resize(1);
  right.cameras[0].near_m = 1e-20;
  EXPECT_EQ(first_defect(right), "");
  const auto defect_after = [&](auto change) {
    Scene scene = right;
    change(scene);
    return first_defect(scene);
  };
  EXPECT_THAT(defect_after([](Scene& s) { s.meshes[0].positions[0].x = 6e18f; }),
              HasSubstr("position 0 has component 6e+18, rule: within 5e+18 m of the origin"));
  EXPECT_THAT(defect_after([](Scene& s) { s.nodes[0].local.translation.y = -6e18; }),
              HasSubstr("translation has component -6e+18, rule: within"));
  EXPECT_THAT(defect_after([](Scene& s) {
                FlightTrack flight;
                flight.position = {{0}, {{0, 0, 1e30}}};
                s.tracks = {{0, flight}};
              }),
              HasSubstr("position key 0 has component 1e+30, rule: within"));
  EXPECT_THAT(defect_after([](Scene& s) { s.cameras[0].near_m = 1e-21; }),
              HasSubstr("near_m 1e-21, rule: at least 1e-20"));
}

TEST(FirstDefect, EmptySceneHasNone) { EXPECT_EQ(first_defect(Scene{}), ""); }

}  // namespace
}  // namespace talisman::layers
