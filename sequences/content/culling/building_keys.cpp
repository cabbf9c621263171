// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/culling/building.h"

namespace talisman::sequences {

const Table<BuildingContent>& building_keys() {
  using B = BuildingContent;
  static const Table<B> table =
      Table<B>("building")
          .key("storeys", &B::storeys, whole(1, 20), "", "one above the other")
          .key("rooms", &B::rooms, whole(1, 200), "", "along each side of a storey's corridor")
          .key("atrium_rooms", &B::atrium_rooms, whole(0, 200), "",
               "whose place in the middle of all storeys the atrium takes up; 0: none")
          .key("room", &B::room_m, pair({1.5, 1000}), "m", "along the corridor, across it")
          .key("height_m", &B::height_m, number({2.4, 100}), "m", "of a storey")
          .key("corridor_m", &B::corridor_m, number({1.5, 100}), "m", "its width")
          .key("corridor_rooms", &B::corridor_rooms, whole(0, 200), "",
               "a cell of a corridor is so many rooms long; 0: all of its wing")
          .key("wall_m", &B::wall_m, number({0.01, 0.5}), "m", "thickness of walls and floors")
          .key("furniture", &B::furniture, whole(0, 1000), "", "pieces in a room")
          .key("seed", &B::seed, whole(0, 2'000'000'000), "", "of all that is random")
          .rule("atrium_rooms at most rooms", [](const B& b) { return b.atrium_rooms <= b.rooms; });
  return table;
}

}  // namespace talisman::sequences
