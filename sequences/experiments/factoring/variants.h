// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sequences that differ only in how their shading is factored, and how they are drawn so that nothing else
/// differs: what the factoring experiment compares.

#include <optional>

#include "sequences/experiments/variant.h"

namespace talisman::sequences {

/// Does some layer have a shade layer?
bool is_factored(const Sequence& sequence);

/// The same with every term in the sprite of its surface. Multipliers of textures over time are lost: the
/// renderer knows only Material::texture_blend.
Variant unfactored(const Variant& variant);

/// Does the compositor blend the textures of some layer otherwise than its material says, at some time?
bool blends_over_time(const Sequence& sequence);

/// All factored shadows as `as`. Multiply and Atop: with the extended compositor, and without factored textures in
/// the first case; else with `over` alone. Empty: as the sequence says, but what needs more than `over` as suits the
/// lights.
Variant with_shadows_as(const Variant& variant, std::optional<layers::ShadowsAs> as);

enum class ShadeResolution { Full, Own };

/// Every layer in every frame with its texels on the pixels of the display: all sprites at the display's
/// resolution, without motion blur, not rotated, not compressed; and `over` alone. Shade layers are like
/// their base in all of this, or as coarse as the sequence asks for.
Variant texel_on_pixel(const Variant& variant, ShadeResolution shades);

/// As the sequence places its sprites, every layer in every frame.
Variant without_reuse(const Variant& variant);

}  // namespace talisman::sequences
