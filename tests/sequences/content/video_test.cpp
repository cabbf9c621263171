// SPDX-License-Identifier: Apache-2.0
// Frames of video files: which they are, when they begin, their colours, alpha and rotation, and what is refused.
#include "sequences/content/images/video.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/errors.h"
#include "tests/sequences/content/coded_video.h"
#include "tests/sequences/sequence_lines.h"

namespace talisman::sequences {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using tests::ffmpeg;
using tests::kCodes;
using tests::message_of;
using tests::TemporaryFolder;
using tests::write_coded;

constexpr double kAll = std::numeric_limits<double>::infinity();
const std::vector<std::string> kH264 = {
    "-vf",          "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
    "-c:v",         "libx264",
    "-crf",         "10",
    "-colorspace",  "bt709",
    "-color_range", "tv"};
const std::vector<std::string> kLossless = {"-c:v", "ffv1", "-pix_fmt", "bgr0"};

std::vector<std::string> with(std::vector<std::string> coding, const std::vector<std::string>& more) {
  coding.insert(coding.end(), more.begin(), more.end());
  return coding;
}

/// RGBA of the middle of a frame.
std::array<int, 4> middle_of(const layers::Texture& frame) {
  const std::size_t at = 4 * (static_cast<std::size_t>(frame.height / 2) * frame.width + frame.width / 2);
  return {frame.rgba[at], frame.rgba[at + 1], frame.rgba[at + 2], frame.rgba[at + 3]};
}

int number_of(const layers::Texture& frame) {
  const auto c = middle_of(frame);
  return tests::number_of(c[0], c[1], c[2]);
}

void expect_numbers(const VideoFrames& video, int frames) {
  ASSERT_THAT(video.frames, SizeIs(frames));
  for (int k = 0; k < frames; ++k) EXPECT_EQ(number_of(video.frames[k]), k % kCodes) << "frame " << k;
}

TEST(ReadVideo, EveryFrameOnceInItsOrder) {
  // H.264 with frames that are coded in another order than they are shown in.
  const TemporaryFolder folder;
  ASSERT_EQ(write_coded(folder, "a.mp4", 64, 48, "24", 27, with(kH264, {"-bf", "3", "-g", "12"})), "");
  const VideoFrames video = read_video(folder / "a.mp4", kAll);
  expect_numbers(video, 27);
  EXPECT_EQ(video.fps, 24);
  EXPECT_THAT(video.starts_s, IsEmpty());
  EXPECT_DOUBLE_EQ(video.length_s, 27 / 24.0);
}

TEST(ReadVideo, WholeMillisecondsOfMatroskaAreAConstantRate) {
  // 1001/24000 s is no whole number of milliseconds: every start is off by up to half of one.
  const TemporaryFolder folder;
  ASSERT_EQ(write_coded(folder, "a.mkv", 32, 32, "24000/1001", 27, kLossless), "");
  const VideoFrames video = read_video(folder / "a.mkv", kAll);
  expect_numbers(video, 27);
  EXPECT_THAT(video.starts_s, IsEmpty());
  EXPECT_NEAR(video.fps, 24000.0 / 1001, 1e-9);
}

TEST(ReadVideo, AVariableRateGivesEachFrameItsOwnTime) {
  // Frame k begins at k² / 24 s, as far as whole milliseconds say.
  const TemporaryFolder folder;
  ASSERT_EQ(write_coded(folder, "a.mkv", 32, 32, "24", 6,
                        with(kLossless, {"-vf", "setpts=N*N/24/TB", "-fps_mode", "passthrough"})),
            "");
  const VideoFrames video = read_video(folder / "a.mkv", kAll);
  expect_numbers(video, 6);
  ASSERT_THAT(video.starts_s, SizeIs(6));
  EXPECT_EQ(video.starts_s[0], 0);
  for (int k = 1; k < 6; ++k) {
    EXPECT_LE(video.starts_s[k], k * k / 24.0) << "shown when it begins";
    EXPECT_GT(video.starts_s[k], k * k / 24.0 - 1.01e-3);
  }
  EXPECT_GT(video.length_s, 25 / 24.0);
}

TEST(ReadVideo, OddSizesStayOdd) {
  const TemporaryFolder folder;
  ASSERT_EQ(write_coded(folder, "a.mkv", 35, 21, "10", 3, {"-c:v", "ffv1", "-pix_fmt", "yuv420p"}), "");
  const VideoFrames video = read_video(folder / "a.mkv", kAll);
  expect_numbers(video, 3);
  EXPECT_EQ(video.frames[0].width, 35);
  EXPECT_EQ(video.frames[0].height, 21);
}

TEST(ReadVideo, TheRotationFlagTurnsIt) {
  // Left half red, right half blue, with the flag to turn it by a quarter: one colour is above the other.
  const TemporaryFolder folder;
  ASSERT_EQ(ffmpeg(folder, {"-f", "lavfi", "-i",
                            "color=red:s=32x48:d=0.2[a];color=blue:s=32x48:d=0.2[b];[a][b]hstack", "-c:v",
                            "libx264", "-pix_fmt", "yuv420p", "flat.mp4"}),
            "");
  ASSERT_EQ(ffmpeg(folder, {"-i", "flat.mp4", "-c", "copy", "-metadata:s:v:0", "rotate=90", "turned.mp4"}),
            "");
  const VideoFrames flat = read_video(folder / "flat.mp4", kAll),
                    turned = read_video(folder / "turned.mp4", kAll);
  const layers::Texture& a = flat.frames[0];
  const layers::Texture& b = turned.frames[0];
  ASSERT_EQ(a.width, 64);
  ASSERT_EQ(a.height, 48);
  ASSERT_EQ(b.width, 48) << "the flag was not followed";
  ASSERT_EQ(b.height, 64);
  // ffmpeg 5 writes a display matrix that turns counter-clockwise: what was left is below.
  EXPECT_GT(b.rgba[4 * (8 * 48 + 24) + 2], 200) << "blue above";
  EXPECT_GT(b.rgba[4 * (56 * 48 + 24)], 200) << "red below";
}

/// Frame 19, (216, 40, 128), coded by this matrix and range.
std::array<int, 4> colour_through(const std::string& matrix, const std::string& stated,
                                  const std::string& range) {
  const TemporaryFolder folder;
  std::string raw;
  for (int i = 0; i < 32 * 32; ++i) raw += "\xd8\x28\x80";
  folder.write("c.raw", raw);
  EXPECT_EQ(ffmpeg(folder,
                   {"-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", "32x32", "-i", "c.raw", "-vf",
                    "scale=out_color_matrix=" + matrix + ":out_range=" + range +
                        ":flags=accurate_rnd+full_chroma_int,format=yuv444p",
                    "-c:v", "libx264", "-qp", "1", "-colorspace", stated, "-color_range", range, "c.mp4"}),
            "");
  return middle_of(read_video(folder / "c.mp4", kAll).frames.at(0));
}

TEST(ReadVideo, ColoursAreThoseOfTheMatrixAndRangeThatItStates) {
  // BT.601 for BT.709 would be off by 20 of 255 here, full for narrow range by 16.
  for (const auto& [matrix, stated, range] : {std::array<const char*, 3>{"bt709", "bt709", "tv"},
                                              {"bt601", "smpte170m", "tv"},
                                              {"bt709", "bt709", "pc"},
                                              {"bt601", "bt470bg", "pc"},
                                              {"bt2020", "bt2020nc", "tv"}}) {
    const auto c = colour_through(matrix, stated, range);
    EXPECT_NEAR(c[0], 216, 3) << matrix << " " << range;
    EXPECT_NEAR(c[1], 40, 3) << matrix << " " << range;
    EXPECT_NEAR(c[2], 128, 3) << matrix << " " << range;
  }
}

TEST(ReadVideo, AlphaIsStraight) {
  // Half-transparent orange stays orange: were the colour multiplied, red would be 127.
  const TemporaryFolder folder;
  const std::string orange = "color=0xff8000:s=32x32:d=0.1,format=rgba,colorchannelmixer=aa=0.5";
  for (const auto& coding :
       {std::vector<std::string>{"-c:v", "qtrle", "a.mov"},
        {"-c:v", "ffv1", "-pix_fmt", "bgra", "a.mkv"},
        {"-c:v", "libvpx-vp9", "-pix_fmt", "yuva420p", "-crf", "4", "-b:v", "0", "a.webm"}}) {
    ASSERT_EQ(ffmpeg(folder, with({"-f", "lavfi", "-i", orange}, coding)), "");
    const layers::Texture frame = read_video(folder / coding.back(), kAll).frames.at(0);
    const auto c = middle_of(frame);
    EXPECT_TRUE(frame.has_alpha) << coding.back();
    EXPECT_NEAR(c[0], 255, 4) << coding.back();
    EXPECT_NEAR(c[1], 128, 4) << coding.back();
    EXPECT_NEAR(c[2], 0, 4) << coding.back();
    EXPECT_NEAR(c[3], 128, 2) << coding.back();
  }
}

TEST(ReadVideo, NoMoreIsReadThanIsAskedFor) {
  const TemporaryFolder folder;
  ASSERT_EQ(write_coded(folder, "a.mkv", 16, 16, "10", 100, kLossless), "");
  EXPECT_THAT(read_video(folder / "a.mkv", 0.5).frames, SizeIs(15)) << "and a second behind it";
}

std::string refusal(const TemporaryFolder& folder, const std::string& name) {
  return message_of([&] { read_video(folder / name, kAll); });
}

TEST(ReadVideo, PlaylistsAreRefusedWhateverTheyAreCalled) {
  const TemporaryFolder folder;
  ASSERT_EQ(write_coded(folder, "a.mp4", 32, 32, "10", 3, kH264), "");
  folder.write("list.m3u8", "#EXTM3U\n#EXTINF:1,\na.mp4\n#EXT-X-ENDLIST\n");
  folder.write("list.mp4", "#EXTM3U\n#EXTINF:1,\nhttp://127.0.0.1:9/a.mp4\n#EXT-X-ENDLIST\n");
  folder.write("concat.mkv", "ffconcat version 1.0\nfile a.mp4\n");
  folder.write("dash.mp4", "<?xml version=\"1.0\"?><MPD/>");
  for (const char* name : {"list.m3u8", "list.mp4", "concat.mkv", "dash.mp4"})
    EXPECT_THAT(
        refusal(folder, name),
        AllOf(HasSubstr(name), HasSubstr("is a playlist, rule: a video file that holds its pictures")));
  // One that hides its kind from us is no format that ffmpeg may open.
  folder.write("spaces.mp4", std::string(600, '\n') + "ffconcat version 1.0\nfile a.mp4\n");
  EXPECT_THAT(refusal(folder, "spaces.mp4"), HasSubstr("is no video that ffmpeg reads"));
}

TEST(ReadVideo, WhatIsNoVideoIsRefusedInOneLine) {
  const TemporaryFolder folder;
  folder.write("empty.mp4", "");
  folder.write("text.mp4", "no video at all");
  ASSERT_EQ(ffmpeg(folder, {"-f", "lavfi", "-i", "sine=d=0.2", "sound.mp4"}), "");
  ASSERT_EQ(write_coded(folder, "a.mp4", 64, 48, "24", 9, kH264), "");
  folder.write("cut.mp4", folder.read("a.mp4").substr(0, 600));
  EXPECT_THAT(refusal(folder, "empty.mp4"), HasSubstr("has 0 bytes, rule: a video file"));
  EXPECT_THAT(refusal(folder, "text.mp4"), HasSubstr("is no video that ffmpeg reads"));
  EXPECT_THAT(refusal(folder, "sound.mp4"), HasSubstr("has no pictures, rule: a file with a video stream"));
  EXPECT_THAT(refusal(folder, "cut.mp4"), HasSubstr("cut.mp4: "));
  for (const char* name : {"text.mp4", "cut.mp4"})
    EXPECT_EQ(refusal(folder, name).find('\n'), std::string::npos);
}

}  // namespace
}  // namespace talisman::sequences
