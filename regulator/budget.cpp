// SPDX-License-Identifier: Apache-2.0
#include "regulator/budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "regulator/decision.h"
#include "regulator/policies.h"
#include "regulator/profile.h"
#include "regulator/resolution.h"

namespace talisman::regulator {

namespace {

std::int64_t less(std::int64_t budget, std::int64_t cost) {
  return budget == kNoLimit ? kNoLimit : std::max<std::int64_t>(budget - cost, 0);
}

double share(std::int64_t cost, std::int64_t budget) {
  if (budget == kNoLimit) return 0;
  return static_cast<double>(cost) / static_cast<double>(std::max<std::int64_t>(budget, 1));
}

/// What `ms` of work at `rate_per_s` can do. NaN counts as no limit: first_defect rejects it.
std::int64_t work_in(double ms, double rate_per_s) {
  const double work = std::floor(ms * 1e-3 * rate_per_s);
  return work < 9e18 ? static_cast<std::int64_t>(std::max(work, 0.0)) : kNoLimit;
}

bool appears(const LayerAssessment& layer) { return layer.in_view && !layer.has_sprite; }

double smear_px(const fiducials::Sampling& s) {
  return (std::fmax(s.magnification, 1) - 1) + (1 / std::fmin(s.minification, 1) - 1) +
         (std::fmax(s.anisotropy, 1) - 1);
}

/// One of the things of which there is a budget.
struct Limited {
  const char* what;
  std::int64_t needed, left, whole;
  bool by_time;  ///< the limit follows from budget_ms
};

std::array<Limited, 3> all_limited(const LayerCost& cost, const Budget& left,
                                   const RegulatorOptions& options) {
  const Budget whole = frame_budget(options);
  return {
      {{"polygons", cost.polygons, left.polygons, whole.polygons, whole.polygons < options.budget.polygons},
       {"pixels", cost.pixels, left.pixels, whole.pixels, whole.pixels < options.budget.pixels},
       {"chunks", cost.chunks, left.chunks, whole.chunks, false}}};
}

/// "polygons 5000 > 3000 left of 8000", for the first budget that is too small, or "dearer than the whole
/// budget of 4000 polygons, needs 5000"; empty if it fits.
std::string excess(const LayerCost& cost, const Budget& left, const RegulatorOptions& options) {
  if (left.affords(cost)) return {};
  const auto all = all_limited(cost, left, options);
  const auto time = [&](const Limited& l) {
    char text[48] = "";
    if (l.by_time) std::snprintf(text, sizeof text, " in %.4g ms", options.budget.ms);
    return std::string(text);
  };
  for (const Limited& l : all)
    if (l.needed > l.whole)
      return "dearer than the whole budget of " + std::to_string(l.whole) + " " + l.what + time(l) +
             ", needs " + std::to_string(l.needed);
  for (const Limited& l : all)
    if (l.needed > l.left)
      return std::string(l.what) + " " + std::to_string(l.needed) + " > " + std::to_string(l.left) +
             " left of " + std::to_string(l.whole) + time(l);
  return {};
}

/// "; resolution 0.81", or nothing at full resolution.
std::string at_resolution(double resolution) {
  if (resolution == 1) return {};
  char text[40];
  std::snprintf(text, sizeof text, "; resolution %.3g", resolution);
  return text;
}

/// The old sprite where a render is not worth it or not affordable: warped if its warp is sound.
LayerDecision keep(const LayerAssessment& layer, std::string reason) {
  if (layer.identical || has_sound_fit(layer)) return reuse(layer, std::move(reason));
  return reuse_in_place(layer, reason + ", no warp");
}

/// Decisions that do not depend on the budget; candidates stay as "cut-off" until they are ranked.
LayerDecision decide_without_budget(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (!layer.in_view) return drop(layer);
  if (!layer.has_sprite) return rerender(layer, "first_appearance" + at_resolution(layer.resolution));
  if (nothing_to_gain(layer)) return reuse(layer, "unchanged" + at_resolution(layer.resolution_then));
  const double benefit = benefit_px(layer);
  if (benefit > options.budget.cutoff_px) return keep(layer, "deferred: max_update_rate");
  return keep(layer, comparison("benefit", benefit, "<=", options.budget.cutoff_px, "px"));
}

/// First appearances spend first, whatever is left.
Budget draw_first_appearances(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                              std::vector<LayerDecision>& decisions) {
  Budget left = frame_budget(options);
  for (std::size_t i = 0; i < assessments.size(); ++i) {
    if (!appears(assessments[i])) continue;
    const std::string overdraft = excess(assessments[i].cost, left, options);
    if (!overdraft.empty()) decisions[i].reason += "; overdraws budget: " + overdraft;
    left = after(left, assessments[i].cost);
  }
  return left;
}

}  // namespace

double benefit_px(const LayerAssessment& layer) {
  if (nothing_to_gain(layer)) return 0;
  if (!has_sound_fit(layer) || due_by_minimum_rate(layer)) return kMostBenefitPx;
  const fiducials::Report& f = layer.fiducials;
  const layers::FiducialWeights& w = layer.preferences.importance;
  // A weight of zero silences its fiducial even where that is unbounded.
  const auto weighted = [](double weight, double px) { return weight > 0 ? weight * px : 0; };
  // What is not computed cannot matter.
  const double light_px = f.photometric.computed ? kPxPerLight * f.photometric.color : 0;
  const double hidden_px =
      (f.visibility.computed ? f.visibility.uncovered_px : 0) + (f.turned.computed ? f.turned.px : 0);
  const double benefit = weighted(w.geometric, f.geometric.px) + weighted(w.photometric, light_px) +
                         weighted(w.sampling, smear_px(f.sampling)) + weighted(w.visibility, hidden_px);
  return benefit < kMostBenefitPx ? benefit : kMostBenefitPx;  // NaN too
}

Budget frame_budget(const RegulatorOptions& options) {
  Budget budget{options.budget.polygons, options.budget.pixels, options.budget.chunks};
  const HardwareProfile& profile = talisman_1996();
  budget.polygons = std::min(budget.polygons, work_in(options.budget.ms, profile.polygons_per_s));
  budget.pixels = std::min(budget.pixels, work_in(options.budget.ms, profile.renderer_pixels_per_s));
  return budget;
}

bool is_limited(const RegulatorOptions& options) {
  const Budget budget = frame_budget(options);
  return budget.polygons != kNoLimit || budget.pixels != kNoLimit || budget.chunks != kNoLimit;
}

Budget after(const Budget& budget, const LayerCost& cost) {
  return {less(budget.polygons, cost.polygons), less(budget.pixels, cost.pixels),
          less(budget.chunks, cost.chunks)};
}

double share_of_budget(const LayerCost& cost, const Budget& budget) {
  return share(cost.polygons, budget.polygons) + share(cost.pixels, budget.pixels) +
         share(cost.chunks, budget.chunks);
}

void sort_by_benefit_per_cost(std::vector<Candidate>& candidates, const Budget& budget) {
  const bool limited = budget.polygons != kNoLimit || budget.pixels != kNoLimit || budget.chunks != kNoLimit;
  const auto urgency = [&](const Candidate& c) {
    const double cost = limited ? share_of_budget(c.cost, budget) : 1;
    return cost > 0 ? c.benefit_px / cost : HUGE_VAL;
  };
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    const double of_a = urgency(a), of_b = urgency(b);
    return of_a != of_b ? of_a > of_b : a.layer < b.layer;
  });
}

bool is_candidate(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (!layer.in_view || !layer.has_sprite || !(benefit_px(layer) > options.budget.cutoff_px)) return false;
  return !(has_sound_fit(layer) && barred_by_maximum_rate(layer));
}

std::vector<Candidate> candidates_of(std::span<const LayerAssessment> assessments,
                                     const RegulatorOptions& options) {
  std::vector<Candidate> candidates;
  for (const LayerAssessment& layer : assessments)
    if (is_candidate(layer, options)) candidates.push_back({layer.layer, benefit_px(layer), layer.cost});
  return candidates;
}

Budget left_after_first_appearances(std::span<const LayerAssessment> assessments,
                                    const RegulatorOptions& options) {
  Budget left = frame_budget(options);
  for (const LayerAssessment& layer : assessments)
    if (appears(layer)) left = after(left, layer.cost);
  return left;
}

std::vector<LayerDecision> decide_budget(std::span<const LayerAssessment> assessments,
                                         const RegulatorOptions& options) {
  std::vector<LayerDecision> decisions;
  decisions.reserve(assessments.size());
  for (const LayerAssessment& layer : assessments) decisions.push_back(decide_without_budget(layer, options));
  Budget left = draw_first_appearances(assessments, options, decisions);

  const auto index_of = [&](int layer) {
    return std::find_if(assessments.begin(), assessments.end(),
                        [layer](const LayerAssessment& a) { return a.layer == layer; }) -
           assessments.begin();
  };
  std::vector<Candidate> order = candidates_of(assessments, options);
  sort_by_benefit_per_cost(order, left);
  for (const Candidate& candidate : order) {
    const LayerAssessment& layer = assessments[index_of(candidate.layer)];
    const std::string gain = comparison("benefit", candidate.benefit_px, ">", options.budget.cutoff_px, "px");
    const std::string lack = excess(candidate.cost, left, options);
    LayerDecision& decision = decisions[index_of(candidate.layer)];
    const std::string detail = gain + at_resolution(layer.resolution);
    decision =
        lack.empty() ? rerender(layer, detail) : keep(layer, "deferred: budget, " + lack + "; " + detail);
    decision.short_of_area = candidate.cost.pixels > left.pixels || candidate.cost.chunks > left.chunks;
    if (lack.empty()) left = after(left, candidate.cost);
  }
  return decisions;
}

}  // namespace talisman::regulator
