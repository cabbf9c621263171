// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/parts/axes_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "chunker/render.h"
#include "sequences/content/default_view.h"
#include "sequences/pictures/image_drawing.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using layers::dvec2;
using layers::dvec3;

constexpr double kFov_rad = 0.5, kRoom = 1.3, kAxis = 1.25;
constexpr float kBehind = 0.1f;

struct Eye {
  layers::Transform world_from_eye;
  double distance = 1, radius = 1;
};

/// From the front (where -z points), the right and above.
Eye eye_on(const dvec3& center, double radius) {
  const dvec3 z = glm::normalize(dvec3(0.75, 0.6, -1)), x = glm::normalize(glm::cross(dvec3(0, 1, 0), z));
  Eye eye;
  eye.radius = radius;
  eye.distance = kRoom * radius / std::sin(kFov_rad / 2);
  eye.world_from_eye.rotation = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
  eye.world_from_eye.translation = center + eye.distance * z;
  return eye;
}

/// The scene before that eye, under the light of a bare model, without shadows and mirrors.
layers::Scene scene_before(const Sequence& sequence, const Eye& eye) {
  layers::Scene scene = *sequence.scene;
  scene.lights.clear();
  scene.lights = model_stage(scene, {.stage = false}).lights;
  layers::Camera camera;
  camera.node = static_cast<int>(scene.nodes.size());
  camera.fov_y_rad = kFov_rad;
  camera.near_m = 0.25 * (eye.distance - eye.radius);
  camera.far_m = 4 * (eye.distance + eye.radius);
  scene.nodes.push_back({"eye", -1, eye.world_from_eye});
  scene.cameras = {camera};
  scene.background = layers::vec3(kBehind);
  return scene;
}

Image8 picture_of(const layers::Scene& scene, std::vector<layers::LayerSpec> specs, int size_px) {
  for (layers::LayerSpec& spec : specs) spec.shading = {}, spec.fade = {};
  Settings settings;
  settings.regulator.policy = regulator::Policy::Direct;
  settings.view.display_px = {size_px, size_px};
  settings.frames = 1;
  const Pipeline pipeline = make_pipeline(scene, layers::factor(scene, specs), settings);
  const chunker::PreparedScene prepared(scene, settings.render);
  PipelineState state(pipeline);
  return to_image8(step(pipeline, state, 0, &prepared).picture);
}

dvec2 on_picture(const Eye& eye, const dvec3& place, int size_px) {
  const dvec3 seen = glm::conjugate(eye.world_from_eye.rotation) * (place - eye.world_from_eye.translation);
  const double scale = 0.5 * size_px / std::tan(kFov_rad / 2);
  return dvec2(0.5 * size_px) + scale / -seen.z * dvec2(seen.x, -seen.y);
}

struct Axis {
  const char* name;
  dvec3 way;
  Rgb color;
};

void draw_axes(Image8& image, const Eye& eye, const dvec3& center, const dvec3& half) {
  static const std::array kAxes{Axis{"+x", {1, 0, 0}, {255, 80, 80}}, Axis{"+y", {0, 1, 0}, {90, 230, 90}},
                                Axis{"+z", {0, 0, 1}, {120, 150, 255}},
                                Axis{"nose (-z)", {0, 0, -1}, {255, 80, 240}}};
  const double shortest = 0.8 * std::max({half.x, half.y, half.z});
  for (const Axis& axis : kAxes) {
    const double reach = kAxis * std::max(std::abs(glm::dot(half, axis.way)), shortest);
    const dvec2 from = on_picture(eye, center, image.width),
                to = on_picture(eye, center + reach * axis.way, image.width);
    draw_line(image, from, to, axis.color);
    const layers::ivec2 box = text_size(axis.name, 2);
    const dvec2 at = to + (to.x < from.x ? dvec2(-box.x - 6, 0) : dvec2(6, 0)) - dvec2(0, 0.5 * box.y);
    draw_text(image, axis.name,
              {std::clamp(static_cast<int>(at.x), 0, std::max(0, image.width - box.x)),
               std::clamp(static_cast<int>(at.y), 0, std::max(0, image.height - box.y))},
              axis.color, 2);
  }
}

}  // namespace

Image8 axes_picture(const Sequence& sequence, int size_px) {
  layers::WorldBounds bounds;
  const layers::SceneFrame frame = sequence.scene->at(0);
  for (const layers::Part& part : sequence.scene->parts)
    for (const dvec3& p : layers::world_positions(frame, part)) {
      bounds.lo = glm::min(bounds.lo, p);
      bounds.hi = glm::max(bounds.hi, p);
    }
  if (bounds.empty()) bounds = {dvec3(-1), dvec3(1)};
  const dvec3 center = 0.5 * (bounds.lo + bounds.hi), half = 0.5 * (bounds.hi - bounds.lo);
  const Eye eye = eye_on(center, std::max(glm::length(half), 1e-9));
  Image8 image = picture_of(scene_before(sequence, eye), sequence.layer_specs, size_px);
  draw_axes(image, eye, center, half);
  return image;
}

}  // namespace talisman::sequences
