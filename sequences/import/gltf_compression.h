// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do the compressed parts of a glTF file hold?
///
///   EXT_meshopt_compression      bytes of a buffer view: attributes, triangles or index sequences, filtered or not.
///                                Codec versions: attributes 0, triangles and sequences 0 and 1. The buffer that the
///                                view names itself is only for readers without the extension, and is not read.
///   KHR_draco_mesh_compression   attributes and indices of a primitive; every attribute that it names takes the
///                                place of that accessor's content

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "sequences/import/gltf_accessors.h"
#include "sequences/import/gltf_json.h"

namespace talisman::sequences {

/// The bytes of a view whose extension is `meshopt`, of `length` bytes decoded; `source` is what the extension
/// points to. Throws InputError for anything that does not fit or is damaged.
std::vector<std::uint8_t> decoded_meshopt(const Json& meshopt, std::span<const std::uint8_t> source,
                                          std::size_t length);

struct DracoMesh {
  std::map<int, Accessed> accessors;   ///< by accessor, in place of its own content
  std::vector<std::uint32_t> indices;  ///< three per triangle
};

/// The content of a primitive's extension `draco`. Throws InputError likewise.
DracoMesh decoded_draco(GltfFile& file, const Json& primitive, const Json& draco);

}  // namespace talisman::sequences
