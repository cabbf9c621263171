// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where something of a sequence file stands, or how it flies and turns: the keys that shapes, models, their
/// instances, the camera and lights share.

#include <optional>
#include <string>

#include "layers/scene.h"
#include "sequences/content/key_table.h"
#include "sequences/content/traces/trace.h"

namespace talisman::sequences {

struct Motion {
  std::string carried_by;  ///< id of the shape with which it moves; empty: it moves in the world
  std::string file;        ///< and line: where it is written, for errors that show only with the scene
  int line = 0;
  layers::Transform rest;
  std::optional<layers::FlightTrack> flight;
  std::optional<layers::SpinTrack> spin;
  std::optional<TraceOptions> trace;  ///< what is tracked moves so; `rest` is then its place on that
};

const Table<Motion>& motion_keys();

}  // namespace talisman::sequences
