// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/overlay.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>

#include "layers/check.h"
#include "sequences/pictures/box_placement.h"
#include "sequences/pictures/image_drawing.h"

namespace talisman::sequences {
namespace {

using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::ivec2;
using layers::RectI;

constexpr int kLargePx = 600;      // from this size on pictures have the larger letters
constexpr double kMarginPx = 2;    // lines just outside still reach in
constexpr int kLabelMarginPx = 3;  // of the letters in their box
constexpr int kLabelGapPx = 2;     // between labels
constexpr Rgb kLabelGround{12, 12, 16};

struct Segment {
  dvec2 a, b;
};

/// The part of the homogeneous edge a…b that is in front (w > 0) and inside the picture and its margin, in
/// pixels.
std::optional<Segment> visible_part(const dvec3& a, const dvec3& b, int width, int height) {
  // Each plane is a linear function that is positive inside; along the edge it is linear in t.
  const auto planes = [&](const dvec3& p) {
    return std::array<double, 5>{p.z, p.x + kMarginPx * p.z, (width + kMarginPx) * p.z - p.x,
                                 p.y + kMarginPx * p.z, (height + kMarginPx) * p.z - p.y};
  };
  const auto at_a = planes(a), at_b = planes(b);
  double t0 = 0, t1 = 1;
  for (std::size_t i = 0; i < at_a.size(); ++i) {
    if (!std::isfinite(at_a[i]) || !std::isfinite(at_b[i]) || (at_a[i] <= 0 && at_b[i] <= 0))
      return std::nullopt;
    const double crossing = at_a[i] / (at_a[i] - at_b[i]);
    if (at_a[i] < 0) t0 = std::max(t0, crossing);
    if (at_b[i] < 0) t1 = std::min(t1, crossing);
  }
  if (!(t0 <= t1)) return std::nullopt;
  const auto point = [&](double t) {
    const double w = a.z * (1 - t) + b.z * t;
    return dvec2{(a.x * (1 - t) + b.x * t) / w, (a.y * (1 - t) + b.y * t) / w};
  };
  Segment s{point(t0), point(t1)};
  if (!std::isfinite(s.a.x + s.a.y + s.b.x + s.b.y)) return std::nullopt;  // w = 0 at an end
  // Rounding at nearly vanishing w may leave the margin by more than the clip allows.
  for (dvec2* p : {&s.a, &s.b}) {
    p->x = std::clamp(p->x, -kMarginPx, width + kMarginPx);
    p->y = std::clamp(p->y, -kMarginPx, height + kMarginPx);
  }
  return s;
}

std::array<dvec3, 4> corners_of(const Outline& o) {
  const double w = o.size_px.x, h = o.size_px.y;
  const dmat3& m = o.screen_from_sprite;
  return {m * dvec3(0, 0, 1), m * dvec3(w, 0, 1), m * dvec3(w, h, 1), m * dvec3(0, h, 1)};
}

std::vector<Segment> visible_edges(const Outline& outline, int width, int height) {
  std::vector<Segment> edges;
  const auto corners = corners_of(outline);
  for (int i = 0; i < 4; ++i)
    if (const auto s = visible_part(corners[i], corners[(i + 1) % 4], width, height)) edges.push_back(*s);
  return edges;
}

/// What of the sprite is in view: its corners clipped to the picture and to denominators above 0.
std::vector<dvec2> visible_corners(const Outline& outline, int width, int height) {
  const auto sprite = corners_of(outline);
  std::vector<dvec3> polygon(sprite.begin(), sprite.end());
  const dvec3 planes[] = {{0, 0, 1}, {1, 0, 0}, {-1, 0, double(width)}, {0, 1, 0}, {0, -1, double(height)}};
  for (const dvec3& plane : planes) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double at_a = glm::dot(plane, a), at_b = glm::dot(plane, b);
      if (at_a >= 0) kept.push_back(a);
      if ((at_a < 0) != (at_b < 0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    polygon = std::move(kept);
  }
  std::vector<dvec2> corners;
  for (const dvec3& p : polygon)
    if (const dvec2 c{p.x / p.z, p.y / p.z}; std::isfinite(c.x + c.y)) corners.push_back(c);
  return corners;
}

/// Where the label belongs: of what is in view that which lies highest, and left. It moves as the sprite does,
/// also where a corner leaves the picture; level edges, the most frequent, have their left end for sure.
std::optional<dvec2> label_anchor(const Outline& outline, int width, int height) {
  const auto height_of = [](dvec2 p) { return p.y + 0.3 * p.x; };
  std::optional<dvec2> anchor;
  for (const dvec2& p : visible_corners(outline, width, height))
    if (!anchor || height_of(p) < height_of(*anchor)) anchor = p;
  return anchor;
}

int letters_of(const Image8& image) { return std::min(image.width, image.height) >= kLargePx ? 2 : 1; }

// --- Labels

/// With a gap to the right and below, so that neighbours can be told apart.
ivec2 label_size(const std::string& text, int scale) {
  const ivec2 letters = text_size(text, scale);
  return {letters.x + 2 * kLabelMarginPx + kLabelGapPx, letters.y + kLabelMarginPx + kLabelGapPx};
}

void draw_label(Image8& image, const std::string& text, const RectI& box, Rgb color, int scale) {
  tint(image, {box.x0, box.y0, box.width() - kLabelGapPx, box.height() - kLabelGapPx}, kLabelGround, 0.75);
  draw_text(image, text, {box.x0 + kLabelMarginPx, box.y0 + kLabelMarginPx}, color, scale);
}

/// Where there is no room: at its place, over others; from its beginning, if it is wider than the picture.
RectI crowded_place(dvec2 at, ivec2 size, const Image8& image) {
  const auto inside = [](double wish, int length, int all) {
    return static_cast<int>(std::clamp(wish, 0.0, std::max(double(all - length), 0.0)));
  };
  const ivec2 p{inside(at.x, size.x, image.width), inside(at.y, size.y, image.height)};
  return {p.x, p.y, p.x + size.x, p.y + size.y};
}

void draw_labels(Image8& image, const std::vector<Outline>& outlines, int oldest_frames,
                 const std::vector<RectI>& kept_free) {
  const int scale = letters_of(image);
  std::vector<std::size_t> order(outlines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return outlines[a].rank < outlines[b].rank; });
  std::vector<BoxWish> wishes;
  std::vector<const Outline*> labelled;
  for (const std::size_t i : order) {
    const auto anchor = label_anchor(outlines[i], image.width, image.height);
    if (outlines[i].label.empty() || !anchor) continue;
    constexpr double kBesideTheLine_px = 2;
    wishes.push_back(
        {label_size(outlines[i].label, scale),
         {{std::floor(anchor->x) + kBesideTheLine_px, std::floor(anchor->y) + kBesideTheLine_px}}});
    labelled.push_back(&outlines[i]);
  }
  const auto places = place_boxes({0, 0, image.width, image.height}, kept_free, wishes);
  for (std::size_t i = 0; i < places.size(); ++i)
    draw_label(image, labelled[i]->label,
               places[i].value_or(crowded_place(wishes[i].at[0], wishes[i].size_px, image)),
               age_color(labelled[i]->age_frames, oldest_frames), scale);
}

// --- The legend

constexpr int kBarPx = 60;  ///< of the colours of all ages

/// What the two lines of the legend say: of the boxes; of the colours, with a gap for each sign.
constexpr const char* kBoxWords = "box: a sprite, carried by its warp";
constexpr const char* kFreshWords = "drawn now";
std::string old_words(int oldest_frames) { return "1 ... " + std::to_string(oldest_frames) + "+ frames ago"; }

struct LegendSizes {
  int line = 0, fresh = 0, all = 0, boxes = 0;  ///< height of a line; widths
};

LegendSizes legend_sizes(int scale, int oldest_frames) {
  LegendSizes sizes;
  sizes.line = text_size(kBoxWords, scale).y + kLabelMarginPx;
  sizes.fresh = sizes.line + text_size(kFreshWords, scale).x + 4 * kLabelMarginPx;
  sizes.all = kLabelMarginPx + sizes.fresh + scale * kBarPx + text_size(old_words(oldest_frames), scale).x +
              3 * kLabelMarginPx;
  sizes.boxes = text_size(kBoxWords, scale).x + 2 * kLabelMarginPx;
  return sizes;
}

}  // namespace

std::array<std::uint8_t, 3> age_color(int age_frames, int oldest_frames) {
  if (age_frames <= 0) return {255, 255, 255};
  constexpr double kStops[3][3] = {{40, 200, 80}, {250, 215, 40}, {235, 50, 40}};
  const double span = std::max(oldest_frames - 1, 1);
  const double at = std::min((age_frames - 1) / span, 1.0) * 2;
  const int stop = at < 1 ? 0 : 1;
  Rgb color;
  for (int c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(kStops[stop][c] +
                                         (at - stop) * (kStops[stop + 1][c] - kStops[stop][c]) + 0.5);
  return color;
}

void draw_outlines(Image8& image, const std::vector<Outline>& outlines, int oldest_frames,
                   const std::vector<RectI>& kept_free) {
  TALISMAN_CHECK_EQ(image.rgb.size(), static_cast<std::size_t>(image.width) * image.height * 3);
  TALISMAN_CHECK_GE(oldest_frames, 1);
  if (image.rgb.empty()) return;
  for (const Outline& outline : outlines)
    for (const Segment& edge : visible_edges(outline, image.width, image.height))
      draw_line(image, edge.a, edge.b, age_color(outline.age_frames, oldest_frames));
  draw_labels(image, outlines, oldest_frames, kept_free);
}

std::optional<RectI> legend_place(const Image8& image, int oldest_frames) {
  const LegendSizes sizes = legend_sizes(letters_of(image), oldest_frames);
  const int width = std::max(sizes.all, sizes.boxes), height = 2 * sizes.line + kLabelMarginPx;
  // A legend that takes more than a fifth of the picture hides what it is the legend of.
  if (width > image.width || 5 * height > image.height) return std::nullopt;
  return RectI{0, image.height - height, width, image.height};
}

void draw_legend(Image8& image, int oldest_frames) {
  const auto place = legend_place(image, oldest_frames);
  if (!place) return;
  const int scale = letters_of(image);
  const LegendSizes sizes = legend_sizes(scale, oldest_frames);
  constexpr Rgb kWords{235, 235, 235};
  tint(image, {place->x0, place->y0, place->width(), place->height()}, kLabelGround, 0.75);
  int x = place->x0 + kLabelMarginPx, y = place->y0 + kLabelMarginPx;
  draw_text(image, kBoxWords, {x, y}, kWords, scale);
  y += sizes.line;
  const int sign = sizes.line - 2 * kLabelMarginPx;
  tint(image, {x, y, sign, sign}, age_color(0, oldest_frames), 1);
  draw_text(image, kFreshWords, {x + sign + kLabelMarginPx, y}, kWords, scale);
  x += sizes.fresh;
  for (int i = 0; i < scale * kBarPx; ++i)
    tint(image, {x + i, y, 1, sign}, age_color(1 + i * oldest_frames / (scale * kBarPx), oldest_frames), 1);
  draw_text(image, old_words(oldest_frames), {x + scale * kBarPx + kLabelMarginPx, y}, kWords, scale);
}

std::string outline_label(const std::string& layer, int age_frames) {
  if (age_frames <= 0) return layer + " · new";
  return layer + " · " + std::to_string(age_frames) + (age_frames == 1 ? " frame" : " frames");
}

void draw_overlay(Image8& image, const std::vector<Outline>& outlines, int oldest_frames) {
  const auto legend = legend_place(image, oldest_frames);
  draw_outlines(image, outlines, oldest_frames, legend ? std::vector<RectI>{*legend} : std::vector<RectI>{});
  draw_legend(image, oldest_frames);
}

}  // namespace talisman::sequences
