// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One frame of a sequence, looked at: what was decided about its layers, and for one of them the pictures.

#include <optional>
#include <string>

#include "sequences/files/image_io.h"
#include "sequences/results/decision_history.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

/// What the old sprite shows, or would have shown, and what a fresh one does, both alone.
struct LayerPictures {
  chunker::Frame old, fresh;
};

struct ExplainedFrame {
  std::vector<LayerHistory> layers;       ///< of the frame, in the order of decisions.jsonl
  std::optional<LayerPictures> pictures;  ///< of the layer asked for, if it is in view and has an old sprite
  int last_planned = 0;                   ///< the frame up to which it was looked for the next render
};

/// Plans from frame 0 on, until every layer of the frame has been drawn once more or the sequence ends. `layer`:
/// whose pictures are drawn; empty: none.
ExplainedFrame explained_frame(const Sequence& sequence, const Settings& settings, int frame,
                               const std::string& layer);

/// The same from the folder of a run, without pictures. Throws InputError where the folder holds no complete run of
/// this version, or the frame is not in it. `settings` are set to those of the run.
ExplainedFrame explained_folder(const std::string& folder, int frame, nlohmann::ordered_json& settings);

/// Old, fresh and their difference side by side: the layer, or 360 pixels around the place where its geometric error is
/// largest. That is marked.
Image8 explanation_sheet(const std::vector<std::string>& title, const LayerPictures& pictures,
                         layers::dvec2 worst_px);

}  // namespace talisman::sequences
