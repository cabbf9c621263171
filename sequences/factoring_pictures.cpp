// SPDX-License-Identifier: Apache-2.0
#include "sequences/factoring_pictures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sequences/page.h"
#include "sequences/tile_image.h"

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
  const std::string number = std::to_string(worst.frame);
  return sheet_of(
      {{"UNFACTORED, FRAME " + number, truth},
       {"FACTORED: OVER ALONE", shown},
       {"UNFACTORED, FACTORED, X" + std::to_string(kEnlarged), enlarged(worst, truth, shown, kEnlarged)},
       {"MEASURED ERROR" + amplification(full), error_map(worst, ErrorMap::Measured, full)},
       {"PREDICTED ERROR" + amplification(full), error_map(worst, ErrorMap::Predicted, full)},
       {"MEASURED - PREDICTED" + amplification(fine), error_map(worst, ErrorMap::Difference, fine)}},
      3);
}

Plot prediction_plot(const FactoringReport& report) {
  Plot plot{"error of over alone (" + report.sequence +
                "): measured against predicted, a point per cell of 1/" + std::to_string(kCellsOfWhite) +
                " of white",
            {"predicted error, linear light", "% of white", false},
            {"measured error", "% of white", false},
            {}};
  PlotSeries cells{"cell with values", {}, SeriesStyle::Cloud, {}};
  PlotSeries mean{"mean of a bin of predicted error", {}, SeriesStyle::LinePoints, {}};
  PlotSeries equal{"measured = predicted", {}, SeriesStyle::Line, {}};
  constexpr double kPercent = 100.0 / kCellsOfWhite;
  std::map<int, std::pair<std::int64_t, double>> bins;  // by predicted: values, sum of measured
  for (const auto& [cell, values] : report.result.cells) {
    cells.points.push_back({cell.first * kPercent, cell.second * kPercent});
    bins[cell.first].first += values;
    bins[cell.first].second += static_cast<double>(values) * cell.second;
  }
  for (const auto& [predicted, sum] : bins)
    mean.points.push_back({predicted * kPercent, sum.second / static_cast<double>(sum.first) * kPercent});
  if (!bins.empty())
    for (const int end : {bins.begin()->first, bins.rbegin()->first})
      equal.points.push_back({end * kPercent, end * kPercent});
  plot.series = {cells, mean, equal};
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
      series.points.push_back({std::stod(frame.name), rms_code_values(frame.quality)});
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
  write_plot(dir, "factoring-prediction", prediction_plot(report));
  write_plot(dir, "factoring-losses", losses_plot(report));
}

}  // namespace talisman::sequences
