// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot_links.h"

#include "layers/check.h"
#include "sequences/pictures/plot_layout.h"

namespace talisman::sequences {

std::vector<FigureLink> links_of(const Plot& plot, const PlotFiles& files) {
  const PlotLayout layout = plot_layout(plot, files);
  std::vector<FigureLink> links;
  for (const PlotSeries& series : plot.series) {
    TALISMAN_CHECK(series.links.empty() || series.links.size() == series.points.size());
    for (std::size_t k = 0; k < series.links.size(); ++k) {
      if (series.links[k].href.empty() || !drawable(series.points[k], plot)) continue;
      const layers::dvec2 at = layout.pixel(series.points[k]);
      links.push_back({at.x, at.y, series.links[k].words, series.links[k].href});
    }
  }
  return links;
}

}  // namespace talisman::sequences
