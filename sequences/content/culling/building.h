// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A building of rooms along corridors, with its cells and portals: the content of [Fu93], by numbers.
///
/// A corridor runs along x on each storey, with rooms on both sides, each with an open door to it, and every third with one to
/// its neighbour. An atrium in the middle takes up the place of some rooms on both sides, over all storeys; the corridors
/// open onto it. Walls, floors and ceilings are boxes around the planes between cells, with holes at the doors, so that
/// nobody sees through those planes elsewhere. Cells are the rooms, the two ends of each corridor, whole or
/// in pieces, and the atrium.
///
/// Every room is furnished by lot with tables, chairs, shelves, plants and lamps: instances of a few meshes. Parts are called
/// "storey 0/room 3 left/chair 2"; walls "storey 0/walls/…". Rooms are top-level nodes, so that each is a
/// layer where a file asks for none. The same seed gives the same building on every machine.

#include <cstdint>

#include "layers/cells.h"
#include "layers/scene.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

struct BuildingContent {
  int storeys = 2;             ///< 1 … 20
  int rooms = 8;               ///< 1 … 200; along each side of a corridor
  int atrium_rooms = 2;        ///< 0 … rooms; whose place the atrium takes up, in the middle; 0: none
  layers::dvec2 room_m{5, 6};  ///< > 1.5; along the corridor, across it
  double height_m = 3;         ///< > 2.4; of a storey
  double corridor_m = 2.4;     ///< > 1.5; its width
  int corridor_rooms = 0;      ///< 0 … 200; a cell of a corridor is so many rooms long; 0: all of a wing
  double wall_m = 0.2;         ///< thickness of walls and floors
  int furniture = 8;           ///< 0 … 1000; pieces in a room
  std::uint32_t seed = 1;
};

const Table<BuildingContent>& building_keys();

/// Adds its parts to the scene and returns its cells, which have no defect.
layers::CellSet add_building(layers::Scene& scene, const BuildingContent& building);

}  // namespace talisman::sequences
