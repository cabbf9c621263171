// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/predictive/part_motion.h"

#include <algorithm>
#include <optional>

#include "layers/animation.h"
#include "layers/moving_picture.h"
#include "layers/shading.h"
#include "layers/state.h"

namespace talisman::sequences {

namespace {

using layers::dmat4;
using layers::dvec4;
using layers::SceneFrame;

/// Numbers that grow whenever something that many parts depend on differs from the frame before.
struct Surroundings {
  int camera = 0, light = 0;
};

/// As it was drawn last.
struct SeenPart {
  dmat4 world{1.0};
  std::vector<dmat4> matrices;  ///< of what deforms
  Surroundings around;
  int picture = -1;
  layers::dvec2 blend{1, 1};
  std::uint8_t outside = 0;
};

class Follower {
 public:
  Follower(const FollowedParts& followed, layers::ivec2 display_px, const MotionOptions& options)
      : followed_(followed),
        display_px_(display_px),
        options_(options),
        seen_(followed.parts.size()),
        clip_(followed.points.size()) {}

  /// The slice begins.
  void begin(SceneFrame frame) {
    casters_ = layers::part_matrices(frame, followed_.casters);
    before_ = std::move(frame);
    set_view();
    for (std::size_t i = 0; i < seen_.size(); ++i) look(i);
  }

  void follow(SceneFrame frame, int index, MotionSlice& slice) {
    note_surroundings(frame);
    before_ = std::move(frame);
    set_view();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (is_unchanged(i)) continue;
      moved_px_ = 0;
      const bool changed = has_changed(i);
      double& largest =
          slice.moved_px[static_cast<std::size_t>(index) * slice.layers + followed_.parts[i].layer];
      if (!changed) largest = std::max(largest, moved_px_);
      if (changed) slice.words[i].mark(index);
      if (changed || options_.reference == regulator::MotionReference::LastFrame) keep(i);
    }
  }

  /// How many parts would be displayed too far off the scene as it came? It is looked at, and forgotten again.
  int surprised(SceneFrame truth, int index, MotionSlice& slice) {
    const Surroundings around = around_;
    const std::vector<dmat4> casters = casters_;
    note_surroundings(truth);
    std::swap(before_, truth);
    set_view();
    const auto moved = slice.moved_px.begin() + static_cast<std::ptrdiff_t>(index) * slice.layers;
    std::fill(moved, moved + slice.layers, 0.0);  // what was expected is not what is displayed
    int count = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (is_unchanged(i)) continue;
      moved_px_ = 0;
      if (has_changed(i))
        ++count;
      else
        moved[followed_.parts[i].layer] = std::max(moved[followed_.parts[i].layer], moved_px_);
    }
    std::swap(before_, truth);
    set_view();
    around_ = around;
    casters_ = casters;
    return count;
  }

  std::int64_t vertices() const { return vertices_; }

 private:
  void note_surroundings(const SceneFrame& frame) {
    std::vector<dmat4> casters = layers::part_matrices(frame, followed_.casters);
    if (!(frame.camera == before_.camera)) ++around_.camera;
    if (frame.lights != before_.lights || casters != casters_) ++around_.light;
    casters_ = std::move(casters);
  }

  void set_view() {
    clip_from_world_ = layers::clip_from_world(before_.camera, display_px_);
    scale_ = regulator::DisplayScale(before_.camera, display_px_);
  }

  const dmat4& world_of(const FollowedPart& part) const { return before_.world_from_node[part.node]; }
  int picture_of(const FollowedPart& part) const {
    return part.picture < 0 ? -1 : before_.picture_frames[part.picture];
  }

  layers::dvec2 blend_of(const FollowedPart& part) const {
    if (part.blend < 0) return {1, 1};
    const FollowedBlend& blend = followed_.blends[part.blend];
    const auto at = [&](const layers::Keys<double>& keys) {
      return keys.values.empty() ? 1 : layers::value_at(keys, before_.time_s);
    };
    return {at(blend.first), at(blend.second)};
  }

  /// Would its picture be the same for certain?
  bool is_unchanged(std::size_t i) {
    const FollowedPart& part = followed_.parts[i];
    const SeenPart& seen = seen_[i];
    if (seen.around.camera != around_.camera || looks_otherwise(i)) return false;
    if (!part.deforms) return seen.world == world_of(part);
    const int parts[] = {part.part};
    return seen.matrices == layers::part_matrices(before_, parts);
  }

  /// Whatever its motion: by its light, or by what is on it.
  bool looks_otherwise(std::size_t i) const {
    const FollowedPart& part = followed_.parts[i];
    const SeenPart& seen = seen_[i];
    return (part.lit && seen.around.light != around_.light) || seen.picture != picture_of(part) ||
           seen.blend != blend_of(part);
  }

  bool has_changed(std::size_t i) {
    const FollowedPart& part = followed_.parts[i];
    const SeenPart& seen = seen_[i];
    project(part);
    const std::span<const dvec4> then(&clip_[part.first_point], part.points);
    if (options_.clip_rule && seen.outside != 0 && regulator::sides_outside(now_) != 0 && !part.deforms)
      return false;
    if (options_.delta_px == 0 || part.deforms || looks_otherwise(i)) return true;
    const regulator::ProjectedMotion motion = regulator::projected_motion(then, now_, scale_);
    moved_px_ = motion.px;
    return regulator::is_beyond(motion, options_.delta_px, options_.norm);
  }

  /// Into now_.
  void project(const FollowedPart& part) {
    const dmat4 clip_from_part = clip_from_world_ * world_of(part);
    now_.resize(part.points);
    for (std::size_t k = 0; k < part.points; ++k)
      now_[k] = clip_from_part * dvec4(followed_.points[part.first_point + k], 1);
    vertices_ += static_cast<std::int64_t>(part.points);
  }

  void look(std::size_t i) {
    project(followed_.parts[i]);
    keep(i);
  }

  /// What was projected last becomes what was drawn.
  void keep(std::size_t i) {
    const FollowedPart& part = followed_.parts[i];
    SeenPart& seen = seen_[i];
    seen.world = world_of(part);
    if (part.deforms) {
      const int parts[] = {part.part};
      seen.matrices = layers::part_matrices(before_, parts);
    }
    seen.around = around_;
    seen.picture = picture_of(part);
    seen.blend = blend_of(part);
    seen.outside = regulator::sides_outside(now_);
    std::copy(now_.begin(), now_.end(), clip_.begin() + static_cast<std::ptrdiff_t>(part.first_point));
  }

  const FollowedParts& followed_;
  layers::ivec2 display_px_;
  MotionOptions options_;
  std::vector<SeenPart> seen_;
  std::vector<dvec4> clip_;  ///< of all points, as they were drawn last
  std::vector<dvec4> now_;   ///< of one part
  SceneFrame before_;        ///< the frame that is looked at
  std::vector<dmat4> casters_;
  dmat4 clip_from_world_{1.0};
  regulator::DisplayScale scale_{layers::CameraState{}, {1, 1}};
  Surroundings around_;
  std::int64_t vertices_ = 0;
  double moved_px_ = 0;  ///< of the part that is looked at
};

FollowedPart followed_part(const layers::Scene& scene, int index) {
  const layers::Part& part = scene.parts[index];
  FollowedPart followed;
  followed.part = index;
  followed.node = part.node;
  followed.deforms = layers::deforms(scene, part);
  followed.lit = layers::is_lit(scene, part);
  if (!scene.moving_pictures.empty())
    followed.picture = layers::moving_picture_of(scene, scene.materials[part.material]);
  return followed;
}

/// The blend of the layer's textures over time, if there is one.
void add_blend(const layers::LayerSet& set, const layers::Layer& layer, FollowedParts& followed) {
  for (const layers::Layer& shade : set.layers)
    if (shade.base == layer.id && shade.kind == layers::LayerKind::Texture)
      followed.blends.push_back({layer.gain, shade.gain});
}

}  // namespace

FollowedParts followed_parts(const layers::Scene& scene, const layers::LayerSet& set) {
  FollowedParts followed;
  followed.casters = set.casting_parts;
  followed.layers = static_cast<int>(set.layers.size());
  std::vector<std::optional<layers::PredictionPrimitive>> by_mesh(scene.meshes.size());
  for (const layers::Layer& layer : set.layers) {  // in the order in which one pass draws them
    if (layer.base >= 0 || layer.is_aggregate()) continue;
    const std::size_t blends = followed.blends.size();
    if (layer.factored.second_texture) add_blend(set, layer, followed);
    for (const int index : layer.parts) {
      if (scene.parts[index].is_seam) continue;
      FollowedPart part = followed_part(scene, index);
      part.layer = layer.id;
      if (followed.blends.size() > blends) part.blend = static_cast<int>(blends);
      auto& primitive = by_mesh[scene.parts[index].mesh];
      if (!primitive) primitive = layers::prediction_primitive(scene.meshes[scene.parts[index].mesh]);
      part.kind = primitive->kind;
      part.first_point = followed.points.size();
      part.points = primitive->points.size();
      followed.points.insert(followed.points.end(), primitive->points.begin(), primitive->points.end());
      followed.parts.push_back(part);
    }
  }
  return followed;
}

MotionSlice follow_parts(const FollowedParts& followed, layers::ivec2 display_px, int first, int frames,
                         int last, const FrameAt& frame_at, const MotionOptions& options,
                         const FrameAt& truth_at) {
  MotionSlice slice{first, frames, {}, 0, -1, 0, followed.layers, {}};
  slice.moved_px.assign(static_cast<std::size_t>(frames) * followed.layers, 0.0);
  slice.words.assign(followed.parts.size(), regulator::MotionWord(frames));
  Follower follower(followed, display_px, options);
  follower.begin(frame_at(first));
  for (int index = 1; index < frames && first + index <= last; ++index) {
    follower.follow(frame_at(first + index), index, slice);
    if (!truth_at || slice.surprise >= 0) continue;
    slice.surprised = follower.surprised(truth_at(first + index), index, slice);
    if (slice.surprised > 0) slice.surprise = index;
  }
  slice.vertices = follower.vertices();
  return slice;
}

}  // namespace talisman::sequences
