// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sequences.h"

#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

sequences::Sequence sequence_of(const char* name, layers::Scene scene, int frames) {
  sequences::Sequence sequence;
  sequence.name = name;
  sequence.frames = frames;
  sequence.display_px = {96, 72};
  sequence.layers = layers::factor(scene, one_layer_per_part(scene));
  sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  return sequence;
}

}  // namespace

sequences::Sequence moving_sequence(int frames) { return sequence_of("moving", moving_scene(), frames); }
sequences::Sequence resting_sequence(int frames) { return sequence_of("resting", cube_scene(), frames); }

}  // namespace talisman::tests
