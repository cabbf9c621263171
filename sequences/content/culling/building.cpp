// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/culling/building.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "sequences/content/shapes.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::Mesh;
using layers::vec3;

constexpr double kDoorWide_m = 1.1, kDoorHigh_m = 2.1;
/// Of half its thickness: how far a wall reaches into another. Not all of it: two faces in one plane would flicker.
constexpr double kOverlap = 0.9;

/// Uniform numbers with the same bits everywhere: the standard leaves its distributions open.
class Lot {
 public:
  explicit Lot(std::uint32_t seed) : engine_(seed) {}
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

/// Boxes and a ball, joined into one mesh that stands on y = 0.
class FurnitureMesh {
 public:
  explicit FurnitureMesh(const std::string& name) { mesh_.name = name; }

  FurnitureMesh& box(const dvec3& middle, const dvec3& size) {
    ShapeContent shape;
    shape.size_m = size;
    shape.segments = 1;
    return add(shape, middle);
  }
  FurnitureMesh& ball(const dvec3& middle, double diameter, int segments) {
    ShapeContent shape;
    shape.kind = ShapeContent::Kind::Sphere;
    shape.size_m = dvec3(diameter);
    shape.segments = segments;
    return add(shape, middle);
  }
  FurnitureMesh& pole(const dvec3& middle, double diameter, double height, double taper) {
    ShapeContent shape;
    shape.kind = ShapeContent::Kind::Cylinder;
    shape.size_m = {diameter, height, diameter};
    shape.taper = taper;
    shape.segments = 16;
    return add(shape, middle);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  FurnitureMesh& add(const ShapeContent& shape, const dvec3& middle) {
    const Mesh more = shape_mesh(shape);
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (const vec3& p : more.positions) mesh_.positions.push_back(p + vec3(middle));
    mesh_.normals.insert(mesh_.normals.end(), more.normals.begin(), more.normals.end());
    mesh_.uvs.insert(mesh_.uvs.end(), more.uvs.begin(), more.uvs.end());
    for (const std::uint32_t i : more.indices) mesh_.indices.push_back(first + i);
    return *this;
  }
  Mesh mesh_;
};

std::vector<Mesh> furniture_meshes() {
  FurnitureMesh table("table"), chair("chair"), shelf("shelf"), plant("plant"), lamp("lamp");
  table.box({0, 0.72, 0}, {1.4, 0.05, 0.8});
  chair.box({0, 0.45, 0}, {0.45, 0.05, 0.45}).box({0, 0.75, -0.2}, {0.42, 0.5, 0.04});
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) {
      table.box({0.64 * x, 0.35, 0.34 * z}, {0.06, 0.7, 0.06});
      chair.box({0.19 * x, 0.21, 0.19 * z}, {0.04, 0.42, 0.04});
    }
  for (int board = 0; board < 5; ++board) shelf.box({0, 0.03 + 0.42 * board, 0}, {1.2, 0.03, 0.35});
  for (const double x : {-0.6, 0.6}) shelf.box({x, 0.87, 0}, {0.03, 1.74, 0.35});
  for (int book = 0; book < 18; ++book)
    shelf.box({-0.5 + 0.12 * (book % 9), 0.58 + 0.42 * (book / 9), 0},
              {0.07, 0.22 + 0.02 * (book % 4), 0.24});
  plant.pole({0, 0.2, 0}, 0.3, 0.4, 0.8).ball({0, 0.8, 0}, 0.7, 20).ball({0.1, 1.15, 0.05}, 0.45, 16);
  lamp.pole({0, 0.02, 0}, 0.3, 0.04, 1).pole({0, 0.75, 0}, 0.04, 1.5, 1).pole({0, 1.55, 0}, 0.45, 0.3, 0.55);
  std::vector<Mesh> meshes;
  for (FurnitureMesh* mesh : {&table, &chair, &shelf, &plant, &lamp}) meshes.push_back(mesh->take());
  return meshes;
}

constexpr vec3 kWoods[] = {{0.45f, 0.25f, 0.11f}, {0.62f, 0.42f, 0.22f}, {0.20f, 0.23f, 0.27f},
                           {0.55f, 0.12f, 0.10f}, {0.12f, 0.28f, 0.42f}, {0.70f, 0.66f, 0.55f}};
constexpr vec3 kPlaster[] = {{0.78f, 0.76f, 0.70f}, {0.70f, 0.75f, 0.78f}, {0.80f, 0.70f, 0.58f}};
constexpr vec3 kFloor{0.36f, 0.30f, 0.24f}, kCeiling{0.85f, 0.85f, 0.83f}, kLeaves{0.13f, 0.36f, 0.12f},
    kShade{0.85f, 0.72f, 0.42f};

class Building {
 public:
  Building(layers::Scene& scene, const BuildingContent& content)
      : scene_(scene), c_(content), lot_(content.seed), first_mesh_(static_cast<int>(scene.meshes.size())) {
    for (Mesh& mesh : furniture_meshes()) scene_.meshes.push_back(std::move(mesh));
    const int left_over = c_.rooms - c_.atrium_rooms;
    atrium_first_ = left_over / 2, atrium_end_ = atrium_first_ + c_.atrium_rooms;
  }

  layers::CellSet build() {
    if (c_.atrium_rooms > 0) add_atrium();
    for (int storey = 0; storey < c_.storeys; ++storey) add_storey(storey);
    return std::move(cells_);
  }

 private:
  double x_of(int room) const { return room * c_.room_m.x; }
  double y_of(int storey) const { return storey * c_.height_m; }
  double inner_z() const { return c_.corridor_m / 2; }
  double outer_z() const { return c_.corridor_m / 2 + c_.room_m.y; }
  bool is_atrium(int room) const { return room >= atrium_first_ && room < atrium_end_; }

  int add_node(const std::string& name, int parent, const dvec3& at, double turn_rad = 0) {
    layers::Node node;
    node.name = name;
    node.parent = parent;
    node.local.translation = at;
    node.local.rotation = glm::angleAxis(turn_rad, dvec3(0, 1, 0));
    scene_.nodes.push_back(std::move(node));
    return static_cast<int>(scene_.nodes.size()) - 1;
  }
  int material(const vec3& color) {
    for (std::size_t i = 0; i < scene_.materials.size(); ++i)
      if (scene_.materials[i].name == "building" && scene_.materials[i].base_color == color)
        return static_cast<int>(i);
    layers::Material m;
    m.name = "building";
    m.base_color = color;
    scene_.materials.push_back(m);
    return static_cast<int>(scene_.materials.size()) - 1;
  }
  void add_part(const std::string& name, int parent, int mesh, const vec3& color, const dvec3& at,
                double turn_rad) {
    const int node = add_node(name, parent, at, turn_rad);
    std::string path = name;
    for (int up = parent; up >= 0; up = scene_.nodes[up].parent) path = scene_.nodes[up].name + "/" + path;
    scene_.parts.push_back({path, node, mesh, material(color)});
  }

  /// A box from lo to hi, part of a wall.
  void add_block(const std::string& name, int parent, const dvec3& lo, const dvec3& hi, const vec3& color) {
    FurnitureMesh block(name);
    block.box(0.5 * (lo + hi), hi - lo);
    scene_.meshes.push_back(block.take());
    add_part(name, parent, static_cast<int>(scene_.meshes.size()) - 1, color, {0, 0, 0}, 0);
  }

  int add_cell(const std::string& name, const dvec3& lo, const dvec3& hi) {
    cells_.cells.push_back({name, lo, hi});
    return static_cast<int>(cells_.cells.size()) - 1;
  }

  /// A wall across `axis` (0: x, 2: z) at `where`, from `low` to `high` along the other and from y0 to y1; with a
  /// door in its middle where `door` is. It reaches into those that it meets, so that corners are closed.
  void add_wall(const std::string& name, int parent, int axis, double where, double low, double high,
                double y0, double y1, bool door, const vec3& color) {
    const double half = c_.wall_m / 2, over = kOverlap * half;
    const auto block = [&](const std::string& piece, double from, double to, double bottom, double top) {
      dvec3 lo(from, bottom, from), hi(to, top, to);
      lo[axis] = where - half, hi[axis] = where + half;
      add_block(name + piece, parent, lo, hi, color);
    };
    if (!door) return block("", low - over, high + over, y0 - over, y1 + over);
    const double middle = 0.5 * (low + high);
    block(" before the door", low - over, middle - kDoorWide_m / 2, y0 - over, y1 + over);
    block(" behind the door", middle + kDoorWide_m / 2, high + over, y0 - over, y1 + over);
    block(" above the door", middle - kDoorWide_m / 2, middle + kDoorWide_m / 2, y0 + kDoorHigh_m, y1 + over);
  }

  /// The hole of that wall's door.
  void add_door(int a, int b, int axis, double where, double low, double high, double y0) {
    const double middle = 0.5 * (low + high);
    add_opening(a, b, axis, where, middle - kDoorWide_m / 2, middle + kDoorWide_m / 2, y0, y0 + kDoorHigh_m);
  }
  void add_opening(int a, int b, int axis, double where, double low, double high, double y0, double y1) {
    layers::Portal portal{{a, b}, {}};
    for (const auto& [along, y] : {std::pair(low, y0), {high, y0}, {high, y1}, {low, y1}}) {
      dvec3 corner(along, y, along);
      corner[axis] = where;
      portal.corners.push_back(corner);
    }
    cells_.portals.push_back(std::move(portal));
  }

  void add_slabs(const std::string& name, int parent, double x0, double x1, double z0, double z1,
                 double bottom, double top) {
    const double half = c_.wall_m / 2, over = kOverlap * half;
    add_block(name + " floor", parent, {x0 - over, bottom - half, z0 - over},
              {x1 + over, bottom + half, z1 + over}, kFloor);
    add_block(name + " ceiling", parent, {x0 - over, top - half - 0.02, z0 - over},
              {x1 + over, top, z1 + over}, kCeiling);
  }

  void add_atrium() {
    const double x0 = x_of(atrium_first_), x1 = x_of(atrium_end_), top = y_of(c_.storeys);
    atrium_ = add_cell("atrium", {x0, 0, -outer_z()}, {x1, top, outer_z()});
    const int walls = add_node("atrium", -1, {0, 0, 0});
    add_slabs("atrium", walls, x0, x1, -outer_z(), outer_z(), 0, top);
    for (const double z : {-outer_z(), outer_z()})
      add_wall(z < 0 ? "north wall" : "south wall", walls, 2, z, x0, x1, 0, top, false, kPlaster[2]);
    // Where no room and no corridor is beside it.
    if (atrium_first_ == 0)
      add_wall("west wall", walls, 0, x0, -outer_z(), outer_z(), 0, top, false, kPlaster[2]);
    if (atrium_end_ == c_.rooms)
      add_wall("east wall", walls, 0, x1, -outer_z(), outer_z(), 0, top, false, kPlaster[2]);
    furnish("atrium", walls, x0, x1, -outer_z(), outer_z(), 0, 3 * c_.furniture);
  }

  void add_storey(int storey) {
    const std::string name = "storey " + std::to_string(storey);
    const int walls = add_node(name + "/walls", -1, {0, 0, 0});
    if (atrium_first_ > 0) add_wing(storey, name, walls, 0, atrium_first_);
    if (atrium_end_ < c_.rooms) add_wing(storey, name, walls, atrium_end_, c_.rooms);
  }

  int rooms_of_piece(int first, int end) const {
    return c_.corridor_rooms > 0 ? c_.corridor_rooms : end - first;
  }
  /// The corridor's cells along rooms `first` … `end`, open to each other.
  std::vector<int> add_corridor_cells(const std::string& name, int first, int end, double y0, double y1) {
    std::vector<int> pieces;
    const int rooms = rooms_of_piece(first, end);
    for (int room = first; room < end; room += rooms) {
      const bool is_whole = room == first && room + rooms >= end;
      const double x0 = x_of(room), x1 = x_of(std::min(room + rooms, end));
      pieces.push_back(add_cell(is_whole ? name : name + " " + std::to_string(pieces.size()),
                                {x0, y0, -inner_z()}, {x1, y1, inner_z()}));
      if (room > first)
        add_opening(pieces[pieces.size() - 2], pieces.back(), 0, x0, -inner_z(), inner_z(), y0, y1);
    }
    return pieces;
  }

  /// Rooms `first` … `end` on both sides of their piece of corridor.
  void add_wing(int storey, const std::string& name, int walls, int first, int end) {
    const double y0 = y_of(storey), y1 = y_of(storey + 1), x0 = x_of(first), x1 = x_of(end);
    const std::string wing = first == 0 ? " west" : " east";
    const std::vector<int> corridor = add_corridor_cells(name + "/corridor" + wing, first, end, y0, y1);
    add_slabs("corridor" + wing, walls, x0, x1, -inner_z(), inner_z(), y0, y1);
    for (const bool is_east : {false, true}) {
      const double x = is_east ? x1 : x0;
      const bool to_atrium = c_.atrium_rooms > 0 && is_atrium(is_east ? end : first - 1);
      if (to_atrium)
        add_opening(is_east ? corridor.back() : corridor.front(), atrium_, 0, x, -inner_z(), inner_z(), y0,
                    y1);
      else
        add_wall("corridor" + wing + " end", walls, 0, x, -inner_z(), inner_z(), y0, y1, false, kPlaster[0]);
      if (to_atrium && storey > 0)
        add_block("railing" + wing, walls, {x - 0.03, y0, -inner_z()}, {x + 0.03, y0 + 1, inner_z()},
                  kWoods[2]);
    }
    for (const bool is_left : {false, true}) {
      int before = -1;
      for (int room = first; room < end; ++room)
        before = add_room({storey, room, first, end, is_left}, name, walls,
                          corridor[(room - first) / rooms_of_piece(first, end)], before);
    }
  }

  struct RoomPlace {
    int storey, room, first, end;
    bool is_left;
  };

  int add_room(const RoomPlace& place, const std::string& storey, int walls, int corridor, int before) {
    const double y0 = y_of(place.storey), y1 = y_of(place.storey + 1), x0 = x_of(place.room),
                 x1 = x_of(place.room + 1);
    const double sign = place.is_left ? -1 : 1, z0 = std::min(sign * inner_z(), sign * outer_z()),
                 z1 = std::max(sign * inner_z(), sign * outer_z());
    const std::string label = "room " + std::to_string(place.room) + (place.is_left ? " left" : " right"),
                      name = storey + "/" + label;
    const int cell = add_cell(name, {x0, y0, z0}, {x1, y1, z1});
    const vec3 plaster = kPlaster[lot_.below(3)];
    add_slabs(label, walls, x0, x1, z0, z1, y0, y1);
    add_wall(label + " outer wall", walls, 2, sign * outer_z(), x0, x1, y0, y1, false, plaster);
    add_wall(label + " wall", walls, 2, sign * inner_z(), x0, x1, y0, y1, true, plaster);
    add_door(cell, corridor, 2, sign * inner_z(), x0, x1, y0);
    const bool door = before >= 0 && place.room % 3 == 1;
    add_wall(label + " west wall", walls, 0, x0, z0, z1, y0, y1, door, plaster);
    if (door) add_door(before, cell, 0, x0, z0, z1, y0);
    if (place.room + 1 == place.end)
      add_wall(label + " east wall", walls, 0, x1, z0, z1, y0, y1, false, plaster);
    furnish(name, add_node(name, -1, {0, 0, 0}), x0, x1, z0, z1, y0, c_.furniture);
    return cell;
  }

  void furnish(const std::string&, int parent, double x0, double x1, double z0, double z1, double y,
               int pieces) {
    constexpr const char* kNames[] = {"table", "chair", "shelf", "plant", "lamp"};
    constexpr double kFromWalls_m = 0.9;
    const double floor = y + c_.wall_m / 2;
    const dvec3 lo(std::min(x0 + kFromWalls_m, 0.5 * (x0 + x1)), floor,
                   std::min(z0 + kFromWalls_m, 0.5 * (z0 + z1))),
        hi(std::max(x1 - kFromWalls_m, 0.5 * (x0 + x1)), floor, std::max(z1 - kFromWalls_m, 0.5 * (z0 + z1)));
    for (int piece = 0; piece < pieces; ++piece) {
      const int kind = piece % 5;
      const vec3 color = kind == 3 ? kLeaves : kind == 4 ? kShade : kWoods[lot_.below(6)];
      const double x = lot_.within(lo.x, hi.x), z = lot_.within(lo.z, hi.z), turn = lot_.within(0, 2 * M_PI);
      add_part(std::string(kNames[kind]) + " " + std::to_string(piece / 5), parent, first_mesh_ + kind, color,
               {x, floor, z}, turn);
    }
  }

  layers::Scene& scene_;
  const BuildingContent& c_;
  Lot lot_;
  int first_mesh_, atrium_first_ = 0, atrium_end_ = 0, atrium_ = -1;
  layers::CellSet cells_;
};

}  // namespace

layers::CellSet add_building(layers::Scene& scene, const BuildingContent& building) {
  return Building(scene, building).build();
}

}  // namespace talisman::sequences
