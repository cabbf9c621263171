// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is a shadow map drawn anew in this frame, or are the shadows those of an old one? [LS97 2.3, Fig. 5]
///
/// A shadow map is a layer in the price: it has polygons (those of the casters) and pixels (its texels), an age,
/// a resolution, and a decision with a reason in every frame. It differs from others in that nothing of it is
/// displayed: what it is worth shows in the sprites that look it up when they are drawn. So a map is drawn only
/// if a layer that looks it up is drawn in the same frame, and its fiducial is an error of those:
///
///   moved = max over the layers in view that look it up of
///           how far the shadow that it casts on them has run since it was drawn, as seen now   [px]
///
/// which is the shade motion of fiducials/shade_drift.h between shadows of the light and the casters as they
/// were and as they are, on the receiver as it lies now. A sprite that is drawn from an old map has this error
/// from the beginning; it is what the decision says of it (LayerDecision::shown_geometric_px), and it counts on
/// in the geometric fiducial of the sprite.
///
///   up to date             never drawn
///   Budget                 regulator/budget.h: if that buys more than what else its polygons and pixels buy
///   Threshold              if moved > shadow_map_px (0 by default: whenever it is out of date)
///   all others             whenever it is out of date
///
/// Lookahead and Oracle draw sprites as of several instants in one frame, each from a map of its instant: their
/// maps are not decided here but follow from the sprites.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "regulator/plan.h"

namespace talisman::regulator {

/// A layer that looks the map up if it is drawn.
struct MapUse {
  int layer = -1;
  double moved_px = 0;  ///< of the shadow on this layer, since the map was drawn
};

/// What the regulator knows about one shadow map at one frame.
struct MapAssessment {
  std::string name;  ///< in reasons: "shadow map of sun"
  /// in_view: a layer in view looks it up; has_sprite: it was drawn before; identical: it is up to date. Its
  /// geometric and shade fiducials are `moved`, where that matters. Cost: of drawing it now.
  LayerAssessment map;
  std::vector<MapUse> uses;  ///< the layers in view that look it up
};

/// How far the shadows on a layer are off if it is drawn now while `drawn_anew` are drawn, too; the rest are old.
/// `drawn_anew` by map.
double moved_on(int layer, std::span<const MapAssessment> maps, const std::vector<bool>& drawn_anew);

/// Is a layer that looks it up drawn? `decisions` in the order of ids.
bool is_looked_up(const MapAssessment& map, std::span<const LayerDecision> decisions);

/// The decisions of all policies but Budget.
std::vector<LayerDecision> decide_maps(std::span<const MapAssessment> maps,
                                       std::span<const LayerDecision> decisions,
                                       const RegulatorOptions& options);

/// A map that is left as it is, and why.
LayerDecision keep_map(const MapAssessment& map, std::string reason);

/// Says in the decisions of layers that are drawn from old maps that they are, and how far off that is.
void show_held_maps(std::span<const MapAssessment> maps, std::span<const LayerDecision> of_maps,
                    std::vector<LayerDecision>& decisions);

}  // namespace talisman::regulator
