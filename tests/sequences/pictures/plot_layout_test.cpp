// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot_layout.h"
#include "sequences/pictures/plot_links.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/pictures/box_placement.h"

namespace talisman::sequences {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

Plot labelled(const std::vector<PlotPoint>& points, bool logarithmic = false) {
  Plot plot{"", {"x", "", logarithmic}, {"y", "", logarithmic}, {}};
  PlotSeries series{"s", points, SeriesStyle::LinePoints, {}};
  for (std::size_t i = 0; i < points.size(); ++i) series.labels.push_back("label " + std::to_string(i));
  plot.series.push_back(series);
  return plot;
}

/// All labels inside the axes, none over another or over a marker's middle.
void expect_clear(const PlotLayout& layout) {
  const layers::RectI& area = layout.area_px;
  for (std::size_t i = 0; i < layout.labels.size(); ++i) {
    const layers::RectI& box = layout.labels[i].box_px;
    EXPECT_TRUE(box.x0 >= area.x0 && box.y0 >= area.y0 && box.x1 <= area.x1 && box.y1 <= area.y1) << i;
    for (std::size_t k = 0; k < layout.labels.size(); ++k) {
      EXPECT_TRUE(k == i || !overlap(box, layout.labels[k].box_px)) << i << ", " << k;
      const layers::dvec2 p = layout.labels[k].point_px;
      EXPECT_FALSE(p.x > box.x0 && p.x < box.x1 && p.y > box.y0 && p.y < box.y1) << i << ", " << k;
    }
  }
}

TEST(PlotLayout, FortyLabelsAtOnePoint) {
  for (const bool logarithmic : {false, true}) {
    const PlotLayout layout = plot_layout(labelled(std::vector<PlotPoint>(40, {3, 7}), logarithmic), {});
    EXPECT_THAT(layout.labels, SizeIs(40));
    EXPECT_EQ(layout.without_room, 0);
    expect_clear(layout);
    EXPECT_FALSE(layout.labels.front().joined);
    EXPECT_TRUE(layout.labels.back().joined);
  }
}

// Points in the corners of the axes: labels do not leave the picture.
TEST(PlotLayout, LabelsAtTheEndsOfTheAxes) {
  const PlotLayout layout = plot_layout(labelled({{0, 0}, {0, 1}, {1, 0}, {1, 1}}), {});
  EXPECT_THAT(layout.labels, SizeIs(4));
  expect_clear(layout);
}

TEST(PlotLayout, ValuesThatCannotBeDrawnHaveNoLabel) {
  const double nan = std::nan(""), inf = HUGE_VAL;
  const PlotLayout layout =
      plot_layout(labelled({{1, nan}, {nan, 1}, {inf, 1}, {1, -inf}, {0, 1}, {1, -1}, {2, 2}}, true), {});
  ASSERT_THAT(layout.labels, SizeIs(1));
  EXPECT_EQ(layout.labels[0].text, "label 6");
  expect_clear(layout);
}

TEST(PlotLayout, OnePointAndNone) {
  const PlotLayout one = plot_layout(labelled({{5, 5}}), {});
  ASSERT_THAT(one.labels, SizeIs(1));
  EXPECT_FALSE(one.labels[0].joined);
  EXPECT_THAT(plot_layout(labelled({}), {}).labels, SizeIs(0));
  EXPECT_THAT(plot_layout(Plot{}, {}).labels, SizeIs(0));
}

// In the smallest picture there is no room for all; those that are left out are counted.
TEST(PlotLayout, LabelsWithoutRoomAreCounted) {
  const PlotLayout layout = plot_layout(labelled(std::vector<PlotPoint>(300, {1, 1})), {false, 100, 100});
  expect_clear(layout);
  EXPECT_EQ(layout.labels.size() + layout.without_room, 300u);
  EXPECT_GT(layout.without_room, 0);
}

// By hand: axes from 96 to width - legend, one decade of logarithms is half of two.
TEST(PlotLayout, PixelsOfPoints) {
  PlotLayout layout;
  layout.area_px = {100, 50, 500, 250};
  layout.x = {1, 100, true};
  layout.y = {0, 4, false};
  EXPECT_NEAR(layout.pixel({10, 1}).x, 300, 1e-9);
  EXPECT_NEAR(layout.pixel({10, 1}).y, 200, 1e-9);
}

TEST(AxisRange, HoldsItsValuesAndAMargin) {
  const AxisRange linear = axis_range({2, 12}, false), logarithmic = axis_range({1, 100}, true);
  EXPECT_DOUBLE_EQ(linear.lo, 1.6);
  EXPECT_DOUBLE_EQ(linear.hi, 12.4);
  EXPECT_NEAR(logarithmic.lo, std::pow(100, -0.04), 1e-12);
  EXPECT_NEAR(logarithmic.hi, 100 * std::pow(100, 0.04), 1e-9);
  EXPECT_EQ(axis_range({0, 10}, false).lo, 0);
  EXPECT_LT(axis_range({-1, 10}, false).lo, -1);
}

TEST(AxisRange, HardValues) {
  const double tiny = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
  const std::vector<std::vector<double>> hard = {{},     {NAN},         {HUGE_VAL},   {0},
                                                 {5},    {-5},          {5, 5},       {tiny},
                                                 {most}, {-most, most}, {tiny, most}, {1, 1 + 1e-15}};
  for (const auto& values : hard)
    for (const bool logarithmic : {false, true}) {
      const AxisRange range = axis_range(values, logarithmic);
      EXPECT_TRUE(std::isfinite(range.lo) && std::isfinite(range.hi) && range.lo < range.hi);
      EXPECT_TRUE(!logarithmic || range.lo > 0);
      for (const double v : values)
        if (std::isfinite(v) && std::fabs(v) < most && (!logarithmic || v > tiny)) {
          if (logarithmic && v <= 0) continue;
          EXPECT_TRUE(range.lo <= v && v <= range.hi) << v;
        }
    }
}

TEST(LogarithmicTics, AsManyAsThereIsRoomFor) {
  EXPECT_THAT(logarithmic_tics({0.9, 1100, true}, 8).numbers, ElementsAre(1, 3, 10, 30, 100, 300, 1000));
  EXPECT_THAT(logarithmic_tics({0.9, 1100, true}, 4).numbers, ElementsAre(1, 10, 100, 1000));
  EXPECT_THAT(logarithmic_tics({0.002, 0.006, true}, 8).numbers,
              ElementsAre(0.002, 0.003, 0.004, 0.005, 0.006));
  EXPECT_THAT(logarithmic_tics({0.9e-9, 1.1e3, true}, 4).numbers, ElementsAre(1e-8, 1e-4, 1));
}

// Less than a factor of two: even steps, so that there are two numbers at least.
TEST(LogarithmicTics, NarrowRangesHaveEvenSteps) {
  EXPECT_THAT(logarithmic_tics({1.04, 1.31, true}, 5).numbers,
              ElementsAre(testing::DoubleEq(1.1), testing::DoubleEq(1.2), testing::DoubleEq(1.3)));
  for (const double lo : {1e-300, 0.0123, 1.0, 7.3e5, 1e300})
    for (const double factor : {1.000001, 1.01, 1.2, 1.9, 2.1, 9.0, 11.0, 1e3, 1e8})
      for (const int most : {4, 6, 10}) {
        const AxisRange range{lo, lo * factor, true};
        const AxisTics tics = logarithmic_tics(range, most);
        EXPECT_GE(tics.numbers.size(), 1u) << lo << " " << factor << " " << most;
        EXPECT_LE(tics.numbers.size(), std::size_t(most)) << lo << " " << factor << " " << most;
        for (const double v : tics.numbers) EXPECT_TRUE(v >= range.lo && v <= range.hi);
      }
}

TEST(FittedText, IsCutAtASignAndSaysSo) {
  EXPECT_EQ(fitted_text("short", 10, 100), "short");
  EXPECT_EQ(fitted_text("", 10, 0), "");
  const std::string cut = fitted_text("µµµµµµµµµµ", 10, 40);
  EXPECT_LE(text_width_px(cut, 10), 40);
  EXPECT_THAT(cut, testing::EndsWith("…"));
  EXPECT_EQ(cut.size() % 2, 1u);  // whole signs of two bytes, and one of three
  EXPECT_EQ(fitted_text("much too long", 10, 0), "…");
}

TEST(LinksOf, LieWhereThePointsAreDrawn) {
  Plot plot{"t", {"x", "", true}, {"y", "", false}, {}};
  plot.series = {{"a", {{1, 5}, {0, 6}, {10, 7}}}, {"b", {{3, 1}}}};
  plot.series[0].links = {
      {"first", "1.html"}, {"has no place on a logarithmic axis", "2.html"}, {"opens nothing", ""}};
  const PlotFiles files{false, 640, 480};
  const std::vector<FigureLink> links = links_of(plot, files);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].href, "1.html");
  EXPECT_EQ(links[0].words, "first");
  const layers::dvec2 at = plot_layout(plot, files).pixel({1, 5});
  EXPECT_EQ(links[0].x_px, at.x);
  EXPECT_EQ(links[0].y_px, at.y);
}

}  // namespace
}  // namespace talisman::sequences
