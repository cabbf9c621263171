// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Chunks that are drawn when they are first read, and never if nothing reads them.
///
/// A sprite outlives its frame, and of what it holds a part is never seen: what lies outside the display, or
/// behind opaque sprites. Here its triangles, set up and binned as of its own instant, are kept beside it, and a
/// chunk is drawn from them when it is first asked for: the bytes are those of a sprite drawn at once. What is
/// looked up while drawing (textures) is kept, too; a sprite that looks up shadow maps or reflections, which
/// change, is drawn at once.
///
/// Cost: the triangles and their attributes stay in memory as long as the sprite has chunks that were not read,
/// some 150 bytes a triangle.

#include <cstdint>
#include <span>

#include "chunker/composite.h"
#include "chunker/render.h"

namespace talisman::chunker {

/// For several threads at once: who asks for a chunk that another thread draws waits for it.
class LateChunks {
 public:
  LateChunks() = default;
  LateChunks(const LateChunks&) = delete;
  LateChunks& operator=(const LateChunks&) = delete;
  virtual ~LateChunks() = default;
  /// Chunks in which there may be something; slots are 0 … count-1.
  virtual int count() const = 0;
  /// Null where the drawn chunk is clear.
  virtual const Chunk* chunk(int slot) = 0;
  virtual std::uint16_t opaque_blocks(int slot) = 0;
  /// Was every chunk read before the last rest()?
  virtual bool all_drawn() const = 0;
  /// Frees what drawing needs beside the triangles, and returns what was counted since the last call. Not while
  /// others read.
  virtual RenderCounters rest() = 0;
};

/// What render() draws, late. The counters hold what is known by now: polygons, and chunks without any.
RenderResult render_late(const PreparedScene& prepared, const layers::SceneFrame& frame,
                         std::span<const int> parts, layers::ivec2 display_px,
                         const layers::SpritePlacement& placement, const RenderOptions& options = {},
                         const ShadeInputs& inputs = {});

/// Draws the late chunks that composite() would read, from front to back in each tile: those behind opaque
/// texels are not. Without it they are drawn all the same, but while compositing.
void draw_late_chunks(std::span<const PlacedSprite> sprites, layers::ivec2 display_px);

}  // namespace talisman::chunker
