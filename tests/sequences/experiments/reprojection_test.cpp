// SPDX-License-Identifier: Apache-2.0
// Whole frames seen by another camera: what turns is exact, what moves is where a projection has it, and what was hidden is a
// hole until it is filled.
#include "sequences/experiments/latency/reprojection.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include "layers/state.h"

namespace talisman::sequences {
namespace {

using layers::CameraState;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;
using layers::ivec2;

constexpr ivec2 kSize{64, 48};

CameraState camera_at(const dvec3& place, double yaw = 0) {
  CameraState camera;
  camera.fov_y_rad = 1;
  camera.near_m = 0.1;
  camera.world_from_camera = glm::mat4_cast(glm::angleAxis(yaw, dvec3{0, 1, 0}));
  camera.world_from_camera[3] = dvec4(place, 1);
  return camera;
}

dvec2 seen(const CameraState& camera, const dvec3& point, double* inverse_depth = nullptr) {
  const dvec4 clip = layers::clip_from_world(camera, kSize) * dvec4(point, 1);
  if (inverse_depth != nullptr) *inverse_depth = 1 / clip.w;
  return layers::screen_from_clip(clip, kSize);
}

/// A wall at z = −10, and before its left half another at z = −2; the colour of a pixel is its column.
DepthPicture two_walls() {
  DepthPicture picture;
  picture.color.width = kSize.x, picture.color.height = kSize.y;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      picture.color.pixels.push_back({static_cast<std::uint16_t>(1000 * x), 0, 0, 65025});
      picture.inverse_depth.push_back(x < kSize.x / 2 ? 0.5f : 0.1f);
      picture.part.push_back(x < kSize.x / 2 ? 0 : 1);
    }
  return picture;
}

int holes(const SourceMap& map) {
  int count = 0;
  for (std::size_t k = 0; k < map.source.size(); ++k) count += map.is_hole(k);
  return count;
}

TEST(Reprojection, PixelMapIsWhereProjectionsHavePoints) {
  const CameraState from = camera_at({0.3, -0.2, 1}, 0.2), to = camera_at({-0.1, 0.4, 0.5}, -0.1);
  const PixelMap map = pixel_map(from, to, kSize);
  for (const dvec3& point : {dvec3{0.5, 0.2, -6}, dvec3{-1, -1, -3}, dvec3{2, 1, -40}}) {
    double inverse = 0, inverse_there = 0;
    const dvec2 p = seen(from, point, &inverse), there = seen(to, point, &inverse_there);
    const dvec3 q = map(p, inverse);
    EXPECT_LT(glm::distance(dvec2(q) / q.z, there), 1e-9);
    EXPECT_NEAR(inverse / q.z, inverse_there, 1e-12);
    const DepthPicture none{};
    EXPECT_LT(glm::distance(point_shown(Reprojection::Depth, &none, {1000, 1000}, map, p, inverse), there),
              1e-9);
  }
}

/// One homography is exact where the camera only turns: geometry to 1e-6 px, and a hole is what lies past the edge.
TEST(Reprojection, OfACameraThatTurnsIsExact) {
  const CameraState from = camera_at({0, 0, 0}), to = camera_at({0, 0, 0}, 0.1);
  const PixelMap map = pixel_map(from, to, kSize);
  const dvec3 point{0.2, 0.3, -5};
  const dvec2 there = seen(to, point);
  EXPECT_LT(
      glm::distance(point_shown(Reprojection::Turned, nullptr, kSize, map, seen(from, point), 0.2), there),
      1e-6);
  const SourceMap turned = source_map(Reprojection::Turned, two_walls(), from, to);
  int past_edge = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const dvec3 q = pixel_map(to, from, kSize)({x + 0.5, y + 0.5}, 0);
      const dvec2 p = dvec2(q) / q.z;
      const bool is_in = p.x >= 0 && p.y >= 0 && p.x <= kSize.x && p.y <= kSize.y;
      past_edge += !is_in;
      const std::size_t at = static_cast<std::size_t>(y) * kSize.x + x;
      ASSERT_EQ(!turned.is_hole(at), is_in);
      if (is_in) {
        EXPECT_LT(glm::distance(turned.source[at], p), 1e-6);
      }
    }
  EXPECT_GT(past_edge, 0);
  EXPECT_EQ(holes(turned), past_edge);
}

TEST(Reprojection, OfTheSameCameraIsThePictureItself) {
  const CameraState camera = camera_at({0.1, 0.2, 0.3}, 0.4);
  const DepthPicture picture = two_walls();
  for (const Reprojection reprojection : kAllReprojections) {
    const SourceMap map = source_map(reprojection, picture, camera, camera);
    EXPECT_EQ(holes(map), 0) << name(reprojection);
    EXPECT_EQ(reprojected(picture.color, map, {0, 0, 0}).pixels, picture.color.pixels) << name(reprojection);
  }
}

/// To the right by 0.2 m: f = 48 / (2 tan 0.5) = 43.9 px. The near wall moves left by 0.2 · f / 2 = 4.39 px, the far one by
/// 0.88 px: 3 or 4 columns of what was hidden, and what comes in at the right edge.
TEST(Reprojection, LeavesHolesWhereNothingWasSeen) {
  const CameraState from = camera_at({0, 0, 0}), to = camera_at({0.2, 0, 0});
  const DepthPicture picture = two_walls();
  const double f = kSize.y / (2 * std::tan(0.5));
  const SourceMap open = source_map(Reprojection::Depth, picture, from, to);
  for (int y = 0; y < kSize.y; ++y) {
    int inner = 0, at_edge = 0;
    for (int x = 0; x < kSize.x; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * kSize.x + x;
      if (open.is_hole(at)) {
        (x > kSize.x - 3 ? at_edge : inner) += 1;
        continue;
      }
      const bool is_near = open.source[at].x < kSize.x / 2;
      EXPECT_NEAR(open.source[at].x - (x + 0.5), 0.2 * f * (is_near ? 0.5 : 0.1), 1e-6);
    }
    EXPECT_GE(inner, 3);
    EXPECT_LE(inner, 4);
    EXPECT_LE(at_edge, 1);
  }
  // Filled from the far wall; the mesh has no hole within, but stretches.
  const SourceMap filled = source_map(Reprojection::Filled, picture, from, to);
  EXPECT_EQ(holes(filled), 0);
  for (std::size_t k = 0; k < filled.source.size(); ++k)
    if (open.is_hole(k)) {
      EXPECT_GE(filled.source[k].x, kSize.x / 2);
    }
  EXPECT_LE(holes(source_map(Reprojection::Grid, picture, from, to)), 2 * kSize.y);
}

TEST(Reprojection, HolesShowTheBackground) {
  const CameraState from = camera_at({0, 0, 0}), to = camera_at({0, 0, 0}, M_PI);
  for (const Reprojection reprojection : {Reprojection::Turned, Reprojection::Depth, Reprojection::Grid}) {
    const SourceMap map = source_map(reprojection, two_walls(), from, to);
    EXPECT_EQ(holes(map), kSize.x * kSize.y) << name(reprojection);
    for (const chunker::Linear16& pixel : reprojected(two_walls().color, map, {0, 1, 0}).pixels) {
      ASSERT_EQ(pixel.r, 0);
      ASSERT_EQ(pixel.g, 65025);
    }
  }
  EXPECT_EQ(source_map(Reprojection::Filled, two_walls(), from, to).source.size(), 64u * 48u)
      << "nothing to fill it with";
}

}  // namespace
}  // namespace talisman::sequences
