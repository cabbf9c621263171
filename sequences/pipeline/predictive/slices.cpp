// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/predictive/slices.h"

#include <algorithm>

#include "layers/jumps.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

bool is_expected(const regulator::RegulatorOptions& options) {
  return options.lookahead.predict != regulator::Prediction::Known;
}

}  // namespace

Slices::Slices(const Pipeline& pipeline)
    : options_(pipeline.settings.regulator),
      display_px_(pipeline.settings.view.display_px),
      followed_(followed_parts(pipeline.scene, pipeline.authored.set())) {
  by_number_ = !is_expected(options_) && !options_.predictive.adaptive;
  if (options_.predictive.adaptive)
    jumps_ = layers::jumps_of(pipeline.scene, time_of(pipeline, std::max(pipeline.settings.frames, 1)));
  if (options_.predictive.intervals == regulator::Intervals::Data)
    for (const FollowedPart& part : followed_.parts)
      weights_.push_back(pipeline.scene.meshes[pipeline.scene.parts[part.part].mesh].triangle_count());
}

layers::SceneFrame Slices::expected(const Pipeline& pipeline, const Slice& slice, int instant) {
  return is_expected(pipeline.settings.regulator) ? scene_expected(pipeline, slice.first, instant)
                                                  : scene_at(pipeline, instant);
}

PlannedSlice Slices::planned(const Pipeline& pipeline, Slice slice) const {
  const int frames = pipeline.settings.frames;
  const int last = slice.first < frames ? frames - 1 : slice.first + slice.frames - 1;
  MotionOptions options;
  options.delta_px = options_.thresholds.geometric_px;
  options.norm = options_.predictive.norm;
  const FrameAt expected_at = [&](int at) { return expected(pipeline, slice, at); };
  const FrameAt truth_at = [&](int at) { return scene_at(pipeline, at); };
  const regulator::PlanShape shape{slice.frames, options_.predictive.children};
  PlannedSlice planned{slice,
                       follow_parts(followed_, display_px_, slice.first, slice.frames, last, expected_at,
                                    options, is_expected(options_) ? truth_at : FrameAt{}),
                       regulator::PlanIntervals(shape)};
  if (options_.predictive.intervals == regulator::Intervals::Data)
    planned.intervals = regulator::fitted_intervals(shape, planned.motion.words, weights_);
  return planned;
}

/// Where the plan is dropped: at the first surprise of both kinds.
void Slices::find_end(const Pipeline& pipeline, PlannedSlice& planned) const {
  Slice& slice = planned.slice;
  slice.end = slice.first + (planned.motion.surprise >= 0 ? planned.motion.surprise : slice.frames);
  for (int frame = slice.first + 1; frame < slice.end; ++frame)
    if (layers::any_between(jumps_, time_of(pipeline, frame - 1), time_of(pipeline, frame)))
      slice.end = frame;
}

Slice Slices::after(const Pipeline& pipeline, const PlannedSlice& planned) const {
  const Slice& before = planned.slice;
  Slice next{before.end, before.frames, 0, 0, 0};
  const bool is_dropped = before.end < before.first + before.frames;
  const bool is_surprise = is_dropped || layers::any_between(jumps_, time_of(pipeline, before.end - 1),
                                                             time_of(pipeline, before.end));
  if (is_surprise) next.surprised = std::max(is_dropped ? planned.motion.surprised : 0, 1);
  if (!options_.predictive.adaptive) return next;
  const int k = options_.predictive.children;
  next.quiet = is_surprise ? 0 : before.quiet + 1;
  if (is_surprise) next.frames = std::max(before.frames / k, 1);
  if (next.quiet >= kQuietSlices && before.frames <= options_.lookahead.frames / k) {
    next.frames = before.frames * k;
    next.quiet = 0;
  }
  return next;
}

const PlannedSlice& Slices::keep(PlannedSlice planned) {
  at_hand_.emplace(std::move(planned));
  return *at_hand_;
}

const PlannedSlice& Slices::of(const Pipeline& pipeline, int frame) {
  if (at_hand_ && frame >= at_hand_->slice.first && frame < at_hand_->slice.end) return *at_hand_;
  const int longest = options_.lookahead.frames;
  if (by_number_) {
    const int first = frame - frame % longest;
    return keep(planned(pipeline, {first, longest, first + longest, 0, 0}));
  }
  const auto begins_later = [](int at, const Slice& slice) { return at < slice.first; };
  auto known = std::upper_bound(known_.begin(), known_.end(), frame, begins_later);
  if (known != known_.begin() && frame < std::prev(known)->end)
    return keep(planned(pipeline, *std::prev(known)));  // was followed before
  Slice next{0, longest, 0, 0, 0};
  if (!known_.empty()) {
    const bool is_last_at_hand = at_hand_ && at_hand_->slice == known_.back();
    next = after(pipeline, is_last_at_hand ? *at_hand_ : planned(pipeline, known_.back()));
  }
  while (true) {
    PlannedSlice planned_next = planned(pipeline, next);
    find_end(pipeline, planned_next);
    known_.push_back(planned_next.slice);
    if (frame < planned_next.slice.end) return keep(std::move(planned_next));
    next = after(pipeline, planned_next);
  }
}

}  // namespace talisman::sequences
