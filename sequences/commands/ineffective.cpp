// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/ineffective.h"

#include <algorithm>

#include "sequences/content/value_type.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;

struct Group {
  std::vector<Policy> readers;
  std::vector<std::string> given;
};

class Given {
 public:
  explicit Given(std::vector<std::string>& names) : names_(names) {}
  template <typename T>
  Given& operator()(const char* name, const std::optional<T>& value) {
    return add(name, value.has_value());
  }
  Given& operator()(const char* name, const std::string& value) { return add(name, !value.empty()); }

 private:
  Given& add(const char* name, bool is_given) {
    if (is_given) names_.emplace_back(name);
    return *this;
  }
  std::vector<std::string>& names_;
};

bool is_read_by(const Group& group, Policy policy) {
  return std::find(group.readers.begin(), group.readers.end(), policy) != group.readers.end();
}

std::vector<Group> groups_of(const CommandLine& line, bool is_late) {
  using enum Policy;
  std::vector<Group> groups = {{{Hold, Interpolate}, {}},
                               {{Lookahead, Predictive}, {}},
                               {{Budget}, {}},
                               {{Threshold, Lookahead, Oracle, Predictive}, {}},
                               {{Threshold}, {}},
                               // Budget adds these to the benefit; interpolate follows the light by them.
                               {{Interpolate, Threshold, Budget, Lookahead, Oracle}, {}},
                               {{Interpolate}, {}},
                               {{Interpolate, Threshold, Lookahead, Oracle}, {}},
                               {{Predictive}, {}},
                               {{Lookahead, Predictive}, {}},
                               {{Threshold}, {}},
                               {{Reference, Threshold, Budget}, {}},
                               {{Budget}, {}}};
  Given(groups[0].given)("--hold", line.hold);
  Given(groups[1].given)("--lookahead", line.lookahead);
  Given(groups[2].given)("--budget-polygons", line.budget_polygons)("--budget-pixels", line.budget_pixels)(
      "--budget-chunks", line.budget_chunks)("--min-resolution", line.min_resolution)(
      "--cutoff-px", line.cutoff_px)("--choice", line.choice)("--depth-complexity", line.depth_complexity);
  Given(groups[3].given)("--geometric-px", line.geometric_px);
  Given(groups[4].given)("--shadow-map-px", line.shadow_map_px);
  Given(groups[5].given)("--photometric", line.photometric)("--light-angle-deg", line.light_angle_deg)(
      "--turned-px", line.turned_px)("--color-warp", line.color_warp);
  Given(groups[6].given)("--stagger", line.stagger);
  Given(groups[7].given)("--blend", line.blend);
  Given(groups[8].given)("--tree-k", line.tree_k)("--joining", line.joining)(
      "--motion-norm", line.motion_norm)("--intervals", line.intervals)("--adaptive", line.adaptive);
  if (!is_late) Given(groups[9].given)("--predict", line.predict);
  Given(groups[10].given)("--regroup", line.regroup)("--regroup-prices", line.regroup_prices)(
      "--regroup-ceiling-ms", line.regroup_ceiling_ms)("--regroup-dwell", line.regroup_dwell)("--refresh",
                                                                                              line.refresh);
  Given(groups[11].given)("--lod", line.lod)("--px-per-polygon", line.px_per_polygon)("--feedback-gain",
                                                                                      line.feedback_gain);
  Given(groups[12].given)("--benefit", line.lod_benefit)("--first-appearance", line.first_appearance);
  // Feedback has a target.
  const bool has_target = line.lod == regulator::name(regulator::LodSelector::Feedback);
  Given(groups[has_target ? 11 : 2].given)("--budget-ms", line.budget_ms);
  return groups;
}

}  // namespace

std::string of_another_policy(const CommandLine& line, Policy policy, bool is_late) {
  for (const Group& group : groups_of(line, is_late)) {
    if (group.given.empty() || is_read_by(group, policy)) continue;
    std::vector<std::string> readers;
    for (const Policy reader : group.readers) readers.emplace_back(regulator::name(reader));
    const bool is_one = group.given.size() == 1;
    return listed(group.given, "and") + (is_one ? " is no option" : " are no options") + " of policy " +
           std::string(regulator::name(policy)) + "; " + (readers.size() == 1 ? "policy " : "the policies ") +
           listed(readers, "and") + (readers.size() == 1 ? " has " : " have ") + (is_one ? "it" : "them");
  }
  return {};
}

std::vector<std::string> options_of_other_policies(const CommandLine& line, Policy policy) {
  std::vector<std::string> names;
  for (const Group& group : groups_of(line, !line.latency_ms.empty()))
    if (!is_read_by(group, policy)) names.insert(names.end(), group.given.begin(), group.given.end());
  return names;
}

}  // namespace talisman::sequences
