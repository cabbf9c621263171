// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where does a sprite lie and how densely is it sampled? Extents, rendering transform and spatial resolution
/// [LS97 3.2, 3.3, 3.4].
///
/// A sprite point q (texels) is shown at p = A q (pixels): A is `screen_from_sprite`. With rotation R(θ),
/// density s (texels per pixel) and the whole-numbered first texel (x0, y0):
///
///   lattice point  l = s R(-θ) p        origin at the display's corner, one lattice per θ and s
///   sprite point   q = l - (x0, y0)     so A q = R(θ) (q + (x0, y0)) / s
///
/// θ is the slab direction k · (π/2) / n, k = 0 … n - 1, whose rectangle around the layer's outline on the
/// display has the least area in texels, padding included. θ and s never depend on how far the extents grow,
/// and (x0, y0) are whole numbers, so the samples of a sprite are the same whatever reuse is expected. With θ
/// = 0 and s = 1 the lattice is that of the pixels: compositing such a sprite unwarped loses nothing. It is
/// preferred while a rotated rectangle would save less than a stated share of area.
///
/// For motion blur [LS97 3.4, Fig. 11] one axis of the lattice follows the layer's motion on the display, and
/// its samples are farther apart along it: with density s_x, s_y of the two axes, l = (s_x, s_y) · R(-θ) p. θ
/// and both densities come from the motion alone, so the rules above hold.
///
/// Around the layer there is one texel of padding, for its antialiased edge and the bilinear filter. Only
/// where the extents cut the layer off, on the lattice of the pixels, there is none: what lies beyond is off
/// the display, and a full screen keeps its whole number of chunks.

#include "layers/state.h"

namespace talisman::layers {

struct ExtentOptions {
  double expected_reuse_frames = 8;  ///< ≥ 0; extents grow by velocity × this; more area is drawn, clipped
                                     ///< sprites live longer
  double max_growth = 0.25;  ///< at most this share of the display's larger side, per side; 0 … 1; what
                             ///< exceeds View::clip_margin has no effect
  bool whole = false;        ///< all of the clipped view instead (LayerPreferences::whole_extents)
};

/// Values outside the ranges count as the nearest end, NaN as the default.
struct PlacementOptions {
  int slab_directions = 16;         ///< 2 … 30 [LS97 3.3]; more fit tighter and cost O(points) each
  double min_rotation_gain = 0.25;  ///< share of area that a rotated rectangle must save to be used; 0 … 1;
                                    ///< 1: never rotate
  double resolution_scale = 1;  ///< texels per display pixel, each axis; (0, 4]; cost grows with its square
  dvec2 motion{0, 0};  ///< direction on the display along which the sprite is blurred, of any length and
                       ///< sign; {0, 0} or not finite: none
  double motion_density = 1;  ///< density along it relative to that across it; [1/16, 1]; 1: no blur; less
                              ///< blurs more and draws fewer texels
  int max_sprite_px = 4096;  ///< ≥ 8; largest side of a sprite in texels; beyond it growth is given up first,
                             ///< then the resolution is lowered
};

/// Which sides of the sprite were cut off by the extents rather than by the layer's own bounds: in sprite
/// space, left (x = 0), right, top (y = 0), bottom.
struct ClippedSides {
  bool left = false, right = false, top = false, bottom = false;
  bool any() const { return left || right || top || bottom; }
  bool operator==(const ClippedSides&) const = default;
};

struct SpritePlacement {
  Affine2 screen_from_sprite;  ///< A
  ivec2 size_px{0, 0};         ///< texels, not rounded to chunks; {0, 0}: nothing in view
  ClippedSides clipped;
  bool axis_aligned = true;
  bool resolution_reduced = false;  ///< max_sprite_px forced a lower density than asked for
  double density_kept = 1;          ///< share of the density asked for, (0, 1]: less where it was reduced
  bool empty() const { return size_px.x <= 0 || size_px.y <= 0; }
  bool operator==(const SpritePlacement&) const = default;
};

/// Placement of a sprite rendered at `now`. `soon` is the state one frame later (for the velocity; may equal
/// `now`). The extents are the display grown on the sides to which content moves in, by the velocity of the
/// points on that half of the display × expected reuse. Never non-finite; empty when nothing is on the
/// display. Cost: O(points · slab directions).
SpritePlacement place_sprite(const LayerState& now, const LayerState& soon, const Polyhedron& hull,
                             const ExtentOptions& extents, const PlacementOptions& options);

}  // namespace talisman::layers
