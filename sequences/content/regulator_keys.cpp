// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/regulator_keys.h"

#include "regulator/lod/selectors.h"
#include "sequences/content/sequence.h"

#include <array>
#include <limits>

namespace talisman::sequences {

namespace {

using layers::KalmanNoise;
using regulator::BudgetOptions;
using regulator::LatencyOptions;
using regulator::LodOptions;
using regulator::LookaheadOptions;
using regulator::PredictiveOptions;
using regulator::RegroupOptions;
using regulator::RegulatorOptions;
using regulator::Thresholds;
using RegulatorKeys = Table<RegulatorOptions>;

constexpr Range kStretch{1, 1e6};

Format<regulator::Policy> policy() {
  std::vector<std::pair<std::string, regulator::Policy>> choices;
  for (const regulator::Policy policy : regulator::kAllPolicies)
    choices.emplace_back(regulator::name(policy), policy);
  return choice(choices);
}

Format<regulator::Prediction> prediction() {
  std::vector<std::pair<std::string, regulator::Prediction>> choices;
  for (const regulator::Prediction prediction : regulator::kAllPredictions)
    choices.emplace_back(regulator::name(prediction), prediction);
  return choice(choices);
}

Format<regulator::ChoiceRule> choice_rule() {
  using enum regulator::ChoiceRule;
  return choice<regulator::ChoiceRule>({{"paper", Paper}, {"best", Best}});
}

Format<regulator::Joining> joining() {
  std::vector<std::pair<std::string, regulator::Joining>> choices;
  for (const regulator::Joining joining : regulator::kAllJoinings)
    choices.emplace_back(regulator::name(joining), joining);
  return choice(choices);
}

Format<regulator::MotionNorm> motion_norm() {
  using enum regulator::MotionNorm;
  return choice<regulator::MotionNorm>({{"axis", Axis}, {"euclid", Euclid}});
}

Format<regulator::Intervals> intervals() {
  using enum regulator::Intervals;
  return choice<regulator::Intervals>({{"fixed", Fixed}, {"data", Data}});
}

Format<int> amount() { return whole(0, std::numeric_limits<int>::max()); }

Table<LookaheadOptions> lookahead_keys() {
  using L = LookaheadOptions;
  return Table<L>()
      .key("lookahead_frames", &L::frames, whole(0, kLongestRun_frames), "frames",
           "policy lookahead: how far ahead the instant of a sprite may lie; policy predictive: frames of a "
           "slice, "
           "a power of `tree_k`")
      .key("predict", &L::predict, prediction(), "",
           "policies lookahead and predictive: motion ahead is known, or expected: all stays as it is, goes "
           "on with its "
           "velocity, or "
           "with its acceleration");
}

Table<LatencyOptions> latency_keys() {
  using L = LatencyOptions;
  return Table<L>()
      .key("latency_ms", &L::render_ms, number({0, regulator::kLongestLatency_ms}), "ms",
           "decisions and sprites know the poses of the camera of so long ago; 0: that of now")
      .key("latency_warp_ms", &L::warp_ms, number({0, regulator::kLongestLatency_ms}), "ms",
           "just before they are shown sprites are warped once more, with poses of so long ago; at most "
           "latency_ms")
      .otherwise("no last warp")
      .key("latency_predict", &L::predict, prediction(), "",
           "what is expected of the camera from there: it stays, goes on with its velocity, or with its "
           "acceleration; known: as if nothing were old");
}

Table<KalmanNoise> kalman_keys() {
  using K = KalmanNoise;
  constexpr Range kNoise{1e-12, 1e12};
  return Table<K>()
      .key("kalman_place_m", &K::place_m, number(kNoise), "m",
           "prediction kalman: standard deviation of a measured place; more follows later and smoother")
      .key("kalman_turn_deg", &K::turn_rad, degrees({1e-9, 180}), "°",
           "prediction kalman: of a measured rotation, likewise")
      .key("kalman_jerk_m", &K::jerk_m, number(kNoise), "m s⁻³ √s",
           "prediction kalman: how much the acceleration changes, root of its density; more follows sooner")
      .key("kalman_jerk_rad", &K::jerk_rad, number(kNoise), "rad s⁻³ √s",
           "prediction kalman: of the turning, likewise")
      .key("kalman_coast_s", &K::coast_s, number({0, 1e6}), "s",
           "prediction kalman: in what time the velocity of a turn falls to 1/e when left alone; 0: it lasts")
      .key("kalman_push_s", &K::push_s, number({0, 1e6}), "s",
           "prediction kalman: its acceleration, likewise; much less than a frame: it is pushed by white "
           "noise");
}

Table<PredictiveOptions> predictive_keys() {
  using P = PredictiveOptions;
  return Table<P>()
      .key("tree_k", &P::children, whole(2, regulator::kLongestSlice_frames), "",
           "policy predictive: into how many parts each interval of the plan is cut; more are fewer buffers, "
           "and "
           "coarser intervals")
      .key("joining", &P::joining, joining(), "",
           "policy predictive: all buffers are joined in each frame, or each begins as a copy of the one "
           "that it is "
           "laid over, or goes on in it where nothing else needs that")
      .key("motion_norm", &P::norm, motion_norm(), "",
           "policy predictive: geometric_px holds along x and along y, or in any direction")
      .key("intervals", &P::intervals, intervals(), "",
           "policy predictive: those of the plan are of equal length, or cut for each slice where most rests "
           "(of at most 128 frames)")
      .key("adaptive", &P::adaptive, truth(), "",
           "policy predictive: a slice is 1 / tree_k as long after a surprise, tree_k times after two "
           "without one");
}

Format<regulator::Regroup> regroup_by() {
  using enum regulator::Regroup;
  return choice<regulator::Regroup>({{"none", None}, {"amortised", Amortised}});
}

Format<regulator::RegroupPrices> regroup_prices() {
  using enum regulator::RegroupPrices;
  return choice<regulator::RegroupPrices>({{"modelled", Modelled}, {"durbin-1995", Durbin1995}});
}

Format<regulator::Refresh> refresh_of() {
  using enum regulator::Refresh;
  return choice<regulator::Refresh>({{"sprite", Sprite}, {"chunks", Chunks}});
}

Table<RegroupOptions> regroup_keys() {
  using R = RegroupOptions;
  return Table<R>()
      .key("regroup", &R::by, regroup_by(), "",
           "policy threshold: neighbours in the order share a sprite while that is cheaper by their modelled "
           "cost and "
           "by how long sprites of theirs have lasted")
      .key("regroup_prices", &R::prices, regroup_prices(), "",
           "modelled as everything else, or 12.7 µs apart, 3.8 µs together and 87.9 µs once for each polygon")
      .key("regroup_ceiling_ms", &R::ceiling_ms, number(kNotNegative), "ms",
           "the changes of one frame cost no more at once")
      .otherwise("no limit")
      .key("regroup_dwell", &R::dwell_frames, whole(1, kLongestRun_frames), "frames",
           "layers that were merged or split stay so for at least so long")
      .key("regroup_recency", &R::recency, number({kLeast, 1}), "",
           "weight of the last life of a sprite in how long the next is expected to last");
}

template <typename T, std::size_t N>
Format<T> one_of_names(const std::array<T, N>& all) {
  std::vector<std::pair<std::string, T>> choices;
  for (const T one : all) choices.emplace_back(regulator::name(one), one);
  return choice(choices);
}

Table<LodOptions> lod_keys() {
  using L = LodOptions;
  return Table<L>()
      .key(
          "lod", &L::by, one_of_names(regulator::kAllLodSelectors), "",
          "policies reference, threshold and budget: at which level of detail layers are drawn: the finest; "
          "the finest "
          "whose triangles are large enough; likewise, as large as the last frame's time asks for; of policy "
          "budget, what gives most within budget_ms")
      .key("lod_benefit", &L::benefit, one_of_names(regulator::kAllLodBenefits), "",
           "lod optimise: what a picture is worth: six guesses of [Fu93], or the error that it takes away")
      .key("first_appearance", &L::first_appearance, one_of_names(regulator::kAllFirstAppearances), "",
           "lod optimise: what comes into view is drawn finest, coarsest where the budget affords no more, "
           "or not at "
           "all where it does not")
      .key("px_per_polygon", &L::px_per_polygon, number({0, regulator::kMostPxPerPolygon}), "px",
           "lod static: pixels for each triangle of the level; feedback begins with it")
      .key("feedback_gain", &L::feedback_gain, number({kLeast, regulator::kMostPxPerPolygon}), "px",
           "lod feedback: by how much that grows after a frame twice as long as budget_ms");
}

Table<BudgetOptions> budget_keys() {
  using B = BudgetOptions;
  return Table<B>()
      .key("budget_polygons", &B::polygons, amount(), "triangles", "policy budget: of each frame")
      .otherwise("no limit")
      .key("budget_pixels", &B::pixels, amount(), "texels", "policy budget: of each frame")
      .otherwise("no limit")
      .key("budget_chunks", &B::chunks, amount(), "chunks", "policy budget: of each frame, 32 × 32 texels")
      .otherwise("no limit")
      .key("budget_ms", &B::ms, number(kNotNegative), "ms",
           "policy budget: modelled render time of each frame, as planned (`modelled_drawing_ms`)")
      .otherwise("no limit")
      .key("min_resolution", &B::min_resolution, number({kLeast, 1}), "",
           "policy budget: how far sprites may be drawn coarser to fit; 1: never")
      .key("cutoff_px", &B::cutoff_px, number(kNotNegative), "px",
           "policy budget: a layer whose benefit is not above it is not drawn again")
      .key("choice", &B::choice, choice_rule(), "",
           "policy budget: by benefit over cost as in the paper, or never worse than that and half the best "
           "at "
           "least")
      .key("depth_complexity", &B::depth_complexity, zero_or(kStretch), "1",
           "policy budget: pixels filled per texel of a sprite, by which the pixels of budget_ms are "
           "divided; 0: "
           "as measured");
}

Table<Thresholds> threshold_keys() {
  using T = Thresholds;
  return Table<T>()
      .key("geometric_px", &T::geometric_px, number(kNotNegative), "px",
           "a reused sprite may be this far off at any characteristic point; 0: only what is identical is "
           "reused")
      .key("magnification", &T::magnification, zero_or(kStretch), "",
           "texels may be stretched by this; 0: not regulated")
      .key("minification", &T::minification, number({0, 1}), "",
           "texels may be squeezed to this; 0: not regulated")
      .key("anisotropy", &T::anisotropy, zero_or(kStretch), "",
           "texels may be longer than wide by this; 0: not regulated")
      .key("uncovered_px", &T::uncovered_px, number(), "px",
           "a cut side may be this far in view; negative: not regulated")
      .key("turned_px", &T::turned_px, number(kNotNegative), "px",
           "a side of the characteristic polyhedron that has turned to the eye may be this large (square "
           "root of its area on the display); 0: not regulated")
      .key("photometric", &T::photometric, number(kNotNegative), "1",
           "shading may be this far off at any characteristic point, after the colour warp; linear light, 1 "
           "is white; 0: not regulated")
      .key(
          "shadow_map_px", &T::shadow_map_px, number(kNotNegative), "px",
          "policy threshold: shadows may be this far off because their map is old when a sprite is drawn; 0: "
          "maps are never old")
      .key("light_angle_deg", &T::light_angle_rad, degrees({0, 180}), "°",
           "a light (or, for highlights, the eye) may have moved by this about the layer: the alternative "
           "for hardware without colour warp; 0: not regulated");
}

}  // namespace

const Table<RegulatorOptions>& regulator_keys() {
  using R = RegulatorOptions;
  static const RegulatorKeys table =
      RegulatorKeys("regulator")
          .key("policy", &R::policy, policy(), "", "what decides")
          .key("hold_frames", &R::hold_frames, whole(1, kLongestRun_frames), "frames",
               "policies hold and interpolate: drawn every so many")
          .key("stagger", &R::stagger, truth(), "",
               "policy interpolate: each layer has a beat of its own, so that not all are drawn in the same "
               "frame")
          .key("blend_frames", &R::blend_frames, whole(0, kLongestRun_frames), "frames",
               "policies interpolate, threshold, lookahead and oracle: a sprite that is drawn again fades in "
               "over "
               "so many, as long as the old one is off by no more than twice geometric_px; 0: it is shown at "
               "once")
          .key("settle_frames", &R::settle_frames, whole(0, kLongestRun_frames), "frames",
               "a layer that is shown enlarged is drawn again when it has been at rest for so many; 0: never")
          .include(&R::thresholds, threshold_keys())
          .key("color_warp", &R::color_warp, truth(), "",
               "reused sprites are multiplied with the colour (0 … 1 per channel) that "
               "fits the light now best. "
               "Multipliers only darken; light that grows is drawn again")
          .include(&R::lookahead, lookahead_keys())
          .include(&R::budget, budget_keys())
          .include(&R::predictive, predictive_keys())
          .include(&R::regroup, regroup_keys())
          .key("refresh", &R::refresh, refresh_of(), "",
               "policy threshold: where a sprite is too far off in places only, all of it is drawn again "
               "(sprite), or the chunks that show them (chunks)")
          .include(&R::lod, lod_keys())
          .include(&R::latency, latency_keys())
          .include(&R::kalman, kalman_keys())
          .rule("latency_warp_ms at most latency_ms", [](const R& r) {
            return r.latency.warp_ms == regulator::kNoLastWarp_ms || r.latency.warp_ms <= r.latency.render_ms;
          });
  return table;
}

}  // namespace talisman::sequences
