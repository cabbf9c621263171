// SPDX-License-Identifier: Apache-2.0
#include "chunker/composite.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "chunker/blend_constants.h"
#include "chunker/job_order.h"
#include "chunker/late_chunks.h"
#include "chunker/lattice.h"
#include "chunker/sampling.h"
#include "chunker/span_composite.h"
#include "chunker/tile_lines.h"
#include "chunker/tile_reach.h"
#include "chunker/window.h"
#include "layers/check.h"

namespace talisman::chunker {
namespace {

using layers::ivec2;
using layers::RectI;

static_assert(kRunPixels == kBandLines, "tiles are square");
static_assert(sizeof(Linear16) == sizeof(PackedPixel));

bool has_chunks_to_draw(const Sprite& sprite) {
  return sprite.late_chunks() != nullptr && !sprite.late_chunks()->all_drawn();
}

/// columns_touched() with the axes of the display exchanged.
PixelRange lines_touched(const TapMap& map, ivec2 size, ivec2 display) {
  const auto exchanged = [](const layers::dvec3& row) { return layers::dvec3(row.y, row.x, row.z); };
  TapMap turned;
  turned.x = exchanged(map.x);
  turned.y = exchanged(map.y);
  turned.w = exchanged(map.w);
  return columns_touched(turned, size, display.y, 0, display.x - 1);
}

std::vector<Visible> visible_sprites(std::span<const PlacedSprite> sprites, ivec2 display) {
  std::vector<Visible> visible;
  for (const PlacedSprite& placed : sprites) {
    TALISMAN_CHECK(placed.sprite != nullptr);
    const ivec2 size = placed.sprite->size_px();
    TALISMAN_CHECK_LE(std::max(size.x, size.y), kMaxSpriteSide);
    const auto map = tap_map(placed.screen_from_sprite);
    const Multiplier multiplier = fixed_multiplier(placed.color_multiplier, placed.alpha_multiplier);
    if (size.x <= 0 || size.y <= 0 || !map || multiplier.is_zero()) continue;
    const PixelRange lines = lines_touched(*map, size, display);
    if (!lines.empty()) visible.push_back({placed.sprite, *map, multiplier, lines, lattice_origin(*map)});
  }
  return visible;
}

std::uint64_t texel_pair(Texel left, Texel right) {
  const Texel pair[2] = {left, right};
  std::uint64_t packed;
  std::memcpy(&packed, pair, sizeof packed);
  return packed;
}

/// Also pixels that show nothing need weights that add up to one.
Footprints clear_footprints() {
  Footprints f{};
  std::fill_n(f.weight_x, kRunPixels, weight_pair(0));
  std::fill_n(f.weight_y, kRunPixels, weight_pair(0));
  return f;
}

/// Two texel rows under a footprint, from a window or straight from the chunks.
struct WindowSource {
  const Window& window;
  std::uint64_t pair(int x, int y) const {
    const Texel* at = window.texels() + (y - window.origin().y) * window.stride() + (x - window.origin().x);
    return texel_pair(at[0], at[1]);
  }
};
struct SpriteSource {
  const Sprite& sprite;
  std::uint64_t pair(int x, int y) const { return texel_pair(sprite.texel(x, y), sprite.texel(x + 1, y)); }
};

template <typename Source>
void blend_pixels(const Source& source, const PixelTaps& taps, const Multiplier& multiplier,
                  const Tile& tile) {
  const Footprints nothing = clear_footprints();
  for (int row = 0; row < tile.lines(); ++row) {
    Footprints f = nothing;
    for (int k = 0; k < kRunPixels; ++k) {
      const TapPosition p = taps.at[row * kRunPixels + k];
      if (p.x == PixelTaps::kNothing) continue;
      f.top[k] = source.pair(tap_texel(p.x), tap_texel(p.y));
      f.bottom[k] = source.pair(tap_texel(p.x), tap_texel(p.y) + 1);
      f.weight_x[k] = weight_pair(tap_weight(p.x));
      f.weight_y[k] = weight_pair(tap_weight(p.y));
    }
    blend_run(f, multiplier, tile.pixels + row * kRunPixels);
  }
}

/// Composites one band; its buffers are used again by every tile.
class BandCompositor {
 public:
  /// Without a background the sprites are laid over what `frame` shows.
  BandCompositor(std::span<const Visible> sprites, std::optional<PackedPixel> background, Frame& frame)
      : sprites_(sprites), background_(background), frame_(frame) {}

  CompositeCounters run(int band) {
    collect(band);
    Tile tile{0, band * kBandLines, {frame_.width, frame_.height}, tile_.data()};
    for (; tile.x < frame_.width; tile.x += kRunPixels) {
      begin(tile);
      const auto bottom = lowest_shown(tile);
      for (std::size_t i = 0; i < touching_.size(); ++i) {
        if (touching_[i].may_touch(tile)) lay(touching_[i], tile, hidden_strips(bottom, i));
      }
      keep(tile);
    }
    for (const Touching& touching : touching_) counters_.sprite_bands += touching.seen;
    return counters_;
  }

  /// Reads the late chunks that run() would read, and nothing else.
  void read_late(int band) {
    collect(band);
    Tile tile{0, band * kBandLines, {frame_.width, frame_.height}, nullptr};
    for (; tile.x < frame_.width; tile.x += kRunPixels) {
      const auto bottom = lowest_shown(tile);
      for (std::size_t i = *std::min_element(bottom.begin(), bottom.end()); i < touching_.size(); ++i)
        if (touching_[i].may_touch(tile)) read_late(*touching_[i].visible, tile);
    }
  }

 private:
  struct Touching {
    const Visible* visible;
    PixelRange columns;
    bool seen = false;
    bool may_touch(const Tile& tile) const {
      return tile.x + kRunPixels > columns.first && tile.x < columns.last;
    }
    bool may_hide(const Tile& tile) const {
      return tile.x >= columns.first && tile.x + tile.columns() <= columns.last;
    }
  };

  void collect(int band) {
    const int first_line = band * kBandLines,
              last_line = std::min(first_line + kBandLines, frame_.height) - 1;
    for (const Visible& v : sprites_) {
      if (v.lines.last <= first_line || v.lines.first > last_line) continue;
      const PixelRange columns =
          columns_touched(v.map, v.sprite->size_px(), frame_.width, first_line, last_line);
      if (!columns.empty()) touching_.push_back({&v, columns});
    }
  }

  /// By strip, the topmost sprite that hides those below it; 0 where none does.
  std::array<std::size_t, kStrips> lowest_shown(const Tile& tile) const {
    std::array<std::size_t, kStrips> bottom{};
    Strips open = kAllStrips;
    for (std::size_t i = touching_.size(); i-- > 0 && open != 0;) {
      if (!touching_[i].may_hide(tile)) continue;
      const Strips hidden = strips_hidden_by(*touching_[i].visible, tile, open);
      for (int k = 0; k < kStrips; ++k)
        if ((hidden >> k & 1u) != 0) bottom[k] = i;
      open &= ~hidden;
    }
    return bottom;
  }

  static Strips hidden_strips(const std::array<std::size_t, kStrips>& bottom, std::size_t sprite) {
    Strips hidden = 0;
    for (int k = 0; k < kStrips; ++k) hidden |= static_cast<Strips>(sprite < bottom[k]) << k;
    return hidden;
  }

  static void read_late(const Visible& v, const Tile& tile) {
    if (!has_chunks_to_draw(*v.sprite)) return;
    TapBounds bounds;
    if (v.map.perspective) {
      PixelTaps taps;
      locate_perspective(v, tile, taps);
      bounds = taps.bounds;
    } else {
      bounds = affine_lines(v, tile).bounds;
    }
    if (bounds.rect.empty() || is_clear(*v.sprite, bounds.texels())) return;
    // As Window::gather: with the row and column after.
    for (int row = chunk_of(bounds.rect.y0); row <= chunk_of(bounds.rect.y1); ++row)
      for (int column = chunk_of(bounds.rect.x0); column <= chunk_of(bounds.rect.x1); ++column)
        chunk_or_clear(*v.sprite, column, row);
  }

  void lay(Touching& touching, const Tile& tile, Strips hidden) {
    const std::int64_t before = counters_.pixels_composited;
    const Visible& v = *touching.visible;
    if (hidden == kAllStrips)
      count_hidden(v, tile);
    else if (v.lattice)
      lay_whole_texels(v, tile, hidden);
    else
      v.map.perspective ? lay_perspective(v, tile, hidden) : lay_affine(v, tile, hidden);
    touching.seen |= counters_.pixels_composited > before;
  }

  /// Counts a sprite as if it were drawn.
  void count_hidden(const Visible& v, const Tile& tile) {
    if (v.lattice)
      return count_hidden(lattice_reach(*v.lattice, v.sprite->size_px(), tile.rect()), *v.sprite);
    if (const auto reach = whole_tile_reach(v.map, v.sprite->size_px(), tile.rect())) {
      const bool clear = is_clear(*v.sprite, reach->outer.texels());
      if (clear || !v.map.perspective || !is_clear(*v.sprite, reach->inner.texels())) {
        const std::int64_t lines = tile.lines();
        return count_hidden(Counted{lines * tile.columns(), lines, reach->outer}, *v.sprite);
      }
    }
    if (!v.map.perspective) return count_hidden(affine_lines(v, tile), *v.sprite);
    PixelTaps taps;
    locate_perspective(v, tile, taps);
    count_hidden(taps, *v.sprite);
  }

  /// What a tile shows, without where.
  struct Counted {
    std::int64_t pixel_count, line_count;
    TapBounds bounds;
  };
  template <typename Positions>
  void count_hidden(const Positions& positions, const Sprite& sprite) {
    if (count(positions, sprite)) counters_.pixels_hidden += positions.pixel_count;
  }

  /// Counts what a tile shows; false when there is nothing to draw.
  template <typename Positions>
  bool count(const Positions& positions, const Sprite& sprite) {
    counters_.pixels_composited += positions.pixel_count;
    if (positions.pixel_count == 0) return false;
    if (!is_clear(sprite, positions.bounds.texels())) return true;
    counters_.chunks_skipped_clear += positions.line_count;
    return false;
  }

  /// Counts the pixels of strips that are hidden, and leaves them out; true where that is all of them.
  template <typename Positions>
  bool leave_out_all(Strips hidden, Positions& positions) {
    if (hidden == 0) return false;
    const std::int64_t left_out = leave_out(hidden, positions);
    counters_.pixels_hidden += left_out;
    return left_out == positions.pixel_count;
  }

  void lay_whole_texels(const Visible& v, const Tile& tile, Strips hidden) {
    const LatticeReach reach = lattice_reach(*v.lattice, v.sprite->size_px(), tile.rect());
    if (!count(reach, *v.sprite)) return;
    LatticeJob job = lattice_job(*v.sprite, *v.lattice, {tile.x, tile.y}, reach.pixels, v.multiplier);
    const PixelRange all = job.lines;
    for (int k = 0; k < kStrips; ++k) {
      const PixelRange strip = tile.strip(k);
      job.lines = {std::max(all.first, strip.first), std::min(all.last, strip.last)};
      if (job.lines.empty()) continue;
      if ((hidden >> k & 1u) != 0)
        counters_.pixels_hidden += std::int64_t{job.lines.last - job.lines.first} * reach.pixels.width();
      else
        blend_lattice(job, tile.pixels);
    }
  }

  void lay_affine(const Visible& v, const Tile& tile, Strips hidden) {
    AffineLines lines = affine_lines(v, tile);
    if (!count(lines, *v.sprite)) return;
    if (leave_out_all(hidden, lines)) return;
    if (!window_.gather(*v.sprite, lines.bounds.rect)) {
      PixelTaps taps;
      locate_minified(lines.job, tile, taps);
      return blend_pixels(SpriteSource{*v.sprite}, taps, v.multiplier, tile);
    }
    lines.job.window = window_.texels();
    lines.job.stride = static_cast<std::uint32_t>(window_.stride());
    lines.job.origin_x = static_cast<std::uint32_t>(window_.origin().x) << 16;
    lines.job.origin_y = static_cast<std::uint32_t>(window_.origin().y) << 16;
    blend_tile(lines.job, tile.pixels);
  }

  void lay_perspective(const Visible& v, const Tile& tile, Strips hidden) {
    PixelTaps taps;
    locate_perspective(v, tile, taps);
    if (!count(taps, *v.sprite)) return;
    if (leave_out_all(hidden, taps)) return;
    if (window_.gather(*v.sprite, taps.bounds.rect)) {
      blend_pixels(WindowSource{window_}, taps, v.multiplier, tile);
    } else {
      blend_pixels(SpriteSource{*v.sprite}, taps, v.multiplier, tile);
    }
  }

  Linear16* line_of_frame(const Tile& tile, int row) {
    return frame_.pixels.data() + static_cast<std::size_t>(tile.y + row) * frame_.width + tile.x;
  }

  void begin(const Tile& tile) {
    tile_.fill(background_.value_or(0));
    if (background_) return;
    for (int row = 0; row < tile.lines(); ++row)
      std::memcpy(tile.pixels + row * kRunPixels, line_of_frame(tile, row),
                  tile.columns() * sizeof(Linear16));
  }

  void keep(const Tile& tile) {
    for (int row = 0; row < tile.lines(); ++row)
      std::memcpy(static_cast<void*>(line_of_frame(tile, row)), tile.pixels + row * kRunPixels,
                  tile.columns() * sizeof(Linear16));
  }

  std::span<const Visible> sprites_;
  std::optional<PackedPixel> background_;
  Frame& frame_;
  std::vector<Touching> touching_;
  CompositeCounters counters_;
  Window window_;
  alignas(64) std::array<PackedPixel, kBandLines * kRunPixels> tile_;
};

int bands_of(const Frame& frame) { return (frame.height + kBandLines - 1) / kBandLines; }

/// Calls use(band's number, its compositor) for all bands of `frame`.
template <typename Use>
void for_each_band(Frame& frame, std::span<const PlacedSprite> sprites, std::optional<PackedPixel> background,
                   const Use& use) {
  const std::vector<Visible> visible = visible_sprites(sprites, {frame.width, frame.height});
  const int bands = bands_of(frame);
  const JobOrder order(static_cast<std::size_t>(bands));
  tbb::parallel_for(tbb::blocked_range<int>(0, bands, 1), [&](const tbb::blocked_range<int>& range) {
    for (int job = range.begin(); job != range.end(); ++job)
      use(static_cast<int>(order[job]), *std::make_unique<BandCompositor>(visible, background, frame));
  });
}

/// All bands of `frame`, whose pixels are there.
CompositeCounters composite_bands(Frame& frame, std::span<const PlacedSprite> sprites,
                                  std::optional<PackedPixel> background) {
  std::vector<CompositeCounters> counters(bands_of(frame));
  for_each_band(frame, sprites, background,
                [&](int band, BandCompositor& compositor) { counters[band] = compositor.run(band); });
  CompositeCounters sum;
  for (const CompositeCounters& c : counters) sum += c;
  return sum;
}

}  // namespace

CompositeCounters& CompositeCounters::operator+=(const CompositeCounters& o) {
  sprite_bands += o.sprite_bands;
  pixels_composited += o.pixels_composited;
  pixels_hidden += o.pixels_hidden;
  chunks_skipped_clear += o.chunks_skipped_clear;
  return *this;
}

CompositeCounters composite_into(Frame& frame, std::span<const PlacedSprite> sprites, ivec2 display_px,
                                 layers::vec3 background) {
  TALISMAN_CHECK_GE(display_px.x, 0);
  TALISMAN_CHECK_GE(display_px.y, 0);
  const Linear16 below = fixed_background(background);
  PackedPixel packed_background;
  std::memcpy(&packed_background, &below, sizeof below);

  frame.width = display_px.x;
  frame.height = display_px.y;
  frame.pixels.resize(static_cast<std::size_t>(display_px.x) * display_px.y);
  return composite_bands(frame, sprites, packed_background);
}

CompositeCounters composite_onto(Frame& frame, std::span<const PlacedSprite> sprites) {
  TALISMAN_CHECK_EQ(frame.pixels.size(), static_cast<std::size_t>(frame.width) * frame.height);
  return composite_bands(frame, sprites, std::nullopt);
}

void draw_late_chunks(std::span<const PlacedSprite> sprites, ivec2 display_px) {
  if (std::none_of(sprites.begin(), sprites.end(),
                   [](const PlacedSprite& placed) { return has_chunks_to_draw(*placed.sprite); }))
    return;
  Frame frame{display_px.x, display_px.y, {}};
  for_each_band(frame, sprites, std::nullopt,
                [](int band, BandCompositor& compositor) { compositor.read_late(band); });
}

CompositeResult composite(std::span<const PlacedSprite> sprites, ivec2 display_px, layers::vec3 background) {
  CompositeResult result;
  result.counters = composite_into(result.frame, sprites, display_px, background);
  return result;
}

std::vector<std::uint8_t> srgb_bytes(const Frame& frame) {
  static const auto table = [] {
    std::array<std::uint8_t, kOne + 1> t{};
    for (std::uint32_t v = 0; v <= kOne; ++v) t[v] = srgb_from_linear16(static_cast<std::uint16_t>(v));
    return t;
  }();
  std::vector<std::uint8_t> bytes;
  bytes.reserve(frame.pixels.size() * 3);
  const auto encode = [](std::uint16_t v) { return table[std::min<std::uint32_t>(v, kOne)]; };
  for (const Linear16& p : frame.pixels) bytes.insert(bytes.end(), {encode(p.r), encode(p.g), encode(p.b)});
  return bytes;
}

}  // namespace talisman::chunker
