// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which numbers does a glTF accessor hold? (glTF 2.0, 3.6.2)
///
///   component types  5120 … 5126: int8, uint8, int16, uint16, uint32, float
///   normalised       unsigned c / max, signed max(c / max, -1): 127, 255, 32767, 65535
///   matrices         column by column, each column begins at a multiple of 4 bytes
///   sparse           values that replace those of the view (or zeros without one), at indices that increase
///
/// Every offset, stride, count and index is checked against the bytes there are.

#include <vector>

#include "sequences/import/gltf_json.h"

namespace talisman::sequences {

/// What stands in GltfFile::decoded, or what the accessor's view holds. Throws InputError for anything that does not
/// fit. Cost: O(count).
Accessed read_accessor(GltfFile& file, int index);

/// The number at `from` of a component type, normalised if wished.
double component_value(int type, bool normalized, const std::uint8_t* from);

/// The same, with a number of components that must be one of two.
Accessed read_accessor(GltfFile& file, int index, const char* what, int components, int or_components = 0);

}  // namespace talisman::sequences
