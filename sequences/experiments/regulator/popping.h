// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How hard does the picture jump when a sprite is drawn again? [LS97 7] names the "clicking" and has no
/// number for it.
///
///   E_f(x) = shown_f(x) - reference_f(x)    signed error image, sRGB code values per channel
///
///   D_f(x) = E_f(x) - E_{f-1}(x)            what the error did between two consecutive frames
///
///   A_f      pixels whose centre lies in the display rectangle of a sprite that was drawn again in f, or whose
///            share in a cross-fade is not that of f - 1, and
///            was shown in f - 1, too, at a texel that is not clear
///
/// popping: RMS of D_f over the pixels of A_f and their three channels, over all frames measured
///
/// p95: the 95th percentile over the same pixels of maxᶜ |D_f|, whole code values
///
/// elsewhere: RMS of D_f over all other pixels: how fast the error changes where nothing was drawn again
///
/// Why a step of the error and not the error: a constant error is part of the picture. A ship that is always
/// shown two pixels too far left, or land that is always a little too dark, looks as if it were so, and D is
/// zero. What the eye catches is the frame in which the ship jumps back to its place: there E falls from the
/// error of the old sprite to that of the fresh one at once, and D is the height of this step. Both frames
/// are compared with their own reference, so motion that is shown as it should be drops out. Motion of what
/// is shown wrongly does not (its error moves with it), which is why D is taken where sprites are fresh.
///
/// Under `reference` D = 0 everywhere; so it is for a policy whose error does not change. A first appearance
/// is no step: there was nothing that could jump. Where other layers lie before the sprite or show through
/// it, their error is part of D; `elsewhere` says how much that may be.
///
/// Unit: code values 0 … 510; best 0. One code value is 1/255 of the range from black to white.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sequences/files/image_io.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

/// One byte per pixel, row by row; not 0 where the pixel belongs to the set.
using PixelMask = std::vector<std::uint8_t>;

/// A_f: `now` is the report of frame f, which was drawn, `sprites` the store after it, `shown_before` the
/// layers that frame f - 1 showed. Cost: O(area of the rectangles on the display).
PixelMask stepping_pixels(std::span<const int> shown_before, const FrameReport& now,
                          const chunker::SpriteStore& sprites, layers::ivec2 display_px);

/// Two consecutive frames.
struct ConsecutiveFrames {
  const Image8& before;
  const Image8& now;
};

struct Popping {
  double rms = 0, p95 = 0;    ///< code values; NaN where no sprite was drawn again in a measured frame
  double elsewhere_rms = 0;   ///< code values
  double stepping_share = 0;  ///< pixels of A over all pixels, 0 … 1
  int frames = 0;             ///< pairs of frames that were measured
  int frames_with_steps = 0;  ///< of them, those with an A that is not empty
};

/// Gathers the steps of one run. Memory: a histogram, however long the run. Sums are of whole numbers, so the
/// result does not depend on any order.
class PoppingMeter {
 public:
  /// All pictures of one size, `stepping` of as many pixels (programmer error otherwise).
  void add(const ConsecutiveFrames& shown, const ConsecutiveFrames& reference, const PixelMask& stepping);
  Popping result() const;

 private:
  static constexpr int kLargestStep = 510;
  struct Sums {
    std::int64_t pixels = 0, squares = 0;
    double rms() const;
  };
  Sums stepping_, elsewhere_;
  std::array<std::int64_t, kLargestStep + 1> steps_{};  ///< pixels of A by maxᶜ |D|
  int frames_ = 0, frames_with_steps_ = 0;
};

}  // namespace talisman::sequences
