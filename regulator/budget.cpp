// SPDX-License-Identifier: Apache-2.0
#include "regulator/budget.h"

#include <algorithm>
#include <cmath>

#include "regulator/policies.h"
#include "regulator/profile.h"
#include "regulator/resolution.h"
#include "regulator/settle.h"

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

}  // namespace

double benefit_px(const LayerAssessment& layer, double unmended_px) {
  if (nothing_to_gain(layer)) return 0;
  if (!has_sound_fit(layer) || due_by_minimum_rate(layer) || !layer.new_picture.empty())
    return kMostBenefitPx;
  const fiducials::Report& f = layer.fiducials;
  const layers::FiducialWeights& w = layer.preferences.importance;
  // A weight of zero silences its fiducial even where that is unbounded.
  const auto weighted = [](double weight, double px) { return weight > 0 ? weight * px : 0; };
  // What is not computed cannot matter.
  const double light_px = f.photometric.computed ? kPxPerLight * f.photometric.color : 0;
  const double hidden_px =
      (f.visibility.computed ? f.visibility.uncovered_px : 0) + (f.turned.computed ? f.turned.px : 0);
  const double mended_px = f.geometric.px - unmended_px;
  const double benefit = weighted(w.geometric, mended_px < 0 ? 0 : mended_px) +
                         weighted(w.photometric, light_px) + weighted(w.sampling, smear_px(f.sampling)) +
                         weighted(w.visibility, hidden_px);
  return benefit < kMostBenefitPx ? benefit : kMostBenefitPx;  // NaN too
}

Budget frame_budget(const RegulatorOptions& options) {
  Budget budget{options.budget.polygons, options.budget.pixels, options.budget.chunks};
  const HardwareProfile& profile = talisman_1996();
  budget.polygons = std::min(budget.polygons, work_in(options.budget.ms, profile.polygons_per_s));
  const double filled_once = std::max(1.0, options.budget.depth_complexity);
  budget.pixels =
      std::min(budget.pixels, work_in(options.budget.ms, profile.renderer_pixels_per_s / filled_once));
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

bool is_candidate(const LayerAssessment& layer, const RegulatorOptions& options, double unmended_px) {
  if (!layer.in_view || !layer.has_sprite) return false;
  if (!(benefit_px(layer, unmended_px) > options.budget.cutoff_px) && !settles(layer, options)) return false;
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

}  // namespace talisman::regulator
