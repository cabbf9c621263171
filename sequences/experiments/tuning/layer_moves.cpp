// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/tuning/layer_moves.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace talisman::sequences {

namespace {

using Weights = std::vector<double>;

/// A plan that gains less is not worth a picture.
constexpr double kLeastGain = 0.01;

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Entries of layer_specs that are drawn at all and have a limit, the dearest first.
std::vector<std::size_t> movable_layers(const PlannedThresholds& here) {
  std::vector<std::size_t> layers;
  for (std::size_t k = 0; k < here.layer_ms.size(); ++k)
    if (here.layer_ms[k] > 0 && here.thresholds.weights[k] > 0) layers.push_back(k);
  std::stable_sort(layers.begin(), layers.end(),
                   [&](std::size_t a, std::size_t b) { return here.layer_ms[a] > here.layer_ms[b]; });
  return layers;
}

Weights all_times(Weights weights, double factor) {
  for (double& weight : weights) weight = as_printed(weight * factor);
  return weights;
}

Weights one_times(Weights weights, std::size_t layer, double factor) {
  weights[layer] = as_printed(weights[layer] * factor);
  return weights;
}

std::vector<Weights> neighbours(const PlannedThresholds& here, MoveTowards towards) {
  const Weights& now = here.thresholds.weights;
  std::vector<std::size_t> layers = movable_layers(here);
  const bool has_others = layers.size() > 1;
  layers.resize(std::min(layers.size(), kMostMoved));
  std::vector<Weights> all;
  for (const double step : {2.0, 1.41421356}) {
    const double factor = towards == MoveTowards::Looser ? 1 / step : step;
    for (const std::size_t layer : layers) {
      all.push_back(one_times(now, layer, factor));
      if (!has_others) continue;
      Weights others = all_times(now, factor);
      others[layer] = now[layer];
      all.push_back(others);
      all.push_back(one_times(std::move(others), layer, 1 / factor));
    }
  }
  return all;
}

}  // namespace

std::vector<PlannedThresholds> layer_moves(const Sequence& sequence, const Settings& settings,
                                           const FrameRange& range, MoveTowards towards,
                                           const PlannedThresholds& here) {
  const auto measure = [towards](const PlannedThresholds& plan) {
    return towards == MoveTowards::Looser ? plan.cost_ms : total(plan.suspicion);
  };
  std::vector<PlannedThresholds> moves;
  for (Weights& weights : neighbours(here, towards)) {
    PlannedThresholds plan =
        plan_of(sequence, settings, range, {here.thresholds.geometric_px, std::move(weights)});
    if (measure(plan) < (1 - kLeastGain) * measure(here)) moves.push_back(std::move(plan));
  }
  std::stable_sort(moves.begin(), moves.end(), [&](const PlannedThresholds& a, const PlannedThresholds& b) {
    return measure(a) < measure(b);
  });
  return moves;
}

}  // namespace talisman::sequences
