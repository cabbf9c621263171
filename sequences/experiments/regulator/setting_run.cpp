// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/setting_run.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sequences/experiments/regulator/cut_layers.h"
#include "sequences/experiments/statistics.h"

namespace talisman::sequences {
namespace {

Settings with(Settings settings, const RegulatorSetting& setting) {
  settings.regulator = setting.options;
  return settings;
}

Timing timing_of(const std::vector<FrameLine>& lines, double FrameTimes::*stage) {
  std::vector<double> ms;
  for (const FrameLine& line : lines) ms.push_back(line.times.*stage);
  if (ms.empty()) return {};
  return {std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size()), median(ms)};
}

}  // namespace

SettingRun::SettingRun(const Sequence& sequence, Settings settings, const RegulatorSetting& setting)
    : setting_(setting),
      seamed_(with_cut_layers(sequence, setting.cut), with(settings, setting)),
      pipeline_(make_pipeline(*seamed_.sequence().scene, seamed_.sequence().layers,
                              with(std::move(settings), setting))),
      state_(pipeline_),
      summary_(start_summary(pipeline_, sequence.name)) {}

void SettingRun::advance(int frame, const chunker::PreparedScene* prepared) {
  layers_before_.clear();
  for (const ShownSprite& sprite : report_.shown) layers_before_.push_back(sprite.layer);
  report_ = step(pipeline_, state_, frame, prepared ? &seamed_.prepared(*prepared) : nullptr);
  before_ = std::move(now_);
  now_ = prepared ? to_image8(report_.picture) : Image8{};
}

void SettingRun::count() {
  add_decisions(summary_, report_, state_);
  summary_.frames.push_back(line_of(report_));
  for (const regulator::LayerDecision& decision : report_.plan.decisions) chunks_ += decision.cost.chunks;
  for (const ShadowMapRow& map : report_.shadow_maps) chunks_ += map.decision.cost.chunks;
}

void SettingRun::judge(const ConsecutiveFrames& truth) {
  drawn_.push_back(summary_.frames.back());
  qualities_.push_back({std::to_string(report_.frame), compare(now_, truth.now)});
  if (before_.rgb.empty() || truth.before.rgb.empty()) return;
  popping_.add({before_, now_}, truth,
               stepping_pixels(layers_before_, report_, state_.sprites, pipeline_.settings.view.display_px));
}

SettingResult SettingRun::result() const {
  SettingResult result;
  result.setting = setting_;
  result.mean_update_rate = summary_.mean_update_rate();
  result.weighted_update_rate = summary_.cost_weighted_update_rate();
  result.polygons = summary_.polygons_rendered();
  result.pixels = summary_.pixels_rendered();
  result.chunks = chunks_;
  double error_px = 0;
  int shown = 0;
  for (const LayerSummary& layer : summary_.layers) {
    result.renders += layer.renders;
    error_px += layer.sum_geometric_px;
    shown += layer.frames_shown;
    result.max_geometric_px = std::max(result.max_geometric_px, layer.max_geometric_px);
  }
  result.mean_geometric_px = shown > 0 ? error_px / shown : 0;
  result.plan = timing_of(summary_.frames, &FrameTimes::plan_ms);
  result.render = timing_of(drawn_, &FrameTimes::render_ms);
  result.composite = timing_of(drawn_, &FrameTimes::composite_ms);
  for (const FrameLine& line : drawn_) result.modelled_ms += line.modelled_ms;
  if (!drawn_.empty()) result.modelled_ms /= static_cast<double>(drawn_.size());
  result.quality = summarize(qualities_).mean;
  result.popping = popping_.result();
  return result;
}

}  // namespace talisman::sequences
