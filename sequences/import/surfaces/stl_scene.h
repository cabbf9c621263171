// SPDX-License-Identifier: Apache-2.0
#pragma once

/// STL files: facets of three places each, flat.
///
///   text      "solid NAME", then "facet normal X Y Z", "vertex X Y Z" three times; every solid is a part
///   binary    80 bytes, a count n, n times 50 bytes: normal, three places, two bytes of attributes
///   normals   those of the places, by their order: what the file says is the same, or rubbish
///   colours   5 bits each in the attributes, in sRGB. VisCAM: bit 15 set, then red, green, blue from the high bits down.
///             Materialise, whose header has "COLOR=" and the colour of all else: bit 15 clear, then from the low bits up
///
/// Source: 3D Systems, "StereoLithography Interface Specification" (1989); Materialise, "Magics STL colours".

#include <string>

#include "sequences/import/model_import.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

bool is_stl(const std::string& path);

/// Reads the file. Throws InputError without the file's name.
ImportedModel read_stl(const ModelPlace& place);

}  // namespace talisman::sequences
