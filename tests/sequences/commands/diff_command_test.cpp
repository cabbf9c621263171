// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/diff_command.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

Image8 shade(int value, int width = 24, int height = 16) {
  Image8 image{width, height,
               std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3,
                                         static_cast<std::uint8_t>(value))};
  return image;
}

class DiffTest : public testing::Test {
 protected:
  DiffTest() {
    for (const char* name : {"a", "b"}) fs::create_directory(path(name));
    options_.a = path("a"), options_.b = path("b");
  }
  std::string path(const std::string& name) const { return root_ / name; }
  void put(const std::string& name, const Image8& image) const { write_png(path(name), image); }
  std::string refusal() const {
    std::ostringstream out;
    return tests::message_of([&] { run_diff(options_, out); });
  }
  tests::TemporaryFolder root_;
  DiffOptions options_;
};

TEST_F(DiffTest, TwoFiles) {
  put("a/x.png", shade(100));
  put("b/y.png", shade(110));
  options_.a = path("a/x.png"), options_.b = path("b/y.png");
  std::ostringstream out;
  EXPECT_EQ(run_diff(options_, out), 0);
  EXPECT_THAT(out.str(), HasSubstr("x "));
  EXPECT_THAT(out.str(), HasSubstr("28.13"));  // 20 log10(255 / 10)
  EXPECT_EQ(out.str().find("mean"), std::string::npos);
}

TEST_F(DiffTest, FoldersAreMatchedByNumber) {
  for (const char* name : {"0000", "0001", "0012"}) {
    put(std::string("a/") + name + ".png", shade(100));
    put(std::string("b/") + name + ".png", shade(name == std::string("0012") ? 130 : 100));
  }
  put("a/notes.png", shade(3));  // no frame number: not a frame
  const DiffReport report = diff(options_);
  ASSERT_EQ(report.frames.size(), 3u);
  EXPECT_EQ(report.frames[2].name, "0012");
  EXPECT_TRUE(std::isinf(report.frames[0].quality.psnr_db));
  EXPECT_EQ(report.frames[2].quality.max_difference, 30);
  EXPECT_FALSE(report.partial());
  std::ostringstream out;
  EXPECT_EQ(run_diff(options_, out), 0);
  for (const char* word : {"frame", "psnr_db", "identical", "mean", "worst"})
    EXPECT_THAT(out.str(), HasSubstr(word));
}

// Five digits come after four, although they sort before as text.
TEST_F(DiffTest, NumbersBeyondFourDigitsComeLast) {
  for (const char* name : {"9999", "10000", "0002"})
    for (const char* side : {"a/", "b/"}) put(std::string(side) + name + ".png", shade(1));
  const DiffReport report = diff(options_);
  ASSERT_EQ(report.frames.size(), 3u);
  EXPECT_EQ(report.frames[0].name, "0002");
  EXPECT_EQ(report.frames[2].name, "10000");
}

TEST_F(DiffTest, MissingCounterpartsMakeThePartialExitCode) {
  put("a/0000.png", shade(1)), put("b/0000.png", shade(1));
  put("a/0001.png", shade(1)), put("b/0007.png", shade(1)), put("b/0008.png", shade(1));
  const DiffReport report = diff(options_);
  EXPECT_THAT(report.only_a, ElementsAre("0001"));
  EXPECT_THAT(report.only_b, ElementsAre("0007", "0008"));
  std::ostringstream out;
  EXPECT_EQ(run_diff(options_, out), 3);
  EXPECT_THAT(out.str(), HasSubstr("frame 0001 is in " + options_.a + " only"));
  EXPECT_THAT(out.str(), HasSubstr("frame 0008 is in " + options_.b + " only"));
}

// What `talisman render` leaves: DIR/frames/NNNN.png; a PNG run can be compared with an EXR run.
TEST_F(DiffTest, ResultFoldersAndMixedFormats) {
  fs::create_directory(path("a/frames"));
  chunker::Frame frame{8, 8, std::vector<chunker::Linear16>(64, {20000, 20000, 20000, 65025})};
  write_png(path("a/frames/0003.png"), to_image8(frame));
  write_exr(path("b/0003.exr"), frame);
  const DiffReport report = diff(options_);
  ASSERT_EQ(report.frames.size(), 1u);
  EXPECT_LE(report.frames[0].quality.max_difference, 1);
}

TEST_F(DiffTest, JsonHasSchemaFramesAndSummary) {
  put("a/0000.png", shade(100)), put("b/0000.png", shade(100));
  put("a/0001.png", shade(100)), put("b/0001.png", shade(90));
  put("a/0002.png", shade(100));
  options_.json = true;
  std::ostringstream out;
  EXPECT_EQ(run_diff(options_, out), 3);
  const auto j = nlohmann::json::parse(out.str());
  EXPECT_EQ(j["schema"], "talisman.diff/1");
  ASSERT_EQ(j["frames"].size(), 2u);
  EXPECT_TRUE(j["frames"][0]["psnr_db"].is_null());  // identical: JSON has no infinity
  EXPECT_NEAR(j["frames"][1]["psnr_db"].get<double>(), 28.13, 0.005);
  EXPECT_EQ(j["worst"]["max_difference"], 10);
  EXPECT_GT(j["mean"]["flip"].get<double>(), 0);
  EXPECT_EQ(j["only_a"], (std::vector<std::string>{"0002"}));
}

TEST_F(DiffTest, WhatIsSwitchedOffIsNotReported) {
  put("a/0000.png", shade(100)), put("b/0000.png", shade(90));
  options_.json = true;
  options_.quality.flip = options_.quality.ssim = false;
  std::ostringstream out;
  run_diff(options_, out);
  const auto j = nlohmann::json::parse(out.str());
  EXPECT_FALSE(j["frames"][0].contains("flip"));
  EXPECT_FALSE(j["frames"][0].contains("ssim"));
}

TEST_F(DiffTest, MapsAreViewablePictures) {
  Image8 changed = shade(100);
  for (int y = 4; y < 12; ++y)
    for (int x = 0; x < 12; ++x) changed.rgb[(y * 24 + x) * 3] = 255;
  put("a/0000.png", changed), put("b/0000.png", shade(100));
  options_.map_dir = path("maps/deep");
  options_.quality.flip = false;  // a map asks for it anyway
  std::ostringstream out;
  EXPECT_EQ(run_diff(options_, out), 0);
  const Image8 map = read_image(path("maps/deep/0000.png"));
  ASSERT_EQ(map.width, 24);
  EXPECT_GT(map.rgb[(8 * 24 + 4) * 3], 100);  // bright where it differs
  EXPECT_LT(map.rgb[(8 * 24 + 23) * 3], 60);  // dark where it does not
  options_.map_dir.clear();
  options_.quality.flip = true;
  EXPECT_THAT(out.str(), HasSubstr(std::to_string(diff(options_).frames[0].quality.flip).substr(0, 6)));
}

TEST_F(DiffTest, MapFolderBelowAFileIsBadInput) {
  put("a/0000.png", shade(1)), put("b/0000.png", shade(2));
  std::ofstream(path("file")) << "x";
  options_.map_dir = path("file/maps");
  std::ostringstream out;
  EXPECT_THROW(run_diff(options_, out), InputError);
}

TEST_F(DiffTest, SizesThatDifferAreNamed) {
  put("a/0000.png", shade(1, 24, 16)), put("b/0000.png", shade(1, 25, 16));
  const std::string message = refusal();
  for (const char* part : {"24x16", "25x16", "0000.png"}) EXPECT_THAT(message, HasSubstr(part));
}

TEST_F(DiffTest, UnusableArgumentsAreInputErrors) {
  EXPECT_THAT(refusal(), HasSubstr("no frames"));  // both folders are empty
  put("a/0000.png", shade(1)), put("b/0001.png", shade(1));
  EXPECT_THAT(refusal(), HasSubstr("in common"));
  options_.b = path("a/0000.png");
  EXPECT_THAT(refusal(), HasSubstr("two of a kind"));
  options_.b = path("nothing");
  EXPECT_THAT(refusal(), HasSubstr("nothing: does not exist"));
}

TEST(DiffSummary, MeanOfPsnrIsThatOfTheSquaredErrors) {
  const double inf = std::numeric_limits<double>::infinity();
  const DiffSummary s =
      summarize({{"0", {inf, 1, 0, 0, 0}}, {"1", {30, 0.9, 0.2, 12, 0.5}}, {"2", {20, 0.6, 0.4, 40, 1}}});
  EXPECT_NEAR(s.mean.psnr_db, -10 * std::log10((0 + 1e-3 + 1e-2) / 3), 1e-9);
  EXPECT_NEAR(s.mean.ssim, 2.5 / 3, 1e-12);
  EXPECT_NEAR(s.mean.flip, 0.2, 1e-12);
  EXPECT_NEAR(s.mean.changed_pixels, 0.5, 1e-12);
  EXPECT_EQ(s.worst.psnr_db, 20);
  EXPECT_EQ(s.worst.ssim, 0.6);
  EXPECT_EQ(s.worst.flip, 0.4);
  EXPECT_EQ(s.worst.max_difference, 40);
  EXPECT_EQ(s.frames, 3);
}

TEST(DiffSummary, AllIdenticalAndNoFrames) {
  EXPECT_TRUE(std::isinf(summarize({{"0", {HUGE_VAL, 1, 0, 0, 0}}}).mean.psnr_db));
  EXPECT_GT(summarize({{"0", {HUGE_VAL, 1, 0, 0, 0}}}).mean.psnr_db, 0);
  EXPECT_EQ(summarize({}).frames, 0);
}

}  // namespace
}  // namespace talisman::sequences
