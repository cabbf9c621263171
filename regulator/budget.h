// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which layers are drawn in this frame, if not all that would gain can be afforded? The seven steps of
/// [LS97 6], and how far the paper's greedy order is from the best choice.
///
///   1 warps        given: LayerAssessment::fitted
///   2 benefit      B = w_g F + w_p P + w_s S + w_v V, pixels                                (`benefit_px`)
///                    F  geometric fiducial, px
///                    P  photometric fiducial · kPxPerLight, px
///                    S  (max(σ₁, 1) - 1) + (1 / min(σ₂, 1) - 1) + (anisotropy - 1): display pixels over
///                       which a texel is smeared, or texels skipped by a pixel; 0 at rest
///                    V  depth to which a cut side has come into view + size of a side that has turned to
///                       the eye, px
///                    w  the layer's importance [LS97 2.4], no unit
///                  0 where a render would draw the same again; kMostBenefitPx where the old sprite cannot be
///                  warped soundly or the author's minimum update rate makes a render due
///   3 cost         c = polygons / budget + pixels / budget + chunks / budget, of those that are limited,
///                  at the resolution of step 6                                      (`share_of_budget`)
///   4 order        by B / c, largest first; ties by layer id
///   5 cut-off      B ≤ cutoff_px: not drawn again whatever is left
///   6 parameters   the resolution of sprites                             (regulator/resolution.h); its costs
///                  are known before step 3, so that the order and the spending are those of what is drawn
///   7 render       in order; a layer that does not fit is deferred, a later and cheaper one may still fit
///
/// What is counted: the polygons, pixels and chunks of the sprites that are drawn, of the mirrored pictures behind
/// them, and of the shadow maps. The budget of steps 3 and 7 is what first appearances leave of the frame's. A
/// budget of modelled time is exactly a budget of polygons and one of pixels, because a render takes the longer of
/// the two times (regulator/profile.h):
///
///   max(polygons / polygon rate, d pixels / pixel rate) ≤ t  ⇔  polygons ≤ t · rate and pixels ≤ t · rate / d
///
/// Pixels are those of the sprite's rectangle, each once. d ≥ 1 is how often they are filled in the mean, because
/// of hidden surfaces: BudgetOptions::depth_complexity [LS97 footnote 11]. It is an average: a single frame may
/// fill more than its budget of ms allows for; polygons, and pixels of rectangles, are kept exactly.
///
/// First appearances have nothing to show instead: layers in the order of their ids, then the shadow maps that
/// they look up, come first and are drawn even beyond the budget. That is what a frame may spend beyond it, and
/// all: in frame 0 everything appears.
///
/// Shadow maps (regulator/shadow_maps.h). A layer may be drawn with the old map of a light, which leaves the
/// motion of its shadow unmended, or with a new one, which has a price of its own. For every set S of maps that
/// could be drawn anew (they are at most four) there is a choice:
///
///   budget(S) = what is left - cost of S        B(S) = benefit but for the motion of shadows of maps not in S
///
/// and that with the largest benefit is made; of equals, the one with the fewest maps. The layers that first
/// appear count with the motion that S mends on them.
///
/// The choice of step 7 is a 0/1 knapsack with up to three constraints (Horvitz & Lengyel 1997 choose by
/// expected perceived cost). `greedy_choice`, the paper's, can be arbitrarily bad in theory; `best_choice` is
/// never worse and bounded; `optimal_choice` tells how bad either is.

#include <cstdint>
#include <span>
#include <vector>

#include "regulator/plan.h"
#include "regulator/shadow_maps.h"

namespace talisman::regulator {

/// What may be spent.
struct Budget {
  std::int64_t polygons = kNoLimit, pixels = kNoLimit, chunks = kNoLimit;
  bool affords(const LayerCost& cost) const {
    return cost.polygons <= polygons && cost.pixels <= pixels && cost.chunks <= chunks;
  }
};

/// The whole budget of a frame: budget_ms becomes limits of polygons and of pixels.
Budget frame_budget(const RegulatorOptions& options);

/// Is there any limit at all?
bool is_limited(const RegulatorOptions& options);

/// What `cost` leaves; not negative, and no limit stays none.
Budget after(const Budget& budget, const LayerCost& cost);

/// One layer that would gain by a render.
struct Candidate {
  int layer = -1;
  double benefit_px = 0;  ///< ≥ 0
  LayerCost cost;
  bool operator==(const Candidate&) const = default;
};

struct Choice {
  std::vector<int> layers;  ///< ids, ascending
  double benefit_px = 0;    ///< summed in the order of the candidates
  bool exact = true;        ///< optimal_choice: proved to be the most; false: too large, the greedy choice
};

/// The most that a layer can gain: more than any display is wide, small enough that sums keep the rest.
inline constexpr double kMostBenefitPx = 1e6;

/// The exchange rate of light for geometry: an error of the default photometric threshold, 0.05 of white,
/// weighs as much as one of the default geometric threshold, 4 px. Weights (FiducialWeights) change it for a
/// layer.
inline constexpr double kPxPerLight = 80;

/// B, 0 … kMostBenefitPx; what is not a number counts as the most. `unmended_px` of the geometric error would be
/// there after a render, too: the shadows of old maps.
double benefit_px(const LayerAssessment& layer, double unmended_px = 0);

/// c ≥ 0: 1 is a whole budget of polygons, pixels or chunks. What is not limited costs nothing.
double share_of_budget(const LayerCost& cost, const Budget& budget);

/// Step 4: by benefit / cost, largest first, ties by id. Without any cost the benefit alone decides.
void sort_by_benefit_per_cost(std::vector<Candidate>& candidates, const Budget& budget);

/// Steps 4 and 7. Cost: O(n log n).
Choice greedy_choice(std::span<const Candidate> candidates, const Budget& budget);

/// Steps 4 and 7, safe: the best of
///   - the greedy choice, so that it is never worse than the paper's;
///   - the most beneficial layer that fits by itself, filled up greedily;
/// improved as long as that gains, by giving up one layer and filling up greedily in the order of benefit over
/// cost, or of benefit alone. Of k kinds of budget it buys at least 1/(2 k) of the best benefit, one half with
/// one: of the greedy prefix and the first layer that did not fit, whose costs together exceed one of the budgets
/// while nothing can spend more than k, one has half of their benefit. Cost: O(n²) per improvement, some 50 µs
/// for 100 layers.
Choice best_choice(std::span<const Candidate> candidates, const Budget& budget);

/// By the rule.
Choice choose(ChoiceRule rule, std::span<const Candidate> candidates, const Budget& budget);

/// The most benefit that the budget can buy: dynamic programming over the choices that no other choice beats
/// in polygons, pixels, chunks and benefit at once (Nemhauser & Ullmann 1969), without those that cannot
/// exceed the greedy benefit even if the rest were divisible (Dantzig 1957, on c). For analysis of small
/// frames: time and memory grow with the number of such choices, at worst 2ⁿ; beyond `most_states` (≥ 1) the
/// greedy choice is returned with `exact` false. Costs must not be negative.
Choice optimal_choice(std::span<const Candidate> candidates, const Budget& budget,
                      std::size_t most_states = 200'000);

/// What was chosen against the best, for one frame.
struct BudgetGap {
  double greedy_px = 0, optimal_px = 0;  ///< benefit of all layers chosen, by the rule and at best
  bool exact = true;                     ///< false: too many layers, `optimal_px` is only what was chosen
  double gap() const;  ///< share of the optimum that was missed, 0 … 1; 0 for nothing to gain
};
/// At 119 layers about 1 ms with one kind of budget; with several, some 10 ms per 10,000 states.
BudgetGap budget_gap(std::span<const Candidate> candidates, const Budget& budget,
                     std::size_t most_states = 200'000, ChoiceRule rule = ChoiceRule::Paper);
/// The same for a frame: over all sets of shadow maps.
BudgetGap budget_gap_of_frame(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                              std::span<const MapAssessment> maps, std::size_t most_states);

/// The share of the optimal benefit that the greedy choice misses, 0 … 1; 0 where there is nothing to gain.
double greedy_gap(std::span<const Candidate> candidates, const Budget& budget);

/// Does step 5 let the layer through? In view, drawn before, worth it, not barred by its maximum update rate.
bool is_candidate(const LayerAssessment& layer, const RegulatorOptions& options, double unmended_px = 0);

/// The layers that step 5 lets through, in the order of ids.
std::vector<Candidate> candidates_of(std::span<const LayerAssessment> assessments,
                                     const RegulatorOptions& options);

/// What first appearances leave of the frame's budget; not negative.
Budget left_after_first_appearances(std::span<const LayerAssessment> assessments,
                                    const RegulatorOptions& options);

/// What a frame can choose from if a set of shadow maps is drawn anew.
struct Alternative {
  std::vector<bool> drawn_anew;  ///< by map; first appearances included
  std::vector<Candidate> candidates;
  Budget left;         ///< for them
  double sure_px = 0;  ///< what the maps mend on layers that appear in any case
};

/// That without any map (but first appearances), then those with one, two, … that fit the budget.
std::vector<Alternative> alternatives_of(std::span<const LayerAssessment> assessments,
                                         const RegulatorOptions& options,
                                         std::span<const MapAssessment> maps);

/// All decisions of a frame under Policy::Budget, in the order of the assessments.
struct BudgetDecisions {
  std::vector<LayerDecision> layers, maps;
};
BudgetDecisions decide_budget(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                              std::span<const MapAssessment> maps = {});

}  // namespace talisman::regulator
