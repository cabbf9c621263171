// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/shadow_appendix.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/factoring/prediction.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr int kShadowSteps = 64;
constexpr double kReceiver = 0.6, kBehind = 0.1;

double shadow_step(int k) { return k / double(kShadowSteps); }

chunker::LinearImage shadow_image(const std::function<chunker::LinearColor(double s, double beta)>& texel) {
  chunker::LinearImage image;
  image.size_px = {kShadowSteps + 1, kShadowSteps + 1};
  for (int y = 0; y <= kShadowSteps; ++y)
    for (int x = 0; x <= kShadowSteps; ++x) image.texels.push_back(texel(shadow_step(x), shadow_step(y)));
  return image;
}

/// Receiver and shadow as two sprites of one layer.
ShadedLayer shadowed_layer(double receiver) {
  const auto b = static_cast<float>(receiver);
  ShadedLayer layer;
  layer.unfactored = shadow_image([b](double s, double beta) {
    const float lit = static_cast<float>(s * beta) * b;
    return chunker::LinearColor{lit, lit, lit, static_cast<float>(beta)};
  });
  layer.terms.push_back({layers::LayerKind::Geometry, shadow_image([b](double, double beta) {
                           const float lit = static_cast<float>(beta) * b;
                           return chunker::LinearColor{lit, lit, lit, static_cast<float>(beta)};
                         })});
  layer.terms.push_back({layers::LayerKind::Shadow, shadow_image([](double s, double beta) {
                           return chunker::LinearColor{0, 0, 0, static_cast<float>((1 - s) * beta)};
                         })});
  return layer;
}

const std::vector<ShadowTexel>& shadow_measured(PaperBench& bench) {
  return bench.once("shadow texels", [] { return shadow_texels(kReceiver, kBehind); });
}

Claim shadow_claim(const char* id, const char* paper, const char* rule,
                   const std::function<Finding(const std::vector<ShadowTexel>&)>& test) {
  return {id, paper, rule, [test](PaperBench& bench) { return test(shadow_measured(bench)); }};
}

std::vector<PaperFigure> shadow_drawings(PaperBench& bench) {
  Plot plot{"shadow over a receiver: error of the frame",
            {"coverage of the receiver", "", false, true},
            {"error, linear light", "", false, true},
            {}};
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    PlotSeries series{formatted("s = %g", s), {}, SeriesStyle::Line};
    for (const ShadowTexel& texel : shadow_measured(bench))
      if (texel.s == s) series.points.push_back({texel.beta, texel.error});
    plot.series.push_back(series);
  }
  return {{"LS97-appendix", "Appendix: what is shown less what is wanted, receiver 0.6 over 0.1", plot}};
}

std::string error_words(double error) { return formatted("%.4f", error); }

}  // namespace

std::vector<ShadowTexel> shadow_texels(double receiver, double behind) {
  const ShadedLayer layer = shadowed_layer(receiver);
  const layers::vec3 background(static_cast<float>(behind));
  const chunker::Frame frame =
      composite_layers({&layer, 1}, {true}, {kShadowSteps + 1, kShadowSteps + 1}, background);
  std::vector<ShadowTexel> texels;
  for (int y = 0; y <= kShadowSteps; ++y)
    for (int x = 0; x <= kShadowSteps; ++x) {
      const double s = shadow_step(x), beta = shadow_step(y);
      const double wanted = s * beta * receiver + (1 - beta) * behind;
      const double shown = linear_of(frame.pixels[static_cast<std::size_t>(y) * (kShadowSteps + 1) + x]).x;
      texels.push_back({s, beta, shown - wanted, beta * (1 - beta) * (1 - s) * (receiver - behind)});
    }
  return texels;
}

Finding right_where_whole_or_lit(const std::vector<ShadowTexel>& texels) {
  double worst = 0;
  int count = 0;
  for (const ShadowTexel& texel : texels) {
    if (texel.s != 1 && texel.beta != 1) continue;
    worst = std::max(worst, std::abs(texel.error));
    ++count;
  }
  return {"at most " + error_words(worst) + " in " + std::to_string(count) + " texels",
          count > 0 && worst <= kShadowRounding,
          {{"worst", worst}}};
}

Finding wrong_as_the_formula_says(const std::vector<ShadowTexel>& texels) {
  double worst = 0;
  for (const ShadowTexel& texel : texels) worst = std::max(worst, std::abs(texel.error - texel.formula));
  return {"to " + error_words(worst), !texels.empty() && worst <= kShadowRounding, {{"worst", worst}}};
}

Finding worst_in_half_coverage(const std::vector<ShadowTexel>& texels, double receiver, double behind) {
  if (texels.empty()) return {"nothing", false, {}};
  const ShadowTexel worst = *std::max_element(
      texels.begin(), texels.end(), [](auto& a, auto& b) { return std::abs(a.error) < std::abs(b.error); });
  const double quarter = (receiver - behind) / 4;
  constexpr double kNearHalf = 0.1, kNearShadow = 0.05;
  return {error_words(worst.error) + formatted(" at s %.2f, coverage %.2f", worst.s, worst.beta),
          std::abs(worst.error - quarter) <= kShadowRounding && worst.s <= kNearShadow &&
              std::abs(worst.beta - 0.5) <= kNearHalf,
          {{"worst", worst.error}, {"s", worst.s}, {"coverage", worst.beta}}};
}

Item shadow_appendix() {
  return {"appendix",
          "Appendix: shadow sprites",
          {shadow_claim("right", "right where s = 1 or coverage is whole", "rounding of 8 bits",
                        right_where_whole_or_lit),
           shadow_claim("formula", "elsewhere wrong by (1 - s)(1 - b) b (B - T)", "to rounding",
                        wrong_as_the_formula_says),
           shadow_claim("worst", "the problem: shadow and partial coverage",
                        "a quarter of B - T in half coverage",
                        [](const std::vector<ShadowTexel>& texels) {
                          return worst_in_half_coverage(texels, kReceiver, kBehind);
                        })},
          shadow_drawings};
}

}  // namespace talisman::sequences
