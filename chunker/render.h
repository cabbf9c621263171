// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The chunk renderer: a layer's parts, at one instant, into one sprite [LS97 1.1, 3; A §1].
///
/// Vertices are transformed once, triangles are clipped (near plane, guard band) and binned to 32×32 chunks,
/// and the chunks are independent jobs. Inside a chunk: coverage by fixed-point edge functions with a
/// top-left rule on a 4×4 sub-pixel grid (a shared edge is covered exactly once); opaque full cover goes
/// straight to the pixel; partial cover and translucency become fragments with mask, premultiplied colour and
/// a depth plane; resolve composites front to back in each of the sub-pixels. A fragment merges with the
/// last one stored for its pixel when depth and colour are within tolerance; when fragment memory overflows
/// the chunk is subdivided and its pieces are rendered independently, with the same result.
///
/// Conventions: depth is 1/w, so there is no far plane, and at equal depth the triangle that comes first in
/// the order of `parts` and of indices is seen. Nodes of negative scale and mirroring placements keep fronts
/// fronts. Triangles with a vertex that is not finite are skipped. Shading is that of chunker/shade.h:
/// Lambert and Blinn-Phong, lights without falloff, attributes at the centroid of the covered samples, one
/// colour per fragment.
///
/// The result is the same, byte for byte, for any number of threads, any SIMD width and any order of chunks.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "chunker/clip.h"
#include "chunker/sprite.h"
#include "layers/layer.h"
#include "layers/scene.h"
#include "layers/sprite_transform.h"

namespace talisman::chunker {

enum class Shading { Flat, Gouraud, Phong };

/// How a texture is looked up: the nearest texel of level 0, four of them, or four in each of two levels of
/// the pyramid. Cheaper ones alias where the texture is minified.
enum class TextureFilter { Nearest, Bilinear, Trilinear };

struct RenderOptions {
  /// Flat shades triangles, Gouraud vertices, Phong every covered pixel: the cost of lights goes with their
  /// number.
  Shading shading = Shading::Phong;
  bool mipmaps = true;  ///< trilinear; without them minified textures alias, and cost half as much
  TextureFilter filter = TextureFilter::Trilinear;  ///< without mipmaps at most Bilinear
  /// Most trilinear samples along the line of anisotropy, 1 … 16; 1: isotropic. More keeps slanted textures
  /// sharp; every sample costs as much as the one before. Takes part only where `filter` is Trilinear.
  int max_anisotropy = 1;
  /// Samples of coverage and depth per texel: 1, 4 or 16 (chunker/samples.h). Edges and crossing surfaces
  /// have that many steps; more cost more masks, fragments and comparisons where there are edges, and nothing
  /// inside of surfaces. With 1 opaque surfaces need no fragments at all.
  int samples = 16;
  /// ≥ 16; a chunk that needs more is drawn again in quarters. More memory (48 bytes each), fewer
  /// repetitions; the bytes do not change [A §1: size unpublished, assumed].
  int max_fragments_per_chunk = 4096;
  /// Tolerances of the merge rule: relative depth anywhere in the pixel, linear colour per channel; ≥ 0.
  /// Larger ones save fragments and cost accuracy, with these defaults at most one code value. Both 0:
  /// nothing merges, and the sprite equals chunker::reference::render byte for byte.
  float merge_depth = 1e-4f;
  float merge_color = 1.0f / 512;
};

/// Counted while drawing, independent of threads and order. All work counts, also that of a chunk that is
/// given up because its fragments overflow and drawn again in quarters.
struct RenderCounters {
  std::int64_t polygons_in = 0;  ///< triangles of the layer
  std::int64_t polygons_drawn =
      0;  ///< after clipping and culling, with at least one sample in their bounding box
  std::int64_t polygon_chunks = 0;      ///< triangle–chunk pairs; quarters are not counted again
  std::int64_t chunks_rendered = 0;     ///< chunks in which something was drawn
  std::int64_t chunks_clear = 0;        ///< chunks in which nothing was drawn
  std::int64_t pixels_filled = 0;       ///< pixel writes: straight to the pixel, stored or merged
  std::int64_t pixels_shaded = 0;       ///< colours computed, for whole pixels and for parts of them
  std::int64_t fragments = 0;           ///< stored
  std::int64_t fragments_merged = 0;    ///< into one that was stored before
  std::int64_t chunk_subdivisions = 0;  ///< chunks, or quarters, that were cut into four
  std::int64_t texture_samples = 0;     ///< filtered look-ups, trilinear or bilinear
  std::int64_t shadow_lookups = 0;      ///< filtered look-ups in shadow maps
  std::int64_t reflection_lookups = 0;  ///< bilinear look-ups in a reflection
  RenderCounters& operator+=(const RenderCounters& o);
  bool operator==(const RenderCounters&) const = default;
};

/// What rendering needs of a scene beyond the scene itself (texture pyramids); made once, only for the
/// textures that parts use, and only the levels that `options` look up. Keeps a reference to `scene`.
class PreparedScene {
 public:
  explicit PreparedScene(const layers::Scene& scene, const RenderOptions& options = {});
  ~PreparedScene();
  PreparedScene(PreparedScene&&) noexcept;
  PreparedScene& operator=(PreparedScene&&) noexcept;
  const layers::Scene& scene() const;
  std::int64_t texture_bytes() const;
  struct Impl;
  const Impl& impl() const { return *impl_; }
  std::shared_ptr<const Impl> shared_impl() const { return impl_; }  ///< what is drawn late keeps it

 private:
  std::shared_ptr<Impl> impl_;
};

class ShadowMap;  // chunker/shadow_map.h

/// Which part of the shading expression a sprite holds [LS97 2.3, appendix]; chunker/shade.h has the
/// formulas. In every term the same surfaces are seen in the same samples, so the terms line up texel by
/// texel.
enum class ShadeTerm {
  Full,        ///< all at once: B · Π s + Σ specular · v + reflectivity · reflection; alpha = coverage
  Base,        ///< B: ambient, diffuse (of both textures) and emission; alpha = coverage
  Shadow,      ///< black, alpha (1 - Π s) β
  Specular,    ///< highlights alone, alpha 0: `over` adds them
  Reflection,  ///< reflectivity · reflection, alpha 0
  /// The base split by textures: (N·L) T₁, with emission and coverage, and (N·L) T₂ with alpha 0. Both leave
  /// out Material::texture_blend, which the compositor applies as colour multipliers, without drawing again.
  Texture1,
  Texture2,
};

/// Which lights a picture holds.
enum class LightsHeld {
  All,       ///< each seen through its map
  Unmapped,  ///< ambient light, and those that cast no shadow
  One,  ///< ShadeInputs::light alone, through its map; no ambient light, no emission, and alpha 0: `over`
        ///< adds it. In Full, Base, Texture1 and Texture2
};

/// What one mirror shows: the scene as its mirrored camera sees it (chunker/mirror.h).
struct Reflection {
  const Sprite* picture = nullptr;      ///< null: nothing
  layers::Affine2 picture_from_screen;  ///< where it lies; the default: texel on pixel of the display
  std::span<const int> parts;           ///< that show it, ascending; empty: all
};

/// Factors of the two textures of some parts, in place of Material::texture_blend.
struct TextureBlend {
  layers::vec2 factors{1, 0};  ///< 0 … 1
  std::span<const int> parts;  ///< ascending; empty: all
};

/// What one call draws, and what it looks up. What a term does not need is not looked at.
struct ShadeInputs {
  ShadeTerm term = ShadeTerm::Full;
  /// By index of Scene::lights. Shorter, or null: that light casts no shadow. Used by Full, Shadow, Specular.
  std::span<const ShadowMap* const> shadow_maps;
  /// Index of the one light whose shadow or highlight is drawn; -1: of all. Used by Shadow, Specular and
  /// LightsHeld::One.
  int light = -1;
  LightsHeld lights = LightsHeld::All;
  /// A part looks up the first that names it. Used by Full and Reflection.
  std::span<const Reflection> reflections;
  /// Likewise. Used by Full and Base.
  std::span<const TextureBlend> texture_blends;
  /// The half-space of the world that is drawn; the rest is cut off, in the middle of triangles. Empty:
  /// everything, at no cost.
  std::optional<HalfSpace> kept;
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
                    const layers::SpritePlacement& placement, const RenderOptions& options = {},
                    const ShadeInputs& inputs = {});

/// Some chunks of a sprite.
struct RenderedChunks {
  std::vector<int> places;    ///< row · columns + column, ascending
  std::vector<Chunk> chunks;  ///< as many; clear ones too
  RenderCounters counters;    ///< chunks, fragments and pixels of these alone
};

/// The chunks at `places` (ascending) of what render() draws, the same bytes. Cost: O(vertices) + O(triangle–chunk
/// pairs) + O(covered pixels of these chunks).
RenderedChunks render_chunks(const PreparedScene& prepared, const layers::SceneFrame& frame,
                             std::span<const int> parts, layers::ivec2 display_px,
                             const layers::SpritePlacement& placement, std::span<const int> places,
                             const RenderOptions& options = {}, const ShadeInputs& inputs = {});

}  // namespace talisman::chunker
