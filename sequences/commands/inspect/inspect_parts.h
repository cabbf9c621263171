// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman inspect --parts`: the tree of nodes with the names that `parts:` of a layer may say, polygons, sizes and
/// places in metres, textures and where they were found, what is not drawn; and a picture with the axes.

#include <string>

#include "sequences/content/parts/part_tree.h"

namespace talisman::sequences {

/// `id`: how a sequence would call the model, in front of the names of its parts; empty: it is a sequence already.
std::string parts_text(const Sequence& sequence, const PartTree& tree, const std::string& id,
                       const std::string& picture);
std::string parts_json(const Sequence& sequence, const PartTree& tree,
                       const std::string& picture);  ///< schema talisman.parts/1

/// Writes the picture into the file `out` (empty: out/<name>-parts.png) and says the rest. Throws InputError and
/// OutputError.
std::string inspect_parts(const Sequence& sequence, const std::string& out, bool json);

}  // namespace talisman::sequences
