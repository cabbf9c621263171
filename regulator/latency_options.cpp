// SPDX-License-Identifier: Apache-2.0
#include "regulator/latency_options.h"

#include <cstdio>

namespace talisman::regulator {

namespace {

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace

std::string_view name(Prediction prediction) {
  switch (prediction) {
    case Prediction::Known:
      return "known";
    case Prediction::Held:
      return "held";
    case Prediction::Linear:
      return "linear";
    case Prediction::Kalman:
      return "kalman";
  }
  return "?";
}

std::optional<Prediction> prediction_from_name(std::string_view text) {
  for (const Prediction prediction : kAllPredictions)
    if (name(prediction) == text) return prediction;
  return std::nullopt;
}

bool is_late(const LatencyOptions& options) {
  return options.render_ms > 0 && options.predict != Prediction::Known;
}

bool warps_last(const LatencyOptions& options) {
  return is_late(options) && options.warp_ms < options.render_ms;
}

// The comparisons are written so that NaN breaks each rule.
std::string first_defect(const LatencyOptions& options) {
  if (!(options.render_ms >= 0 && options.render_ms <= kLongestLatency_ms))
    return "latency_ms is " + number_text(options.render_ms) + ", must be from 0 to " +
           number_text(kLongestLatency_ms);
  if (options.warp_ms == kNoLastWarp_ms) return {};
  if (!(options.warp_ms >= 0 && options.warp_ms <= options.render_ms))
    return "latency_warp_ms is " + number_text(options.warp_ms) +
           ", must be from 0 to latency_ms, which is " + number_text(options.render_ms) +
           ": the last warp knows no older pose than the picture";
  return {};
}

}  // namespace talisman::regulator
