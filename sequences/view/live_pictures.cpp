// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/live_pictures.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"
#include "sequences/pictures/flip.h"
#include "sequences/pictures/outlined_frame.h"
#include "sequences/pictures/overlay.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/blended_sprites.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/view/flights.h"

namespace talisman::sequences {

namespace {

struct ModeName {
  const char* name;
  PictureMode mode;
};
constexpr std::array kModes{
    ModeName{"shown", PictureMode::Shown},   ModeName{"direct", PictureMode::Direct},
    ModeName{"beside", PictureMode::Beside}, ModeName{"difference", PictureMode::Difference},
    ModeName{"flip", PictureMode::Flip},     ModeName{"overlay", PictureMode::Overlay},
    ModeName{"age", PictureMode::Age},       ModeName{"depth", PictureMode::Depth}};

constexpr int kDifferenceGain = 4;
constexpr float kWhiteDepth = 8;

Image8 beside_each_other(const Image8& left, const Image8& right) {
  const int width = left.width + right.width;
  Image8 both{width, left.height, {}};
  const auto row_of = [](const Image8& image, int y) {
    return image.rgb.begin() + static_cast<std::ptrdiff_t>(3) * image.width * y;
  };
  for (int y = 0; y < left.height; ++y)
    for (const Image8* image : {&left, &right})
      both.rgb.insert(both.rgb.end(), row_of(*image, y), row_of(*image, y + 1));
  return both;
}

Image8 amplified_difference(const Image8& a, const Image8& b) {
  Image8 difference = a;
  for (std::size_t k = 0; k < a.rgb.size(); ++k)
    difference.rgb[k] =
        static_cast<std::uint8_t>(std::min(255, kDifferenceGain * std::abs(int(a.rgb[k]) - int(b.rgb[k]))));
  return difference;
}

/// Shows each sprite's alpha on the display, 0 … kOne, back to front.
template <typename Show>
void for_each_alpha(const PipelineState& state, const FrameReport& report, const Show& show) {
  const BlendedSprites blended = blended_sprites(state, report);
  const std::size_t area = static_cast<std::size_t>(report.display_px.x) * report.display_px.y;
  for (const ShownSprite& sprite : report.shown) {
    chunker::Frame alone{report.display_px.x, report.display_px.y, std::vector<chunker::Linear16>(area)};
    chunker::composite_onto(alone, std::vector{placed_sprite(sprite, state.sprites, blended)});
    for (std::size_t i = 0; i < area; ++i)
      if (alone.pixels[i] != chunker::Linear16{}) show(sprite, i, alone.pixels[i].a);
  }
}

/// Throws InputError where there is nothing that the picture would show.
void require_sprites(const Settings& settings, const char* mode) {
  using regulator::Policy;
  const Policy policy = settings.regulator.policy;
  if (policy == Policy::Direct || policy == Policy::Predictive)
    throw InputError("policy is '" + std::string(regulator::name(policy)) + "', must be one with sprites: '" +
                     mode + "' is a picture of them");
}

Image8 age_picture(const PipelineState& state, const FrameReport& report) {
  const layers::ivec2 size = report.display_px;
  Image8 picture{size.x, size.y, std::vector<std::uint8_t>(static_cast<std::size_t>(size.x) * size.y * 3)};
  for_each_alpha(state, report, [&](const ShownSprite& sprite, std::size_t i, int alpha) {
    if (2 * alpha < static_cast<int>(chunker::kOne)) return;
    const auto color = age_color(sprite.age_frames, kOldestFrames);
    std::copy(color.begin(), color.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  });
  return picture;
}

Image8 depth_picture(const PipelineState& state, const FrameReport& report) {
  const layers::ivec2 size = report.display_px;
  std::vector<float> depth(static_cast<std::size_t>(size.x) * size.y);
  for_each_alpha(state, report, [&](const ShownSprite&, std::size_t i, int) { depth[i] += 1 / kWhiteDepth; });
  return heat_map(depth, size.x, size.y);
}

}  // namespace

std::vector<std::string> picture_mode_names() {
  std::vector<std::string> names;
  for (const ModeName& mode : kModes) names.emplace_back(mode.name);
  return names;
}

PictureMode picture_mode(const std::string& name) {
  for (const ModeName& mode : kModes)
    if (name == mode.name) return mode.mode;
  throw InputError("mode is '" + name + "', must be one of " + listed(picture_mode_names()));
}

LivePictures::LivePictures(LiveScene live, std::shared_ptr<const ReadyScene> ready)
    : live_(std::move(live)),
      ready_(std::move(ready)),
      pipeline_(make_pipeline(*live_.variant.sequence.scene, live_.variant.sequence.layers,
                              live_.variant.settings)) {
  start_again();
}

void LivePictures::start_again() {
  state_ = std::make_unique<PipelineState>(pipeline_);
  at_ = -1;
}

void LivePictures::follow(const std::vector<CameraPose>& flight, bool goes_on) {
  if (!live_.flown) return;
  fly(*live_.flown, flight, live_.variant.sequence.fps);  // others fly the same scene
  if (flight == flight_) return;
  const bool is_longer =
      flight.size() >= flight_.size() && std::equal(flight_.begin(), flight_.end(), flight.begin());
  if (!goes_on || !is_longer) start_again();
  live_.variant.sequence.frames = pipeline_.settings.frames = static_cast<int>(flight.size());
  flight_ = flight;
}

std::optional<Image8> LivePictures::draw(int frame, PictureMode mode, const std::function<bool()>& is_stale) {
  if (frame >= frames())
    throw InputError("frame is " + std::to_string(frame) + ", must be at most " +
                     std::to_string(frames() - 1));
  if (frame < at_ || (frame == at_ && !drawn_)) start_again();
  while (at_ < frame) {
    if (is_stale()) return std::nullopt;
    const bool is_last = at_ + 1 == frame;
    report_ = step(pipeline_, *state_, at_ + 1, is_last ? &*ready_->prepared : nullptr);
    ++at_;
    drawn_ = is_last;
  }
  return picture(mode);
}

Image8 LivePictures::picture(PictureMode mode) {
  const auto direct = [this] { return to_image8(draw_direct(pipeline_, at_, *ready_->prepared)); };
  switch (mode) {
    case PictureMode::Shown:
      return to_image8(report_.picture);
    case PictureMode::Direct:
      return direct();
    case PictureMode::Beside:
      return beside_each_other(to_image8(report_.picture), direct());
    case PictureMode::Difference:
      return amplified_difference(to_image8(report_.picture), direct());
    case PictureMode::Flip:
      return heat_map(flip_map(to_image8(report_.picture), direct(), QualityOptions().pixels_per_degree),
                      report_.display_px.x, report_.display_px.y);
    case PictureMode::Overlay:
      return with_outlines(report_);
    case PictureMode::Age:
      require_sprites(pipeline_.settings, "age");
      return age_picture(*state_, report_);
    case PictureMode::Depth:
      require_sprites(pipeline_.settings, "depth");
      return depth_picture(*state_, report_);
  }
  return {};
}

}  // namespace talisman::sequences
