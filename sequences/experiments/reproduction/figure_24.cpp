// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/figure_24.h"

#include <algorithm>

#include "sequences/experiments/reproduction/moving_average.h"
#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kChickenLayers = 80;
constexpr double kLeastArea = 0.40, kMostArea = 0.50, kRounding = 0.005;

std::string chicken() {
  const PaperSequence sequence = chicken_sequence();
  if (sequence.name.empty()) throw InputError("there is no sequence 'chicken'");
  return sequence.name;
}

PlanOf at_full_resolution() {
  PlanOf of = reference_plan(chicken());
  of.full_resolution = true;
  return of;
}

double texels_of(const PlannedRun& run) { return static_cast<double>(run.summary.pixels_rendered()); }

PixelUse pixel_use(PaperBench& bench) {
  bench.plan_all({own_plan(chicken()), reference_plan(chicken()), at_full_resolution()});
  return {texels_of(bench.plan(own_plan(chicken()))), texels_of(bench.plan(reference_plan(chicken()))),
          texels_of(bench.plan(at_full_resolution()))};
}

SpriteResolutions resolutions(PaperBench& bench) {
  SpriteResolutions sprites;
  const OpenSequence& open = bench.sequence(chicken());
  for (const layers::Layer& layer : open.sequence.layers.layers)
    sprites.scales.push_back(open.settings.placement.resolution_scale * layer.preferences.resolution_scale);
  for (const LayerSummary& layer : bench.plan(own_plan(chicken())).summary.layers)
    if (layer.is_aggregate) sprites.aggregates.push_back(layer.name);
  return sprites;
}

/// Which layers take most of it?
std::string dearest_layers(PaperBench& bench) {
  const Summary& summary = bench.plan(own_plan(chicken())).summary;
  std::vector<const LayerSummary*> rows = summary.rows();
  constexpr std::size_t kShown = 4;
  const std::size_t shown = std::min(kShown, rows.size());
  std::partial_sort(rows.begin(), rows.begin() + shown, rows.end(),
                    [](auto* a, auto* b) { return a->render_ms > b->render_ms; });
  std::string text = "dearest:";
  for (std::size_t k = 0; k < shown; ++k)
    text += (k > 0 ? ", '" : " '") + rows[k]->name + "' " + fixed(100 * summary.share_of_cost(*rows[k]), 0) +
            " % of the drawing time, drawn in " +
            fixed(100 * rows[k]->drawn_rate(static_cast<int>(summary.frames.size())), 0) + " % of the frames";
  return text;
}

template <typename Data>
Claim chicken_claim(const char* id, const char* paper, const char* rule, Data (*measure)(PaperBench&),
                    Finding (*test)(const Data&)) {
  Claim claim{id, paper, rule, [=](PaperBench& bench) { return test(measure(bench)); }, dearest_layers};
  claim.sequence = chicken_sequence().name;
  claim.must = chicken_sequence().is_papers_own;
  return claim;
}

std::vector<PaperFigure> chicken_drawings(PaperBench& bench) {
  const auto number = [](const FrameLine& line) { return static_cast<double>(line.pixels.rendered); };
  Plot plot{"pixels rendered (" + chicken() + "), 15-frame moving averages",
            {"frame in the middle of 15", "", false},
            {"texels", "1e6", false, true},
            {}};
  for (const auto& [name, of] : {std::pair{"drawn on demand", own_plan(chicken())},
                                 std::pair{"every frame", reference_plan(chicken())},
                                 std::pair{"every frame, full resolution", at_full_resolution()}}) {
    PlotSeries series{name, {}, SeriesStyle::Line};
    const std::vector<double> averages = moving_average(by_frame(bench.plan(of), number));
    for (std::size_t k = 0; k < averages.size(); ++k)
      series.points.push_back({static_cast<double>(k + kWindow_frames / 2), averages[k] / 1e6});
    plot.series.push_back(series);
  }
  return {{"LS97-24", "Fig. 24 is a picture; these are the texels of " + chicken(), plot}};
}

bool has_word(const std::string& name, const char* word) { return name.find(word) != std::string::npos; }

Finding share_at_most(double part, double whole, double most, const char* name) {
  const double share = whole > 0 ? part / whole : 1;
  return {fixed(100 * share, 1) + " %", part > 0 && share <= most, {{name, share}}};
}

}  // namespace

Finding layer_count(const SpriteResolutions& sprites) {
  return {std::to_string(sprites.scales.size()),
          sprites.scales.size() == kChickenLayers,
          {{"layers", static_cast<double>(sprites.scales.size())}}};
}

Finding reduced_layers(const SpriteResolutions& sprites) {
  int reduced = 0, others = 0;
  double least = 1, most = 0;
  for (const double scale : sprites.scales) {
    if (scale >= 1) continue;
    const double area = scale * scale;
    least = std::min(least, area);
    most = std::max(most, area);
    (area >= kLeastArea - kRounding && area <= kMostArea + kRounding ? reduced : others) += 1;
  }
  if (reduced + others == 0) return {"none is reduced", false, {}};
  return {std::to_string(reduced + others) + " layers at " + fixed(100 * least, 0) + " to " +
              fixed(100 * most, 0) + " % by area" +
              (others > 0 ? ", " + std::to_string(others) + " outside" : ""),
          others == 0,
          {{"reduced", reduced}, {"outside", others}}};
}

Finding wing_and_tailgate(const SpriteResolutions& sprites) {
  std::string all;
  bool found = false;
  for (const std::string& name : sprites.aggregates) {
    all += (all.empty() ? "" : "; ") + name;
    found = found || (has_word(name, "wing") && has_word(name, "tailgate"));
  }
  return {all.empty() ? "no sprite is shared" : all, found, {{"shared", double(sprites.aggregates.size())}}};
}

Finding pixels_of_reference(const PixelUse& use) {
  return share_at_most(use.drawn, use.reference, 0.60, "share");
}
Finding pixels_of_full(const PixelUse& use) { return share_at_most(use.drawn, use.full, 0.30, "share"); }

Item figure_24() {
  return {"24",
          "Fig. 24: chicken crossing",
          {chicken_claim("layers", "80 layers", "as many", resolutions, layer_count),
           chicken_claim("resolution", "most sprites at 40 to 50 % of the display",
                         "by area, all that are reduced", resolutions, reduced_layers),
           chicken_claim("cycle", "wing and tailgate share a sprite", "an aggregate of both", resolutions,
                         wing_and_tailgate),
           chicken_claim("of-reference", "drawn on demand: a part of every frame's pixels",
                         "at most 60 % at the same resolutions", pixel_use, pixels_of_reference),
           chicken_claim("of-full", "and of those at the display's resolution", "at most 30 %", pixel_use,
                         pixels_of_full)},
          chicken_drawings};
}

}  // namespace talisman::sequences
