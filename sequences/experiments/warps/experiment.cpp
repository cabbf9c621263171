// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/experiment.h"

#include <algorithm>
#include <utility>

namespace talisman::sequences {
namespace {

/// Those that are looked at in every motion and in pictures.
std::vector<std::size_t> studied(const std::vector<WarpObject>& objects) {
  if (objects.size() == 1) return {0};
  std::vector<std::size_t> found;
  for (const auto& [first, second] : {std::pair{"flat-teapot", "flat-box"}, std::pair{"teapot", "box"}})
    for (const std::string name : {first, second}) {
      const auto object = std::find_if(objects.begin(), objects.end(),
                                       [&name](const WarpObject& o) { return o.name == name; });
      if (object == objects.end()) continue;
      found.push_back(static_cast<std::size_t>(object - objects.begin()));
      break;
    }
  return found;
}

/// The main motion of all objects, then the other motions of those that are studied.
std::vector<RateFigure> figures_to_draw(std::size_t objects, const std::vector<std::size_t>& studied) {
  const std::vector<WarpMotion> motions = warp_motions();
  const auto is_studied = [&](std::size_t k) {
    return std::find(studied.begin(), studied.end(), k) != studied.end();
  };
  std::vector<RateFigure> figures;
  for (const std::size_t k : studied) figures.push_back({k, true, true, motions[0], {}, {}});
  for (std::size_t k = 0; k < objects; ++k)
    if (!is_studied(k)) figures.push_back({k, true, false, motions[0], {}, {}});
  for (const std::size_t k : studied)
    for (std::size_t m = 1; m < motions.size(); ++m) figures.push_back({k, false, true, motions[m], {}, {}});
  return figures;
}

}  // namespace

WarpReport measure_warps(std::vector<WarpObject> objects, std::vector<MissingObject> missing,
                         layers::BoundKind bound, ProgressKind progress_kind) {
  WarpReport report;
  report.objects = std::move(objects);
  report.missing = std::move(missing);
  report.thresholds = figure_thresholds();
  report.rate.bound = bound;
  const std::vector<std::size_t> in_pictures = studied(report.objects);
  report.figures = figures_to_draw(report.objects.size(), in_pictures);
  Progress progress(progress_kind, "warps", static_cast<int>(report.figures.size() + in_pictures.size()));
  for (RateFigure& figure : report.figures) {
    const layers::Scene scene = stage(report.objects[figure.object], figure.motion);
    figure.curves =
        update_curves(capture_animation(scene, kMotion_frames, kMotion_fps, {}, bound), report.thresholds);
    figure.ranking = rank(figure.curves);
    progress.advance();
  }
  for (const std::size_t k : in_pictures) {
    report.qualities.push_back(
        {k, quality_at_rate(stage(report.objects[k], warp_motions()[0]), report.rate)});
    progress.advance();
  }
  return report;
}

}  // namespace talisman::sequences
