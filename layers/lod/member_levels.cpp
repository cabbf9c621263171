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

double focal_px(const LayerState& now) {
  return now.view.display_px.y / (2 * std::tan(now.camera.fov_y_rad / 2));
}

/// What a sprite shows of the world, from its camera.
class SpriteWindow {
 public:
  SpriteWindow(const LayerState& now, const SpritePlacement& placement)
      : camera_from_world_(glm::inverse(now.camera.world_from_camera)),
        focal_px_(focal_px(now)),
        middle_px_(dvec2(now.view.display_px) / 2.0) {
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

 private:
  dmat4 camera_from_world_;
  double focal_px_;
  dvec2 middle_px_;
  dvec2 lo_{HUGE_VAL}, hi_{-HUGE_VAL};
};

/// Is all that is drawn of the part inside its box, moved with it?
bool has_box(const Part& part, std::size_t i, const LayerState& now, const MeshBox& box) {
  return part.skin < 0 && i < now.world_from_part.size() && box.morphs.empty() && !box.rest.empty() &&
         box.rest != kEverywhere;
}

}  // namespace

bool has_member_levels(const Scene& scene, const Layer& layer) {
  return scene.levels && may_have_levels(layer) && layer.parts.size() > 1;
}

ShownMembers::ShownMembers(const Scene& scene, const Layer& layer, const LayerState& now,
                           const SpritePlacement& placement)
    : scene_(&scene),
      layer_(&layer),
      focal_px_(focal_px(now)),
      most_tangent_(glm::length(dvec2(now.view.display_px) / (2 * focal_px_))) {
  const SpriteWindow window(now, placement);
  for (std::size_t i = 0; i < layer.parts.size(); ++i) {
    const Part& part = scene.parts[static_cast<std::size_t>(layer.parts[i])];
    Member& member = members_.emplace_back();
    if (part.is_seam || part.mesh < 0 || ladder_of(i).empty()) continue;
    member.has_levels = true;
    SpriteWindow::Seen seen{false, now.nearest_w_m, HUGE_VAL};
    const MeshBox& box = scene.levels->boxes[static_cast<std::size_t>(part.mesh)];
    if (has_box(part, i, now, box)) seen = window.look_at(box.rest, now.world_from_part[i]);
    member.outside = seen.outside;
    if (seen.outside) continue;
    member.nearest_m = seen.nearest_m;
    member.diagonal_m = seen.diagonal_m;
    member.stretch = stretch_of(part, i, layer, now.world_from_part);
  }
}

double ShownMembers::error_px(double error_m, double nearest_m) const {
  return error_m > 0 ? level_error_px(error_m, nearest_m, focal_px_, most_tangent_) : 0;
}

const std::vector<LadderLevel>& ShownMembers::ladder_of(std::size_t i) const {
  const Part& part = scene_->parts[static_cast<std::size_t>(layer_->parts[i])];
  return scene_->levels->ladders[static_cast<std::size_t>(part.mesh)].levels;
}

ShownMembers::Choice ShownMembers::at_level(std::size_t i, int level) const {
  const std::vector<LadderLevel>& ladder = ladder_of(i);
  const Member& member = members_[i];
  const int drawn = std::min(level, static_cast<int>(ladder.size()) - 1);
  return {drawn,
          error_px(ladder[static_cast<std::size_t>(drawn)].error_m * member.stretch, member.nearest_m)};
}

ShownMembers::Choice ShownMembers::at_rung(std::size_t i, int rung) const {
  const Member& member = members_[i];
  const int coarsest = static_cast<int>(ladder_of(i).size()) - 1;
  const bool is_last = rung >= kRungs - 1;
  const double allowed_px = is_last ? kLeftOut_px : kRungs_px[static_cast<std::size_t>(rung)];
  const double whole_px = error_px(member.diagonal_m, member.nearest_m);
  const auto triangles = static_cast<double>(ladder_of(i).back().triangles);
  const double left_out_px = allowed_px * (is_last ? 1 : std::min(1.0, std::sqrt(triangles / kDearPart)));
  if (whole_px > 0 && whole_px <= left_out_px) return {-1, whole_px};
  Choice choice = at_level(i, coarsest);
  while (!is_last && choice.level > 0 && choice.error_px > allowed_px) choice = at_level(i, choice.level - 1);
  return choice;
}

template <typename Choose>
MemberLevels ShownMembers::chosen(const Choose& choose) const {
  MemberLevels result{{}, layer_->polygons, 0};
  const LevelSet& levels = *scene_->levels;
  const auto draw = [&](std::size_t i, std::size_t level) {
    result.polygons += ladder_of(i)[level].triangles;
    result.parts.push_back(levels.parts[static_cast<std::size_t>(layer_->parts[i])][level]);
  };
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (!members_[i].has_levels) {
      result.parts.push_back(layer_->parts[i]);
      continue;
    }
    result.polygons -= ladder_of(i)[0].triangles;
    if (members_[i].outside) continue;
    const Choice choice = choose(i);
    result.error_px = std::max(result.error_px, choice.error_px);
    if (choice.level >= 0) draw(i, static_cast<std::size_t>(choice.level));
  }
  // A picture of nothing is still one of the layer.
  if (result.parts.empty() && !members_.empty()) draw(0, ladder_of(0).size() - 1);
  return result;
}

MemberLevels ShownMembers::at_rung(int rung) const {
  return chosen([this, rung = std::clamp(rung, 0, kRungs - 1)](std::size_t i) { return at_rung(i, rung); });
}

MemberLevels ShownMembers::at_level(int level) const {
  return chosen([this, level](std::size_t i) { return at_level(i, level); });
}

}  // namespace talisman::layers
