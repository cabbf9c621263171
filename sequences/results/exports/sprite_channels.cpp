// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/exports/sprite_channels.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "sequences/pipeline/blended_sprites.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kLongestName_bytes = 200;  // OpenEXR takes 255, with what stands behind the dot
constexpr int kFrameChannels = 3, kBackgroundChannels = 3, kSpriteChannels = 6;

/// A name that OpenEXR takes, and no other sprite of the frame has.
std::string channel_name(const std::string& layer, std::set<std::string>& taken) {
  std::string name;
  for (const char c : layer) name += c == '.' || static_cast<unsigned char>(c) < ' ' || c == 127 ? '_' : c;
  if (name.size() > kLongestName_bytes) {
    std::size_t end = kLongestName_bytes;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;  // whole characters
    name.resize(end);
  }
  std::string unique = name;
  for (int k = 2; !taken.insert(unique).second; ++k) unique = name + " " + std::to_string(k);
  return unique;
}

/// The rows and columns of the display in which a picture has texels.
void crop_to_texels(const chunker::Frame& alone, SpriteContribution& to) {
  int x0 = alone.width, x1 = -1, y0 = alone.height, y1 = -1;
  for (int y = 0; y < alone.height; ++y)
    for (int x = 0; x < alone.width; ++x) {
      if (alone.pixels[static_cast<std::size_t>(y) * alone.width + x] == chunker::Linear16{}) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  if (x1 < 0) return;
  to.x0 = x0, to.y0 = y0, to.width = x1 - x0 + 1, to.height = y1 - y0 + 1;
}

/// What a sprite that is composited `alone` contributes behind what lets `transmitted` through; then that is less.
void contribute(const chunker::Frame& alone, std::vector<float>& transmitted, SpriteContribution& to) {
  constexpr float one = chunker::kOne;
  crop_to_texels(alone, to);
  const std::size_t area = static_cast<std::size_t>(to.width) * to.height;
  to.color.reserve(area);
  to.covers.reserve(area);
  for (int y = to.y0; y < to.y0 + to.height; ++y)
    for (int x = to.x0; x < to.x0 + to.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * alone.width + x;
      const chunker::Linear16& s = alone.pixels[at];
      to.color.push_back(layers::vec3(s.r, s.g, s.b) / one * transmitted[at]);
      to.covers.push_back(s != chunker::Linear16{});
      transmitted[at] *= 1 - static_cast<float>(s.a) / one;
    }
}

SpriteContribution of_background(const layers::vec3& color, layers::ivec2 display_px,
                                 const std::vector<float>& transmitted) {
  SpriteContribution background;
  background.channel = "background";
  background.width = display_px.x;
  background.height = display_px.y;
  background.color.reserve(transmitted.size());
  for (const float t : transmitted) background.color.push_back(color * t);
  return background;
}

std::vector<std::string> channel_names(const SpriteChannels& channels) {
  std::vector<std::string> names = {"R", "G", "B"};
  for (const SpriteContribution& sprite : channels.sprites) {
    for (const char* color : {".R", ".G", ".B"}) names.push_back(sprite.channel + color);
    if (sprite.layer.empty()) continue;
    for (const char* value : {".age", ".error", ".id"}) names.push_back(sprite.channel + value);
  }
  return names;
}

/// Its channels in one row of the picture, `samples` being those of the row's first pixel.
void fill_sprite_row(const SpriteContribution& sprite, int y, std::size_t stride, float* samples) {
  if (y < sprite.y0 || y >= sprite.y0 + sprite.height) return;
  for (int x = 0; x < sprite.width; ++x) {
    const std::size_t at = static_cast<std::size_t>(y - sprite.y0) * sprite.width + x;
    float* to = samples + static_cast<std::size_t>(sprite.x0 + x) * stride;
    for (int c = 0; c < 3; ++c) to[c] = sprite.color[at][c];
    if (sprite.layer.empty() || !sprite.covers[at]) continue;
    to[3] = sprite.age_frames;
    to[4] = sprite.error_px;
    to[5] = sprite.id;
  }
}

void fill_rows(const chunker::Frame& frame, const SpriteChannels& channels, int y0, int rows,
               std::size_t stride, float* samples) {
  std::fill(samples, samples + stride * frame.width * rows, 0.0f);
  for (int row = 0; row < rows; ++row) {
    float* const line = samples + stride * frame.width * row;
    for (int x = 0; x < frame.width; ++x) {
      const chunker::Linear16& p = frame.pixels[static_cast<std::size_t>(y0 + row) * frame.width + x];
      float* const to = line + stride * x;
      to[0] = static_cast<float>(p.r) / chunker::kOne;
      to[1] = static_cast<float>(p.g) / chunker::kOne;
      to[2] = static_cast<float>(p.b) / chunker::kOne;
    }
    std::size_t first = kFrameChannels;
    for (const SpriteContribution& sprite : channels.sprites) {
      fill_sprite_row(sprite, y0 + row, stride, line + first);
      first += sprite.layer.empty() ? kBackgroundChannels : kSpriteChannels;
    }
  }
}

std::string names_of_layers(const SpriteChannels& channels) {
  nlohmann::ordered_json names = nlohmann::ordered_json::object();
  for (const SpriteContribution& sprite : channels.sprites)
    if (!sprite.layer.empty()) names[sprite.channel] = sprite.layer;
  return names.dump();
}

}  // namespace

SpriteChannels sprite_channels(const Pipeline& pipeline, const PipelineState& state,
                               const FrameReport& report) {
  const layers::ivec2 size = report.display_px;
  const std::size_t area = static_cast<std::size_t>(size.x) * size.y;
  const BlendedSprites blended = blended_sprites(state, report);
  std::vector<float> transmitted(area, 1.0f);
  std::set<std::string> taken = {"background"};
  SpriteChannels channels;
  for (auto shown = report.shown.rbegin(); shown != report.shown.rend(); ++shown) {
    chunker::Frame alone{size.x, size.y, std::vector<chunker::Linear16>(area)};
    chunker::composite_onto(alone, std::vector{placed_sprite(*shown, state.sprites, blended)});
    SpriteContribution sprite;
    sprite.layer = report.layers[shown->layer].name;
    sprite.channel = channel_name(sprite.layer, taken);
    sprite.age_frames = static_cast<float>(shown->age_frames);
    sprite.error_px = static_cast<float>(report.plan.decisions[shown->layer].shown_geometric_px);
    sprite.id = static_cast<float>(shown->layer + 1);
    contribute(alone, transmitted, sprite);
    channels.sprites.push_back(std::move(sprite));
  }
  channels.sprites.push_back(of_background(pipeline.scene.background, size, transmitted));
  std::reverse(channels.sprites.begin(), channels.sprites.end());
  return channels;
}

EncodedPicture encoded_exr(const chunker::Frame& frame, const SpriteChannels& channels) {
  ChannelPicture picture;
  picture.width = frame.width;
  picture.height = frame.height;
  picture.channels = channel_names(channels);
  for (const std::string& name : picture.channels) {
    const std::string last = name.substr(name.rfind('.') + 1);
    picture.half.push_back(last == "R" || last == "G" || last == "B");
  }
  const std::size_t stride = picture.channels.size();
  picture.fill = [&](int y, int rows, float* samples) {
    fill_rows(frame, channels, y, rows, stride, samples);
  };
  picture.attributes = {{"talisman:layers", names_of_layers(channels)}};
  return picture_codec().encode_exr_channels(picture);
}

}  // namespace talisman::sequences
