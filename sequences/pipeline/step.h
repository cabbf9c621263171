// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One frame of the pipeline: the only place where the decision side (layers, warp, fiducials, regulator) and
/// the pixel side (chunker) meet.
///
///   scene.at(t) → capture → order → correspond → fit → assess → regulate → [render →] [composite →] report
///
/// Without a `PixelSide` a frame is planned and nothing is drawn; the decisions are the same. A frame may
/// also be planned while its pictures are left for later: a sprite that was planned but not drawn is drawn,
/// as of the instant for which it was planned, when a frame that must be shown needs it. From this follow
/// --frames and --resume: any frame of a sequence comes out with the same bytes, however it is reached.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "chunker/render.h"
#include "layers/layer.h"
#include "layers/polyhedron.h"
#include "layers/sprite_transform.h"
#include "layers/state.h"
#include "regulator/budget.h"
#include "regulator/plan.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/bound_table.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/sprite_compression.h"
#include "warp/fit.h"

namespace talisman::sequences {

struct Settings {
  regulator::RegulatorOptions regulator;
  warp::Curve curve = warp::Curve::aff;
  warp::FitOptions fit;
  layers::View view;
  layers::BoundKind bound = layers::BoundKind::Box8;
  layers::ExtentOptions extents;  ///< expected_reuse_frames is the default of policies that do not fix it
  layers::PlacementOptions placement;  ///< resolution_scale is multiplied with the layer's own
  chunker::RenderOptions render;
  std::optional<chunker::CompressionOptions> compression;  ///< empty: sprites are kept as they are
  std::vector<layers::ExplicitPair> explicit_order;        ///< of layer ids; before geometry
  Cycles cycles = Cycles::Merge;
  Compositor compositor = Compositor::Talisman;  ///< Extended: sequences/pipeline/resolved_cycles.h
  double fps = 24;
  int frames = 0;  ///< length of the sequence, however few of its frames are asked for; needed by the
                   ///< policies that look ahead (Lookahead, Oracle), whose runs it ends
  bool budget_gap = false;  ///< Budget: also compute the best choice of each frame (regulator/budget.h);
                            ///< costs up to some ms a frame, and changes no decision
};

/// What does not change during a run. Keeps references.
struct Pipeline {
  Pipeline(const layers::Scene& scene, const layers::LayerSet& layers, const Settings& settings);
  /// The same with more layers behind those of `authored`: aggregates.
  Pipeline(const Pipeline& authored, const layers::LayerSet& layers, BoundTable bounds);
  const layers::Scene& scene;
  const layers::LayerSet& layers;
  Settings settings;
  BoundTable bounds;                 ///< one per layer
  std::vector<int> moving_carriers;  ///< by node (layers/animation.h); empty unless light is followed
  bool sorts_visibility = false;     ///< the effect visibility_sort is called for
};

/// What is remembered of one layer: how it was at the instant as of which it was last rendered.
struct LayerMemory {
  std::optional<layers::LayerState> then;  ///< empty: never rendered
  layers::SpritePlacement placement;
  int frame_rendered = -1;  ///< when the work was done
  int depicts_frame = -1;   ///< as of which instant `then` is; later (or earlier) with Lookahead and Oracle
  bool drawn = false;       ///< the sprite store holds that picture (false: planned only)
  double resolution = 1;    ///< of the sprite, relative to what the layer's author asks for
  bool predicted = false;   ///< `then` was extrapolated in frame_rendered, it is not the scene's own motion
  int frames_short_of_area = 0;  ///< frames in a row in which it was deferred for want of pixels or chunks
};

/// What is known of one frame of the motion: the states of all layers, and where their sprites would lie as
/// far as that was asked for.
struct CapturedFrame {
  std::vector<layers::LayerState> states;                          ///< by layer id
  std::vector<std::optional<layers::SpritePlacement>> placements;  ///< by layer id
  int generation = -1;  ///< OrderMemory::generation: aggregates that exist since then are not captured yet
  std::vector<ShadowMapKey> shadow_maps;  ///< by light; empty where no shadow is called for
};

/// The last two frames of the motion, as far as a regulator that predicts knows it.
struct MotionKnown {
  int frame = 0;
  layers::SceneFrame before, now;  ///< `before` is `now` at frame 0
};

/// All that survives a frame.
struct PipelineState {
  explicit PipelineState(const Pipeline& pipeline) : memory(pipeline.layers.layers.size()) {}
  std::vector<LayerMemory> memory;  ///< by layer id, aggregates behind the author's layers
  chunker::SpriteStore sprites;     ///< as the compositor shows them: decompressed if they are compressed
  CompressedSprites compressed;     ///< empty unless Settings::compression asks for it
  OrderMemory order;
  ShadePlan shade_plan;
  ShadowMapStore shadow_maps;
  std::map<int, CapturedFrame> captured;  ///< by frame: this one and those looked at ahead, each once
  std::vector<CapturedFrame> forgotten;   ///< were captured; the next ones are captured in their memory
  int now = 0;                            ///< the frame that is planned: what lies ahead may be a prediction
  std::optional<MotionKnown> motion;      ///< what predictions are made from; empty unless they are made
  std::optional<regulator::RegulatorOptions> planned_with;  ///< `captured` was judged under these options
};

struct StageTimes {
  double plan_ms = 0, render_ms = 0, composite_ms = 0;
};

/// A sprite as it is shown in this frame, back to front.
struct ShownSprite {
  int layer = -1;
  layers::dmat3 screen_from_sprite{1.0};
  layers::ivec2 size_px{0, 0};
  int age_frames = 0;
  SpriteMultipliers multipliers;
};

struct FrameReport {
  int frame = 0;
  FrameOrder order;
  regulator::FramePlan plan;
  std::vector<regulator::LayerAssessment>
      assessments;                    ///< by layer id, aggregates behind the author's layers
  std::vector<ShownSprite> shown;     ///< back to front
  int layers_assessed = 0;            ///< in view with an old sprite: fitted and judged
  std::int64_t pixels_reference = 0;  ///< texels that `reference` would render for this frame
  chunker::RenderCounters render;     ///< summed over the layers rendered for this frame
  std::vector<chunker::RenderCounters> render_by_layer;  ///< by layer id; zero where nothing was drawn
  chunker::CompositeCounters composite;
  std::optional<CompressionReport> compression;  ///< of the sprites drawn for this frame, and of its reads
  std::int64_t sprite_bytes = 0;                 ///< of the sprites shown, as they are stored
  ShadeCounters shade;                           ///< passes behind shadows and reflections, as planned
  int late_renders = 0;  ///< sprites drawn now that had been planned for an earlier frame
  std::optional<regulator::BudgetGap> budget_gap;  ///< with Settings::budget_gap
  StageTimes times;
  chunker::Frame picture;  ///< empty when only planned
};

/// Plans frame `frame` and, if `prepared` is given, draws it. Frames come in order from 0; a frame may be
/// repeated, and (with policies that do not look ahead) frames may run backwards. The same `state` may be
/// carried on under other settings: sprites and what is known of them stay, what was planned ahead is planned
/// anew.
FrameReport step(const Pipeline& pipeline, PipelineState& state, int frame,
                 const chunker::PreparedScene* prepared);

/// The frame as the policies `direct` and `reference` show it, without touching any state: the truths of
/// --quality. The reference of one frame sorts it by itself: what a run still holds merged after a cycle, it
/// shows apart, which differs only where a pixel is covered in part.
chunker::Frame draw_direct(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared);
chunker::Frame draw_reference(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared);

}  // namespace talisman::sequences
