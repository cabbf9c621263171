// SPDX-License-Identifier: Apache-2.0
// Scenes whose right factoring is known, and scenes that are none.
#include "sequences/content/factoring/factoring.h"

#include <gmock/gmock.h>

#include "sequences/content/own_settings.h"
#include "tests/sequences/content/factoring/factored_scene.h"

namespace talisman {
namespace {

using sequences::Factoring;
using sequences::FactoringStudy;
using sequences::FactoringWay;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;
using tests::dvec3;
using tests::FactoredScene;

const Factoring* other(const FactoringStudy& study, const std::string& how) {
  for (const Factoring& f : study.others)
    if (f.how == how) return &f;
  return nullptr;
}

/// Two bodies of three cubes each, one drifting, one turning, far apart on the display.
FactoredScene two_bodies() {
  FactoredScene s;
  const int drifting = s.node("drifting", {-3, 2, 0}), turning = s.node("turning", {3, -2, 0});
  for (int i = 0; i < 3; ++i) {
    s.part("d" + std::to_string(i), {0.4 * i, 0, 0}, drifting);
    s.part("t" + std::to_string(i), {0.4 * i, 0, 0}, turning);
  }
  s.moves(drifting, {0.02, 0, 0.1});
  s.spins(turning, 0.2);
  return s;
}

TEST(Factoring, TwoRigidBodiesAreTwoLayers) {
  const FactoredScene s = two_bodies();
  const FactoringStudy study = s.study();
  EXPECT_THAT(s.parts_of(study.chosen), UnorderedElementsAre(UnorderedElementsAre("d0", "d1", "d2"),
                                                             UnorderedElementsAre("t0", "t1", "t2")));
}

// The display is the same at every scale: so are the layers, and what they cost.
// As a pattern the first of these names would take the others too.
TEST(Factoring, WildcardsInNamesAreThemselves) {
  FactoredScene s;
  const char* const names[] = {"*", "?", "a*"};
  for (int i = 0; i < 3; ++i)
    s.moves(s.part(names[i], {3.0 * i - 3, 2.0 - 2 * i, 0}), {0.02 * (i - 1), 0, 0.1 * i});
  for (const FactoringWay way : {FactoringWay::Velocity, FactoringWay::Node, FactoringWay::Amortised})
    EXPECT_THAT(s.parts_of(s.study(3, way).chosen),
                UnorderedElementsAre(ElementsAre("*"), ElementsAre("?"), ElementsAre("a*")))
        << static_cast<int>(way);
}

TEST(Factoring, TheUnitOfLengthIsOfNoConcern) {
  const FactoredScene s = two_bodies();
  const FactoringStudy as_it_is = s.study();
  for (const double factor : {1e-4, 1e6}) {
    FactoredScene other = s;
    other.scene = tests::scaled(s.scene, factor);
    const FactoringStudy scaled = other.study();
    EXPECT_EQ(other.parts_of(scaled.chosen), s.parts_of(as_it_is.chosen)) << factor;
    EXPECT_EQ(scaled.chosen.plan.renders, as_it_is.chosen.plan.renders) << factor;
  }
}

TEST(Factoring, WhatRestsIsApartFromWhatMovesBeforeIt) {
  FactoredScene s;
  s.part("wall", {0, 0, -2}, -1, 1, dvec3(9));
  s.part("picture", {1, 1, -1.9}, -1, 1, dvec3(2));
  s.moves(s.part("ball", {-3, 0, 1}), {0.25, 0, 0});
  const FactoringStudy study = s.study();
  EXPECT_THAT(s.parts_of(study.chosen), testing::Contains(ElementsAre("ball")));
  // The wall is drawn once, the ball as often as it must: never the wall with it.
  const Factoring* one = other(study, "one");
  ASSERT_NE(one, nullptr);
  EXPECT_LT(study.chosen.plan.pixels, one->plan.pixels);
}

// The bar bends: nothing that is rigid is like it.
TEST(Factoring, WhatDeformsIsALayerOfItsOwn) {
  FactoredScene s;
  s.scene = tests::skinned_bar_scene();
  layers::Node at;
  at.name = "floor";
  at.local.translation = {0, -2, -1};
  s.scene.nodes.push_back(at);
  s.scene.meshes.push_back(tests::quad_mesh(4));
  s.scene.parts.push_back({"floor", static_cast<int>(s.scene.nodes.size()) - 1,
                           static_cast<int>(s.scene.meshes.size()) - 1, 0, -1});
  s.settings.fps = 12;
  const FactoringStudy study = s.study();
  EXPECT_THAT(s.parts_of(study.chosen), testing::Contains(ElementsAre("bar")));
}

// A land in strips, over which the camera goes: the strips ahead are drawn far less often than the one below.
TEST(Factoring, ALongLandIsCutWhereOneWarpNoLongerServes) {
  FactoredScene s(48);
  for (int i = 0; i < 6; ++i) {
    const int at = s.part("land " + std::to_string(i), {0, -1, -20.0 * i}, -1, 1, dvec3(40, 20, 1));
    s.scene.nodes[at].local.rotation = glm::angleAxis(-M_PI / 2, dvec3(1, 0, 0));
  }
  s.moves(s.eye(), {0, 0, -0.5});
  s.settings.regulator.thresholds.geometric_px = 1;
  const FactoringStudy study = s.study();
  EXPECT_GE(study.chosen.specs.size(), 2u);
  const Factoring* one = other(study, "one");
  ASSERT_NE(one, nullptr);
  EXPECT_LT(study.chosen.plan.work_ms(), one->plan.work_ms());
}

TEST(Factoring, NeverDearerThanANodeEachOrOneForAll) {
  const FactoredScene s = two_bodies();
  const FactoringStudy study = s.study();
  for (const Factoring& f : study.others) EXPECT_LE(study.chosen.plan.work_ms(), f.plan.work_ms()) << f.how;
}

TEST(Factoring, NoMoreLayersThanAsked) {
  FactoredScene s;
  for (int i = 0; i < 9; ++i)
    s.moves(s.part("c" + std::to_string(i), {i - 4.0, 0, -0.2 * i}), {0.01 * i, 0.02 * i, 0.03 * i});
  for (const int max : {1, 2, 5})
    for (const FactoringWay way : {FactoringWay::Velocity, FactoringWay::Node}) {
      const FactoringStudy study = s.study(max, way);
      EXPECT_LE(study.chosen.specs.size(), static_cast<std::size_t>(max));
      EXPECT_EQ(layers::factor(s.scene, study.chosen.specs).unassigned_parts, 0);
    }
}

TEST(Factoring, ByNodeAloneIsWhatABareModelAlwaysWas) {
  const FactoredScene s = two_bodies();
  const FactoringStudy study = s.study(40, FactoringWay::Node);
  std::vector<std::vector<std::string>> expected;
  Factoring nodes;
  nodes.specs = layers::default_layer_specs(s.scene);
  EXPECT_THAT(s.parts_of(study.chosen), testing::UnorderedElementsAreArray(s.parts_of(nodes)));
}

// The canyon with all that its author said of layers forgotten: at 4 px what is found costs at most a tenth more than the author's
// layers, in polygons and in texels, and less than one layer per node, and than one for all.
TEST(Factoring, OfTheCanyonIsAsGoodAsTheAuthors) {
  sequences::Sequence canyon;
  try {
    canyon = sequences::load_sequence("canyon");
  } catch (const sequences::InputError&) {
    GTEST_SKIP() << "content was not fetched";
  }
  sequences::Settings settings = sequences::own_settings(canyon);
  std::vector<int> spec_of;
  int next = 0;
  for (const layers::Layer& layer : canyon.layers.layers)
    spec_of.push_back(layer.base < 0 ? next++ : spec_of[layer.base]);
  std::vector<sequences::SpecPair> order;
  for (const layers::ExplicitPair& pair : canyon.explicit_order)
    order.emplace_back(spec_of[pair.behind], spec_of[pair.front]);
  const sequences::PlannedFactoring authored =
      sequences::plan_of(*canyon.scene, canyon.layers, order, settings, canyon.frames);
  settings.explicit_order.clear();
  const FactoringStudy study = sequences::study({*canyon.scene, {}, {}, settings}, {});
  ASSERT_EQ(study.chosen.plan.frames, canyon.frames);
  EXPECT_LE(study.chosen.plan.polygons, 1.1 * authored.polygons);
  EXPECT_LE(study.chosen.plan.pixels, 1.1 * authored.pixels);
  for (const char* how : {"node", "one"}) {
    ASSERT_NE(other(study, how), nullptr);
    EXPECT_LT(study.chosen.plan.work_ms(), 0.75 * other(study, how)->plan.work_ms()) << how;
  }
}

// --- What is no scene to factor ---

TEST(Factoring, WithoutPartsThereAreNoLayers) {
  FactoredScene s;
  EXPECT_THAT(s.study().chosen.specs, IsEmpty());
}

TEST(Factoring, OnePartIsOneLayer) {
  FactoredScene s;
  s.part("alone", {0, 0, 0});
  EXPECT_THAT(s.parts_of(s.study().chosen), ElementsAre(ElementsAre("alone")));
}

// Nothing moves: everything is drawn once, whatever the layers are.
TEST(Factoring, WhereNothingMovesEachLayerIsDrawnOnce) {
  FactoredScene s;
  for (int i = 0; i < 4; ++i) s.part("c" + std::to_string(i), {2.0 * i - 3, 0, 0});
  const FactoringStudy study = s.study();
  EXPECT_EQ(study.chosen.plan.renders, static_cast<std::int64_t>(study.chosen.specs.size()));
}

TEST(Factoring, WhatIsBehindTheCameraCostsNothingAndIsInALayer) {
  FactoredScene s;
  for (int i = 0; i < 3; ++i) s.part("b" + std::to_string(i), {0, 0, 20.0 + i});
  const FactoringStudy study = s.study();
  EXPECT_EQ(study.chosen.plan.renders, 0);
  EXPECT_EQ(layers::factor(s.scene, study.chosen.specs).unassigned_parts, 0);
}

TEST(Factoring, WhatCoincidesIsOneLayer) {
  FactoredScene s;
  const int body = s.node("body", {0, 0, 0});
  for (int i = 0; i < 3; ++i) s.part("c" + std::to_string(i), {0, 0, 0}, body);
  s.spins(body, 0.3);
  EXPECT_THAT(s.study().chosen.specs, SizeIs(1));
}

TEST(Factoring, AFrameAloneCanBeFactored) {
  FactoredScene s = two_bodies();
  s.settings.frames = 1;
  const FactoringStudy study = s.study();
  EXPECT_EQ(layers::factor(s.scene, study.chosen.specs).unassigned_parts, 0);
  EXPECT_EQ(study.chosen.plan.frames, 1);
}

TEST(Factoring, PartsWithoutTrianglesAreTakenToo) {
  FactoredScene s = two_bodies();
  s.scene.meshes.emplace_back();
  s.part("nothing", {0, 0, 0}, -1, 2);
  EXPECT_EQ(layers::factor(s.scene, s.study().chosen.specs).unassigned_parts, 0);
}

// Globs cannot tell parts of one name apart; a name with a star takes no others.
TEST(Factoring, PartsOfOneNameStayTogether) {
  FactoredScene s;
  s.moves(s.part("twin", {-3, 0, 0}), {0.05, 0, 0});
  s.moves(s.part("twin", {3, 0, 0}), {-0.05, 0, 0});
  s.part("a*", {0, 3, 0});
  s.part("ab", {0, -3, 0});
  const FactoringStudy study = s.study();
  const layers::LayerSet set = layers::factor(s.scene, study.chosen.specs);
  EXPECT_EQ(set.defect, "");
  EXPECT_EQ(set.unassigned_parts, 0);
}

}  // namespace
}  // namespace talisman
