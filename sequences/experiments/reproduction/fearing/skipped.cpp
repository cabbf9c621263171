// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/fearing/skipped.h"

#include <cmath>

#include "layers/layer.h"
#include "sequences/content/asset_paths.h"
#include "sequences/content/scene_builder.h"
#include "sequences/content/sequence_file.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/predictive/motion_study.h"

namespace talisman::sequences {

namespace {

constexpr double kPrinted[5][5] = {{0, 12.50, 25.00, 37.50, 49.50},
                                   {0, 18.75, 37.50, 56.25, 74.25},
                                   {0, 21.75, 43.50, 65.25, 86.13},
                                   {0, 23.25, 46.50, 69.75, 92.07},
                                   {0, 24.00, 48.00, 72.00, 95.04}};
constexpr double kBounds32[] = {1.00, 1.31, 1.92, 3.57, 20.16}, kBounds[] = {1.00, 1.33, 2.00, 4.00, 100};

bool is_near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

/// The scenario with another share that moves.
double counted_skipped(const SequenceFile& file, int moving_percent, int slice) {
  SceneRecipe recipe = file.recipe;
  recipe.times = {file.settings.fps, file.settings.frames, file.settings.display_px};
  recipe.swarm->moving_percent = moving_percent;
  const layers::Scene scene = build_scene(recipe).scene;
  layers::LayerSpec all;
  all.name = "swarm";
  all.part_globs = {"*"};
  MotionStudyOptions options;
  options.motion = {0.01, regulator::MotionNorm::Axis, regulator::MotionReference::LastDrawn, false};
  options.plan = {slice, 2};
  options.display_px = file.settings.display_px;
  options.frames = file.settings.frames;
  options.fps = file.settings.fps;
  const MotionCounts counts = study_motion(scene, layers::factor(scene, {&all, 1}), options).all;
  return 100 * (1 - static_cast<double>(counts.polygons) / static_cast<double>(counts.polygons_direct));
}

std::vector<SkippedCell> skipped_cells() {
  const std::string path = sequence_file_of("fearing/random");
  if (path.empty()) throw InputError("fearing/random is not there");
  const SequenceFile file = read_sequence_file(path);
  std::vector<SkippedCell> cells;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      const int moving = kMovingPercent[column], slice = kSlices96[row];
      cells.push_back({moving, slice, kPrinted[row][column], counted_skipped(file, moving, slice),
                       100 * skipped_share(1 - moving / 100.0, file.settings.frames, slice)});
    }
  return cells;
}

const std::vector<SkippedCell>& cells_of(PaperBench& bench) {
  return bench.once("F96 skipped", skipped_cells);
}

std::string cell_name(const SkippedCell& cell) {
  return "N = " + std::to_string(cell.slice) + ", " + std::to_string(cell.moving_percent) + " %";
}

}  // namespace

double skipped_share(double rest, int frames, int slice) {
  return rest * (1 - static_cast<double>((frames + slice - 1) / slice) / frames);
}

Finding table_5_26(const std::vector<SkippedCell>& cells) {
  Finding finding{"", !cells.empty(), {}};
  int equal = 0;
  std::string others;
  for (const SkippedCell& cell : cells) {
    const bool same =
        is_near(cell.counted, cell.printed, 0.005 + 1e-9) && is_near(cell.counted, cell.oracle, 1e-9);
    equal += same;
    finding.same = finding.same && same;
    if (!same)
      others += "; " + cell_name(cell) + ": " + fixed(cell.counted, 2) + " for " + fixed(cell.printed, 2);
    finding.numbers.emplace_back(cell_name(cell), cell.counted);
  }
  finding.ours = std::to_string(equal) + " of " + std::to_string(cells.size()) + " cells" + others;
  return finding;
}

Finding bounds_5_30(const std::vector<SkippedCell>& cells) {
  Finding finding{"", false, {}};
  int found = 0, same = 0;
  for (const SkippedCell& cell : cells) {
    if (cell.slice != 32) continue;
    const double of_slice = 1 / (1 - cell.counted / 100), of_all = 100.0 / cell.moving_percent;
    // 1.316 is printed as 1.31: cut off.
    const double printed = kBounds32[found];
    const bool cut_off = is_near(std::floor(100 * of_slice + 1e-9) / 100, printed, 1e-9);
    same += (is_near(of_slice, printed, 0.005 + 1e-9) || cut_off) && is_near(of_all, kBounds[found], 0.005);
    finding.ours += (finding.ours.empty() ? "" : ", ") + fixed(of_slice, 3);
    finding.numbers.emplace_back(cell_name(cell), of_slice);
    ++found;
  }
  finding.same = found == 5 && same == 5;
  return finding;
}

Item skipped_polygons_96() {
  Claim table{"5.26", "Table 5.26, 25 cells from 0.00 to 95.04 %",
              "counted from a run's words: every cell to the last digit",
              [](PaperBench& bench) { return table_5_26(cells_of(bench)); }};
  Claim bounds{"5.30", "Table 5.30, best for N = 32: 1.00 1.31 1.92 3.57 20.16",
               "every bound, rounded or cut off (1.316 is printed as 1.31)",
               [](PaperBench& bench) { return bounds_5_30(cells_of(bench)); }};
  for (Claim* claim : {&table, &bounds}) {
    claim->sequence = "fearing/random";
    claim->must = true;
  }
  return {"5.26", "Tables 5.26 and 5.30: polygons skipped", {table, bounds}};
}

}  // namespace talisman::sequences
