// SPDX-License-Identifier: Apache-2.0
#include "regulator/regroup.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "regulator/profile.h"

namespace talisman::regulator {

namespace {

bool by_polygons(const RegroupOptions& options) { return options.prices == RegroupPrices::Durbin1995; }

/// `margin_ms`: what a frame must save at least.
RegroupVerdict verdict_on(const Amortisation& terms, double frames, double margin_ms, double left_ms) {
  const Amortisation damped{terms.unoptimised_ms - margin_ms, terms.optimised_ms, terms.once_ms};
  RegroupVerdict verdict{terms, frames, pays(damped, frames), false};
  verdict.is_above_ceiling = verdict.pays && !(terms.once_ms <= left_ms);
  return verdict;
}

}  // namespace

SpritePrice modelled_price(std::int64_t polygons, std::int64_t texels, double shown_px, double run_frames) {
  const HardwareProfile& profile = talisman_1996();
  SpritePrice price;
  price.render_ms = modelled_time(profile, polygons, texels, 0).render_ms;
  price.reuse_ms = 1e3 * shown_px / profile.compositor_pixels_per_s + kReuseOverhead_ms;
  price.run_frames = run_frames > 1 ? run_frames : 1;  // NaN as well
  price.polygons = polygons;
  return price;
}

RegroupVerdict weigh_merge(const SpritePrice& a, const SpritePrice& b, const SpritePrice& together,
                           const RegroupOptions& options, double left_ms) {
  if (by_polygons(options))
    return verdict_on(durbin_1995(together.polygons), together.run_frames, 0, left_ms);
  const Amortisation terms{a.ms_per_frame() + b.ms_per_frame(), together.reuse_ms, together.render_ms};
  const double margin_ms = kRegroupMargin * std::min(a.ms_per_frame(), b.ms_per_frame());
  return verdict_on(terms, together.run_frames, margin_ms, left_ms);
}

RegroupVerdict weigh_split(const SpritePrice& together, std::span<const SpritePrice> apart, double renders_ms,
                           const RegroupOptions& options, double left_ms) {
  if (by_polygons(options)) {  // apart is what is not optimised: nothing is paid for it
    const Amortisation shared = durbin_1995(together.polygons);
    const double shared_ms = shared.optimised_ms + shared.once_ms / together.run_frames;
    RegroupVerdict verdict{{shared_ms, shared.unoptimised_ms, 0}, together.run_frames, false, false};
    verdict.pays = !pays(shared, together.run_frames);
    return verdict;
  }
  Amortisation terms{together.ms_per_frame(), 0, renders_ms};
  double frames = options.dwell_frames, least_ms = together.ms_per_frame();
  for (const SpritePrice& part : apart) {
    terms.optimised_ms += part.ms_per_frame();
    frames = std::max(frames, part.run_frames);
    least_ms = std::min(least_ms, part.ms_per_frame());
  }
  return verdict_on(terms, frames, kRegroupMargin * least_ms, left_ms);
}

std::string in_words(const RegroupVerdict& verdict) {
  char text[160];
  std::snprintf(text, sizeof text, "%.3g ms once and %.3g ms a frame < %.3g ms a frame, for %.3g frames",
                verdict.terms.once_ms, verdict.terms.optimised_ms, verdict.terms.unoptimised_ms,
                verdict.frames);
  return text;
}

std::string_view name(Regroup by) { return by == Regroup::Amortised ? "amortised" : "none"; }

std::string_view name(RegroupPrices prices) {
  return prices == RegroupPrices::Durbin1995 ? "durbin-1995" : "modelled";
}

std::string first_defect(const RegroupOptions& options) {
  char text[120] = "";
  if (!(options.ceiling_ms >= 0))
    std::snprintf(text, sizeof text, "regroup_ceiling_ms is %g, must be at least 0", options.ceiling_ms);
  else if (options.dwell_frames < 1)
    std::snprintf(text, sizeof text, "regroup_dwell is %d, must be at least 1", options.dwell_frames);
  else if (!(options.recency > 0 && options.recency <= 1))
    std::snprintf(text, sizeof text, "regroup_recency is %g, must be above 0 and at most 1", options.recency);
  return text;
}

}  // namespace talisman::regulator
