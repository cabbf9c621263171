// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which chunks of an old sprite are too far off, if each is judged by what it shows? Pure, from geometry alone.
///
/// A sprite is a grid of 32×32 chunks, laid out when all of it was drawn, at its first instant 0. Chunk c holds the
/// picture of instant s(c), drawn into that same grid: with A = screen_from_sprite and W_s the warp that carried the
/// sprite in the frame of s, the map of its texels is W_s A, so that it is in its place where W_s A shows it. A point x
/// of the layer, at p_s(x) on the display at s and p(x) now, is then shown by chunk c at
///
///   W W_s⁻¹ p_s(x),        W the warp of this frame        e_s(x) = |W W_s⁻¹ p_s(x) - p(x)|
///
/// Content is known as boxes around groups of triangles, in the space of their part (layers/mesh_clusters.h). Both
/// W W_s⁻¹ p_s and p are projections of the box, so that the bound of regulator/projected_motion.h holds for all that is
/// in it, perspective included: E_s(box) ≥ e_s(x). A chunk that is shown is *over* when, for a box,
///
///   E_s(box) > δ   and   the box reaches into the chunk, then (W_s A) or now (W A), one texel around it included
///
/// "Then" finds what the chunk shows in the wrong place; "now" what it lacks, also where it is clear. What is neither
/// shown nor belongs on the display now is no error. All chunks over are drawn as of now, by W A: exact, as long as W A
/// does not mirror. So every chunk shown is off by δ at most. Two neighbours of instants s and t show a box in places
///
///   |W W_s⁻¹ p_s(x) - W W_t⁻¹ p_t(x)| ≤ E_s + E_t ≤ 2 δ        (δ where one of them is fresh)
///
/// apart: the step at their border, which is bounded in the same way, by the hull of the two pictures of the box.
///
/// Boxes are cut into places on the display (regulator/content_leaves.h); what of them reaches through the near plane has
/// no bound, and its chunks are over. W is the warp of the most chunks that move alike (regulator/chunk_warp.h).
///
/// Where chunks say nothing the whole sprite is drawn; `why_whole` names the case.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x3.hpp>

#include "layers/sprite_transform.h"
#include "regulator/refresh_options.h"
#include "warp/fit.h"

namespace talisman::regulator {

/// Some triangles of a part, in its space.
struct ContentBox {
  int part = 0;  ///< index into Layer::parts
  layers::dvec3 lo{0, 0, 0}, hi{0, 0, 0};
  int triangles = 0;
};

/// All that a layer draws.
struct LayerContent {
  std::vector<ContentBox> boxes;
  std::int64_t vertices = 0, triangles = 0;
  bool deforms = false;  ///< then boxes do not bound it
};

/// Places on the display, homogeneous: (x w, y w, w) px.
using PlaceMap = glm::dmat4x3;

/// How the parts of a layer are seen at one instant.
struct ContentView {
  std::vector<PlaceMap> screen_from_part;
  double near_m = 0;  ///< what has no more depth is not seen
};
ContentView content_view(const layers::LayerState& state);

/// As the renderer's [LS97 1.1], texels on each side.
inline constexpr int kRefreshChunk = 32;
/// Columns and rows of chunks [x0, x1) × [y0, y1).
using ChunkRect = layers::RectI;

/// An instant as of which chunks of a sprite were drawn.
struct ChunkInstant {
  int frame = 0;
  layers::Affine2 carried;             ///< W_s
  std::vector<layers::dvec3> corners;  ///< W_s⁻¹ p_s of the eight corners of each box, homogeneous
  std::vector<ChunkRect> reach;        ///< of each box: the chunks that it reaches into
};
ChunkInstant chunk_instant(const LayerContent& content, const ContentView& seen,
                           const layers::SpritePlacement& placement, const layers::Affine2& carried,
                           int frame);

/// The instants of a sprite's chunks.
struct SpriteChunks {
  layers::ivec2 count{0, 0};                                  ///< columns, rows
  std::vector<std::uint8_t> of_chunk;                         ///< index of its instant, row by row
  std::vector<std::shared_ptr<const ChunkInstant>> instants;  ///< the first one is that of the whole
  std::vector<char> drawn;                                    ///< of each instant: are its pixels there?
  bool mixed() const { return instants.size() > 1; }
};
SpriteChunks whole_sprite(const layers::SpritePlacement& placement, ChunkInstant first);
/// With the chunks at `places` as of another instant. Instants that no chunk has are forgotten, but the first.
void set_chunks(std::span<const int> places, ChunkInstant instant, SpriteChunks& chunks);

/// As many instants at most; more cost time in every frame.
inline constexpr std::size_t kMostChunkInstants = 48;
/// Share of the stored chunks beyond which all of the sprite is drawn.
inline constexpr double kMostChunksOver = 0.6;

struct ChunkLimits {
  double geometric_px = 4;  ///< δ > 0
  warp::Curve curve = warp::Curve::aff;
  warp::FitOptions fit;
};

struct ChunkJudgement {
  std::string_view why_whole;  ///< empty: chunks can be drawn alone
  warp::FitResult fitted;      ///< W; valid, as all else, where that is so
  std::vector<int> over;       ///< row · columns + column, ascending
  double worst_px = 0;         ///< of all chunks shown, as they are
  double left_px = 0;          ///< of those that are not over
  layers::dvec2 where_px{0, 0};
  ChunkShare share;           ///< with the chunks over drawn
  std::int64_t polygons = 0;  ///< in boxes that reach into a chunk that is over, now
  std::int64_t pixels = 0;    ///< texels of these chunks
};

/// Cost: O(boxes · instants).
ChunkJudgement judge_chunks(const LayerContent& content, const SpriteChunks& chunks, const ContentView& now,
                            const layers::SpritePlacement& placement, layers::ivec2 display_px,
                            const ChunkLimits& limits);

}  // namespace talisman::regulator
