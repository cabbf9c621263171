// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Should neighbours in the order share one sprite, or have one each? [D95] for sprites.
///
/// A sprite costs a *render* each time that a fiducial speaks, on average every T frames, and in every frame a
/// *reuse*: fit, fiducials, and the pixels that the compositor reads.
///
///   a frame, of one sprite      C = reuse + render / T
///   neighbours a, b together    merge  ⇔  reuse_ab · T_ab + render_ab < (C_a + C_b) · T_ab
///   a shared sprite g apart     split  ⇔  Σ C_i · H + renders < C_g · H         H = the longest of T_i, dwell
///
/// The first is the utility test of [D95] (regulator/amortise.h): the shared sprite is the optimisation, drawing it is OT,
/// and it lasts until one of them, or the warp that they then have in common, has to be given up: T_ab ≤ T_a, T_b. In the
/// second, `renders` are those of members whose own old sprites no longer serve; others need none.
///
/// All in modelled ms (regulator/profile.h), render and composite added up as one processor would spend them: never in
/// time that was measured, so that runs repeat.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "regulator/amortise.h"

namespace talisman::regulator {

enum class Regroup {
  None,       ///< the author's layers stay as they are (but for cycles)
  Amortised,  ///< neighbours share a sprite while that is cheaper; policy Threshold only
};
inline constexpr std::array kAllRegroups = {Regroup::None, Regroup::Amortised};

/// What things cost.
enum class RegroupPrices {
  Modelled,    ///< on talisman-1996, of what each sprite is
  Durbin1995,  ///< durbin_1995() of the polygons that would be shared: apart TTRU, together TTRO
};
inline constexpr std::array kAllRegroupPrices = {RegroupPrices::Modelled, RegroupPrices::Durbin1995};

struct RegroupOptions {
  Regroup by = Regroup::None;
  RegroupPrices prices = RegroupPrices::Modelled;
  /// ≥ 0, ms: no change costs more than that at once, so that no frame stalls ("a hard upper limit on the allowable OT",
  /// [D95]); more lets larger sprites be shared. All changes of a frame together stay below it.
  double ceiling_ms = std::numeric_limits<double>::infinity();
  /// ≥ 1: layers whose grouping changed keep it for so many frames, a set that had to be split for twice as many each
  /// time; fewer follow the motion sooner and flicker more.
  int dwell_frames = 12;
  double recency = 0.25;  ///< (0, 1]: weight of the last run in RunLength; more forgets faster
  bool operator==(const RegroupOptions&) const = default;
};

/// What a change must save with modelled prices, which are estimates: this share of the cheaper one of the two sprites that
/// are merged, or that a split makes. What is common to both sides errs alike and needs no margin.
inline constexpr double kRegroupMargin = 0.1;
/// Of fit, fiducials and decision of one sprite in one frame: an assumption of this model, ms.
inline constexpr double kReuseOverhead_ms = 0.005;

struct SpritePrice {
  double render_ms = 0, reuse_ms = 0;
  double run_frames = 1;  ///< T ≥ 1
  std::int64_t polygons = 0;
  double ms_per_frame() const { return reuse_ms + render_ms / run_frames; }
};

/// Of a sprite that sends so many polygons and texels to the renderer, and so many pixels to the compositor.
SpritePrice modelled_price(std::int64_t polygons, std::int64_t texels, double shown_px, double run_frames);

/// A change that was weighed.
struct RegroupVerdict {
  Amortisation terms;
  double frames = 0;              ///< AUT
  bool pays = false;              ///< whatever it costs at once
  bool is_above_ceiling = false;  ///< it pays, and costs too much at once
  bool is_made() const { return pays && !is_above_ceiling; }
  double saved_ms() const { return (terms.unoptimised_ms - terms.optimised_ms) * frames - terms.once_ms; }
};

/// `left_ms`: what is left of the ceiling.
RegroupVerdict weigh_merge(const SpritePrice& a, const SpritePrice& b, const SpritePrice& together,
                           const RegroupOptions& options, double left_ms);
/// `renders_ms`: of the members whose sprites do not serve.
RegroupVerdict weigh_split(const SpritePrice& together, std::span<const SpritePrice> apart, double renders_ms,
                           const RegroupOptions& options, double left_ms);

/// "0.83 ms once and 0.11 ms a frame < 0.35 ms a frame, for 14 frames".
std::string in_words(const RegroupVerdict& verdict);

std::string_view name(Regroup by);            ///< "none", "amortised"
std::string_view name(RegroupPrices prices);  ///< "modelled", "durbin-1995"

/// First broken rule, or empty.
std::string first_defect(const RegroupOptions& options);

}  // namespace talisman::regulator
