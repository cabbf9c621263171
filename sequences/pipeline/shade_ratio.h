// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do shadows leave of a surface, apart from the surface? The sprites that the extended compositor
/// multiplies with, and those that it lays atop.
///
///   multiply   [C_v / C_1, 1]         per channel; C_v: the surface with shadows, C_1: the same without, each cut
///                                     off at 1 as its sprite is; 1 where C_1 is 0. Kept as colour, the square
///                                     root in eight bits: as alpha, which is linear, deep shadows would be up
///                                     to six code values off.
///   atop       [0, A / β]             A = (1 - s) β: the shade's alpha, β: the surface's, each the mean over all
///                                     samples of a texel: so their ratio is the mean over the covered ones
///
/// Beside the silhouette there is no surface to ask. There each texel takes the mean of those of its eight
/// neighbours that have some, so that filtering at the edge does not mix in light: one texel far.

#include "chunker/multipass.h"

namespace talisman::sequences {

/// `seen` and `whole` are of one size.
chunker::LinearImage left_of_light(const chunker::LinearImage& seen, const chunker::LinearImage& whole);

/// `shadow` and `surface` likewise; only alphas are read.
chunker::LinearImage darkness_atop(const chunker::LinearImage& shadow, const chunker::LinearImage& surface);

}  // namespace talisman::sequences
