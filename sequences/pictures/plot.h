// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Curves as pictures, with the numbers beside them: NAME.svg drawn by gnuplot, and NAME.csv, one line per
/// point (`series,x,y`; the header names quantity and unit; `samples` as a fourth column where a series has
/// them).
///
/// The first seven colours are those of Okabe and Ito (told apart by colour-blind readers), five more follow;
/// no two of the first twelve series share one. Later ones, and those that ask for the colour of another,
/// differ in their dashes. Markers differ too, for grey print: no two series have one colour and one marker.
/// A point of few samples is hollow. Labels do not lie over each other (plot_layout.h).

#include <string>
#include <vector>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// A point that is not finite, or ≤ 0 on a logarithmic axis, leaves a gap in the curve.
struct PlotPoint {
  double x = 0, y = 0;
};

/// Cloud: small translucent points, of which there may be thousands. Bars: from 0 up to each point, 0.7 wide, so that
/// points one apart stand beside each other.
enum class SeriesStyle { Line, Points, LinePoints, Steps, Cloud, Bars };

/// What a point opens (plot_links.h). Neither in the picture nor in the CSV.
struct PointLink {
  std::string words, href;  ///< href empty: nothing
};

struct PlotSeries {
  std::string name;  ///< in the legend and in the CSV
  std::vector<PlotPoint> points;
  SeriesStyle style = SeriesStyle::LinePoints;
  std::vector<std::string> labels =
      {};                         ///< written beside the points, one for each; empty: none. Not in the CSV
  std::vector<int> samples = {};  ///< of how many each point is, one for each; empty: not told
  std::vector<PointLink> links = {};  ///< one for each; empty: none opens anything
  int color = -1;  ///< ≥ 0: that of the series of this index; else one of its own, while there are some
};

/// Points of fewer samples than this are hollow.
inline constexpr int kFewSamples = 10;

struct PlotAxis {
  std::string label;  ///< quantity: "update rate"
  std::string unit;   ///< "px", "ms", "%"; empty: none
  bool logarithmic = false;
  bool from_zero = false;               ///< 0 is on it; not of logarithmic ones
  std::vector<std::string> names = {};  ///< x: written at 1, 2, 3, … in the place of numbers; empty: numbers
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
};

struct PlotFiles {
  bool script = false;                  ///< also keep NAME.gp, the gnuplot input
  int width_px = 800, height_px = 500;  ///< of the picture; 100 … 10000
};

/// The CSV text. Numbers are written so that reading them gives the same doubles; not-a-number and infinity
/// as empty fields.
std::string plot_csv(const Plot& plot);

/// The gnuplot input; draws SVG to the standard output. No text of the plot can leave its quotes.
std::string plot_script(const Plot& plot, const PlotFiles& files = {});

/// Is there a gnuplot that answers? To be asked before what is plotted is measured. Throws OutputError.
void require_plotter();

/// Writes DIR/NAME.csv and DIR/NAME.svg (each whole or not at all). Throws OutputError: not writable, gnuplot
/// missing or failing.
void write_plot(const std::string& dir, const std::string& name, const Plot& plot,
                const PlotFiles& files = {});

}  // namespace talisman::sequences
