// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One chunk: triangles in, texels out.

#include <span>

#include "chunker/coverage.h"
#include "chunker/draw_list.h"
#include "chunker/fragment.h"
#include "chunker/multipass.h"
#include "chunker/plan_buffer.h"
#include "chunker/shade_batch.h"
#include "chunker/sprite.h"

namespace talisman::chunker {

/// Working memory of one thread, about 300 kB, used for one chunk after the other.
/// `kCount`: samples per texel, 1, 4 or 16.
template <int kCount>
class ChunkRenderer {
 public:
  /// With `linear`, which is as large as the sprite, texels are left there and not encoded.
  ChunkRenderer(const DrawList& list, const RenderOptions& options, LinearImage* linear = nullptr)
      : list_(list), options_(options), linear_(linear) {}

  /// Draws `triangles` (ascending indices into the list) into the chunk whose first texel is `origin`. When
  /// the fragments do not fit the chunk is drawn again in quarters, each again in quarters, down to single
  /// texels, for which there is no limit. A texel does not depend on its neighbours, so the bytes are the
  /// same.
  /// With `depth`, which is clear, each texel that something covers gets the depth of the nearest surface, and
  /// the place of its part in the list.
  Chunk draw(std::span<const std::uint32_t> triangles, layers::ivec2 origin, DepthChunk* depth = nullptr);

  const RenderCounters& counters() const { return counters_; }

 private:
  void draw_box(std::span<const std::uint32_t> triangles, const LatticeBox& box, Chunk& out);
  void finish_row(std::span<Float4> row, int x0, int y, Chunk& out) const;
  void note_depth(const LatticeBox& box);
  void count_shading(const Shader& shader);
  void draw_quarters(std::span<const std::uint32_t> triangles, const LatticeBox& box, Chunk& out);
  bool draw_triangles(std::span<const std::uint32_t> triangles, const LatticeBox& box);
  bool draw_triangle(std::uint32_t order, const LatticeBox& box);
  void gather_visible(const Triangle& t, const Gradients& gradients, const LatticeBox& box);
  /// `kOpaque`: every colour of the batch has alpha 1, and nothing of it can be seen through.
  template <bool kOpaque>
  bool store_fragments(std::uint32_t order);
  template <bool kOpaque>
  bool add(int texel, const Fragment& fragment);

  const DrawList& list_;
  const RenderOptions& options_;
  LinearImage* linear_ = nullptr;
  DepthChunk* noted_ = nullptr;  ///< the depths of the chunk that is drawn
  layers::ivec2 origin_{0, 0};
  FragmentBuffer<kCount> buffer_;
  Coverage coverage_;
  ShadeBatch batch_;  ///< the visible texels of one triangle, and beside it
  std::array<std::uint16_t, ShadeBatch::kPoints> texel_;  ///< which they are,
  std::array<std::uint16_t, ShadeBatch::kPoints> mask_;   ///< their coverage,
  std::array<float, ShadeBatch::kPoints> depth_;          ///< and their depth at the centre,
  float depth_dx_ = 0, depth_dy_ = 0;                     ///< which changes like this
  RenderCounters counters_;
};

}  // namespace talisman::chunker
