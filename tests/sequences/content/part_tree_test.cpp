// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/parts/part_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/parts/axes_picture.h"
#include "tests/sequences/import/gltf_builder.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

/// root > (hull with a square, eye > lens), and a second square 3 m to the right, half as large.
tests::Gltf tree() {
  tests::Gltf file;
  file.json["nodes"] = tests::Json::array(
      {{{"name", "root"}, {"children", {1, 2}}},
       {{"name", "hull"}, {"mesh", 0}},
       {{"name", "eye"}, {"children", {3}}},
       {{"name", "lens"}},
       {{"name", "sail"}, {"mesh", 0}, {"translation", {3, 0, 1}}, {"scale", {0.5, 0.5, 0.5}}}});
  file.json["scenes"][0]["nodes"] = {0, 4};
  return file;
}

Sequence loaded(const TemporaryFolder& folder, const tests::Gltf& file) {
  return load_sequence(folder.write("ship.gltf", file.text()), {.stage = false});
}

TEST(PartTree, KnowsPlacesInMetresAndWhatHasNothingToDraw) {
  const TemporaryFolder folder;
  const PartTree tree_ = part_tree(loaded(folder, tree()));
  ASSERT_EQ(tree_.parts.size(), 2u);
  EXPECT_EQ(tree_.parts[0].name, "root/hull");
  EXPECT_EQ(tree_.parts[1].name, "sail");
  EXPECT_EQ(tree_.parts[0].polygons, 2);
  // The square of ±1, halved, at (3, 0, 1).
  EXPECT_EQ(tree_.parts[1].bounds.lo, layers::dvec3(2.5, -0.5, 1));
  EXPECT_EQ(tree_.parts[1].bounds.hi, layers::dvec3(3.5, 0.5, 1));
  EXPECT_EQ(tree_.bounds.lo, layers::dvec3(-1, -1, 0));
  EXPECT_EQ(tree_.bounds.hi, layers::dvec3(3.5, 1, 1));
  std::vector<std::string> names;
  for (const NodeRow& node : tree_.nodes) names.push_back(std::string(node.depth, ' ') + node.name);
  EXPECT_THAT(names, ElementsAre("root", " hull", "sail"));
  EXPECT_EQ(tree_.other_nodes, 4) << "eye, lens, and the two of the camera that it is given";
}

TEST(PartTree, NamesAreThoseThatGlobsMatch) {
  const TemporaryFolder folder;
  const PartTree tree_ = part_tree(loaded(folder, tree()));
  for (const PartRow& part : tree_.parts) {
    const std::string yaml = "frames: 1\nmodels: [{id: s, file: ship.gltf}]\nlayers: [{name: l, parts: ['s/" +
                             part.name + "']}]\n";
    EXPECT_EQ(load_sequence(folder.write("s.yaml", yaml)).layers.layers[0].polygons, part.polygons);
  }
}

TEST(PartTree, TexturesAreFoundInsideOrMissing) {
  const TemporaryFolder folder;
  folder.write("red.ppm", "P6\n1 1\n255\n\xff\x01\x01");
  folder.write("two.mtl", "newmtl a\nmap_Kd red.ppm\nnewmtl b\nmap_Kd gone.png\n");
  const Sequence sequence =
      load_sequence(folder.write("two.obj",
                                 "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\no x\nusemtl a\nf 1/1 "
                                 "2/1 3/1\no y\nusemtl b\nf 1/1 3/1 2/1\n"));
  const PartTree tree_ = part_tree(sequence);
  ASSERT_EQ(tree_.textures.size(), 1u);
  EXPECT_EQ(tree_.textures[0].file, folder / "red.ppm");
  EXPECT_THAT(tree_.not_drawn, ElementsAre(HasSubstr("'gone.png'")));
  const std::string text = text_of(tree_);
  EXPECT_THAT(text, HasSubstr("1x1         " + (folder / "red.ppm")));
  EXPECT_THAT(text, HasSubstr("not in the picture\n"));

  tests::Gltf embedded;
  const std::string picture = "P6\n1 1\n255\n\x01\x01\xff";
  embedded.json["images"].push_back(
      {{"bufferView", embedded.view(std::vector<std::uint8_t>(picture.begin(), picture.end()))},
       {"mimeType", "image/x-ppm"},
       {"name", "paint"}});
  embedded.json["textures"].push_back({{"source", 0}});
  embedded.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  embedded.primitive()["material"] = 0;
  const PartTree inside = part_tree(loaded(folder, embedded));
  ASSERT_EQ(inside.textures.size(), 1u);
  EXPECT_EQ(inside.textures[0].file, "");
  EXPECT_THAT(text_of(inside), HasSubstr("inside the model's file"));
}

TEST(PartTree, PartsInNoLayerAreNotDrawn) {
  const TemporaryFolder folder;
  const PartTree tree_ =
      part_tree(load_sequence(folder.write("s.yaml",
                                           "frames: 1\nshapes: [{id: a, box: [1, 1, 1]}, {id: b, box: [1, 1, "
                                           "1]}]\nlayers: [{name: l, parts: [a]}]\n")));
  EXPECT_EQ(tree_.parts[0].layer, "l");
  EXPECT_EQ(tree_.parts[1].layer, "");
  EXPECT_THAT(text_of(tree_), HasSubstr("none: not drawn"));
}

/// Where the last pixels of a colour lie, far from the middle.
layers::dvec2 end_of(const Image8& image, const std::array<int, 3>& rgb) {
  layers::dvec2 end(0.5 * image.width);
  double farthest = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = 3 * (static_cast<std::size_t>(y) * image.width + x);
      bool is_it = true;
      for (std::size_t k = 0; k < 3; ++k) is_it &= image.rgb[at + k] == rgb[k];
      const layers::dvec2 place(x, y);
      if (const double d = glm::distance(place, layers::dvec2(0.5 * image.width)); is_it && d > farthest)
        farthest = d, end = place;
    }
  return end;
}

// The eye is at (0.75, 0.6, -1) from the middle: to its left, on the display, lies +x turned by cross(y, z) = (-1, 0,
// -0.75)/1.25: x of the eye. So +x goes left, +z goes left too but behind, y goes up, and the nose comes to the right
// and down.
TEST(AxesPicture, AxesGoWhereTheyAreSeen) {
  const TemporaryFolder folder;
  const Image8 image = axes_picture(
      load_sequence(folder.write("s.yaml", "frames: 1\nshapes: [{id: a, box: [2, 2, 2]}]\n")), 256);
  ASSERT_EQ(image.width, 256);
  const layers::dvec2 x = end_of(image, {255, 80, 80}), y = end_of(image, {90, 230, 90}),
                      z = end_of(image, {120, 150, 255}), nose = end_of(image, {255, 80, 240});
  EXPECT_LT(x.x, 100);
  EXPECT_LT(y.y, 90);
  EXPECT_LT(z.x, 128);
  EXPECT_LT(z.y, 128) << "away from the eye: up on the display";
  EXPECT_GT(nose.x, 128);
  EXPECT_GT(nose.y, 128) << "towards the eye: down on the display";
}

}  // namespace
}  // namespace talisman::sequences
