// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is known of one frame when it is done: its order, its plan, what was shown, what it took, and its
/// picture.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "chunker/render.h"
#include "regulator/budget.h"
#include "regulator/plan.h"
#include "sequences/pipeline/frame_order.h"
#include "sequences/pipeline/latency/latency_report.h"
#include "sequences/pipeline/layer_table.h"
#include "sequences/pipeline/lookahead_report.h"
#include "sequences/pipeline/predictive/predictive_report.h"
#include "sequences/pipeline/refresh/refresh_report.h"
#include "sequences/pipeline/shade_memory.h"
#include "sequences/pipeline/sprite_compression.h"

namespace talisman::sequences {

/// What a layer's sprite is multiplied with where it is shown.
struct SpriteMultipliers {
  float alpha = 1;              ///< all four channels
  layers::vec3 color{1, 1, 1};  ///< colour alone
};

struct StageTimes {
  double plan_ms = 0, render_ms = 0, composite_ms = 0;
};

/// What is left of the sprite before, beside a fresh one (sequences/pipeline/cross_fading.h).
struct FadingOut {
  double share = 0;                       ///< (0, 1)
  layers::dmat3 screen_from_sprite{1.0};  ///< of the old sprite
  layers::dvec3 color{1, 1, 1};           ///< its multiplier
};

/// A sprite as it is shown in this frame, back to front.
struct ShownSprite {
  int layer = -1;
  layers::dmat3 screen_from_sprite{1.0};
  layers::ivec2 size_px{0, 0};
  int age_frames = 0;
  SpriteMultipliers multipliers;   ///< without those of the colour warp where it is mixed with an old one
  std::optional<FadingOut> old{};  ///< with which it is mixed
  bool steps = false;              ///< drawn for this frame, or its share is not that of the frame before
  /// Of a Light layer: how far its light falls beside its base (sequences/pipeline/light_beside.h), px.
  std::optional<double> beside_base_px{};
};

/// A shadow map as a row of the tables, beside the layers.
struct ShadowMapRow {
  std::string name;  ///< "shadow map of sun"; that of no layer
  int light = -1;    ///< index into Scene::lights
  regulator::LayerAssessment assessment;
  regulator::LayerDecision decision;  ///< its cost is that of all pictures drawn for this frame
  int parts = 0;                      ///< that cast
  int pictures = 0;                   ///< drawn for this frame; more than one only with Lookahead and Oracle
  layers::ivec2 size_px{0, 0};
};

struct FrameReport {
  int frame = 0;
  layers::ivec2 display_px{0, 0};
  LayerTable layers;  ///< that the ids of this report mean
  FrameOrder order;
  regulator::FramePlan plan;
  std::vector<regulator::LayerAssessment>
      assessments;                 ///< by layer id, aggregates behind the author's layers
  std::vector<ShownSprite> shown;  ///< back to front
  int layers_assessed = 0;         ///< in view with an old sprite: fitted and judged
  regulator::LayerCost reference;  ///< polygons and pixels that `reference` would render for this frame
  chunker::RenderCounters render;  ///< summed over the layers rendered for this frame
  std::vector<chunker::RenderCounters> render_by_layer;  ///< by layer id; zero where nothing was drawn
  chunker::CompositeCounters composite;
  std::optional<CompressionReport> compression;  ///< of the sprites drawn for this frame, and of its reads
  std::int64_t sprite_bytes = 0;                 ///< of the sprites shown, as they are stored
  std::optional<std::int64_t> upload_bytes;      ///< of frames of moving pictures, where the scene has any
  ShadeCounters shade;                           ///< passes behind shadows and reflections, as planned
  std::vector<ShadowMapRow> shadow_maps;         ///< one per light that has a map
  double depth_complexity = 1;                   ///< by which a budget of ms was divided
  std::int64_t blended_pixels = 0;               ///< texels of third sprites, part of their layers' costs
  chunker::RenderCounters late_chunks;           ///< drawn now, of sprites rendered for an earlier frame
  int late_renders = 0;  ///< sprites drawn now that had been planned for an earlier frame
  std::optional<regulator::BudgetGap> budget_gap;  ///< with Settings::budget_gap
  std::optional<PredictiveReport> predictive;      ///< of that policy
  std::optional<LookaheadReport> lookahead;        ///< of the policies that look ahead
  std::optional<RefreshReport> refresh;            ///< of a run that draws chunks alone
  std::optional<LateDisplay> late;                 ///< of a run that knows old poses only
  StageTimes times;
  chunker::Frame picture;  ///< empty when only planned
};

}  // namespace talisman::sequences
