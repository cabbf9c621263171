// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/lod_options.h"

#include <cmath>

namespace talisman::regulator {
namespace {

template <typename T, std::size_t N>
std::optional<T> lod_word(std::string_view text, const std::array<T, N>& all) {
  for (const T one : all)
    if (name(one) == text) return one;
  return std::nullopt;
}

}  // namespace

std::string_view name(LodSelector selector) {
  constexpr std::array<std::string_view, 4> kNames = {"none", "static", "feedback", "optimise"};
  return kNames[static_cast<std::size_t>(selector)];
}

std::string_view name(LodBenefit benefit) { return benefit == LodBenefit::Printed ? "printed" : "error"; }

std::string_view name(FirstAppearance first) {
  constexpr std::array<std::string_view, 3> kNames = {"draw", "coarsest", "skip"};
  return kNames[static_cast<std::size_t>(first)];
}

std::optional<LodSelector> lod_selector_from_name(std::string_view text) {
  return lod_word(text, kAllLodSelectors);
}
std::optional<LodBenefit> lod_benefit_from_name(std::string_view text) {
  return lod_word(text, kAllLodBenefits);
}
std::optional<FirstAppearance> first_appearance_from_name(std::string_view text) {
  return lod_word(text, kAllFirstAppearances);
}

std::string first_defect(const LodOptions& options) {
  if (!(options.px_per_polygon >= 0 && std::isfinite(options.px_per_polygon)))
    return "px_per_polygon is " + std::to_string(options.px_per_polygon) + ", must be at least 0";
  if (!(options.feedback_gain > 0 && std::isfinite(options.feedback_gain)))
    return "feedback_gain is " + std::to_string(options.feedback_gain) + ", must be above 0";
  return {};
}

}  // namespace talisman::regulator
