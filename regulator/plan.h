// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is worth drawing again? The plan of one frame, as data [LS97 6].
///
/// Assessments (one per layer) go in, decisions (one per layer) come out. `regulate` is pure: it draws
/// nothing, reads no clock and remembers nothing, so a whole sequence can be planned, printed and tested
/// without a pixel.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fiducials/fiducials.h"
#include "layers/predict_kalman.h"
#include "regulator/latency_options.h"
#include "regulator/lod/lod_options.h"
#include "regulator/predictive_options.h"
#include "regulator/refresh_options.h"
#include "regulator/regroup.h"

namespace talisman::regulator {

enum class Policy {
  Direct,       ///< the whole scene in one pass, no sprites: the truth
  Reference,    ///< every layer, every frame, through sprites
  Hold,         ///< every N frames; that picture stands in between (triple framing is N = 3) [LS97 7.2]
  Interpolate,  ///< every N frames, each sprite warped in between
  Threshold,    ///< when a fiducial exceeds its threshold
  Budget,       ///< what gains most for its cost, until the frame's budget is spent
  Lookahead,    ///< as Threshold, but drawn as of the instant within N frames that serves longest
  Oracle,       ///< as Lookahead over the whole sequence: the fewest renders under the same bound (of renders
                ///< alone: not of polygons or pixels)
  Predictive,   ///< no sprites: what changes in the same frames shares a buffer with depth [F96]
};
inline constexpr std::array kAllPolicies = {Policy::Direct,      Policy::Reference, Policy::Hold,
                                            Policy::Interpolate, Policy::Threshold, Policy::Budget,
                                            Policy::Lookahead,   Policy::Oracle,    Policy::Predictive};
std::string_view name(Policy policy);
std::optional<Policy> policy_from_name(std::string_view text);

enum class Action {
  Reuse,
  Rerender,
  Drop,
  Refresh,  ///< some chunks of the old sprite are drawn anew (regulator/chunk_refresh.h), and it is carried as with Reuse
};
std::string_view name(Action action);  ///< "reuse", "rerender", "drop", "refresh"

/// What drawing a layer once costs, as far as it can be told without drawing.
struct LayerCost {
  std::int64_t polygons = 0;  ///< triangles sent to the renderer
  std::int64_t pixels = 0;    ///< texels of the sprite's rectangle
  std::int64_t chunks = 0;    ///< 32×32 chunks of the sprite's rectangle
  std::int64_t bytes = 0;     ///< of the sprite, uncompressed, clear chunks included
  bool operator==(const LayerCost&) const = default;
};

/// What is known of the chunks of a sprite that does not serve as a whole (regulator/chunk_refresh.h).
struct ChunkAssessment {
  std::string why_whole{};  ///< why chunks are not drawn alone; empty: they are, or need not be
  warp::FitResult fitted;   ///< as all below, valid where that is empty
  fiducials::Report
      fiducials;  ///< under that warp; the geometric one of the chunks that are left as they are
  ChunkShare share;
  std::vector<int> over{};  ///< the chunks to be drawn: row · columns + column, ascending
  LayerCost cost;           ///< of them
  bool mixed =
      false;  ///< some were drawn alone before: then these are the assessment's own fit and fiducials, too
};

/// One way to draw a layer now (layers/lod/levels.h).
struct LevelChoice {
  int level = 0;          ///< of detail; 0: the finest
  double resolution = 1;  ///< relative to what its author asks for
  LayerCost cost;
  double error_px = 0;  ///< of the level, how far its surface may be from that of the finest on the display
};

/// What the regulator knows about one layer at one frame.
struct LayerAssessment {
  int layer = -1;
  bool in_view = false;
  bool has_sprite = false;       ///< it was rendered before
  bool identical = false;        ///< its state equals the state at its last render: reuse loses nothing
  int frames_since_render = 0;   ///< valid if has_sprite
  int matched_points = 0;        ///< correspondences behind `fitted`; too few say nothing about the motion
  warp::FitResult fitted;        ///< valid if has_sprite
  fiducials::Report fiducials;   ///< valid if has_sprite
  double held_geometric_px = 0;  ///< error of showing the sprite where it was (identity warp)
  LayerCost cost;                ///< of rendering it now, at `resolution`
  layers::LayerPreferences preferences;
  double resolution = 1;  ///< at which it would be rendered now, relative to what its author asks for; (0, 1]
  double resolution_then = 1;    ///< at which its sprite was rendered, likewise
  int frames_short_of_area = 0;  ///< frames in a row in which it was deferred for want of pixels or chunks
  int frames_at_rest = 0;  ///< frames in a row, this one the last, in which its state was that of the frame
                           ///< before; counted only with settle_frames
  std::string new_picture{};  ///< what its sprite shows an old frame of, in words; empty: nothing
  std::optional<ChunkAssessment>
      chunks{};  ///< with Refresh::Chunks, where the sprite is off as a whole, or mixed
  /// The ways to draw it now, the finest at full resolution first; empty: `cost` alone. Only with RegulatorOptions::lod.
  std::vector<LevelChoice> levels{};
  int level = 0;               ///< that would be drawn now; its cost is `cost`
  int level_then = 0;          ///< of its sprite
  double level_then_px = 0;    ///< error of that now, as LevelChoice::error_px
  bool may_be_skipped = true;  ///< nothing is laid over it that would be seen without it
};

/// The budget of a frame that is not limited.
inline constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();
inline constexpr double kNoLimitMs = std::numeric_limits<double>::infinity();

/// A layer is rendered again when a fiducial exceeds its threshold; fewer renders as they grow.
struct Thresholds {
  double geometric_px = 4;     ///< ≥ 0; 0: reuse only what is identical
  double magnification = 1.5;  ///< ≥ 1: texels stretched by more than this are drawn again; 0: not regulated
  double minification = 0.5;   ///< 0 … 1: texels squeezed by more; 0: not regulated
  double anisotropy = 2;       ///< ≥ 1; 0: not regulated
  double uncovered_px = 1;     ///< ≥ 0: a cut side may be this far in view; negative: not regulated
  double turned_px = 0;        ///< > 0: a side of the layer that has turned to the eye may be this large
                               ///< (square root of its area); 0: not regulated, and not computed
  double photometric = 0.05;   ///< > 0: shading may be this far off, linear light (1 is white), after the
                               ///< colour warp; 0: not regulated
  double shadow_map_px =
      0;  ///< ≥ 0: a sprite may be drawn from an old shadow map as long as the shadows that
          ///< it casts are no farther off on the display; 0: never
  double light_angle_rad = 0;  ///< 0 … π: a light (or, for highlights, the eye) may have moved by this angle
                               ///< about the layer: the alternative for hardware without colour warp; 0:
                               ///< not regulated
  bool operator==(const Thresholds&) const = default;
};

/// Policies Lookahead and Predictive.
struct LookaheadOptions {
  int frames = 16;  ///< N ≥ 0; a sprite may be drawn as of an instant up to N frames ahead; 0 draws as of
                    ///< now; planning time grows with N, renders fall. Predictive: frames of a slice, ≥ 1
  Prediction predict =
      Prediction::Known;  ///< Lookahead: what is known ahead; the others draw more often, since
                          ///< they err where the motion bends
  bool operator==(const LookaheadOptions&) const = default;
};

/// Policy Budget: how are the layers chosen that a frame draws (regulator/budget.h)?
enum class ChoiceRule {
  Paper,  ///< by benefit over cost until the budget is spent [LS97 6]; may be far from the best
  Best,   ///< never worse than that, and half the best at least with one kind of budget; some µs more
};
inline constexpr std::array kAllChoiceRules = {ChoiceRule::Paper, ChoiceRule::Best};
std::string_view name(ChoiceRule rule);  ///< "paper", "best"
std::optional<ChoiceRule> choice_rule_from_name(std::string_view text);

/// Policy Budget: what a frame may spend. More is drawn as a limit grows.
struct BudgetOptions {
  std::int64_t polygons = kNoLimit;  ///< triangles per frame, ≥ 0
  std::int64_t pixels = kNoLimit;    ///< sprite texels per frame, ≥ 0
  std::int64_t chunks = kNoLimit;    ///< 32×32 chunks of sprites per frame, ≥ 0
  double ms = kNoLimitMs;            ///< modelled render time per frame on talisman-1996, ≥ 0
  double min_resolution = 0.125;     ///< (0, 1]; how far the resolution of sprites may be lowered to fit a
                                     ///< budget of pixels, chunks or time (regulator/resolution.h); 1: never;
                                     ///< raising it keeps sprites sharp and draws them less often
  double cutoff_px = 0.004;  ///< ≥ 0; a layer whose benefit (regulator/budget.h) is not above it is never
                             ///< drawn again; the default is 1/1000 of a typical error of 4 px [LS97 6]; more
                             ///< leaves resources unspent
  ChoiceRule choice = ChoiceRule::Paper;
  double depth_complexity =
      0;  ///< ≥ 1: pixels that are filled per texel of a sprite's rectangle, by which the
          ///< pixels of budget.ms are divided [LS97 footnote 11]; 0: as measured on the
          ///< layers drawn so far (sequences/pipeline/depth_complexity.h)
  bool operator==(const BudgetOptions&) const = default;
};

/// Options of all policies.
struct RegulatorOptions {
  Policy policy = Policy::Threshold;
  int hold_frames = 3;  ///< Hold, Interpolate: N ≥ 1; 1 is every frame
  bool stagger =
      false;  ///< Interpolate: each layer has a beat of its own, so that not all step at once and each
              ///< frame draws about as much as the next
  int blend_frames =
      0;  ///< K ≥ 0; policies that carry sprites by warps and have no budget: a fresh sprite fades in
          ///< over K frames (sequences/pipeline/cross_fading.h); more steps less, fills more texels
          ///< and shows the old error longer; 0: off
  bool color_warp = true;  ///< reused sprites are multiplied with the colour that fits their shading best;
                           ///< false: hardware without it, the photometric error is that of 1
  int settle_frames =
      0;  ///< N ≥ 1: what is shown enlarged is drawn again when it has been at rest for N frames
          ///< (regulator/settle.h), by policies that draw on demand; fewer are sharp sooner and
          ///< draw more; 0: off
  Thresholds thresholds;
  LookaheadOptions lookahead;
  BudgetOptions budget;
  PredictiveOptions predictive;
  RegroupOptions regroup;
  Refresh refresh = Refresh::Sprite;  ///< what is drawn anew where only places of a sprite are too far off
  LodOptions lod;                     ///< Reference, Threshold, Budget
  LatencyOptions latency;             ///< all policies
  layers::KalmanNoise kalman;         ///< of Prediction::Kalman, wherever it is
  bool operator==(const RegulatorOptions&) const = default;
};

/// One layer, one frame: what is done and why.
struct LayerDecision {
  int layer = -1;
  Action action = Action::Drop;
  std::string reason;     ///< in words and numbers: "geometric 4.7 > 4 px", "first_appearance", "policy: hold
                          ///< 3", "out_of_view"
  warp::Warp shown_warp;  ///< carries the sprite as rendered to where it is shown; identity for a fresh one
  double shown_geometric_px =
      0;  ///< error of what is displayed; 0 for a fresh sprite, unless it is drawn from
          ///< an old shadow map: then how far its shadow is off
  double warp_geometric_px = 0;  ///< error that the warp would have had (also when it was rejected)
  LayerCost cost;                ///< spent: zero unless rendered
  int depicts_frame = -1;  ///< the frame at whose instant the sprite was drawn; ahead of the frame it is
                           ///< shown in only with Lookahead and Oracle; -1 if nothing is shown or not known
  layers::dvec3 shown_color{1, 1, 1};  ///< multiplier of the sprite's colour, 0 … 1; 1 for a fresh sprite
  double resolution = 1;               ///< of the sprite shown, relative to what the layer's author asks for
  bool short_of_area = false;          ///< deferred for want of pixels or chunks
  bool deferred = false;               ///< worth drawing, but the frame's budget did not suffice
  bool over_budget = false;            ///< of these: dearer than the whole budget of a frame
  bool settled = false;                ///< drawn because it is at rest (regulator/settle.h): as of this frame
  std::optional<ChunkShare>
      chunks{};          ///< Refresh, and Reuse of a sprite whose chunks are of several instants
  int level = 0;         ///< of detail, of what is shown
  bool skipped = false;  ///< not shown, though in view: the budget did not suffice
};

/// What the choice of levels of a frame came to (regulator/lod/solver.h).
struct LodPlan {
  double benefit = 0, upper_bound = 0;
  double cost_ms = 0;  ///< the sum of its layers and shadow maps, each alone
  bool fits = true;    ///< false: the cheapest choices alone exceed the budget
  int iterations = 0;  ///< of the solver
  int skipped = 0;     ///< layers in view that are not shown
};

struct MapAssessment;
class LodSolver;  // regulator/lod/solver.h

struct FramePlan {
  int frame = 0;
  std::vector<LayerDecision> decisions;  ///< by layer id
  std::vector<LayerDecision> maps;       ///< of the shadow maps, in the order of their assessments
  std::optional<LodPlan> lod;            ///< of LodSelector::Optimise
};

/// Hold and Interpolate draw on the beat: pictures, order and fades are those of the last beat, and what was out
/// of view then waits for the next one.
struct FrameBeat {
  int frame = 0;      ///< that is planned
  int last_beat = 0;  ///< the frame in which all layers were drawn; `frame`: they are drawn now
  bool is_now() const { return last_beat == frame; }
  /// Is the layer's sprite that of the last beat?
  bool drew(const LayerAssessment& layer) const;
};

/// Do pictures stand from one beat to the next?
bool keeps_beat(const RegulatorOptions& options);

/// Do fresh sprites fade in: is that asked for, and does the policy carry sprites by warps, without a budget?
bool blends(const RegulatorOptions& options);

/// As if the run had begun at frame 0: a beat is every frame that hold_frames divides.
FrameBeat regular_beat(int frame, const RegulatorOptions& options);

FramePlan regulate(int frame, std::span<const LayerAssessment> assessments, const RegulatorOptions& options);
/// The same where the last beat was another one, because the run began between two of them.
/// `maps`: the shadow maps that these layers look up (regulator/shadow_maps.h). `solver`: of the run; it makes the choice of
/// levels faster and never another one.
FramePlan regulate(const FrameBeat& beat, std::span<const LayerAssessment> assessments,
                   const RegulatorOptions& options, std::span<const MapAssessment> maps = {},
                   LodSolver* solver = nullptr);

/// Are levels of detail chosen: is that asked for, and does the policy know how?
bool chooses_levels(const RegulatorOptions& options);

/// Do the options ask for the colour warp or a threshold of the light, whatever the policy?
bool asks_for_light(const RegulatorOptions& options);

/// … and does the policy carry old sprites by warps at all, so that the light on them has to be followed?
bool follows_light(const RegulatorOptions& options);

/// First broken rule ("hold_frames is 0, must be at least 1"), or empty. It names the options as users write
/// them: budget.ms is budget_ms.
std::string first_defect(const RegulatorOptions& options);

/// The plan tree of policy Predictive.
PlanShape plan_shape(const RegulatorOptions& options);

/// Do layers share sprites because it is cheaper: is that asked for, and does the policy know how?
bool regroups(const RegulatorOptions& options);

/// Are chunks of sprites drawn alone: is that asked for, and does nothing forbid it for all sprites: another policy, a
/// threshold of 0 px, fades, shared sprites, old poses?
bool refreshes_chunks(const RegulatorOptions& options);

/// For how many later frames a sprite is expected to be moved by a warp: 0 where none is (Direct, Reference,
/// Hold, Predictive, or a threshold of 0 px), N - 1 for Interpolate, `threshold_default` for the rest. Extents grow in
/// proportion.
double expected_reuse_frames(const RegulatorOptions& options, double threshold_default = 8);

}  // namespace talisman::regulator
