// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/frame_totals.h"

#include <algorithm>

namespace talisman::sequences {

namespace {

void add_counters(FrameLine& sum, const FrameLine& line) {
  sum.polygons.rendered += line.polygons.rendered;
  sum.polygons.reference += line.polygons.reference;
  sum.pixels.rendered += line.pixels.rendered;
  sum.pixels.reference += line.pixels.reference;
  sum.pixels.filled += line.pixels.filled;
  sum.pixels.composited += line.pixels.composited;
  sum.pixels.registers += line.pixels.registers;
  sum.chunks.rendered += line.chunks.rendered;
  sum.chunks.clear += line.chunks.clear;
  sum.fragments += line.fragments;
  sum.texture_samples += line.texture_samples;
  sum.modelled_ms += line.modelled_ms;
  sum.modelled_drawing_ms += line.modelled_drawing_ms;
}

void add_times(FrameTimes& sum, const FrameTimes& times) {
  sum.plan_ms += times.plan_ms;
  sum.render_ms += times.render_ms;
  sum.composite_ms += times.composite_ms;
  sum.io_ms += times.io_ms;
  sum.sort_ms += times.sort_ms;
  sum.compress_ms += times.compress_ms;
  sum.late_pixels += times.late_pixels;
}

void add_sort(const VisibilityLine& line, VisibilityTotals& sum, ResolvedCounters& resolved) {
  const layers::VisibilityCounters& c = line.counters;
  ++sum.frames;
  sum.cyclic_frames += c.merged_components + line.resolved.components > 0;
  sum.queries += c.queries;
  sum.pairs += c.pairs;
  sum.exact_tests += c.exact_tests;
  sum.swaps += c.swaps;
  sum.merged_layers += c.merged_layers;
  sum.merged_parts += line.merged_parts;
  resolved.components += line.resolved.components;
  resolved.layers += line.resolved.layers;
  resolved.reads += line.resolved.reads;
  resolved.operators += line.resolved.operators;
  resolved.registers = std::max(resolved.registers, line.resolved.registers);
}

void add_gap(const regulator::BudgetGap& gap, GapSummary& sum) {
  ++sum.frames;
  if (!gap.exact) return;  // nothing is known of it
  ++sum.exact_frames;
  sum.mean += gap.gap();
  sum.max = std::max(sum.max, gap.gap());
}

void add_latency(const LatencyReport& late, LatencyTotals& totals) {
  ++totals.frames;
  for (double LatencyReport::*number :
       {&LatencyReport::drawn_turn_deg, &LatencyReport::shown_turn_deg, &LatencyReport::drawn_moved_m,
        &LatencyReport::shown_moved_m, &LatencyReport::true_px, &LatencyReport::true_mean_px}) {
    totals.sum.*number += late.*number;
    totals.most.*number = std::max(totals.most.*number, late.*number);
  }
  totals.sum.layers_missing += late.layers_missing;
  totals.most.layers_missing = std::max(totals.most.layers_missing, late.layers_missing);
}

void add_refresh_of(const RefreshReport& frame, std::optional<RefreshReport>& sum) {
  if (!sum) sum.emplace();
  sum->layers += frame.layers;
  sum->chunks += frame.chunks;
  sum->step_px = std::max(sum->step_px, frame.step_px);
  sum->torn_borders += frame.torn_borders;
}

void add_comparison(const Quality& quality, MeanQuality& sum) {
  sum.mse += std::isfinite(quality.psnr_db) ? 255.0 * 255.0 / std::pow(10.0, quality.psnr_db / 10) : 0;
  sum.ssim += quality.ssim;
  sum.flip += quality.flip;
}

}  // namespace

void FrameTotals::add(const FrameLine& line) {
  if (frames_++ == 0) first_frame_ = line.frame;
  add_counters(total_, line);
  add_times(total_.times, line.times);
  slowest_sort_ms_ = std::max(slowest_sort_ms_, line.times.sort_ms);
  if (line.visibility) add_sort(*line.visibility, visibility_, resolved_);
  if (line.budget_gap) add_gap(*line.budget_gap, gap_);
  if (line.latency) add_latency(*line.latency, latency_);
  if (line.refresh) add_refresh_of(*line.refresh, refresh_);
  if (line.lod) {
    ++lod_.frames;
    lod_.over += !line.lod->fits;
    lod_.skipped += line.lod->skipped;
    lod_.benefit += line.lod->benefit;
    lod_.upper_bound += line.lod->upper_bound;
  }
  if (line.upload_bytes) upload_bytes_ = upload_bytes_.value_or(0) + *line.upload_bytes;
  if (line.predictive) {
    surprises_ = surprises_.value_or(0) + line.predictive->surprises;
    edge_pixels_ += line.predictive->edge_pixels;
  }
  if (line.lookahead) {
    if (!lookahead_) lookahead_.emplace();
    lookahead_->judged += line.lookahead->judged;
    lookahead_->evaluated += line.lookahead->evaluated;
  }
  if (line.compression) {
    if (!compression_) compression_.emplace();
    *compression_ += *line.compression;
  }
  if (line.quality) add_quality(*line.quality);
  if (!line.open_seam_pixels) return;
  if (!open_seams_) open_seams_.emplace();
  open_seams_->pixels += *line.open_seam_pixels;
  if (*line.open_seam_pixels <= open_seams_->most) return;
  open_seams_->most = *line.open_seam_pixels;
  open_seams_->worst_frame = line.frame;
}

void FrameTotals::add_quality(const FrameQuality& quality) {
  ++frames_compared_;
  add_comparison(quality.total, of_total_);
  add_comparison(quality.reuse, of_reuse_);
  add_comparison(quality.resampling, of_resampling_);
}

GapSummary FrameTotals::gap() const {
  GapSummary gap = gap_;
  if (gap.exact_frames > 0) gap.mean /= gap.exact_frames;
  return gap;
}

std::optional<MeanQuality> FrameTotals::quality(Quality FrameQuality::*which) const {
  if (frames_compared_ == 0) return std::nullopt;
  MeanQuality mean = which == &FrameQuality::total   ? of_total_
                     : which == &FrameQuality::reuse ? of_reuse_
                                                     : of_resampling_;
  for (double* value : {&mean.mse, &mean.ssim, &mean.flip}) *value /= frames_compared_;
  return mean;
}

}  // namespace talisman::sequences
