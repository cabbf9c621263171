// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The two series of [LS97 4.2] on a set of objects.
///
/// First series: update rate against error threshold at 1024 × 1024, all fourteen curves; every object in the
/// main motion, and those that are studied in all motions. Second series: picture quality of those that are
/// studied, at one equal update rate.
///
/// Studied are flat teapot and teapot (without them flat box and box), as in the paper; where there is one
/// object only, it is.

#include "layers/polyhedron.h"
#include "sequences/experiments/warps/measured.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// All that there is to measure of the objects. `missing` is handed on. Cost: about a second per figure and
/// five per object in pictures, in proportion to the points of `bound`.
WarpReport measure_warps(std::vector<WarpObject> objects, std::vector<MissingObject> missing,
                         layers::BoundKind bound, ProgressKind progress);

}  // namespace talisman::sequences
