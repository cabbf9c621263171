// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/quality.h"

#include <oneapi/tbb/parallel_for.h>

#include "sequences/pictures/diff.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {
namespace {

using warp::Curve;

/// The pipeline with the geometric fiducial alone, as in the simulation.
Settings settings_for(const RateOptions& options, Curve curve, double threshold_px) {
  Settings settings;
  settings.view.display_px = options.display_px;
  settings.fps = options.fps;
  settings.bound = options.bound;
  settings.curve = curve;
  settings.layers_own_warps = false;
  settings.regulator.policy = regulator::Policy::Threshold;
  regulator::Thresholds& thresholds = settings.regulator.thresholds;
  thresholds.geometric_px = threshold_px;
  thresholds.magnification = thresholds.minification = thresholds.anisotropy = 0;
  thresholds.uncovered_px = -1;
  return settings;
}

struct Truth {
  const layers::Scene& scene;
  const layers::LayerSet& layers;
  const chunker::PreparedScene& prepared;
  std::vector<Image8> pictures;  ///< by the policy `reference`
};

void draw_truth(const RateOptions& options, Truth& truth) {
  const Pipeline pipeline = make_pipeline(truth.scene, truth.layers, settings_for(options, Curve::aff, 0));
  truth.pictures.resize(options.frames);
  oneapi::tbb::parallel_for(0, options.frames, [&](int frame) {
    truth.pictures[frame] = to_image8(draw_reference(pipeline, frame, truth.prepared));
  });
}

CurveQuality draw_and_compare(const RateOptions& options, const Truth& truth, Curve curve,
                              double threshold_px) {
  const Pipeline pipeline =
      make_pipeline(truth.scene, truth.layers, settings_for(options, curve, threshold_px));
  PipelineState state(pipeline);
  CurveQuality result{curve, threshold_px, 0, {}, {}};
  std::vector<FrameDiff> diffs;
  for (int frame = 0; frame < options.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, &truth.prepared);
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      result.renders += decision.action == regulator::Action::Rerender;
    diffs.push_back({std::to_string(frame), compare(to_image8(report.picture), truth.pictures[frame])});
  }
  const DiffSummary summary = summarize(diffs);
  result.mean = summary.mean;
  result.worst = summary.worst;
  return result;
}

}  // namespace

std::vector<CurveQuality> quality_at_rate(const layers::Scene& scene, const RateOptions& options) {
  const layers::LayerSet set = layers::factor(scene, whole_scene());
  const chunker::PreparedScene prepared(scene);
  Truth truth{scene, set, prepared, {}};
  draw_truth(options, truth);
  const CapturedAnimation animation = capture_animation(
      scene, options.frames, options.fps, settings_for(options, Curve::aff, 0).view, options.bound);
  const std::vector<Curve> curves = all_curves();
  std::vector<CurveQuality> result(curves.size());
  oneapi::tbb::parallel_for(std::size_t{0}, curves.size(), [&](std::size_t k) {
    UpdateCounter counter(animation, curves[k]);
    const double threshold_px = threshold_for_rate(counter, options.update_rate);
    result[k] = draw_and_compare(options, truth, curves[k], threshold_px);
  });
  return result;
}

}  // namespace talisman::sequences
