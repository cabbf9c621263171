// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sequences that differ only in how their shading is factored, and how they are drawn so that nothing else
/// differs: what the factoring experiment compares.

#include "sequences/sequence.h"
#include "sequences/step.h"

namespace talisman::sequences {

/// Does some layer have a shade layer?
bool is_factored(const Sequence& sequence);

/// The same with every term in the sprite of its surface. Multipliers of textures over time are lost: the
/// renderer knows only Material::texture_blend.
Sequence unfactored(const Sequence& sequence);

/// Where the textures of a factored layer are blended otherwise than its material says, at some time.
bool blends_over_time(const Sequence& sequence);

enum class ShadeResolution { Full, Own };

/// All sprites at the display's resolution and without motion blur; those of shade layers too, and like their
/// base in all else, or as coarse as the sequence asks for.
Sequence at_full_resolution(const Sequence& sequence, ShadeResolution shades);

/// Every layer in every frame, its texels on the pixels of the display where its resolution is full: no
/// rotated sprites, no compression, and `over` alone.
Settings texel_on_pixel(const Settings& settings);

/// As the sequence places its sprites, every layer in every frame.
Settings without_reuse(const Settings& settings);

}  // namespace talisman::sequences
