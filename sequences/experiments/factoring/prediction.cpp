// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/factoring/prediction.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <tbb/parallel_for.h>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

using chunker::kOne;
using chunker::LinearColor;
using layers::dvec3;
using layers::ivec2;
using layers::LayerKind;
using layers::vec3;

constexpr double kHalf = 0.5 / kOne;
/// The square root of a colour is taken in single precision, and terms are blended in it.
constexpr double kSingle = 1e-6;

double color_step(double v) {
  constexpr double kHalfByte = 1.0 / 510;
  return v <= 0 || v >= 1 ? 0 : 2 * std::sqrt(v) * kHalfByte + kHalfByte * kHalfByte;
}
double alpha_step(double a) { return a <= 0 || a >= 1 ? 0 : 1.0 / 510; }

dvec3 color_of(const LinearColor& c) { return {c.r, c.g, c.b}; }
dvec3 at_most_one(const dvec3& c) { return glm::min(c, dvec3(1)); }

/// One sprite at one pixel.
struct Laid {
  dvec3 color{0, 0, 0};  ///< premultiplied, 0 … 1, before the multipliers
  double alpha = 0;
  dvec3 color_step{0, 0, 0};  ///< largest rounding of both
  double alpha_step = 0;
};

Laid encoded(const LinearColor& c) {
  const dvec3 color = at_most_one(color_of(c));
  return {color, c.a, {color_step(color.x), color_step(color.y), color_step(color.z)}, alpha_step(c.a)};
}

/// Already encoded: nothing more is rounded.
Laid decoded(chunker::Texel texel) {
  const chunker::Linear16 c = chunker::decode(texel);
  return {linear_of(c), static_cast<double>(c.a) / kOne, dvec3(0), 0};
}

/// A pixel of the compositor in exact arithmetic, and how far its 16 bits may be from that.
struct Canvas {
  dvec3 color{0, 0, 0};
  dvec3 bound{0, 0, 0};

  void lay(const Laid& sprite, const vec3& gain, double fade) {
    const dvec3 multiplier = dvec3(gain) * fade;
    const bool multiplied = multiplier != dvec3(1);
    const double alpha = fade * sprite.alpha;
    const double alpha_off = fade * sprite.alpha_step + (multiplied ? 2 * kHalf : 0);
    bound = multiplier * sprite.color_step + bound * (1 - alpha) + (color + bound) * alpha_off +
            dvec3(kHalf + kSingle + (multiplied ? 2 * kHalf : 0));
    color = at_most_one(multiplier * sprite.color + color * (1 - alpha));
  }
};

/// What the formula says of one texel, and how much light from behind the layer's sprites let through.
struct Formula {
  dvec3 over{0, 0, 0};
  double through = 1;
};

Formula formula_at(const ShadedLayer& layer, int x, int y, const dvec3& behind) {
  Formula formula;
  std::vector<float> shadows;
  for (const TermSprite& term : layer.terms) {
    const float alpha = term.image.at(x, y).a;
    formula.through *= 1 - static_cast<double>(layer.fade) * alpha;
    if (term.kind == LayerKind::Shadow) shadows.push_back(alpha);
  }
  if (!shadows.empty())
    formula.over = color_of(
        chunker::predicted_factoring_error(layer.surface.at(x, y), shadows, vec3(behind), layer.fade));
  return formula;
}

/// Lays one layer over one pixel: the sprites that are shown, and the truth.
void lay_factored(const ShadedLayer& layer, int x, int y, PixelPrediction& pixel) {
  const Formula formula = formula_at(layer, x, y, pixel.truth);
  Canvas shown{pixel.truth + pixel.error(), pixel.bound}, truth{pixel.truth, {}};
  for (const TermSprite& term : layer.terms) shown.lay(encoded(term.image.at(x, y)), term.gain, layer.fade);
  truth.lay(encoded(layer.unfactored.at(x, y)), vec3(1), layer.fade);
  pixel.over = pixel.over * formula.through + formula.over;
  pixel.truth = truth.color;
  pixel.rest = shown.color - truth.color - pixel.over;
  pixel.bound = shown.bound;
}

void lay_whole(const Laid& sprite, double fade, PixelPrediction& pixel) {
  Canvas shown{pixel.truth + pixel.error(), pixel.bound}, truth{pixel.truth, {}};
  shown.lay(sprite, vec3(1), fade);
  truth.lay(sprite, vec3(1), fade);
  pixel.over *= 1 - fade * sprite.alpha;
  pixel.truth = truth.color;
  pixel.rest = shown.color - truth.color - pixel.over;
  pixel.bound = shown.bound;
}

void lay_row(const ShadedLayer& layer, bool factored, int row, FramePrediction& frame) {
  const int y = row - layer.origin_px.y;
  const ivec2 size = layer.size_px();
  if (y < 0 || y >= size.y) return;
  const int first = std::max(layer.origin_px.x, 0);
  const int end = std::min(layer.origin_px.x + size.x, frame.size_px.x);
  for (int column = first; column < end; ++column) {
    const int x = column - layer.origin_px.x;
    PixelPrediction& pixel = frame.pixels[static_cast<std::size_t>(row) * frame.size_px.x + column];
    if (!layer.factors())
      lay_whole(decoded(layer.sprite->texel(x, y)), layer.fade, pixel);
    else if (!factored)
      lay_whole(encoded(layer.unfactored.at(x, y)), layer.fade, pixel);
    else
      lay_factored(layer, x, y, pixel);
  }
}

chunker::PlacedSprite placed(const ShadedLayer& layer, const chunker::Sprite* sprite, const vec3& gain) {
  chunker::PlacedSprite p;
  p.sprite = sprite;
  p.screen_from_sprite[2] = {layer.origin_px.x, layer.origin_px.y, 1};
  p.alpha_multiplier = layer.fade;
  p.color_multiplier = gain;
  return p;
}

}  // namespace

dvec3 linear_of(const chunker::Linear16& pixel) { return dvec3(pixel.r, pixel.g, pixel.b) / double(kOne); }

FramePrediction predict_frame(std::span<const ShadedLayer> layers, const FactoredMask& factored,
                              ivec2 display_px, vec3 background) {
  TALISMAN_CHECK_EQ(layers.size(), factored.size());
  FramePrediction frame{display_px, {}};
  frame.pixels.resize(static_cast<std::size_t>(display_px.x) * display_px.y);
  for (PixelPrediction& pixel : frame.pixels) {
    pixel.truth = glm::clamp(dvec3(background), dvec3(0), dvec3(1));
    pixel.bound = dvec3(kHalf);
  }
  tbb::parallel_for(0, display_px.y, [&](int row) {
    for (std::size_t i = 0; i < layers.size(); ++i) lay_row(layers[i], factored[i], row, frame);
  });
  return frame;
}

chunker::Frame composite_layers(std::span<const ShadedLayer> layers, const FactoredMask& factored,
                                ivec2 display_px, vec3 background) {
  std::deque<chunker::Sprite> sprites;  // those that are made here stay where they are
  std::vector<chunker::PlacedSprite> all;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const ShadedLayer& layer = layers[i];
    if (!layer.factors()) {
      all.push_back(placed(layer, layer.sprite, vec3(1)));
    } else if (!factored[i]) {
      all.push_back(placed(layer, &sprites.emplace_back(encode_sprite(layer.unfactored)), vec3(1)));
    } else {
      for (const TermSprite& term : layer.terms)
        all.push_back(placed(layer, &sprites.emplace_back(encode_sprite(term.image)), term.gain));
    }
  }
  return chunker::composite(all, display_px, background).frame;
}

chunker::Frame frame_of_truth(const FramePrediction& prediction) {
  chunker::Frame frame{prediction.size_px.x, prediction.size_px.y, {}};
  const auto fixed = [](double v) { return static_cast<std::uint16_t>(v * kOne + 0.5); };
  for (const PixelPrediction& pixel : prediction.pixels)
    frame.pixels.push_back(
        {fixed(pixel.truth.x), fixed(pixel.truth.y), fixed(pixel.truth.z), static_cast<std::uint16_t>(kOne)});
  return frame;
}

}  // namespace talisman::sequences
