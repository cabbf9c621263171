// SPDX-License-Identifier: Apache-2.0
#pragma once

/// By how much does a frame of factored layers differ from the unfactored one, and how much of that is
/// rounding? All sprites texel on pixel, drawn for this frame.
///
/// A layer's unfactored picture is [U, β], in one pass by the definition (chunker/shade.h). Back to front, with m the fade of the layer,
/// T the true frame so far and E the error of the factored frame so far, per pixel and channel in linear
/// light:
///
///   T ← m U + (1 - m β) T                         one sprite holds 0 … 1: U counts as min(U, 1)
///   E ← E Π(1 - α_i) + m βB (Π(1 - m A_l) - Π s_l) + (1 - m β) T (Π(1 - m A_l) - 1) + rest
///
/// α_i: of all the layer's sprites. With one shadow and m = 1 the second and third term together are the
/// paper's β (1 - β)(1 - s)(B - T) [LS97 appendix], T being what really lies behind; the first says that what
/// covers an error in front hides it in proportion, and that a shadow darkens it too. `rest` is what the
/// formula does not know: a term that the author left in the base under a factored shadow is darkened with
/// it, which dims a highlight by s where the light's visibility should; several shadows multiply where lights
/// add; a shadow is one number for three channels, and for all samples of a texel; and 8 bits hold no more
/// than 1 in each sprite. It is what exact arithmetic gives on the same sprites beyond the formula: zero to 1e-6
/// for shadows as light, and, with one light and ambient light of its hue, for layers that factor all of their
/// terms, where no texel is mixed.
///
/// Rounding bound D of |frame - (T + E)|, from half steps alone:
///
///   sprite   colour v is held as round(255 √v)²:  δ = 2 √v / 510 + 1 / 510²,  0 where v is 0 or 1
///            alpha in 255 steps:                  δα = 1 / 510,               0 where α is 0 or 1
///   over     D ← δ m + D (1 - m α) + (C + D) (δα m) + h,   h = 1 / 130050, half a step of 16 bits;
///            one h more for colour, and one for alpha times (C + D), where a multiplier is not 1; C: the
///            factored frame so far
///
/// It is compared before the frame is encoded to sRGB bytes, which is monotonic and adds half a code value.

#include <cstdint>
#include <vector>

#include "chunker/composite.h"
#include "chunker/multipass.h"

namespace talisman::sequences {

/// One sprite of a factored layer as it is before it is encoded.
struct TermSprite {
  layers::LayerKind kind = layers::LayerKind::Geometry;
  chunker::LinearImage image;
  layers::vec3 gain{1, 1, 1};  ///< multiplier of its colour alone
};

/// What lies side by side in the order: a layer with its shade layers.
struct ShadedLayer {
  int layer = -1;                 ///< id of the base, or of an aggregate
  layers::ivec2 origin_px{0, 0};  ///< the display's pixel under its first texel
  float fade = 1;                 ///< multiplier of all four channels of all its sprites
  /// Of a layer without shade layers: its sprite, which is its own truth.
  const chunker::Sprite* sprite = nullptr;
  /// Of one that has some: its sprites in the order of the compositor, its surface (the formula's [βB, β]),
  /// and U. All of one size.
  std::vector<TermSprite> terms;
  chunker::LinearImage surface, unfactored;

  bool factors() const { return !terms.empty(); }
  layers::ivec2 size_px() const { return factors() ? unfactored.size_px : sprite->size_px(); }
};

/// Linear light, 1: white.
struct PixelPrediction {
  layers::dvec3 truth{0, 0, 0};  ///< T
  layers::dvec3 over{0, 0, 0};   ///< E by the formula
  layers::dvec3 rest{0, 0, 0};   ///< E beyond it
  layers::dvec3 bound{0, 0, 0};  ///< D
  layers::dvec3 error() const { return over + rest; }
};

struct FramePrediction {
  layers::ivec2 size_px{0, 0};
  std::vector<PixelPrediction> pixels;  ///< row by row
};

/// Which layers are shown factored; the others show their unfactored picture, in one sprite.
using FactoredMask = std::vector<bool>;

/// `layers` back to front, `factored` as many. Cost: O(texels · sprites).
FramePrediction predict_frame(std::span<const ShadedLayer> layers, const FactoredMask& factored,
                              layers::ivec2 display_px, layers::vec3 background);

/// The same layers by the compositor itself, with sprites of four bytes.
chunker::Frame composite_layers(std::span<const ShadedLayer> layers, const FactoredMask& factored,
                                layers::ivec2 display_px, layers::vec3 background);

/// The true frame as a picture.
chunker::Frame frame_of_truth(const FramePrediction& prediction);

/// A pixel of a frame, linear light.
layers::dvec3 linear_of(const chunker::Linear16& pixel);

}  // namespace talisman::sequences
