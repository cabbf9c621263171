// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How does a fresh sprite take over from the old one without a step? [LS97 8] names the "popping" of a sprite that is
/// drawn again and leaves the remedy open. Here the two are mixed into a third sprite, which the compositor shows:
///
///   T(x) = (1 - a) · m_old · S_old(M x) + a · m_new · S_new(x)      x in texels of the fresh sprite
///
/// per channel, in premultiplied linear light, alpha like the colours: a mix of two coverages is the coverage of the
/// mix, and nothing is darkened where only one of them has something. M carries a point of the fresh sprite to the old
/// one, where four texels are mixed bilinearly as the compositor does; outside the old sprite is clear. The third sprite
/// has the size of the fresh one: what the old one shows beyond it is cut off.
///
/// It is shown by one placement, that of the fresh sprite. Where the two pictures of an edge do not lie on each other,
/// both are seen, each with its share: an edge that is off by d px is doubled at that distance.

#include "chunker/sprite.h"

namespace talisman::chunker {

/// One of the two sprites that are mixed.
struct FadedSprite {
  const Sprite& sprite;
  layers::vec3 color_multiplier{1, 1, 1};  ///< 0 … 1 per channel
};

/// `share` of the fresh sprite: 0 … 1. `old_from_fresh`: M, homogeneous; a point at or behind its horizon is clear, and
/// so is all of the old sprite where M is not finite. Cost: about 20 ns per texel of the chunks that either holds.
Sprite cross_fade(const FadedSprite& old, const FadedSprite& fresh, const layers::dmat3& old_from_fresh,
                  double share);

}  // namespace talisman::chunker
