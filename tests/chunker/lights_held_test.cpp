// SPDX-License-Identifier: Apache-2.0
// The light of a surface taken apart: what has no shadow, and each light that casts by itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/chunker/shade_support.h"

namespace talisman::chunker {
namespace {

using tests::ShadeScene;

LinearImage held(ShadeScene& shaded, ShadeTerm term, LightsHeld lights, int light = -1) {
  ShadeInputs inputs = shaded.inputs(term, light);
  inputs.lights = lights;
  inputs.reflections = {};
  return shaded.linear(inputs, tests::exact_options());
}

/// The largest difference of colour between `whole` and the sum of `parts`.
float largest_gap(const LinearImage& whole, const std::vector<LinearImage>& parts) {
  float largest = 0;
  for (std::size_t i = 0; i < whole.texels.size(); ++i) {
    LinearColor sum;
    for (const LinearImage& part : parts) {
      const LinearColor& c = part.texels[i];
      sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b, 0};
    }
    const LinearColor& c = whole.texels[i];
    largest = std::max({largest, std::fabs(sum.r - c.r), std::fabs(sum.g - c.g), std::fabs(sum.b - c.b)});
  }
  return largest;
}

// Also where a texel is mixed: the mean of a sum is the sum of the means.
TEST(LightsHeld, AddUpToTheWholeTexelByTexel) {
  ShadeScene shaded;
  const LinearImage whole = held(shaded, ShadeTerm::Full, LightsHeld::All),
                    rest = held(shaded, ShadeTerm::Full, LightsHeld::Unmapped),
                    sun = held(shaded, ShadeTerm::Full, LightsHeld::One, ShadeScene::kSun),
                    spot = held(shaded, ShadeTerm::Full, LightsHeld::One, ShadeScene::kSpot);
  EXPECT_LT(largest_gap(whole, {rest, sun, spot}), 2e-6);
  EXPECT_GT(largest_gap(whole, {rest, sun}), 0.05);  // each of them is needed
  EXPECT_GT(largest_gap(whole, {rest, spot}), 0.05);
}

TEST(LightsHeld, OneLightHasNoAlphaAndTheRestHasAllOfIt) {
  ShadeScene shaded;
  const LinearImage whole = held(shaded, ShadeTerm::Full, LightsHeld::All),
                    rest = held(shaded, ShadeTerm::Full, LightsHeld::Unmapped),
                    sun = held(shaded, ShadeTerm::Full, LightsHeld::One, ShadeScene::kSun);
  for (std::size_t i = 0; i < whole.texels.size(); ++i) {
    ASSERT_EQ(sun.texels[i].a, 0);
    ASSERT_EQ(rest.texels[i].a, whole.texels[i].a);
  }
}

TEST(LightsHeld, EqualTheReferenceRenderer) {
  ShadeScene shaded;
  for (const LightsHeld lights : {LightsHeld::Unmapped, LightsHeld::One})
    for (const ShadeTerm term :
         {ShadeTerm::Full, ShadeTerm::Base, ShadeTerm::Texture1, ShadeTerm::Texture2}) {
      ShadeInputs inputs = shaded.inputs(term, ShadeScene::kSpot);
      inputs.lights = lights;
      tests::expect_same(shaded.render(inputs, tests::exact_options()).sprite,
                         shaded.reference(inputs, tests::exact_options()), tests::name_of(term));
    }
}

}  // namespace
}  // namespace talisman::chunker
