// SPDX-License-Identifier: Apache-2.0
// Ground from cold, warm and damaged caches.
#include "sequences/content/painted_ground.h"

#include <chrono>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "sequences/files/cache.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using tests::TemporaryFolder;

std::string plain_ppm(int width, int height, const std::string& rgb) {
  std::string bytes = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (int i = 0; i < width * height; ++i) bytes += rgb;
  return bytes;
}

class PaintedGroundTest : public testing::Test {
 protected:
  PaintedGroundTest() {
    use_cache({cache_.path(), 64});
    content_.classes_file = folder_.write("classes.ppm", plain_ppm(6, 5, "\x10\x10\x10"));
    content_.classes = {{{16, 16, 16}, folder_.write("tile.ppm", plain_ppm(4, 4, "abc"))},
                        {{200, 0, 0}, "never opened, for no pixel is of this class"}};
    content_.texels_per_cell = 3;
    field_.columns = 6;
    field_.rows = 5;
    field_.heights_m.assign(30, 0);
  }
  ~PaintedGroundTest() override { use_cache({}); }

  std::vector<std::vector<std::uint8_t>> texels() const {
    std::vector<std::vector<std::uint8_t>> all;
    for (const layers::Texture& texture : painted_ground(content_, field_, windows_)) {
      EXPECT_EQ(texture.rgba.size(), 4u * texture.width * texture.height);
      all.push_back(texture.rgba);
    }
    return all;
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(cache_.path()), fs::directory_iterator()));
  }

  const TemporaryFolder cache_, folder_;
  TerrainContent content_;
  layers::HeightField field_;
  const std::vector<GroundWindow> windows_{{-2, -2, 9, 5}, {-2, 1, 9, 6}};
};

TEST_F(PaintedGroundTest, WarmIsTheSameAsColdAndAsWithoutACache) {
  use_cache({});
  const auto without = texels();
  ASSERT_EQ(without.size(), 2u);
  use_cache({cache_.path(), 64});
  EXPECT_EQ(texels(), without);
  ASSERT_EQ(entries(), 1u);
  const fs::path entry = fs::directory_iterator(cache_.path())->path();
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(5);
  fs::last_write_time(entry, long_ago);
  EXPECT_EQ(texels(), without);
  EXPECT_GT(fs::last_write_time(entry), long_ago) << "it was used";
}

TEST_F(PaintedGroundTest, DamagedCutAndEmptyEntriesGiveTheSame) {
  const auto want = texels();
  const fs::path entry = fs::directory_iterator(cache_.path())->path();
  for (const auto size : {fs::file_size(entry) - 1, fs::file_size(entry) / 2, std::uintmax_t{0}}) {
    fs::resize_file(entry, size);
    EXPECT_EQ(texels(), want) << size;
  }
  std::fstream(entry, std::ios::in | std::ios::out | std::ios::binary).seekp(100).put('!');
  EXPECT_EQ(texels(), want);
}

TEST_F(PaintedGroundTest, EveryInputCounts) {
  const auto first = texels();
  folder_.write("tile.ppm", plain_ppm(4, 4, "xyz"));
  const auto other_tile = texels();
  EXPECT_NE(other_tile, first);
  folder_.write("tile.ppm", plain_ppm(4, 4, "abc"));
  EXPECT_EQ(texels(), first);
  EXPECT_EQ(entries(), 2u);
  content_.tile_m = 11;
  texels();
  content_.cell_m = 5;
  texels();
  content_.classes[1].rgb = {16, 16, 17};
  texels();
  folder_.write("classes.ppm", plain_ppm(6, 5, "\x10\x10\x11"));
  content_.classes[1].rgb = {201, 0, 0};
  texels();
  EXPECT_EQ(entries(), 6u);
}

TEST_F(PaintedGroundTest, WithoutClassesThereIsNothing) {
  content_.classes.clear();
  EXPECT_TRUE(texels().empty());
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
}  // namespace talisman::sequences
