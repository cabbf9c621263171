// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/extended_composite.h"

#include <algorithm>
#include <utility>

#include "layers/check.h"

namespace talisman::sequences {

namespace {

using chunker::CompositeCounters;
using chunker::Frame;
using chunker::kOne;
using chunker::Linear16;
using layers::CompositeExpression;
using Operator = CompositeExpression::Operator;

/// round(v · m / kOne)
std::uint32_t scaled(std::uint32_t v, std::uint32_t m) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(v) * m + kOne / 2) / kOne);
}

/// A · of_a + B · of_b
Linear16 weighted_sum(const Linear16& a, std::uint32_t of_a, const Linear16& b, std::uint32_t of_b) {
  const auto channel = [&](std::uint16_t x, std::uint16_t y) {
    return static_cast<std::uint16_t>(std::min(scaled(x, of_a) + scaled(y, of_b), kOne));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b), channel(a.a, b.a)};
}

Linear16 combine_pixel(Operator op, const Linear16& a, const Linear16& b) {
  switch (op) {
    case Operator::Over:
      return weighted_sum(a, kOne, b, kOne - a.a);
    case Operator::Atop:
      return weighted_sum(a, b.a, b, kOne - a.a);
    case Operator::Out:
      return weighted_sum(a, kOne - b.a, b, 0);
    case Operator::Plus:
      return weighted_sum(a, kOne, b, kOne);
    case Operator::Layer:
      break;
  }
  TALISMAN_CHECK(op != Operator::Layer);
  return {};
}

Frame clear_frame(layers::ivec2 size) {
  Frame frame{size.x, size.y, {}};
  frame.pixels.resize(static_cast<std::size_t>(size.x) * size.y);
  return frame;
}

/// The picture of one expression over nothing. Every node is the operand of one other, so that a picture is
/// given up as soon as it was used.
Frame evaluate(const CompositeExpression& expression, std::span<const LayerSprite> sprites,
               layers::ivec2 size, CompositeCounters& counters) {
  std::vector<Frame> pictures;
  for (const CompositeExpression::Node& node : expression.nodes) {
    if (node.op != Operator::Layer) {
      const Frame left = std::exchange(pictures[node.left], {});
      const Frame right = std::exchange(pictures[node.right], {});
      pictures.push_back(combine(node.op, left, right));
      continue;
    }
    Frame read = clear_frame(size);
    for (const LayerSprite& sprite : sprites)
      if (sprite.layer == node.layer) counters += chunker::composite_onto(read, {&sprite.placed, 1});
    pictures.push_back(std::move(read));
  }
  return pictures.empty() ? clear_frame(size) : std::move(pictures.back());
}

}  // namespace

Frame combine(Operator op, const Frame& left, const Frame& right) {
  TALISMAN_CHECK_EQ(left.width, right.width);
  TALISMAN_CHECK_EQ(left.pixels.size(), right.pixels.size());
  Frame result{left.width, left.height, left.pixels};
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = combine_pixel(op, left.pixels[i], right.pixels[i]);
  return result;
}

chunker::CompositeResult composite_extended(std::span<const LayerSprite> sprites, const FrameOrder& order,
                                            layers::ivec2 display_px, layers::vec3 background) {
  chunker::CompositeResult result = chunker::composite({}, display_px, background);
  std::size_t next = 0;
  while (next < sprites.size()) {
    const ResolvedCycle* cycle = order.resolved_with(sprites[next].layer);
    const std::size_t first = next;
    while (next < sprites.size() && order.resolved_with(sprites[next].layer) == cycle) ++next;
    const std::span<const LayerSprite> run = sprites.subspan(first, next - first);
    if (cycle) {
      const Frame picture = evaluate(cycle->expression, run, display_px, result.counters);
      result.frame = combine(Operator::Over, picture, result.frame);
      continue;
    }
    std::vector<chunker::PlacedSprite> placed;
    for (const LayerSprite& sprite : run) placed.push_back(sprite.placed);
    result.counters += chunker::composite_onto(result.frame, placed);
  }
  return result;
}

}  // namespace talisman::sequences
