// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Puts pictures, sequences of pictures and videos into a scene: each as an unlit rectangle of two triangles, which
/// stands in the world or moves with the camera, or in place of the textures of parts.
///
/// On the screen. The rectangle is carried by the camera, just beyond its near plane, or behind everything ten times as
/// far as its far plane: at the depth d (metres along the view axis) a pixel of the file's display is
/// 2 d tan(fov / 2) / height metres. So it stands still on the display, however the camera moves. Of several each lies
/// before those that the file has before it.

#include "layers/layer.h"
#include "sequences/content/images/image_recipe.h"
#include "sequences/content/scene_builder.h"

namespace talisman::sequences {

/// Those in the world and on parts: before the camera, which may have to look at them. Throws InputError.
void add_images_in_world(BuiltScene& built, const std::vector<ImageRecipe>& images, const ShownTimes& times);

/// Those on the screen: the scene has its camera. Throws InputError.
void add_images_on_screen(BuiltScene& built, const std::vector<ImageRecipe>& images, const ShownTimes& times);

/// Gives each rectangle that no layer takes a layer of its own, of the same name; those on the screen the group
/// that their place asks for.
void add_image_layers(const std::vector<ImageRecipe>& images, std::vector<layers::LayerSpec>& specs);

}  // namespace talisman::sequences
