// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which file does a model mean by the name of a buffer or a texture?
///
/// Only files below the model's own folder, or below the folder `textures` beside it, are opened, after links are
/// resolved. What a model names elsewhere (absolute paths of another machine, "../..") is looked for by its file
/// name in these places.
///
///   1. the path as written, relative to the model
///   2. the file name in the model's folder, ../textures and ./textures
///   3. textures only, in the same places: in any letter case; then with another extension of a picture; then, for
///      a name of exactly 8 characters as DOS files cut them, the only picture whose name begins so
///
/// A picture of another name is never taken for a missing one.

#include <string>

#include "sequences/files/file_uses.h"

namespace talisman::sequences {

/// The file by rules 1 and 2; empty if there is none.
/// What was looked for is noted in `files`.
std::string find_file(const std::string& model_path, const std::string& written, FileUses& files);

/// The picture by all rules; empty if there is none. Files that no extension marks as pictures are not taken.
std::string find_texture(const std::string& model_path, const std::string& written, FileUses& files);

}  // namespace talisman::sequences
