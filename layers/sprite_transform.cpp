// SPDX-License-Identifier: Apache-2.0
#include "layers/sprite_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "layers/outline.h"

namespace talisman::layers {
namespace {

/// Rounding of coordinates (texels) that must not cost a texel nor raise a flag.
constexpr double kSliver = 1e-6;
constexpr int kPadding = 1;
/// Padding on both sides, and what rounding to whole texels adds at most on both sides.
constexpr double kMargins = 2 * kPadding + 2;

/// A value outside its range counts as the nearest end, NaN as the default.
double in_range(double value, double lo, double hi, double fallback) {
  return std::isnan(value) ? fallback : std::clamp(value, lo, hi);
}

constexpr double kLeastMotionDensity = 1.0 / 16;

/// The sample lattice of one direction and density, anchored at the display's origin.
struct Lattice {
  double cos = 1, sin = 0;
  dvec2 density{1, 1};  ///< along the two axes
  bool axis_aligned() const { return sin == 0; }
  /// Texels are pixels.
  bool is_flush() const { return axis_aligned() && density == dvec2(1); }

  dvec2 operator()(dvec2 p) const {
    return {density.x * (cos * p.x + sin * p.y), density.y * (cos * p.y - sin * p.x)};
  }
  /// Of finite points; without the calls that RectD::include makes for the sake of NaN.
  RectD bounds(const Polygon2& points) const {
    RectD result;
    for (const dvec2 point : points) {
      const dvec2 p = (*this)(point);
      result.lo = {std::min(result.lo.x, p.x), std::min(result.lo.y, p.y)};
      result.hi = {std::max(result.hi.x, p.x), std::max(result.hi.y, p.y)};
    }
    return result;
  }
  Affine2 screen_from_sprite(int x0, int y0) const {
    const dvec2 x_axis = dvec2(cos, sin) / density.x, y_axis = dvec2(0 - sin, cos) / density.y;
    return {x_axis.x, y_axis.x, x_axis.x * x0 + y_axis.x * y0,
            x_axis.y, y_axis.y, x_axis.y * x0 + y_axis.y * y0};
  }
};

constexpr int kFewestDirections = 2, kMostDirections = 30;

/// Cosine and sine of direction k of n, for every n: they are asked for in every placement.
struct Directions {
  std::array<std::array<dvec2, kMostDirections>, kMostDirections + 1> of;
  Directions() {
    for (int n = kFewestDirections; n <= kMostDirections; ++n)
      for (int k = 0; k < n; ++k) {
        const double angle = k * (std::numbers::pi / 2) / n;
        of[n][k] = {std::cos(angle), std::sin(angle)};
      }
  }
};

double padded_area(const RectD& r) { return (r.width() + 2 * kPadding) * (r.height() + 2 * kPadding); }

/// Less than the padded area of any rectangle around the polygon: its sides w and h have w h ≥ the polygon's
/// area S, so that (w + 2 p) (h + 2 p) ≥ (√S + 2 p)². A hair less, for the rounding of both.
double least_padded_area(const Polygon2& polygon, double density) {
  const double side = std::sqrt(area_of(polygon)) * density + 2 * kPadding;
  return side * side * (1 - 1e-9);
}

/// The slab direction with the least area [LS97 3.3]; the axes unless that saves the share that was asked
/// for.
Lattice choose_direction(const Polygon2& shown, const PlacementOptions& options, double density) {
  static const Directions kDirections;
  const int directions = std::clamp(options.slab_directions, kFewestDirections, kMostDirections);
  const Lattice axes{1, 0, dvec2(density)};
  Lattice best = axes;
  double best_area = padded_area(axes.bounds(shown));
  const double gain = in_range(options.min_rotation_gain, 0, 1, PlacementOptions{}.min_rotation_gain);
  const double area_to_rotate = (1 - gain) * best_area;
  if (least_padded_area(shown, density) > area_to_rotate) return axes;  // no direction saves as much
  for (int k = 1; k < directions; ++k) {
    const dvec2 direction = kDirections.of[directions][k];
    const Lattice rotated{direction.x, direction.y, dvec2(density)};
    const double area = padded_area(rotated.bounds(shown));
    if (area >= best_area || area > area_to_rotate) continue;
    best = rotated;
    best_area = area;
  }
  return best;
}

/// One axis along the motion, at most 45 degrees from the display's, so that the sprite stays upright; the
/// same for motion there and back.
Lattice along_motion(dvec2 motion, double density, double ratio) {
  const dvec2 way = motion / std::hypot(motion.x, motion.y);
  const bool is_x = std::abs(way.x) >= std::abs(way.y);
  const dvec2 x_axis =
      is_x ? way * (way.x < 0 ? -1.0 : 1.0) : dvec2(way.y, -way.x) * (way.y < 0 ? -1.0 : 1.0);
  return {x_axis.x, x_axis.y + 0, is_x ? dvec2(density * ratio, density) : dvec2(density, density * ratio)};
}

bool is_blurred(const PlacementOptions& options) {
  const double length = std::hypot(options.motion.x, options.motion.y);
  return options.motion_density < 1 && length > 0 && std::isfinite(length);
}

Lattice choose_lattice(const Polygon2& shown, const PlacementOptions& options) {
  const double density = in_range(options.resolution_scale, 1e-3, 4, PlacementOptions{}.resolution_scale);
  if (!is_blurred(options)) return choose_direction(shown, options, density);
  return along_motion(options.motion, density, std::max(options.motion_density, kLeastMotionDensity));
}

/// The factor by which density must fall so that the larger side of `shown` takes at most `max_px` texels
/// with its margins.
double reduction_within(const RectD& shown, int max_px) {
  const double larger = std::max(shown.width(), shown.height());
  return larger + kMargins > max_px ? (max_px - kMargins) / larger : 1;
}

/// Speed (px per frame, ≥ 0) with which content moves in over the low (sign = 1) or high (sign = -1) side of
/// an axis: the fastest of the points on that half of the display. Those on the other half tell of another
/// side: under a zoom they move the opposite way.
double speed_inwards(const Correspondences& motion, int axis, double sign, double centre) {
  double speed = 0;
  for (std::size_t i = 0; i < motion.point.size(); ++i) {
    if (sign * (motion.then_px[i][axis] - centre) > 0) continue;
    speed = std::max(speed, sign * (motion.now_px[i][axis] - motion.then_px[i][axis]));
  }
  return speed;
}

/// The display, grown by velocity × expected reuse [LS97 3.2].
RectD grown_display(const LayerState& now, const LayerState& soon, const Polyhedron& hull,
                    const ExtentOptions& options) {
  const dvec2 size(now.view.display_px);
  RectD grown{{0, 0}, size};
  const double frames = in_range(options.expected_reuse_frames, 0, HUGE_VAL, 0);
  if (frames == 0) return grown;
  const Correspondences motion = correspond(now, soon, hull);
  if (!motion.overlap) return grown;
  const double most = in_range(options.max_growth, 0, 1, 0) * std::max(size.x, size.y);
  const auto growth = [&](int axis, double sign) {
    const double speed = speed_inwards(motion, axis, sign, size[axis] / 2);
    return speed > 0 ? std::min(frames * speed, most) : 0;
  };
  for (const int axis : {0, 1}) {
    grown.lo[axis] -= growth(axis, 1);
    grown.hi[axis] += growth(axis, -1);
  }
  return grown;
}

/// What was cut off at the enlarged view goes on beyond it: such points are moved out by a display's size.
Polygon2 continued_beyond_view(Polygon2 outline, const View& view) {
  const dvec2 size(view.display_px);
  const double larger = std::max(size.x, size.y);
  for (dvec2& p : outline) {
    for (const int axis : {0, 1}) {
      const double margin = view.clip_margin * size[axis];
      if (p[axis] <= -margin + kSliver) p[axis] -= larger;
      if (p[axis] >= size[axis] + margin - kSliver) p[axis] += larger;
    }
  }
  return outline;
}

/// One axis of a rectangle, in lattice coordinates.
struct Interval {
  double lo, hi;
};

struct Texels {
  int lo, hi;
  bool cut_lo, cut_hi;
};

/// Gives up growth until no more than `max_px` texels are left, from both sides in proportion to their
/// growth.
void give_up_growth(const Texels& ungrown, int max_px, Texels& texels) {
  const int excess = texels.hi - texels.lo - max_px;
  if (excess <= 0) return;
  const double grown_lo = std::max(0, ungrown.lo - texels.lo), grown_hi = std::max(0, texels.hi - ungrown.hi);
  const int from_lo = static_cast<int>(std::lround(excess * grown_lo / std::max(1.0, grown_lo + grown_hi)));
  texels.lo += from_lo;
  texels.hi -= excess - from_lo;
}

/// Whole texels over `drawn`, padded. A layer that goes on beyond the padding of a flush lattice gets none
/// there.
Texels cover(Interval own, Interval drawn, bool flush) {
  Texels t{static_cast<int>(std::floor(drawn.lo + kSliver)), static_cast<int>(std::ceil(drawn.hi - kSliver)),
           false, false};
  t.hi = std::max(t.hi, t.lo + 1);
  if (!flush || own.lo >= t.lo - kPadding) t.lo -= kPadding;
  if (!flush || own.hi <= t.hi + kPadding) t.hi += kPadding;
  return t;
}

/// One axis of the sprite: `own` are the bounds of the layer, `shown` of what is on the display, `drawn` of
/// what is in the extents.
Texels texels_along(Interval own, Interval shown, Interval drawn, bool flush, int max_px) {
  Texels texels = cover(own, drawn, flush);
  give_up_growth(cover(own, shown, flush), max_px, texels);
  texels.cut_lo = own.lo < texels.lo - kSliver;
  texels.cut_hi = own.hi > texels.hi + kSliver;
  return texels;
}

}  // namespace

SpritePlacement place_sprite(const LayerState& now, const LayerState& soon, const Polyhedron& hull,
                             const ExtentOptions& extents, const PlacementOptions& options) {
  SpritePlacement placement;
  if (!now.touches_display) return placement;
  const RectD display{{0, 0}, dvec2(now.view.display_px)};
  const Polygon2 outline = convex_hull(now.screen_points);
  const Polygon2 on_display = clip_to_rect(outline, display);
  if (on_display.empty()) return placement;  // its bounds touch the display, itself it passes by a corner

  const int max_px = std::max(options.max_sprite_px, 8);
  Lattice lattice = choose_lattice(on_display, options);
  RectD shown = lattice.bounds(on_display);
  const double reduction = reduction_within(extents.whole ? lattice.bounds(outline) : shown, max_px);
  if (reduction < 1) {
    lattice.density *= reduction;
    shown = lattice.bounds(on_display);
  }

  const RectD grown = extents.whole ? display : grown_display(now, soon, hull, extents);
  const RectD own = lattice.bounds(now.clipped ? continued_beyond_view(outline, now.view) : outline);
  const RectD drawn = extents.whole      ? lattice.bounds(outline)
                      : grown == display ? shown
                                         : lattice.bounds(clip_to_rect(outline, grown));
  const auto along = [&](int axis) {
    return texels_along({own.lo[axis], own.hi[axis]}, {shown.lo[axis], shown.hi[axis]},
                        {drawn.lo[axis], drawn.hi[axis]}, lattice.is_flush(), max_px);
  };
  const Texels x = along(0), y = along(1);
  placement.screen_from_sprite = lattice.screen_from_sprite(x.lo, y.lo);
  placement.size_px = {x.hi - x.lo, y.hi - y.lo};
  placement.clipped = {x.cut_lo, x.cut_hi, y.cut_lo, y.cut_hi};
  placement.axis_aligned = lattice.axis_aligned();
  placement.resolution_reduced = reduction < 1;
  placement.density_kept = reduction;
  return placement;
}

}  // namespace talisman::layers
