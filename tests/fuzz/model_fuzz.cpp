// SPDX-License-Identifier: Apache-2.0
// Any bytes in the place of a model: what the importer does in a process of its own, here in this one. The first byte says
// which reader: glTF, GLB, OBJ with its materials behind a zero byte, STL, PLY. Only an error in words may come out; what is
// accepted goes through the scene stream, as it would between the two processes, and can be evaluated.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>

#include "sequences/import/gltf_scene.h"
#include "sequences/import/scene_stream.h"
#include "sequences/import/surfaces/obj_scene.h"
#include "sequences/import/surfaces/ply_scene.h"
#include "sequences/import/surfaces/stl_scene.h"
#include "tests/fuzz/file_of_bytes.h"

namespace {

using namespace talisman::sequences;

ImportedModel read_any(int kind, const std::uint8_t* data, std::size_t size) {
  using talisman::fuzz::file_of_bytes;
  if (kind == 0) return read_gltf({file_of_bytes("a.gltf", data, size)});
  if (kind == 1) return read_gltf({file_of_bytes("a.glb", data, size)});
  if (kind == 3) return read_stl({file_of_bytes("a.stl", data, size)});
  if (kind == 4) return read_ply({file_of_bytes("a.ply", data, size)});
  const std::uint8_t *end = data + size, *zero = std::find(data, end, 0);
  const std::uint8_t* materials = zero == end ? end : zero + 1;
  file_of_bytes("a.mtl", materials, static_cast<std::size_t>(end - materials));
  return read_obj({file_of_bytes("a.obj", data, static_cast<std::size_t>(zero - data))});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  ImportedModel read;
  try {
    read = read_any(data[0] % 5, data + 1, size - 1);
  } catch (const std::exception&) {  // the importer prints it
    return 0;
  }
  ImportedModel model;
  try {
    model = model_from_bytes(bytes_from_model(read));
  } catch (const InputError&) {
    if (talisman::layers::first_defect(read.scene).empty()) std::abort();  // its own stream of a right scene
    return 0;  // the tool refuses the model in the words of the defect
  }
  const auto frame = model.scene.at(0.5);
  for (const auto& part : model.scene.parts) talisman::layers::world_positions(frame, part);
  return 0;
}
