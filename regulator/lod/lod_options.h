// SPDX-License-Identifier: Apache-2.0
#pragma once

/// At which level of detail is a layer drawn, and who decides that? [Fu93 4]

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace talisman::regulator {

enum class LodSelector {
  None,      ///< the finest level always
  Static,    ///< the finest whose triangles are large enough on the display
  Feedback,  ///< likewise, with a size that follows from how long the last frame was
  Optimise,  ///< what gives most within the budget of the frame (regulator/lod/solver.h)
};
inline constexpr std::array kAllLodSelectors = {LodSelector::None, LodSelector::Static, LodSelector::Feedback,
                                                LodSelector::Optimise};
std::string_view name(LodSelector selector);  ///< "none", "static", "feedback", "optimise"
std::optional<LodSelector> lod_selector_from_name(std::string_view text);

/// What is a picture of a layer worth (regulator/lod/benefit.h)?
enum class LodBenefit {
  Printed,  ///< the six factors of [Fu93 4.2]: guesses before anything is drawn
  Error,    ///< the error that is shown without it, less that with it, px
};
inline constexpr std::array kAllLodBenefits = {LodBenefit::Printed, LodBenefit::Error};
std::string_view name(LodBenefit benefit);  ///< "printed", "error"
std::optional<LodBenefit> lod_benefit_from_name(std::string_view text);

/// What is shown of a layer in the first frame in which it is in view?
enum class FirstAppearance {
  Draw,      ///< its finest level, beyond any budget
  Coarsest,  ///< its coarsest level in any case, a finer one if the budget affords it
  Skip,      ///< nothing, unless the budget affords it
};
inline constexpr std::array kAllFirstAppearances = {FirstAppearance::Draw, FirstAppearance::Coarsest,
                                                    FirstAppearance::Skip};
std::string_view name(FirstAppearance first);  ///< "draw", "coarsest", "skip"
std::optional<FirstAppearance> first_appearance_from_name(std::string_view text);

struct LodOptions {
  LodSelector by = LodSelector::None;
  LodBenefit benefit = LodBenefit::Error;
  FirstAppearance first_appearance =
      FirstAppearance::Coarsest;  ///< only of layers that have levels; the others are drawn
  /// ≥ 0; Static: S, display pixels for each triangle; more is coarser. [Fu93 4.5]
  double px_per_polygon = 1024;
  /// > 0; Feedback: what is added to S by a frame twice as long as it should be; more follows sooner and swings more.
  double feedback_gain = 256;
  bool operator==(const LodOptions&) const = default;
};

/// First broken rule, or empty.
std::string first_defect(const LodOptions& options);

}  // namespace talisman::regulator
