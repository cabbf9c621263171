// SPDX-License-Identifier: Apache-2.0
// Rows of a paper that is made up: what is measured, what says no, what cannot be measured; and plans on the workbench.
#include "sequences/experiments/reproduction/reproduction.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/experiments/reproduction/papers.h"
#include "sequences/experiments/reproduction/report.h"
#include "sequences/results/planned.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;

constexpr int kFramesThatMove = 24;

OpenSequence opened_moving(const std::string& name) {
  if (name != "moving") throw InputError("'" + name + "' has no content");
  const Variant run = tests::run_of(tests::moving_sequence(kFramesThatMove));
  return {run.sequence, run.settings};
}

Claim claim_of(const std::string& id, bool same) {
  return {id, "the paper's words, \"quoted\"", "a rule",
          [same](PaperBench&) {
            return Finding{"1.5 px", same, {{"px", 1.5}}};
          },
          [](PaperBench&) { return std::string("a second look"); }};
}

/// Two rows that are measured, one whose content is not there, one that draws.
std::vector<Paper> made_up_papers() {
  Item item{"7", "Fig. 7: made up", {claim_of("yes", true), claim_of("no", false)}, nullptr};
  Claim missing = claim_of("missing", true);
  missing.ours = [](PaperBench& bench) {
    bench.sequence("absent");
    return Finding{"", true, {}};
  };
  item.claims.push_back(missing);
  Claim pictures = claim_of("pictures", true);
  pictures.pictures = true;
  item.claims.push_back(pictures);
  item.draw = [](PaperBench&) {
    Plot plot{"bars", {"sprite", "", false, false, {"sky", "land"}}, {"rate", "%", false, true}, {}};
    plot.series.push_back({"rate", {{1, 20}, {2, 50}}, SeriesStyle::Bars});
    return std::vector<PaperFigure>{{"X99-7", "Fig. 7", plot}};
  };
  return {{"X99", "Nobody, Nothing, 1999", {item, {"8", "Table 8", {claim_of("yes", true)}, nullptr}}}};
}

Reproduction made_up(bool quick) {
  PaperBench bench(opened_moving);
  return reproduce(made_up_papers(), bench, quick, ProgressKind::None);
}

TEST(Reproduce, CountsWhatSaysYesAndNoAndWhatCannotBeMeasured) {
  const Reproduction all = made_up(false);
  EXPECT_EQ(all.count(Shape::Same), 3);
  EXPECT_EQ(all.count(Shape::Other), 1);
  EXPECT_EQ(all.count(Shape::NotMeasured), 1);
  EXPECT_EQ(all.left_out, 0);
  EXPECT_EQ(made_up(true).count(Shape::Same), 2);
  EXPECT_EQ(made_up(true).left_out, 1);
}

TEST(Reproduce, ASecondExperimentIsMadeWhereARowSaysNoAndOnlyThere) {
  const Reproduction all = made_up(false);
  EXPECT_EQ(all.items[0].rows[0].why, "");
  EXPECT_EQ(all.items[0].rows[1].why, "a second look");
  EXPECT_EQ(all.items[0].rows[2].finding.ours, "'absent' has no content");
}

TEST(Reproduce, HasFailedWhereARowSaysNoThatMustNot) {
  std::vector<Paper> papers = made_up_papers();
  PaperBench bench(opened_moving);
  EXPECT_EQ(reproduce(papers, bench, true, ProgressKind::None).failed(), 0);
  for (Claim& claim : papers[0].items[0].claims) claim.must = true;
  EXPECT_EQ(reproduce(papers, bench, true, ProgressKind::None).failed(), 1);
}

TEST(PrintReproduction, SaysWhatThePaperSaysAndOursAndWhy) {
  std::ostringstream out;
  print_report(made_up(true), out);
  EXPECT_THAT(out.str(), HasSubstr("X99:7  Fig. 7: made up\n"));
  EXPECT_THAT(out.str(), HasSubstr("X99:7/no says no (rule: a rule); a second look\n"));
  EXPECT_THAT(out.str(),
              HasSubstr("2 rows say yes, 1 no, 1 are not measured, 1 draw pictures and are left out"));
}

TEST(WriteReproduction, WritesTablesFiguresAndOnePage) {
  const tests::TemporaryFolder folder;
  write_report(made_up(false), folder.path());
  EXPECT_THAT(folder.read("reproduce.csv"), HasSubstr("X99:7/no,\"the paper's words, \"\"quoted\"\"\",\"1.5 "
                                                      "px\",\"no\",\"a rule\",,0,0,\"a second look\"\n"));
  EXPECT_THAT(folder.read("numbers.csv"), HasSubstr("X99:7/no,\"px\",1.5\n"));
  const auto json = nlohmann::json::parse(folder.read("reproduce.json"));
  EXPECT_EQ(json["schema"], "talisman.reproduce/1");
  EXPECT_EQ(json["items"][0]["rows"][0]["same"], true);
  EXPECT_EQ(json["items"][0]["rows"][1]["numbers"]["px"], 1.5);
  EXPECT_TRUE(json["items"][0]["rows"][2]["same"].is_null());
  EXPECT_EQ(json["items"][0]["figures"][0]["file"], "X99-7.svg");
  EXPECT_THAT(folder.read("X99-7.svg"), HasSubstr("<svg"));
  EXPECT_THAT(folder.read("reproduce.html"), HasSubstr("<svg"));
}

// --- What is asked for

TEST(ChosenPapers, ArePapersOrSingleItems) {
  const std::vector<Paper> papers = made_up_papers();
  EXPECT_EQ(chosen_papers(papers, {})[0].items.size(), 2u);
  EXPECT_EQ(chosen_papers(papers, {"X99"})[0].items.size(), 2u);
  const std::vector<Paper> one = chosen_papers(papers, {"X99:8"});
  ASSERT_EQ(one[0].items.size(), 1u);
  EXPECT_EQ(one[0].items[0].id, "8");
  EXPECT_EQ(chosen_papers(papers, {"X99", "X99:8"})[0].items.size(), 2u);
}

TEST(ChosenPapers, RefusesWhatThereIsNot) {
  EXPECT_THAT(tests::message_of([] { chosen_papers(made_up_papers(), {"X99:9"}); }),
              HasSubstr("--only is 'X99:9', must be one of X99, X99:7, X99:8"));
}

TEST(AllPapers, HaveRowsOfTheirOwnNames) {
  std::set<std::string> ids;
  for (const Paper& paper : all_papers())
    for (const Item& item : paper.items)
      for (const Claim& claim : item.claims) {
        const std::string id = full_id(paper, item) + "/" + claim.id;
        EXPECT_TRUE(ids.insert(id).second) << id;
        EXPECT_FALSE(claim.paper.empty() || claim.rule.empty()) << id;
        EXPECT_TRUE(claim.ours) << id;
      }
  EXPECT_GT(ids.size(), 40u);
}

// --- Plans

TEST(PaperBench, PlansAreThoseOfARunAndMadeOnce) {
  PaperBench bench(opened_moving);
  const PlannedRun& run = bench.plan(threshold_plan("moving", 1));
  EXPECT_EQ(&run, &bench.plan(threshold_plan("moving", 1)));
  OpenSequence open = opened_moving("moving");
  open.settings.regulator.policy = regulator::Policy::Threshold;
  open.settings.regulator.thresholds.geometric_px = 1;
  open.settings.frames = kFramesThatMove;
  const Summary alone = planned(open.sequence, open.settings, {0, kFramesThatMove - 1});
  ASSERT_EQ(run.summary.frames.size(), std::size_t{kFramesThatMove});
  EXPECT_EQ(run.summary.polygons_rendered(), alone.polygons_rendered());
  EXPECT_EQ(run.sprite_depth.size(), std::size_t{kFramesThatMove});
}

TEST(PaperBench, TripleFramingDrawsInEveryThirdFrame) {
  PaperBench bench(opened_moving);
  for (const PlanOf& of : {triple_framing("moving"), interpolated_triple_framing("moving")}) {
    const PlannedRun& run = bench.plan(of);
    for (const FrameLine& line : run.summary.frames)
      EXPECT_EQ(line.renders > 0, line.frame % 3 == 0) << line.frame;
  }
  const auto error = [](const FrameLine& line) { return line.error.mean_px; };
  const std::vector<double> held = by_frame(bench.plan(triple_framing("moving")), error);
  const std::vector<double> warped = by_frame(bench.plan(interpolated_triple_framing("moving")), error);
  EXPECT_EQ(held[3], 0);
  EXPECT_GT(held[5], held[4]);
  EXPECT_LT(warped[5], held[5]);
}

// At half the speed frame 2 k shows the instant of frame k.
TEST(PaperBench, AnotherSpeedIsAnotherStepOfTime) {
  const OpenSequence original = opened_moving("moving");
  PlanOf slow = own_plan("moving"), fast = own_plan("moving");
  slow.speed = 0.5;
  fast.speed = 2;
  EXPECT_DOUBLE_EQ(changed(original, slow).settings.fps, 2 * original.settings.fps);
  EXPECT_EQ(changed(original, slow).settings.frames, kFramesThatMove);
  EXPECT_DOUBLE_EQ(changed(original, fast).settings.fps, original.settings.fps / 2);
  EXPECT_EQ(changed(original, fast).settings.frames, kFramesThatMove / 2);
}

TEST(PaperBench, AFixedCameraStaysWhereItIsInTheMiddle) {
  const OpenSequence original = opened_moving("moving");
  PlanOf of = own_plan("moving");
  of.fixed_camera = true;
  const OpenSequence fixed = changed(original, of);
  const layers::Scene& scene = *fixed.sequence.scene;
  const double middle_s = kFramesThatMove / 2 / original.sequence.fps;
  const layers::dmat4 wanted = original.sequence.scene->at(middle_s).camera.world_from_camera;
  for (const double t : {0.0, 0.3, 1.0})
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        EXPECT_NEAR(scene.at(t).camera.world_from_camera[column][row], wanted[column][row], 1e-9);
}

TEST(PaperBench, FullResolutionIsThatOfTheDisplay) {
  OpenSequence original = opened_moving("moving");
  original.sequence.layer_specs[0].preferences.resolution_scale = 0.5;
  original.sequence.layers = layers::factor(*original.sequence.scene, original.sequence.layer_specs);
  PlanOf of = reference_plan("moving");
  of.full_resolution = true;
  for (const layers::Layer& layer : changed(original, of).sequence.layers.layers)
    EXPECT_EQ(layer.preferences.resolution_scale, 1);
}

TEST(PaperBench, WhatIsNotThereIsRefusedEachTime) {
  PaperBench bench(opened_moving);
  EXPECT_THROW(bench.plan(own_plan("absent")), InputError);
  EXPECT_THROW(bench.plan(own_plan("absent")), InputError);
}

}  // namespace
}  // namespace talisman::sequences
