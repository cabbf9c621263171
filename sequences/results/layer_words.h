// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A layer's name in a table, and in the name of a file.

#include <string>

namespace talisman::sequences {

/// As wide as a column of tables, 24 characters: cut off with "..." or filled up with spaces. Names are UTF-8 and are
/// not cut inside a character.
std::string column_of(const std::string& layer);

/// "wall-shadow of sun.png" of "wall/shadow of sun"; of a frame "0017-wall-shadow of sun.png".
std::string picture_of(std::string layer);
std::string picture_of(int frame, const std::string& layer);

}  // namespace talisman::sequences
