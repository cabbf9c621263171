// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/culling/visibility.h"

#include <algorithm>

#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/step.h"
#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

namespace {

/// One triple on its way through the frames.
class VisibilityRun {
 public:
  VisibilityRun(const Sequence& sequence, Settings settings, const VisibilityOptions& options)
      : pipeline_(make_pipeline(*sequence.scene, sequence.layers, with(std::move(settings), options))),
        state_(pipeline_) {
    result_.options = options;
  }

  void decide(int frame, double all_polygons, double all_parts) {
    forget_seen(state_);
    const Stopwatch watch;
    const SeenParts* seen = seen_at(pipeline_, state_, frame);
    const double ms = watch.ms();
    if (decided_++ == 0)
      result_.first_ms = ms;
    else
      decided_ms_.push_back(ms);
    const double polygons = seen ? double(seen->polygons) : all_polygons;
    result_.polygons += polygons;
    result_.polygons_most = std::max(result_.polygons_most, polygons);
    result_.parts += seen ? seen->parts : all_parts;
    if (!seen) return;
    result_.cells += seen->cells.cells;
    result_.in_walls += seen->cells.in_wall;
  }

  void draw(int frame, const chunker::PreparedScene& prepared, const chunker::Frame& truth) {
    const FrameReport report = step(pipeline_, state_, frame, &prepared);
    ++result_.drawn;
    result_.render_ms += report.times.render_ms;
    result_.differing += report.picture != truth;
  }

  VisibilityResult result() const {
    VisibilityResult result = result_;
    const double frames = std::max(decided_, 1);
    for (double* sum : {&result.polygons, &result.parts, &result.cells}) *sum /= frames;
    std::vector<double> ms = decided_ms_;
    std::sort(ms.begin(), ms.end());
    if (!ms.empty()) result.decide_ms = ms[ms.size() / 2], result.decide_most_ms = ms.back();
    result.render_ms /= std::max(result.drawn, 1);
    return result;
  }

 private:
  static Settings with(Settings settings, const VisibilityOptions& options) {
    settings.regulator.policy = regulator::Policy::Direct;
    settings.visibility = options;
    return settings;
  }
  Pipeline pipeline_;
  PipelineState state_;
  VisibilityResult result_;
  int decided_ = 0;
  std::vector<double> decided_ms_;  ///< all but the first
};

}  // namespace

std::vector<VisibilityOptions> visibility_triples(bool with_cells) {
  std::vector<VisibilityOptions> triples;
  for (const char* pre : {"none", "ctc", "cto"})
    for (const char* cell : {"none", "frustum", "eye"})
      for (const char* object : {"none", "frustum", "eye"}) {
        const auto options = visibility_from(std::string(pre) + "," + cell + "," + object);
        if (options && (with_cells || !options->needs_cells())) triples.push_back(*options);
      }
  return triples;
}

VisibilityExperiment measure_visibility(const Sequence& sequence, const Settings& settings,
                                        const ExperimentFrames& frames, ProgressKind progress) {
  const layers::Scene& scene = *sequence.scene;
  VisibilityExperiment experiment{sequence.name, settings.view.display_px, frames, 0, 0, 0, 0, {}};
  experiment.parts = int(scene.parts.size());
  for (const layers::Part& part : scene.parts)
    experiment.polygons += scene.meshes[part.mesh].triangle_count();
  if (settings.cells) {
    experiment.cells = int(settings.cells->cells.size());
    experiment.portals = int(settings.cells->portals.size());
  }
  const chunker::PreparedScene prepared(scene, settings.render);
  Settings of_truth = settings;
  of_truth.visibility = {};
  const Pipeline all = make_pipeline(scene, sequence.layers, of_truth);
  std::vector<std::pair<int, chunker::Frame>> truths;
  for (const int frame : sampled_frames(frames))
    truths.emplace_back(frame, draw_direct(all, frame, prepared));
  const std::vector<VisibilityOptions> triples = visibility_triples(settings.cells != nullptr);
  Progress bar(progress, "triples", int(triples.size()));
  for (const VisibilityOptions& options : triples) {
    VisibilityRun run(sequence, settings, options);
    for (int frame = frames.first; frame <= frames.last; ++frame)
      run.decide(frame, double(experiment.polygons), experiment.parts);
    for (const auto& [frame, truth] : truths) run.draw(frame, prepared, truth);
    experiment.results.push_back(run.result());
    bar.advance();
  }
  return experiment;
}

}  // namespace talisman::sequences
