// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which triangles does a polygon consist of?
///
/// Ears (three corners in a row whose triangle holds none of the others) are cut off until three corners are left. The
/// polygon is looked at along its normal, half the sum of the cross products of its corners (Newell). Each outline that
/// touches itself but does not cross itself is covered once, that of a hole which it runs in to along a seam and back
/// included: the areas of the triangles sum to that of the polygon.

#include <array>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace talisman::sequences {

/// Numbers of corners, turning as the polygon does; fewer than n - 2 triangles where corners lie in a line or at one
/// place, none of an area of zero. An outline that crosses itself is covered, in places more than once. Four corners that can be cut both ways are cut along the shorter diagonal. Any finite corners.
/// Cost: O(n · (1 + r)) for r corners that turn inwards; memory O(n).
std::vector<std::array<int, 3>> triangulated(std::span<const glm::dvec3> corners);

}  // namespace talisman::sequences
