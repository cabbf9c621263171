// SPDX-License-Identifier: Apache-2.0
#pragma once

/// At which resolution is a layer drawn when not all can be afforded at full resolution? Step 6 of [LS97 6].
///
///   share  s = min(1, √(pixels / Σ desired pixels), √(chunks / Σ desired chunks))
///          over the layers that were selected for rendering and for whose polygons there is a budget;
///          pixels and chunks are the frame's budget. Area is allocated in proportion to desired area, so s
///          is the same for all.
///   first appearance      r = s
///   changed since         r = s, but 0.9 … 1.1 times the value at the last render, so that it does not
///                         fluctuate visibly; and a further tenth lower for every frame in a row in which the
///                         layer was deferred for want of pixels or chunks
///   unchanged since       r = 1.1 times the value at the last render: a sprite at rest is sharpened as long
///                         as there is budget left
///   and always            min_resolution ≤ r ≤ 1
///
/// r is texels per texel of the resolution that the layer's author asks for, each axis.
///
/// Why a tenth lower with every frame waited: the limit of ±10 % counts from the last *render*, so a layer
/// that is dearer than the whole budget at 0.9 of its resolution would never be drawn, and never come closer
/// to its share. In this way it is drawn after at most log(min_resolution) / log(0.9) frames (20 by default),
/// without ever spending more than the budget, if pixels or chunks are what it lacks and min_resolution is
/// low enough. Polygons do not depend on the resolution: a layer with more polygons than the budget is drawn
/// at its first appearance and not again; its reason says so.

#include <span>

#include "regulator/plan.h"

namespace talisman::regulator {

/// Largest change of the resolution from one render to the next, relative [LS97 6].
inline constexpr double kMostChange = 0.1;

/// s, 0 … 1. The costs must be those of resolution 1.
double share_of_resolution(std::span<const LayerAssessment> assessments, const RegulatorOptions& options);

/// r of one layer for a given share.
double regulated_resolution(const LayerAssessment& layer, double share, const RegulatorOptions& options);

/// Sets `resolution` of all layers in view. The costs must be those of resolution 1; those of layers whose
/// resolution comes out lower are the caller's to compute again.
void regulate_resolutions(std::span<LayerAssessment> assessments, const RegulatorOptions& options);

/// Drawing the layer now would change nothing: its state is the same, at no lower resolution.
bool nothing_to_gain(const LayerAssessment& layer);

}  // namespace talisman::regulator
