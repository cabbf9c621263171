// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a run consist of? Its options, what does not change while it lasts, and all that survives a
/// frame. Data only, below the stages that read and write it; how a frame comes about is in
/// sequences/pipeline/step.h.

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "chunker/render.h"
#include "layers/layer.h"
#include "layers/sprite_transform.h"
#include "layers/state.h"
#include "regulator/chunk_refresh.h"
#include "regulator/plan.h"
#include "regulator/refresh_ledger.h"
#include "sequences/pipeline/culling/unshared.h"
#include "sequences/pipeline/culling/visibility.h"
#include "sequences/pipeline/frame_order.h"
#include "sequences/pipeline/layer_table.h"
#include "sequences/pipeline/order_memory.h"
#include "sequences/pipeline/regrouping/regroup_memory.h"
#include "sequences/pipeline/shade_memory.h"
#include "sequences/pipeline/sprite_compression.h"
#include "warp/fit.h"

namespace talisman::layers {
struct CellSet;     // layers/cells.h
class SceneMotion;  // layers/advance.h
}  // namespace talisman::layers

namespace talisman::sequences {

struct Settings {
  regulator::RegulatorOptions regulator;
  warp::Curve curve = warp::Curve::aff;
  bool layers_own_warps = true;  ///< a layer's own curve (LayerPreferences::warp) precedes `curve`
  warp::FitOptions fit;
  layers::View view;
  layers::BoundKind bound = layers::BoundKind::Box8;
  /// Samples of each body that deforms, or whose light is followed; 0 … 1024. More find what moves between
  /// the others (layers/surface_samples.h) and cost time in every fit.
  int material_points = layers::kDefaultMaterialPoints;
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
  /// Chunks of sprites are drawn when a frame first shows them (chunker/late_chunks.h): the same pictures for
  /// less. The counters, and the modelled time with them, are then of what was drawn, which is less than the
  /// hardware of [LS97] would. Without effect where all of a sprite is looked at: compression, fades of fresh
  /// sprites.
  bool late_chunks = false;
  /// Which tests decide what is looked at and drawn at all. More of them leave less to draw, and cost time.
  VisibilityOptions visibility;
  /// M ≥ 1: a frame is the mean of M pictures over its time (sequences/pipeline/accumulate.h). 1: an instant. More
  /// are smoother motion blur, and cost what changes within a frame each time.
  int accumulate = 1;
  std::shared_ptr<const layers::CellSet> cells;  ///< of the scene; null: it has none
};

class Culling;  // sequences/pipeline/culling/culling.h
struct CullingMemory;

/// What does not change during a run. Made by make_pipeline (sequences/pipeline/make_pipeline.h). It refers to
/// the scene, which must outlive it; all else is its own.
struct Pipeline {
  const layers::Scene& scene;
  Settings settings;
  LayerTable authored;               ///< the author's layers; those of a frame are in its state
  std::vector<int> moving_carriers;  ///< by node (layers/animation.h); empty unless light is followed
  bool sorts_visibility = false;     ///< the effect visibility_sort is called for
  std::shared_ptr<const layers::SceneMotion> motion;
  std::shared_ptr<const Culling> culling;  ///< null where Settings::visibility asks for nothing
  std::shared_ptr<const layers::Scene>
      rig;  ///< the camera alone, of a late run (latency/late_camera.h); or null
  /// What the author's layers draw, by id; null unless chunks are drawn alone (refresh/refresh.h).
  std::shared_ptr<const std::vector<regulator::LayerContent>> contents{};
};

/// Since when is a layer at rest (regulator/settle.h)? Kept only where the regulator asks for it.
struct RestMemory {
  std::optional<layers::LayerState> seen;  ///< in `frame`
  int frame = -1;
  int frames = 0;  ///< LayerAssessment::frames_at_rest
};

/// What is remembered of one layer: how it was at the instant as of which it was last rendered.
struct LayerMemory {
  std::optional<layers::LayerState> then;  ///< empty: never rendered
  layers::SpritePlacement placement;
  int frame_rendered = -1;  ///< when the work was done
  int depicts_frame = -1;   ///< as of which instant `then` is; later (or earlier) with Lookahead and Oracle
  int frame_shown = -1;     ///< the last frame that showed it
  bool drawn = false;       ///< the sprite store holds that picture (false: planned only)
  std::vector<ShadowMapInstant> maps;  ///< that it looks up, where those are not simply of its own instant
  bool has_old_shadows = false;        ///< one of them was out of date already when it was drawn
  double resolution = 1;               ///< of the sprite, relative to what the layer's author asks for
  bool predicted = false;  ///< `then` was extrapolated in frame_rendered, it is not the scene's own motion
  int frames_short_of_area = 0;  ///< frames in a row in which it was deferred for want of pixels or chunks
  int level = 0;                 ///< of detail, of the sprite
  RestMemory rest;
  regulator::RefreshLedger ledger{};                ///< of its chunks drawn alone
  std::optional<regulator::SpriteChunks> chunks{};  ///< empty unless chunks of it were judged or drawn alone
};

/// What is known of one frame of the motion: the states of all layers, and where their sprites would lie as
/// far as that was asked for.
struct CapturedFrame {
  std::vector<layers::LayerState> states;                          ///< by layer id
  std::vector<std::optional<layers::SpritePlacement>> placements;  ///< by layer id
  std::vector<char> culled;  ///< by layer id: not seen, and so not captured; empty where nothing is culled
  int generation = -1;  ///< OrderMemory::generation: aggregates that exist since then are not captured yet
  std::vector<ShadowMapKey> shadow_maps;   ///< by light; empty where no shadow is called for
  std::vector<layers::LightState> lights;  ///< of the scene
};

/// The last frames of the motion, as far as a regulator that predicts knows it.
struct MotionKnown {
  int frame = 0;
  std::vector<layers::SceneFrame> past;  ///< the oldest first; the last one is `frame`
};

/// A sprite that fades out while the layer's fresh one fades in (sequences/pipeline/cross_fading.h).
struct FadingSprite {
  LayerMemory old;
  int began = 0;  ///< the frame in which the fresh one was drawn
};

/// Policies Hold and Interpolate: what stands from the last beat to the next [LS97 7.2].
struct BeatMemory {
  int frame = 0;  ///< of that beat
  FrameOrder order;
};

/// How often a texel of a sprite is filled, from the sprites measured (sequences/pipeline/depth_complexity.h).
struct DepthMemory {
  double filled = 0, texels = 0;
  double complexity() const { return texels > 0 && filled > texels ? filled / texels : 1; }
};

class PredictiveMemory;  // sequences/pipeline/predictive/plan_buffers.h

/// All that survives a frame.
struct PipelineState {
  explicit PipelineState(const Pipeline& pipeline)
      : authored(pipeline.authored), layers(authored), memory(layers.size()) {}
  LayerTable authored;                  ///< of the pipeline for which `layers` was made
  LayerTable layers;                    ///< those, and behind them the aggregates that exist or have lately
  std::vector<LayerMemory> memory;      ///< by layer id, aggregates behind the author's layers
  chunker::SpriteStore sprites;         ///< as the compositor shows them: decompressed if they are compressed
  std::map<int, FadingSprite> fading;   ///< by layer id; empty unless sprites fade
  chunker::SpriteStore fading_sprites;  ///< of them, those that are drawn
  CompressedSprites compressed;         ///< empty unless Settings::compression asks for it
  OrderMemory order;
  RegroupMemory regroup;              ///< empty unless the regulator regroups
  std::optional<BeatMemory> beat;     ///< empty unless the policy keeps one
  std::vector<ShadowMapMemory> maps;  ///< by light; empty where no shadow is called for
  ShadePlan reference_shades;         ///< of the policy `reference`: the yardstick of what is saved
  ShadowMapStore shadow_maps;
  layers::SceneFrame walked;  ///< the scene as it was evaluated last, by `walked_by` (layers/advance.h)
  std::shared_ptr<const layers::SceneMotion> walked_by;
  layers::SceneFrame seen_late;  ///< the same as a late run knows it; empty for others
  Unshared<CullingMemory> culling;
  DepthMemory depth;
  std::vector<int> uploaded;  ///< by moving picture: the frame that the texture memory holds, or -1
  std::map<int, CapturedFrame> captured;  ///< by frame: this one and those looked at ahead, each once
  std::vector<CapturedFrame> forgotten;   ///< were captured; the next ones are captured in their memory
  int now = 0;                            ///< the frame that is planned: what lies ahead may be a prediction
  std::optional<MotionKnown> motion;      ///< what predictions are made from; empty unless they are made
  std::optional<regulator::RegulatorOptions> planned_with;  ///< `captured` was judged under these options
  std::shared_ptr<PredictiveMemory>
      predictive;                         ///< words and buffers of policy Predictive; null for all others
  std::optional<double> px_per_polygon;   ///< of LodSelector::Feedback, for the next frame
  Unshared<regulator::LodSolver> solver;  ///< of LodSelector::Optimise
};

}  // namespace talisman::sequences
