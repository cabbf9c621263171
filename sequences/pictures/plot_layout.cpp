// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "sequences/pictures/box_placement.h"

namespace talisman::sequences {
namespace {

using layers::dvec2;
using layers::ivec2;
using layers::RectI;

// --- Axes

bool on_axis(double v, bool logarithmic) { return std::isfinite(v) && (!logarithmic || v > 0); }

constexpr double kAxisMargin = 0.04;  ///< of the span of the data

AxisRange logarithmic_range(double lo, double hi) {
  constexpr double kLeast = std::numeric_limits<double>::min(), kMost = std::numeric_limits<double>::max();
  lo = std::max(lo, kLeast), hi = std::max(hi, kLeast);
  // Of one value: from its half to its double.
  const double margin = hi > lo ? kAxisMargin * (std::log(hi) - std::log(lo)) : std::log(2.0);
  // At least a per mille, lest rounding ends in one number for both.
  const double factor = std::exp(std::max(margin, 1e-3));
  return {std::max(lo / factor, kLeast), hi > kMost / factor ? kMost : hi * factor, true};
}

AxisRange linear_range(double lo, double hi) {
  constexpr double kMost =
      std::numeric_limits<double>::max() / 4;  // so that the length of the axis is finite
  lo = std::clamp(lo, -kMost, kMost), hi = std::clamp(hi, -kMost, kMost);
  const double size = std::max(std::fabs(lo), std::fabs(hi));
  double margin = kAxisMargin * (hi - lo);
  if (!(margin > 1e-9 * size))
    margin = size > 0 ? std::max(0.1 * size, std::numeric_limits<double>::min()) : 1;
  return {lo >= 0 ? std::max(lo - margin, 0.0) : lo - margin, hi + margin, false};
}

/// Mantissas of the numbers of a decade, from many to few.
const std::vector<std::vector<double>>& mantissas() {
  static const std::vector<std::vector<double>> sets = {
      {1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 5, 7}, {1, 2, 5}, {1, 3}, {1}};
  return sets;
}

/// Digits and a power of ten, as it is written: 0.3 and not 0.30000000000000004.
double decimal(double mantissa, int exponent) {
  return exponent < 0 && exponent > -300 ? mantissa / std::pow(10.0, -exponent)
                                         : mantissa * std::pow(10.0, exponent);
}

std::vector<double> of_decades(const AxisRange& range, const std::vector<double>& of_one, int step) {
  std::vector<double> values;
  const int first = static_cast<int>(std::floor(std::log10(range.lo))),
            last = static_cast<int>(std::ceil(std::log10(range.hi)));
  for (int decade = first; decade <= last; ++decade)
    if (decade % step == 0)
      for (const double mantissa : of_one)
        if (const double v = decimal(mantissa, decade); v >= range.lo && v <= range.hi) values.push_back(v);
  return values;
}

/// 1, 2 or 5 times a power of ten apart.
std::vector<double> even_steps(const AxisRange& range, int most) {
  const double least = (range.hi - range.lo) / std::max(most - 1, 1);
  const int decade = static_cast<int>(std::floor(std::log10(least)));
  for (const double mantissa : {1.0, 2.0, 5.0, 10.0}) {
    const double step = decimal(mantissa, decade);
    if (step < least) continue;
    std::vector<double> values;
    for (double k = std::ceil(range.lo / step); k * step <= range.hi; ++k)
      if (const double v = mantissa * k * decimal(1, decade); v >= range.lo && v <= range.hi)
        values.push_back(v);
    return values;
  }
  return {};
}

// --- Words

/// In ems, of DejaVu Sans, rounded up.
double letter_width(unsigned char c) {
  constexpr std::string_view narrow = " .,:;'|!ijlIJ()[]/-ft", wide = "mwMW@%+=<>~#";
  if (narrow.find(char(c)) != std::string_view::npos) return 0.43;
  if (wide.find(char(c)) != std::string_view::npos) return 1.0;
  return c >= 'A' && c <= 'Z' ? 0.8 : 0.65;
}

bool continues_a_sign(unsigned char c) { return c >= 0x80 && c < 0xc0; }

// --- Labels

constexpr int kMarker_px = 6;      ///< half of a marker's box
constexpr int kLabelGap_px = 2;    ///< around the letters
constexpr double kJoined_px = 14;  ///< from here on a line leads to the point

std::vector<RectI> markers_of(const Plot& plot, const PlotLayout& layout) {
  std::vector<RectI> markers;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) {
      if (!has_markers(series.style) || !drawable(point, plot)) continue;
      const dvec2 p = layout.pixel(point);
      const int x = static_cast<int>(std::lround(p.x)), y = static_cast<int>(std::lround(p.y));
      markers.push_back({x - kMarker_px, y - kMarker_px, x + kMarker_px, y + kMarker_px});
    }
  return markers;
}

/// Right of the point and above it, right, left …: where a reader looks for its label.
BoxWish wish_of(const PlotLabel& label) {
  const ivec2 size{static_cast<int>(std::ceil(text_width_px(label.text, kLabelFont_px))) + 2 * kLabelGap_px,
                   static_cast<int>(std::ceil(kLabelFont_px)) + 2 * kLabelGap_px};
  const dvec2 p = label.point_px;
  const double right = p.x + kMarker_px, left = p.x - kMarker_px - size.x;
  const double above = p.y - kMarker_px - size.y, below = p.y + kMarker_px;
  return {size,
          {{right, above},
           {right, p.y - size.y / 2.0},
           {left, above},
           {left, p.y - size.y / 2.0},
           {right, below},
           {p.x - size.x / 2.0, above},
           {left, below},
           {p.x - size.x / 2.0, below}}};
}

double distance_to_box(dvec2 p, const RectI& box) {
  const double x = std::max({box.x0 - p.x, 0.0, p.x - box.x1}),
               y = std::max({box.y0 - p.y, 0.0, p.y - box.y1});
  return std::hypot(x, y);
}

std::vector<PlotLabel> wanted_labels(const Plot& plot, const PlotLayout& layout) {
  std::vector<PlotLabel> labels;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const PlotSeries& series = plot.series[s];
    for (std::size_t i = 0; i < std::min(series.labels.size(), series.points.size()); ++i)
      if (!series.labels[i].empty() && drawable(series.points[i], plot))
        labels.push_back({fitted_text(series.labels[i], kLabelFont_px, layout.area_px.width() / 3.0),
                          s,
                          layout.pixel(series.points[i]),
                          {},
                          false});
  }
  return labels;
}

void place_labels(const Plot& plot, PlotLayout& layout) {
  constexpr std::size_t kMost = 200;  // more could not be read, and would take seconds to place
  std::vector<PlotLabel> wanted = wanted_labels(plot, layout);
  if (wanted.size() > kMost) {
    layout.without_room += static_cast<int>(wanted.size() - kMost);
    wanted.resize(kMost);
  }
  std::vector<BoxWish> wishes;
  for (const PlotLabel& label : wanted) wishes.push_back(wish_of(label));
  const auto places = place_boxes(layout.area_px, markers_of(plot, layout), wishes);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!places[i]) {
      ++layout.without_room;
      continue;
    }
    layout.labels.push_back(wanted[i]);
    layout.labels.back().box_px = *places[i];
    layout.labels.back().joined = distance_to_box(wanted[i].point_px, *places[i]) > kJoined_px;
  }
}

int legend_width_px(const Plot& plot, int picture_px) {
  double names = 0;
  for (const PlotSeries& series : plot.series) {
    names = std::max(names, text_width_px(series.name, kTextFont_px));
    for (std::size_t i = 0; i < series.points.size(); ++i)
      if (few_samples(series, i, plot))
        names = std::max(names, text_width_px(few_samples_words(), kTextFont_px));
  }
  return static_cast<int>(std::ceil(std::min(kLegendSign_px + names, 0.4 * picture_px)));
}

}  // namespace

double AxisRange::share(double value) const {
  return logarithmic ? (std::log(value) - std::log(lo)) / (std::log(hi) - std::log(lo))
                     : (value - lo) / (hi - lo);
}

AxisRange axis_range(const std::vector<double>& values, bool logarithmic) {
  double lo = HUGE_VAL, hi = -HUGE_VAL;
  for (const double v : values)
    if (on_axis(v, logarithmic)) lo = std::min(lo, v), hi = std::max(hi, v);
  if (!(lo <= hi)) return logarithmic ? AxisRange{1, 10, true} : AxisRange{0, 1, false};
  return logarithmic ? logarithmic_range(lo, hi) : linear_range(lo, hi);
}

AxisTics logarithmic_tics(const AxisRange& range, int most) {
  const auto count = [](const std::vector<double>& values) { return static_cast<int>(values.size()); };
  AxisTics tics;
  if (range.hi < 2 * range.lo) {
    tics.numbers = even_steps(range, most);
    return tics;
  }
  for (const std::vector<double>& set : mantissas())
    if (tics.numbers = of_decades(range, set, 1); count(tics.numbers) <= most) break;
  for (int step = 2; count(tics.numbers) > most; ++step) tics.numbers = of_decades(range, {1}, step);
  tics.plain = of_decades(range, mantissas().front(), 1);
  if (count(tics.plain) > 6 * most) tics.plain = of_decades(range, {1}, 1);
  return tics;
}

double text_width_px(const std::string& text, double font_px) {
  double ems = 0;
  for (const char c : text)
    if (!continues_a_sign(static_cast<unsigned char>(c))) ems += letter_width(static_cast<unsigned char>(c));
  return ems * font_px;
}

std::string fitted_text(const std::string& text, double font_px, double width_px) {
  if (text_width_px(text, font_px) <= width_px) return text;
  const std::string dots = "…";
  std::string part = text;
  while (!part.empty() && text_width_px(part + dots, font_px) > width_px) {
    while (!part.empty() && continues_a_sign(static_cast<unsigned char>(part.back()))) part.pop_back();
    if (!part.empty()) part.pop_back();
  }
  return part + dots;
}

dvec2 PlotLayout::pixel(const PlotPoint& point) const {
  return {area_px.x0 + x.share(point.x) * area_px.width(), area_px.y1 - y.share(point.y) * area_px.height()};
}

namespace {

/// What the axes have to show.
std::array<std::vector<double>, 2> shown_values(const Plot& plot) {
  constexpr double kHalfBar = 0.5;  // of a bar with its gap
  std::vector<double> x, y;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) {
      if (!drawable(point, plot)) continue;
      x.push_back(point.x), y.push_back(point.y);
      if (series.style != SeriesStyle::Bars) continue;
      if (!plot.x.logarithmic) x.push_back(point.x - kHalfBar), x.push_back(point.x + kHalfBar);
      if (!plot.y.logarithmic) y.push_back(0);
    }
  if (plot.x.from_zero && !plot.x.logarithmic) x.push_back(0);
  if (plot.y.from_zero && !plot.y.logarithmic) y.push_back(0);
  return {x, y};
}

}  // namespace

PlotLayout plot_layout(const Plot& plot, const PlotFiles& files) {
  constexpr int kLeft_px = 96, kTop_px = 60, kBottom_px = 68, kNames_px = 140;  // of numbers and words
  const auto [x, y] = shown_values(plot);
  PlotLayout layout;
  // At least a fifth of a small picture is left for the curves.
  const int left = std::min(kLeft_px, files.width_px / 3), top = std::min(kTop_px, files.height_px / 4);
  layout.area_px = {
      left, top, files.width_px - legend_width_px(plot, files.width_px),
      files.height_px - std::min(plot.x.names.empty() ? kBottom_px : kNames_px, files.height_px / 4)};
  layout.x = axis_range(x, plot.x.logarithmic);
  layout.y = axis_range(y, plot.y.logarithmic);
  place_labels(plot, layout);
  return layout;
}

bool has_markers(SeriesStyle style) {
  return style == SeriesStyle::Points || style == SeriesStyle::LinePoints;
}

bool few_samples(const PlotSeries& series, std::size_t point, const Plot& plot) {
  return has_markers(series.style) && point < series.samples.size() && series.samples[point] < kFewSamples &&
         drawable(series.points[point], plot);
}

std::string few_samples_words() { return "hollow: fewer than " + std::to_string(kFewSamples) + " samples"; }

bool drawable(const PlotPoint& point, const Plot& plot) {
  return on_axis(point.x, plot.x.logarithmic) && on_axis(point.y, plot.y.logarithmic);
}

}  // namespace talisman::sequences
