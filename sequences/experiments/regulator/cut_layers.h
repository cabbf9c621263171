// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The rival of chunks that are drawn alone: the same layers, cut into more of them.
///
/// A surface of one rigid part is halved at the median of its triangles, again and again, into layers of their own,
/// each with its bound, its warp and its sprite; the author's wishes are those of the whole. Pieces are joined by seams
/// (layers/seam.h), for the warps of two of them open a crack. What has several parts, deforms, or is factored into terms of
/// shading stays as it is.

#include "sequences/content/sequence.h"

namespace talisman::sequences {

/// The first piece has the layer's name, the others "NAME, piece 2" and so on, behind all other layers. The same
/// sequence for one piece. `pieces` is a power of 2. Cost: a copy of the scene.
Sequence with_cut_layers(const Sequence& sequence, int pieces);

}  // namespace talisman::sequences
