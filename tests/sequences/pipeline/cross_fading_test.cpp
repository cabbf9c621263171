// SPDX-License-Identifier: Apache-2.0
// A sprite that is drawn again fades in: what is shown, what it costs, and what it does not touch.
#include "sequences/pipeline/cross_fading.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/policies.h"
#include "sequences/experiments/regulator/popping.h"
#include "tests/sequences/playback.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;
using testing::HasSubstr;

constexpr int kFrames = 64;
constexpr int kCube = 1;  // which spins, so that warps err

Variant blended(int frames, Policy policy = Policy::Threshold) {
  Variant variant = tests::run_of(tests::moving_sequence(kFrames));
  variant.settings.regulator.policy = policy;
  regulator::Thresholds& only_geometric = variant.settings.regulator.thresholds;
  only_geometric = {.geometric_px = 1, .magnification = 0, .minification = 0, .anisotropy = 0};
  only_geometric.uncovered_px = -1;
  only_geometric.photometric = 0;
  variant.settings.regulator.blend_frames = frames;
  variant.settings.fps = 120;  // so slow that a sprite lasts for some frames
  return variant;
}

std::vector<FrameReport> played(const Variant& variant, bool draw = false) {
  return tests::Playback(variant.sequence, variant.settings, draw).all(kFrames);
}

const ShownSprite* shown(const FrameReport& report, int layer) {
  const auto it = std::find_if(report.shown.begin(), report.shown.end(),
                               [&](const ShownSprite& sprite) { return sprite.layer == layer; });
  return it == report.shown.end() ? nullptr : &*it;
}

/// The first frame in which the cube is drawn again after that of frame 0, if it was carried in between.
int first_step(const std::vector<FrameReport>& reports) {
  for (int f = 1; f + 3 < kFrames; ++f)
    if (reports[f].plan.decisions[kCube].action == Action::Rerender) return f > 1 ? f : -1;
  return -1;
}

TEST(CrossFading, SharesOfTheOldSpriteFallInEqualSteps) {
  const auto reports = played(blended(3));
  const int f = first_step(reports);
  ASSERT_GT(f, 0);
  ASSERT_EQ(reports[f + 1].plan.decisions[kCube].action, Action::Reuse);
  ASSERT_EQ(reports[f + 2].plan.decisions[kCube].action, Action::Reuse);
  for (int j = 0; j < 3; ++j) {
    const ShownSprite* sprite = shown(reports[f + j], kCube);
    ASSERT_TRUE(sprite && sprite->old) << j;
    EXPECT_DOUBLE_EQ(sprite->old->share, (3 - j) / 4.0);
    EXPECT_THAT(reports[f + j].plan.decisions[kCube].reason,
                HasSubstr(std::to_string(75 - 25 * j) + " % of the sprite before it"));
  }
  EXPECT_FALSE(shown(reports[f - 1], kCube)->old);
}

TEST(CrossFading, ChangesNoDecisionAndOnlyAddsItsOwnPixels) {
  const auto without = played(blended(0)), with = played(blended(2));
  std::int64_t blended_pixels = 0;
  for (int f = 0; f < kFrames; ++f) {
    std::int64_t added = 0;
    for (std::size_t k = 0; k < without[f].plan.decisions.size(); ++k) {
      const auto &a = without[f].plan.decisions[k], &b = with[f].plan.decisions[k];
      EXPECT_EQ(a.action, b.action) << f << " " << k;
      EXPECT_EQ(a.cost.polygons, b.cost.polygons);
      const ShownSprite* sprite = shown(with[f], static_cast<int>(k));
      const std::int64_t texels =
          sprite && sprite->old ? std::int64_t{sprite->size_px.x} * sprite->size_px.y : 0;
      EXPECT_EQ(b.cost.pixels, a.cost.pixels + texels);
      added += texels;
    }
    EXPECT_EQ(with[f].blended_pixels, added);
    EXPECT_EQ(without[f].blended_pixels, 0);
    blended_pixels += added;
  }
  EXPECT_GT(blended_pixels, 0);
}

TEST(CrossFading, TheErrorShownIsThatOfTheWorse) {
  const Variant variant = blended(2);
  const auto reports = played(variant);
  const int f = first_step(reports);
  ASSERT_GT(f, 0);
  // The fresh sprite is exact and the old one is past the threshold: that is why it was drawn again.
  EXPECT_NEAR(reports[f].plan.decisions[kCube].shown_geometric_px,
              reports[f].plan.decisions[kCube].warp_geometric_px, 1e-9);
  EXPECT_GT(reports[f].plan.decisions[kCube].shown_geometric_px, 1);
}

TEST(CrossFading, NothingFadesUnderAThresholdOfZero) {
  Variant variant = blended(2);
  variant.settings.regulator.thresholds.geometric_px = 0;
  for (const FrameReport& report : played(variant))
    for (const ShownSprite& sprite : report.shown) EXPECT_FALSE(sprite.old) << report.frame;
}

TEST(CrossFading, WhatIsKnownToBeWrongDoesNotFade) {
  regulator::RegulatorOptions options;  // 4 px, 0.05 of light
  regulator::LayerAssessment old;
  old.fitted.status = warp::FitStatus::Converged;
  old.matched_points = 12;
  old.fiducials.geometric.px = 7.9;
  old.fiducials.photometric.computed = true;
  old.fiducials.photometric.color = 0.09;
  old.fiducials.sampling.magnification = 3;  // no worse than before it was drawn again
  EXPECT_TRUE(regulator::may_fade_out(old, options));
  old.fiducials.photometric.color = 0.11;  // the light is another
  EXPECT_FALSE(regulator::may_fade_out(old, options));
  old.fiducials.photometric.color = 0;
  old.new_picture = "new frame of 'clip', 7";  // a cut stays a cut
  EXPECT_FALSE(regulator::may_fade_out(old, options));
  old.new_picture.clear();
  old.fiducials.geometric.px = 8.1;
  EXPECT_FALSE(regulator::may_fade_out(old, options));
}

// The oracle is another run: where the cube may be off by 1000 px, its sprite of frame 0 is carried on, and two
// pictures are mixed by hand.
TEST(CrossFading, ShowsTheMixOfBothPictures) {
  Variant old_alone = blended(0), fresh_alone = blended(0), both = blended(1);
  old_alone.sequence.layers.layers[kCube].preferences.importance.geometric = 0.001;
  const auto mixed = played(both, true);
  const int f = first_step(mixed);
  ASSERT_GT(f, 0);
  const auto olds = played(old_alone, true), fresh = played(fresh_alone, true);
  ASSERT_EQ(olds[f].plan.decisions[kCube].action, Action::Reuse);
  ASSERT_EQ(shown(mixed[f], kCube)->old->share, 0.5);
  // The other layers are the same in both: all that differs is the cube.
  int compared = 0;
  double sum = 0, largest_difference = 0;
  for (std::size_t i = 0; i < mixed[f].picture.pixels.size(); ++i) {
    const chunker::Linear16 a = olds[f].picture.pixels[i], b = fresh[f].picture.pixels[i],
                            m = mixed[f].picture.pixels[i];
    if (a == b) continue;
    const double expected = std::sqrt((a.g + b.g) / 2.0 / chunker::kOne);
    const double error = 255 * std::fabs(std::sqrt(m.g / double(chunker::kOne)) - expected);
    sum += error;
    ++compared;
    largest_difference = std::max(largest_difference, std::fabs(double(a.g) - b.g) / chunker::kOne);
  }
  ASSERT_GT(compared, 50);
  EXPECT_GT(largest_difference, 0.05);  // the two pictures do differ
  EXPECT_LT(sum / compared, 1.5);       // of 255: filtered twice, and rounded to 8 bits between
}

TEST(CrossFading, IsTheSameWhetherFramesAreDrawnOrOnlyPlanned) {
  const Variant variant = blended(3);
  const auto drawn = played(variant, true);
  const int f = first_step(drawn);
  ASSERT_GT(f, 0);
  tests::Playback later(variant.sequence, variant.settings);
  while (later.frame < f + 1) {
    const FrameReport planned = later.next();
    for (std::size_t k = 0; k < planned.plan.decisions.size(); ++k)
      EXPECT_EQ(planned.plan.decisions[k].reason, drawn[planned.frame].plan.decisions[k].reason);
  }
  later.prepared.emplace(*later.sequence.scene);  // in the middle of a fade: both sprites are drawn late
  const FrameReport resumed = later.next();
  EXPECT_EQ(chunker::srgb_bytes(resumed.picture), chunker::srgb_bytes(drawn[f + 1].picture));
  EXPECT_GE(resumed.late_renders, 2);
}

TEST(CrossFading, TheStepIsSpreadOverItsFrames) {
  const auto meter = [](const Variant& variant) {
    const chunker::PreparedScene prepared(*variant.sequence.scene);
    tests::Playback playback(variant.sequence, variant.settings, true);
    PoppingMeter steps;
    Image8 shown_before, truth_before;
    std::vector<int> layers_before;
    for (int f = 0; f < kFrames; ++f) {
      const FrameReport report = playback.next();
      Image8 now = to_image8(report.picture),
             truth = to_image8(draw_reference(playback.pipeline, f, prepared));
      if (f > 0)
        steps.add(
            {shown_before, now}, {truth_before, truth},
            stepping_pixels(layers_before, report, playback.state.sprites, variant.settings.view.display_px));
      shown_before = std::move(now);
      truth_before = std::move(truth);
      layers_before.clear();
      for (const ShownSprite& sprite : report.shown) layers_before.push_back(sprite.layer);
    }
    return steps.result();
  };
  EXPECT_LT(meter(blended(2)).rms, 0.8 * meter(blended(0)).rms);
}

TEST(CrossFading, PoliciesThatCarryNothingOrHaveABudgetDoNotBlend) {
  for (const Policy policy : {Policy::Direct, Policy::Reference, Policy::Hold, Policy::Budget}) {
    Variant variant = blended(4, policy);
    variant.settings.regulator.budget.polygons = 10000;
    EXPECT_FALSE(regulator::blends(variant.settings.regulator));
    for (const FrameReport& report : played(variant)) EXPECT_EQ(report.blended_pixels, 0);
  }
}

TEST(CrossFading, NothingFadesThatIsOffByMoreThanTwiceTheThreshold) {
  Variant variant = blended(8);  // longer than the old sprite is worth showing
  int fades = 0;
  for (const FrameReport& report : played(variant))
    for (const ShownSprite& sprite : report.shown) {
      fades += sprite.old.has_value();
      EXPECT_LE(report.plan.decisions[sprite.layer].shown_geometric_px, 2 + 1e-9) << report.frame;
    }
  EXPECT_GT(fades, 0);
}

TEST(CrossFading, WhatIsDrawnEveryFrameDoesNotFade) {
  Variant variant = blended(4);
  variant.settings.regulator.thresholds.geometric_px = 0;
  for (const FrameReport& report : played(variant)) EXPECT_EQ(report.blended_pixels, 0) << report.frame;
}

TEST(Staggered, EachLayerHasABeatOfItsOwn) {
  Variant variant = blended(0, Policy::Interpolate);
  variant.settings.regulator.hold_frames = 3;
  variant.settings.regulator.stagger = true;
  const auto reports = played(variant);
  for (int f = 1; f < kFrames; ++f)
    for (const regulator::LayerDecision& d : reports[f].plan.decisions) {
      if (d.action == Action::Drop) continue;
      const bool due = (f + d.layer) % 3 == 0;
      EXPECT_EQ(d.action == Action::Rerender, due)
          << "frame " << f << ", layer " << d.layer << ": " << d.reason;
    }
}

}  // namespace
}  // namespace talisman::sequences
