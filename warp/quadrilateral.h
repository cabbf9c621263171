// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which perspective warp does a textured quadrilateral in space give? (`pers`, and its refinement `pers2`)
///
/// The method of [Shade96] as [LS97 4.2] derives it: a plane is put through the centre of the layer's
/// bounding box, perpendicular to the view direction at the last render. The characteristic points are
/// projected onto it from the eye, bounded there by a rectangle, and the rectangle's corners are carried with
/// the object and projected to the display now. The homography that maps the four old corners to the four new
/// ones is the warp.
///
/// The view direction is that from the eye to the centre; the rectangle's sides are parallel to the camera's
/// x and y projected onto the plane. The corners follow the object by the similarity in space that best maps
/// its points then to its points now (Umeyama 1991), which is exact for a rigid layer.

#include <span>

#include "layers/state.h"
#include "warp/fit.h"

namespace talisman::warp {

/// The curve `pers`. `matched` is correspond(then, now): the errors are measured on it, and it decides the
/// simpler family where the quadrilateral gives no answer: no eye-side points, a corner behind the near plane
/// now, an edge-on or mirrored quadrilateral. Status as in fit(). Cost: O(points), about 3 µs for a box.
FitResult fit_shade(const layers::LayerState& then, const layers::LayerState& now,
                    const layers::Correspondences& matched);

/// fit() for any curve, with the layer in space for those that need it: pers is fit_shade(), pers2 is refined
/// from it by least squares after the divide (Ceres).
FitResult fit(const layers::LayerState& then, const layers::LayerState& now,
              const layers::Correspondences& matched, Curve curve, const FitOptions& options = {});

}  // namespace talisman::warp
