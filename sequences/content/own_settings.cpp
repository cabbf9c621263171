// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/own_settings.h"

namespace talisman::sequences {

Settings own_settings(const Sequence& sequence) {
  Settings settings;
  settings.regulator = sequence.regulator;
  settings.curve = warp::curve_from_name(sequence.warp).value_or(settings.curve);
  settings.view.display_px = sequence.display_px;
  if (sequence.clip_margin) settings.view.clip_margin = *sequence.clip_margin;
  settings.bound = sequence.bound;
  settings.material_points = sequence.material_points;
  settings.explicit_order = sequence.explicit_order;
  settings.cycles = sequence.cycles;
  settings.compositor = sequence.compositor;
  settings.extents = sequence.extents;
  settings.placement = sequence.placement;
  settings.compression = sequence.compression;
  settings.visibility = sequence.visibility;
  settings.cells = sequence.cells;
  settings.fps = sequence.fps;
  settings.frames = sequence.frames;
  return settings;
}

}  // namespace talisman::sequences
