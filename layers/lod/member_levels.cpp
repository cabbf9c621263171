// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/member_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/lod/levels.h"

namespace talisman::layers {
namespace {

/// Around the rectangle of a sprite, px: for what a filter reaches and for rounding.
constexpr double kRim_px = 2;

/// What a sprite shows of the world, from its camera.
class SpriteWindow {
 public:
  SpriteWindow(const LayerState& now, const SpritePlacement& placement)
      : camera_from_world_(glm::inverse(now.camera.world_from_camera)),
        focal_px_(now.view.display_px.y / (2 * std::tan(now.camera.fov_y_rad / 2))),
        middle_px_(dvec2(now.view.display_px) / 2.0) {
    const double up = middle_px_.y / focal_px_, across = middle_px_.x / focal_px_;
    most_tangent_ = std::sqrt(up * up + across * across);
    const double rim = kRim_px + glm::length(now.motion_px);
    const dvec2 size(placement.size_px);
    for (const dvec2& corner : {dvec2(0), dvec2(size.x, 0), dvec2(0, size.y), size}) {
      const dvec2 at = placement.screen_from_sprite(corner);
      lo_ = glm::min(lo_, at - rim), hi_ = glm::max(hi_, at + rim);
    }
  }

  struct Seen {
    bool outside = true;
    double nearest_m = HUGE_VAL;
    double diagonal_m = 0;
  };

  Seen look_at(const Box3& box, const dmat4& world_from_mesh) const {
    Seen seen;
    const dmat4 to_camera = camera_from_world_ * world_from_mesh;
    std::array<int, 5> beyond{};
    std::array<dvec3, 8> corners;
    for (int k = 0; k < 8; ++k) {
      const dvec4 corner(k & 1 ? box.hi[0] : box.lo[0], k & 2 ? box.hi[1] : box.lo[1],
                         k & 4 ? box.hi[2] : box.lo[2], 1);
      const dvec3 p = corners[static_cast<std::size_t>(k)] = dvec3(to_camera * corner);
      const double w = -p.z, x = focal_px_ * p.x + middle_px_.x * w, y = -focal_px_ * p.y + middle_px_.y * w;
      const std::array<bool, 5> is_beyond = {(x < lo_.x * w), (x > hi_.x * w), (y < lo_.y * w),
                                             (y > hi_.y * w), w < 0};
      for (std::size_t side = 0; side < beyond.size(); ++side) beyond[side] += is_beyond[side];
      seen.nearest_m = std::min(seen.nearest_m, w);
    }
    seen.outside = std::find(beyond.begin(), beyond.end(), 8) != beyond.end();
    for (std::size_t k = 0; k < 4; ++k)
      seen.diagonal_m = std::max(seen.diagonal_m, glm::distance(corners[k], corners[7 - k]));
    return seen;
  }

  double px(double error_m, double nearest_m) const {
    return error_m > 0 ? level_error_px(error_m, nearest_m, focal_px_, most_tangent_) : 0;
  }

 private:
  dmat4 camera_from_world_;
  double focal_px_;
  dvec2 middle_px_;
  double most_tangent_ = 0;
  dvec2 lo_{HUGE_VAL}, hi_{-HUGE_VAL};
};

struct Asked {
  std::optional<int> level;  ///< of all; else a rung
  int rung = 0;
};

/// The level of one part; -1: none, it is not drawn.
struct PartChoice {
  int level = 0;
  double error_px = 0;
};

PartChoice chosen(const std::vector<LadderLevel>& ladder, const SpriteWindow& window,
                  const SpriteWindow::Seen& seen, double stretch, const Asked& asked) {
  const int coarsest = static_cast<int>(ladder.size()) - 1;
  const auto error_px = [&](int level) {
    return window.px(ladder[static_cast<std::size_t>(level)].error_m * stretch, seen.nearest_m);
  };
  if (asked.level) {
    const int level = std::min(*asked.level, coarsest);
    return {level, error_px(level)};
  }
  const bool is_last = asked.rung >= kRungs - 1;
  const double allowed_px = is_last ? kLeftOut_px : kRungs_px[static_cast<std::size_t>(asked.rung)];
  const double whole_px = window.px(seen.diagonal_m, seen.nearest_m);
  const auto triangles = static_cast<double>(ladder[static_cast<std::size_t>(coarsest)].triangles);
  const double left_out_px = allowed_px * (is_last ? 1 : std::min(1.0, std::sqrt(triangles / kDearPart)));
  if (whole_px > 0 && whole_px <= left_out_px) return {-1, whole_px};
  if (is_last) return {coarsest, error_px(coarsest)};
  int level = coarsest;
  while (level > 0 && error_px(level) > allowed_px) --level;
  return {level, error_px(level)};
}

MemberLevels members(const Scene& scene, const Layer& layer, const LayerState& now,
                     const SpritePlacement& placement, const Asked& asked) {
  MemberLevels result{{}, layer.polygons, 0};
  const SpriteWindow window(now, placement);
  const LevelSet& levels = *scene.levels;
  for (std::size_t i = 0; i < layer.parts.size(); ++i) {
    const auto own = static_cast<std::size_t>(layer.parts[i]);
    const Part& part = scene.parts[own];
    const auto mesh = static_cast<std::size_t>(part.mesh);
    const bool is_plain = !part.is_seam && part.mesh >= 0 && part.skin < 0 &&
                          i < now.world_from_part.size() && levels.boxes[mesh].morphs.empty() &&
                          !levels.boxes[mesh].rest.empty() && levels.boxes[mesh].rest != kEverywhere;
    if (part.is_seam || part.mesh < 0 || levels.ladders[mesh].levels.empty()) {
      result.parts.push_back(layer.parts[i]);
      continue;
    }
    const std::vector<LadderLevel>& ladder = levels.ladders[mesh].levels;
    SpriteWindow::Seen seen{false, now.nearest_w_m, HUGE_VAL};
    if (is_plain) seen = window.look_at(levels.boxes[mesh].rest, now.world_from_part[i]);
    PartChoice choice{-1, 0};
    if (!seen.outside)
      choice = chosen(ladder, window, seen, stretch_of(part, i, layer, now.world_from_part), asked);
    result.polygons -= ladder[0].triangles;
    result.error_px = std::max(result.error_px, choice.error_px);
    if (choice.level < 0) continue;
    const auto level = static_cast<std::size_t>(choice.level);
    result.polygons += ladder[level].triangles;
    result.parts.push_back(levels.parts[own][level]);
  }
  if (!result.parts.empty() || layer.parts.empty()) return result;
  // A picture of nothing is still one of the layer.
  const auto first = static_cast<std::size_t>(layer.parts[0]);
  const auto& ladder = levels.ladders[static_cast<std::size_t>(scene.parts[first].mesh)].levels;
  result.parts.push_back(levels.parts[first].back());
  result.polygons += ladder.back().triangles;
  return result;
}

}  // namespace

bool has_member_levels(const Scene& scene, const Layer& layer) {
  return scene.levels && may_have_levels(layer) && layer.parts.size() > 1;
}

MemberLevels members_at_rung(const Scene& scene, const Layer& layer, const LayerState& now,
                             const SpritePlacement& placement, int rung) {
  return members(scene, layer, now, placement, {std::nullopt, std::clamp(rung, 0, kRungs - 1)});
}

MemberLevels members_at_level(const Scene& scene, const Layer& layer, const LayerState& now,
                              const SpritePlacement& placement, int level) {
  return members(scene, layer, now, placement, {level, 0});
}

}  // namespace talisman::layers
