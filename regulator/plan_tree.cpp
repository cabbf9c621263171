// SPDX-License-Identifier: Apache-2.0
#include "regulator/plan_tree.h"

#include <algorithm>
#include <cmath>

namespace talisman::regulator {

std::string_view name(Joining joining) {
  switch (joining) {
    case Joining::EachFrame:
      return "each-frame";
    case Joining::Copy:
      return "copy";
    case Joining::InPlace:
      return "in-place";
  }
  return "?";
}

std::optional<Joining> joining_from_name(std::string_view text) {
  for (const Joining joining : kAllJoinings)
    if (name(joining) == text) return joining;
  return std::nullopt;
}

int PlanShape::levels() const {
  int levels = 1;
  for (int width = frames; width > 1; width /= children) ++levels;
  return levels;
}

int PlanShape::interval(int level) const {
  int width = frames;
  for (; level > 0; --level) width /= children;
  return width;
}

int slice_within(int frames, int children) {
  int slice = 1;
  while (slice <= frames / children) slice *= children;
  return slice;
}

std::string first_defect(const PlanShape& shape) {
  if (shape.children < 2) return "tree_k is " + std::to_string(shape.children) + ", must be at least 2";
  const std::string is = "lookahead is " + std::to_string(shape.frames);
  if (shape.frames < 1 || shape.frames > kLongestSlice_frames)
    return is + ", must be 1 to " + std::to_string(kLongestSlice_frames) + " for the policy predictive";
  if (slice_within(shape.frames, shape.children) != shape.frames)
    return is + ", must be a power of tree_k " + std::to_string(shape.children) +
           " for the policy predictive";
  return "";
}

PlannedDraw draw_due(const PlanShape& shape, const MotionWord& word, int frame) {
  int level = 0;
  for (int width = shape.frames; width > 1; width /= shape.children, ++level)
    if (frame % width == 0 && word.rests_over(frame + 1, frame + width - 1)) return {frame, level, width};
  return {frame, level, 1};
}

std::vector<PlannedDraw> planned_draws(const PlanShape& shape, const MotionWord& word) {
  std::vector<PlannedDraw> draws;
  for (int frame = 0; frame < shape.frames; frame += draws.back().frames)
    draws.push_back(draw_due(shape, word, frame));
  return draws;
}

PlannedDraw draw_shown(const PlanShape& shape, const MotionWord& word, int frame) {
  int level = 0;
  for (int width = shape.frames; width > 1; width /= shape.children, ++level) {
    const int first = frame - frame % width;
    if (word.rests_over(first + 1, first + width - 1)) return {first, level, width};
  }
  return {frame, level, 1};
}

double expected_draws(const PlanShape& shape, double change) {
  const double rest = 1 - change;
  double sum = std::pow(rest, shape.frames - 1), nodes = 1;
  for (int width = shape.frames; width > 1; width /= shape.children) {
    nodes *= shape.children;
    sum += nodes * (std::pow(rest, width / shape.children - 1) - std::pow(rest, width - 1));
  }
  return sum;
}

double expected_runs(int frames, double change) { return 1 + (frames - 1) * change; }

std::int64_t joins_of_slice(const PlanShape& shape, Joining joining) {
  const std::int64_t frames = shape.frames, children = shape.children;
  switch (joining) {
    case Joining::EachFrame:
      return frames * (shape.levels() - 1);
    case Joining::Copy:
      return children * (frames - 1) / (children - 1);
    case Joining::InPlace:
      return frames - 1;
  }
  return 0;
}

}  // namespace talisman::regulator
