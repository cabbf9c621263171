// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where in its picture does a plot have its axes, numbers and labels?
///
/// gnuplot does not know whether one label lies over another. So ranges, tics and margins are chosen here,
/// every point has a known pixel, and labels are boxes that are placed beside their points (box_placement.h),
/// clear of the markers and of each other; one that had to go far is joined with its point by a thin line.
/// Letters are as wide as those of DejaVu Sans, the widest of the common substitutes for Helvetica.
///
/// Pure. Pixels are of the picture: x to the right, y down.

#include <optional>
#include <string>
#include <vector>

#include "layers/geometry2.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// What an axis shows: finite, lo < hi, and > 0 if logarithmic.
struct AxisRange {
  double lo = 0, hi = 1;
  bool logarithmic = false;
  /// 0 at lo, 1 at hi.
  double share(double value) const;
};

/// Holds every drawable value with a margin of 4 % of the axis on both sides; a linear axis of values ≥ 0 does
/// not go below 0. Without a drawable value 0 … 1, or 1 … 10.
AxisRange axis_range(const std::vector<double>& values, bool logarithmic);

/// Where an axis has numbers, and where tics without one; ascending, in its range.
struct AxisTics {
  std::vector<double> numbers, plain;
};

/// Decades, or every second, third, … of them; where there are few, also 2, 5 or more of each; in ranges of
/// less than a factor of two even steps. At most `most` numbers, ≥ 2 wherever possible.
AxisTics logarithmic_tics(const AxisRange& range, int most);

/// An upper bound of what a text takes in letters of `font_px`.
double text_width_px(const std::string& text, double font_px);

/// The text, or its beginning and "…", so that it is at most `width_px` wide.
std::string fitted_text(const std::string& text, double font_px, double width_px);

struct PlotLabel {
  std::string text;
  std::size_t series = 0;
  layers::dvec2 point_px{0, 0};
  layers::RectI box_px;
  bool joined = false;  ///< far from its point: with a line to it
};

struct PlotLayout {
  layers::RectI area_px;  ///< between the axes
  AxisRange x, y;
  std::vector<PlotLabel> labels;
  int without_room = 0;  ///< labels that are left out
  layers::dvec2 pixel(const PlotPoint& point) const;
};

inline constexpr double kTextFont_px = 14, kLabelFont_px = 11;
inline constexpr int kLegendSign_px = 78;  ///< the line before a name of the legend, with its gaps

PlotLayout plot_layout(const Plot& plot, const PlotFiles& files);

/// Can the point be drawn? Finite, and > 0 on a logarithmic axis.
bool drawable(const PlotPoint& point, const Plot& plot);

bool has_markers(SeriesStyle style);

/// Is the point drawn hollow, because it is of few samples? And the words of the legend for it.
bool few_samples(const PlotSeries& series, std::size_t point, const Plot& plot);
std::string few_samples_words();

}  // namespace talisman::sequences
