// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Of which frames does an experiment draw pictures?
///
/// Plans are made of every frame of the range (and of those before it, as in any run). Pictures are drawn of
/// some: the range is cut into strata of `every` frames, and in each one frame f and its predecessor f - 1
/// are drawn. In its stratum f is the frame whose phases in the periods of hold and interpolate
///
///   f mod n,   n in compared_holds()
///
/// were met least so far, each weighted by its period, and of those the one nearest to the middle: so no
/// policy is seen at its renders, or between them, too often. every = 1 draws all.

#include <vector>

namespace talisman::sequences {

struct ExperimentFrames {
  int first = 0, last = 0;  ///< inclusive
  int every = 1;            ///< ≥ 1: one frame of so many is drawn; more is quicker and less certain
};

/// The periods of the policies hold and interpolate that are compared: frames from one render to the next.
std::vector<int> compared_holds();

/// The frames f that are drawn together with their predecessors, ascending; at least one.
std::vector<int> sampled_frames(const ExperimentFrames& frames);

/// These and their predecessors, each once, ascending: all of which there are pictures.
std::vector<int> drawn_frames(const ExperimentFrames& frames);

/// Is the frame one of them? O(log n).
bool is_sampled(const std::vector<int>& sampled, int frame);

}  // namespace talisman::sequences
