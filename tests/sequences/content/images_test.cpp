// SPDX-License-Identifier: Apache-2.0
// 2-D layers of a sequence file: where they are seen, which frame they show in which frame of the sequence, when they
// are drawn again, and what is refused.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chunker/pixel.h"
#include "sequences/content/sequence.h"
#include "sequences/files/errors.h"
#include "sequences/files/image_io.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/content/coded_video.h"
#include "tests/sequences/sequence_lines.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using tests::message_of;
using tests::TemporaryFolder;
using tests::write_coded;

const std::vector<std::string> kLossless = {"-c:v", "ffv1", "-pix_fmt", "bgr0"};

/// A run of a sequence, drawn.
struct DrawnRun {
  explicit DrawnRun(const Sequence& of, regulator::Policy policy = regulator::Policy::Threshold)
      : sequence(of), settings(tests::run_of(of).settings) {
    settings.regulator.policy = policy;
    const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
    const chunker::PreparedScene prepared(*sequence.scene);
    PipelineState state(pipeline);
    for (int k = 0; k < sequence.frames; ++k) reports.push_back(step(pipeline, state, k, &prepared));
  }
  /// sRGB of a pixel.
  std::array<int, 3> at(int frame, int x, int y) const {
    const chunker::Frame& picture = reports[frame].picture;
    const chunker::Linear16& p = picture.pixels[static_cast<std::size_t>(y) * picture.width + x];
    return {chunker::srgb_from_linear16(p.r), chunker::srgb_from_linear16(p.g),
            chunker::srgb_from_linear16(p.b)};
  }
  /// The number that a coded video shows there.
  int number(int frame, int x, int y) const {
    const auto c = at(frame, x, y);
    return tests::number_of(c[0], c[1], c[2]);
  }
  const regulator::LayerDecision& decision(int frame, const std::string& layer) const {
    for (const regulator::LayerDecision& d : reports[frame].plan.decisions)
      if (reports[frame].layers[d.layer].name == layer) return d;
    throw std::runtime_error("no layer " + layer);
  }

  Sequence sequence;
  Settings settings;
  std::vector<FrameReport> reports;
};

const char* kCamera = "camera: {position: [0, 0, 5], look_at: [0, 0, 0], fov_deg: 40}\n";
/// One that flies and turns, so that whatever stands in the world moves on the display.
const char* kFlight =
    "camera: {fov_deg: 40, flight: [{t: 0, position: [-1, 0.5, 6], target: [0, 0, 0]},"
    " {t: 1, position: [1.5, 0, 4], target: [0.3, 0, 0]}]}\n";

Sequence load(const TemporaryFolder& folder, const std::string& text) {
  return load_sequence(folder.write("test.yaml", text));
}

class VideoLayer : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(write_coded(folder_, "v.mkv", 32, 24, "10", 27, kLossless), ""); }
  TemporaryFolder folder_;
};

TEST_F(VideoLayer, ShowsTheRightFrameOnTheScreenInEveryFrameOfTheSequence) {
  const Sequence sequence =
      load(folder_, std::string("frames: 24\nfps: 24\ndisplay: [128, 96]\n") + kFlight +
                        "images: [{id: news, video: v.mkv, screen_px: [16, 8, 64, 48]}]\n"
                        "shapes: [{id: ball, sphere: 1}]\n");
  for (const auto policy :
       {regulator::Policy::Threshold, regulator::Policy::Reference, regulator::Policy::Direct,
        regulator::Policy::Lookahead, regulator::Policy::Oracle}) {
    const DrawnRun run(sequence, policy);
    for (int k = 0; k < 24; ++k)
      EXPECT_EQ(run.number(k, 48, 32), k * 10 / 24) << "frame " << k << ", " << regulator::name(policy);
  }
}

TEST_F(VideoLayer, IsDrawnAgainOnlyWhenTheSourceHasANewFrame) {
  const DrawnRun run(load(folder_, std::string("frames: 24\nfps: 24\ndisplay: [128, 96]\n") + kFlight +
                                       "images: [{id: news, video: v.mkv, screen_px: [16, 8, 64, 48]}]\n"
                                       "shapes: [{id: ball, sphere: 1}]\n"));
  for (int k = 1; k < 24; ++k) {
    const bool is_new = k * 10 / 24 != (k - 1) * 10 / 24;
    const regulator::LayerDecision& d = run.decision(k, "news");
    EXPECT_EQ(d.action, is_new ? Action::Rerender : Action::Reuse) << "frame " << k << ": " << d.reason;
    if (is_new) {
      EXPECT_EQ(d.reason, "new frame of 'v.mkv', " + std::to_string(k * 10 / 24));
      EXPECT_EQ(run.reports[k].upload_bytes, 32 * 24 * 4);
    } else {
      EXPECT_EQ(run.reports[k].upload_bytes, 0);
    }
  }
  EXPECT_EQ(run.reports[0].upload_bytes, 32 * 24 * 4) << "the first one";
}

TEST_F(VideoLayer, OnTheScreenStandsToThePixel) {
  // 64 x 48 px at (16, 8), whatever the camera does: inside the picture's colour, outside the background's.
  const DrawnRun run(
      load(folder_, std::string("frames: 6\nfps: 24\ndisplay: [128, 96]\nbackground: [0, 0, 0]\n") + kFlight +
                        "images: [{id: news, video: v.mkv, screen_px: [16, 8, 64, 48]}]\n"));
  for (int k = 0; k < 6; ++k)
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 128; ++x) {
        const bool inside = x >= 16 && x < 80 && y >= 8 && y < 56;
        const auto c = run.at(k, x, y);
        ASSERT_EQ(c[0] > 20, inside) << "frame " << k << " at " << x << ", " << y;
      }
}

TEST_F(VideoLayer, InTheWorldIsHiddenByWhatIsBeforeItAndBehindIsBehindAll) {
  const DrawnRun run(load(
      folder_, std::string("frames: 3\nfps: 10\ndisplay: [128, 96]\n") + kCamera +
                   "images:\n"
                   "  - {id: wall, video: v.mkv, size_m: [3, 2], position: [0, 0, -1]}\n"
                   "  - {id: sky, video: v.mkv, start_s: -0.5, screen_px: [0, 0, 128, 96], behind: true}\n"
                   "shapes: [{id: box, box: [0.5, 0.5, 0.5], color: [0, 0, 0], unlit: true}]\n"));
  for (int k = 0; k < 3; ++k) {
    EXPECT_THAT(run.at(k, 64, 48), ElementsAre(0, 0, 0)) << "the box";
    EXPECT_EQ(run.number(k, 84, 48), k) << "the wall beside it";
    EXPECT_EQ(run.number(k, 4, 4), k + 5) << "the corner of the display";
  }
}

TEST_F(VideoLayer, OnAPartMakesItsLayerDrawnAndAMergedSpriteThatHoldsIt) {
  // The box and the ball hide each other in turn of the author's making: one sprite for both.
  const std::string text =
      std::string("frames: 6\nfps: 20\ndisplay: [128, 96]\n") + kCamera +
      "images: [{id: news, video: v.mkv, on: [screen]}]\n"
      "shapes:\n"
      "  - {id: screen, box: [2, 1.5, 0.2], unlit: true, color: [1, 1, 1]}\n"
      "  - {id: bar, box: [0.2, 0.2, 3], position: [0.8, 0, 0], color: [0, 0, 0], unlit: true}\n";
  const DrawnRun alone(load(folder_, text + "layers: [{name: both, parts: [screen, bar]}]\n"));
  const DrawnRun merged(
      load(folder_, text + "layers: [{name: screen, parts: [screen]}, {name: bar, parts: [bar]}]\n"));
  ASSERT_FALSE(merged.reports[0].order.back_to_front.empty());
  const std::string name = merged.reports[0].layers[merged.reports[0].order.back_to_front.back()].name;
  ASSERT_EQ(name, "screen+bar") << "the bar runs through the screen";
  for (int k = 1; k < 6; ++k) {
    EXPECT_EQ(alone.number(k, 64, 48), k / 2);
    EXPECT_EQ(merged.number(k, 64, 48), k / 2);
    EXPECT_EQ(alone.decision(k, "both").action, k % 2 == 0 ? Action::Rerender : Action::Reuse);
    EXPECT_EQ(merged.decision(k, name).action, k % 2 == 0 ? Action::Rerender : Action::Reuse);
  }
}

TEST_F(VideoLayer, BudgetDrawsItFirstAndSaysWhenItCannot) {
  Sequence sequence = load(folder_, std::string("frames: 6\nfps: 10\ndisplay: [128, 96]\n") + kCamera +
                                        "images: [{id: news, video: v.mkv, screen_px: [16, 8, 64, 48]}]\n");
  sequence.regulator.budget.pixels = 64 * 64;
  const DrawnRun enough(sequence, regulator::Policy::Budget);
  EXPECT_THAT(enough.decision(3, "news").reason, StartsWith("new frame of 'v.mkv', 3"));
  EXPECT_EQ(enough.decision(3, "news").action, Action::Rerender);
  sequence.regulator.budget.pixels = 16;
  const DrawnRun little(sequence, regulator::Policy::Budget);
  EXPECT_THAT(little.decision(3, "news").reason,
              AllOf(StartsWith("deferred: budget"), HasSubstr("new frame of 'v.mkv', 3")));
  EXPECT_EQ(little.number(3, 48, 32), 0) << "the old frame is shown, and that is said";
}

TEST_F(VideoLayer, TheLastFrameHoldsAndItIsSaidOnce) {
  const Sequence sequence =
      load(folder_, std::string("frames: 40\nfps: 10\ndisplay: [64, 48]\n") + kCamera +
                        "images: [{id: news, video: v.mkv, screen_px: [0, 0, 64, 48]}]\n");
  EXPECT_THAT(
      sequence.notes,
      ElementsAre("image 'news': 'v.mkv' ends at 2.7 s, before the sequence does: its last frame holds"));
  const DrawnRun run(sequence);
  EXPECT_EQ(run.number(26, 32, 24), 26);
  EXPECT_EQ(run.number(39, 32, 24), 26);
  EXPECT_EQ(run.decision(30, "news").action, Action::Reuse);
}

TEST_F(VideoLayer, ALoopBeginsAgainAndIsSilent) {
  const Sequence sequence =
      load(folder_,
           std::string("frames: 60\nfps: 10\ndisplay: [64, 48]\n") + kCamera +
               "images: [{id: news, video: v.mkv, loop: true, start_s: 0.2, screen_px: [0, 0, 64, 48]}]\n");
  EXPECT_THAT(sequence.notes, IsEmpty());
  const DrawnRun run(sequence);
  for (const int k : {0, 1, 2, 3, 28, 29, 30, 59})
    EXPECT_EQ(run.number(k, 32, 24), std::max(k - 2, 0) % 27) << k;
}

TEST(ImageLayer, ASequenceOfPicturesIsShownInTheOrderOfItsNames) {
  const TemporaryFolder folder;
  for (int k = 0; k < 4; ++k) {
    const auto c = tests::code_of(k);
    folder.write("water/" + std::to_string(k) + ".txt", "not a picture that matches");
    write_png(folder / ("water/w" + std::to_string(k) + ".png"), {1, 1, {c[0], c[1], c[2]}});
  }
  const Sequence sequence =
      load(folder, std::string("frames: 8\nfps: 10\ndisplay: [64, 48]\n") + kCamera +
                       "images: [{id: water, files: \"water/w*.png\", fps: 5, screen_px: [0, 0, 64, 48]}]\n");
  const DrawnRun run(sequence);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(run.number(k, 32, 24), k / 2);
}

TEST(ImageLayer, APictureIsDrawnOnceAndHasNoMovingPicture) {
  const TemporaryFolder folder;
  write_png(folder / "logo.png", {1, 1, {216, 128, 40}});
  const Sequence sequence =
      load(folder, std::string("frames: 5\nfps: 10\ndisplay: [64, 48]\n") + kFlight +
                       "images: [{id: logo, file: logo.png, screen_px: [8, 8, 16, 16]}]\n");
  EXPECT_THAT(sequence.scene->moving_pictures, IsEmpty());
  const DrawnRun run(sequence);
  for (int k = 1; k < 5; ++k)
    EXPECT_EQ(run.decision(k, "logo").action, Action::Reuse) << run.decision(k, "logo").reason;
  EXPECT_FALSE(run.reports[4].upload_bytes.has_value());
  EXPECT_EQ(sequence.layers.layers[0].group, layers::OrderGroup::Foreground);
}

TEST(ImageLayer, OfTwoOnTheScreenTheLaterIsInFront) {
  const TemporaryFolder folder;
  write_png(folder / "red.png", {1, 1, {200, 0, 0}});
  write_png(folder / "blue.png", {1, 1, {0, 0, 200}});
  const Sequence sequence =
      load(folder, std::string("frames: 3\nfps: 10\ndisplay: [64, 48]\n") + kFlight +
                       "images:\n  - {id: under, file: red.png, screen_px: [0, 0, 40, 40]}\n"
                       "  - {id: over, file: blue.png, screen_px: [20, 8, 8, 8]}\n");
  for (const auto policy : {regulator::Policy::Threshold, regulator::Policy::Direct}) {
    const DrawnRun run(sequence, policy);
    for (int k = 0; k < 3; ++k) {
      EXPECT_THAT(run.at(k, 24, 12), ElementsAre(0, 0, 200));
      EXPECT_THAT(run.at(k, 10, 12), ElementsAre(200, 0, 0));
    }
  }
}

// --- What is refused

std::string refusal(const TemporaryFolder& folder, const std::string& image) {
  return message_of([&] {
    load(folder, std::string("frames: 5\n") + kCamera +
                     "shapes: [{id: ball, sphere: 1}, {id: box, box: [1, 1, 1]}]\n" +
                     "images:\n  - {id: news, " + image + "}\n");
  });
}

TEST(ImageRefusal, EachBadInputNamesFileValueAndRule) {
  const TemporaryFolder folder;
  write_png(folder / "a.png", {1, 1, {1, 2, 3}});
  folder.write("zero.png", "");
  folder.write("list.m3u8", "#EXTM3U\n");
  const std::string on_screen = ", screen_px: [0, 0, 8, 8]";
  EXPECT_THAT(refusal(folder, "video: gone.mp4" + on_screen),
              HasSubstr("test.yaml:5: 'gone.mp4' is not there, rule: a file"));
  for (const char* url :
       {"http://a.b/c.mp4", "https://a.b/c.mp4", "\"concat:a.mp4|b.mp4\"", "\"pipe:0\"", "rtsp://a/b"})
    EXPECT_THAT(refusal(folder, std::string("video: ") + url + on_screen),
                AllOf(HasSubstr("test.yaml:5:"), HasSubstr("a file on this machine, not a URL")))
        << url;
  EXPECT_THAT(refusal(folder, "video: list.m3u8" + on_screen), HasSubstr("list.m3u8: is a playlist"));
  EXPECT_THAT(refusal(folder, "video: a.png" + on_screen), HasSubstr("a.png: is no video that ffmpeg reads"));
  EXPECT_THAT(refusal(folder, "file: zero.png" + on_screen),
              HasSubstr("zero.png: not an image that can be read"));
  EXPECT_THAT(refusal(folder, "files: \"none*.png\"" + on_screen),
              HasSubstr("a glob that matches at least one file"));
  EXPECT_THAT(refusal(folder, "files: \"gone/*.png\"" + on_screen),
              HasSubstr("'gone' is not there, rule: a folder"));
  EXPECT_THAT(refusal(folder, "file: a.png, screen_px: [0, 0, 0, 8]"), HasSubstr("width and height above 0"));
  EXPECT_THAT(refusal(folder, "file: a.png, size_m: [0, 8]"), HasSubstr("a number from 1e-09"));
  EXPECT_THAT(refusal(folder, "file: a.png"), HasSubstr("screen_px"));
  EXPECT_THAT(refusal(folder, "file: a.png, on: [gone]"),
              HasSubstr("on 'gone' matches no part, rule: each matches a part"));
  EXPECT_THAT(refusal(folder, "file: a.png, video: a.png" + on_screen), HasSubstr("video"));
  EXPECT_THAT(refusal(folder, "file: a.png, fps: 3" + on_screen), HasSubstr("fps"));
  EXPECT_THAT(message_of([&] {
                load(folder, std::string("frames: 5\nshapes: [{id: ball, sphere: 1}]\n") +
                                 "images: [{id: ball, file: a.png, size_m: [1, 1]}]\n");
              }),
              HasSubstr("image 'ball' has the name of another shape or image, rule: names are unique"));
}

}  // namespace
}  // namespace talisman::sequences
