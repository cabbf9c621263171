// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where a sprite lies and how densely it is sampled: extents, rendering transform and spatial resolution [LS97 3.2, 3.3, 3.4].
///
/// A sprite point q (texels) is shown at p = A q (pixels): A is `screen_from_sprite`. A comes from the rectangle of least area
/// over a set of slab directions around the layer's clipped screen points. Two rules keep fresh sprites sharp and
/// runs comparable: an axis-aligned sprite at display density is anchored on the display's pixel lattice (A is a
/// whole-pixel translation, so compositing it unwarped loses nothing), and it is preferred while a rotated rectangle would save less than a
/// stated share of area; and extents grow by whole texels on a lattice that does not depend on the growth, so that the
/// samples are the same whatever reuse is expected.

#include "layers/state.h"

namespace talisman::layers {

struct ExtentOptions {
  double expected_reuse_frames = 8;   ///< ≥ 0; extents grow by velocity × this; more area is drawn, clipped sprites live longer
  double max_growth = 0.25;           ///< at most this share of the display's larger side, per side; 0 … 1
};

struct PlacementOptions {
  int slab_directions = 16;           ///< 2 … 30 [LS97 3.3]; more fit tighter and cost O(points) each
  double min_rotation_gain = 0.25;    ///< share of area that a rotated rectangle must save to be used; 0 … 1; 1: never rotate
  double resolution_scale = 1;        ///< texels per display pixel, each axis; (0, 4]
  int max_sprite_px = 4096;           ///< largest side of a sprite in texels; beyond it the resolution is lowered
};

/// Which sides of the sprite were cut off by the extents rather than by the layer's own bounds: in sprite space,
/// left (x = 0), right, top (y = 0), bottom.
struct ClippedSides {
  bool left = false, right = false, top = false, bottom = false;
  bool any() const { return left || right || top || bottom; }
  bool operator==(const ClippedSides&) const = default;
};

struct SpritePlacement {
  Affine2 screen_from_sprite;         ///< A
  ivec2 size_px{0, 0};                ///< texels, not rounded to chunks; {0, 0}: nothing in view
  ClippedSides clipped;
  bool axis_aligned = true;
  bool resolution_reduced = false;    ///< max_sprite_px forced a lower density than asked for
  bool empty() const { return size_px.x <= 0 || size_px.y <= 0; }
  bool operator==(const SpritePlacement&) const = default;
};

/// Placement of a sprite rendered at `now`. `soon` is the state one frame later (for the velocity; may equal `now`).
/// The extents cover the layer's screen points inside the display grown, on the sides to which content moves in, by velocity ×
/// expected reuse. Never non-finite; empty when nothing is in view. Cost: O(points · slab directions).
SpritePlacement place_sprite(const LayerState& now, const LayerState& soon, const Polyhedron& hull,
                             const ExtentOptions& extents, const PlacementOptions& options);

}  // namespace talisman::layers
