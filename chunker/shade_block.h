// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A block of points on its way through shade_batch(): what each step leaves to the next, and the steps that
/// work in lanes (shade_lanes.cpp).

#include <array>
#include <cstdint>

#include "chunker/interpolator.h"
#include "chunker/shade.h"

namespace talisman::chunker {

/// Points go through all steps in blocks whose intermediate results stay in the first-level cache.
inline constexpr int kBlock = 64;  // a multiple of every lane count
using BlockRow = std::array<float, kBlock>;
using BlockIndices = std::array<std::int32_t, kBlock>;

/// The four texels of bilinear() at each point, in one level of the pyramid, and the shares of the second of
/// each pair.
struct BlockTaps {
  alignas(64) std::array<BlockIndices, 4> texel;
  alignas(64) BlockRow x_share, y_share;
};

struct ShadeBlock {
  const float* dx = nullptr;
  const float* dy = nullptr;
  int count = 0;
  alignas(64) BlockRow one, two;     ///< λ₁, λ₂
  alignas(64) BlockIndices level;    ///< the finer one
  alignas(64) BlockRow level_share;  ///< of the coarser one; 0: it is not needed
  BlockTaps fine, coarse;
  alignas(64) std::array<BlockRow, 3> diffuse, specular;  ///< Phong only
  /// Where shadows are looked up: what the maps say, and s (share_left).
  alignas(64) std::array<BlockRow, layers::kMaxShadowLights> visibility;
  alignas(64) BlockRow shadow;
  alignas(64) std::array<BlockRow, 3> normal;  ///< under a normal map: of unit length
};

/// Where the texels of a block come from: there is no texture; its mean; four taps; twice four taps; point by
/// point.
enum class Texels { None, Constant, Bilinear, Trilinear, Looked };

/// λ at every point of the block, and where `texels` says so the taps of its texels.
void interpolate_block(const Shader& shader, const Interpolator& t, Texels texels, ShadeBlock& block);

/// light() at every point of the block (Phong). Where shadows are looked up, ShadeBlock::visibility is given;
/// under a normal map ShadeBlock::normal.
void light_block(const Shader& shader, const Interpolator& t, ShadeBlock& block);

}  // namespace talisman::chunker
