// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect.h"

#include <cstdio>
#include <ostream>
#include <utility>

#include <nlohmann/json.hpp>

#include "layers/effects.h"
#include "regulator/profile.h"
#include "sequences/commands/inspect/inspect_cells.h"
#include "sequences/commands/inspect/inspect_factoring.h"
#include "sequences/commands/inspect/inspect_order.h"
#include "sequences/commands/inspect/inspect_parts.h"
#include "sequences/commands/missing_effects.h"
#include "sequences/commands/options.h"
#include "sequences/commands/words.h"
#include "sequences/content/factoring/factoring.h"
#include "sequences/experiments/variant.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"
#include "sequences/files/utf8.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Of a group that no word stands for, since a variant of the sequence gave each layer its own.
std::string name_of(layers::OrderGroup group) { return std::string(word_of(group, kOrderGroupWords, "own")); }

std::string name_of(layers::BoundKind kind) { return std::string(word_of(kind, kBoundWords)); }

/// As a run without any option has them.
std::vector<layers::EffectCall> effects_of(const Sequence& s) {
  Settings own;
  own.regulator = s.regulator;
  own.compression = s.compression;
  return effects_of(s, own);
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

std::string layer_lines(const Sequence& s) {
  std::string text =
      formatted("  %-24s %-10s %6s %9s  %s\n", "layer", "group", "parts", "polygons", "motion");
  int polygons = 0;
  for (const layers::Layer& layer : s.layers.layers) {
    polygons += layer.polygons;
    const std::string motion = layer.rigid_node >= 0
                                   ? "rigid, follows " + s.scene->nodes[layer.rigid_node].name
                                   : std::string("parts move against each other or deform");
    text += formatted("  %-24s %-10s %6zu %9d  %s\n", layer.name.c_str(), name_of(layer.group).c_str(),
                      layer.parts.size(), layer.polygons, motion.c_str());
  }
  const Memory memory = memory_of(*s.scene);
  text += formatted("\n  %zu layers, %d polygons; meshes %.1f MB, textures %.1f MB", s.layers.layers.size(),
                    polygons, memory.mesh_bytes / 1e6, memory.texture_bytes / 1e6);
  if (s.layers.unassigned_parts == 1) text += "; 1 part is in no layer and is not drawn";
  if (s.layers.unassigned_parts > 1)
    text += formatted("; %d parts are in no layer and are not drawn", s.layers.unassigned_parts);
  return text;
}

std::string effect_lines(const Sequence& s) {
  std::string text = "  effect               called  why\n";
  for (const layers::EffectCall& call : effects_of(s))
    text += formatted("  %-20s %-6s  %s%s\n", std::string(layers::name(call.effect)).c_str(),
                      call.called ? "yes" : "no", call.why.c_str(),
                      has_effect(call.effect) ? "" : " (not in this build)");
  return text;
}

/// The visibility order as a run with the sequence's own settings has it.
std::string order_of(const Sequence& sequence, const InspectOptions& options) {
  CommandLine line;
  line.cycles = options.cycles;
  line.compositor = options.compositor;
  const OrderOverTime order = order_over_time(sequence, resolve(line, sequence, true).settings);
  return options.json ? order_json(sequence, order) : order_text(sequence, order);
}

}  // namespace

std::string inspection_text(const Sequence& s) {
  std::string text = formatted("%s (%s)\n  %d frames at %g/s, %dx%d px, policy %s, warp %s, bound %s\n\n",
                               s.name.c_str(), s.file.c_str(), s.frames, s.fps, s.display_px.x,
                               s.display_px.y, std::string(regulator::name(s.regulator.policy)).c_str(),
                               s.warp.c_str(), name_of(s.bound).c_str());
  return text + layer_lines(s) + "\n\n" + effect_lines(s);
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
  Json warnings = Json::array();  // they speak of files
  for (const std::string& warning : s.warnings) warnings.push_back(utf8_from(warning));
  const Json json = {{"schema", "talisman.inspect/1"},
                     {"sequence", s.name},
                     {"file", utf8_from(s.file)},
                     {"frames", s.frames},
                     {"fps", s.fps},
                     {"display_px", {s.display_px.x, s.display_px.y}},
                     {"bound", name_of(s.bound)},
                     {"layers", layer_list},
                     {"unassigned_parts", s.layers.unassigned_parts},
                     {"mesh_bytes", memory.mesh_bytes},
                     {"texture_bytes", memory.texture_bytes},
                     {"effects", effects},
                     {"warnings", warnings}};
  return json.dump(2) + "\n";
}

namespace {

/// Options that belong to another question would be ignored.
void require_one_question(const InspectOptions& options) {
  if (!options.out.empty() && !options.parts && !options.cells)
    throw InputError("--out is the picture of --parts or --cells, must come with one of them");
  if (options.frame && !options.cells)
    throw InputError("--frame is that of the plan of --cells, must come with it");
  if (options.parts + options.cells + options.order + options.factoring + options.motion > 1)
    throw InputError(
        "--parts, --cells, --order, --factoring and --motion are several questions, must be one");
  if (options.trace.any() && !options.motion)
    throw InputError("--format, --joint, --fps and --scale are about a trace, must come with --motion");
  if (options.max_layers && !options.factoring)
    throw InputError("--max-layers limits what --factoring proposes, must come with it");
  if (options.factoring && options.json)
    throw InputError("--factoring prints text and YAML, must be given without --json");
  for (const auto& [name, value] :
       {std::pair{"--cycles", options.cycles}, {"--compositor", options.compositor}})
    if (!value.empty() && !options.order)
      throw InputError(std::string(name) + " is about the visibility order, must come with --order");
}

}  // namespace

int run_inspect(const InspectOptions& options, std::ostream& out) {
  require_one_question(options);
  if (options.profile) out << profile_text();
  if (options.sequence.empty()) {
    if (options.profile) return kSuccess;
    throw InputError("inspect needs a SEQUENCE, a MODEL or --profile");
  }
  if (options.motion) {
    out << inspect_motion(options.sequence, options.trace, options.json);
    return kSuccess;
  }
  ContentWords content = options.content;
  content.no_stage |= options.parts;  // the ground that a bare model is given is not in its file
  const Sequence sequence = load_with_warnings(options.sequence, content);
  out << (options.factoring ? inspect_factoring(sequence, options.max_layers.value_or(kMostLayersByDefault))
          : options.parts   ? inspect_parts(sequence, options.out, options.json)
          : options.cells   ? inspect_cells(sequence, options.frame.value_or(0), options.out, options.json)
          : options.order   ? order_of(sequence, options)
          : options.json    ? inspection_json(sequence)
                            : inspection_text(sequence));
  return kSuccess;
}

std::string profile_text() {
  const regulator::HardwareProfile& profile = regulator::talisman_1996();
  std::string text = std::string(profile.name) + "\n";
  for (const regulator::ProfileNumber& n : profile.numbers)
    text += formatted("  %-18s %12g %-18s %-9s  %s\n", std::string(n.name).c_str(), n.value,
                      std::string(n.unit).c_str(), n.confirmed ? "confirmed" : "assumed",
                      std::string(n.source).c_str());
  return text;
}

}  // namespace talisman::sequences
