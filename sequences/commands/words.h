// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The words of the command line: what an option with a choice may be, once for reading it, for the help and
/// for printing it.
///
///   choice("--bound", "dop14", kBoundWords)      BoundKind::Dop14
///   choice("--bound", "ball", kBoundWords)       error: --bound is 'ball', must be one of box8, dop14, dop26
///   alternatives(kBoundWords)                    "box8, dop14 or dop26"
///   word_of(BoundKind::Dop14, kBoundWords)       "dop14"

#include <array>
#include <string>
#include <string_view>

#include "chunker/render.h"
#include "layers/layer.h"
#include "layers/polyhedron.h"
#include "regulator/plan.h"
#include "sequences/content/sequence.h"
#include "sequences/files/errors.h"
#include "sequences/files/image_io.h"
#include "sequences/files/progress.h"
#include "sequences/pipeline/frame_order.h"
#include "sequences/results/run_options.h"
#include "warp/warp.h"

namespace talisman::sequences {

template <typename T>
struct Word {
  std::string_view text;
  T value;
};

template <typename T, std::size_t N>
using Words = std::array<Word<T>, N>;

inline constexpr Words<regulator::LodSelector, 4> kLodWords{{{"none", regulator::LodSelector::None},
                                                             {"static", regulator::LodSelector::Static},
                                                             {"feedback", regulator::LodSelector::Feedback},
                                                             {"optimise", regulator::LodSelector::Optimise}}};

inline constexpr Words<regulator::LodBenefit, 2> kLodBenefitWords{
    {{"printed", regulator::LodBenefit::Printed}, {"error", regulator::LodBenefit::Error}}};

inline constexpr Words<regulator::FirstAppearance, 3> kFirstAppearanceWords{
    {{"draw", regulator::FirstAppearance::Draw},
     {"coarsest", regulator::FirstAppearance::Coarsest},
     {"skip", regulator::FirstAppearance::Skip}}};

inline constexpr Words<bool, 2> kSwitchWords{{{"on", true}, {"off", false}}};

inline constexpr Words<ProgressKind, 4> kProgressWords{{{"auto", ProgressKind::Auto},
                                                        {"bar", ProgressKind::Bar},
                                                        {"plain", ProgressKind::Plain},
                                                        {"none", ProgressKind::None}}};

inline constexpr Words<FrameFormat, 4> kFormatWords{{{"png", FrameFormat::Png},
                                                     {"exr", FrameFormat::Exr},
                                                     {"exr-layers", FrameFormat::ExrLayers},
                                                     {"none", FrameFormat::None}}};

inline constexpr Words<layers::BoundKind, 3> kBoundWords{{{"box8", layers::BoundKind::Box8},
                                                          {"dop14", layers::BoundKind::Dop14},
                                                          {"dop26", layers::BoundKind::Dop26}}};

inline constexpr Words<layers::OrderGroup, 3> kOrderGroupWords{
    {{"background", layers::OrderGroup::Background},
     {"normal", layers::OrderGroup::Normal},
     {"foreground", layers::OrderGroup::Foreground}}};

inline constexpr Words<Cycles, 2> kCyclesWords{{{"merge", Cycles::Merge}, {"keep", Cycles::Keep}}};

inline constexpr Words<Seam, 2> kSeamWords{{{"none", Seam::None}, {"auto", Seam::Auto}}};

inline constexpr Words<Compositor, 2> kCompositorWords{
    {{"talisman", Compositor::Talisman}, {"extended", Compositor::Extended}}};

inline constexpr Words<chunker::Shading, 3> kShadingWords{{{"flat", chunker::Shading::Flat},
                                                           {"gouraud", chunker::Shading::Gouraud},
                                                           {"phong", chunker::Shading::Phong}}};

inline constexpr Words<DecisionLines, 3> kDecisionLinesWords{
    {{"all", DecisionLines::All}, {"changed", DecisionLines::Changed}, {"none", DecisionLines::None}}};

/// Of an enumeration whose library has a name(value) for each.
template <typename T, std::size_t N>
Words<T, N> words_of(const std::array<T, N>& values) {
  Words<T, N> words{};
  for (std::size_t k = 0; k < N; ++k) words[k] = {name(values[k]), values[k]};
  return words;
}

inline const auto kCurveWords = words_of(warp::kAllCurves);
inline const auto kPolicyWords = words_of(regulator::kAllPolicies);
inline const auto kPredictionWords = words_of(regulator::kAllPredictions);
inline const auto kJoiningWords = words_of(regulator::kAllJoinings);

inline constexpr Words<regulator::Intervals, 2> kIntervalsWords{
    {{"fixed", regulator::Intervals::Fixed}, {"data", regulator::Intervals::Data}}};
inline constexpr Words<regulator::MotionNorm, 2> kMotionNormWords{
    {{"axis", regulator::MotionNorm::Axis}, {"euclid", regulator::MotionNorm::Euclid}}};
inline const auto kRegroupWords = words_of(regulator::kAllRegroups);
inline const auto kRefreshWords = words_of(regulator::kAllRefreshes);
inline const auto kRegroupPricesWords = words_of(regulator::kAllRegroupPrices);
inline const auto kChoiceRuleWords = words_of(regulator::kAllChoiceRules);

/// "a, b<last>c".
template <typename T, std::size_t N>
std::string listed(const Words<T, N>& words, std::string_view last) {
  std::string text(words[0].text);
  for (std::size_t k = 1; k < N; ++k)
    text += std::string(k + 1 < N ? ", " : last) + std::string(words[k].text);
  return text;
}

/// For the help: "a, b or c".
template <typename T, std::size_t N>
std::string alternatives(const Words<T, N>& words) {
  return listed(words, " or ");
}

/// The value that a word of an option stands for. Throws InputError that lists the words.
template <typename T, std::size_t N>
T choice(std::string_view option, std::string_view text, const Words<T, N>& words) {
  for (const Word<T>& word : words)
    if (word.text == text) return word.value;
  throw InputError(std::string(option) + " is '" + std::string(text) + "', must be one of " +
                   listed(words, ", "));
}

/// The word of a value; `other` where it has none.
template <typename T, std::size_t N>
std::string_view word_of(T value, const Words<T, N>& words, std::string_view other = "?") {
  for (const Word<T>& word : words)
    if (word.value == value) return word.text;
  return other;
}

}  // namespace talisman::sequences
