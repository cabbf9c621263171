// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/figure_21.h"

#include <algorithm>

#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr const char* kSkyLayer = "sky";

CanyonRates canyon_measured(PaperBench& bench) {
  return canyon_rates(bench.plan(own_plan(canyon_sequence().name)).summary);
}

/// The one with the most polygons; null where there is no layer but the sky.
const SpriteRate* land_of(const CanyonRates& rates) {
  const SpriteRate* land = nullptr;
  for (const SpriteRate& sprite : rates.sprites)
    if (sprite.name != kSkyLayer && (!land || sprite.polygons > land->polygons)) land = &sprite;
  return land;
}

std::string rate_percent(double share) { return fixed(100 * share, 1) + " %"; }

Finding share_in_range(double value, double least, double most, const std::string& name) {
  return {rate_percent(value), value >= least && value <= most, {{name, value}}};
}

/// At which threshold would it be so, if at any?
std::string rates_at_other_thresholds(PaperBench& bench, Finding (*rule)(const CanyonRates&)) {
  std::string text;
  for (const double px : {1.0, 2.0, 6.0, 8.0, 16.0, 32.0}) {
    const Finding finding =
        rule(canyon_rates(bench.plan(threshold_plan(canyon_sequence().name, px)).summary));
    text +=
        (text.empty() ? "" : "; ") + formatted("%g px: ", px) + finding.ours + (finding.same ? " (yes)" : "");
  }
  return text;
}

Claim canyon_claim(const char* id, const char* paper, const char* rule, Finding (*test)(const CanyonRates&)) {
  Claim claim{id, paper, rule, [=](PaperBench& bench) { return test(canyon_measured(bench)); },
              [=](PaperBench& bench) { return rates_at_other_thresholds(bench, test); }};
  claim.sequence = canyon_sequence().name;
  claim.must = canyon_sequence().is_papers_own;
  return claim;
}

std::vector<PaperFigure> canyon_drawings(PaperBench& bench) {
  const CanyonRates rates = canyon_measured(bench);
  const std::string name = canyon_sequence().name;
  Plot plot{
      "average update rate (" + name + ")", {"sprite", "", false}, {"update rate", "%", false, true}, {}};
  PlotSeries bars{"renders per frame", {}, SeriesStyle::Bars};
  for (const SpriteRate& sprite : rates.sprites) {
    bars.points.push_back({static_cast<double>(bars.points.size() + 1), 100 * sprite.rate});
    plot.x.names.push_back(sprite.name);
  }
  plot.series.push_back(bars);
  return {{"LS97-21", "Fig. 21: " + name + ", renders of each sprite over the frames", plot}};
}

}  // namespace

CanyonRates canyon_rates(const Summary& summary) {
  CanyonRates rates;
  const int frames = static_cast<int>(summary.frames.size());
  for (const LayerSummary& layer : summary.layers)
    if (!layer.is_aggregate)
      rates.sprites.push_back(
          {layer.name, layer.polygons, layer.renders + layer.merged_renders, layer.drawn_rate(frames)});
  rates.mean = summary.mean_update_rate();
  rates.weighted = summary.cost_weighted_update_rate();
  const auto reference = static_cast<double>(summary.total([](auto& l) { return l.polygons.reference; }));
  rates.polygons = reference > 0 ? static_cast<double>(summary.polygons_rendered()) / reference : 0;
  return rates;
}

Finding mean_rate(const CanyonRates& rates) { return share_in_range(rates.mean, 1e-9, 0.25, "mean"); }
Finding weighted_rate(const CanyonRates& rates) {
  return share_in_range(rates.weighted, 0.25, 0.40, "weighted");
}
Finding polygon_share(const CanyonRates& rates) {
  return share_in_range(rates.polygons, 0.25, 0.42, "polygons");
}

Finding sky_once(const CanyonRates& rates) {
  for (const SpriteRate& sprite : rates.sprites)
    if (sprite.name == kSkyLayer)
      return {std::to_string(sprite.renders) + (sprite.renders == 1 ? " render" : " renders"),
              sprite.renders == 1,
              {{"renders", sprite.renders}}};
  return {"no layer 'sky'", false, {}};
}

Finding ship_parts(const CanyonRates& rates) {
  constexpr double kMost = 0.35;
  const SpriteRate* land = land_of(rates);
  double least = 1, most = 0;
  int parts = 0, outside = 0;
  for (const SpriteRate& sprite : rates.sprites) {
    if (&sprite == land || sprite.name == kSkyLayer) continue;
    ++parts;
    least = std::min(least, sprite.rate);
    most = std::max(most, sprite.rate);
    outside += sprite.rate > kMost;
  }
  if (parts == 0) return {"no layers beside sky and land", false, {}};
  return {fixed(100 * least, 1) + " to " + rate_percent(most) + " of " + std::to_string(parts) + " layers" +
              (outside > 0 ? ", " + std::to_string(outside) + " above 35 %" : ""),
          outside == 0,
          {{"least", least}, {"most", most}, {"layers", parts}, {"above", outside}}};
}

Finding land_most_often(const CanyonRates& rates) {
  const SpriteRate* land = land_of(rates);
  if (!land) return {"no land", false, {}};
  double others = 0;
  for (const SpriteRate& sprite : rates.sprites)
    if (&sprite != land) others = std::max(others, sprite.rate);
  return {"'" + land->name + "' " + rate_percent(land->rate) + ", others at most " + rate_percent(others),
          land->rate > others,
          {{"land", land->rate}, {"others", others}}};
}

Item figure_21() {
  return {"21",
          "Fig. 21: canyon flyby, update rate of each sprite",
          {canyon_claim("mean", "average update rate 19 %", "at most 25 %", mean_rate),
           canyon_claim("weighted", "weighted by polygons 32 %", "25 to 40 %", weighted_rate),
           canyon_claim("polygons", "about a third of the polygons drawn", "25 to 42 %", polygon_share),
           canyon_claim("sky", "the sky is rendered just once", "one render", sky_once),
           canyon_claim("ships", "parts of the ships 5 to 30 %", "each at most 35 %", ship_parts),
           canyon_claim("land", "a high rate for the landscape", "the highest of all", land_most_often)},
          canyon_drawings};
}

}  // namespace talisman::sequences
