// SPDX-License-Identifier: Apache-2.0
// Ground and sky out of pictures. The pictures are tiny and written here (PGM and PPM).
#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/ground.h"
#include "sequences/content/ground_texture.h"
#include "sequences/content/sky.h"
#include "sequences/content/tile_image.h"
#include "sequences/pictures/srgb.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;

std::string pgm(int width, int height, const std::function<int(int, int)>& grey) {
  std::string bytes = "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) bytes += static_cast<char>(grey(x, y));
  return bytes;
}

std::string plain_ppm(int r, int g, int b, int size = 4) {
  std::string bytes = "P6\n" + std::to_string(size) + " " + std::to_string(size) + "\n255\n";
  for (int i = 0; i < size * size; ++i)
    bytes.append({static_cast<char>(r), static_cast<char>(g), static_cast<char>(b)});
  return bytes;
}

/// 8 × 21 samples; left half of class 0 (red tiles), right half of class 1 (blue tiles).
TerrainContent two_class_terrain(const TemporaryFolder& folder) {
  TerrainContent content;
  content.heights_file = folder.write("heights.pgm", pgm(8, 21, [](int x, int y) { return 10 * x + y; }));
  content.classes_file = folder.write("classes.pgm", pgm(8, 21, [](int x, int) { return x < 4 ? 3 : 250; }));
  content.classes = {{{0, 0, 0}, folder.write("red.ppm", plain_ppm(255, 0, 0))},
                     {{255, 255, 255}, folder.write("blue.ppm", plain_ppm(0, 0, 255))},
                     {{128, 128, 128}, "never opened, for no pixel is of this class"}};
  content.segments = 4;
  content.texels_per_cell = 2;
  content.smooth_cells = 0;
  content.low_m = 100, content.high_m = 355;
  content.cell_m = 2;
  return content;
}

TEST(HeightField, GreyIsHeight) {
  const TemporaryFolder folder;
  const layers::HeightField field = read_height_field(two_class_terrain(folder));
  ASSERT_EQ(field.columns, 8);
  ASSERT_EQ(field.rows, 21);
  EXPECT_FLOAT_EQ(field.heights_m[2 * 8 + 3], 100 + 32);
  // Centred in x, rows towards -z; bilinear in between, the border's height outside.
  EXPECT_NEAR(ground_height(field, -7, 0), 100, 1e-4);
  EXPECT_NEAR(ground_height(field, -6, -1), 105.5, 1e-4);
  EXPECT_NEAR(ground_height(field, -1e9, 1e9), 100, 1e-4);
}

TEST(HeightField, SmoothingKeepsSlopesAndTheMeanAndEndsSteps) {
  // A slope of one grey level in four samples, as 8-bit heights have it: its terraces must become even.
  const TemporaryFolder folder;
  TerrainContent content = two_class_terrain(folder);
  content.heights_file = folder.write("steps.pgm", pgm(80, 2, [](int x, int) { return x / 4; }));
  content.smooth_cells = 3;
  const layers::HeightField field = read_height_field(content);
  for (int x = 20; x < 60; ++x) {
    const float rise = field.heights_m[x + 1] - field.heights_m[x];
    EXPECT_NEAR(rise, 0.25, 0.02) << x;
    EXPECT_NEAR(field.heights_m[x], 100 + (x - 1.5) / 4, 0.02);
  }
}

TEST(HeightField, RowsBeforeTheFirstAreLeftOutOfHeightsAndColours) {
  const TemporaryFolder folder;
  TerrainContent content = two_class_terrain(folder);
  content.smooth_cells = 1;
  content.classes_file = folder.write("half.pgm", pgm(8, 21, [](int, int y) { return y < 12 ? 0 : 255; }));
  const layers::HeightField all = read_height_field(content);
  content.first_row = 12;
  const layers::HeightField rest = read_height_field(content);
  ASSERT_EQ(rest.rows, 9);
  // Smoothed before it is cut: a cut does not change the land that stays.
  EXPECT_TRUE(std::equal(rest.heights_m.begin(), rest.heights_m.end(), all.heights_m.begin() + 12 * 8));
  const layers::Texture blue = GroundPainter(content, rest).bake({0, 0, 7, 8}, 1);
  EXPECT_EQ(blue.rgba[0], 0);
  EXPECT_EQ(blue.rgba[2], 255);
  content.first_row = 20;
  EXPECT_THAT(message_of([&] { read_height_field(content); }),
              HasSubstr("8 × 21 from row 20, rule: at least 2 × 2"));
}

TEST(HeightField, TooSmallPicturesAreRefused) {
  const TemporaryFolder folder;
  TerrainContent content = two_class_terrain(folder);
  content.heights_file = folder.write("line.pgm", pgm(1, 9, [](int, int) { return 0; }));
  EXPECT_THAT(message_of([&] { read_height_field(content); }),
              HasSubstr("1 × 9 from row 0, rule: at least 2 × 2"));
}

TEST(AddTerrain, SegmentsGetTheirOwnTexturesAndTheColoursOfTheirClasses) {
  const TemporaryFolder folder;
  layers::Scene scene;
  add_terrain(scene, two_class_terrain(folder));
  ASSERT_EQ(scene.parts.size(), 4u);
  ASSERT_EQ(scene.textures.size(), 4u);
  EXPECT_EQ(layers::first_defect(scene), "");
  for (const layers::Part& part : scene.parts) {
    const layers::Mesh& mesh = scene.meshes[part.mesh];
    const layers::Texture& texture = scene.textures[scene.materials[part.material].texture];
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      // Strictly inside: filtering at the border may not wrap around.
      ASSERT_GT(mesh.uvs[i].x, 0.05f);
      ASSERT_LT(mesh.uvs[i].x, 0.95f);
      ASSERT_GT(mesh.uvs[i].y, 0.05f);
      ASSERT_LT(mesh.uvs[i].y, 0.95f);
      const int x = static_cast<int>(mesh.uvs[i].x * texture.width),
                y = static_cast<int>(mesh.uvs[i].y * texture.height);
      const std::uint8_t* texel = &texture.rgba[4 * (static_cast<std::size_t>(y) * texture.width + x)];
      const float metres = mesh.positions[i].x;  // the classes meet at x = 0, within one cell of 2 m
      const std::uint8_t red = texel[0], blue = texel[2];
      ASSERT_TRUE(metres >= -2 || (red == 255 && blue == 0)) << metres;
      ASSERT_TRUE(metres <= 2 || (red == 0 && blue == 255)) << metres;
    }
  }
}

TEST(AddTerrain, TexturesContinueOverTheSeams) {
  // The colour of a place may not depend on the segment that shows it; here it changes along the rows.
  const TemporaryFolder folder;
  TerrainContent content = two_class_terrain(folder);
  content.classes_file =
      folder.write("rows.pgm", pgm(8, 21, [](int, int y) { return y % 3 == 0 ? 0 : 255; }));
  const layers::HeightField field = read_height_field(content);
  const GroundPainter painter(content, field);
  const layers::Texture all = painter.bake({0, 0, 7, 20}, 4), part = painter.bake({0, 6, 7, 5}, 4);
  const std::size_t row_bytes = 4 * static_cast<std::size_t>(all.width);
  EXPECT_TRUE(std::equal(part.rgba.begin(), part.rgba.end(),
                         all.rgba.begin() + static_cast<std::ptrdiff_t>(6 * 4 * row_bytes)));
}

TEST(AddTerrain, WithoutClassesItIsOneColour) {
  const TemporaryFolder folder;
  TerrainContent content = two_class_terrain(folder);
  content.classes_file.clear();
  layers::Scene scene;
  add_terrain(scene, content);
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_EQ(scene.materials[0].texture, -1);
}

TEST(AddTerrain, ClassImageOfAnotherSizeIsRefused) {
  const TemporaryFolder folder;
  TerrainContent content = two_class_terrain(folder);
  content.classes_file = folder.write("small.pgm", pgm(7, 21, [](int, int) { return 0; }));
  layers::Scene scene;
  EXPECT_THAT(message_of([&] { add_terrain(scene, content); }),
              HasSubstr("7 × 21, rule: as many pixels as the height map, 8 × 21"));
}

TEST(GroundClasses, ListIsReadAsTheGameReadsIt) {
  // Comments, entries over several lines, a texture without extension, an entry without colour.
  const TemporaryFolder folder;
  const std::string file =
      folder.write("terrains.lst",
                   "# *[name] old [texture] old.png [col] 1 1 1\n"
                   "*[name] ice [texture] ice.png [friction] 0.2\n\t[col] 0 60 120 [sound] x\n"
                   "*[name] rock [texture] rock [depth] 1 [col] 127 127 127\n*[name] none [texture] a.png\n");
  const std::vector<GroundClass> classes = read_ground_classes(file);
  ASSERT_EQ(classes.size(), 2u);
  EXPECT_EQ(classes[0].rgb, (std::array<int, 3>{0, 60, 120}));
  EXPECT_EQ(classes[0].texture_file, folder.path() + "/ice.png");
  EXPECT_EQ(classes[1].texture_file, folder.path() + "/rock.png");
  EXPECT_THAT(message_of([&] { read_ground_classes(folder.write("none.lst", "nothing")); }),
              HasSubstr("lists no ground class"));
}

TEST(TileImage, SrgbComesBackForEveryByte) {
  for (int v = 0; v < 256; ++v) EXPECT_EQ(srgb_byte(linear_from_srgb(static_cast<float>(v) / 255.0f)), v);
  EXPECT_EQ(srgb_byte(-1), 0);
  EXPECT_EQ(srgb_byte(7), 255);
}

TEST(TileImage, RepeatsAndInterpolates) {
  TileImage tile{2, 1, {layers::vec3(0), layers::vec3(1)}};
  EXPECT_FLOAT_EQ(tile(0.25, 0.5).x, 0);
  EXPECT_FLOAT_EQ(tile(0.75, 0.5).x, 1);
  EXPECT_FLOAT_EQ(tile(0.5, 0.1).x, 0.5f);
  EXPECT_FLOAT_EQ(tile(1.0, 0.9).x, 0.5f);  // over the border, to the next repetition
  EXPECT_FLOAT_EQ(tile(-1.75, -3).x, 0);
}

TEST(TileImage, ReducingKeepsTheMeanAndStopsAtTheTexelSize) {
  TileImage tile{8, 8, {}};
  for (int i = 0; i < 64; ++i) tile.texels.push_back(layers::vec3(static_cast<float>(i % 5)));
  float mean = 0;
  for (const auto& t : tile.texels) mean += t.x / 64;
  const TileImage reduced = reduced_tile(tile, 8, 4);  // 1 m texels → at least 3 m: two halvings
  ASSERT_EQ(reduced.width, 2);
  EXPECT_NEAR((reduced.texels[0].x + reduced.texels[1].x + reduced.texels[2].x + reduced.texels[3].x) / 4,
              mean, 1e-5);
  EXPECT_EQ(reduced_tile(tile, 8, 1).width, 8);
}

TEST(AddSky, DomeAndBackdropFaceTheirCentreAndShowTheGradient) {
  for (const auto kind : {SkyContent::Kind::Dome, SkyContent::Kind::Backdrop}) {
    SkyContent sky;
    sky.kind = kind;
    sky.azimuth_deg = {-50, 70};
    sky.elevation_deg = {-10, 45};
    sky.radius_m = 500;
    sky.texels = {64, 32};
    layers::Scene scene;
    add_sky(scene, sky);
    ASSERT_EQ(layers::first_defect(scene), "");
    const layers::Mesh& mesh = scene.meshes[0];
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) { return layers::dvec3(mesh.positions[mesh.indices[i + k]]); };
      const layers::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      EXPECT_LT(glm::dot(normal, corner(0)), 0) << "triangle " << i / 3 << " looks away from the centre";
    }
    double nearest = 1e9, leftmost = 0, rightmost = 0;
    for (const layers::vec3& p : mesh.positions) {
      nearest = std::min(nearest, glm::length(layers::dvec3(p)));
      const double azimuth = glm::degrees(std::atan2(p.x, -p.z));
      leftmost = std::min(leftmost, azimuth), rightmost = std::max(rightmost, azimuth);
    }
    EXPECT_GE(nearest, 499.9);
    EXPECT_NEAR(leftmost, -50, 1e-3);
    EXPECT_NEAR(rightmost, 70, 1e-3);
    const layers::Texture& texture = scene.textures[0];
    // Top row, in the middle: towards its corners a flat picture is lower in the sky.
    EXPECT_NEAR(texture.rgba[4 * 32], srgb_byte(sky.zenith.x), 1);
    EXPECT_EQ(texture.rgba[texture.rgba.size() - 4], srgb_byte(sky.horizon.x));
  }
}

}  // namespace
}  // namespace talisman::sequences
