// SPDX-License-Identifier: Apache-2.0
#include "layers/visibility_expression.h"

#include <gtest/gtest.h>

#include "tests/layers/visibility_oracle.h"

namespace talisman::layers {
namespace {

using Operator = CompositeExpression::Operator;
using Status = CompositeExpression::Status;
using tests::Dice;

/// Premultiplied; one number stands for the colour.
struct Pixel {
  double color = 0, alpha = 0;
};

Pixel apply(Operator op, const Pixel& a, const Pixel& b) {
  const auto mix = [&](double fa, double fb) {
    return Pixel{fa * a.color + fb * b.color, fa * a.alpha + fb * b.alpha};
  };
  switch (op) {
    case Operator::Over:
      return mix(1, 1 - a.alpha);
    case Operator::Atop:
      return mix(b.alpha, 1 - a.alpha);
    case Operator::Out:
      return mix(1 - b.alpha, 0);
    case Operator::Plus:
      return mix(1, 1);
    case Operator::Layer:
      break;
  }
  return {};
}

Pixel evaluate(const CompositeExpression& expression, const std::vector<Pixel>& layers) {
  std::vector<Pixel> values;
  for (const auto& n : expression.nodes)
    values.push_back(n.op == Operator::Layer ? layers[n.layer]
                                             : apply(n.op, values[n.left], values[n.right]));
  return values.empty() ? Pixel{} : values.back();
}

/// A tilted disc, or a piece of it, seen from z = +∞: what it covers, and how high it is there.
struct Disc {
  dvec2 centre{0, 0};
  double radius = 1, height = 0;
  dvec2 slope{0, 0};
  dvec2 across{0, 0};  ///< unit: only what is within 0.1 of the diameter across it, a stick; 0: the disc
  bool covers(const dvec2& p) const {
    return glm::length(p - centre) < radius && std::fabs(glm::dot(p - centre, across)) < 0.1;
  }
  double depth(const dvec2& p) const { return height + glm::dot(slope, p - centre); }
};

std::vector<dvec2> pixels() {
  std::vector<dvec2> all;
  for (int y = -40; y <= 40; ++y)
    for (int x = -40; x <= 40; ++x) all.push_back({x / 10.0, y / 10.0});
  return all;
}

/// The relations that the pixels show.
MergedComponent component_of(const std::vector<Disc>& discs) {
  MergedComponent c;
  for (int a = 0; a < static_cast<int>(discs.size()); ++a) c.layers.push_back(a);
  for (const int a : c.layers)
    for (const int b : c.layers)
      for (const dvec2& p : pixels())
        if (a != b && discs[a].covers(p) && discs[b].covers(p) && discs[a].depth(p) < discs[b].depth(p)) {
          c.relations.push_back({a, b});
          break;
        }
  return c;
}

/// Composited in the order of depth of this pixel.
Pixel truth(const std::vector<Disc>& discs, const dvec2& p, const std::vector<Pixel>& colors) {
  std::vector<int> line;
  for (int i = 0; i < static_cast<int>(discs.size()); ++i)
    if (discs[i].covers(p)) line.push_back(i);
  std::sort(line.begin(), line.end(), [&](int a, int b) { return discs[a].depth(p) < discs[b].depth(p); });
  Pixel result;
  for (const int i : line) result = apply(Operator::Over, colors[i], result);
  return result;
}

void expect_truth(const std::vector<Disc>& discs, const CompositeExpression& expression, double alpha) {
  std::vector<Pixel> colors;
  for (std::size_t i = 0; i < discs.size(); ++i) colors.push_back({(1.0 + i) * alpha, alpha});
  for (const dvec2& p : pixels()) {
    std::vector<Pixel> here = colors;
    for (std::size_t i = 0; i < discs.size(); ++i)
      if (!discs[i].covers(p)) here[i] = {};
    const Pixel expected = truth(discs, p, colors), got = evaluate(expression, here);
    ASSERT_NEAR(got.color, expected.color, 1e-9) << "at " << p.x << ", " << p.y;
    ASSERT_NEAR(got.alpha, expected.alpha, 1e-9);
  }
}

/// Discs on a circle, each high where it meets the next and low where it meets the one before.
std::vector<Disc> wheel(int count) {
  std::vector<Disc> discs;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const dvec2 out{std::cos(angle), std::sin(angle)}, along{-out.y, out.x};
    discs.push_back({out * 2.0, 2.0 * std::sin(M_PI / count) * 1.15, 0, along});
  }
  return discs;
}

TEST(OcclusionExpression, WheelsAreResolvedInBothForms) {
  for (const int count : {3, 4, 7, 12}) {
    const auto discs = wheel(count);
    const MergedComponent c = component_of(discs);
    ASSERT_EQ(static_cast<int>(c.relations.size()), count) << "each is behind the one before, and no other";
    for (const ExpressionForm form : {ExpressionForm::Out, ExpressionForm::Atop}) {
      const CompositeExpression e = occlusion_expression(c, form);
      ASSERT_EQ(e.status, Status::Resolved);
      EXPECT_EQ(e.registers, 2);
      expect_truth(discs, e, 1);
    }
    EXPECT_EQ(occlusion_expression(c, ExpressionForm::Atop).reads, count + 1) << "one layer is read twice";
    EXPECT_EQ(occlusion_expression(c, ExpressionForm::Out).reads, 2 * count);
  }
}

// Where a layer lets shine through what is behind it, Out stays right; Atop does not, as its header says.
TEST(OcclusionExpression, OutIsRightForTranslucentLayers) {
  const auto discs = wheel(5);
  expect_truth(discs, occlusion_expression(component_of(discs)), 0.4);
}

TEST(OcclusionExpression, OrderlyLayersNeedOnlyOver) {
  const MergedComponent c{.layers = {0, 1, 2}, .cycle = {}, .relations = {{2, 1}, {1, 0}, {2, 0}}};
  const CompositeExpression e = occlusion_expression(c, ExpressionForm::Atop);
  EXPECT_EQ(to_string(e), "0 over (1 over 2)");
  EXPECT_EQ(e.registers, 1);
}

TEST(OcclusionExpression, TriangleOfLayersInWords) {
  const MergedComponent c{.layers = {0, 1, 2}, .cycle = {}, .relations = {{0, 1}, {1, 2}, {2, 0}}};
  EXPECT_EQ(to_string(occlusion_expression(c, ExpressionForm::Atop)), "(0 atop 2) over (1 over 0)");
  EXPECT_EQ(to_string(occlusion_expression(c)), "((0 out 1) plus (1 out 2)) plus (2 out 0)");
}

TEST(OcclusionExpression, BinaryCyclesHaveNone) {
  const MergedComponent c{.layers = {3, 5}, .cycle = {}, .relations = {{3, 5}, {5, 3}}};
  const CompositeExpression e = occlusion_expression(c);
  EXPECT_EQ(e.status, Status::BinaryCycle);
  EXPECT_TRUE(e.nodes.empty());
  EXPECT_EQ(to_string(e), "");
}

TEST(OcclusionExpression, NothingIsNothing) {
  EXPECT_EQ(occlusion_expression({}).registers, 0);
  EXPECT_TRUE(occlusion_expression({}, ExpressionForm::Atop).nodes.empty());
}

// Sticks thrown upon each other: few pairs interpenetrate, many go round, also in cycles within cycles.
TEST(OcclusionExpression, RandomSticksAgreeWithDepthPerPixel) {
  Dice dice(23);
  int cyclic = 0;
  for (int k = 0; k < 100; ++k) {
    std::vector<Disc> sticks;
    for (int i = 0; i < 5; ++i) {
      const double turn = dice.uniform(0, 2 * M_PI), tilt = dice.uniform(-1.5, 1.5);
      const dvec2 along{std::cos(turn), std::sin(turn)}, across{-along.y, along.x};
      sticks.push_back({dvec2(dice.in_cube(1)), 2.5, dice.uniform(-0.3, 0.3), along * tilt, across});
    }
    const MergedComponent c = component_of(sticks);
    const CompositeExpression out = occlusion_expression(c),
                              atop = occlusion_expression(c, ExpressionForm::Atop);
    ASSERT_EQ(out.status, atop.status);
    if (out.status != Status::Resolved) continue;
    cyclic += std::any_of(atop.nodes.begin(), atop.nodes.end(),
                          [](const auto& n) { return n.op == Operator::Atop; });
    expect_truth(sticks, out, 1);
    expect_truth(sticks, atop, 1);
    if (testing::Test::HasFatalFailure()) FAIL() << "scene " << k;
  }
  EXPECT_GT(cyclic, 5);
}

// All of a tournament in which i is behind the next half of the others: cycles within cycles, and no picture
// at all that could show them, but the expression has to end.
TEST(OcclusionExpression, NestedCyclesEndOrAreTooLarge) {
  for (const int count : {5, 9, 61}) {
    MergedComponent c;
    for (int i = 0; i < count; ++i) {
      c.layers.push_back(i);
      for (int k = 1; k <= count / 2; ++k) c.relations.push_back({i, (i + k) % count});
    }
    const CompositeExpression e = occlusion_expression(c, ExpressionForm::Atop);
    EXPECT_LE(e.nodes.size(), static_cast<std::size_t>(kLargestExpression));
    EXPECT_EQ(e.nodes.empty(), e.status == Status::TooLarge);
    const CompositeExpression out = occlusion_expression(c);
    EXPECT_EQ(out.status, Status::Resolved);
    EXPECT_EQ(out.reads, count + count * (count / 2));
  }
}

}  // namespace
}  // namespace talisman::layers
