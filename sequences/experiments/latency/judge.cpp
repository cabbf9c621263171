// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/latency/judge.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/statistics.h"
#include "sequences/pictures/flip.h"
#include "sequences/pictures/quality.h"

namespace talisman::sequences {

namespace {

using layers::dvec2;

bool is_place(const dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

double ratio(double sum, std::int64_t of) { return of > 0 ? sum / static_cast<double>(of) : 0; }

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  return {quantile(values, 0.5), quantile(values, 0.95), *std::max_element(values.begin(), values.end())};
}

ShownJudge::ShownJudge(std::string name, bool is_whole, const layers::LayerSet& layers,
                       layers::ivec2 display_px)
    : display_px_(display_px), layers_(layers.layers.size()) {
  way_.name = std::move(name);
  way_.is_whole = is_whole;
  for (const layers::Layer& layer : layers.layers) way_.layers.push_back({layer.name, {}, 0, 0, 0, 0});
}

void ShownJudge::add_points(const std::vector<dvec2>& truth, const std::vector<dvec2>& shown,
                            OfLayer& layer) {
  dvec2 sum(0);
  int count = 0;
  for (std::size_t i = 0; i < std::min(truth.size(), shown.size()); ++i) {
    const dvec2& t = truth[i];
    const bool is_seen =
        t.x >= 0 && t.y >= 0 && t.x <= display_px_.x && t.y <= display_px_.y;  // false for NaN
    if (!is_seen || !is_place(shown[i])) continue;
    const dvec2 off = shown[i] - t;
    layer.px.push_back(std::hypot(off.x, off.y));
    sum += off;
    ++count;
  }
  if (count == 0) return layer.before.reset();
  const dvec2 mean = sum / static_cast<double>(count);
  if (layer.before) {
    layer.judder += std::hypot(mean.x - layer.before->x, mean.y - layer.before->y);
    ++layer.steps;
  }
  layer.before = mean;
}

void ShownJudge::add_picture(const TrueFrame& truth, const ShownFrame& shown) {
  const std::vector<float> flip = flip_map(shown.picture, truth.picture);
  ++drawn_;
  flip_ += mean(flip);
  for (std::size_t pixel = 0; pixel < flip.size(); ++pixel) {
    if (truth.layer[pixel] < 0) continue;
    OfLayer& layer = layers_[static_cast<std::size_t>(truth.layer[pixel])];
    layer.flip += static_cast<double>(flip[pixel]);
    layer.open += shown.is_open[pixel];
    ++layer.pixels;
    open_ += shown.is_open[pixel];
    ++pixels_;
  }
}

void ShownJudge::add(const TrueFrame& truth, const ShownFrame& shown) {
  ++frames_;
  for (std::size_t layer = 0; layer < layers_.size(); ++layer)
    add_points(truth.points[layer], shown.points[layer], layers_[layer]);
  for (const int age : shown.ages) {
    ages_.push_back(age);
    reused_ += age > 0;
  }
  if (!truth.picture.rgb.empty() && !shown.picture.rgb.empty()) add_picture(truth, shown);
}

ShownWay ShownJudge::result() const {
  ShownWay way = way_;
  way.polygons_per_frame = ratio(polygons_, frames_);
  way.reused = ratio(static_cast<double>(reused_), static_cast<std::int64_t>(ages_.size()));
  way.age_frames = spread_of(ages_);
  way.flip = ratio(flip_, drawn_);
  way.uncovered = ratio(open_, pixels_);
  std::vector<double> all;
  double judder = 0;
  std::int64_t steps = 0;
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const OfLayer& layer = layers_[k];
    way.layers[k].px = spread_of(layer.px);
    way.layers[k].judder_px = ratio(layer.judder, layer.steps);
    way.layers[k].flip = ratio(layer.flip, layer.pixels);
    way.layers[k].uncovered = ratio(layer.open, layer.pixels);
    way.layers[k].pixels = layer.pixels;
    all.insert(all.end(), layer.px.begin(), layer.px.end());
    judder += layer.judder;
    steps += layer.steps;
  }
  way.px = spread_of(std::move(all));
  way.judder_px = ratio(judder, steps);
  return way;
}

}  // namespace talisman::sequences
