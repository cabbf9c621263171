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

// --- Surfaces with their shadows in a register ---

Frame white_frame(layers::ivec2 size) {
  constexpr auto kFull = static_cast<std::uint16_t>(kOne);
  Frame frame{size.x, size.y, {}};
  frame.pixels.assign(static_cast<std::size_t>(size.x) * size.y, Linear16{kFull, kFull, kFull, kFull});
  return frame;
}

/// R ← s * R
void multiply(const Frame& left, Frame& picture) {
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const Linear16& s = left.pixels[i];
    Linear16& c = picture.pixels[i];
    const auto channel = [](std::uint16_t v, std::uint16_t m) {
      return static_cast<std::uint16_t>(scaled(v, m));
    };
    c = {channel(c.r, s.r), channel(c.g, s.g), channel(c.b, s.b), c.a};
  }
}

/// The end of the sprites that lie on the surface `first`, itself included; `first` where none of them needs a
/// register.
std::size_t end_of_surface(std::span<const LayerSprite> sprites, std::size_t first) {
  if (sprites[first].base >= 0) return first;
  bool needs_register = false;
  std::size_t end = first + 1;
  for (; end < sprites.size() && sprites[end].base == sprites[first].layer; ++end)
    needs_register = needs_register || sprites[end].use != Use::Over;
  return needs_register ? end : first;
}

/// The picture of one surface over nothing.
Frame put_together(std::span<const LayerSprite> sprites, layers::ivec2 size, CompositeCounters& counters) {
  Frame picture = clear_frame(size);
  for (const LayerSprite& sprite : sprites) {
    if (sprite.use == Use::Over) {
      counters += chunker::composite_onto(picture, {&sprite.placed, 1});
      continue;
    }
    Frame read = sprite.use == Use::Multiply ? white_frame(size) : clear_frame(size);
    counters += chunker::composite_onto(read, {&sprite.placed, 1});
    if (sprite.use == Use::Multiply)
      multiply(read, picture);
    else
      picture = combine(Operator::Atop, read, picture);
  }
  return picture;
}

}  // namespace

Use use_of(const layers::Layer& layer) {
  if (layer.kind != layers::LayerKind::Shadow) return Use::Over;
  if (layer.shadows_as == layers::ShadowsAs::Multiply) return Use::Multiply;
  return layer.shadows_as == layers::ShadowsAs::Atop ? Use::Atop : Use::Over;
}

bool any_registers(const LayerTable& layers) {
  return std::any_of(layers.begin(), layers.end(),
                     [](const layers::Layer& layer) { return use_of(layer) != Use::Over; });
}

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
    if (const std::size_t end = end_of_surface(sprites, first); end > first) {
      const Frame picture = put_together(sprites.subspan(first, end - first), display_px, result.counters);
      result.frame = combine(Operator::Over, picture, result.frame);
      next = end;
      continue;
    }
    do {
      ++next;
    } while (next < sprites.size() && order.resolved_with(sprites[next].layer) == cycle &&
             end_of_surface(sprites, next) == next);
    const std::span<const LayerSprite> run = sprites.subspan(first, next - first);
    if (cycle) {
      const Frame picture = evaluate(cycle->expression, run, display_px, result.counters);
      result.frame = combine(Operator::Over, picture, result.frame);
      continue;
    }
    std::vector<chunker::PlacedSprite> placed;
    for (const LayerSprite& sprite : run)
      if (sprite.use == Use::Over) placed.push_back(sprite.placed);  // else its surface is not shown
    result.counters += chunker::composite_onto(result.frame, placed);
  }
  return result;
}

}  // namespace talisman::sequences
