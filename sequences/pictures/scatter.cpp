// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/scatter.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sequences/files/number_text.h"
#include "sequences/pictures/page_text.h"

namespace talisman::sequences {

namespace {

constexpr double kWidth = 720, kHeight = 340, kLeft = 64, kRight = 90, kTop = 14, kBottom = 46;
constexpr int kShapes = 4;

/// One axis: from a value to a place between `from` and `to`.
struct ScatterScale {
  double lo = 0, hi = 1, from = 0, to = 1;
  bool logarithmic = false;

  double share(double value) const {
    return logarithmic ? std::log(value / lo) / std::log(hi / lo) : (value - lo) / (hi - lo);
  }
  double place(double value) const { return from + (to - from) * share(value); }
  /// Numbers of one, two or five times a power of ten.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (logarithmic) {
      for (int power = static_cast<int>(std::floor(std::log10(lo))); std::pow(10, power) <= hi; ++power)
        for (const double digit : {1, 2, 5})
          if (const double tick = digit * std::pow(10, power); tick >= lo && tick <= hi)
            ticks.push_back(tick);
      return ticks;
    }
    constexpr double kMost = 7;
    double step = std::pow(10, std::floor(std::log10((hi - lo) / kMost)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0})
      if ((hi - lo) / (factor * step) <= kMost) {
        step *= factor;
        break;
      }
    for (int k = 0; k * step <= hi; ++k) ticks.push_back(k * step);
    return ticks;
  }
};

ScatterScale scale_of(const std::vector<double>& values, bool logarithmic, double from, double to) {
  ScatterScale scale{0, 1, from, to, logarithmic};
  if (values.empty()) return scale;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  scale.hi = *most > 0 ? 1.1 * *most : 1;
  if (logarithmic) scale.lo = *least / 1.2, scale.hi = 1.2 * *most;
  return scale;
}

/// Told apart without their colours.
std::string shape(int series, double x, double y) {
  constexpr double kReach = 5;
  switch (series % kShapes) {
    case 0:
      return formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.0f\"/>", x, y, kReach);
    case 1:
      return formatted("<rect x=\"%.1f\" y=\"%.1f\" width=\"9\" height=\"9\"/>", x - 4.5, y - 4.5);
    case 2:
      return formatted("<path d=\"M%.1f %.1fl6 6l-6 6l-6-6z\"/>", x, y - 6);
    default:
      return formatted("<path d=\"M%.1f %.1fl6 10h-12z\"/>", x, y - 6);
  }
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor) + escaped(text) +
         "</text>\n";
}

std::string axes(const ScatterPicture& scatter, const ScatterScale& x, const ScatterScale& y) {
  std::string text;
  for (const double tick : x.ticks()) {
    text += formatted("<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", x.place(tick), y.from, y.to);
    text += text_at(x.place(tick), y.from + 16, "middle", formatted("%.4g", tick));
  }
  for (const double tick : y.ticks()) {
    text += formatted("<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", x.from, y.place(tick), x.to);
    text += text_at(x.from - 6, y.place(tick) + 4, "end", formatted("%.4g", tick));
  }
  return text + text_at((x.from + x.to) / 2, kHeight - 6, "middle", scatter.x_label) +
         formatted("<g transform=\"translate(14 %.1f) rotate(-90)\">", (y.from + y.to) / 2) +
         text_at(0, 0, "middle", scatter.y_label) + "</g>\n";
}

}  // namespace

std::string svg(const ScatterPicture& scatter) {
  std::vector<ScatterPoint> points;
  std::vector<double> xs, ys;
  for (const ScatterPoint& point : scatter.points) {
    const bool is_finite = std::isfinite(point.x) && std::isfinite(point.y);
    if (!is_finite || (scatter.logarithmic && !(point.x > 0 && point.y > 0))) continue;
    points.push_back(point);
    xs.push_back(point.x), ys.push_back(point.y);
  }
  const ScatterScale x = scale_of(xs, scatter.logarithmic, kLeft, kWidth - kRight),
                     y = scale_of(ys, scatter.logarithmic, kHeight - kBottom, kTop);
  std::string text =
      formatted("<svg class=\"scatter\" viewBox=\"0 0 %.0f %.0f\" role=\"group\" aria-label=\"", kWidth,
                kHeight) +
      escaped(scatter.caption) + "\">\n" + axes(scatter, x, y);
  std::map<int, std::string> lines;
  for (const ScatterPoint& point : points)
    lines[point.series] +=
        formatted("%s%.1f %.1f", lines[point.series].empty() ? "M" : "L", x.place(point.x), y.place(point.y));
  for (const auto& [series, line] : lines)
    text += formatted("<path class=\"line c%d\" d=\"", series % kShapes) + line + "\"/>\n";
  for (const ScatterPoint& point : points) {
    const std::string mark = formatted("<g class=\"point c%d\">", point.series % kShapes) +
                             shape(point.series, x.place(point.x), y.place(point.y)) + "<title>" +
                             escaped(point.label) + formatted(": %.4g, %.4g", point.x, point.y) + "</title>" +
                             text_at(x.place(point.x) + 9, y.place(point.y) - 6, "start", point.label) +
                             "</g>\n";
    text += point.href.empty() ? mark : "<a href=\"" + escaped(point.href) + "\">" + mark + "</a>\n";
  }
  return text + "</svg>\n";
}

}  // namespace talisman::sequences
