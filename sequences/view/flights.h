// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A camera that is flown by hand: a pose per frame, in place of the sequence's own camera, and as a file that any command
/// of the tool reads.

#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/view/view_request.h"
#include "sequences/view/view_source.h"

namespace talisman::sequences {

/// A copy of the scene whose camera may be flown; all else is shared with nobody. Cost: the scene's memory.
layers::Scene flyable(const layers::Scene& scene);

/// Lets the camera of a flyable scene go through `flight`, frame f at f / fps. Level, and as a sequence file with these poses
/// would have it. May be called again with a longer flight.
void fly(layers::Scene& scene, const std::vector<CameraPose>& flight, double fps);

/// Writes OUT/NAME.yaml, a sequence that extends the one in view, and returns its path. Never over a file that is there.
/// Throws InputError for a name that is not of letters, digits, '-' and '_', OutputError where it cannot be written.
std::string save_flight(const ViewSource& source, const layers::Camera& camera, double fps,
                        const ViewRequest& request);

}  // namespace talisman::sequences
