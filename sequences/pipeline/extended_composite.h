// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a compositor show that can evaluate expressions? The pixels of the profile `extended`: slow and
/// obvious, on whole images of 16-bit premultiplied linear colour, where one is kOne [Snyder & Lengyel 1998].
///
///   A over B = A + (1-a) B      A atop B = b A + (1-a) B      A out B = (1-b) A      A plus B = A + B
///
/// per channel, alpha included, each product rounded to nearest, sums saturated at kOne. A pixel that sprites
/// cover in full comes out without any rounding. Sprites that belong to no cycle are composited as ever
/// (chunker/composite.h); the picture of an expression is laid `over` what is behind it.
///
/// A surface whose shadows are to be multiplied or laid atop (layers/shading.h) is put together with its shade
/// layers in a register of its own, back to front, and laid over what is behind it when it is done:
///
///   A over R      as ever               s * R = [s R, α_R]  per channel, where s has no texel it is 1
///   A atop R
///
/// so no shadow ever darkens what is behind the surface.
///
/// What hardware would need for it: the operators out and plus (or atop) beside over; two registers of the
/// size of the picture, or of a band, three to be quick; and each sprite read as often as the expression
/// names it. This model keeps whole images and takes some ten milliseconds for each read at a megapixel: its
/// time says nothing about such hardware.

#include <span>
#include <vector>

#include "chunker/composite.h"
#include "sequences/pipeline/frame_order.h"
#include "sequences/pipeline/layer_table.h"

namespace talisman::sequences {

/// What a sprite does to the register of its surface.
enum class Use { Over, Multiply, Atop };
Use use_of(const layers::Layer& layer);

/// Does some layer need a register for its shadows?
bool any_registers(const LayerTable& layers);

/// A sprite and whose it is.
struct LayerSprite {
  int layer = -1;
  chunker::PlacedSprite placed;
  int base = -1;  ///< of a shade layer: its surface
  Use use = Use::Over;
};

/// `left op right`, pixel by pixel; both of one size. `op` is not Layer.
chunker::Frame combine(layers::CompositeExpression::Operator op, const chunker::Frame& left,
                       const chunker::Frame& right);

/// Sprites back to front over `background`; those of a cycle of `order` side by side. A layer of an
/// expression that shows no sprite is clear. The counters count every read of a sprite. Cost: reads × pixels.
chunker::CompositeResult composite_extended(std::span<const LayerSprite> sprites, const FrameOrder& order,
                                            layers::ivec2 display_px, layers::vec3 background);

}  // namespace talisman::sequences
