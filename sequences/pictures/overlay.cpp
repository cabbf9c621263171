// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/overlay.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "layers/check.h"
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

/// Is the middle of the picture inside the sprite? Then a sprite without a visible edge covers it all.
bool covers_middle(const Outline& outline, int width, int height) {
  const auto corners = corners_of(outline);
  const dvec3 middle(width / 2.0, height / 2.0, 1);
  int positive = 0, negative = 0;
  for (int i = 0; i < 4; ++i) {
    const dvec3 &a = corners[i], &b = corners[(i + 1) % 4];
    if (!(a.z > 0)) return false;
    const double side =
        middle.x * (a.y * b.z - a.z * b.y) + middle.y * (a.z * b.x - a.x * b.z) + (a.x * b.y - a.y * b.x);
    positive += side > 0;
    negative += side < 0;
  }
  return positive == 4 || negative == 4;
}

/// The corner that the label belongs to: the first corner of the sprite in view, else the first visible end
/// of an edge.
std::optional<dvec2> label_anchor(const Outline& outline, const std::vector<Segment>& edges, int width,
                                  int height) {
  for (const dvec3& c : corners_of(outline)) {
    const dvec2 p{c.x / c.z, c.y / c.z};
    if (c.z > 0 && p.x >= 0 && p.x < width && p.y >= 0 && p.y < height) return p;
  }
  if (!edges.empty()) return edges.front().a;
  if (covers_middle(outline, width, height)) return dvec2{0, 0};
  return std::nullopt;
}

bool overlap(const RectI& a, const RectI& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

RectI moved_inside(RectI box, int width, int height) {
  const int dx = std::max(std::min(0, width - box.x1), -box.x0),
            dy = std::max(std::min(0, height - box.y1), -box.y0);
  return {box.x0 + dx, box.y0 + dy, box.x1 + dx, box.y1 + dy};
}

class Labels {
 public:
  Labels(Image8& image, int scale) : image_(image), scale_(scale) {}

  void draw(const std::string& text, dvec2 anchor, Rgb color) {
    if (text.empty()) return;
    const ivec2 letters = text_size(text, scale_);
    const RectI box = free_place(anchor, {letters.x + 2 * kLabelMarginPx, letters.y + kLabelMarginPx});
    taken_.push_back(box);
    tint(image_, {box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0}, kLabelGround, 0.75);
    draw_text(image_, text, {box.x0 + kLabelMarginPx, box.y0 + kLabelMarginPx}, color, scale_);
  }

 private:
  /// At the anchor, inside the picture, or else below or above the labels that are already there.
  RectI free_place(dvec2 anchor, ivec2 size) const {
    const int x = static_cast<int>(std::floor(anchor.x)) + 2, y = static_cast<int>(std::floor(anchor.y)) + 2;
    const auto is_free = [this](const RectI& box) {
      return std::none_of(taken_.begin(), taken_.end(), [&box](const RectI& t) { return overlap(t, box); });
    };
    const auto at = [&](int row) {
      return moved_inside({x, y + row * size.y, x + size.x, y + (row + 1) * size.y}, image_.width,
                          image_.height);
    };
    const int rows = image_.height / std::max(size.y, 1);
    for (int step = 0; step <= rows; ++step)
      for (const int row : {step, -step})
        if (const RectI box = at(row); is_free(box)) return box;
    return at(0);
  }

  Image8& image_;
  int scale_;
  std::vector<RectI> taken_;
};

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

void draw_outlines(Image8& image, const std::vector<Outline>& outlines, int oldest_frames) {
  TALISMAN_CHECK_EQ(image.rgb.size(), static_cast<std::size_t>(image.width) * image.height * 3);
  TALISMAN_CHECK_GE(oldest_frames, 1);
  if (image.rgb.empty()) return;
  const int scale = std::min(image.width, image.height) >= kLargePx ? 2 : 1;
  std::vector<std::optional<dvec2>> anchors;
  for (const Outline& outline : outlines) {
    const auto edges = visible_edges(outline, image.width, image.height);
    for (const Segment& edge : edges)
      draw_line(image, edge.a, edge.b, age_color(outline.age_frames, oldest_frames));
    anchors.push_back(label_anchor(outline, edges, image.width, image.height));
  }
  Labels labels(image, scale);
  for (std::size_t i = 0; i < outlines.size(); ++i)
    if (anchors[i])
      labels.draw(outlines[i].label, *anchors[i], age_color(outlines[i].age_frames, oldest_frames));
}

}  // namespace talisman::sequences
