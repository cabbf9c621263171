// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/memory/memory_need.h"

#include <algorithm>

#include "chunker/sprite.h"
#include "sequences/files/errors.h"
#include "sequences/files/free_memory.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/kept_frames.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/make_pipeline.h"

namespace talisman::sequences {

namespace {

constexpr int kSampled = 4;
constexpr std::int64_t kTexel_bytes = sizeof(chunker::Texel), kPicture_bytes = 11, kBuffer_bytes = 8;

std::int64_t pixels_of(const Settings& settings) {
  return std::int64_t{settings.view.display_px.x} * settings.view.display_px.y;
}

std::int64_t in_chunks(int px) {
  return (px + chunker::kChunkSize - 1) / chunker::kChunkSize * std::int64_t{chunker::kChunkSize};
}

/// Of the layers' sprites in one frame.
std::int64_t sprite_bytes_at(const Pipeline& pipeline, PipelineState& state, int frame) {
  const auto& states = captured_states(pipeline, state, frame);
  std::int64_t texels = 0;
  for (const layers::Layer& layer : state.layers) {
    if (layer.is_aggregate() || !exists_now(state, layer.id) || !states[layer.id].in_view()) continue;
    const layers::SpritePlacement placement = captured_placement(pipeline, state, layer.id, frame);
    if (!placement.empty()) texels += in_chunks(placement.size_px.x) * in_chunks(placement.size_px.y);
  }
  return texels * kTexel_bytes;
}

/// A picture is composed; with files three more wait or are encoded (files/frame_writer.h).
std::int64_t picture_bytes(const Settings& settings, const RunOptions& options) {
  if (options.plan_only) return 0;
  return (options.format == FrameFormat::None ? 1 : 4) * kPicture_bytes * pixels_of(settings);
}

std::int64_t sprite_bytes(const Pipeline& pipeline, PipelineState& state, const RunOptions& options) {
  const Settings& settings = pipeline.settings;
  if (options.plan_only) return 0;
  if (settings.regulator.policy == regulator::Policy::Predictive)
    return std::max(1, settings.regulator.lookahead.frames) * kBuffer_bytes * pixels_of(settings);
  if (!draws_sprites(pipeline)) return pixels_of(settings) * kTexel_bytes;
  std::int64_t most = 0;
  for (int k = 0; k < kSampled; ++k) {
    const std::int64_t frames = options.last_frame - options.first_frame;
    const int frame = options.first_frame + static_cast<int>(frames * k / std::max(1, kSampled - 1));
    begin_frame(pipeline, state, frame);
    most = std::max(most, sprite_bytes_at(pipeline, state, frame));
  }
  return most;
}

/// More than any run of these sizes takes besides its content.
std::int64_t at_most(const Sequence& sequence, const Settings& settings, const RunOptions& options) {
  constexpr std::int64_t kState_bytes = 16 * 1024;  // of a layer in a kept frame
  const std::int64_t sprite =
      std::int64_t{settings.placement.max_sprite_px} * settings.placement.max_sprite_px;
  const std::int64_t layers = static_cast<std::int64_t>(sequence.layers.layers.size());
  const std::int64_t buffers = std::max(1, settings.regulator.lookahead.frames);
  const std::int64_t pixels = pixels_of(settings);
  return layers * std::min(sprite, 4 * pixels) * kTexel_bytes + buffers * kBuffer_bytes * pixels +
         picture_bytes(settings, options) +
         most_frames_kept(settings.regulator, settings.frames) * layers * kState_bytes;
}

/// "12.1 GB", "255 MB".
std::string in_words(std::int64_t bytes) {
  constexpr double kGiga = 1e9, kMega = 1e6;
  const double value = static_cast<double>(bytes);
  return value >= kGiga ? formatted("%.3g GB", value / kGiga) : formatted("%.0f MB", value / kMega);
}

}  // namespace

MemoryNeed memory_need(const Sequence& sequence, const Settings& settings, const RunOptions& options) {
  MemoryNeed need;
  need.content = held_memory_bytes();
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  captured_states(pipeline, state, options.first_frame);
  need.frame = bytes_of(state.captured.at(options.first_frame));
  need.kept_frames = need.frame * most_frames_kept(settings.regulator, settings.frames);
  need.sprites = sprite_bytes(pipeline, state, options);
  need.pictures = picture_bytes(settings, options);
  return need;
}

std::string memory_warning(const MemoryNeed& need, std::int64_t free_bytes) {
  const std::int64_t more = need.total() - need.content;  // that is held already
  if (more <= free_bytes) return {};
  const std::string words = "the run needs some " + in_words(more) + " of memory (sprites " +
                            in_words(need.sprites) + ", pictures " + in_words(need.pictures) +
                            ", frames looked at ahead " + in_words(need.kept_frames) + "), and " +
                            in_words(free_bytes) + " are free";
  if (more / 2 > free_bytes)
    throw InputError(words +
                     ", rule: at most twice what is free; a smaller --size, fewer --frames at a time");
  return words + ": it may be ended by the system";
}

std::string memory_words(const Sequence& sequence, const Settings& settings, const RunOptions& options) {
  constexpr std::int64_t kMuch_bytes = 100'000'000;
  const std::optional<std::int64_t> free = free_memory_bytes();
  const bool is_oracle = settings.regulator.policy == regulator::Policy::Oracle;
  const std::int64_t most = at_most(sequence, settings, options);
  if ((!free || most <= *free) && !(is_oracle && most > kMuch_bytes)) return {};
  const MemoryNeed need = memory_need(sequence, settings, options);
  const std::string warning = free ? memory_warning(need, *free) : "";
  if (!warning.empty() || !is_oracle || need.kept_frames <= kMuch_bytes) return warning;
  return "policy oracle keeps each frame that it looks at, " + std::to_string(need.frame) + " bytes: up to " +
         in_words(need.kept_frames) + " of memory";
}

}  // namespace talisman::sequences
