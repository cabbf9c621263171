// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frames drawn on demand, of one setting: planned from frame 0 on, as every run does, so that a picture is that of the
/// run, byte for byte; frames that come one after another cost one step each.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sequences/files/image_io.h"
#include "sequences/pipeline/step.h"
#include "sequences/view/live_scene.h"
#include "sequences/view/ready_scenes.h"

namespace talisman::sequences {

/// How a frame is shown.
///
///   shown        as the run shows it                       direct    without sprites, the truth
///   beside       both, shown on the left
///   difference   |shown - direct|, four times, sRGB bytes  flip      FLIP of the two (pictures/flip.h)
///   overlay      outlines of sprites, coloured by age      age       of the frontmost sprite, the same colours
///   depth        how many sprites lie over each other, eight and more are white
enum class PictureMode { Shown, Direct, Beside, Difference, Flip, Overlay, Age, Depth };

std::vector<std::string> picture_mode_names();
/// Throws InputError that lists the modes.
PictureMode picture_mode(const std::string& name);

class LivePictures {
 public:
  /// Of a scene that is `ready`, and is that of `live`.
  LivePictures(LiveScene live, std::shared_ptr<const ReadyScene> ready);
  LivePictures(const LivePictures&) = delete;
  LivePictures& operator=(const LivePictures&) = delete;

  int frames() const { return live_.variant.sequence.frames; }
  /// The camera's flight; none: the sequence's own. Where it begins as the one before did and `goes_on`, what was planned
  /// stays, though the last frame of a flight does not know where the next one goes: fast, and nearly what the whole
  /// flight would show. Else all is planned anew.
  void follow(const std::vector<CameraPose>& flight, bool goes_on);
  /// Empty where `is_stale` said so on the way. Throws InputError where there is no such frame.
  std::optional<Image8> draw(int frame, PictureMode mode, const std::function<bool()>& is_stale);

 private:
  Image8 picture(PictureMode mode);
  void start_again();

  LiveScene live_;
  std::shared_ptr<const ReadyScene> ready_;
  std::vector<CameraPose> flight_;
  Pipeline pipeline_;
  std::unique_ptr<PipelineState> state_;
  FrameReport report_;
  int at_ = -1;         ///< the frame of `report_`
  bool drawn_ = false;  ///< it has its picture
};

}  // namespace talisman::sequences
