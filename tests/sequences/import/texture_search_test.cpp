// SPDX-License-Identifier: Apache-2.0
// Which files a model may open: what lies in its own tree, in that of the sequence, or where --assets says.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/import/model_import.h"
#include "sequences/import/texture_io.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::TemporaryFolder;

constexpr const char* kObj = "mtllib tri.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n";
constexpr const char* kPicture = "P6\n1 1\n255\nabc";

std::string mtl(const std::string& texture) { return "newmtl paint\nKd 1 1 1\nmap_Kd " + texture + "\n"; }

/// A model in models/ whose material names the texture.
std::string model_with(const TemporaryFolder& folder, const std::string& texture) {
  folder.write("models/tri.mtl", mtl(texture));
  return folder.write("models/tri.obj", kObj);
}

bool has_texture(const ImportedModel& model) { return !model.scene.textures.empty(); }

TEST(ModelFiles, BelowTheModelAreOpened) {
  const TemporaryFolder folder;
  folder.write("models/deep/er/paint.ppm", kPicture);
  EXPECT_TRUE(has_texture(import_model(model_with(folder, "deep/er/paint.ppm"))));
}

TEST(ModelFiles, AboveTheModelAreNotOpenedUnlessAFolderIsGiven) {
  const TemporaryFolder folder;
  folder.write("shared/paint.ppm", kPicture);
  const std::string model = model_with(folder, "../shared/paint.ppm");
  const ImportedModel alone = import_model(model);
  EXPECT_FALSE(has_texture(alone));
  EXPECT_THAT(alone.warnings.at(0), HasSubstr("'../shared/paint.ppm': is missing"));
  EXPECT_TRUE(has_texture(import_model(model, {}, {folder / "shared"})));  // by its name there
}

TEST(ModelFiles, PathsAreTakenRelativeToFurtherFoldersToo) {
  const TemporaryFolder folder;
  folder.write("library/metal/paint.ppm", kPicture);
  EXPECT_TRUE(has_texture(import_model(model_with(folder, "metal/paint.ppm"), {}, {folder / "library"})));
}

TEST(ModelFiles, AbsolutePathsAreTriedByTheirName) {
  const TemporaryFolder folder;
  folder.write("elsewhere/secret.ppm", kPicture);
  const std::string model = model_with(folder, folder / "elsewhere/secret.ppm");
  EXPECT_FALSE(has_texture(import_model(model)));
  folder.write("models/secret.ppm", kPicture);
  EXPECT_TRUE(has_texture(import_model(model)));
}

TEST(ModelFiles, LinksThatLeadOutAreNotFollowed) {
  const TemporaryFolder folder;
  folder.write("elsewhere/secret.ppm", kPicture);
  const std::string model = model_with(folder, "link.ppm");
  std::filesystem::create_symlink(folder / "elsewhere/secret.ppm", folder / "models/link.ppm");
  EXPECT_FALSE(has_texture(import_model(model)));
  EXPECT_TRUE(has_texture(import_model(model, {}, {folder / "elsewhere"})));  // now it leads to where it may
}

TEST(ModelFiles, MaterialsOfOtherFoldersAreNotOpened) {
  const TemporaryFolder folder;
  folder.write("elsewhere/tri.mtl", "newmtl paint\nKd 0 1 0\n");
  const std::string model = folder.write(
      "models/tri.obj", "mtllib ../elsewhere/tri.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n");
  const auto green = [](const ImportedModel& m) {
    const layers::vec3 c = m.scene.materials.at(m.scene.parts.at(0).material).base_color;
    return c.y > 0.9f && c.x < 0.1f;
  };
  EXPECT_FALSE(green(import_model(model)));
  EXPECT_TRUE(green(import_model(model, {}, {folder / "elsewhere"})));
}

TEST(ModelFiles, OfASequenceMayLieInItsFolder) {
  const TemporaryFolder folder;
  folder.write("show/paint.ppm", kPicture);
  folder.write("show/models/tri.mtl", mtl("../paint.ppm"));
  folder.write("show/models/tri.obj", kObj);
  const std::string text = "frames: 1\nmodels: [{id: m, file: models/tri.obj}]\n";
  EXPECT_THAT(load_sequence(folder.write("show/show.yaml", text)).warnings, IsEmpty());
}

TEST(ModelFiles, OfASequenceMayLieInItsAssets) {
  const TemporaryFolder folder;
  folder.write("library/paint.ppm", kPicture);
  folder.write("show/tri.mtl", mtl("d:\\art\\paint.ppm"));
  folder.write("show/tri.obj", kObj);
  const std::string text = "frames: 1\nmodels: [{id: m, file: tri.obj}]\n";
  EXPECT_THAT(load_sequence(folder.write("show/show.yaml", text)).warnings.size(), 1u);
  EXPECT_THAT(load_sequence(folder.write("show/keyed.yaml", text + "assets: [../library]\n")).warnings,
              IsEmpty());
  EXPECT_THAT(load_sequence(folder / "show/show.yaml", {.assets = {folder / "library"}}).warnings, IsEmpty());
  EXPECT_THAT(tests::message_of(
                  [&] { load_sequence(folder.write("show/wrong.yaml", text + "assets: [nowhere]\n")); }),
              HasSubstr("folders that are there"));
}

/// A picture of one red texel with this alpha, as TGA.
std::string red_texel(char alpha) {
  std::string bytes(18, '\0');
  bytes[2] = 2, bytes[12] = bytes[14] = 1, bytes[16] = 32, bytes[17] = 8;
  return bytes + std::string("\0\0\xff", 3) + alpha;
}

TEST(ModelFiles, EmptyAlphaOfOldPaintersIsLeftOutAndSaid) {
  const TemporaryFolder folder;
  folder.write("models/paint.tga", red_texel(0));
  const ImportedModel model = import_model(model_with(folder, "paint.tga"));
  EXPECT_FALSE(model.scene.textures.at(0).has_alpha);
  EXPECT_EQ(model.scene.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255}));
  EXPECT_THAT(model.warnings.at(0), HasSubstr("every texel is clear (alpha 0): alpha is left out"));
}

TEST(ModelFiles, AlphaThatIsNotEmptyHolds) {
  const TemporaryFolder folder;
  folder.write("models/paint.tga", red_texel(1));
  const ImportedModel model = import_model(model_with(folder, "paint.tga"));
  EXPECT_EQ(model.scene.textures.at(0).rgba[3], 1);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(Pictures, ClearPictureIsClear) {
  const TemporaryFolder folder;
  const layers::Texture clear = read_texture(folder.write("clear.tga", red_texel(0)));
  EXPECT_TRUE(clear.has_alpha);
  EXPECT_EQ(clear.rgba[3], 0);
}

}  // namespace
}  // namespace talisman::sequences
