// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A world matrix taken apart: M = rotation · stretch, about an origin, as predictions need it (layers/predict.h).

#include <optional>

#include "layers/vectors.h"

namespace talisman::layers {

struct Placed {
  dmat3 rotation;
  dmat3 stretch;  ///< upper triangular
  dvec3 origin;
};

/// The rotation is found by orthonormalising the columns (Gram & Schmidt). Empty for a matrix that is flat.
std::optional<Placed> placed(const dmat4& m);

/// Axis times angle of a rotation, by the shorter way round: |angle| ≤ π.
dvec3 rotation_vector(const dmat3& rotation);

bool is_finite(const dmat4& m);

}  // namespace talisman::layers
