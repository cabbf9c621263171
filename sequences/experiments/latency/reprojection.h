// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where does each pixel of a frame come from, if all there is is a whole picture of another camera, with its depth?
///
/// Camera D drew, camera W shows. A pixel p of D with the depth d along its axis is seen by W at
///
///   q = A (p, 1) + b / d,   p' = (q.x, q.y) / q.z,   1/d' = (1/d) / q.z       A = K_W R_W⁻¹ R_D K_D⁻¹,  b = K_W R_W⁻¹ (c_D − c_W)
///
/// K takes a ray of a camera's space to pixels (pipeline/latency/last_warp.h), c is its place. The sky has 1/d = 0.
///
///   turned   b is left out: one homography for the whole picture; a pixel is a hole where it looks past the edge of D's
///   depth    each pixel of D is laid over the pixels of W that it covers, a square 1/q.z wide (at least one pixel), the
///            nearest wins; what none covers is a hole. The place in D is then found from the depth that won, so that colours
///            are filtered as those of a warped sprite are, and not shifted to whole pixels
///   filled   the same; each hole takes what its row shows beside it, of the two sides the farther (a stretch); a row without
///            any that of the nearest row
///   grid     a mesh of squares of `kGridCell_px` whose corners have the depth of their pixel, drawn as triangles with a depth
///            test: no holes but at the edge, where it is torn it is stretched
///
/// Pure; pictures are colour over the background.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "chunker/composite.h"
#include "chunker/plan_buffer.h"
#include "layers/scene.h"

namespace talisman::sequences {

enum class Reprojection { Turned, Depth, Filled, Grid };
inline constexpr std::array kAllReprojections = {Reprojection::Turned, Reprojection::Depth,
                                                 Reprojection::Filled, Reprojection::Grid};
std::string_view name(Reprojection reprojection);

inline constexpr int kGridCell_px = 16;

/// A whole frame with depth.
struct DepthPicture {
  chunker::Frame color;
  std::vector<float> inverse_depth;  ///< 1/m by pixel, row by row; 0: the sky
  std::vector<std::int32_t> part;    ///< numbers of parts; -1: the sky
};
DepthPicture depth_picture(const chunker::PlanBuffer& buffer, layers::vec3 background);

/// From D to W.
struct PixelMap {
  layers::dmat3 turn{1.0};
  layers::dvec3 way{0.0};  ///< b
  layers::dvec3 operator()(const layers::dvec2& pixel, double inverse_depth) const {
    return turn * layers::dvec3(pixel, 1) + way * inverse_depth;
  }
};
PixelMap pixel_map(const layers::CameraState& drawn, const layers::CameraState& shown, layers::ivec2 size_px);

/// Of each pixel of W the place in D's picture; NaN: a hole.
struct SourceMap {
  layers::ivec2 size_px{0, 0};
  std::vector<layers::dvec2> source;
  bool is_hole(std::size_t pixel) const { return !(source[pixel].x == source[pixel].x); }
};
SourceMap source_map(Reprojection reprojection, const DepthPicture& drawn, const layers::CameraState& from,
                     const layers::CameraState& to);

/// Filtered between the four nearest pixels; holes show the background.
chunker::Frame reprojected(const chunker::Frame& picture, const SourceMap& map, layers::vec3 background);

/// Where W shows the point that D has at `pixel` with its own depth; NaN: nowhere. `drawn` is looked at by Grid alone.
layers::dvec2 point_shown(Reprojection reprojection, const DepthPicture* drawn, layers::ivec2 size_px,
                          const PixelMap& map, const layers::dvec2& pixel, double inverse_depth);

}  // namespace talisman::sequences
