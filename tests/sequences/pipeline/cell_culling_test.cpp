// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/culling/cell_culling.h"

#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/content/culling/building.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;

constexpr const char* kTriples[] = {"none,none,none",       "none,none,frustum",   "none,frustum,none",
                                    "none,frustum,frustum", "none,eye,none",       "none,eye,frustum",
                                    "none,eye,eye",         "ctc,none,none",       "ctc,none,frustum",
                                    "ctc,frustum,none",     "ctc,frustum,frustum", "ctc,eye,none",
                                    "ctc,eye,frustum",      "ctc,eye,eye",         "cto,none,none",
                                    "cto,none,frustum",     "cto,frustum,none",    "cto,frustum,frustum",
                                    "cto,eye,none",         "cto,eye,frustum",     "cto,eye,eye"};

/// A small building, an eye that walks through it, a chair that flies from room to room.
struct Walk {
  layers::Scene scene;
  std::shared_ptr<const layers::CellSet> cells;
  layers::LayerSet layers;
  BuildingContent content;

  explicit Walk(unsigned seed, int storeys = 2, int rooms = 5, int atrium = 1) {
    content.storeys = storeys, content.rooms = rooms, content.atrium_rooms = atrium;
    content.furniture = 5, content.seed = seed;
    cells = std::make_shared<const layers::CellSet>(add_building(scene, content));
    layers::Light light;
    light.kind = layers::Light::Kind::Ambient;
    scene.lights.push_back(light);
    fly_camera();
    fly_chair();
    layers = layers::factor(scene, std::vector<layers::LayerSpec>{{"all", {"*"}, {}, {}}});
  }

  void fly_camera() {
    const int node = static_cast<int>(scene.nodes.size());
    scene.nodes.push_back({"camera", -1, {}});
    scene.cameras.push_back({"camera", node, 1.1, 0.05, 200});
    layers::FlightTrack flight;
    flight.position = {{0, 1, 2, 3, 4},
                       {{2.5, 1.6, -4}, {2.5, 1.6, 0}, {10, 1.6, 0.3}, {13, 1.7, 2}, {20, 1.6, 0}}};
    flight.target = {{0, 1, 2, 3, 4}, {{2.5, 1.5, 0}, {9, 1.4, 0}, {30, 2, 0}, {12, 4, -5}, {20, 1.5, 5}}};
    scene.tracks.push_back({node, flight});
  }
  void fly_chair() {
    for (const layers::Part& part : scene.parts)
      if (part.name == "storey 0/room 1 left/chair 0") {
        layers::TransformTrack track;
        track.translation = {{0, 4}, {{2.5, 0.1, -4}, {22, 0.1, 4}}};
        scene.tracks.push_back({part.node, track});
      }
  }
  Settings settings(const std::string& triple) const {
    Settings settings;
    settings.regulator.policy = regulator::Policy::Direct;
    settings.view.display_px = {120, 90};
    settings.render.samples = 4;
    settings.frames = 13;
    settings.fps = 3;
    settings.cells = cells;
    settings.visibility = *visibility_from(triple);
    return settings;
  }
};

TEST(CellCulling, ABuildingHasNoDefect) {
  for (const auto& [storeys, rooms, atrium] :
       {std::tuple(1, 1, 0), {1, 1, 1}, {3, 4, 4}, {2, 9, 3}, {1, 30, 0}}) {
    const Walk walk(1, storeys, rooms, atrium);
    EXPECT_EQ(first_defect(*walk.cells), "");
    EXPECT_EQ(first_defect(walk.scene), "");
  }
}

TEST(CellCulling, AllTriplesShowTheSamePictures) {
  const Walk walk(2);
  const chunker::PreparedScene prepared(walk.scene, walk.settings("none,none,none").render);
  std::vector<chunker::Frame> truth;
  double all = 0, least = HUGE_VAL;
  for (const char* triple : kTriples) {
    const Pipeline pipeline = make_pipeline(walk.scene, walk.layers, walk.settings(triple));
    PipelineState state(pipeline);
    double polygons = 0;
    for (int frame = 0; frame < 13; ++frame) {
      const FrameReport report = step(pipeline, state, frame, &prepared);
      polygons += double(report.render.polygons_in);
      if (truth.size() <= static_cast<std::size_t>(frame)) truth.push_back(report.picture);
      EXPECT_TRUE(report.picture == truth[frame]) << triple << " frame " << frame;
    }
    all = std::max(all, polygons), least = std::min(least, polygons);
  }
  EXPECT_LT(least, 0.4 * all);
}

/// Where a ray meets a triangle, as a multiple of its direction; infinite where it does not. [Möller, Trumbore 1997]
double hit(const dvec3& eye, const dvec3& way, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 u = b - a, v = c - a, p = cross(way, v);
  const double det = dot(u, p);
  if (std::fabs(det) < 1e-14) return HUGE_VAL;
  const dvec3 s = (eye - a) / det, q = cross(s, u);
  const double x = dot(s, p), y = dot(way, q), t = dot(v, q);
  return x >= 0 && y >= 0 && x + y <= 1 && t > 1e-9 ? t : HUGE_VAL;
}

/// The part that a ray meets first, by trying every triangle; -1: none.
int first_part(const layers::Scene& scene, const layers::SceneFrame& frame,
               const std::vector<std::vector<dvec3>>& world, const dvec3& eye, const dvec3& way) {
  double nearest = HUGE_VAL;
  int part = -1;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const std::vector<std::uint32_t>& indices = scene.meshes[scene.parts[i].mesh].indices;
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3)
      if (const double t =
              hit(eye, way, world[i][indices[k]], world[i][indices[k + 1]], world[i][indices[k + 2]]);
          t < nearest)
        nearest = t, part = static_cast<int>(i);
  }
  EXPECT_EQ(frame.scene, &scene);
  return part;
}

// Rays from eyes by lot in cells by lot: what they meet first is seen from the cell and through the portals.
TEST(CellCulling, RaysHitNothingThatIsNotSeen) {
  const Walk walk(3, 2, 3, 1);
  const layers::SceneFrame frame = walk.scene.at(0);
  std::vector<std::vector<dvec3>> world;
  std::vector<layers::Box3> boxes;
  const auto meshes = layers::mesh_boxes(walk.scene);
  for (const layers::Part& part : walk.scene.parts) {
    world.push_back(world_positions(frame, part));
    boxes.push_back(part_box(frame, part, meshes[part.mesh]));
  }
  CellMemory memory(walk.cells, boxes, {});
  std::mt19937 lot(3);
  std::uniform_real_distribution<double> unit(0, 1);
  int looked = 0;
  for (int k = 0; k < 60; ++k) {
    const layers::Cell& cell = walk.cells->cells[lot() % walk.cells->cells.size()];
    layers::CameraState camera{layers::dmat4(1), 1, 0.01, 100};
    const dvec3 eye = glm::mix(cell.lo, cell.hi, 0.1 + 0.8 * dvec3(unit(lot), unit(lot), unit(lot)));
    camera.world_from_camera[3] = layers::dvec4(eye, 1);
    std::vector<int> seen(boxes.size());
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = static_cast<int>(i);
    // Objects by CTO: eyes look everywhere, which no one frustum does.
    memory.keep_seen(*visibility_from("cto,none,none"), camera, {64, 64}, boxes, seen);
    for (int r = 0; r < 40; ++r, ++looked) {
      const dvec3 way = glm::normalize(dvec3(unit(lot) - 0.5, 0.4 * (unit(lot) - 0.5), unit(lot) - 0.5));
      const int part = first_part(walk.scene, frame, world, eye, way);
      ASSERT_GE(part, 0) << "a hole in the building: an eye in " << cell.name;
      EXPECT_TRUE(std::find(seen.begin(), seen.end(), part) != seen.end())
          << walk.scene.parts[part].name << " from " << cell.name;
    }
  }
  EXPECT_EQ(looked, 2400);
}

// In a wall, outside of the building, in a doorway: what cannot be known hides nothing.
TEST(CellCulling, NothingIsHiddenFromAnEyeInAWallOrInNoCell) {
  const Walk walk(4);
  const layers::SceneFrame frame = walk.scene.at(0);
  std::vector<layers::Box3> boxes;
  const auto meshes = layers::mesh_boxes(walk.scene);
  for (const layers::Part& part : walk.scene.parts) boxes.push_back(part_box(frame, part, meshes[part.mesh]));
  CellMemory memory(walk.cells, boxes, {});
  const auto left = [&](const dvec3& eye) {
    layers::CameraState camera{layers::dmat4(1), 1, 0.01, 100};
    camera.world_from_camera[3] = layers::dvec4(eye, 1);
    std::vector<int> seen(boxes.size());
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = static_cast<int>(i);
    memory.keep_seen(*visibility_from("cto,eye,eye"), camera, {64, 64}, boxes, seen);
    return seen.size();
  };
  EXPECT_EQ(left({1, 1, 1.2}), boxes.size());    // in the wall between a room and the corridor
  EXPECT_EQ(left({100, 1, 0}), boxes.size());    // outside
  EXPECT_LT(left({2.5, 1, 1.2}), boxes.size());  // in the doorway
  EXPECT_LT(left({2.5, 1, 4}), boxes.size());    // in the room
}

}  // namespace
}  // namespace talisman::sequences
