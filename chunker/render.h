// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The chunk renderer: a layer's parts, at one instant, into one sprite [LS97 1.1, 3; A §1].
///
/// Vertices are transformed once, triangles are clipped (near plane, guard band) and binned to 32×32 chunks,
/// and the chunks are independent jobs. Inside a chunk: coverage by fixed-point edge functions with a
/// top-left rule on a 4×4 sub-pixel grid (a shared edge is covered exactly once); opaque full cover goes
/// straight to the pixel; partial cover and translucency become fragments with mask, premultiplied colour and
/// a depth plane; resolve composites front to back in each of the 16 sub-pixels. A fragment merges with the
/// last one stored for its pixel when depth and colour are within tolerance; when fragment memory overflows
/// the chunk is subdivided and its pieces are rendered independently, with the same result.
///
/// The result is the same, byte for byte, for any number of threads, any SIMD width and any order of chunks.

#include <cstdint>
#include <memory>
#include <span>

#include "chunker/sprite.h"
#include "layers/layer.h"
#include "layers/scene.h"
#include "layers/sprite_transform.h"

namespace talisman::chunker {

enum class Shading { Flat, Gouraud, Phong };

struct RenderOptions {
  Shading shading = Shading::Phong;  ///< Gouraud shades vertices, Phong every covered pixel
  bool mipmaps = true;               ///< without them minified textures alias
  int max_fragments_per_chunk =
      4096;  ///< ≥ 16; memory of a chunk's fragment buffer [A §1: size unpublished, assumed]
  float merge_depth = 1e-4f;       ///< tolerance of the merge rule, relative depth; ≥ 0
  float merge_color = 1.0f / 512;  ///< tolerance of the merge rule, linear colour; ≥ 0
};

/// Counted while drawing; sums of chunks equal the layer's totals.
struct RenderCounters {
  std::int64_t polygons_in = 0;      ///< triangles of the layer
  std::int64_t polygons_drawn = 0;   ///< after clipping and culling
  std::int64_t polygon_chunks = 0;   ///< triangle–chunk pairs
  std::int64_t chunks_rendered = 0;  ///< chunks in which something was drawn
  std::int64_t chunks_clear = 0;     ///< chunks in which nothing was drawn
  std::int64_t pixels_filled = 0;    ///< pixel writes, depth test passed or fragment stored
  std::int64_t pixels_shaded = 0;
  std::int64_t fragments = 0;  ///< stored
  std::int64_t fragments_merged = 0;
  std::int64_t chunk_subdivisions = 0;
  std::int64_t texture_samples = 0;
  RenderCounters& operator+=(const RenderCounters& o);
  bool operator==(const RenderCounters&) const = default;
};

/// What rendering needs of a scene beyond the scene itself (texture pyramids); made once, only for the
/// textures that parts use. Keeps a reference to `scene`.
class PreparedScene {
 public:
  explicit PreparedScene(const layers::Scene& scene);
  ~PreparedScene();
  PreparedScene(PreparedScene&&) noexcept;
  PreparedScene& operator=(PreparedScene&&) noexcept;
  const layers::Scene& scene() const;
  std::int64_t texture_bytes() const;
  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

struct RenderResult {
  Sprite sprite;
  RenderCounters counters;
};

/// Draws `parts` (indices into Scene::parts) as seen at `frame` by a display of `display_px`, through
/// `placement`: sprite = placement.screen_from_sprite⁻¹ · screen.  Cost: O(vertices) + O(triangle–chunk
/// pairs) + O(covered pixels).
RenderResult render(const PreparedScene& prepared, const layers::SceneFrame& frame,
                    std::span<const int> parts, layers::ivec2 display_px,
                    const layers::SpritePlacement& placement, const RenderOptions& options = {});

}  // namespace talisman::chunker
