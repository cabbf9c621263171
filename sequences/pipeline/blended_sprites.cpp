// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/blended_sprites.h"

#include "chunker/cross_fade.h"

namespace talisman::sequences {

BlendedSprites blended_sprites(const PipelineState& state, const FrameReport& report) {
  BlendedSprites blended;
  for (const ShownSprite& shown : report.shown) {
    if (!shown.old) continue;
    const layers::vec3 color(report.plan.decisions[shown.layer].shown_color);
    const layers::dmat3 old_from_fresh =
        glm::inverse(shown.old->screen_from_sprite) * shown.screen_from_sprite;
    blended[shown.layer] =
        chunker::cross_fade({*state.fading_sprites.find(shown.layer), layers::vec3(shown.old->color)},
                            {*state.sprites.find(shown.layer), color}, old_from_fresh, 1 - shown.old->share);
  }
  return blended;
}

chunker::PlacedSprite placed_sprite(const ShownSprite& shown, const chunker::SpriteStore& sprites,
                                    const BlendedSprites& blended) {
  chunker::PlacedSprite placed;
  placed.sprite = shown.old ? &blended.at(shown.layer) : sprites.find(shown.layer);
  placed.screen_from_sprite = shown.screen_from_sprite;
  placed.alpha_multiplier = shown.multipliers.alpha;
  placed.color_multiplier = shown.multipliers.color;
  return placed;
}

}  // namespace talisman::sequences
