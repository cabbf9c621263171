// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Image files as textures: sRGB bytes, straight alpha, by OpenImageIO.

#include <cstdint>
#include <span>
#include <string>

#include "layers/scene.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Reads an image file into a texture. Throws InputError.
layers::Texture read_texture(const std::string& path);

/// The same from the bytes of an image file. `format` is its usual file extension without the dot ("png",
/// "jpg").
layers::Texture read_texture_from_bytes(std::span<const std::uint8_t> bytes, const std::string& name,
                                        const std::string& format);

/// Is alpha 0 in every texel?
bool is_all_clear(const layers::Texture& texture);

/// Alpha is left out, as where a material says that it has no meaning.
void make_opaque(layers::Texture& texture);

}  // namespace talisman::sequences
