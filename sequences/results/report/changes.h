// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What has changed since a layer was last drawn, and how much of the error of its old sprite is due to that?
///
///   E       geometric error of the old sprite, as decisions.jsonl has it: with its warp, of the policy `hold` without
///   E(c)    the same, had nothing changed but the cause c; all else is as it was at the sprite's instant, and the warp
///           is the one that fits then                                                                      [px]
///
/// over four causes: the camera; the layer's own motion (the nodes, joints and shapes of its parts); the lights; other
/// layers (all other nodes). The last two act through shadows, highlights and mirrored pictures alone.
///
///   separable    |Σ E(c) - E| ≤ kSumTolerance · E
///
/// A cause that alone would have moved the layer out of view has no E(c): the old sprite would not be looked at. Errors are lengths: two causes may cancel out (a camera that goes along) or, in perspective, do more together than
/// one by one. Then the amounts are what each would have done alone, and no shares of E.
///
/// One cause alone has all of E, and nothing is computed; else a fit for each cause that has acted.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/results/columns.h"

namespace talisman::sequences {

inline constexpr double kSumTolerance = 0.1;

/// A line of changes.jsonl: a layer with an old sprite that is off by something.
struct Change {
  int frame = 0;
  std::string layer;
  int since_frame = 0;      ///< the instant that the old sprite shows
  double geometric_px = 0;  ///< E
  /// E(c); empty: alone it would have moved the layer out of view.
  std::optional<double> camera_px = 0, own_motion_px = 0, light_px = 0, other_layers_px = 0;
  bool separable = false;

  /// Of those that there are.
  double sum_px() const {
    return camera_px.value_or(0) + own_motion_px.value_or(0) + light_px.value_or(0) +
           other_layers_px.value_or(0);
  }
};

/// Its first kChangeKeys columns, frame and layer, say which decision a line belongs to.
const ColumnTable<Change>& change_table();
inline constexpr std::size_t kChangeKeys = 2;
std::string json_of(const Change& change);

/// When each layer was last drawn, by name, from the reports of a run in their order.
class LastRenders {
 public:
  struct Render {
    int frame = 0;    ///< in which it was drawn
    int instant = 0;  ///< that it shows
  };
  /// Of the frames noted so far.
  std::optional<Render> of(const std::string& layer) const;
  void note(const FrameReport& report);

 private:
  std::map<std::string, Render> renders_;
};

/// Of the layers of a frame; `before`: of the frames before it. None for layers without an
/// error, and for those of whose last render nothing is known.
std::vector<Change> changes_in(const Pipeline& pipeline, const FrameReport& report,
                               const LastRenders& before);

}  // namespace talisman::sequences
