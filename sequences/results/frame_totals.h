// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is left of frames when their lines are written: what adds up, added up in their order. So a run of a million
/// frames takes no more memory than one of a thousand.

#include <cmath>
#include <cstdint>
#include <optional>

#include "sequences/results/frame_lines.h"

namespace talisman::sequences {

/// How far the greedy choice was from the best one. Mean and largest gap are those of the frames in which the
/// best one was proved.
struct GapSummary {
  int frames = 0;
  int exact_frames = 0;  ///< of them, the best choice was proved
  double mean = 0, max = 0;
};

/// Totals over the frames in which the layers were sorted.
struct VisibilityTotals {
  std::int64_t frames = 0, cyclic_frames = 0;
  std::int64_t queries = 0, pairs = 0, exact_tests = 0, swaps = 0, merged_layers = 0, merged_parts = 0;
};

/// Means over the frames; PSNR is that of the mean squared error, so that identical frames do not make it
/// infinite.
struct MeanQuality {
  double mse = 0, ssim = 0, flip = 0;
  double psnr_db() const { return mse > 0 ? 10 * std::log10(255.0 * 255.0 / mse) : INFINITY; }
};

/// Pixels at edges that layers share, where what is behind them shows.
struct OpenSeams {
  std::int64_t pixels = 0, most = 0;  ///< in all frames, and in the worst of them
  int worst_frame = -1;               ///< -1: none are open
};

/// Of a run that knows old poses only. Means: the sums.
struct LatencyTotals {
  int frames = 0;
  LatencyReport sum, most;
  double mean(double LatencyReport::*number) const { return frames > 0 ? sum.*number / frames : 0; }
};

/// Of a run that chooses levels within a budget.
struct LodTotals {
  int frames = 0, over = 0;  ///< over: the coarsest pictures alone exceed the budget
  std::int64_t skipped = 0;  ///< layers in view that were not shown, over all frames
  double benefit = 0, upper_bound = 0;
};

class FrameTotals {
 public:
  void add(const FrameLine& line);

  std::int64_t frames() const { return frames_; }
  int first_frame() const { return first_frame_; }  ///< 0 where there is none
  /// The polygons, pixels, chunks, samples, times and modelled times of all frames in the place of those of one; nothing
  /// else of a line adds up.
  const FrameLine& total() const { return total_; }
  const VisibilityTotals& visibility() const { return visibility_; }
  const ResolvedCounters& resolved() const { return resolved_; }  ///< registers: at most
  GapSummary gap() const;
  const std::optional<CompressionReport>& compression() const { return compression_; }
  const std::optional<std::int64_t>& upload_bytes() const { return upload_bytes_; }
  const std::optional<LookaheadReport>& lookahead() const { return lookahead_; }
  const std::optional<std::int64_t>& surprises() const { return surprises_; }  ///< of policy predictive
  std::int64_t edge_pixels() const { return edge_pixels_; }  ///< likewise: partly covered ones
  const LatencyTotals& latency() const { return latency_; }
  /// Layers and chunks of all frames, the largest step. Empty where no chunks are drawn alone.
  const std::optional<RefreshReport>& refresh() const { return refresh_; }
  const LodTotals& lod() const { return lod_; }
  double slowest_sort_ms() const { return slowest_sort_ms_; }
  /// Empty where no frame was compared.
  std::optional<MeanQuality> quality(Quality FrameQuality::*which) const;
  const std::optional<OpenSeams>& open_seams() const { return open_seams_; }  ///< empty: were not counted

 private:
  void add_quality(const FrameQuality& quality);

  std::int64_t frames_ = 0;
  int first_frame_ = 0, frames_compared_ = 0;
  FrameLine total_;
  VisibilityTotals visibility_;
  ResolvedCounters resolved_;
  GapSummary gap_;  ///< its mean: the sum
  std::optional<CompressionReport> compression_;
  std::optional<std::int64_t> upload_bytes_;
  std::optional<OpenSeams> open_seams_;
  std::optional<LookaheadReport> lookahead_;
  std::optional<std::int64_t> surprises_;
  std::int64_t edge_pixels_ = 0;
  LatencyTotals latency_;
  std::optional<RefreshReport> refresh_;
  LodTotals lod_;
  double slowest_sort_ms_ = 0;
  MeanQuality of_total_, of_reuse_, of_resampling_;  ///< the sums
};

}  // namespace talisman::sequences
