// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/papers.h"

#include <algorithm>
#include <set>

#include "sequences/experiments/reproduction/barnyard_pictures.h"
#include "sequences/experiments/reproduction/durbin/amortised_95.h"
#include "sequences/experiments/reproduction/fearing/fixed_cost_96.h"
#include "sequences/experiments/reproduction/fearing/operations.h"
#include "sequences/experiments/reproduction/fearing/skipped.h"
#include "sequences/experiments/reproduction/fearing/speed_ups_96.h"
#include "sequences/experiments/reproduction/figure_21.h"
#include "sequences/experiments/reproduction/figure_22.h"
#include "sequences/experiments/reproduction/figure_23.h"
#include "sequences/experiments/reproduction/figure_24.h"
#include "sequences/experiments/reproduction/figures_15_16.h"
#include "sequences/experiments/reproduction/funkhouser/culling_93.h"
#include "sequences/experiments/reproduction/funkhouser/memory_93.h"
#include "sequences/experiments/reproduction/machine.h"
#include "sequences/experiments/reproduction/shadow_appendix.h"
#include "sequences/experiments/reproduction/speed_ups.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

Paper lengyel_snyder_1997() {
  return {"LS97",
          "Lengyel and Snyder, Rendering with Coherent Layers, SIGGRAPH 1997",
          {figure_15(), figure_16(), warp_pictures(), moving_cameras(), figure_21(), barnyard_pictures(),
           figure_22(), figure_23(), figure_24(), fixed_cameras(), shadow_appendix(), published_machine()}};
}

Paper fearing_1996() {
  return {"F96",
          "Fearing, Predictive Rendering, MSc thesis, University of British Columbia 1996",
          {operation_counts_96(), skipped_polygons_96(), speed_ups_96(), motion_thresholds_96(),
           fixed_cost_item_96()}};
}

Paper durbin_1995() {
  return {
      "D95",
      "Durbin, Gossweiler and Pausch, Amortizing 3D Graphics Optimization Across Multiple Frames, UIST 1995",
      {utility_test_95(), amusement_park_95()}};
}

Paper funkhouser_1993() {
  return {
      "Fu93",
      "Funkhouser, Database and Display Algorithms for Interactive Visualization of Architectural Models, "
      "PhD thesis, University of California at Berkeley 1993",
      {visibility_93(), prefetch_93(), queues_93()}};
}

std::string known_ids(const std::vector<Paper>& papers) {
  std::string text;
  for (const Paper& paper : papers) {
    text += (text.empty() ? "" : ", ") + paper.tag;
    for (const Item& item : paper.items) text += ", " + full_id(paper, item);
  }
  return text;
}

bool is_known(const std::vector<Paper>& papers, const std::string& id) {
  return std::any_of(papers.begin(), papers.end(), [&](const Paper& paper) {
    return paper.tag == id || std::any_of(paper.items.begin(), paper.items.end(),
                                          [&](const Item& item) { return full_id(paper, item) == id; });
  });
}

}  // namespace

std::vector<Paper> all_papers() {
  return {lengyel_snyder_1997(), fearing_1996(), durbin_1995(), funkhouser_1993()};
}

std::vector<Paper> chosen_papers(const std::vector<Paper>& papers, const std::vector<std::string>& only) {
  if (only.empty()) return papers;
  for (const std::string& id : only)
    if (!is_known(papers, id))
      throw InputError("--only is '" + id + "', must be one of " + known_ids(papers));
  const std::set<std::string> wanted(only.begin(), only.end());
  std::vector<Paper> chosen;
  for (Paper paper : papers) {
    if (!wanted.count(paper.tag))
      std::erase_if(paper.items, [&](const Item& item) { return !wanted.count(full_id(paper, item)); });
    if (!paper.items.empty()) chosen.push_back(std::move(paper));
  }
  return chosen;
}

}  // namespace talisman::sequences
