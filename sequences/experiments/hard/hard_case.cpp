// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/hard/hard_case.h"

namespace talisman::sequences {

std::string_view name(HardStage stage) {
  switch (stage) {
    case HardStage::Warps:
      return "warps";
    case HardStage::Clipping:
      return "clipping";
    case HardStage::Polyhedra:
      return "polyhedra";
    case HardStage::Shading:
      return "shading";
    case HardStage::Shadow:
      return "shadow";
    case HardStage::Order:
      return "order";
    case HardStage::Regulator:
      return "regulator";
    case HardStage::Compositor:
      return "compositor";
    case HardStage::Scale:
      return "scale";
  }
  return "";
}

std::string_view name(HardStatus status) {
  switch (status) {
    case HardStatus::Holds:
      return "holds";
    case HardStatus::Refused:
      return "refused as it should";
    case HardStatus::Broken:
      return "broken";
  }
  return "";
}

std::vector<HardCase> all_hard_cases() {
  std::vector<HardCase> all;
  for (const auto stage : {hard_warps, hard_clipping, hard_polyhedra, hard_shading, hard_shadows, hard_orders,
                           hard_regulation, hard_composites, hard_scales}) {
    const std::vector<HardCase> cases = stage();
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

MeasuredHardCase measure_hard_case(const HardCase& hard) {
  const HardOutcome outcome = hard.measure();
  const bool kept = outcome.error <= hard.rule.most && outcome.refused == hard.rule.refused;  // false for NaN
  const HardStatus answered = outcome.refused ? HardStatus::Refused : HardStatus::Holds;
  return {hard, outcome, kept ? answered : HardStatus::Broken};
}

}  // namespace talisman::sequences
