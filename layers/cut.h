// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How is one large part made into several?
///
/// A warp carries a sprite as if what it shows were flat. A room or a land around the eye is not: one warp does not serve,
/// and its layer is drawn in every frame. Cut into pieces, each a layer, it lasts longer: each is nearer to flat, and what is
/// far away hardly changes [LS97 2.1; 7.2: the landscape is split].
///
/// The triangles are divided by where they are, the middle of their bounds over the size of the part, and by where they face,
/// half their normal, so that opposite walls are as far apart as the ends of the part: the piece that is longest along any of
/// these six axes is cut in its middle, until there are as many as are wanted, or a triangle each. No triangle is cut, so
/// pieces share whole edges, over which a layer can reach (layers/seam.h).
///
/// Pieces of the part "room" are the parts "room~1", "room~2", ... Together they are drawn as it was.

#include <string>

#include "layers/scene.h"

namespace talisman::layers {

/// More pieces make nothing cheaper: each is a sprite.
inline constexpr int kMostCutPieces = 64;

/// The name of piece `k`, from 1 on.
std::string cut_piece_name(const std::string& part, int k);

/// Why a part cannot be cut: "has a skin", "has morph targets"; empty: it can.
std::string cut_defect(const Scene& scene, int part);

/// Cuts a part for which cut_defect is empty. The first piece takes its place, the others come last, each with a mesh of its
/// own. Returns how many there are: 1 (and nothing is changed) where there is one triangle or none, or `pieces` ≤ 1.
/// Cost: O(triangles · pieces).
int cut_part(Scene& scene, int part, int pieces);

}  // namespace talisman::layers
