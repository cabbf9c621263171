// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/swarm/swarm.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "sequences/content/shapes.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::Mesh;

/// Uniform numbers with the same bits everywhere: the standard leaves its distributions open.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  dvec3 in_cube(double half) {
    const double x = within(-half, half), y = within(-half, half);
    return {x, y, within(-half, half)};
  }
  /// Evenly over all attitudes [Shoemake 1992].
  glm::dquat attitude() {
    const double u = within(0, 1), a = within(0, 2 * M_PI), b = within(0, 2 * M_PI);
    const double s = std::sqrt(1 - u), t = std::sqrt(u);
    return {t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)};
  }

 private:
  std::mt19937_64 engine_;
};

void append_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  if (a != b) mesh.indices.insert(mesh.indices.end(), {a, b, c});
  if (c != d) mesh.indices.insert(mesh.indices.end(), {a, c, d});
}

/// 16 meridians, 9 rows; one vertex at each pole.
void append_sphere(Mesh& mesh, const dvec3& middle, double radius) {
  constexpr std::uint32_t kAround = 16, kRows = 9;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto vertex = [&](std::uint32_t row, std::uint32_t column) {
    if (row == 0) return first;
    if (row == kRows) return first + 1;
    return first + 2 + (row - 1) * kAround + column % kAround;
  };
  const auto add = [&](const dvec3& unit) {
    mesh.positions.emplace_back(middle + radius * unit);
    mesh.normals.emplace_back(unit);
  };
  add({0, -1, 0});
  add({0, 1, 0});
  for (std::uint32_t row = 1; row < kRows; ++row)
    for (std::uint32_t column = 0; column < kAround; ++column) {
      const double up = M_PI * row / kRows, around = 2 * M_PI * column / kAround;
      add({std::sin(up) * std::sin(around), -std::cos(up), std::sin(up) * std::cos(around)});
    }
  for (std::uint32_t row = 0; row < kRows; ++row)
    for (std::uint32_t column = 0; column < kAround; ++column)
      append_quad(mesh, vertex(row, column), vertex(row, column + 1), vertex(row + 1, column + 1),
                  vertex(row + 1, column));
}

/// Along x, without ends.
void append_rod(Mesh& mesh, double half_length, double radius) {
  constexpr std::uint32_t kSides = 12;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t side = 0; side < kSides; ++side) {
    const double angle = 2 * M_PI * side / kSides;
    const dvec3 normal(0, std::cos(angle), std::sin(angle));
    for (const double end : {-half_length, half_length}) {
      mesh.positions.emplace_back(radius * normal + dvec3(end, 0, 0));
      mesh.normals.emplace_back(normal);
    }
  }
  for (std::uint32_t side = 0; side < kSides; ++side) {
    const std::uint32_t a = first + 2 * side, b = first + 2 * ((side + 1) % kSides);
    append_quad(mesh, a, b, b + 1, a + 1);
  }
}

Mesh quad_mesh() {
  Mesh mesh;
  for (const auto& [x, y] : {std::pair{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}}) {
    mesh.positions.emplace_back(x, y, 0.0f);
    mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Mesh block_mesh() {
  ShapeContent block;
  block.segments = 1;
  return shape_mesh(block);
}

Mesh mesh_of(SwarmContent::Shape shape) {
  constexpr double kRadius = 0.75, kFromMiddle = 1.75;
  Mesh mesh;
  switch (shape) {
    case SwarmContent::Shape::Quad:
      mesh = quad_mesh();
      break;
    case SwarmContent::Shape::Block:
      mesh = block_mesh();
      break;
    case SwarmContent::Shape::Sphere:
      append_sphere(mesh, dvec3(0), kRadius);
      break;
    case SwarmContent::Shape::Molecule:
      append_sphere(mesh, {-kFromMiddle, 0, 0}, kRadius);
      append_sphere(mesh, {kFromMiddle, 0, 0}, kRadius);
      append_rod(mesh, kFromMiddle - 0.5 * kRadius, 0.25);  // its ends are inside the spheres
      break;
  }
  mesh.name = "swarm";
  return mesh;
}

/// When one coordinate leaves the cube next, seconds from now.
double until_exit(double place, double velocity, double half) {
  if (velocity == 0) return HUGE_VAL;
  return ((velocity > 0 ? half : -half) - place) / velocity;
}

/// Straight on; at a side of the cube it goes on from the opposite one. Two keys, a bit apart, are a jump.
layers::TransformTrack flight(dvec3 place, const dvec3& velocity, const SwarmContent& swarm, double last_s) {
  const double half = 0.5 * swarm.cube_m;
  layers::Keys<dvec3> keys;
  double now = 0;
  const auto add = [&](double t, const dvec3& at) {
    if (!keys.times_s.empty() && !(t > keys.times_s.back()))
      t = std::nextafter(keys.times_s.back(), HUGE_VAL);
    keys.times_s.push_back(t);
    keys.values.push_back(at);
  };
  add(0, place);
  while (swarm.wrap) {
    int axis = 0;
    dvec3 wait;
    for (int k = 0; k < 3; ++k) wait[k] = std::max(0.0, until_exit(place[k], velocity[k], half));
    for (int k = 1; k < 3; ++k)
      if (wait[k] < wait[axis]) axis = k;
    if (!(now + wait[axis] < last_s)) break;
    now += wait[axis];
    place += wait[axis] * velocity;
    place[axis] = velocity[axis] > 0 ? half : -half;
    add(now, place);
    place[axis] = -place[axis];
    add(now, place);
  }
  add(last_s, place + (last_s - now) * velocity);
  layers::TransformTrack track;
  track.translation = std::move(keys);
  return track;
}

/// How one thing begins, and how it would move.
struct Thing {
  dvec3 place, velocity_m;  ///< a frame
  glm::dquat attitude;
  dvec3 turn_deg;  ///< a frame
  dvec3 scale;
};

Thing thrown(Dice& dice, const SwarmContent& swarm) {
  Thing thing;
  thing.place = dice.in_cube(0.5 * swarm.cube_m);
  thing.attitude = dice.attitude();
  thing.velocity_m = dice.in_cube(swarm.translation_m);
  thing.turn_deg = dice.in_cube(swarm.rotation_deg);
  const double u = dice.within(swarm.quad_edges_m.x, swarm.quad_edges_m.y);
  const double v = dice.within(swarm.quad_edges_m.x, swarm.quad_edges_m.y);
  const bool is_quad = swarm.shape == SwarmContent::Shape::Quad;
  thing.scale = swarm.size * (is_quad ? dvec3(u, v, 1) : dvec3(1));
  return thing;
}

/// Returns the node that carries it.
int add_thing(layers::Scene& scene, const std::string& name, const Thing& thing, bool moves,
              const SwarmContent& swarm, double fps, double last_s) {
  const auto add_node = [&](int parent, const layers::Transform& local) {
    scene.nodes.push_back({name, parent, local});
    return static_cast<int>(scene.nodes.size()) - 1;
  };
  if (!moves) return add_node(-1, {thing.place, thing.attitude, thing.scale});
  const int carrier = add_node(-1, {thing.place, thing.attitude, dvec3(1)});
  if (thing.velocity_m != dvec3(0))
    scene.tracks.push_back({carrier, flight(thing.place, fps * thing.velocity_m, swarm, last_s)});
  const int node = add_node(carrier, {dvec3(0), {1, 0, 0, 0}, thing.scale});
  const double turn = glm::radians(glm::length(thing.turn_deg));
  if (turn > 0) scene.tracks.push_back({node, layers::SpinTrack{glm::normalize(thing.turn_deg), fps * turn}});
  return node;
}

void add_lights(layers::Scene& scene, const SwarmContent& swarm, Dice& dice) {
  for (int i = 0; i < swarm.lights; ++i) {
    layers::Light light;
    light.name = "swarm light " + std::to_string(i);
    light.kind = layers::Light::Kind::Point;
    light.position = dice.in_cube(0.5 * swarm.cube_m);
    light.color = layers::vec3(static_cast<float>(2.0 / swarm.lights));
    light.attenuation = {1, 2 / swarm.cube_m, 0};
    scene.lights.push_back(light);
  }
}

void add_materials(layers::Scene& scene, const SwarmContent& swarm, Dice& dice) {
  for (int i = 0; i < swarm.colors; ++i) {
    layers::Material material;
    material.name = "swarm " + std::to_string(i);
    for (int k = 0; k < 3; ++k) material.base_color[k] = static_cast<float>(dice.within(0.1, 0.9));
    material.two_sided = swarm.shape == SwarmContent::Shape::Quad;
    scene.materials.push_back(material);
  }
}

/// Before any memory is taken.
void require_few_jumps(const SwarmContent& swarm, double frames) {
  constexpr double kMost = 2e7;
  const double jumps = swarm.wrap ? 3 * frames * moving_count(swarm) * swarm.translation_m / swarm.cube_m : 0;
  if (!(jumps <= kMost))
    throw InputError("swarm has things that may leave their cube " + formatted("%.3g", jumps) +
                         " times, rule: at most 20 million",
                     swarm.file, swarm.line);
}

}  // namespace

int moving_count(const SwarmContent& swarm) {
  return static_cast<int>(std::lround(swarm.count * swarm.moving_percent / 100));
}

int quads_of(SwarmContent::Shape shape) {
  switch (shape) {
    case SwarmContent::Shape::Quad:
      return 1;
    case SwarmContent::Shape::Block:
      return 6;
    case SwarmContent::Shape::Sphere:
      return 144;
    case SwarmContent::Shape::Molecule:
      return 300;
  }
  return 0;
}

void add_swarm(layers::Scene& scene, const SwarmContent& swarm, double fps, double last_s) {
  require_few_jumps(swarm, fps * last_s);
  Dice dice(swarm.seed);
  const int material = static_cast<int>(scene.materials.size()), mesh = static_cast<int>(scene.meshes.size());
  add_lights(scene, swarm, dice);
  add_materials(scene, swarm, dice);
  scene.meshes.push_back(mesh_of(swarm.shape));
  const int moving = moving_count(swarm);
  for (int i = 0; i < swarm.count; ++i) {
    const std::string name = "swarm/" + std::to_string(i);
    const int node = add_thing(scene, name, thrown(dice, swarm), i < moving, swarm, fps, last_s);
    scene.parts.push_back({name, node, mesh, material + i % swarm.colors, -1});
  }
}

}  // namespace talisman::sequences
