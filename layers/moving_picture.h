// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which frame of an image sequence or a video is shown at one time?
///
///   n = floor((t - start_s) · fps + 1e-6)                    frames of one rate
///   n = the last frame with starts_s[n] ≤ t - start_s        frames with times of their own
///
/// 1e-6 of a frame is more than rounding loses in t = k / fps, and less than anybody sees. Before frame 0 that one
/// is shown; after the last one, the last, or where the picture loops the first again.
///
/// A frame is content: no warp makes a new one of an old one. So a sprite that shows an old frame is within no
/// bound, and is drawn again (regulator/plan.h, LayerAssessment::new_picture) [LS97 1].

#include <span>
#include <string>
#include <vector>

#include "layers/scene.h"
#include "layers/state.h"

namespace talisman::layers {

/// Share of a frame by which its time may be missed.
inline constexpr double kFrameTolerance = 1e-6;

/// Number of the frame of the source that is shown at `t_s` (finite). Cost: O(log frames).
int frame_at(const MovingPicture& picture, double t_s);

/// The same for all moving pictures of a scene; empty where it has none.
std::vector<int> picture_frames_at(const Scene& scene, double t_s);

/// The texture that is looked up for `texture` now: of a moving picture the held frame with the largest number that
/// is at most the frame shown (before the first: the first), of all others itself. Cost: O(moving pictures).
int texture_at(const SceneFrame& frame, int texture);

/// Index into Scene::moving_pictures of the one that `texture` stands for; -1: it stands still.
int moving_picture_of(const Scene& scene, int texture);

/// The moving picture that a material shows, by the first of its textures that is one; -1: none.
int moving_picture_of(const Scene& scene, const Material& material);

/// Frames of the moving pictures on `parts`, joined to what `pictures` holds: by index, each once.
void add_shown_pictures(const SceneFrame& frame, std::span<const int> parts,
                        std::vector<ShownPicture>& pictures);

/// "new frame of 'news.mp4', 12": the first that differs; empty where none does.
std::string new_picture_in_words(const Scene& scene, std::span<const ShownPicture> then,
                                 std::span<const ShownPicture> now);

/// Bytes of the frame's texels, 4 each, as they are sent to a texture memory.
std::int64_t bytes_of(const Scene& scene, const ShownPicture& shown);

}  // namespace talisman::layers
