// SPDX-License-Identifier: Apache-2.0
#include "layers/layer.h"

#include <numeric>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/glob.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Nodes given as (name, parent) in order, each with one cube part unless its name starts with '.'.
Scene tree(const std::vector<std::pair<std::string, int>>& nodes) {
  Scene scene;
  scene.meshes = {tests::cube_mesh()};
  scene.materials.resize(1);
  std::vector<std::string> paths;
  for (const auto& [name, parent] : nodes) {
    Node node;
    node.name = name;
    node.parent = parent;
    paths.push_back(parent < 0 ? name : paths[parent] + "/" + name);
    if (name[0] != '.') scene.parts.push_back({paths.back(), static_cast<int>(scene.nodes.size()), 0, 0, -1});
    scene.nodes.push_back(node);
  }
  return scene;
}

LayerSpec spec(std::string name, std::vector<std::string> globs) {
  LayerSpec s;
  s.name = std::move(name);
  s.part_globs = std::move(globs);
  return s;
}

LayerSet factored(const Scene& scene, const std::vector<LayerSpec>& specs) { return factor(scene, specs); }

int rigid_node_of_all(const Scene& scene) {
  return factored(scene, {spec("all", {"*"})}).layers[0].rigid_node;
}

// --- Globs ---

TEST(GlobMatches, TextWithoutWildcardsOnlyItself) {
  EXPECT_TRUE(glob_matches("hull", "hull"));
  EXPECT_FALSE(glob_matches("hull", "hulls"));
  EXPECT_FALSE(glob_matches("hull", "hul"));
  EXPECT_FALSE(glob_matches("hull", "Hull"));
}

TEST(GlobMatches, StarIsAnyRun) {
  EXPECT_TRUE(glob_matches("*", ""));
  EXPECT_TRUE(glob_matches("ship*", "ship"));
  EXPECT_TRUE(glob_matches("ship*", "ship/hull#2"));
  EXPECT_TRUE(glob_matches("*hull", "ship/hull"));
  EXPECT_FALSE(glob_matches("*hull", "ship/hull#2"));
  EXPECT_TRUE(glob_matches("a**b", "ab"));
}

TEST(GlobMatches, QuestionMarkIsExactlyOne) {
  EXPECT_TRUE(glob_matches("leg?", "leg1"));
  EXPECT_FALSE(glob_matches("leg?", "leg"));
  EXPECT_FALSE(glob_matches("leg?", "leg12"));
}

// The first place where the piece after a star fits is not the one that leads to the end.
TEST(GlobMatches, StarsBacktrack) {
  EXPECT_TRUE(glob_matches("*ab", "aab"));
  EXPECT_TRUE(glob_matches("a*bc*d", "abbcbcxd"));
  EXPECT_FALSE(glob_matches("a*bc*d", "abbbcx"));
}

TEST(GlobMatches, EmptyGlobOnlyEmptyText) {
  EXPECT_TRUE(glob_matches("", ""));
  EXPECT_FALSE(glob_matches("", "a"));
}

TEST(GlobMatches, BackslashMakesAWildcardMeanItself) {
  EXPECT_TRUE(glob_matches("leg\\?", "leg?"));
  EXPECT_FALSE(glob_matches("leg\\?", "leg1"));
  EXPECT_TRUE(glob_matches("*\\*", "ab*"));
  EXPECT_FALSE(glob_matches("*\\*", "ab"));
  EXPECT_TRUE(glob_matches("a\\b\\", "a\\b\\")) << "before anything else it is itself";
  EXPECT_TRUE(has_wildcard("\\*?"));
  EXPECT_FALSE(has_wildcard("\\*\\?"));
}

TEST(GlobMatches, GlobOfANameMatchesThatNameAlone) {
  const std::string letters = "a*?\\";
  std::vector<std::string> names;
  for (int k = 0; k < 4 * 4 * 4 * 4; ++k) {
    std::string& name = names.emplace_back();
    for (int i = 0, rest = k; i < 4; ++i, rest /= 4) name += letters[rest % 4];
  }
  for (const std::string& name : names) {
    const std::string glob = glob_of_name(name);
    EXPECT_FALSE(has_wildcard(glob)) << name;
    EXPECT_EQ(name_of_glob(glob), name);
    for (const std::string& other : names) ASSERT_EQ(glob_matches(glob, other), name == other) << name;
  }
}

// Against a plain recursion, on a small alphabet where almost everything nearly matches.
bool matches_slowly(const std::string& glob, const std::string& text) {
  if (glob.empty()) return text.empty();
  if (glob[0] == '\\' && glob.size() > 1 && (glob[1] == '*' || glob[1] == '?'))
    return !text.empty() && glob[1] == text[0] && matches_slowly(glob.substr(2), text.substr(1));
  if (glob[0] == '*')
    return matches_slowly(glob.substr(1), text) || (!text.empty() && matches_slowly(glob, text.substr(1)));
  return !text.empty() && (glob[0] == '?' || glob[0] == text[0]) &&
         matches_slowly(glob.substr(1), text.substr(1));
}

TEST(GlobMatches, AgreesWithTheDefinitionOnAllShortStrings) {
  const std::string letters = "a*?\\";
  int matched = 0;
  for (int g = 0; g < 4 * 4 * 4 * 4 * 4; ++g)
    for (int t = 0; t < 4 * 4 * 4 * 4; ++t) {
      std::string glob, text;
      for (int i = 0, rest = g; i < 5; ++i, rest /= 4) glob += letters[rest % 4];
      for (int i = 0, rest = t; i < 4; ++i, rest /= 4) text += letters[rest % 4];
      ASSERT_EQ(glob_matches(glob, text), matches_slowly(glob, text)) << glob << " " << text;
      matched += glob_matches(glob, text);
    }
  EXPECT_GT(matched, 1000);
}

// Exponential in a naive matcher.
TEST(GlobMatches, ManyStarsAreFast) {
  std::string glob;
  for (int i = 0; i < 200; ++i) glob += "*a";
  EXPECT_FALSE(glob_matches(glob + "b", std::string(5000, 'a')));
}

// --- factor ---

TEST(Factor, EmptySceneAndNoSpecsGiveNothing) {
  const LayerSet set = factor(Scene{}, {});
  EXPECT_TRUE(set.layers.empty());
  EXPECT_EQ(set.defect, "");
  EXPECT_EQ(set.unassigned_parts, 0);
}

TEST(Factor, PartBelongsToTheFirstLayerThatTakesIt) {
  const Scene scene = tree({{"ship", -1}, {"hull", 0}, {"mast", 0}, {"sea", -1}});
  const LayerSet set = factored(scene, {spec("hull", {"*/hull"}), spec("ship", {"ship*"})});
  EXPECT_EQ(set.defect, "");
  ASSERT_EQ(set.layers.size(), 2u);
  EXPECT_THAT(set.layers[0].parts, ElementsAre(1));
  EXPECT_THAT(set.layers[1].parts, ElementsAre(0, 2));
  EXPECT_EQ(set.layers[1].polygons, 24);
  EXPECT_EQ(set.layers[1].id, 1);
  EXPECT_EQ(set.unassigned_parts, 1) << "the sea";
}

TEST(Factor, PartsAreAscendingWhateverTheOrderOfGlobs) {
  const Scene scene = tree({{"a", -1}, {"b", -1}, {"c", -1}});
  EXPECT_THAT(factored(scene, {spec("all", {"c", "a", "*"})}).layers[0].parts, ElementsAre(0, 1, 2));
}

TEST(Factor, GlobThatMatchesNothingIsADefect) {
  const LayerSet set = factored(tree({{"boat", -1}}), {spec("x", {"boat", "ship*"})});
  EXPECT_EQ(set.defect, "layer 'x': part glob 'ship*' matches no part");
}

TEST(Factor, LayerLeftWithoutPartsIsADefect) {
  const Scene scene = tree({{"a", -1}});
  EXPECT_THAT(factored(scene, {spec("x", {"*"}), spec("y", {"a"})}).defect,
              HasSubstr("layer 'y': has no parts left"));
  EXPECT_THAT(factored(scene, {spec("x", {})}).defect, HasSubstr("layer 'x': has no part globs"));
}

TEST(Factor, NameUsedTwiceIsADefect) {
  const Scene scene = tree({{"a", -1}, {"b", -1}});
  EXPECT_THAT(factored(scene, {spec("x", {"a"}), spec("x", {"b"})}).defect,
              HasSubstr("layer 'x': name is used twice"));
}

TEST(Factor, PreferencesOutOfRangeAreDefects) {
  const Scene scene = tree({{"a", -1}});
  const auto defect_with = [&](auto harm) {
    LayerSpec s = spec("x", {"a"});
    harm(s.preferences);
    return factored(scene, {s}).defect;
  };
  EXPECT_EQ(defect_with([](LayerPreferences&) {}), "");
  EXPECT_THAT(defect_with([](auto& p) { p.resolution_scale = 5; }),
              HasSubstr("resolution_scale is 5, rule: above 0"));
  EXPECT_THAT(defect_with([](auto& p) { p.resolution_scale = NAN; }), HasSubstr("resolution_scale is nan"));
  EXPECT_THAT(defect_with([](auto& p) { p.min_update_rate = -1; }), HasSubstr("min_update_rate is -1"));
  EXPECT_THAT(defect_with([](auto& p) { p.min_update_rate = 0.6, p.max_update_rate = 0.5; }),
              HasSubstr("at most max_update_rate"));
  EXPECT_THAT(defect_with([](auto& p) { p.max_update_rate = 0; }), HasSubstr("max_update_rate is 0"));
  EXPECT_THAT(defect_with([](auto& p) { p.importance.sampling = -2; }), HasSubstr("importance is -2"));
  EXPECT_THAT(defect_with([](auto& p) { p.share_of_expected_motion = HUGE_VAL; }),
              HasSubstr("share_of_expected_motion"));
}

// --- rigid_node ---

TEST(RigidNode, IsTheDeepestCommonAncestorOfWhatStandsStill) {
  EXPECT_EQ(rigid_node_of_all(tree({{".world", -1}, {".house", 0}, {"roof", 1}, {"wall", 1}})), 1);
  EXPECT_EQ(rigid_node_of_all(tree({{".world", -1}, {"house", 0}, {"roof", 1}})), 1)
      << "one of the parts' own node";
}

TEST(RigidNode, SeparateTreesAtRestUseAnyOfTheirNodes) {
  const Scene scene = tree({{"a", -1}, {"b", -1}});
  const int node = rigid_node_of_all(scene);
  ASSERT_GE(node, 0);
  EXPECT_FALSE(is_animated(scene, node));
}

TEST(RigidNode, WhatIsCarriedTogetherIsRigid) {
  Scene scene = tree({{".world", -1}, {".ship", 0}, {"hull", 1}, {"mast", 1}});
  scene.tracks = {{1, SpinTrack{}}};
  EXPECT_EQ(rigid_node_of_all(scene), 1);
  scene.tracks = {{0, SpinTrack{}}};
  EXPECT_EQ(rigid_node_of_all(scene), 1) << "what moves is above";
}

TEST(RigidNode, PartsThatMoveAgainstEachOtherHaveNone) {
  Scene scene = tree({{".ship", -1}, {"hull", 0}, {"radar", 0}});
  scene.tracks = {{0, SpinTrack{}}, {2, SpinTrack{}}};
  EXPECT_EQ(rigid_node_of_all(scene), -1);
  scene.tracks = {{2, SpinTrack{}}};
  EXPECT_EQ(rigid_node_of_all(scene), -1) << "one moves, one rests";
}

TEST(RigidNode, TracksThatMoveNothingDoNotCount) {
  Scene scene = tree({{".ship", -1}, {"hull", 0}, {"radar", 0}});
  scene.tracks = {{2, SpinTrack{{0, 1, 0}, 0}}};
  EXPECT_EQ(rigid_node_of_all(scene), 0);
}

TEST(RigidNode, SkinnedPartsHaveNone) { EXPECT_EQ(rigid_node_of_all(tests::skinned_bar_scene()), -1); }

// The definition, tested: in the space of the rigid node the parts must not move.
TEST(RigidNode, PartsStandStillInItsSpace) {
  Scene scene = tree({{".world", -1}, {".ship", 0}, {"hull", 1}, {".boom", 1}, {"sail", 3}, {"radar", 1}});
  scene.nodes[4].local.translation = {1, 2, 3};
  scene.tracks = {{1, SpinTrack{{1, 2, 3}, 1}}, {5, SpinTrack{}}};
  const LayerSet set = factored(scene, {spec("rigid", {"*hull", "*sail"}), spec("radar", {"*radar"})});
  for (const Layer& layer : set.layers) {
    ASSERT_GE(layer.rigid_node, 0) << layer.name;
    const auto in_node = [&](double t_s, int part) {
      const SceneFrame frame = scene.at(t_s);
      return glm::inverse(frame.world_from_node[layer.rigid_node]) *
             frame.world_from_node[scene.parts[part].node];
    };
    for (const int part : layer.parts)
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
          EXPECT_NEAR(in_node(0.3, part)[column][row], in_node(2.9, part)[column][row], 1e-12);
  }
}

// --- default_layer_specs ---

std::vector<std::string> default_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& s : default_layer_specs(scene)) names.push_back(s.name);
  return names;
}

TEST(DefaultLayerSpecs, EmptySceneHasNone) { EXPECT_TRUE(default_layer_specs(Scene{}).empty()); }

TEST(DefaultLayerSpecs, OnePerMovingNodeAndTheRestByTopLevel) {
  EXPECT_THAT(default_names(tests::moving_scene()), ElementsAre("ground", "cube", "orbit"));
}

TEST(DefaultLayerSpecs, MovingNodeInsideAMovingNodeIsALayerOfItsOwn) {
  Scene scene = tree({{".ship", -1}, {"hull", 0}, {"radar", 0}, {"mast", 0}});
  scene.tracks = {{0, SpinTrack{}}, {2, SpinTrack{}}};
  const LayerSet set = factor(scene, default_layer_specs(scene));
  ASSERT_EQ(set.layers.size(), 2u);
  EXPECT_THAT(set.layers[0].parts, ElementsAre(0, 2));
  EXPECT_EQ(set.layers[0].rigid_node, 0);
  EXPECT_THAT(set.layers[1].parts, ElementsAre(1));
}

TEST(DefaultLayerSpecs, SceneAtRestGoesByTopLevelNodes) {
  EXPECT_THAT(default_names(tree({{".a", -1}, {"x", 0}, {"y", 0}, {"b", -1}, {".empty", -1}})),
              ElementsAre(".a", "b"));
}

// Readers put everything below one root; as one layer the scene could not be factored at all.
TEST(DefaultLayerSpecs, RootsThatOnlyHoldTheSceneTogetherDoNotCount) {
  EXPECT_THAT(default_names(tree({{".root", -1}, {".unit", 0}, {"a", 1}, {"b", 1}})), ElementsAre("a", "b"));
}

TEST(DefaultLayerSpecs, NamesAreMadeUnique) {
  Scene scene = tree({{".l", -1}, {".r", -1}, {"wheel", 0}, {"wheel", 1}});
  scene.tracks = {{2, SpinTrack{}}, {3, SpinTrack{}}};
  scene.nodes[2].name = scene.nodes[3].name = "wheel";
  EXPECT_THAT(default_names(scene), ElementsAre("wheel", "wheel#2"));
}

TEST(DefaultLayerSpecs, SkinsOfOneFigureAreOneLayer) {
  Scene scene = tests::skinned_bar_scene();
  scene.skins.push_back(scene.skins[0]);
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "bar#1";
  scene.parts[1].skin = 1;
  const LayerSet set = factor(scene, default_layer_specs(scene));
  ASSERT_EQ(set.layers.size(), 1u);
  EXPECT_EQ(set.layers[0].parts.size(), 2u);
}

// Names that collide or hold wildcards must neither make a defect nor lose a part.
TEST(DefaultLayerSpecs, NastyNamesLoseNoPart) {
  const Scene scene =
      tree({{"a", -1}, {"a", -1}, {"*", -1}, {"?", -1}, {"a*", -1}, {"ab", -1}, {"a?", -1}, {"**", -1}});
  const LayerSet set = factor(scene, default_layer_specs(scene));
  EXPECT_EQ(set.defect, "");
  EXPECT_EQ(set.unassigned_parts, 0);
}

TEST(DefaultLayerSpecs, TenThousandNodesAreFactored) {
  std::vector<std::pair<std::string, int>> nodes;
  for (int i = 0; i < 10000; ++i) nodes.emplace_back("node" + std::to_string(i), -1);
  const Scene scene = tree(nodes);
  const LayerSet set = factor(scene, default_layer_specs(scene));
  EXPECT_EQ(set.layers.size(), 10000u);
  EXPECT_EQ(set.unassigned_parts, 0);
}

}  // namespace
}  // namespace talisman::layers
