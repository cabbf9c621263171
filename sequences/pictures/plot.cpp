// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "layers/check.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/child_process.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;

/// Shortest text that reads back as the same double, independent of the locale.
std::string number(double v) {
  std::array<char, 40> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), v).ptr};
}

std::string csv_number(double v) { return std::isfinite(v) ? number(v) : std::string(); }

/// RFC 4180: quoted when it has to be, quotes doubled.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string with_unit(const PlotAxis& axis, const char* open, const char* close) {
  return axis.unit.empty() ? axis.label : axis.label + open + axis.unit + close;
}

/// A gnuplot string: single quotes know no escapes but the doubled quote; control characters become spaces.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + "'";
}

bool drawable(double v, const PlotAxis& axis) { return std::isfinite(v) && (!axis.logarithmic || v > 0); }
bool drawable(const PlotPoint& p, const Plot& plot) { return drawable(p.x, plot.x) && drawable(p.y, plot.y); }

bool anything_drawable(const PlotSeries& series, const Plot& plot) {
  for (const PlotPoint& p : series.points)
    if (drawable(p, plot)) return true;
  return false;
}

/// A blank line breaks the curve where a point cannot be drawn.
std::string data_block(const PlotSeries& series, const Plot& plot, std::size_t index) {
  std::string block = "$data" + std::to_string(index) + " << END_OF_DATA\n";
  for (const PlotPoint& p : series.points)
    block += drawable(p, plot) ? number(p.x) + " " + number(p.y) + "\n" : "\n";
  return block + "END_OF_DATA\n";
}

const char* style_words(SeriesStyle style) {
  switch (style) {
    case SeriesStyle::Line:
      return "lines";
    case SeriesStyle::Points:
    case SeriesStyle::Cloud:
      return "points";
    case SeriesStyle::LinePoints:
      return "linespoints";
    case SeriesStyle::Steps:
      return "steps";
  }
  return "lines";
}

/// Okabe & Ito 2008, without yellow (too pale on white) and with black last.
constexpr std::array kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};
/// Filled circle, square, triangles, diamond; then hollow ones.
constexpr std::array kMarkers = {7, 5, 9, 13, 11, 6, 4};

std::string curve(const PlotSeries& series, std::size_t index) {
  std::string color = kColors[index % kColors.size()];
  if (series.style == SeriesStyle::Cloud) color.insert(1, "A0");  // gnuplot: two digits of transparency first
  std::string text = "$data" + std::to_string(index) + " using 1:2 with " + style_words(series.style) +
                     " linecolor rgb '" + color + "'";
  if (series.style == SeriesStyle::Cloud) text += " pointtype 7 pointsize 0.35";
  if (series.style != SeriesStyle::Points && series.style != SeriesStyle::Cloud) {
    text += " linewidth 2";
    if (index >= kColors.size()) text += " dashtype " + std::to_string(1 + index / kColors.size());
  }
  if (series.style == SeriesStyle::Points || series.style == SeriesStyle::LinePoints)
    text += " pointtype " + std::to_string(kMarkers[index % kMarkers.size()]) + " pointsize 0.7";
  return text + " title " + quoted(series.name);
}

/// What is written beside the points, in the colour of the series; slanted, so that neighbours do not run
/// into each other.
std::string label_words(const PlotSeries& series, const Plot& plot, std::size_t index) {
  std::string text;
  for (std::size_t i = 0; i < series.labels.size(); ++i) {
    const PlotPoint& p = series.points[i];
    if (series.labels[i].empty() || !drawable(p, plot)) continue;
    text += "set label " + quoted(series.labels[i]) + " at " + number(p.x) + "," + number(p.y) +
            " offset 0.5,0.5 rotate by 40 font 'Helvetica,11' textcolor rgb '" +
            kColors[index % kColors.size()] + "'\n";
  }
  return text;
}

std::string axis_words(const char* which, const PlotAxis& axis) {
  std::string text = std::string("set ") + which + "label " + quoted(with_unit(axis, " (", ")")) + "\n";
  if (axis.logarithmic) text += std::string("set logscale ") + which + "\nset format " + which + " '%g'\n";
  return text;
}

/// gnuplot refuses a plot without points; an empty picture that says so is more useful than none.
std::string empty_plot(const Plot& plot) {
  std::string text = "set label 'no data' at graph 0.5, graph 0.5 center\n";
  for (const auto& [which, axis] : {std::pair{"x", plot.x}, std::pair{"y", plot.y}})
    text += std::string("set ") + which + (axis.logarithmic ? "range [1:10]\n" : "range [0:1]\n");
  return text + "plot NaN notitle\n";
}

}  // namespace

std::string plot_csv(const Plot& plot) {
  std::string csv = "series," + csv_text(with_unit(plot.x, " [", "]")) + "," +
                    csv_text(with_unit(plot.y, " [", "]")) + "\n";
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& p : series.points)
      csv += csv_text(series.name) + "," + csv_number(p.x) + "," + csv_number(p.y) + "\n";
  return csv;
}

std::string plot_script(const Plot& plot, const PlotFiles& files) {
  TALISMAN_CHECK(files.width_px >= 100 && files.width_px <= 10000);
  TALISMAN_CHECK(files.height_px >= 100 && files.height_px <= 10000);
  std::string script =
      "set encoding utf8\nset terminal svg noenhanced font 'Helvetica,14' background rgb 'white' size " +
      std::to_string(files.width_px) + "," + std::to_string(files.height_px) + "\n";
  script +=
      "set border 3 linecolor rgb '#404040'\nset tics nomirror\nset grid linecolor rgb '#b0b0b0' linewidth "
      "0.5\n";
  script += "set key outside right top Left reverse\nset title " + quoted(plot.title) + "\n";
  script += axis_words("x", plot.x) + axis_words("y", plot.y);
  std::string curves;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    if (!anything_drawable(plot.series[i], plot)) continue;
    TALISMAN_CHECK(plot.series[i].labels.empty() ||
                   plot.series[i].labels.size() == plot.series[i].points.size());
    script += data_block(plot.series[i], plot, i) + label_words(plot.series[i], plot, i);
    curves += (curves.empty() ? "plot " : ", \\\n     ") + curve(plot.series[i], i);
  }
  return script + (curves.empty() ? empty_plot(plot) : curves + "\n");
}

void write_plot(const std::string& dir, const std::string& name, const Plot& plot, const PlotFiles& files) {
  const fs::path base = fs::path(dir) / name;
  const std::string svg = base.string() + ".svg", script = plot_script(plot, files);
  write_text_atomically(base.string() + ".csv", plot_csv(plot));
  if (files.script) write_text_atomically(base.string() + ".gp", script);
  write_atomically(svg, [&](const std::string& temporary) {
    const std::string input = temporary + ".gp";
    write_text_atomically(input, script);
    const ChildResult child = run_child({"gnuplot"}, {{}, input, temporary});
    std::error_code ignored;
    fs::remove(input, ignored);
    if (!child.succeeded()) throw OutputError(svg + ": gnuplot failed: " + child.reason());
    if (fs::file_size(temporary, ignored) == 0 || ignored)
      throw OutputError(svg + ": gnuplot drew nothing: " + child.reason());
  });
}

}  // namespace talisman::sequences
