// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is drawn when a sprite no longer serves: all of it, or its chunks that do not (regulator/chunk_refresh.h)?

#include <array>
#include <string_view>

namespace talisman::regulator {

enum class Refresh {
  Sprite,  ///< all of it
  Chunks,  ///< policy Threshold: where only places are too far off, the chunks that show them
};
inline constexpr std::array kAllRefreshes = {Refresh::Sprite, Refresh::Chunks};
std::string_view name(Refresh refresh);  ///< "sprite", "chunks"

/// What a decision says of the chunks of a sprite that were judged one by one.
struct ChunkShare {
  int drawn = 0;         ///< of them, now
  int stored = 0;        ///< that may hold something, by the layer's geometry
  double step_px = 0;    ///< between neighbours of different age that are shown, at most, px
  int torn_borders = 0;  ///< groups of triangles at such borders whose two pictures lie more than δ apart
  double share() const { return stored > 0 ? static_cast<double>(drawn) / stored : 0; }
};

}  // namespace talisman::regulator
