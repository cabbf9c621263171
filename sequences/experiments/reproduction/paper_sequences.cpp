// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/paper_sequences.h"

#include <algorithm>

namespace talisman::sequences {

namespace {

/// One that ships is taken whether or not its content is there: the row then says what to fetch.
PaperSequence known_or(const std::string& name, const std::string& stand_in) {
  const std::vector<std::string> known = known_sequences();
  const bool is_known = std::find(known.begin(), known.end(), name) != known.end();
  return {is_known ? name : stand_in, is_known};
}

}  // namespace

PaperSequence barnyard_sequence() { return known_or("barnyard", "canyon"); }
PaperSequence canyon_sequence() { return known_or("canyon/1997", "canyon"); }
PaperSequence chicken_sequence() { return known_or("chicken", ""); }

std::vector<double> barnyard_thresholds() { return {0.1, 0.2, 0.4, 0.8}; }

BarnyardPlans barnyard_plans(PaperBench& bench, double speed) {
  const std::string name = barnyard_sequence().name;
  std::vector<PlanOf> all{triple_framing(name), interpolated_triple_framing(name)};
  for (const double px : barnyard_thresholds()) all.push_back(threshold_plan(name, px));
  for (PlanOf& of : all) of.speed = speed;
  bench.plan_all(all);
  BarnyardPlans plans{&bench.plan(all[0]), &bench.plan(all[1]), {}};
  for (std::size_t k = 2; k < all.size(); ++k) plans.thresholds.push_back(&bench.plan(all[k]));
  return plans;
}

}  // namespace talisman::sequences
