// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/factoring/pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sequences/experiments/statistics.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using layers::ivec2;

double luminance(const dvec3& linear) { return brightness(layers::vec3(linear)); }

dvec3 measured_at(const ShownFrame& frame, std::size_t pixel) {
  return linear_of(frame.factored.pixels[pixel]) - frame.prediction.pixels[pixel].truth;
}

double error_at(const ShownFrame& frame, std::size_t pixel, ErrorMap map) {
  const dvec3 predicted = frame.prediction.pixels[pixel].error();
  switch (map) {
    case ErrorMap::Measured:
      return luminance(measured_at(frame, pixel));
    case ErrorMap::Predicted:
      return luminance(predicted);
    case ErrorMap::Difference:
      return luminance(measured_at(frame, pixel) - predicted);
  }
  return 0;
}

std::string percent_text(double share) {
  const double percent = 100 * share;
  return fixed(percent, percent >= 1 ? 0 : percent >= 0.1 ? 1 : percent >= 0.01 ? 2 : 3) + "%";
}

/// A bar from -full to +full in the lower left corner, with its numbers.
void draw_scale(Image8& image, double full) {
  constexpr int kWidth = 120, kHeight = 8, kMargin = 6;
  const ivec2 at{kMargin, image.height - kMargin - kHeight};
  paste(image, plain_image(kWidth + 80, kHeight + 22, {255, 255, 255}), {0, at.y - 16});
  for (int x = 0; x < kWidth; ++x)
    paste(image, plain_image(1, kHeight, signed_color(2.0 * x / (kWidth - 1) - 1)), {at.x + x, at.y});
  constexpr Rgb kInk{40, 40, 40};
  draw_text(image, "-" + percent_text(full), {at.x, at.y - 10}, kInk, 1);
  draw_text(image, "0", {at.x + kWidth / 2 - 2, at.y - 10}, kInk, 1);
  draw_text(image, "+" + percent_text(full) + " of white", {at.x + kWidth - 20, at.y - 10}, kInk, 1);
}

/// Where the prediction is largest.
std::size_t largest_at(const ShownFrame& frame) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < frame.prediction.pixels.size(); ++i)
    if (std::fabs(error_at(frame, i, ErrorMap::Predicted)) >
        std::fabs(error_at(frame, best, ErrorMap::Predicted)))
      best = i;
  return best;
}

double full_scale(const ShownFrame& frame) {
  return round_up_125(std::fabs(error_at(frame, largest_at(frame), ErrorMap::Predicted)));
}

constexpr double kDifferenceZoom = 10;

/// The place of the largest error: unfactored left, factored right.
Image8 enlarged(const ShownFrame& frame, const Image8& truth, const Image8& shown, int scale) {
  const int width = truth.width, half = width / 2;
  const std::size_t place = largest_at(frame);
  const ivec2 center{static_cast<int>(place % width), static_cast<int>(place / width)};
  Image8 both = plain_image(width, truth.height, {28, 30, 36});
  paste(both, magnified(truth, center, {half - 2, truth.height}, scale), {0, 0});
  paste(both, magnified(shown, center, {half - 2, truth.height}, scale), {width - half + 2, 0});
  return both;
}

/// So that the predicted errors fall into about kBins bins.
int cells_per_bin(const ErrorCells& cells) {
  constexpr int kBins = 40;
  if (cells.empty()) return 1;
  return std::max((cells.rbegin()->first.first - cells.begin()->first.first) / kBins, 1);
}

int bin_of(int cell, int width) { return static_cast<int>(std::lround(static_cast<double>(cell) / width)); }

std::string amplification(double full) { return " X" + fixed(1 / full, 1 / full < 10 ? 1 : 0); }

}  // namespace

double round_up_125(double value) {
  constexpr double kSlack = 1 + 1e-9;  // 0.02 is not below 0.02
  for (double decade = 1e-4; decade < 1e3; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (value <= decade * step * kSlack) return decade * step;
  return value;
}

Image8 error_map(const ShownFrame& frame, ErrorMap map, double full) {
  Image8 image{frame.prediction.size_px.x, frame.prediction.size_px.y, {}};
  for (std::size_t i = 0; i < frame.prediction.pixels.size(); ++i) {
    const Rgb color = signed_color(error_at(frame, i, map) / full);
    image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  }
  draw_scale(image, full);
  return image;
}

Image8 factoring_sheet(const FactoringReport& report) {
  const ShownFrame& worst = report.result.worst;
  const double full = full_scale(worst), fine = full / kDifferenceZoom;
  const Image8 truth = to_image8(frame_of_truth(worst.prediction)), shown = to_image8(worst.factored);
  constexpr int kEnlarged = 12;
  const auto map = [&](ErrorMap kind, double scale) { return error_map(worst, kind, scale); };
  const std::vector<SheetColumn> columns{
      {{"above: unfactored", "below: measured error" + amplification(full)},
       {truth, map(ErrorMap::Measured, full)}},
      {{"above: factored, over alone", "below: predicted error" + amplification(full)},
       {shown, map(ErrorMap::Predicted, full)}},
      {{"above: both at the largest error X" + std::to_string(kEnlarged),
        "below: measured - predicted" + amplification(fine)},
       {enlarged(worst, truth, shown, kEnlarged), map(ErrorMap::Difference, fine)}}};
  return sheet_of({report.sequence + ", frame " + std::to_string(worst.frame)}, columns, 1);
}

Plot prediction_plot(const FactoringReport& report) {
  const int width = cells_per_bin(report.result.cells);
  const double bin_percent = 100.0 * width / kCellsOfWhite;
  Plot plot{"error of over alone (" + report.sequence + "), pixels by predicted error in bins of " +
                fixed(bin_percent, 3) + " %",
            {"predicted error, linear light", "% of white", false},
            {"measured error", "% of white", false},
            {}};
  std::map<std::pair<int, int>, std::int64_t> points;       // by predicted and measured bin
  std::map<int, std::pair<std::int64_t, double>> measured;  // by predicted bin: values, their sum
  for (const auto& [cell, values] : report.result.cells) {
    const int predicted = bin_of(cell.first, width);
    points[{predicted, bin_of(cell.second, width)}] += values;
    measured[predicted].first += values;
    measured[predicted].second += static_cast<double>(values) * cell.second;
  }
  PlotSeries some{"some pixel", {}, SeriesStyle::Cloud, {}};
  PlotSeries mean{"mean of a bin", {}, SeriesStyle::LinePoints, {}};
  PlotSeries equal{"measured = predicted", {}, SeriesStyle::Line, {}};
  for (const auto& [bins, values] : points)
    some.points.push_back({bins.first * bin_percent, bins.second * bin_percent});
  for (const auto& [bin, sum] : measured) {
    mean.points.push_back(
        {bin * bin_percent, 100.0 / kCellsOfWhite * sum.second / static_cast<double>(sum.first)});
    mean.samples.push_back(
        static_cast<int>(std::min<std::int64_t>(sum.first, std::numeric_limits<int>::max())));
  }
  if (!measured.empty())
    for (const int end : {measured.begin()->first, measured.rbegin()->first})
      equal.points.push_back({end * bin_percent, end * bin_percent});
  plot.series = {some, mean, equal};
  return plot;
}

Plot losses_plot(const FactoringReport& report) {
  Plot plot{"what is lost against the unfactored truth (" + report.sequence + ")",
            {"frame", "", false},
            {"RMS error of the sRGB frame", "code values", true},
            {}};
  for (const PictureLoss& loss : report.result.losses) {
    PlotSeries series{name(loss.picture), {}, SeriesStyle::LinePoints, {}};
    for (const FrameDiff& frame : loss.frames)
      series.points.push_back({std::stod(frame.name), rms_code_values(frame.quality.psnr_db)});
    plot.series.push_back(series);
  }
  return plot;
}

void write_factoring_pictures(const FactoringReport& report, const std::string& dir) {
  const ShownFrame& worst = report.result.worst;
  const double full = full_scale(worst);
  write_png(dir + "/factoring.png", factoring_sheet(report));
  write_png(dir + "/factoring-measured.png", error_map(worst, ErrorMap::Measured, full));
  write_png(dir + "/factoring-predicted.png", error_map(worst, ErrorMap::Predicted, full));
  write_png(dir + "/factoring-difference.png",
            error_map(worst, ErrorMap::Difference, full / kDifferenceZoom));
  PlotFiles files;
  files.width_px = 1000;
  write_plot(dir, "factoring-prediction", prediction_plot(report), files);
  write_plot(dir, "factoring-losses", losses_plot(report), files);
}

}  // namespace talisman::sequences
