// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect/inspect_cells.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "layers/part_box.h"
#include "regulator/memory/stab_lists.h"
#include "sequences/content/culling/cell_plan.h"
#include "sequences/content/own_settings.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

namespace {

using CellsJson = nlohmann::ordered_json;

void add_cell(PerCell& sum, std::size_t of_one, int cells) {
  sum.mean += double(of_one) / cells;
  sum.most = std::max(sum.most, static_cast<int>(of_one));
}

/// The parts that a frame leaves, with the tests of `options`.
std::vector<char> seen_parts(const Sequence& sequence, Settings settings, const VisibilityOptions& options,
                             int frame, layers::SceneFrame& now, std::vector<layers::Box3>& boxes) {
  settings.regulator.policy = regulator::Policy::Direct;
  settings.visibility = options;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  std::vector<char> seen = seen_at(pipeline, state, frame)->part;
  now = state.culling->now, boxes = state.culling->boxes;
  return seen;
}

CellPlan cell_plan_of(const Sequence& sequence, int frame) {
  Settings settings = own_settings(sequence);
  settings.cells = sequence.cells;
  layers::SceneFrame now;
  std::vector<layers::Box3> boxes;
  const std::vector<char> in_view = seen_parts(sequence, settings, *visibility_from("none,none,frustum"),
                                               frame, now, boxes),
                          seen = seen_parts(sequence, settings, *visibility_from("cto,eye,eye"), frame, now,
                                            boxes);
  CellPlan plan;
  plan.cells = sequence.cells.get();
  plan.eye = layers::dvec3(now.camera.world_from_camera[3]);
  plan.view = view_region(now.camera, sequence.display_px, 0);
  const std::vector<int> around = cells_around(*plan.cells, plan.eye, now.camera.near_m);
  plan.sights = sights_from_eye(*plan.cells, plan.cells->portals_of(), around, plan.eye,
                                2 * now.camera.near_m, std::span(plan.view).subspan(1))
                    .sights;
  int drawn = 0;
  for (std::size_t part = 0; part < boxes.size(); ++part) {
    drawn += seen[part];
    plan.parts.push_back({sequence.scene->parts[part].name, boxes[part],
                          seen[part]      ? PlanPart::Drawn
                          : in_view[part] ? PlanPart::BehindWalls
                                          : PlanPart::OutsideOfView});
  }
  plan.title =
      sequence.name +
      formatted(", frame %d: %d of %zu parts are drawn, the eye is in ", frame, drawn, boxes.size()) +
      (around.empty() ? "no cell" : plan.cells->cells[around.front()].name);
  return plan;
}

std::string figure_line(const char* what, const PerCell& figures) {
  return formatted("  %-22s %8.2f %6d\n", what, figures.mean, figures.most);
}

std::string cells_text(const Sequence& sequence, const CellFigures& f, const std::string& title,
                       const std::string& plan) {
  return formatted("%s: %d cells, %d portals, %d parts, of which %d are in no cell\n\n  %-22s %8s %6s\n",
                   sequence.name.c_str(), f.cells, f.portals, f.parts, f.outside, "of a cell", "mean",
                   "most") +
         figure_line("portals", f.portals_of) + figure_line("parts in it", f.parts_in) +
         figure_line("cells that it sees", f.cells_seen) + figure_line("parts that it sees", f.parts_seen) +
         formatted("\n  all of it is worked out in %.0f ms\n\n", f.precompute_ms) + title +
         "\nplan: " + plan + "\n";
}

CellsJson json_of_figures(const PerCell& figures) { return {{"mean", figures.mean}, {"most", figures.most}}; }

}  // namespace

CellFigures cell_figures(const Sequence& sequence) {
  const layers::SceneFrame now = sequence.scene->at(0);
  const std::vector<layers::MeshBox> meshes = layers::mesh_boxes(*sequence.scene);
  std::vector<layers::Box3> boxes;
  for (const layers::Part& part : sequence.scene->parts)
    boxes.push_back(part_box(now, part, meshes[part.mesh]));
  const Stopwatch watch;
  regulator::StabLists lists(sequence.cells, boxes);
  CellFigures f;
  f.cells = static_cast<int>(lists.set().cells.size());
  f.portals = static_cast<int>(lists.set().portals.size());
  f.parts = static_cast<int>(boxes.size());
  f.outside = static_cast<int>(lists.outside().size());
  for (int cell = 0; cell < f.cells; ++cell) {
    const std::vector<regulator::StabEntry>& seen = lists.seen_from(cell);
    std::vector<int> parts;
    for (const regulator::StabEntry& entry : seen)
      parts.insert(parts.end(), entry.things.begin(), entry.things.end());
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    add_cell(f.portals_of, lists.portals_of()[cell].size(), f.cells);
    add_cell(f.parts_in, lists.things_in(cell).size(), f.cells);
    add_cell(f.cells_seen, seen.size(), f.cells);
    add_cell(f.parts_seen, parts.size(), f.cells);
  }
  f.precompute_ms = watch.ms();
  return f;
}

std::string inspect_cells(const Sequence& sequence, int frame, const std::string& out, bool json) {
  if (!sequence.cells || sequence.cells->cells.empty())
    throw InputError(sequence.file +
                     ": has no cells, --cells must be asked of a sequence with `cells` or `building`");
  if (frame < 0 || frame >= sequence.frames)
    throw InputError("--frame is " + std::to_string(frame) + ", must be 0 … " +
                     std::to_string(sequence.frames - 1));
  const std::string file = out.empty() ? "out/" + sequence.name + "-cells.svg" : out;
  if (std::filesystem::path(file).extension() != ".svg")
    throw InputError("--out is '" + file + "', must be a .svg file");
  const CellPlan plan = cell_plan_of(sequence, frame);
  const CellFigures f = cell_figures(sequence);
  if (const std::string folder = std::filesystem::path(file).parent_path().string(); !folder.empty())
    create_folder(folder);
  write_text_atomically(file, cell_plan_svg(plan));
  if (!json) return cells_text(sequence, f, plan.title, file);
  const CellsJson figures = {{"schema", "talisman.cells/1"},
                             {"sequence", sequence.name},
                             {"cells", f.cells},
                             {"portals", f.portals},
                             {"parts", f.parts},
                             {"parts_in_no_cell", f.outside},
                             {"portals_of_a_cell", json_of_figures(f.portals_of)},
                             {"parts_in_a_cell", json_of_figures(f.parts_in)},
                             {"cells_seen", json_of_figures(f.cells_seen)},
                             {"parts_seen", json_of_figures(f.parts_seen)},
                             {"frame", frame},
                             {"plan", file}};
  return figures.dump(2, ' ', false, CellsJson::error_handler_t::replace) + "\n";
}

}  // namespace talisman::sequences
