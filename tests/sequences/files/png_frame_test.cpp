// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/png_frame.h"

#include <filesystem>
#include <random>

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/errors.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using tests::TemporaryFolder;

Image8 noise(int width, int height) {
  std::mt19937 random(7);
  Image8 image{width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height)};
  for (std::uint8_t& sample : image.rgb) sample = static_cast<std::uint8_t>(random());
  return image;
}

TEST(PngFrame, IsWhatWasWrittenAndWhatOpenImageIoReads) {
  const TemporaryFolder folder;
  const Image8 image = noise(37, 5);
  write_png(folder / "a.png", image);
  const Image8 read = read_png_frame(folder / "a.png");
  EXPECT_EQ(read.width, 37);
  EXPECT_EQ(read.height, 5);
  EXPECT_EQ(read.rgb, image.rgb);
  EXPECT_EQ(read.rgb, read_image(folder / "a.png").rgb);
}

TEST(PngFrame, OtherKindsOfPngBecomeRgb) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgba = {10, 20, 30, 255};
  const auto out = OIIO::ImageOutput::create("rgba.png");
  out->open(folder / "rgba.png", OIIO::ImageSpec(1, 1, 4, OIIO::TypeDesc::UINT8));
  out->write_image(OIIO::TypeDesc::UINT8, rgba.data());
  out->close();
  EXPECT_THAT(read_png_frame(folder / "rgba.png").rgb, ::testing::ElementsAre(10, 20, 30));
}

TEST(PngFrame, CutOffEmptyAndMissingFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.png";
  write_png(file, noise(64, 64));
  const auto size = std::filesystem::file_size(file);
  for (const std::uintmax_t kept : {size - 30, size / 2, std::uintmax_t{20}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(file, kept);
    EXPECT_THROW((void)read_png_frame(file), InputError) << kept << " of " << size << " bytes";
  }
  EXPECT_THROW((void)read_png_frame(folder / "none.png"), InputError);
}

}  // namespace
}  // namespace talisman::sequences
