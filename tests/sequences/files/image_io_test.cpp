// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/image_io.h"

#include <sys/resource.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <thread>

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/atomic_file.h"
#include "sequences/files/child_process.h"
#include "sequences/files/video.h"
#include "tests/sequences/temporary_folder.h"

#ifdef __SANITIZE_ADDRESS__
/// What a library of others loses (tests/sanitize/leaks) is told from our own by who asked for it: by the whole stack of an
/// allocation, which the sanitizer else walks along frame pointers, and the libraries of a distribution have none.
extern "C" __attribute__((visibility("default"))) const char* __asan_default_options() {
  return "fast_unwind_on_malloc=0";
}
#endif

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using Folder = tests::TemporaryFolder;
using tests::content;

Image8 gradient(int width, int height) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int v : {x * 255 / width, y * 255 / height, (x + y) * 7})
        image.rgb.push_back(static_cast<std::uint8_t>(v));
  return image;
}

/// A frame with every 16-bit level that a byte can come from, and both ends.
chunker::Frame level_frame() {
  chunker::Frame frame{257, 4, {}};
  for (int i = 0; i < frame.width * frame.height; ++i) {
    const auto v = static_cast<std::uint16_t>(std::min(i * 64, static_cast<int>(chunker::kOne)));
    frame.pixels.push_back({v, static_cast<std::uint16_t>(chunker::kOne - v),
                            static_cast<std::uint16_t>(v / 2), static_cast<std::uint16_t>(chunker::kOne)});
  }
  return frame;
}

template <typename Error, typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// Files of this process end at `bytes`, as they do on a full disk (the error is EFBIG in place of ENOSPC).
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(WriteAtomically, TextComesOutAndNoTemporaryStays) {
  const Folder folder;
  write_text_atomically(folder / "a.txt", std::string("one\0two", 7));
  write_text_atomically(folder / "a.txt", "three");
  EXPECT_EQ(content(folder / "a.txt"), "three");
  EXPECT_EQ(folder.names(), (std::set<std::string>{"a.txt"}));
}

TEST(WriteAtomically, EmptyTextGivesAnEmptyFile) {
  const Folder folder;
  write_text_atomically(folder / "empty", "");
  EXPECT_TRUE(fs::exists(folder / "empty"));
  EXPECT_EQ(fs::file_size(folder / "empty"), 0u);
}

// The old file is what a reader must still see while, and after, a new one fails to be written.
TEST(WriteAtomically, FullDiskKeepsTheOldFileAndSaysWhy) {
  const Folder folder;
  write_text_atomically(folder / "a.txt", "old");
  std::string message;
  {
    const FileSizeLimit limit(4096);
    message =
        message_of<OutputError>([&] { write_text_atomically(folder / "a.txt", std::string(100000, 'x')); });
  }
  EXPECT_THAT(message, HasSubstr(folder / "a.txt"));
  EXPECT_THAT(message, HasSubstr("File too large"));
  EXPECT_EQ(content(folder / "a.txt"), "old");
  EXPECT_EQ(folder.names(), (std::set<std::string>{"a.txt"}));
}

// The same through the image encoders: neither may leave half a picture under the final name.
TEST(WriteAtomically, FullDiskLeavesNoHalfPicture) {
  const Folder folder;
  std::string png, exr;
  std::mt19937 random(7);
  Image8 noise{64, 64, {}};
  for (int i = 0; i < 64 * 64 * 3; ++i) noise.rgb.push_back(static_cast<std::uint8_t>(random()));
  {
    const FileSizeLimit limit(1024);
    png = message_of<OutputError>([&] { write_png(folder / "a.png", noise); });
    exr = message_of<OutputError>([&] { write_exr(folder / "a.exr", level_frame()); });
  }
  EXPECT_THAT(png, HasSubstr("a.png"));
  EXPECT_THAT(exr, HasSubstr("a.exr"));
  EXPECT_TRUE(folder.names().empty());
}

// Root may write anywhere, but not below a regular file.
TEST(WriteAtomically, FolderThatCannotBeWrittenIsNamed) {
  const Folder folder;
  write_text_atomically(folder / "file", "x");
  const std::string target = folder / "file/a.txt";
  const std::string message = message_of<OutputError>([&] { write_text_atomically(target, "y"); });
  EXPECT_THAT(message, HasSubstr(target));
  EXPECT_THAT(message, HasSubstr("Not a directory"));
  EXPECT_THAT(message_of<OutputError>([&] { write_text_atomically(folder / "none/a.txt", "y"); }),
              HasSubstr("No such file"));
}

TEST(WriteAtomically, TargetThatIsAFolderIsAnError) {
  const Folder folder;
  fs::create_directory(folder / "here");
  EXPECT_THROW(write_text_atomically(folder / "here", "y"), OutputError);
  EXPECT_EQ(folder.names(), (std::set<std::string>{"here"}));
}

TEST(WriteAtomically, ContentThatThrowsLeavesNothing) {
  const Folder folder;
  EXPECT_THROW(write_atomically(folder / "a",
                                [](const std::string& temporary) {
                                  std::ofstream(temporary) << "half";
                                  throw std::runtime_error("stop");
                                }),
               std::runtime_error);
  EXPECT_TRUE(folder.names().empty());
}

// A child that says it succeeded but wrote nothing must not pass.
TEST(WriteAtomically, ContentThatWritesNothingIsAnError) {
  const Folder folder;
  EXPECT_THROW(write_atomically(folder / "a", [](const std::string&) {}), OutputError);
}

// The temporary must lie in the target's folder, or the rename would cross devices and not be atomic.
TEST(WriteAtomically, TemporaryIsUniqueAndInTheSameFolder) {
  const Folder folder;
  std::string first, second;
  write_atomically(folder / "a.png", [&](const std::string& outer) {
    first = outer;
    write_atomically(folder / "a.png", [&](const std::string& inner) {
      second = inner;
      std::ofstream(inner) << "inner";
    });
    std::ofstream(outer) << "outer";
  });
  EXPECT_NE(first, second);
  EXPECT_EQ(fs::path(first).parent_path(), folder.path());
  EXPECT_EQ(fs::path(first).extension(), ".png");
  EXPECT_EQ(content(folder / "a.png"), "outer");
}

TEST(WritePng, RoundTripIsExact) {
  const Folder folder;
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 1}, {1, 5}, {64, 33}}) {
    const Image8 image = gradient(w, h);
    write_png(folder / "a.png", image);
    const Image8 back = read_image(folder / "a.png");
    EXPECT_EQ(back.width, w);
    EXPECT_EQ(back.height, h);
    EXPECT_EQ(back.rgb, image.rgb);
    EXPECT_EQ(image_size(folder / "a.png"), layers::ivec2(w, h));
  }
}

// No time stamp or host name may find its way into a file: runs are compared byte by byte. Stamps in files
// count seconds, so the second pair of files is written in another one.
TEST(WriteImage, SameBytesInAnotherSecond) {
  const Folder folder;
  write_png(folder / "a.png", gradient(50, 40));
  write_exr(folder / "a.exr", level_frame());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  write_png(folder / "b.png", gradient(50, 40));
  write_exr(folder / "b.exr", level_frame());
  EXPECT_EQ(content(folder / "a.png"), content(folder / "b.png"));
  EXPECT_FALSE(content(folder / "a.png").empty());
  EXPECT_EQ(content(folder / "a.exr"), content(folder / "b.exr"));
  EXPECT_FALSE(content(folder / "a.exr").empty());
}

// Half floats have 11 bits; the light that comes back may differ by half a unit of the last of them.
TEST(WriteExr, LinearLightComesBackToHalfPrecision) {
  const Folder folder;
  const chunker::Frame frame = level_frame();
  write_exr(folder / "a.exr", frame);
  const auto in = OIIO::ImageInput::open(folder / "a.exr");
  ASSERT_TRUE(in);
  EXPECT_EQ(in->spec().format, OIIO::TypeDesc::HALF);
  ASSERT_EQ(in->spec().nchannels, 3);
  std::vector<float> pixels(frame.pixels.size() * 3);
  ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, pixels.data()));
  for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
    const double want = frame.pixels[i].r / double{chunker::kOne};
    ASSERT_NEAR(pixels[i * 3], want, want / 2048 + 1e-7) << "pixel " << i;
  }
}

// An EXR and a PNG of the same frame must be comparable: reading the EXR gives the PNG's bytes, but for
// rounding at half precision.
TEST(ReadImage, ExrIsEncodedToSrgb) {
  const Folder folder;
  const chunker::Frame frame = level_frame();
  write_exr(folder / "a.exr", frame);
  const Image8 from_exr = read_image(folder / "a.exr"), direct = to_image8(frame);
  ASSERT_EQ(from_exr.rgb.size(), direct.rgb.size());
  for (std::size_t i = 0; i < direct.rgb.size(); ++i)
    ASSERT_NEAR(from_exr.rgb[i], direct.rgb[i], 1) << "sample " << i;
  EXPECT_EQ(direct.rgb[0], 0);
  EXPECT_EQ(direct.rgb[1], 255);
}

TEST(ReadImage, NotANumberAndInfinityAreEnds) {
  const Folder folder;
  OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::FLOAT);
  const float inf = HUGE_VALF;
  const float pixels[12] = {NAN, inf, -inf, 0, 1, 2, -1, 1e30f, 1e-30f, 0, 0, 0};
  const auto out = OIIO::ImageOutput::create("a.exr");
  ASSERT_TRUE(out->open(folder / "a.exr", spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels) &&
              out->close());
  EXPECT_EQ(read_image(folder / "a.exr").rgb,
            (std::vector<std::uint8_t>{0, 255, 0, 0, 255, 255, 0, 255, 0, 0, 0, 0}));
}

TEST(ReadImage, GreyBecomesRgbAndAlphaIsLeftOut) {
  const Folder folder;
  const auto write = [&](const std::string& name, int channels, const std::vector<std::uint8_t>& pixels) {
    const auto out = OIIO::ImageOutput::create(name);
    out->open(folder / name, OIIO::ImageSpec(1, 1, channels, OIIO::TypeDesc::UINT8));
    out->write_image(OIIO::TypeDesc::UINT8, pixels.data());
    out->close();
  };
  write("grey.png", 1, {77});
  write("rgba.png", 4, {10, 20, 30, 255});
  EXPECT_EQ(read_image(folder / "grey.png").rgb, (std::vector<std::uint8_t>{77, 77, 77}));
  EXPECT_EQ(read_image(folder / "rgba.png").rgb, (std::vector<std::uint8_t>{10, 20, 30}));
}

TEST(ReadImage, WhatCannotBeReadIsNamed) {
  const Folder folder;
  const std::string missing = message_of<InputError>([&] { read_image(folder / "none.png"); });
  EXPECT_THAT(missing, HasSubstr(folder / "none.png"));
  write_text_atomically(folder / "text.png", "this is no picture");
  EXPECT_THROW(read_image(folder / "text.png"), InputError);
  EXPECT_THROW(read_image(folder.path()), InputError);
}

// The library's reader reads from no address what is said to be packed in fours, and has 24 bits a pixel.
TEST(ReadImage, PackedBmpOfOtherBitsIsAnError) {
  const Folder folder;
  std::string bmp("BMf\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\4\0\0\0\4\0\0\0\1\0\x18\0\2\0\0\0\x30\0\0\0", 38);
  bmp.resize(102);
  for (const char packing : {1, 2}) {
    bmp[30] = packing;
    write_text_atomically(folder / "a.bmp", bmp);
    EXPECT_THAT(
        message_of<InputError>([&] { read_image(folder / "a.bmp"); }),
        HasSubstr("a.bmp: cannot be read: a BMP of 24 bits a pixel that says it is packed as one of " +
                  std::string(packing == 1 ? "8" : "4")));
  }
}

// The header of OS/2 has 12 bytes and says nothing of packing: where others say it, two dark pixels lie.
TEST(ReadImage, BmpWithAShortHeaderIsReadWhateverItsPixels) {
  const Folder folder;
  std::string bmp("BM\x32\0\0\0\0\0\0\0\x1A\0\0\0\x0C\0\0\0\4\0\2\0\1\0\x18\0", 26);
  const std::string rows("\x0A\x14\x1E\0\1\0\0\0\0\0\0\0", 12);  // blue first, the lowest line first
  bmp += rows + rows;
  write_text_atomically(folder / "a.bmp", bmp);
  EXPECT_EQ(read_image(folder / "a.bmp").rgb,
            (std::vector<std::uint8_t>{30, 20, 10, 0, 1, 0, 0, 0, 0, 0, 0, 0,
                                       30, 20, 10, 0, 1, 0, 0, 0, 0, 0, 0, 0}));
}

// 33 million × 4 pixels by its header, in 54 bytes: the library's reader asks for all of it and throws.
TEST(ReadImage, HeaderThatAsksForMoreThanThereIsIsAnError) {
  const Folder folder;
  std::string bmp("BMf\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\4\0\0\2\4\0\0\0\1\0\x18\0\0\0\0\0\x30\0\0\0", 38);
  bmp.resize(102);
  write_text_atomically(folder / "a.bmp", bmp);
  EXPECT_THAT(message_of<InputError>([&] { read_image(folder / "a.bmp"); }),
              HasSubstr("a.bmp: cannot be read to its end"));
}

// A file that was cut off must not come back as a picture with a black rest.
TEST(ReadImage, TruncatedFileIsAnError) {
  const Folder folder;
  write_png(folder / "whole.png", gradient(200, 200));
  const std::string whole = content(folder / "whole.png");
  write_text_atomically(folder / "half.png", whole.substr(0, whole.size() / 2));
  EXPECT_THROW(read_image(folder / "half.png"), InputError);
}

TEST(RunChild, ArgumentsPassUninterpreted) {
  const std::string awkward = "a b;$(false)*'\"\\";
  const ChildResult child = run_child({"printf", "%s", awkward});
  EXPECT_TRUE(child.succeeded());
  EXPECT_EQ(child.output, awkward);
}

TEST(RunChild, FailuresAreTold) {
  EXPECT_FALSE(run_child({"no-such-program-here"}).started);
  EXPECT_THAT(run_child({"no-such-program-here"}).output, HasSubstr("No such file"));
  EXPECT_EQ(run_child({"false"}).exit_code, 1);
  EXPECT_EQ(run_child({"false"}).reason(), "exit code 1");
  const ChildResult killed = run_child({"sh", "-c", "echo one; echo two >&2; echo; echo three; kill -9 $$"});
  EXPECT_EQ(killed.exit_code, 128 + 9);
  EXPECT_EQ(killed.reason(2), "two | three");
}

// More output than a pipe holds: a parent that waits before it reads would wait for ever.
TEST(RunChild, MuchOutputDoesNotBlock) {
  const ChildResult child = run_child({"sh", "-c", "yes 0123456789 | head -c 3000000; echo end"});
  EXPECT_TRUE(child.succeeded());
  EXPECT_LT(child.output.size(), 200000u);
  EXPECT_THAT(child.reason(1), HasSubstr("end"));
}

struct VideoInfo {
  std::string codec, pixel_format;
  int width = 0, height = 0, frames = 0;
};

VideoInfo probe(const std::string& path) {
  const ChildResult child =
      run_child({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
                 "stream=codec_name,width,height,pix_fmt,nb_read_frames", "-of", "csv=p=0", path});
  VideoInfo info;
  std::istringstream in(child.output);
  std::string width, height, frames;
  std::getline(in, info.codec, ',');
  std::getline(in, width, ',');
  std::getline(in, height, ',');
  std::getline(in, info.pixel_format, ',');
  std::getline(in, frames, ',');
  info.width = std::atoi(width.c_str()), info.height = std::atoi(height.c_str()),
  info.frames = std::atoi(frames.c_str());
  return info;
}

Image8 flat(int width, int height, std::array<std::uint8_t, 3> color) {
  Image8 image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  return image;
}

Image8 first_video_frame(const Folder& folder) {
  const ChildResult child = run_child(
      {"ffmpeg", "-v", "error", "-y", "-i", folder / "video.mp4", "-frames:v", "1", folder / "back.png"});
  EXPECT_TRUE(child.succeeded()) << child.output;
  return read_image(folder / "back.png");
}

// Odd sizes, because yuv420p has none; a first number above 0, because --frames 12-14 has one; awkward
// characters in the folder's name, because ffmpeg takes % for a pattern and a: for a protocol.
TEST(WriteVideo, OddFramesFromALaterNumberInAnAwkwardFolder) {
  const Folder folder;
  const std::string dir = folder / "a:b %04d 'c'";
  fs::create_directories(dir + "/frames");
  for (int f = 12; f < 15; ++f) write_png(dir + "/frames/00" + std::to_string(f) + ".png", gradient(65, 33));
  write_video(dir, 24, FrameFormat::Png, 12);
  const VideoInfo info = probe("file:" + dir + "/video.mp4");
  EXPECT_TRUE(info.codec == "h264" || info.codec == "mpeg4") << info.codec;
  EXPECT_EQ(info.pixel_format, "yuv420p");
  EXPECT_EQ(info.width, 66);
  EXPECT_EQ(info.height, 34);
  EXPECT_EQ(info.frames, 3);
}

TEST(WriteVideo, ColorsSurvive) {
  const Folder folder;
  fs::create_directories(folder / "frames");
  write_png(folder / "frames/0000.png", flat(65, 47, {200, 60, 30}));
  write_video(folder.path(), 24, FrameFormat::Png, 0);
  const Image8 back = first_video_frame(folder);
  ASSERT_EQ(back.width, 66);
  for (const int at :
       {0, back.width * back.height - 1}) {  // the last pixel lies in the column and row that were added
    EXPECT_NEAR(back.rgb[at * 3], 200, 6);
    EXPECT_NEAR(back.rgb[at * 3 + 1], 60, 6);
    EXPECT_NEAR(back.rgb[at * 3 + 2], 30, 6);
  }
}

// Linear light in EXR must reach the video as the same sRGB picture that the PNG would have given.
TEST(WriteVideo, ExrFramesAreEncodedToSrgb) {
  const Folder folder;
  fs::create_directories(folder / "frames");
  const chunker::Linear16 color{13005, 3000, 40000, static_cast<std::uint16_t>(chunker::kOne)};
  const chunker::Frame frame{64, 48, std::vector<chunker::Linear16>(64 * 48, color)};
  write_exr(folder / "frames/0003.exr", frame);
  write_exr(folder / "frames/0004.exr", frame);
  write_video(folder.path(), 30, FrameFormat::Exr, 3);
  EXPECT_EQ(probe(folder / "video.mp4").frames, 2);
  const Image8 want = to_image8(frame), back = first_video_frame(folder);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.rgb[c], want.rgb[c], 6) << "channel " << c;
}

TEST(WriteVideo, LastFrameEndsTheVideoAndAGapIsNamed) {
  const Folder folder;
  fs::create_directories(folder / "frames");
  for (const char* name : {"0000", "0001", "0002", "0004"})
    write_png(folder / ("frames/" + std::string(name) + ".png"), flat(32, 32, {9, 9, 9}));
  write_video(folder.path(), 24, FrameFormat::Png, 0, 1);
  EXPECT_EQ(probe(folder / "video.mp4").frames, 2);
  const std::string gap =
      message_of<OutputError>([&] { write_video(folder.path(), 24, FrameFormat::Png, 0, 4); });
  EXPECT_THAT(gap, HasSubstr("0003.png"));
}

TEST(WriteVideo, FailuresNameFileAndReasonAndLeaveNothing) {
  const Folder folder;
  EXPECT_THAT(message_of<OutputError>([&] { write_video(folder.path(), 24, FrameFormat::Png, 7); }),
              HasSubstr("0007.png"));
  EXPECT_THROW(write_video(folder.path(), 24, FrameFormat::None, 0), OutputError);
  fs::create_directories(folder / "frames");
  write_png(folder / "frames/0000.png", flat(32, 32, {1, 2, 3}));
  EXPECT_THROW(write_video(folder.path(), 0, FrameFormat::Png, 0), OutputError);
  EXPECT_THROW(write_video(folder.path(), NAN, FrameFormat::Png, 0), OutputError);
  std::string full;
  {
    const FileSizeLimit limit(64);  // the child inherits the limit
    full = message_of<OutputError>([&] { write_video(folder.path(), 24, FrameFormat::Png, 0); });
  }
  EXPECT_THAT(full, HasSubstr("video.mp4: ffmpeg failed: "));
  EXPECT_EQ(folder.names(), (std::set<std::string>{"frames"}));
}

}  // namespace
}  // namespace talisman::sequences
