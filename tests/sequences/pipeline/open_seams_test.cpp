// SPDX-License-Identifier: Apache-2.0
// Cracks between layers are counted where they are, and `seam: auto` leaves none.
#include "sequences/pipeline/open_seams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chunker/pixel.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using tests::TemporaryFolder;

AlphaPlane covered(int width, int height) {
  return {width, height, std::vector<std::uint16_t>(static_cast<std::size_t>(width) * height, chunker::kOne)};
}

std::uint16_t& at(AlphaPlane& plane, int x, int y) {
  return plane.alpha[static_cast<std::size_t>(y) * plane.width + x];
}

TEST(OpenPixels, ACrackOfOnePixelReadsItsLength) {
  const AlphaPlane whole = covered(100, 80);
  AlphaPlane shown = whole;
  for (int y = 20; y < 57; ++y) at(shown, 50, y) = 0;
  const CutLine cut{{50.5, 0}, {50.5, 80}, 3};
  EXPECT_EQ(open_pixels(shown, whole, std::vector{cut}), 37);
  EXPECT_EQ(open_pixels(shown, whole, std::vector{cut, cut}), 37) << "each pixel once";
  EXPECT_EQ(open_pixels(whole, whole, std::vector{cut}), 0);
}

TEST(OpenPixels, MoreThanEightOf255IsOpen) {
  const AlphaPlane whole = covered(40, 40);
  AlphaPlane shown = whole;
  at(shown, 20, 20) = static_cast<std::uint16_t>(chunker::kOne - 8 * chunker::kOne / 255);
  at(shown, 20, 22) = static_cast<std::uint16_t>(chunker::kOne - 9 * chunker::kOne / 255);
  EXPECT_EQ(open_pixels(shown, whole, std::vector{CutLine{{20.5, 0}, {20.5, 40}, 2}}), 1);
}

TEST(OpenPixels, OnlyNearACutAndNotAtAnOutline) {
  AlphaPlane whole = covered(60, 60);
  AlphaPlane shown = whole;
  for (int y = 0; y < 60; ++y) at(shown, 30, y) = 0;
  EXPECT_EQ(open_pixels(shown, whole, std::vector{CutLine{{10, 0}, {10, 60}, 4}}), 0) << "far from the cut";
  // An outline that has moved: the land ends at x = 31 in the one pass.
  for (int y = 0; y < 60; ++y)
    for (int x = 31; x < 60; ++x) at(whole, x, y) = at(shown, x, y) = 0;
  EXPECT_EQ(open_pixels(shown, whole, std::vector{CutLine{{30.5, 0}, {30.5, 60}, 4}}), 0);
}

TEST(OpenPixels, WhatACutSideUncoversAtTheBorderIsNoCrack) {
  const AlphaPlane whole = covered(60, 50);
  AlphaPlane shown = whole;
  for (int x = 0; x < 60; ++x) at(shown, x, 25) = 0;  // all along the cut
  const std::vector cut{CutLine{{0, 25.5}, {60, 25.5}, 3}};
  EXPECT_EQ(open_pixels(shown, whole, cut), 60);
  EXPECT_EQ(open_pixels(shown, whole, cut, 2), 56) << "two at either end";
  EXPECT_EQ(open_pixels(shown, whole, cut, 25), 0) << "all rows are border";
  EXPECT_EQ(open_pixels(shown, whole, cut, 1'000'000), 0);
  EXPECT_EQ(border_width_px(0), 0) << "nothing may be uncovered, and all is counted";
  EXPECT_EQ(border_width_px(-1), 0) << "nobody looks";
  EXPECT_EQ(border_width_px(1), 2);
  EXPECT_EQ(border_width_px(0.3), 2);
}

/// A land of 3 x 3 tiles of 8 m, over which the camera flies low; a bright background shows through any crack.
std::string tiles(const std::string& more) {
  std::string text =
      "frames: 24\nfps: 24\ndisplay: [256, 192]\nbackground: [1, 0, 1]\n" + more +
      "camera: {fov_deg: 50, near_m: 0.5, far_m: 200, flight: ["
      "{t: 0, position: [-6, 5, 14], target: [0, 0, -2]}, {t: 1, position: [5, 4, 9], target: [1, 0, -3]}]}\n"
      "regulator: {geometric_px: 0.8}\nshapes:\n";
  for (const int x : {-1, 0, 1})
    for (const int z : {-1, 0, 1})
      text += "  - {id: tile " + std::to_string(x) + " " + std::to_string(z) +
              ", plane: [8, 8], color: [0.2, 0.3, 0.1],"
              " position: [" +
              std::to_string(8 * x) + ", 0, " + std::to_string(8 * z) + "]}\n";
  return text;
}

struct Seen {
  std::int64_t open = 0, polygons = 0, pixels = 0;
  int reuses = 0, merged = 0;
};

Seen run_tiles(const std::string& more) {
  const TemporaryFolder folder;
  const Sequence sequence = load_sequence(folder.write("tiles.yaml", tiles(more)));
  const Settings settings = tests::run_of(sequence).settings;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  const chunker::PreparedScene prepared(*sequence.scene);
  const SeamCounter counter(pipeline);
  PipelineState state(pipeline);
  Seen seen;
  for (int k = 0; k < sequence.frames; ++k) {
    const FrameReport report = step(pipeline, state, k, &prepared);
    seen.open += counter.open_in(state, report, prepared).value();
    seen.merged += report.order.merged_parts;
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      seen.polygons += d.cost.polygons;
      seen.pixels += d.cost.pixels;
      seen.reuses += d.action == regulator::Action::Reuse;
    }
  }
  return seen;
}

TEST(Seams, WithoutThemCracksAreOpenAndWithThemNone) {
  const Seen without = run_tiles(""), with = run_tiles("seam: auto\n");
  EXPECT_GT(without.open, 100) << "else this proves nothing";
  EXPECT_GT(without.reuses, 50) << "sprites are warped";
  EXPECT_EQ(with.open, 0);
  EXPECT_EQ(without.merged, 0);
  EXPECT_EQ(with.merged, 0) << "the seams reach into each other's bodies, and must not merge the tiles";
  RecordProperty("polygons", std::to_string(without.polygons) + " " + std::to_string(with.polygons));
  RecordProperty("pixels", std::to_string(without.pixels) + " " + std::to_string(with.pixels));
}

TEST(Seams, ChangeNothingWhereNoLayersShareAnEdge) {
  const TemporaryFolder folder;
  const char* text =
      "frames: 3\nshapes: [{id: a, sphere: 1}, {id: b, box: [1, 1, 1], position: [3, 0, 0]}]\nseam: ";
  const Sequence none = load_sequence(folder.write("none.yaml", text + std::string("none\n")));
  const Sequence automatic = load_sequence(folder.write("auto.yaml", text + std::string("auto\n")));
  EXPECT_EQ(automatic.scene->parts.size(), none.scene->parts.size());
  const Pipeline pipeline = make_pipeline(*none.scene, none.layers, tests::run_of(none).settings);
  const chunker::PreparedScene prepared(*none.scene);
  PipelineState state(pipeline);
  EXPECT_FALSE(
      SeamCounter(pipeline).open_in(state, step(pipeline, state, 0, &prepared), prepared).has_value());
}

TEST(Seams, DirectIsTheTruthAndHasNone) {
  const TemporaryFolder folder;
  const Sequence none = load_sequence(folder.write("none.yaml", tiles("")));
  const Sequence automatic = load_sequence(folder.write("auto.yaml", tiles("seam: auto\n")));
  const auto picture = [](const Sequence& sequence) {
    const Pipeline pipeline =
        make_pipeline(*sequence.scene, sequence.layers, tests::run_of(sequence).settings);
    return draw_direct(pipeline, 7, chunker::PreparedScene(*sequence.scene));
  };
  EXPECT_EQ(picture(none), picture(automatic));
}

}  // namespace
}  // namespace talisman::sequences
