// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which inputs does a careless stage get wrong, and does ours get them right?
///
/// A hard case is an input with something special about it (no extent, no area, on the plane, 12 orders of
/// magnitude apart), a rule that the answer must keep, and how to measure it. The right answer never comes from the stage
/// itself: it is worked out in `long double`, by brute force over all possibilities, by another solver (Ceres), or
/// by the slow renderer and compositor of chunker/reference.h.
///
///   holds     error ≤ rule, and the stage answered
///   refused   error ≤ rule, and the stage said that there is no answer, as it should
///   broken    all else: a larger error, one that is not a number, an answer where there is none, no answer where there is
///
/// Every case is a pure function: equal in every run and for any number of threads.

#include <cmath>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace talisman::sequences {

enum class HardStage { Warps, Clipping, Polyhedra, Shading, Shadow, Order, Regulator, Compositor, Scale };
inline constexpr HardStage kAllHardStages[] = {
    HardStage::Warps, HardStage::Clipping,  HardStage::Polyhedra,  HardStage::Shading, HardStage::Shadow,
    HardStage::Order, HardStage::Regulator, HardStage::Compositor, HardStage::Scale};
std::string_view name(HardStage stage);

/// The larger of two errors ≥ 0; one that is not a number is as wrong as can be.
template <typename Real>
Real worse(Real worst_yet, Real error) {
  if (std::isnan(worst_yet) || std::isnan(error)) return static_cast<Real>(HUGE_VAL);
  return error <= worst_yet ? worst_yet : error;
}

/// What an answer must keep. All texts are literals.
struct HardRule {
  double most = 0;          ///< largest error that is allowed
  std::string_view unit;    ///< of the error, with what it is relative to: "ulp of the coordinates"
  std::string_view oracle;  ///< where the right answer comes from: "long double"
  bool refused = false;     ///< the stage must say that there is no answer
};

struct HardOutcome {
  double error = 0;
  bool refused = false;  ///< by a status, or by an empty result that the stage documents as such
};

struct HardCase {
  HardStage stage = HardStage::Warps;
  std::string_view name;     ///< unique within its stage
  std::string_view special;  ///< what is special
  /// How extreme it is: the ratio (of lengths, of counts, of brightness) that makes it hard; > 0. 1: what is special is
  /// not a magnitude.
  double extreme = 1;
  HardRule rule;
  std::function<HardOutcome()> measure;
};

/// The cases of each stage, in the order of the table.
std::vector<HardCase> hard_warps();
std::vector<HardCase> hard_clipping();
std::vector<HardCase> hard_polyhedra();
std::vector<HardCase> hard_shading();
std::vector<HardCase> hard_shadows();
std::vector<HardCase> hard_orders();
std::vector<HardCase> hard_regulation();
std::vector<HardCase> hard_composites();
std::vector<HardCase> hard_scales();
/// All of them, stage by stage.
std::vector<HardCase> all_hard_cases();

enum class HardStatus { Holds, Refused, Broken };
std::string_view name(HardStatus status);  ///< "holds", "refused as it should", "broken"

struct MeasuredHardCase {
  HardCase hard;
  HardOutcome outcome;
  HardStatus status = HardStatus::Broken;
};

MeasuredHardCase measure_hard_case(const HardCase& hard);

}  // namespace talisman::sequences
