// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/depth_complexity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::dvec2;
using layers::dvec4;

/// The share of a box that lies on the sprite: how much of a triangle in it probably does.
double share_on(const layers::RectD& box, const layers::RectD& sprite) {
  const layers::RectD inside = layers::intersection(box, sprite);
  const double area = box.width() * box.height();
  return inside.empty() ? 0 : area > 0 ? inside.width() * inside.height() / area : 1;
}

/// Triangles of one part, on the sprite.
class ProjectedPart {
 public:
  ProjectedPart(const Pipeline& pipeline, const layers::SceneFrame& frame, const layers::Part& part,
                const layers::SpritePlacement& placement)
      : mesh_(frame.scene->meshes[part.mesh]),
        two_sided_(part.material >= 0 && frame.scene->materials[part.material].two_sided),
        near_m_(frame.camera.near_m),
        display_px_(pipeline.settings.view.display_px),
        sprite_{{0, 0}, dvec2(placement.size_px)},
        sprite_from_screen_(inverse(placement.screen_from_sprite)) {
    const layers::dmat4 clip_from_part =
        layers::clip_from_world(frame.camera, display_px_) * frame.world_from_node[part.node];
    clip_.reserve(mesh_.positions.size());
    for (const layers::vec3& p : mesh_.positions)
      clip_.push_back(clip_from_part * dvec4(layers::dvec3(p), 1));
  }

  double texels() const {
    double sum = 0;
    for (std::size_t i = 0; sprite_from_screen_ && i + 2 < mesh_.indices.size(); i += 3) sum += triangle(i);
    return sum;
  }

 private:
  double triangle(std::size_t first) const {
    std::array<dvec2, 3> screen;
    layers::RectD box;
    for (int k = 0; k < 3; ++k) {
      const dvec4& clip = clip_[mesh_.indices[first + k]];
      if (!(clip.w > near_m_)) return 0;
      screen[k] = layers::screen_from_clip(clip, display_px_);
    }
    const dvec2 u = screen[1] - screen[0], v = screen[2] - screen[0];
    const double doubled = u.x * v.y - u.y * v.x;  // y is down: negative where it faces the eye
    if (!std::isfinite(doubled) || (doubled >= 0 && !two_sided_)) return 0;
    for (const dvec2& p : screen) box.include((*sprite_from_screen_)(p));
    return 0.5 * std::fabs(doubled * sprite_from_screen_->determinant()) * share_on(box, sprite_);
  }

  const layers::Mesh& mesh_;
  bool two_sided_;
  double near_m_;
  layers::ivec2 display_px_;
  layers::RectD sprite_;
  std::optional<layers::Affine2> sprite_from_screen_;
  std::vector<dvec4> clip_;
};

}  // namespace

bool measures_depth(const Pipeline& pipeline) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  return options.policy == regulator::Policy::Budget && options.budget.ms != regulator::kNoLimitMs &&
         options.budget.depth_complexity == 0;
}

double texels_filled(const Pipeline& pipeline, const layers::SceneFrame& frame, const layers::Layer& layer,
                     const layers::SpritePlacement& placement) {
  double sum = 0;
  for (const int part : layer.parts)
    sum += ProjectedPart(pipeline, frame, frame.scene->parts[part], placement).texels();
  return sum;
}

void measure_depth(const Pipeline& pipeline, PipelineState& state, const FrameReport& report) {
  std::optional<layers::SceneFrame> frame;
  for (const regulator::LayerAssessment& layer : report.assessments) {
    if (!layer.in_view || layer.has_sprite) continue;
    if (!frame) frame = scene_at(pipeline, report.frame);
    const layers::SpritePlacement& placement = captured_placement(pipeline, state, layer.layer, report.frame);
    state.depth.filled += texels_filled(pipeline, *frame, report.layers[layer.layer], placement);
    state.depth.texels += static_cast<double>(placement.size_px.x) * placement.size_px.y;
  }
}

}  // namespace talisman::sequences
