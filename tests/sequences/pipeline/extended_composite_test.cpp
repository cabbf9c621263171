// SPDX-License-Identifier: Apache-2.0
// The extended compositor: its operators, its pictures and what it decides. The whole on the carousel is in
// carousel_test.cpp.
#include "sequences/pipeline/extended_composite.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/options.h"
#include "sequences/pipeline/resolved_cycles.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/summary.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using chunker::Frame;
using chunker::kOne;
using chunker::Linear16;
using chunker::Sprite;
using chunker::Texel;
using layers::MergedComponent;
using Operator = layers::CompositeExpression::Operator;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::message_of;
using tests::TemporaryFolder;

constexpr layers::ivec2 kDisplay{40, 36};

// --- Operators ---

Linear16 combined(Operator op, Linear16 a, Linear16 b) {
  return combine(op, Frame{1, 1, {a}}, Frame{1, 1, {b}}).pixels.front();
}

TEST(CombineImages, OpaqueAndClearOperandsAreExact) {
  const Linear16 red{61234, 17, 0, kOne}, blue{1, 2, 50001, kOne}, clear{};
  EXPECT_EQ(combined(Operator::Over, red, blue), red);
  EXPECT_EQ(combined(Operator::Over, clear, blue), blue);
  EXPECT_EQ(combined(Operator::Atop, red, blue), red);
  EXPECT_EQ(combined(Operator::Atop, red, clear), clear);
  EXPECT_EQ(combined(Operator::Atop, clear, blue), blue);
  EXPECT_EQ(combined(Operator::Out, red, blue), clear);
  EXPECT_EQ(combined(Operator::Out, red, clear), red);
  EXPECT_EQ(combined(Operator::Plus, red, clear), red);
  // What no expression of ours does, but rounding could come near to: a sum beyond one saturates.
  EXPECT_EQ(combined(Operator::Plus, red, blue), (Linear16{61235, 19, 50001, kOne}));
}

TEST(CombineImages, TranslucentOperandsFollowTheFormulas) {
  std::mt19937 random(11);
  const auto value = [&](std::uint32_t most) { return static_cast<std::uint16_t>(random() % (most + 1)); };
  for (int i = 0; i < 2000; ++i) {
    const std::uint16_t a = value(kOne), b = value(kOne), x = value(a), y = value(b);
    const double fa = a / double(kOne), fb = b / double(kOne);
    const Linear16 left{x, x, x, a}, right{y, y, y, b};
    // Two products, each rounded: at most one unit.
    EXPECT_NEAR(combined(Operator::Over, left, right).r, x + (1 - fa) * y, 1);
    EXPECT_NEAR(combined(Operator::Atop, left, right).r, fb * x + (1 - fa) * y, 1);
    EXPECT_NEAR(combined(Operator::Atop, left, right).a, b, 1);
    EXPECT_NEAR(combined(Operator::Out, left, right).g, (1 - fb) * x, 1);
    EXPECT_NEAR(combined(Operator::Out, left, right).a, (1 - fb) * a, 1);
    EXPECT_EQ(combined(Operator::Plus, left, right).b, std::min<std::uint32_t>(x + y, kOne));
  }
}

TEST(CombineImages, EmptyImagesAreEmpty) { EXPECT_TRUE(combine(Operator::Over, {}, {}).pixels.empty()); }

// --- Pictures ---

/// A sprite of the size of the display that shows `texel` in some of its columns.
Sprite columns(int first, int last, Texel texel) {
  Sprite sprite(kDisplay);
  for (int row = 0; row < sprite.chunks().y; ++row)
    for (int column = 0; column < sprite.chunks().x; ++column) {
      chunker::Chunk chunk;
      for (int i = 0; i < chunker::kChunkSize * chunker::kChunkSize; ++i) {
        const int x = column * chunker::kChunkSize + i % chunker::kChunkSize;
        const int y = row * chunker::kChunkSize + i / chunker::kChunkSize;
        if (x >= first && x < last && y < kDisplay.y) chunk.texels[i] = texel;
      }
      sprite.store(column, row, chunk);
    }
  return sprite;
}

LayerSprite shown(int layer, const Sprite& sprite) {
  LayerSprite s{layer, {}};
  s.placed.sprite = &sprite;
  return s;
}

/// 1 behind 2 behind 3 behind 1.
FrameOrder three_that_go_round() {
  MergedComponent component;
  component.layers = {1, 2, 3};
  component.relations = {{1, 2}, {2, 3}, {3, 1}};
  FrameOrder order;
  order.resolved.push_back({component.layers, layers::occlusion_expression(component)});
  return order;
}

/// Sprites of three layers that go round, each pair of which shares columns of its own, between two sprites
/// that belong to no cycle.
struct Ring {
  Texel texels[5];
  std::vector<Sprite> sprites;
  explicit Ring(std::uint8_t alpha) {
    texels[0] = {10, 20, 200, 255}, texels[4] = {3, 3, 3, 40};
    for (int k = 1; k <= 3; ++k) {
      const auto color = static_cast<std::uint8_t>(std::sqrt(alpha / 255.0) * 50 * k);
      texels[k] = {color, static_cast<std::uint8_t>(color / 2), 0, alpha};
    }
    sprites.push_back(columns(0, 40, texels[0]));
    sprites.push_back(columns(0, 18, texels[1]));
    sprites.push_back(columns(12, 30, texels[2]));
    sprites.push_back(columns(24, 40, texels[3]));
    sprites.push_back(columns(3, 36, texels[4]));
  }
};

/// Back to front, the layers of the ring that cover column x.
std::vector<int> layers_in_column(int x) {
  std::vector<int> line{0};
  if (x < 18) line.push_back(1);
  if (x >= 12 && x < 30) line.push_back(2);  // 1 is behind 2
  if (x >= 24) line.push_back(3);            // 2 is behind 3
  if (x >= 3 && x < 36) line.push_back(4);
  return line;
}

/// The same when 3 covers columns 0 to 15 and 2 columns 16 to 29: 3 meets 1 alone, and is behind it.
std::vector<int> layers_where_the_ring_closes(int x) {
  std::vector<int> line{0};
  if (x < 16) line.push_back(3);
  if (x < 18) line.push_back(1);
  if (x >= 16 && x < 30) line.push_back(2);
  if (x >= 3 && x < 36) line.push_back(4);
  return line;
}

/// Over, in floating point.
double red_over(const std::vector<int>& line, const Ring& ring) {
  double red = 0;
  for (const int k : line) {
    const Linear16 t = chunker::decode(ring.texels[k]);
    red = t.r + (1 - t.a / double(kOne)) * red;
  }
  return red;
}

TEST(CompositeExtended, EachPixelShowsItsLayersInTheirOwnOrder) {
  // `over` in the order in which the sprites are handed in, 3 2 1, would be wrong in every shared column.
  for (const int alpha : {255, 128, 30, 0}) {
    const Ring ring(static_cast<std::uint8_t>(alpha));
    const std::vector<LayerSprite> sprites{shown(0, ring.sprites[0]), shown(3, ring.sprites[3]),
                                           shown(2, ring.sprites[2]), shown(1, ring.sprites[1]),
                                           shown(4, ring.sprites[4])};
    const Frame frame = composite_extended(sprites, three_that_go_round(), kDisplay, {1, 1, 1}).frame;
    for (int x = 0; x < kDisplay.x; ++x)
      EXPECT_NEAR(frame.pixels[5 * kDisplay.x + x].r, red_over(layers_in_column(x), ring), 4)
          << "column " << x << ", alpha " << alpha;
    EXPECT_EQ(frame.pixels.back().a, kOne);
  }
}

TEST(CompositeExtended, RelationThatClosesTheCycleHolds) {
  // Handed in as 1 2 3, so that `over` in that order would show 3 in front of 1.
  Ring ring(255);
  ring.sprites[3] = columns(0, 16, ring.texels[3]);
  ring.sprites[2] = columns(16, 30, ring.texels[2]);
  const std::vector<LayerSprite> sprites{shown(0, ring.sprites[0]), shown(1, ring.sprites[1]),
                                         shown(2, ring.sprites[2]), shown(3, ring.sprites[3]),
                                         shown(4, ring.sprites[4])};
  const Frame frame = composite_extended(sprites, three_that_go_round(), kDisplay, {1, 1, 1}).frame;
  for (int x = 0; x < kDisplay.x; ++x)
    EXPECT_NEAR(frame.pixels[x].r, red_over(layers_where_the_ring_closes(x), ring), 4) << "column " << x;
}

TEST(CompositeExtended, WithoutExpressionsItIsTheCompositor) {
  const Ring ring(90);
  std::vector<LayerSprite> sprites;
  std::vector<chunker::PlacedSprite> placed;
  for (int k = 0; k < 5; ++k) {
    sprites.push_back(shown(k, ring.sprites[k]));
    placed.push_back(sprites.back().placed);
  }
  const auto extended = composite_extended(sprites, {}, kDisplay, {0.1f, 0.2f, 0.3f});
  const auto usual = chunker::composite(placed, kDisplay, {0.1f, 0.2f, 0.3f});
  EXPECT_EQ(extended.frame, usual.frame);
  EXPECT_EQ(extended.counters, usual.counters);
}

TEST(CompositeExtended, LayersWithoutSpritesAreClear) {
  // Of the cycle only one sprite is left: no cycle is to be seen.
  const Ring ring(200);
  const std::vector<LayerSprite> sprites{shown(0, ring.sprites[0]), shown(2, ring.sprites[2])};
  const std::vector<chunker::PlacedSprite> placed{sprites[0].placed, sprites[1].placed};
  EXPECT_EQ(composite_extended(sprites, three_that_go_round(), kDisplay, {0, 0, 0}).frame,
            chunker::composite(placed, kDisplay, {0, 0, 0}).frame);
  EXPECT_EQ(composite_extended({}, three_that_go_round(), {0, 0}, {0, 0, 0}).frame.pixels.size(), 0u);
}

// --- Decisions ---

Settings extended(const Sequence& s, regulator::Policy policy = regulator::Policy::Threshold) {
  Settings settings = resolve({}, s, true).settings;
  settings.regulator.policy = policy;
  settings.compositor = Compositor::Extended;
  return settings;
}

TEST(ResolveCycle, WhatHasNoExpressionIsLeftToMerge) {
  const Sequence s = load_sequence("carousel");
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, extended(s));
  MergedComponent c;
  c.layers = {10, 11, 12};
  c.relations = {{10, 11}, {11, 12}, {12, 10}};
  EXPECT_TRUE(resolve_cycle(pipeline, {}, c).cycle);
  Settings talisman = extended(s);
  talisman.compositor = Compositor::Talisman;
  EXPECT_FALSE(resolve_cycle(make_pipeline(*s.scene, s.layers, talisman), {}, c).cycle);
  c.reason = MergedComponent::Reason::Interpenetration;
  EXPECT_FALSE(resolve_cycle(pipeline, {}, c).cycle);
  // A contradiction of reason and relations must not produce a picture either.
  c.reason = MergedComponent::Reason::Cycle;
  c.relations.push_back({11, 10});
  EXPECT_FALSE(resolve_cycle(pipeline, {}, c).cycle);
}

TEST(ResolveCycle, HeldComponentsStayAsTheyWere) {
  const Sequence s = load_sequence("carousel");
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, extended(s));
  MergedComponent c;
  c.layers = {10, 11, 12};
  c.relations = {{10, 11}, {11, 12}};
  c.reason = MergedComponent::Reason::Held;
  std::vector<int> merged_before(s.layers.layers.size(), -1);
  EXPECT_TRUE(resolve_cycle(pipeline, merged_before, c).cycle);
  merged_before[11] = 15;
  EXPECT_FALSE(resolve_cycle(pipeline, merged_before, c).cycle);
}

TEST(ExtendedCompositor, ReasonsAndCountersTellOfExpressions) {
  const Sequence s = load_sequence("carousel");
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, extended(s));
  PipelineState state(pipeline);
  const FrameReport report = step(pipeline, state, 0, nullptr);
  ASSERT_EQ(s.layers.layers[10].name, "plank a");
  EXPECT_EQ(report.plan.decisions[10].reason,
            "first_appearance; in a cycle with plank b, plank c: composited by an expression");
  EXPECT_TRUE(report.order.mergers.empty());
  EXPECT_EQ(report.order.counters.merged_components, 0);
  EXPECT_EQ(report.order.counters.merged_layers, 0);
  // Three layers, each out of the one before it: six reads, a sum and a term.
  EXPECT_EQ(report.order.resolved_counters(), (ResolvedCounters{1, 3, 2, 6, 6}));
  const auto line = frame_line_from_json(json_of(line_of(report)));
  ASSERT_TRUE(line && line->visibility);
  EXPECT_EQ(line->visibility->resolved, report.order.resolved_counters());
  Summary summary = start_summary(pipeline, s.name);
  summary.planned_only = true;
  summary.frames = {*line, *line};
  EXPECT_EQ(summary.sums().resolved(), (ResolvedCounters{2, 6, 2, 12, 12}));
  EXPECT_THAT(json_of(summary), HasSubstr("\"compositor\": \"extended\""));
  EXPECT_THAT(table_of(summary), HasSubstr("12 reads, 12 operators, 2 registers"));
}

TEST(ExtendedCompositor, TalismanHasNeitherExpressionsNorTheirFigures) {
  const Sequence s = load_sequence("carousel");
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, resolve({}, s, true).settings);
  PipelineState state(pipeline);
  const FrameReport report = step(pipeline, state, 0, nullptr);
  EXPECT_EQ(report.order.mergers.size(), 1u);
  EXPECT_EQ(report.order.resolved_counters(), ResolvedCounters{});
  Summary summary = start_summary(pipeline, s.name);
  summary.planned_only = true;
  summary.frames = {line_of(report)};
  EXPECT_THAT(table_of(summary), Not(HasSubstr("expressions")));
}

/// Three boards that go round, as seen from the front.
std::string boards(const std::string& first_layer_more) {
  std::string text = "frames: 8\ndisplay: [80, 60]\nshapes:\n";
  for (int k = 0; k < 3; ++k) {
    const double angle = 2.0943951 * k, x = -1.2 * std::sin(angle), y = 1.2 * std::cos(angle);
    // Each leans back along its length, so that it starts before the one and ends behind the other.
    char line[400];
    std::snprintf(line, sizeof line,
                  "  - {id: %d, box: [0.08, 0.4, 4.6], specular: [1, 1, 1], shininess: 20, flight: [{t: 0, "
                  "position: [%.4f, %.4f, 0], target: [%.4f, %.4f, -25]}, {t: 1, position: [%.4f, %.4f, "
                  "0.001], target: [%.4f, %.4f, -25]}]}\n",
                  k, x, y, x + 100 * std::cos(angle), y + 100 * std::sin(angle), x, y,
                  x + 100 * std::cos(angle), y + 100 * std::sin(angle));
    text += line;
  }
  text += "camera: {fov_deg: 40, near_m: 1, far_m: 100, position: [0, 0, 14], look_at: [0, 0, 0]}\nlayers:\n";
  for (int k = 0; k < 3; ++k)
    text += "  - {name: board " + std::to_string(k) + ", parts: ['" + std::to_string(k) + "']" +
            (k == 0 ? first_layer_more : "") + "}\n";
  return text + "compositor: extended\n";
}

TEST(ExtendedCompositor, LayersOfLayersAreMergedAndSayWhy) {
  const TemporaryFolder folder;
  const Sequence plain = load_sequence(folder.write("plain.yaml", boards("")));
  EXPECT_EQ(plain.compositor, Compositor::Extended);
  const Pipeline apart = make_pipeline(*plain.scene, plain.layers, resolve({}, plain, true).settings);
  PipelineState apart_state(apart);
  EXPECT_EQ(step(apart, apart_state, 0, nullptr).order.resolved.size(), 1u);

  const Sequence shaded = load_sequence(folder.write("shaded.yaml", boards(", shading: {specular: {}}")));
  const Pipeline merged = make_pipeline(*shaded.scene, shaded.layers, resolve({}, shaded, true).settings);
  PipelineState merged_state(merged);
  const FrameReport report = step(merged, merged_state, 0, nullptr);
  EXPECT_TRUE(report.order.resolved.empty());
  ASSERT_EQ(report.order.mergers.size(), 1u);
  EXPECT_THAT(report.order.mergers[0].why, HasSubstr("board 0 has shade layers"));
}

TEST(ExtendedCompositor, UnknownProfilesAreRefused) {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& value) {
    return message_of([&] { load_sequence(folder.write("x.yaml", boards("") + "\n" + value)); });
  };
  EXPECT_THAT(load(""), "");
  std::string text = boards("");
  text.replace(text.find("extended"), 8, "fancy");
  EXPECT_THAT(message_of([&] { load_sequence(folder.write("y.yaml", text)); }),
              HasSubstr("talisman, extended"));
  CommandLine line;
  line.compositor = "fancy";
  const Sequence s = load_sequence("carousel");
  EXPECT_THAT(message_of([&] { resolve(line, s, true); }), HasSubstr("must be one of talisman, extended"));
}

}  // namespace
}  // namespace talisman::sequences
