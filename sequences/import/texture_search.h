// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which file does a model mean by the name of a buffer or a texture?
///
/// Only files in some trees are opened, after links are resolved: below the model's own folder, below the folder
/// `textures` beside it, below the sequence's folder and below those of --assets. What a model names elsewhere
/// (absolute paths of another machine, "../..") is looked for by its file name in these places.
///
///   1. the path as written, relative to the model; then to each of the further folders
///   2. the file name in the model's folder, ../textures and ./textures; then in each further folder and its
///      ./textures
///   3. textures only, in the same places: in any letter case; then with another extension of a picture; then, for
///      a name of exactly 8 characters as DOS files cut them, the only picture whose name begins so
///
/// A picture of another name is never taken for a missing one.

#include <string>
#include <vector>

#include "layers/scene.h"
#include "sequences/files/file_uses.h"

namespace talisman::sequences {

/// A model, and the further folders in whose trees its files may lie.
struct ModelPlace {
  std::string path;
  std::vector<std::string> folders = {};
};

/// The file by rules 1 and 2; empty if there is none.
/// What was looked for is noted in `files`.
std::string find_file(const ModelPlace& model, const std::string& written, FileUses& files);

/// The picture by all rules; empty if there is none. Files that no extension marks as pictures are not taken.
std::string find_texture(const ModelPlace& model, const std::string& written, FileUses& files);

/// The picture read, with its file's name. Throws InputError.
layers::Texture read_named_texture(const ModelPlace& model, const std::string& written, FileUses& files);

/// Old painters wrote an alpha channel and left it zero, and the formats that name such pictures do not say how alpha is
/// meant: a picture of which every texel is clear is made opaque. Returns the words that say so; empty: it is another.
/// (glTF, images and shapes say how it is meant: there a clear picture is clear.)
std::string without_empty_alpha(layers::Texture& texture);

/// What is said where that fails.
std::string missing_texture(const std::string& written, const std::string& why);

}  // namespace talisman::sequences
