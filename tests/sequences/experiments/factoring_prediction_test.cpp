// SPDX-License-Identifier: Apache-2.0
// The predicted error of a frame of factored layers: by hand, and against the compositor on random layers.
#include "sequences/experiments/factoring/prediction.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

using chunker::LinearColor;
using chunker::LinearImage;
using chunker::ShadeTerm;
using layers::dvec3;
using layers::ivec2;
using layers::LayerKind;
using layers::vec3;

LinearImage image_of(ivec2 size, const LinearColor& color) {
  LinearImage image;
  image.size_px = size;
  image.texels.assign(static_cast<std::size_t>(size.x) * size.y, color);
  return image;
}

/// A layer that factors all of its terms: U is made of the very images that are its sprites.
ShadedLayer all_factored(const LinearImage& base, const std::vector<LinearImage>& shadows,
                         const LinearImage& specular) {
  std::vector<chunker::TermImage> terms{{ShadeTerm::Base, -1, base}};
  ShadedLayer layer;
  layer.layer = 0;
  layer.terms.push_back({LayerKind::Geometry, base, vec3(1)});
  for (const LinearImage& shadow : shadows) {
    terms.push_back({ShadeTerm::Shadow, 0, shadow});
    layer.terms.push_back({LayerKind::Shadow, shadow, vec3(1)});
  }
  terms.push_back({ShadeTerm::Specular, -1, specular});
  layer.terms.push_back({LayerKind::Specular, specular, vec3(1)});
  layer.surface = base;
  layer.unfactored = chunker::blend_terms(terms);
  return layer;
}

ShadedLayer one_texel(const LinearColor& base, float shadow, float specular = 0) {
  return all_factored(image_of({1, 1}, base), {image_of({1, 1}, {0, 0, 0, shadow})},
                      image_of({1, 1}, {specular, specular, specular, 0}));
}

constexpr vec3 kBehind{0.1f, 0.3f, 0.05f};

PixelPrediction predicted(const std::vector<ShadedLayer>& layers, bool factored = true) {
  return predict_frame(layers, FactoredMask(layers.size(), factored), {1, 1}, kBehind).pixels[0];
}

TEST(PredictFrame, HalfCoverInHalfShadowIsThePapersFormula) {
  // β (1-β)(1-s)(B - G) = ½ · ½ · ½ · (0.6 - 0.1) in red; A = (1-s) β = ¼, premultiplied colour 0.3.
  const PixelPrediction pixel = predicted({one_texel({0.3f, 0.3f, 0.3f, 0.5f}, 0.25f)});
  EXPECT_NEAR(pixel.over.x, 0.0625, 1e-7);
  EXPECT_NEAR(pixel.over.y, 0.125 * (0.6 - 0.3), 1e-7);
  EXPECT_NEAR(pixel.rest.x, 0, 1e-7);
  EXPECT_NEAR(pixel.truth.x, 0.5 * 0.3 + 0.5 * 0.1, 1e-7);
}

TEST(PredictFrame, NothingIsPredictedWhereTheFormulaVanishes) {
  for (const auto& layer : {one_texel({0.3f, 0.3f, 0.3f, 1}, 0.5f),          // whole cover
                            one_texel({0.3f, 0.3f, 0.3f, 0.5f}, 0),          // no shadow
                            one_texel({0.05f, 0.15f, 0.025f, 0.5f}, 0.25f),  // the background's colour
                            one_texel({0, 0, 0, 0}, 0)}) {
    const PixelPrediction pixel = predicted({layer});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel.error()[c], 0, 1e-7);
  }
}

TEST(PredictFrame, UnfactoredLayersHaveNoError) {
  const PixelPrediction pixel = predicted({one_texel({0.3f, 0.3f, 0.3f, 0.5f}, 0.25f)}, false);
  EXPECT_EQ(pixel.error(), dvec3(0));
}

TEST(PredictFrame, WhatCoversTheErrorHidesItInProportion) {
  const ShadedLayer behind = one_texel({0.3f, 0.3f, 0.3f, 0.5f}, 0.25f);
  const double alone = predicted({behind}).error().x;
  EXPECT_NEAR(predicted({behind, one_texel({0.1f, 0.1f, 0.1f, 0.75f}, 0)}).error().x, 0.25 * alone, 1e-7);
  EXPECT_NEAR(predicted({behind, one_texel({0.1f, 0.1f, 0.1f, 1}, 0)}).error().x, 0, 1e-7);
}

TEST(PredictFrame, FadeScalesCoverAndShadow) {
  ShadedLayer layer = one_texel({0.3f, 0.3f, 0.3f, 1}, 0.5f);  // whole cover, but half faded
  layer.fade = 0.5f;
  // m A (1 - m β)(B - G) = ½ · ½ · ½ · (0.3 - 0.1)
  EXPECT_NEAR(predicted({layer}).error().x, 0.025, 1e-7);
  layer.fade = 0;
  EXPECT_EQ(predicted({layer}).error(), dvec3(0));
  EXPECT_NEAR(predicted({layer}).truth.x, kBehind.x, 1e-7);
}

TEST(PredictFrame, HighlightLeftUnderAShadowIsTheRest) {
  // The base holds 0.2 of base and 0.3 of highlight; the light is blocked, so that the truth has none of it.
  ShadedLayer layer = one_texel({0.2f, 0.2f, 0.2f, 1}, 0.5f);
  layer.terms[0].image = image_of({1, 1}, {0.5f, 0.5f, 0.5f, 1});
  const PixelPrediction pixel = predicted({layer});
  EXPECT_NEAR(pixel.over.x, 0, 1e-7);
  EXPECT_NEAR(pixel.rest.x, 0.5 * 0.3, 1e-6);  // s · highlight is left
}

TEST(PredictFrame, ShadowOfWhatIsBrighterThanWhiteIsTooDark) {
  // A sprite holds at most 1: 0.5 · 1 is shown where 0.5 · 1.6 is right.
  const PixelPrediction pixel = predicted({one_texel({1.6f, 0.5f, 0.5f, 1}, 0.5f)});
  EXPECT_NEAR(pixel.error().x, 0.5 - 0.8, 1e-6);
  EXPECT_NEAR(pixel.error().y, 0, 1e-6);
}

TEST(PredictFrame, LayersOutsideTheDisplayDoNothing) {
  ShadedLayer layer = one_texel({0.3f, 0.3f, 0.3f, 0.5f}, 0.25f);
  for (const ivec2 origin : {ivec2{-1, 0}, ivec2{1, 0}, ivec2{0, -1}, ivec2{0, 1}, ivec2{-1000000, 5}}) {
    layer.origin_px = origin;
    EXPECT_EQ(predicted({layer}).error(), dvec3(0));
  }
}

/// Random layers: cover, shadows and highlights with many values that are exactly 0 or 1, some above.
class RandomLayers {
 public:
  explicit RandomLayers(unsigned seed) : random_(seed) {}

  ShadedLayer next() {
    const ivec2 size{8, 8};
    LinearImage base = image_of(size, {}), specular = base;
    std::vector<LinearImage> shadows(std::uniform_int_distribution(1, 2)(random_), base);
    for (std::size_t i = 0; i < base.texels.size(); ++i) {
      const float cover = edge();
      base.texels[i] = {cover * color(), cover * color(), cover * color(), cover};
      for (LinearImage& shadow : shadows) shadow.texels[i].a = cover * edge();
      specular.texels[i] = {cover * edge() * 0.3f, 0, cover * edge(), 0};
    }
    ShadedLayer layer = all_factored(base, shadows, specular);
    layer.origin_px = {std::uniform_int_distribution(-4, 8)(random_),
                       std::uniform_int_distribution(-4, 8)(random_)};
    layer.fade = edge();
    return layer;
  }
  bool coin() { return std::bernoulli_distribution(0.7)(random_); }

 private:
  float uniform() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  float edge() {
    const float v = 1.6f * uniform() - 0.3f;
    return std::min(std::max(v, 0.0f), 1.0f);
  }
  float color() { return 1.2f * uniform(); }
  std::mt19937 random_;
};

TEST(PredictFrame, TheCompositorIsWithinTheRoundingBoundOnRandomLayers) {
  double largest_share = 0, largest_error = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(seed);
    RandomLayers random(seed);
    std::vector<ShadedLayer> layers;
    FactoredMask factored;
    for (int i = 0; i < 4; ++i) layers.push_back(random.next()), factored.push_back(random.coin());
    const ivec2 display{12, 12};
    const FramePrediction prediction = predict_frame(layers, factored, display, kBehind);
    const chunker::Frame shown = composite_layers(layers, factored, display, kBehind);
    for (std::size_t i = 0; i < prediction.pixels.size(); ++i) {
      const PixelPrediction& pixel = prediction.pixels[i];
      const dvec3 off = linear_of(shown.pixels[i]) - pixel.truth - pixel.error();
      for (int c = 0; c < 3; ++c) {
        ASSERT_LE(std::fabs(off[c]), pixel.bound[c]) << "pixel " << i << " channel " << c;
        largest_share = std::fmax(largest_share, std::fabs(off[c]) / pixel.bound[c]);
        largest_error = std::fmax(largest_error, std::fabs(pixel.error()[c]));
      }
    }
  }
  EXPECT_GT(largest_share, 0.5);  // a bound that is never approached proves little
  EXPECT_GT(largest_error, 0.1);
}

TEST(FrameOfTruth, IsTheUnfactoredFrame) {
  const std::vector<ShadedLayer> layers{one_texel({0.3f, 0.3f, 0.3f, 0.5f}, 0.25f)};
  const FramePrediction prediction = predict_frame(layers, {true}, {1, 1}, kBehind);
  EXPECT_NEAR(linear_of(frame_of_truth(prediction).pixels[0]).x, 0.2, 1e-5);
}

}  // namespace
}  // namespace talisman::sequences
