// SPDX-License-Identifier: Apache-2.0
// `accuracy --factoring` from a small room to its files.
#include "sequences/commands/accuracy_factoring.h"

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/commands/accuracy.h"
#include "sequences/experiments/factoring/pictures.h"
#include "sequences/experiments/factoring/variants.h"
#include "sequences/experiments/statistics.h"
#include "sequences/pipeline/layer_planning.h"
#include "tests/sequences/commands/experiment_files.h"
#include "tests/sequences/room_sequence.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;
using tests::Room;

ExperimentOptions quick_factoring() { return tests::quick_options("", "", 4); }

/// All terms, on a floor that the shadow leaves.
Room full_room() {
  return tests::with_flying_ball(
      tests::small_floor(Room().casting().mirroring().shining().textured_twice().factored()));
}

FactoringReport measured(const Room& room, int frames = 8) {
  return measure_factoring_report(tests::sequence_of(room, frames), quick_factoring());
}

const FactoringReport& full_report() {
  static const FactoringReport report = measured(full_room());
  return report;
}

TEST(MeasureFactoring, ErrorOfTheFrameIsThePredictedOneToRounding) {
  const PredictionCheck& frame = full_report().result.frame;
  EXPECT_EQ(frame.beyond_bound, 0);
  EXPECT_LE(frame.largest_share_of_bound, 1);
  EXPECT_GT(frame.by_formula.largest, 0.02) << "no shadow falls across an edge: nothing is proved";
  EXPECT_GT(frame.elsewhere.count, frame.measured.count / 2);
  EXPECT_LE(frame.elsewhere.largest, frame.largest_bound);
  std::printf("by formula %.5f, measured %.5f, unexplained %.5f, bound %.5f\n", frame.by_formula.largest,
              frame.measured.largest, frame.unexplained.largest, frame.largest_bound);
}

TEST(MeasureFactoring, FormulaAloneIsEnoughWhereAllTermsAreFactored) {
  const PredictionCheck& frame = full_report().result.frame;
  EXPECT_NEAR(frame.predicted.rms(), frame.by_formula.rms(), 1e-4);
  EXPECT_NEAR(frame.predicted.largest, frame.by_formula.largest, 1e-3);
}

TEST(MeasureFactoring, LayersThatFactorNothingAreNotListed) {
  const FactoringResult& result = full_report().result;
  ASSERT_EQ(result.layers.size(), 1u);  // the ball has no shade layers
  EXPECT_EQ(result.layers[0].name, "floor");
  EXPECT_EQ(result.layers[0].shade_layers, 4);
  EXPECT_EQ(result.layers[0].frames_shown, 2);
  EXPECT_EQ(result.layers[0].check.beyond_bound, 0);
  EXPECT_NEAR(result.layers[0].check.predicted.rms(), result.frame.predicted.rms(), 1e-9)
      << "what alone is factored is the frame";
}

TEST(MeasureFactoring, HighlightLeftInTheBaseIsTheRest) {
  Room room = Room().casting().shining();
  room.scene.nodes[3].local.translation = {0, 4, -2};  // so that the ball's shadow lies on the highlight
  room.specs[0].shading.shadows = layers::LayerPreferences{};
  const PredictionCheck frame = measured(room, 1).result.frame;
  EXPECT_EQ(frame.beyond_bound, 0);
  EXPECT_GT(frame.predicted.largest, 10 * frame.by_formula.largest + 0.001);
}

TEST(MeasureFactoring, CoarserShadeLayersLoseMore) {
  Room room = full_room();
  for (auto* term : {&room.specs[0].shading.shadows, &room.specs[0].shading.reflection})
    (*term)->resolution_scale = 0.25;
  const FactoringResult result = measured(room).result;
  const auto rms = [&](Picture picture) {
    return rms_code_values(summarize(result.losses[static_cast<std::size_t>(picture)].frames).mean.psnr_db);
  };
  EXPECT_GT(rms(Picture::ShadeResolution), 1.5 * rms(Picture::OverAlone));
  EXPECT_LT(rms(Picture::OverAlone), 1.5);
  EXPECT_EQ(result.frame.beyond_bound, 0) << "the check is made at full resolution";
}

TEST(MeasureFactoring, PlacementAddsNothingToSpritesThatLieOnPixels) {
  // All shade layers at full resolution: what is drawn is the same as over alone, where nothing is rotated.
  const FactoringResult& result = full_report().result;
  const auto& over = result.losses[static_cast<std::size_t>(Picture::OverAlone)].frames;
  const auto& own = result.losses[static_cast<std::size_t>(Picture::ShadeResolution)].frames;
  ASSERT_EQ(over.size(), 2u);
  for (std::size_t i = 0; i < over.size(); ++i) EXPECT_EQ(over[i].quality.psnr_db, own[i].quality.psnr_db);
}

TEST(MeasureFactoring, BlendOverTimeIsJudgedByATruthOfItsOwn) {
  EXPECT_FALSE(full_report().result.blends_over_time);
  Room room = full_room();
  room.specs[0].shading.second_blend = {{0, 1}, {0, 1}, layers::Interpolation::Linear};
  const FactoringResult result = measured(room).result;
  EXPECT_TRUE(result.blends_over_time);
  EXPECT_EQ(result.frame.beyond_bound, 0);
  // One pass of the renderer blends as the material says; its truth does, too.
  EXPECT_LT(rms_code_values(
                summarize(result.losses[static_cast<std::size_t>(Picture::OnePass)].frames).mean.psnr_db),
            2);
}

TEST(MeasureFactoring, FadesAndMergedLayersKeepTheBound) {
  Room faded = full_room();
  faded.specs[0].fade = {{0}, {0.6}, layers::Interpolation::Step};
  faded.specs[1].fade = {{0}, {0.3}, layers::Interpolation::Step};
  EXPECT_EQ(measured(faded).result.frame.beyond_bound, 0);
  Room sunk = full_room();  // ball and floor pass through each other: one sprite, drawn in one pass
  sunk.scene.tracks.clear();
  sunk.scene.nodes[1].local.translation = {0, 0.1, 0};
  const FactoringResult merged = measured(sunk).result;
  EXPECT_EQ(merged.layers[0].frames_shown, 0) << "an aggregate factors nothing";
  EXPECT_EQ(merged.frame.predicted.largest, 0);
}

TEST(MeasureFactoring, CostsAreThoseOfBothSequences) {
  const FactoringResult& result = full_report().result;
  EXPECT_GT(result.factored.renders, 0);
  EXPECT_GT(result.unfactored.polygons, 0);
  EXPECT_GT(result.unfactored.modelled_ms, 0);
  EXPECT_TRUE(std::isfinite(result.factored.frame_ms()));
}

TEST(FactoringVariants, UnfactoredKeepsLayersAndTheirOrder) {
  Sequence sequence = tests::sequence_of(full_room(), 4);
  const int ball = static_cast<int>(sequence.layers.layers.size()) - 1;
  sequence.explicit_order = {{0, ball}};
  const Variant whole = unfactored({sequence, {}});
  EXPECT_FALSE(is_factored(whole.sequence));
  ASSERT_EQ(whole.sequence.layers.layers.size(), 2u);
  ASSERT_EQ(whole.sequence.explicit_order.size(), 1u);
  EXPECT_EQ(whole.sequence.explicit_order[0], (layers::ExplicitPair{0, 1}));
  EXPECT_TRUE(whole.sequence.layers.layers[0].holds.shadows);
  EXPECT_TRUE(whole.sequence.layers.layers[0].holds.reflection);
}

TEST(FactoringVariants, TexelOnPixelWhateverTheSequenceAsksFor) {
  Room room = full_room();
  room.specs[0].preferences.resolution_scale = 0.3;
  room.specs[0].preferences.motion_blur = 0.5;
  room.specs[0].shading.shadows->resolution_scale = 0.25;
  Settings settings;
  settings.placement.resolution_scale = 2;
  settings.placement.min_rotation_gain = 0;
  const Variant given{tests::sequence_of(room, 4), settings};
  for (const layers::Layer& layer : texel_on_pixel(given, ShadeResolution::Full).sequence.layers.layers) {
    EXPECT_EQ(layer.preferences.resolution_scale, 1) << layer.name;
    EXPECT_EQ(layer.preferences.motion_blur, 0) << layer.name;
  }
  const Variant own = texel_on_pixel(given, ShadeResolution::Own);
  EXPECT_EQ(own.sequence.layers.layers[0].preferences.resolution_scale, 1);
  EXPECT_EQ(own.sequence.layers.layers[2].preferences.resolution_scale, 0.25);
  EXPECT_EQ(own.settings.placement.resolution_scale, 1);
}

TEST(FactoringFiles, AllAreThereAndSayWhatWasMeasured) {
  const tests::TemporaryFolder folder;
  write_report(full_report(), folder.path());
  tests::expect_files(
      folder,
      {"factoring.csv", "factoring-layers.csv", "factoring-costs.csv", "factoring.json", "factoring.png",
       "factoring-measured.png", "factoring-predicted.png", "factoring-difference.png",
       "factoring-prediction.svg", "factoring-prediction.csv", "factoring-losses.svg"});
  const nlohmann::json json = nlohmann::json::parse(folder.read("factoring.json"));
  EXPECT_EQ(json["schema"], "talisman.factoring/1");
  EXPECT_EQ(json["settings_given"]["geometric_px"], full_report().given.regulator.thresholds.geometric_px);
  EXPECT_GT(json["settings_given"].size(), 20u);
  EXPECT_EQ(json["display_px"], (nlohmann::json{160, 120}));
  EXPECT_EQ(json["pictures"].size(), kPictures.size());
  EXPECT_EQ(json["frame"]["values_beyond_bound"], 0);
  EXPECT_EQ(json["layers"][0]["layer"], "floor");
  EXPECT_EQ(json["frames_compared"].size(), 2u);
}

TEST(FactoringFiles, AllButTheTimesIsTheSameInEveryRun) {
  const FactoringReport again = measured(full_room());
  EXPECT_EQ(pictures_csv(again), pictures_csv(full_report()));
  EXPECT_EQ(layers_csv(again), layers_csv(full_report()));
}

TEST(FactoringFiles, TableHasNoNumberThatIsNone) {
  tests::expect_table(tests::printed(full_report()),
                      {"2 frames drawn", "over alone", "+ reuse", "What factoring saves"});
}

TEST(ErrorMap, WhiteIsNoErrorAndColoursSayItsSign) {
  ShownFrame frame;
  frame.factored = {64, 40, std::vector<chunker::Linear16>(64 * 40)};
  frame.prediction.size_px = {64, 40};
  frame.prediction.pixels.resize(64 * 40);
  frame.prediction.pixels[1].over = layers::dvec3(0.1);
  frame.prediction.pixels[2].over = layers::dvec3(-0.1);
  frame.prediction.pixels[3].over = layers::dvec3(NAN);  // a map has no place for it, and no crash
  const Image8 map = error_map(frame, ErrorMap::Predicted, 0.1);
  const auto pixel = [&](int x) { return Rgb{map.rgb[3 * x], map.rgb[3 * x + 1], map.rgb[3 * x + 2]}; };
  EXPECT_EQ(pixel(0), (Rgb{255, 255, 255}));
  EXPECT_GT(pixel(1)[0], pixel(1)[2] + 100);
  EXPECT_GT(pixel(2)[2], pixel(2)[0] + 100);
  EXPECT_EQ(pixel(3), (Rgb{255, 255, 255}));
}

TEST(RoundUp125, IsTheNextRoundNumber) {
  EXPECT_DOUBLE_EQ(round_up_125(0.011), 0.02);
  EXPECT_DOUBLE_EQ(round_up_125(0.02), 0.02);
  EXPECT_DOUBLE_EQ(round_up_125(0.3), 0.5);
  EXPECT_DOUBLE_EQ(round_up_125(0), 1e-4);
}

TEST(MeasureFactoringReport, BadOptionsAreNamed) {
  tests::expect_bad_options_named(quick_factoring(), [](const ExperimentOptions& options) {
    measure_factoring_report(tests::sequence_of(full_room(), 8), options);
  });
}

TEST(MeasureFactoringReport, SequenceWithoutShadeLayersIsAnInputError) {
  EXPECT_THAT(tests::message_of([] { measured(Room().casting().shining()); }),
              HasSubstr("room: no layer factors a shade term"));
  // Asked for, but nothing calls for it.
  EXPECT_THAT(tests::message_of([] { measured(Room().factored()); }), HasSubstr("no layer factors"));
}

TEST(RunAccuracy, FactoringIsOneOfTheExperiments) {
  std::ostringstream out;
  AccuracyOptions both;
  both.solvers = true;
  both.factoring = "stage";
  EXPECT_THAT(tests::message_of([&] { run_accuracy(both, out); }), HasSubstr("more than one experiment"));
}

}  // namespace
}  // namespace talisman::sequences
