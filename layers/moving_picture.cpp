// SPDX-License-Identifier: Apache-2.0
#include "layers/moving_picture.h"

#include <algorithm>
#include <cmath>

namespace talisman::layers {
namespace {

double length_s(const MovingPicture& picture) {
  return picture.starts_s.empty() ? picture.frame_count / picture.fps : picture.length_s;
}

/// Seconds since the start, in the first round of what loops. What is within the tolerance of the next round
/// belongs to it.
double time_inside(const MovingPicture& picture, double t_s) {
  const double since = t_s - picture.start_s, length = length_s(picture);
  if (!picture.loop || !(length > 0) || since < 0) return since;
  const double tolerance = kFrameTolerance * length / picture.frame_count;
  return since - length * std::floor((since + tolerance) / length);
}

/// The frame that is held in place of `number`: an index into MovingPicture::frames.
std::size_t index_held(const MovingPicture& picture, int number) {
  const auto after = std::upper_bound(picture.frames.begin(), picture.frames.end(), number);
  return after == picture.frames.begin() ? 0 : static_cast<std::size_t>(after - picture.frames.begin()) - 1;
}

int texture_of(const MovingPicture& picture, int number) {
  return picture.textures[index_held(picture, number)];
}

void add_shown(const ShownPicture& shown, std::vector<ShownPicture>& pictures) {
  const auto place =
      std::lower_bound(pictures.begin(), pictures.end(), shown,
                       [](const ShownPicture& a, const ShownPicture& b) { return a.picture < b.picture; });
  if (place == pictures.end() || place->picture != shown.picture) pictures.insert(place, shown);
}

}  // namespace

int frame_at(const MovingPicture& picture, double t_s) {
  const double since = time_inside(picture, t_s);
  const int last = picture.frame_count - 1;
  if (picture.starts_s.empty()) {
    const double number = std::floor(since * picture.fps + kFrameTolerance);
    return static_cast<int>(std::clamp(number, 0.0, static_cast<double>(last)));
  }
  const auto after = std::upper_bound(picture.starts_s.begin(), picture.starts_s.end(), since);
  return std::clamp(static_cast<int>(after - picture.starts_s.begin()) - 1, 0, last);
}

std::vector<int> picture_frames_at(const Scene& scene, double t_s) {
  std::vector<int> frames;
  for (const MovingPicture& picture : scene.moving_pictures) frames.push_back(frame_at(picture, t_s));
  return frames;
}

int moving_picture_of(const Scene& scene, int texture) {
  if (texture < 0) return -1;
  for (std::size_t i = 0; i < scene.moving_pictures.size(); ++i)
    if (scene.moving_pictures[i].texture == texture) return static_cast<int>(i);
  return -1;
}

int moving_picture_of(const Scene& scene, const Material& material) {
  for (const int texture : {material.texture, material.texture2, material.emissive_texture})
    if (const int picture = moving_picture_of(scene, texture); picture >= 0) return picture;
  return -1;
}

int texture_at(const SceneFrame& frame, int texture) {
  const int picture = moving_picture_of(*frame.scene, texture);
  return picture < 0 ? texture
                     : texture_of(frame.scene->moving_pictures[picture], frame.picture_frames[picture]);
}

void add_shown_pictures(const SceneFrame& frame, std::span<const int> parts,
                        std::vector<ShownPicture>& pictures) {
  const Scene& scene = *frame.scene;
  if (scene.moving_pictures.empty()) return;
  for (const int part : parts) {
    if (scene.parts[part].material < 0) continue;
    const Material& material = scene.materials[scene.parts[part].material];
    for (const int texture : {material.texture, material.texture2, material.emissive_texture})
      if (const int i = moving_picture_of(scene, texture); i >= 0)
        add_shown({i, frame.picture_frames[i]}, pictures);
  }
}

std::string new_picture_in_words(const Scene& scene, std::span<const ShownPicture> then,
                                 std::span<const ShownPicture> now) {
  for (const ShownPicture& shown : now)
    if (std::find(then.begin(), then.end(), shown) == then.end())
      return "new frame of '" + scene.moving_pictures[shown.picture].name + "', " +
             std::to_string(shown.frame);
  return then.size() == now.size() ? "" : "a moving picture is gone";
}

std::int64_t bytes_of(const Scene& scene, const ShownPicture& shown) {
  const Texture& texture = scene.textures[texture_of(scene.moving_pictures[shown.picture], shown.frame)];
  return std::int64_t{4} * texture.width * texture.height;
}

}  // namespace talisman::layers
