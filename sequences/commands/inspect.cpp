// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect.h"

#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

#include "layers/effects.h"
#include "regulator/profile.h"
#include "sequences/commands/missing_effects.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

const char* name_of(layers::OrderGroup group) {
  switch (group) {
    case layers::OrderGroup::Background:
      return "background";
    case layers::OrderGroup::Normal:
      return "normal";
    case layers::OrderGroup::Foreground:
      return "foreground";
  }
  return "own";
}

const char* name_of(layers::BoundKind kind) {
  switch (kind) {
    case layers::BoundKind::Box8:
      return "box8";
    case layers::BoundKind::Dop14:
      return "dop14";
    case layers::BoundKind::Dop26:
      return "dop26";
  }
  return "?";
}

std::vector<layers::EffectCall> effects_of(const Sequence& s) {
  layers::RunEffects run;
  if (s.compression) run.compression_quality = s.compression->quality;
  run.follows_light = regulator::asks_for_light(s.regulator);
  return layers::effects_called_for(*s.scene, s.layers.layers, run);
}

struct Memory {
  std::int64_t mesh_bytes = 0, texture_bytes = 0;
};

std::int64_t bytes_of(const layers::Mesh& mesh) {
  const auto bytes = [](const auto& values) {
    return static_cast<std::int64_t>(values.size() * sizeof(values[0]));
  };
  return bytes(mesh.positions) + bytes(mesh.normals) + bytes(mesh.uvs) + bytes(mesh.colors) +
         bytes(mesh.indices) + bytes(mesh.joints) + bytes(mesh.weights);
}

Memory memory_of(const layers::Scene& scene) {
  Memory memory;
  for (const layers::Mesh& mesh : scene.meshes) memory.mesh_bytes += bytes_of(mesh);
  for (const layers::Texture& texture : scene.textures)
    memory.texture_bytes += static_cast<std::int64_t>(texture.rgba.size());
  return memory;
}

bool has_effect(layers::Effect effect) { return built_effects()[static_cast<std::size_t>(effect)]; }

std::string line(const char* pattern, auto... values) {
  char text[600];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

}  // namespace

std::string inspection_text(const Sequence& s) {
  const Memory memory = memory_of(*s.scene);
  std::string text =
      line("%s (%s)\n  %d frames at %g/s, %dx%d px, policy %s, warp %s, bound %s\n\n", s.name.c_str(),
           s.file.c_str(), s.frames, s.fps, s.display_px.x, s.display_px.y,
           std::string(regulator::name(s.regulator.policy)).c_str(), s.warp.c_str(), name_of(s.bound));
  text += line("  %-24s %-10s %6s %9s  %s\n", "layer", "group", "parts", "polygons", "motion");
  int polygons = 0;
  for (const layers::Layer& layer : s.layers.layers) {
    polygons += layer.polygons;
    const std::string motion = layer.rigid_node >= 0
                                   ? "rigid, follows " + s.scene->nodes[layer.rigid_node].name
                                   : std::string("parts move against each other or deform");
    text += line("  %-24s %-10s %6zu %9d  %s\n", layer.name.c_str(), name_of(layer.group), layer.parts.size(),
                 layer.polygons, motion.c_str());
  }
  text += line("\n  %zu layers, %d polygons; meshes %.1f MB, textures %.1f MB", s.layers.layers.size(),
               polygons, memory.mesh_bytes / 1e6, memory.texture_bytes / 1e6);
  if (s.layers.unassigned_parts == 1) text += "; 1 part is in no layer and is not drawn";
  if (s.layers.unassigned_parts > 1)
    text += line("; %d parts are in no layer and are not drawn", s.layers.unassigned_parts);
  text += "\n\n  effect               called  why\n";
  for (const layers::EffectCall& call : effects_of(s))
    text += line("  %-20s %-6s  %s%s\n", std::string(layers::name(call.effect)).c_str(),
                 call.called ? "yes" : "no", call.why.c_str(),
                 has_effect(call.effect) ? "" : " (not in this build)");
  return text;
}

std::string inspection_json(const Sequence& s) {
  const Memory memory = memory_of(*s.scene);
  Json layer_list = Json::array();
  for (const layers::Layer& layer : s.layers.layers)
    layer_list.push_back({{"name", layer.name},
                          {"group", name_of(layer.group)},
                          {"parts", layer.parts.size()},
                          {"polygons", layer.polygons},
                          {"rigid", layer.rigid_node >= 0},
                          {"resolution_scale", layer.preferences.resolution_scale}});
  Json effects = Json::object();
  for (const layers::EffectCall& call : effects_of(s))
    effects[std::string(layers::name(call.effect))] = {
        {"called", call.called}, {"why", call.why}, {"built", has_effect(call.effect)}};
  const Json json = {{"schema", "talisman.inspect/1"},
                     {"sequence", s.name},
                     {"file", s.file},
                     {"frames", s.frames},
                     {"fps", s.fps},
                     {"display_px", {s.display_px.x, s.display_px.y}},
                     {"bound", name_of(s.bound)},
                     {"layers", layer_list},
                     {"unassigned_parts", s.layers.unassigned_parts},
                     {"mesh_bytes", memory.mesh_bytes},
                     {"texture_bytes", memory.texture_bytes},
                     {"effects", effects},
                     {"warnings", s.warnings}};
  return json.dump(2) + "\n";
}

std::string profile_text() {
  const regulator::HardwareProfile& profile = regulator::talisman_1996();
  std::string text = std::string(profile.name) + "\n";
  for (const regulator::ProfileNumber& n : profile.numbers)
    text += line("  %-18s %12g %-18s %-9s  %s\n", std::string(n.name).c_str(), n.value,
                 std::string(n.unit).c_str(), n.confirmed ? "confirmed" : "assumed",
                 std::string(n.source).c_str());
  return text;
}

}  // namespace talisman::sequences
