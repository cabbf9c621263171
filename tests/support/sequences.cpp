// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sequences.h"

#include <glm/gtc/quaternion.hpp>

#include "layers/tangents.h"
#include "tests/support/random_scene.h"
#include "tests/support/room.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

sequences::Sequence sequence_of(const char* name, layers::Scene scene, int frames) {
  sequences::Sequence sequence;
  sequence.name = name;
  sequence.frames = frames;
  sequence.display_px = {96, 72};
  sequence.layer_specs = one_layer_per_part(scene);
  sequence.layers = layers::factor(scene, sequence.layer_specs);
  sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  return sequence;
}

void add_pane(Scene& scene) {
  Node stand;
  stand.name = "pane";
  stand.local.translation = {1.4, 0.9, 1};
  scene.nodes.push_back(stand);
  scene.meshes.push_back(quad_mesh(1.2));
  scene.materials.emplace_back();
  scene.materials.back().name = "glass";
  scene.materials.back().base_color = {0.3f, 0.6f, 0.7f};
  scene.materials.back().opacity = 0.4f;
  scene.materials.back().two_sided = true;
  scene.parts.push_back({"pane", static_cast<int>(scene.nodes.size()) - 1,
                         static_cast<int>(scene.meshes.size()) - 1,
                         static_cast<int>(scene.materials.size()) - 1, -1});
}

/// The lamp sways, the eye goes by, the pane (the last node) crosses quickly enough to be blurred.
/// A rippled square that glows, shows stripes that change places and, in 2 s, bends its upper half upwards.
void add_sail(Scene& scene) {
  Node stand;
  stand.name = "sail";
  stand.local.translation = {-0.4, 2, -1};
  stand.morph_weights = {0};
  scene.nodes.push_back(stand);
  const int node = static_cast<int>(scene.nodes.size()) - 1;
  scene.meshes.push_back(quad_mesh(0.8));
  layers::Mesh& mesh = scene.meshes.back();
  layers::MorphTarget taller;
  for (const vec3& p : mesh.positions) taller.positions.push_back({0, p.y > 0 ? 0.4f : 0, 0});
  mesh.morphs = {taller};
  scene.materials.emplace_back();
  scene.materials.back().name = "sail";
  scene.materials.back().emissive = vec3(0.5f);
  scene.materials.back().emissive_texture = 0;
  scene.materials.back().two_sided = true;
  scene.materials.back().normal_texture = static_cast<int>(scene.textures.size());
  scene.textures.push_back({"ripples", 2, 1, {218, 128, 218, 255, 37, 128, 218, 255}});
  layers::derive_tangents(mesh);
  const int first = static_cast<int>(scene.textures.size());
  scene.materials.back().texture = first;
  scene.textures.push_back({"stripes 0", 2, 1, {230, 60, 60, 255, 60, 230, 60, 255}});
  scene.textures.push_back({"stripes 1", 2, 1, {60, 230, 60, 255, 230, 60, 60, 255}});
  scene.moving_pictures.push_back(
      {"stripes", first, 12, -1.0 / 12, 2, true, {}, 0, {0, 1}, {first, first + 1}});
  layers::MorphTrack grow;
  grow.weights = {{{0, 2}, {0, 1}, layers::Interpolation::Linear}};
  scene.tracks.push_back({node, grow});
  scene.parts.push_back({"sail", node, static_cast<int>(scene.meshes.size()) - 1,
                         static_cast<int>(scene.materials.size()) - 1, -1});
}

void add_motion(Scene& scene) {
  layers::TransformTrack cross;
  cross.translation = {{0, 0.25}, {{1.4, 0.9, 1}, {-0.1, 0.9, 1}}, layers::Interpolation::Linear};
  scene.tracks.push_back({static_cast<int>(scene.nodes.size()) - 1, cross});
  layers::FlightTrack eye, lamp;
  eye.position = {{0, 2}, {{-1, 2, 6}, {1, 2.2, 5.6}}, layers::Interpolation::Linear};
  eye.target = {{0}, {{0, 0.6, 0}}, layers::Interpolation::Linear};
  lamp.position = {{0, 2}, {{0, 4, 2}, {2, 4, 1}}, layers::Interpolation::Linear};
  lamp.target = {{0}, {{0, 0, 0}}, layers::Interpolation::Linear};
  scene.tracks.push_back({2, eye});
  scene.tracks.push_back({3, lamp});
}

}  // namespace

sequences::Variant run_of(const sequences::Sequence& sequence) {
  sequences::Settings settings;
  settings.regulator = sequence.regulator;
  settings.view.display_px = sequence.display_px;
  settings.fps = sequence.fps;
  settings.frames = sequence.frames;
  settings.explicit_order = sequence.explicit_order;
  settings.compression = sequence.compression;
  return {sequence, settings};
}

sequences::Variant every_effect(int frames) {
  Room room;
  room.casting().mirroring().shining().textured_twice().factored().spinning(1);
  Light ambient;
  ambient.name = "ambient";
  ambient.kind = Light::Kind::Ambient;
  ambient.color = vec3(0.35f);
  room.scene.lights[0].direction = {0, 0, -1};
  room.scene.lights[0].inner_cone_rad = 0.9;
  room.scene.lights[0].outer_cone_rad = 1.2;
  room.scene.lights[0].shadow.resolution_px = 128;
  room.scene.lights.push_back(ambient);
  room.scene.materials[0].texture_blend = {0.6f, 0.3f};
  room.scene.materials[1].base_color = {0.8f, 0.25f, 0.2f};
  room.scene.materials[1].specular = vec3(0.6f);
  room.scene.materials[1].shininess = 40;
  room.scene.lights[0].attenuation = {0.6, 0, 0.02};
  add_skinned_bar(room.scene, {-1.6, 0.1, 0});
  add_sail(room.scene);
  add_pane(room.scene);
  add_motion(room.scene);
  room.specs[0].group = layers::OrderGroup::Background;
  room.specs[0].shading.shadows->resolution_scale = 0.5;
  room.specs.push_back({"bar", {"bar"}, layers::OrderGroup::Normal, {}});
  room.specs.push_back({"sail", {"sail"}, layers::OrderGroup::Normal, {}});
  room.specs.push_back({"pane", {"pane"}, layers::OrderGroup::Normal, {}});
  room.specs.back().preferences.motion_blur = 0.5;

  sequences::Sequence sequence;
  sequence.name = "every effect";
  sequence.frames = frames;
  sequence.display_px = {96, 72};
  sequence.compression = chunker::CompressionOptions{};
  sequence.regulator.policy = regulator::Policy::Threshold;
  sequence.regulator.thresholds.geometric_px = 1;
  sequence.layer_specs = room.specs;
  sequence.layers = layers::factor(room.scene, room.specs);
  sequence.scene = std::make_shared<const Scene>(std::move(room.scene));
  return run_of(sequence);
}

sequences::Sequence moving_sequence(int frames) { return sequence_of("moving", moving_scene(), frames); }
sequences::Sequence resting_sequence(int frames) { return sequence_of("resting", cube_scene(), frames); }

sequences::Variant calling_for(layers::Effect effect, int frames) {
  if (effect != layers::Effect::Predictive) return every_effect(frames);
  sequences::Sequence sequence = moving_sequence(frames);
  sequence.regulator.policy = regulator::Policy::Predictive;
  sequence.regulator.lookahead.frames = 4;
  return run_of(sequence);
}

}  // namespace talisman::tests
