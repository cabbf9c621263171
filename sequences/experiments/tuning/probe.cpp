// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/tuning/probe.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <numeric>

#include "sequences/files/folders.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

/// Of the frames asked for first, second, and in the end.
constexpr int kFirstFrames = 2, kSecondFrames = 8;

Settings as_reference(Settings settings) {
  settings.regulator.policy = regulator::Policy::Reference;
  return settings;
}

}  // namespace

std::vector<double> ProbedQuality::known() const {
  std::vector<double> values;
  for (const double value : badness)
    if (!std::isnan(value)) values.push_back(value);
  return values;
}

QualityProbe::QualityProbe(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                           const TuneGoal& goal, const std::string& folder, const ProbeLimits& limits)
    : sequence_(sequence),
      settings_(settings),
      range_(range),
      goal_(goal),
      folder_(folder + "/truth"),
      limits_(limits),
      prepared_(*sequence.scene),
      reference_(make_pipeline(*sequence.scene, sequence.layers, as_reference(settings))),
      has_truth_(static_cast<std::size_t>(range.last - range.first + 1)),
      badness_per_suspicion_(has_truth_.size()) {
  prepare_folder(folder_);
}

QualityProbe::~QualityProbe() {
  std::error_code ignored;
  for (std::size_t k = 0; k < has_truth_.size(); ++k)
    if (has_truth_[k]) std::filesystem::remove(truth_path(range_.first + static_cast<int>(k)), ignored);
  std::filesystem::remove(folder_, ignored);
}

std::string QualityProbe::truth_path(int frame) const {
  char name[32];
  std::snprintf(name, sizeof name, "/%04d.png", frame);
  return folder_ + name;
}

Image8 QualityProbe::truth(int frame) {
  const std::size_t k = static_cast<std::size_t>(frame - range_.first);
  if (has_truth_[k]) return read_image(truth_path(frame));
  Image8 picture = to_image8(draw_reference(reference_, frame, prepared_));
  ++drawn_;
  write_png(truth_path(frame), picture);
  has_truth_[k] = true;
  return picture;
}

std::vector<int> QualityProbe::by_suspicion(const PlannedThresholds& plan) const {
  double known = 0;
  int count = 0;
  for (const double ratio : badness_per_suspicion_)
    if (ratio > 0) known += ratio, ++count;
  const double otherwise = count > 0 ? known / count : 1;
  std::vector<double> suspicion = plan.suspicion;
  for (std::size_t k = 0; k < suspicion.size(); ++k)
    suspicion[k] *= badness_per_suspicion_[k] > 0 ? badness_per_suspicion_[k] : otherwise;
  std::vector<int> order(suspicion.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return suspicion[a] > suspicion[b]; });
  return order;
}

bool QualityProbe::is_broken(const ProbedQuality& probed) const {
  const std::vector<double> known = probed.known();
  const double frames = static_cast<double>(probed.badness.size());
  // What is not drawn yet is at best without fault.
  const double badness =
      goal_.of_mean ? mean_of(known) * static_cast<double>(known.size()) / frames : worst_of(known);
  return badness > goal_.largest_badness();
}

bool QualityProbe::draw(const PlannedThresholds& plan, const std::vector<bool>& wanted, bool of_goal,
                        ProbedQuality& probed) {
  const Variant variant = with_thresholds(sequence_, settings_, plan.thresholds);
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  PipelineState state(pipeline);
  std::optional<chunker::PreparedScene> own;  // where its seams are others
  if (variant.sequence.scene.get() != &prepared_.scene()) own.emplace(*variant.sequence.scene);
  QualityOptions options;
  options.ssim = false;
  options.flip = goal_.kind == GoalKind::Flip;
  for (int frame = 0; frame <= range_.last; ++frame) {
    const std::size_t k = static_cast<std::size_t>(std::max(0, frame - range_.first));
    const bool is_drawn = frame >= range_.first && wanted[k];
    constexpr int kTruthAndPicture = 2;
    if (is_drawn && (frames_left() < kTruthAndPicture || is_stopped())) return false;
    const FrameReport report = step(pipeline, state, frame, is_drawn ? &(own ? *own : prepared_) : nullptr);
    if (!is_drawn) continue;
    ++drawn_;
    ++probed.frames_drawn;
    probed.badness[k] = goal_.badness_of(compare(to_image8(report.picture), truth(frame), options));
    if (plan.suspicion[k] > 0) badness_per_suspicion_[k] = probed.badness[k] / plan.suspicion[k];
    if (of_goal && is_broken(probed)) return false;
  }
  return true;
}

ProbedQuality QualityProbe::probe(const PlannedThresholds& plan, bool of_goal) {
  ProbedQuality probed;
  probed.badness.assign(has_truth_.size(), NAN);
  const std::vector<int> order = by_suspicion(plan);
  const int all = static_cast<int>(order.size());
  const std::vector<int> stages =
      of_goal ? std::vector<int>{kFirstFrames, kSecondFrames, all} : std::vector{all};
  int from = 0;
  for (const int to : stages) {
    std::vector<bool> wanted(order.size());
    for (; from < std::min(to, all); ++from) wanted[order[from]] = true;
    if (!draw(plan, wanted, of_goal, probed)) {
      probed.verdict = of_goal && is_broken(probed) ? Verdict::Fails : Verdict::Unknown;
      return probed;
    }
  }
  probed.verdict = goal_.holds(probed.badness) ? Verdict::Holds : Verdict::Fails;
  return probed;
}

}  // namespace talisman::sequences
