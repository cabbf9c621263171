// SPDX-License-Identifier: Apache-2.0
#include "chunker/tile_lines.h"

#include "chunker/window.h"

namespace talisman::chunker {
namespace {

using layers::ivec2;

/// The pixels of a run, 0 … columns-1, that touch a sprite.
PixelRange touching_pixels(const TapMap& map, const TapPosition& start, ivec2 size, int columns) {
  const TapPosition end{start.x + (columns - 1) * map.step_x, start.y + (columns - 1) * map.step_y};
  if (touches(start, size) && touches(end, size)) return {0, columns};  // inside a sprite, nearly all
  const PixelRange x = pixels_touching(start.x, map.step_x, size.x, columns);
  const PixelRange y = pixels_touching(start.y, map.step_y, size.y, columns);
  return {std::max(x.first, y.first), std::min(x.last, y.last)};
}

LineJob line_job(const TapPosition& start, PixelRange pixels) {
  return {static_cast<std::uint32_t>(start.x), static_cast<std::uint32_t>(start.y), pixels};
}

/// Every pixel of the tile touches.
void whole_lines(const Visible& v, const Tile& tile, const TapBounds& bounds, AffineLines& lines) {
  for (int row = 0; row < tile.lines(); ++row)
    lines.job.lines[row] = line_job(*run_start(v.map, tile.x, tile.y + row), {0, tile.columns()});
  lines.pixel_count = static_cast<std::int64_t>(tile.lines()) * tile.columns();
  lines.line_count = tile.lines();
  lines.bounds = bounds;
}

/// Calls position(x, y) → optional<TapPosition> for every pixel.
template <typename Position>
void locate_pixels(const Tile& tile, PixelTaps& taps, const Position& position) {
  taps.at.fill({PixelTaps::kNothing, 0});
  for (int row = 0; row < tile.lines(); ++row) {
    const std::int64_t before = taps.pixel_count;
    for (int k = 0; k < tile.columns(); ++k) {
      const std::optional<TapPosition> p = position(row, k);
      if (!p) continue;
      taps.at[row * kRunPixels + k] = *p;
      taps.bounds.include(tap_texel(p->x), tap_texel(p->y));
      ++taps.pixel_count;
    }
    taps.line_count += taps.pixel_count > before;
  }
}

/// Is a sprite opaque in every texel that these pixels read?
bool hides(const Visible& v, const layers::RectI& pixels) {
  const auto reach = whole_tile_reach(v.map, v.sprite->size_px(), pixels);
  return reach && is_opaque(*v.sprite, reach->outer.texels());
}

}  // namespace

AffineLines affine_lines(const Visible& v, const Tile& tile) {
  AffineLines lines;
  lines.job.step_x = static_cast<std::uint32_t>(v.map.step_x);
  lines.job.step_y = static_cast<std::uint32_t>(v.map.step_y);
  lines.job.multiplier = v.multiplier;
  if (const auto reach = whole_tile_reach(v.map, v.sprite->size_px(), tile.rect())) {
    whole_lines(v, tile, reach->outer, lines);
    return lines;
  }
  const ivec2 size = v.sprite->size_px();
  for (int row = 0; row < tile.lines(); ++row) {
    const auto start = run_start(v.map, tile.x, tile.y + row);
    if (!start) continue;
    const PixelRange range = touching_pixels(v.map, *start, size, tile.columns());
    if (range.empty()) continue;
    lines.job.lines[row] = line_job(*start, range);
    lines.pixel_count += range.last - range.first;
    ++lines.line_count;
    for (const int k : {range.first, range.last - 1}) {
      lines.bounds.include(tap_texel(start->x + k * v.map.step_x), tap_texel(start->y + k * v.map.step_y));
    }
  }
  return lines;
}

std::int64_t leave_out(Strips strips, AffineLines& lines) {
  std::int64_t pixels = 0;
  for (int row = 0; row < kBandLines; ++row) {
    if (!has_strip_of(strips, row)) continue;
    PixelRange& range = lines.job.lines[row].pixels;
    pixels += std::max(range.last - range.first, 0);
    range = {};
  }
  return pixels;
}

void locate_perspective(const Visible& v, const Tile& tile, PixelTaps& taps) {
  const ivec2 size = v.sprite->size_px();
  locate_pixels(tile, taps,
                [&](int row, int k) { return perspective_tap(v.map, tile.x + k, tile.y + row, size); });
}

void locate_minified(const TileJob& job, const Tile& tile, PixelTaps& taps) {
  locate_pixels(tile, taps, [&](int row, int k) -> std::optional<TapPosition> {
    const LineJob& line = job.lines[row];
    if (k < line.pixels.first || k >= line.pixels.last) return std::nullopt;
    return TapPosition{static_cast<std::int32_t>(line.x + k * job.step_x),
                       static_cast<std::int32_t>(line.y + k * job.step_y)};
  });
}

std::int64_t leave_out(Strips strips, PixelTaps& taps) {
  std::int64_t pixels = 0;
  for (int row = 0; row < kBandLines; ++row) {
    if (!has_strip_of(strips, row)) continue;
    for (int k = 0; k < kRunPixels; ++k) {
      TapPosition& at = taps.at[row * kRunPixels + k];
      pixels += at.x != PixelTaps::kNothing;
      at.x = PixelTaps::kNothing;
    }
  }
  return pixels;
}

Strips strips_hidden_by(const Visible& v, const Tile& tile, Strips asked) {
  if (!v.multiplier.is_one()) return 0;
  if (hides(v, tile.rect())) return asked;
  Strips hidden = 0;
  for (int k = 0; k < kStrips; ++k) {
    if ((asked >> k & 1u) == 0) continue;
    const PixelRange lines = tile.strip(k);
    const layers::RectI pixels{tile.x, tile.y + lines.first, tile.x + tile.columns(), tile.y + lines.last};
    if (lines.empty() || hides(v, pixels)) hidden |= 1u << k;
  }
  return hidden;
}

}  // namespace talisman::chunker
