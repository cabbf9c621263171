// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/missing_effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/built_effects.h"
#include "sequences/commands/inspect.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using layers::Effect;
using layers::effects_without;

std::string missing_in(const Variant& variant, std::string_view left_out) {
  return missing_effect(effects_of(variant), effects_without(left_out));
}

TEST(MissingEffect, ABuildWithAllLacksNone) { EXPECT_EQ(missing_in(tests::every_effect(2), ""), ""); }

TEST(MissingEffect, IsNamedWithWhoCallsForIt) {
  EXPECT_EQ(
      missing_in(tests::every_effect(2), "shadow_map"),
      "calls for shadow_map (light 'lamp': drawn again when light or casters move), which this build was "
      "configured without (TALISMAN_WITHOUT)");
}

TEST(MissingEffect, APolicyIsNamedAsTheRunAsksForIt) {
  EXPECT_EQ(missing_in(tests::calling_for(Effect::Predictive, 2), "predictive"),
            "calls for predictive (the run's policy is predictive), which this build was configured without "
            "(TALISMAN_WITHOUT)");
}

TEST(MissingEffect, OfSeveralTheFirstOfTheTableIsNamed) {
  EXPECT_THAT(missing_in(tests::every_effect(2), "texture_layers,skinning"),
              testing::StartsWith("calls for skinning (part 'bar' has a skin)"));
}

class MissingEffectOf : public testing::TestWithParam<Effect> {};

// Both ways round for each effect: refused where it is called for, accepted where it is not. Others that are
// left out too must not matter in the second case, so all that `without_effect` took is left out.
TEST_P(MissingEffectOf, MattersOnlyWhereItIsCalledFor) {
  const std::string name(layers::name(GetParam()));
  const Variant calling = tests::calling_for(GetParam(), 2);
  EXPECT_THAT(missing_in(calling, name), testing::StartsWith("calls for " + name + " ("));
  const Variant without = without_effect(calling, GetParam());
  std::string uncalled;
  for (const layers::EffectCall& call : effects_of(without))
    if (!call.called) uncalled += (uncalled.empty() ? "" : ",") + std::string(layers::name(call.effect));
  EXPECT_EQ(missing_in(without, name), "");
  EXPECT_EQ(missing_in(without, uncalled), "");
}

std::string effect_name(const testing::TestParamInfo<Effect>& info) {
  return std::string(layers::name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Of, MissingEffectOf, testing::ValuesIn(layers::kAllEffects), effect_name);

TEST(RequireBuiltEffects, ThisBuildDrawsWhatItHas) {
  const Variant all = tests::every_effect(2);
  const std::string missing = missing_effect(effects_of(all), built_effects());
  if (missing.empty())
    EXPECT_NO_THROW(require_built_effects(all.sequence, all.settings));
  else
    EXPECT_THROW(require_built_effects(all.sequence, all.settings), InputError);
}

TEST(EffectsWithout, ReadsNamesBetweenCommas) {
  const layers::EffectSet built = effects_without("shadow_map,texture");
  for (const Effect effect : layers::kAllEffects)
    EXPECT_EQ(built[static_cast<std::size_t>(effect)],
              effect != Effect::ShadowMap && effect != Effect::Texture)
        << layers::name(effect);
}

// "texture" is a part of "texture_layers", "shadow_map" of nothing: whole names count.
TEST(EffectsWithout, PartsOfNamesLeaveNothingOut) {
  EXPECT_FALSE(effects_without("texture_layers")[static_cast<std::size_t>(Effect::TextureLayers)]);
  EXPECT_TRUE(effects_without("texture_layers")[static_cast<std::size_t>(Effect::Texture)]);
  EXPECT_EQ(effects_without("text,shadow,,"), effects_without(""));
}

TEST(EffectNames, AreThoseOfTheTableInItsOrder) {
  for (std::size_t e = 0; e < layers::kAllEffects.size(); ++e)
    EXPECT_EQ(static_cast<std::size_t>(layers::kAllEffects[e]), e);
  EXPECT_EQ(layers::name(Effect::Texture), "texture");
  EXPECT_EQ(layers::name(Effect::SpriteCompression), "sprite_compression");
  EXPECT_EQ(layers::name(Effect::TextureLayers), "texture_layers");
}

// The same class as a build with and without the effect sees it.
TEST(ValueOf, IsAConstantWhereTheEffectIsNotBuilt) {
  layers::ValueOf<Effect::Translucency, float, 1, true> built;
  layers::ValueOf<Effect::Translucency, float, 1, false> left_out;
  EXPECT_EQ(float(built), 1.0f);
  built = 0.25f;
  left_out = 0.25f;
  EXPECT_EQ(float(built), 0.25f);
  EXPECT_EQ(float(left_out), 1.0f);
  static_assert(std::is_empty_v<decltype(left_out)>);
}

TEST(Inspection, MarksEffectsThatAreNotInThisBuild) {
  const std::string text = inspection_text(tests::every_effect(2).sequence);
  const bool has_all = missing_effect(effects_of(tests::every_effect(2)), built_effects()).empty();
  EXPECT_EQ(text.find("(not in this build)") == std::string::npos, has_all);
}

}  // namespace
}  // namespace talisman::sequences
