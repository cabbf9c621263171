// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/kept_frames.h"

#include <algorithm>

#include "sequences/pipeline/draw_instant.h"

namespace talisman::sequences {

namespace {

template <typename T>
std::int64_t bytes_of_list(const std::vector<T>& list) {
  return static_cast<std::int64_t>(list.size() * sizeof(T));
}

std::int64_t bytes_of_layer(const layers::LayerState& state) {
  std::int64_t bytes = bytes_of_list(state.world_points) + bytes_of_list(state.clip_points) +
                       bytes_of_list(state.screen_points) + bytes_of_list(state.world_from_part) +
                       bytes_of_list(state.lights) + bytes_of_list(state.world_from_body) +
                       bytes_of_list(state.world_normals) + bytes_of_list(state.point_colors) +
                       bytes_of_list(state.material_clip) + bytes_of_list(state.lit_places) +
                       bytes_of_list(state.world_from_influence) + bytes_of_list(state.traces) +
                       bytes_of_list(state.pictures);
  for (const layers::ShadeTrace& trace : state.traces) bytes += bytes_of_list(trace.places);
  return bytes;
}

}  // namespace

std::int64_t bytes_of(const CapturedFrame& frame) {
  std::int64_t bytes = static_cast<std::int64_t>(sizeof frame) + bytes_of_list(frame.states) +
                       bytes_of_list(frame.placements) + bytes_of_list(frame.culled) +
                       bytes_of_list(frame.shadow_maps) + bytes_of_list(frame.lights);
  for (const layers::LayerState& state : frame.states) bytes += bytes_of_layer(state);
  return bytes;
}

std::int64_t most_frames_kept(const regulator::RegulatorOptions& options, int frames) {
  constexpr std::int64_t kNowAndNext = 2;
  if (options.policy == regulator::Policy::Oracle) return frames;
  if (options.policy != regulator::Policy::Lookahead) return std::min<std::int64_t>(frames, kNowAndNext);
  return std::min<std::int64_t>(frames, std::int64_t{options.lookahead.frames} + kFarthestLook_frames + 1);
}

}  // namespace talisman::sequences
