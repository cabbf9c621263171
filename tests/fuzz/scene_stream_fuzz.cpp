// SPDX-License-Identifier: Apache-2.0
// Any bytes in the place of the importer's stream. Only InputError may come out, and what is accepted
// survives being evaluated.
#include <cstddef>
#include <cstdint>

#include "sequences/import/scene_stream.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto model = talisman::sequences::model_from_bytes({data, size});
    const auto frame = model.scene.at(0.5);
    for (const auto& part : model.scene.parts) talisman::layers::world_positions(frame, part);
  } catch (const talisman::sequences::InputError&) {
  }
  return 0;
}
