// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an image shows over the time of its sequence: frames that are asked for, and no others.

#include <string>
#include <vector>

#include "sequences/content/images/image_recipe.h"

namespace talisman::sequences {

struct PictureSource {
  layers::MovingPicture timing;           ///< without textures; frame_count 1: it stands still
  std::vector<layers::Texture> textures;  ///< of timing.frames; of what stands still the only one
  std::vector<std::string> files;         ///< that were read
  std::vector<std::string> warnings;
  std::vector<std::string> notes;  ///< that its last frame holds
};

/// Throws InputError: a file that cannot be read, more than 1 GiB of frames.
PictureSource read_source(const ImageRecipe& image, const ShownTimes& times);

}  // namespace talisman::sequences
