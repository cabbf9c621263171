// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/culling/culling.h"

#include <algorithm>
#include <numeric>

#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::Layer;

/// Layers of whose points others ask: casters, what is mirrored, and what holds their traces.
std::vector<char> layers_looked_at(const LayerTable& authored) {
  std::vector<char> looked_at(authored.size(), 0);
  const bool blurs = std::any_of(authored.begin(), authored.end(),
                                 [](const Layer& layer) { return layer.preferences.motion_blur > 0; });
  for (const Layer& layer : authored) {
    if (blurs || layer.holds.shadows || layer.holds.reflection || layer.base >= 0) looked_at[layer.id] = 1;
    if (layer.base >= 0) looked_at[layer.base] = 1;
    for (const int id : layer.casters) looked_at[id] = 1;
    for (const int id : layer.reflected) looked_at[id] = 1;
  }
  return looked_at;
}

/// Fits the boxes and the tree to the scene at the frame.
void move_boxes(const Pipeline& pipeline, CullingMemory& memory, int frame) {
  const Culling& culling = *pipeline.culling;
  const layers::Scene& scene = pipeline.scene;
  const auto fit = [&](int part) {
    memory.boxes[part] = part_box(memory.now, scene.parts[part], culling.boxes()[scene.parts[part].mesh]);
  };
  if (is_late(pipeline)) {
    culling.motion().advance(memory.walked, time_of(pipeline, frame));
    memory.now = memory.walked;
    look_from(memory.now, camera_known(pipeline, frame, frame));
  } else {
    culling.motion().advance(memory.now, time_of(pipeline, frame));
  }
  if (memory.boxes.size() != scene.parts.size()) {
    memory.boxes.resize(scene.parts.size());
    for (std::size_t part = 0; part < scene.parts.size(); ++part) fit(static_cast<int>(part));
    memory.tree.build(memory.boxes);
    if (pipeline.settings.cells && culling.options().needs_cells())
      memory.cells.emplace(pipeline.settings.cells, memory.boxes, culling.moving_parts());
    return;
  }
  for (const int part : culling.moving_parts()) fit(part);
  memory.tree.update(memory.boxes, culling.moving_parts());
  if (memory.cells) memory.cells->refile(memory.boxes, culling.moving_parts());
}

/// Parts that pass the test of objects alone: those in the frustum, or all.
void find_objects(const Pipeline& pipeline, CullingMemory& memory, SeenParts& seen) {
  memory.found.clear();
  if (pipeline.culling->options().objects == ViewTest::None) {
    for (std::size_t part = 0; part < memory.boxes.size(); ++part)
      if (!memory.boxes[part].empty()) memory.found.push_back(static_cast<int>(part));
    return;
  }
  memory.tree.query(view_region(memory.now.camera, pipeline.settings.view.display_px, 0), memory.found,
                    seen.query);
}

void note_seen(const Pipeline& pipeline, const CullingMemory& memory, SeenParts& seen) {
  const Culling& culling = *pipeline.culling;
  for (const int part : memory.found) {
    seen.part[part] = 1;
    ++seen.parts;
    const layers::Part& p = pipeline.scene.parts[part];
    seen.polygons += pipeline.scene.meshes[p.mesh].triangle_count();
    if (const int layer = culling.layer_of(part); layer >= 0) seen.layer[layer] = 1;
  }
  for (const Layer& layer : pipeline.authored)
    if (layer.base >= 0) {
      seen.layer[layer.id] = seen.layer[layer.base];
      seen.in_view[layer.id] = seen.in_view[layer.base];
    }
}

}  // namespace

Culling::Culling(const layers::Scene& scene, const LayerTable& authored, const Settings& settings)
    : options_(settings.visibility),
      motion_(scene),
      mesh_boxes_(layers::mesh_boxes(scene)),
      layer_of_part_(scene.parts.size(), -1),
      looked_at_(layers_looked_at(authored)) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (deforms(scene, scene.parts[i]) || motion_.moves(scene.parts[i].node))
      moving_parts_.push_back(static_cast<int>(i));
  for (const Layer& layer : authored)
    if (layer.base < 0)
      for (const int part : layer.parts) layer_of_part_[part] = layer.id;
}

bool allows_culling(regulator::Policy policy) {
  using regulator::Policy;
  return policy == Policy::Direct || policy == Policy::Reference || policy == Policy::Threshold ||
         policy == Policy::Budget;
}

const SeenParts* seen_at(const Pipeline& pipeline, PipelineState& state, int frame) {
  if (!pipeline.culling || !allows_culling(pipeline.settings.regulator.policy)) return nullptr;
  if (!state.culling || state.culling->of != pipeline.culling) {
    state.culling.make();
    state.culling->of = pipeline.culling;
  }
  CullingMemory& memory = *state.culling;
  for (const SeenParts& known : memory.seen)
    if (known.frame == frame) return &known;
  SeenParts& seen = memory.seen[memory.last ^= 1];
  seen = {};
  seen.part.assign(pipeline.scene.parts.size(), 0);
  seen.layer.assign(pipeline.authored.size(), 0);
  move_boxes(pipeline, memory, frame);
  find_objects(pipeline, memory, seen);
  seen.in_view.assign(pipeline.authored.size(), 0);
  for (const int part : memory.found)
    if (const int layer = pipeline.culling->layer_of(part); layer >= 0) seen.in_view[layer] = 1;
  if (memory.cells)
    seen.cells = memory.cells->keep_seen(pipeline.culling->options(), memory.now.camera,
                                         pipeline.settings.view.display_px, memory.boxes, memory.found);
  note_seen(pipeline, memory, seen);
  seen.frame = frame;
  return &seen;
}

const char* why_culled(const SeenParts& seen, int layer) {
  return seen.in_view[layer] ? "culled: no row of portals shows it" : "culled: outside of the view";
}

void forget_seen(PipelineState& state) {
  if (!state.culling) return;
  for (SeenParts& seen : state.culling->seen) seen.frame = -1;
}

void hide(layers::LayerState& state) {
  state.screen_points.clear();
  state.screen_bounds_px = {};
  state.touches_display = state.clipped = false;
  state.nearest_w_m = 0;
}

}  // namespace talisman::sequences
