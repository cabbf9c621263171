// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The room of tests/support/room.h as a sequence, for what runs on whole sequences.

#include <memory>

#include "sequences/content/sequence.h"
#include "tests/sequences/room_show.h"

namespace talisman::tests {

inline sequences::Sequence sequence_of(const Room& room, int frames) {
  sequences::Sequence sequence;
  sequence.name = "room";
  sequence.frames = frames;
  sequence.display_px = {160, 120};
  sequence.layer_specs = room.specs;
  sequence.layers = factor(room.scene, room.specs);
  sequence.scene = std::make_shared<const Scene>(room.scene);
  return sequence;
}

/// A floor that is smaller than the ball's shadow on it, so that the shadow falls across its edges: the place
/// where `over` cannot multiply.
inline Room small_floor(Room room) {
  room.scene.nodes[0].local.scale = dvec3(0.12);
  return room;
}

}  // namespace talisman::tests
