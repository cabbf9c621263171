// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The decision side of the shadow maps of one frame (regulator/shadow_maps.h): which layers look them up, what
/// drawing them costs, how far their shadows have run; and, when layers are drawn, from which maps. No pixel is
/// touched.
///
/// The casters as they were when a map was drawn are remembered by their characteristic points. A sprite that is
/// drawn from an old map has the shadows of that instant on the surface of now; its state says so: it has the
/// traces (layers/shade_state.h) that those points cast, so that every later fiducial counts from them.
///
/// Limits, stated. A picture that a mirror shows has no traces, so that shadows inside it count as moved as far as
/// the farthest elsewhere. The faces of a map are counted by the bounds of what casts: a point light among them
/// has six, else one.

#include <vector>

#include "regulator/shadow_maps.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// What is known of the shadow maps at one frame. Empty where no shadow is called for.
struct ShadowMapsNow {
  std::vector<regulator::MapAssessment> maps;  ///< LayerAssessment::layer is the index of the light
  std::vector<ShadowMapCost> costs;            ///< of drawing them at full resolution, by light
  /// By light, then by layer: the state of now with the shadows of the map at hand. Empty where the map is up to
  /// date, or where no policy would hold it.
  std::vector<std::vector<layers::LayerState>> with_old_shadows;
};

/// Cost: nothing without shadows; O(casters) with them; where an old map may be held, a capture of all traces.
ShadowMapsNow assess_shadow_maps(const Pipeline& pipeline, PipelineState& state, const FrameReport& report);

/// The map as it would be drawn at another resolution, and its cost.
void set_resolution(const Pipeline& pipeline, double resolution, regulator::MapAssessment& map);

/// The rows of the tables, before anything is drawn.
std::vector<ShadowMapRow> shadow_map_rows(const Pipeline& pipeline, const ShadowMapsNow& maps,
                                          const std::vector<regulator::LayerDecision>& decisions);

/// Notes that the layer of `memory`, whose new state is in it, is rendered as of `instant`: which maps that takes
/// and which old ones it looks up.
void look_up_shadow_maps(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps, int layer,
                         int instant, FrameReport& report);

/// After the last layer of the frame.
void finish_shadow_maps(PipelineState& state, FrameReport& report);

}  // namespace talisman::sequences
