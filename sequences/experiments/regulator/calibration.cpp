// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/calibration.h"

#include <algorithm>
#include <array>
#include <map>

#include "layers/check.h"
#include "regulator/policies.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/shade_passes.h"

namespace talisman::sequences {
namespace {

using regulator::LayerAssessment;

constexpr int kEnoughSamples = 8;  ///< for a rank correlation of one layer, or a median of a bin

constexpr std::array kFiducials = {
    CalibratedFiducial{"geometric", "geometric fiducial", "px",
                       [](const LayerAssessment& a) { return a.fiducials.geometric.px; }},
    CalibratedFiducial{
        "magnification", "sampling fiducial: magnification beyond 1", "%",
        [](const LayerAssessment& a) { return 100 * std::fmax(a.fiducials.sampling.magnification - 1, 0); }},
    CalibratedFiducial{
        "minification", "sampling fiducial: minification below 1", "%",
        [](const LayerAssessment& a) { return 100 * std::fmax(1 - a.fiducials.sampling.minification, 0); }},
    CalibratedFiducial{
        "anisotropy", "sampling fiducial: anisotropy beyond 1", "%",
        [](const LayerAssessment& a) { return 100 * std::fmax(a.fiducials.sampling.anisotropy - 1, 0); }},
    CalibratedFiducial{"visibility", "visibility fiducial: depth of uncovered edges", "px",
                       [](const LayerAssessment& a) {
                         return a.fiducials.visibility.computed ? a.fiducials.visibility.uncovered_px : NAN;
                       }},
    CalibratedFiducial{"photometric", "photometric fiducial: share of white, after the colour warp", "%",
                       [](const LayerAssessment& a) {
                         return a.fiducials.photometric.computed ? 100 * a.fiducials.photometric.color : NAN;
                       }},
};

/// The layer's sprite alone. Over black and over white: their mean is the picture over grey, since `over` is
/// linear, and their difference is what the layer lets through.
LayerPicture picture_of(const chunker::Sprite& sprite, const layers::dmat3& screen_from_sprite,
                        const layers::dvec3& color, layers::ivec2 display_px) {
  chunker::PlacedSprite placed;
  placed.sprite = &sprite;
  placed.color_multiplier = layers::vec3(color);
  placed.screen_from_sprite = screen_from_sprite;
  const chunker::Frame black = chunker::composite({&placed, 1}, display_px, {0, 0, 0}).frame;
  const chunker::Frame white = chunker::composite({&placed, 1}, display_px, {1, 1, 1}).frame;
  LayerPicture picture{display_px.x, display_px.y, {}, {}};
  picture.rgb.reserve(black.pixels.size() * 3);
  picture.covered.reserve(black.pixels.size());
  const auto grey = [](std::uint16_t a, std::uint16_t b) {
    return static_cast<float>(
        chunker::srgb_from_linear16(static_cast<std::uint16_t>((std::uint32_t{a} + b) / 2)));
  };
  for (std::size_t i = 0; i < black.pixels.size(); ++i) {
    const chunker::Linear16 b = black.pixels[i], w = white.pixels[i];
    for (const float value : {grey(b.r, w.r), grey(b.g, w.g), grey(b.b, w.b)}) picture.rgb.push_back(value);
    picture.covered.push_back(2u * (w.g - b.g) <= chunker::kOne);
  }
  return picture;
}

float luma(const LayerPicture& picture, std::size_t pixel) {
  const float* rgb = picture.rgb.data() + 3 * pixel;
  return 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
}

/// Sums for the apparent shift over the pixels that both pictures cover, with their neighbours in `fresh`.
double apparent_shift_px(const LayerPicture& old_one, const LayerPicture& fresh) {
  const std::size_t width = fresh.width;
  double differences = 0, gradients = 0;
  for (int y = 1; y + 1 < fresh.height; ++y)
    for (int x = 1; x + 1 < fresh.width; ++x) {
      const std::size_t i = y * width + x;
      const bool inside = old_one.covered[i] && fresh.covered[i] && fresh.covered[i - 1] &&
                          fresh.covered[i + 1] && fresh.covered[i - width] && fresh.covered[i + width];
      if (!inside) continue;
      const double d = luma(old_one, i) - luma(fresh, i);
      const double gx = (luma(fresh, i + 1) - luma(fresh, i - 1)) / 2;
      const double gy = (luma(fresh, i + width) - luma(fresh, i - width)) / 2;
      differences += d * d;
      gradients += gx * gx + gy * gy;
    }
  return gradients > 0 ? std::sqrt(2 * differences / gradients) : NAN;
}

/// Draws the layers of one sequence, each alone.
class LayerStage {
 public:
  LayerStage(const Sequence& sequence, const Settings& settings)
      : pipeline_(make_pipeline(*sequence.scene, sequence.layers, settings)),
        state_(pipeline_),
        prepared_(*sequence.scene) {}

  /// Appends the samples of `layer` at `frame`.
  void sample(int layer, int frame, std::vector<CalibrationSample>& samples) {
    const layers::LayerState now = captured_states(pipeline_, state_, frame)[layer];
    if (!now.touches_display) return;
    const layers::SpritePlacement placement = placement_without_growth(pipeline_, state_.layers, now);
    if (placement.empty()) return;
    std::optional<LayerPicture> fresh;  // drawn when there is something to compare it with
    for (const int age : calibrated_ages()) {
      if (age > frame) break;
      const layers::LayerState then = captured_states(pipeline_, state_, frame - age)[layer];
      if (!then.touches_display) continue;
      const layers::SpritePlacement old_placement = captured_placement(pipeline_, state_, layer, frame - age);
      const LayerAssessment assessment =
          assess_sprite(pipeline_, state_.layers, then, old_placement, now, age);
      if (old_placement.empty() || !(assessment.identical || regulator::has_sound_fit(assessment))) continue;
      if (!fresh) fresh = draw(layer, frame, placement, layers::dmat3(1.0), layers::dvec3(1.0));
      const LayerPicture old_one =
          draw(layer, frame - age, old_placement, assessment.fitted.warp.now_from_then,
               assessment.fiducials.photometric.multiplier);
      const LayerDifference difference = difference_of(old_one, *fresh);
      if (difference.pixels == 0) continue;
      samples.push_back(
          {layer, frame, age, {}, difference.error, difference.apparent_shift_px, difference.pixels});
      for (const CalibratedFiducial& fiducial : kFiducials)
        samples.back().fiducials.push_back(fiducial.value(assessment));
    }
  }

  void forget_before(int frame) {
    state_.captured.erase(state_.captured.begin(), state_.captured.lower_bound(frame));
  }

 private:
  LayerPicture draw(int layer, int instant, const layers::SpritePlacement& placement,
                    const layers::dmat3& warp, const layers::dvec3& color) {
    const chunker::RenderResult drawn =
        draw_layer({pipeline_, state_.layers, shadow_maps_, prepared_, scene_at(pipeline_, instant)},
                   state_.layers[layer], placement);
    return picture_of(drawn.sprite, warp * layers::to_mat3(placement.screen_from_sprite), color,
                      pipeline_.settings.view.display_px);
  }

  Pipeline pipeline_;
  PipelineState state_;
  chunker::PreparedScene prepared_;
  ShadowMapStore shadow_maps_;
};

/// All numbers of one fiducial, and what they are set against.
struct Columns {
  std::vector<double> fiducial, error, shift;
};

CalibrationBin bin_around(double center, const Columns& columns) {
  Columns inside;
  for (std::size_t i = 0; i < columns.fiducial.size(); ++i) {
    const double relative = columns.fiducial[i] / center;
    if (!(relative >= std::sqrt(0.5) && relative < std::sqrt(2.0))) continue;
    inside.error.push_back(columns.error[i]);
    inside.shift.push_back(columns.shift[i]);
  }
  return {center,
          static_cast<int>(inside.error.size()),
          median(inside.error),
          quantile(inside.error, 0.25),
          quantile(inside.error, 0.75),
          median(inside.shift)};
}

CalibrationSummary summary_of(std::size_t index, std::span<const CalibrationSample> samples) {
  Columns all;
  std::map<int, Columns> by_layer;
  for (const CalibrationSample& sample : samples) {
    const double value = sample.fiducials[index];
    if (!std::isfinite(value)) continue;
    for (Columns* columns : {&all, &by_layer[sample.layer]}) {
      columns->fiducial.push_back(value);
      columns->error.push_back(sample.error);
      columns->shift.push_back(sample.apparent_shift_px);
    }
  }
  CalibrationSummary summary;
  summary.fiducial = &kFiducials[index];
  summary.computed = static_cast<int>(all.fiducial.size());
  summary.error = spearman(all.fiducial, all.error);
  summary.shift = spearman(all.fiducial, all.shift);
  std::vector<double> rhos;
  for (const auto& [layer, columns] : by_layer) {
    const RankCorrelation rank = spearman(columns.fiducial, columns.error);
    if (rank.defined && rank.n >= kEnoughSamples) rhos.push_back(rank.rho);
  }
  summary.median_rho_of_layers = median(rhos);
  summary.layers = static_cast<int>(rhos.size());
  for (int octave = -7; octave <= 9; ++octave) {
    const CalibrationBin bin = bin_around(std::exp2(octave), all);
    if (bin.samples >= kEnoughSamples) summary.bins.push_back(bin);
  }
  return summary;
}

}  // namespace

std::span<const CalibratedFiducial> calibrated_fiducials() { return kFiducials; }

std::vector<int> calibrated_ages() { return {1, 2, 4, 8, 16, 32}; }

std::vector<CalibrationSample> calibration_samples(const Sequence& sequence, const Settings& settings,
                                                   std::span<const int> frames, ProgressKind progress_kind) {
  Settings threshold = settings;  // whose sprites are those of a policy that warps them for a while
  threshold.regulator.policy = regulator::Policy::Threshold;
  LayerStage stage(sequence, threshold);
  Progress progress(progress_kind, "calibrated", static_cast<int>(frames.size()));
  std::vector<CalibrationSample> samples;
  for (const int frame : frames) {
    stage.forget_before(frame - calibrated_ages().back());
    for (const layers::Layer& layer : sequence.layers.layers) stage.sample(layer.id, frame, samples);
    progress.advance();
  }
  return samples;
}

std::vector<CalibrationSummary> summarize_calibration(std::span<const CalibrationSample> samples) {
  std::vector<CalibrationSummary> summaries;
  for (std::size_t index = 0; index < kFiducials.size(); ++index)
    summaries.push_back(summary_of(index, samples));
  return summaries;
}

LayerDifference difference_of(const LayerPicture& old_one, const LayerPicture& fresh) {
  TALISMAN_CHECK_EQ(old_one.rgb.size(), fresh.rgb.size());
  TALISMAN_CHECK_EQ(old_one.covered.size(), fresh.covered.size());
  LayerDifference difference;
  double squares = 0;
  for (std::size_t i = 0; i < fresh.covered.size(); ++i) {
    if (!old_one.covered[i] && !fresh.covered[i]) continue;
    ++difference.pixels;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double d = old_one.rgb[c] - fresh.rgb[c];
      squares += d * d;
    }
  }
  if (difference.pixels == 0) return difference;
  difference.error = std::sqrt(squares / (3.0 * difference.pixels));
  difference.apparent_shift_px = apparent_shift_px(old_one, fresh);
  return difference;
}

}  // namespace talisman::sequences
