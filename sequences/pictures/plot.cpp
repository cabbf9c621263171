// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "layers/check.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/child_process.h"
#include "sequences/pictures/plot_layout.h"

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
    case SeriesStyle::Bars:
      return "boxes";
  }
  return "lines";
}

// --- Colours, dashes and markers

/// Okabe & Ito 2008, without yellow (too pale on white) and with black last; then wine, indigo, olive, grey
/// and dark green of Tol's palettes.
constexpr std::array kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00",
                                "#000000", "#882255", "#332288", "#999933", "#888888", "#225522"};
/// Filled circle, square, triangles, diamond, pentagon; then the hollow ones.
constexpr std::array kMarkers = {7, 5, 9, 13, 11, 15, 6, 4, 8, 12, 10, 14};

/// How a series looks: indices of the tables above, and which of those of its colour it is.
struct Look {
  std::size_t color = 0, marker = 0;
  int dash = 1;
};

std::vector<Look> looks_of(const Plot& plot) {
  std::vector<Look> looks;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const int wanted = plot.series[i].color;
    Look look{(wanted >= 0 ? static_cast<std::size_t>(wanted) : i) % kColors.size(), i % kMarkers.size(), 1};
    for (const Look& other : looks)
      if (other.color == look.color) look.dash = std::max(look.dash, other.dash + 1);
    const auto taken = [&] {
      return std::any_of(looks.begin(), looks.end(), [&](const Look& other) {
        return other.color == look.color && other.marker == look.marker;
      });
    };
    for (std::size_t tries = 0; tries < kMarkers.size() && taken(); ++tries)
      look.marker = (look.marker + 1) % kMarkers.size();
    looks.push_back(look);
  }
  return looks;
}

bool has_line(SeriesStyle style) {
  return style == SeriesStyle::Line || style == SeriesStyle::LinePoints || style == SeriesStyle::Steps;
}
/// Those that are drawn first are larger, so that they show where later ones lie on them.
double marker_size_of(std::size_t index, std::size_t all) {
  constexpr double kLargest = 1, kSmallest = 0.65;
  return all > 1 ? kLargest + (kSmallest - kLargest) * double(index) / double(all - 1) : 0.7;
}

std::string curve(const PlotSeries& series, const Look& look, std::size_t index, double marker_size,
                  const std::string& title) {
  std::string color = kColors[look.color];
  if (series.style == SeriesStyle::Cloud) color.insert(1, "A0");  // gnuplot: two digits of transparency first
  std::string text = "$data" + std::to_string(index) + " using 1:2 with " + style_words(series.style) +
                     " linecolor rgb '" + color + "'";
  if (series.style == SeriesStyle::Cloud) text += " pointtype 7 pointsize 0.35";
  if (has_line(series.style)) {
    text += " linewidth 2";
    if (look.dash > 1) text += " dashtype " + std::to_string(look.dash);
  }
  if (has_markers(series.style))
    text += " pointtype " + std::to_string(kMarkers[look.marker]) + " pointsize " + number(marker_size);
  return text + " title " + quoted(title);
}

// --- Points of few samples

/// White points over the markers, and what they mean.
void add_hollow_points(const Plot& plot, std::string& script, std::string& curves) {
  std::string block;
  for (const PlotSeries& series : plot.series)
    for (std::size_t i = 0; i < series.points.size(); ++i)
      if (few_samples(series, i, plot))
        block += number(series.points[i].x) + " " + number(series.points[i].y) + "\n";
  if (block.empty()) return;
  script += "$few << END_OF_DATA\n" + block + "END_OF_DATA\n";
  curves += ", \\\n     $few using 1:2 with points linecolor rgb 'white' pointtype 7 pointsize 0.35 notitle" +
            std::string(
                ", \\\n     keyentry with points linecolor rgb '#404040' pointtype 6 pointsize 0.6 title ") +
            quoted(few_samples_words());
}

// --- Labels

/// A place of the picture, for gnuplot: from the lower left corner, the width and height 1.
std::string on_screen(double x_px, double y_px, const PlotFiles& files) {
  return "screen " + number(x_px / files.width_px) + ", screen " + number(1 - y_px / files.height_px);
}

/// Three quarters as bright: letters are thin.
std::string letter_color(const char* color) {
  std::string darker = "#";
  for (int channel = 0; channel < 3; ++channel) {
    const int value = std::stoi(std::string(color + 1 + 2 * channel, 2), nullptr, 16) * 3 / 4;
    for (const int digit : {value / 16, value % 16}) darker += "0123456789ABCDEF"[digit];
  }
  return darker;
}

/// The nearest place of the box to the point.
layers::dvec2 end_of_join(const PlotLabel& label) {
  const layers::RectI& box = label.box_px;
  return {std::clamp(label.point_px.x, double(box.x0), double(box.x1)),
          std::clamp(label.point_px.y, double(box.y0), double(box.y1))};
}

/// What is written beside the points, in the colour of the series, on a ground that pales what lies under it.
std::string label_words(const PlotLayout& layout, const std::vector<Look>& looks, const PlotFiles& files) {
  std::string text;
  for (const PlotLabel& label : layout.labels) {
    const char* color = kColors[looks[label.series].color];
    const layers::RectI& box = label.box_px;
    if (label.joined) {
      const layers::dvec2 end = end_of_join(label);
      text += "set arrow from " + on_screen(label.point_px.x, label.point_px.y, files) + " to " +
              on_screen(end.x, end.y, files) + " nohead front linewidth 0.7 linecolor rgb '" + color + "'\n";
    }
    text += "set object rectangle from " + on_screen(box.x0, box.y1, files) + " to " +
            on_screen(box.x1, box.y0, files) +
            " front fillcolor rgb 'white' fillstyle transparent solid 0.5 noborder\n";
    text += "set label " + quoted(label.text) + " at " +
            on_screen(box.x0 + 2, (box.y0 + box.y1) / 2.0, files) +
            " left front font 'Helvetica,11' textcolor rgb '" + letter_color(color) + "'\n";
  }
  if (layout.without_room > 0)
    text += "set label " + quoted(std::to_string(layout.without_room) + " labels have no room") + " at " +
            on_screen(layout.area_px.x1, files.height_px - 12, files) + " right font 'Helvetica,11'\n";
  return text;
}

// --- Axes

constexpr int kLegendGap_px = 10;  ///< between the axes and the legend
constexpr int kTic_px = 60;        ///< of an axis for one number

std::string tic_text(double v) {
  std::array<char, 40> text;
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), v, std::chars_format::general, 6).ptr};
}

std::string tic_words(const char* which, const AxisRange& range, int most) {
  const AxisTics tics = logarithmic_tics(range, most);
  std::string text;
  for (const double v : tics.numbers)
    text += (text.empty() ? "" : ", ") + quoted(tic_text(v)) + " " + number(v);
  for (const double v : tics.plain)
    if (std::find(tics.numbers.begin(), tics.numbers.end(), v) == tics.numbers.end())
      text += std::string(text.empty() ? "" : ", ") + "'' " + number(v) + " 1";
  return std::string("set ") + which + "tics (" + text + ")\n";
}

/// So that all names stand below each other: by itself gnuplot begins a second column, outside the picture.
std::string legend_rows_words(std::size_t rows, int room_px) {
  constexpr double kSpacing = 1, kRow_px = 21;  // gnuplot's own
  const double spacing = std::min(kSpacing, kSpacing * room_px / (kRow_px * static_cast<double>(rows)));
  return " maxrows " + std::to_string(rows) + " spacing " + number(spacing);
}

/// Slanted, so that they stand beside each other.
std::string name_tics(const char* which, const std::vector<std::string>& names) {
  constexpr double kRoom_px = 110;
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (text.empty() ? "" : ", ") + quoted(fitted_text(names[k], kLabelFont_px, kRoom_px)) + " " +
            std::to_string(k + 1);
  return std::string("set ") + which + "tics rotate by -40 font 'Helvetica,11' (" + text + ")\n";
}

std::string axis_words(const char* which, const PlotAxis& axis, const AxisRange& range, int length_px,
                       int most) {
  std::string text = std::string("set ") + which + "label " +
                     quoted(fitted_text(with_unit(axis, " (", ")"), kTextFont_px, length_px + 60)) + "\n";
  text += std::string("set ") + which + "range [" + number(range.lo) + ":" + number(range.hi) + "]\n";
  if (!axis.names.empty()) text += name_tics(which, axis.names);
  if (axis.logarithmic) text += std::string("set logscale ") + which + "\n" + tic_words(which, range, most);
  return text;
}

std::string margin_words(const layers::RectI& area, const PlotFiles& files) {
  const auto at = [](double px, int of) { return " at screen " + number(px / of) + "\n"; };
  return "set lmargin" + at(area.x0, files.width_px) + "set rmargin" + at(area.x1, files.width_px) +
         "set tmargin" + at(files.height_px - area.y0, files.height_px) + "set bmargin" +
         at(files.height_px - area.y1, files.height_px);
}

/// gnuplot refuses a plot without points; an empty picture that says so is more useful than none.
constexpr const char* kEmptyPlot = "set label 'no data' at graph 0.5, graph 0.5 center\nplot NaN notitle\n";

bool any_samples(const Plot& plot) {
  return std::any_of(plot.series.begin(), plot.series.end(),
                     [](const PlotSeries& series) { return !series.samples.empty(); });
}

}  // namespace

std::string plot_csv(const Plot& plot) {
  const bool samples = any_samples(plot);
  std::string csv = "series," + csv_text(with_unit(plot.x, " [", "]")) + "," +
                    csv_text(with_unit(plot.y, " [", "]")) + (samples ? ",samples\n" : "\n");
  for (const PlotSeries& series : plot.series)
    for (std::size_t i = 0; i < series.points.size(); ++i) {
      csv +=
          csv_text(series.name) + "," + csv_number(series.points[i].x) + "," + csv_number(series.points[i].y);
      if (samples) csv += "," + (series.samples.empty() ? "" : std::to_string(series.samples[i]));
      csv += "\n";
    }
  return csv;
}

std::string plot_script(const Plot& plot, const PlotFiles& files) {
  TALISMAN_CHECK(files.width_px >= 100 && files.width_px <= 10000);
  TALISMAN_CHECK(files.height_px >= 100 && files.height_px <= 10000);
  const PlotLayout layout = plot_layout(plot, files);
  const std::vector<Look> looks = looks_of(plot);
  const layers::RectI& area = layout.area_px;
  // The title stands over the middle of the axes, the names of the legend behind a sign.
  const double title_px =
      area.x0 + area.x1 < files.width_px ? area.x0 + area.x1 : 2 * files.width_px - area.x0 - area.x1;
  const double name_px = files.width_px - area.x1 - kLegendSign_px;
  std::string script =
      "set encoding utf8\nset terminal svg noenhanced font 'Helvetica,14' background rgb 'white' size " +
      std::to_string(files.width_px) + "," + std::to_string(files.height_px) + "\n";
  script +=
      "set border 3 linecolor rgb '#404040'\nset tics nomirror\nset grid linecolor rgb '#b0b0b0' linewidth "
      "0.5\n";
  script += "set key at " + on_screen(area.x1 + kLegendGap_px, area.y0, files) +
            " left top vertical Left reverse samplen 3" +
            legend_rows_words(plot.series.size() + 1, area.height()) + "\nset title " +
            quoted(fitted_text(plot.title, kTextFont_px, title_px)) + "\n";
  script += "set boxwidth 0.7\nset style fill solid 0.6 noborder\n";
  script += margin_words(area, files) +
            axis_words("x", plot.x, layout.x, area.width(), area.width() / kTic_px) +
            axis_words("y", plot.y, layout.y, area.height(), area.height() / kTic_px);
  std::string curves;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    TALISMAN_CHECK(series.labels.empty() || series.labels.size() == series.points.size());
    TALISMAN_CHECK(series.samples.empty() || series.samples.size() == series.points.size());
    if (!anything_drawable(series, plot)) continue;
    script += data_block(series, plot, i);
    curves += (curves.empty() ? "plot " : ", \\\n     ") +
              curve(series, looks[i], i, marker_size_of(i, plot.series.size()),
                    fitted_text(series.name, kTextFont_px, name_px));
  }
  if (curves.empty()) return script + kEmptyPlot;
  script += label_words(layout, looks, files);
  add_hollow_points(plot, script, curves);
  return script + curves + "\n";
}

void require_plotter() {
  const ChildResult child = run_child({"gnuplot", "--version"});
  if (!child.started)
    throw OutputError("plots: gnuplot cannot be started (" + child.output +
                      "); install the package gnuplot-nox");
  if (!child.succeeded()) throw OutputError("plots: gnuplot failed: " + child.reason());
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
