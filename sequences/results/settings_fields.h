// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The settings of a run as one list of (name, value). Whatever writes, compares or hashes settings walks this
/// list, so that none of them can lack a field.
///
/// Names are those of the command line and of sequence files where the user can set the value there. Every
/// struct is taken apart by a structured binding, which no longer compiles when a member is added; that each
/// member is also named is tested (tests/sequences/results/settings_json_test.cpp).

#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace settings_fields {

template <typename Thresholds, typename Visit>
void thresholds(Thresholds& t, const Visit& visit) {
  auto& [geometric, magnification, minification, anisotropy, uncovered, turned, photometric, shadow_map,
         light_angle] = t;
  visit("geometric_px", geometric);
  visit("magnification", magnification);
  visit("minification", minification);
  visit("anisotropy", anisotropy);
  visit("uncovered_px", uncovered);
  visit("turned_px", turned);
  visit("photometric", photometric);
  visit("shadow_map_px", shadow_map);
  visit("light_angle_rad", light_angle);
}

template <typename Budget, typename Visit>
void budget(Budget& b, const Visit& visit) {
  auto& [polygons, pixels, chunks, ms, min_resolution, cutoff, choice, depth_complexity] = b;
  visit("budget_polygons", polygons);
  visit("budget_pixels", pixels);
  visit("budget_chunks", chunks);
  visit("budget_ms", ms);
  visit("min_resolution", min_resolution);
  visit("cutoff_px", cutoff);
  visit("choice", choice);
  visit("depth_complexity", depth_complexity);
}

template <typename Options, typename Visit>
void regulator(Options& options, const Visit& visit) {
  auto& [policy, hold_frames, stagger, blend_frames, color_warp, settle_frames, of_thresholds, lookahead,
         of_budget, predictive, of_regroup, refresh, lod, latency, kalman] = options;
  visit("policy", policy);
  visit("hold_frames", hold_frames);
  visit("stagger", stagger);
  visit("blend_frames", blend_frames);
  visit("color_warp", color_warp);
  visit("settle_frames", settle_frames);
  thresholds(of_thresholds, visit);
  auto& [lookahead_frames, predict] = lookahead;
  visit("lookahead_frames", lookahead_frames);
  visit("predict", predict);
  budget(of_budget, visit);
  auto& [children, joining, norm, intervals, adaptive] = predictive;
  visit("tree_k", children);
  visit("joining", joining);
  visit("motion_norm", norm);
  visit("intervals", intervals);
  visit("adaptive", adaptive);
  auto& [by, prices, ceiling, dwell, recency] = of_regroup;
  visit("regroup", by);
  visit("regroup_prices", prices);
  visit("regroup_ceiling_ms", ceiling);
  visit("regroup_dwell", dwell);
  visit("regroup_recency", recency);
  visit("refresh", refresh);
  auto& [lod_by, lod_benefit, first_appearance, px_per_polygon, feedback_gain] = lod;
  visit("lod", lod_by);
  visit("lod_benefit", lod_benefit);
  visit("first_appearance", first_appearance);
  visit("px_per_polygon", px_per_polygon);
  visit("feedback_gain", feedback_gain);
  auto& [render_ms, warp_ms, latency_predict] = latency;
  visit("latency_ms", render_ms);
  visit("latency_warp_ms", warp_ms);
  visit("latency_predict", latency_predict);
  auto& [place_noise, turn_noise, jerk_m, jerk_rad, coast_s, push_s] = kalman;
  visit("kalman_place_m", place_noise);
  visit("kalman_turn_rad", turn_noise);
  visit("kalman_jerk_m", jerk_m);
  visit("kalman_jerk_rad", jerk_rad);
  visit("kalman_coast_s", coast_s);
  visit("kalman_push_s", push_s);
}

template <typename FitOptions, typename Visit>
void fit(FitOptions& options, const Visit& visit) {
  auto& [relative_gap, max_iterations, decide] = options;
  visit("fit_relative_gap", relative_gap);
  visit("fit_max_iterations", max_iterations);
  visit("fit_decide_px", decide);
}

template <typename Extents, typename Placement, typename Visit>
void sprites(Extents& extents, Placement& placement, const Visit& visit) {
  auto& [expected_reuse, max_growth, whole] = extents;
  visit("expected_reuse_frames", expected_reuse);
  visit("max_growth", max_growth);
  visit("whole_extents", whole);
  auto& [directions, rotation_gain, resolution_scale, motion, motion_density, max_sprite] = placement;
  visit("slab_directions", directions);
  visit("min_rotation_gain", rotation_gain);
  visit("resolution_scale", resolution_scale);
  visit("motion", motion);
  visit("motion_density", motion_density);
  visit("max_sprite_px", max_sprite);
}

template <typename RenderOptions, typename Visit>
void render(RenderOptions& options, const Visit& visit) {
  auto& [shading, mipmaps, filter, max_anisotropy, samples, max_fragments, merge_depth, merge_color] =
      options;
  visit("shading", shading);
  visit("mipmaps", mipmaps);
  visit("texture_filter", filter);
  visit("max_anisotropy", max_anisotropy);
  visit("samples", samples);
  visit("max_fragments_per_chunk", max_fragments);
  visit("merge_depth", merge_depth);
  visit("merge_color", merge_color);
}

}  // namespace settings_fields

/// Calls visit(name, value) for every setting, always in the same order. `AnySettings` is Settings or const
/// Settings; the values are references into it.
template <typename AnySettings, typename Visit>
void for_each_setting(AnySettings& settings, const Visit& visit) {
  auto& [regulator, curve, own_warps, fit, view, bound, material_points, extents, placement, render,
         compression, explicit_order, cycles, compositor, fps, frames, budget_gap, late_chunks, visibility,
         accumulate, cells] = settings;
  static_cast<void>(cells);  // content: its files are part of the identity
  auto& [display, clip_margin] = view;
  visit("display_px", display);
  visit("clip_margin", clip_margin);
  settings_fields::regulator(regulator, visit);
  visit("warp", curve);
  visit("layers_own_warps", own_warps);
  settings_fields::fit(fit, visit);
  visit("bound", bound);
  visit("material_points", material_points);
  settings_fields::sprites(extents, placement, visit);
  settings_fields::render(render, visit);
  visit("compression", compression);
  visit("explicit_order", explicit_order);
  visit("cycles", cycles);
  visit("compositor", compositor);
  visit("fps", fps);
  visit("sequence_frames", frames);
  visit("budget_gap", budget_gap);
  visit("late_chunks", late_chunks);
  visit("visibility", visibility);
  visit("accumulate", accumulate);
}

}  // namespace talisman::sequences
