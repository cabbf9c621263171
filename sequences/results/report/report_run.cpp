// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/report_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "regulator/profile.h"
#include "sequences/files/file_text.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/json_text.h"
#include "sequences/results/reason_kind.h"
#include "sequences/results/report/changes_beside.h"
#include "sequences/results/report/thumbnails.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Compressed bytes of decisions that a page may hold; a third more as text.
constexpr std::size_t kMostBytes = 8'200'000;

std::vector<ColumnInfo> columns_of_page(std::vector<ColumnInfo> columns) {
  // Hashes of every picture are no numbers to look at, and cannot be made smaller.
  std::erase_if(columns,
                [](const ColumnInfo& c) { return c.name == "frame_hash" || c.name == "picture_hash"; });
  return columns;
}

/// Null where it is not there, or not whole.
Json file_as_json(const std::string& path) {
  const std::optional<std::string> text = text_of_file(path);
  if (!text) return nullptr;
  Json json = Json::parse(*text, nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

/// NAME, or NAME.partial of a run that has not come to its end; empty: neither.
std::string file_of_lines(const std::string& folder, const std::string& name) {
  std::error_code error;
  for (const char* state : {".partial", ""})
    if (fs::exists(folder + "/" + name + state, error)) return folder + "/" + name + state;
  return {};
}

/// The lines of `schema`; the last one may be cut off. Others go to `other`.
void for_each_line_of(const std::string& file, const std::vector<ColumnInfo>& columns,
                      const std::string& schema, const std::function<void(const std::vector<Cell>&)>& take,
                      const std::function<void(const std::string&)>& other = {}) {
  std::ifstream in(file, std::ios::binary);
  FlatLine line(columns);
  int number = 0;
  const auto take_row = [&] {
    try {
      take(line.cells());
    } catch (const std::invalid_argument& error) {  // a column of words in one line, of numbers in another
      throw InputError(error.what(), file, number);
    }
  };
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (in.eof()) break;  // no end of line: is being written
    if (!line.read(text)) throw InputError("is no line of ours, must be of schema " + schema, file, number);
    if (line.schema() == schema)
      take_row();
    else if (other)
      other(text);
    else
      throw InputError("is no line of ours, must be of schema " + schema, file, number);
  }
}

/// Adds up decisions.
class DecisionTally {
 public:
  explicit DecisionTally(ReportRun& run) : run_(run) {}

  void add(const std::vector<Cell>& row) {
    const PackedTable& table = run_.decisions;
    const std::string name = cell_word(table.cell(row, "layer")),
                      decision = cell_word(table.cell(row, "decision"));
    const std::string reason = cell_word(table.cell(row, "reason"));
    const int frame = static_cast<int>(cell_or_0(table.cell(row, "frame")));
    const double geometric_px = cell_or_0(table.cell(row, "geometric_px"));
    LayerCounts& layer = layer_of(name);
    const ReasonKind kind = kind_of_reason(reason);
    ++(decision == "rerender" ? layer.renders : decision == "drop" ? layer.drops : layer.reuses);
    layer.polygons += cell_or_0(table.cell(row, "cost_polygons"));
    layer.pixels += cell_or_0(table.cell(row, "cost_pixels"));
    if (decision == "rerender") ++layer.why[kind.words];
    add_reason(decision, kind);
    if (decision == "drop") return;
    layer.sum_geometric_px += geometric_px;
    if (layer.frame_of_max < 0 || geometric_px > layer.max_geometric_px) {
      layer.max_geometric_px = geometric_px;
      layer.frame_of_max = frame;
    }
    add_worst({frame, name, decision, reason, geometric_px});
  }

  void finish() {
    std::stable_sort(run_.reasons.begin(), run_.reasons.end(),
                     [](const auto& a, const auto& b) { return a.times > b.times; });
    for (ReasonCounts& counts : run_.reasons) {
      std::vector<double>& values = values_[{counts.decision, counts.words}];
      if (values.empty()) continue;
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      counts.median = *middle;
    }
  }

 private:
  LayerCounts& layer_of(const std::string& name) {
    const auto [entry, is_new] = layer_at_.try_emplace(name, run_.layers.size());
    if (is_new) run_.layers.push_back({name});
    return run_.layers[entry->second];
  }

  void add_reason(const std::string& decision, const ReasonKind& kind) {
    const std::pair key{decision, kind.words};
    const auto [entry, is_new] = reason_at_.try_emplace(key, run_.reasons.size());
    if (is_new) run_.reasons.push_back({decision, kind.words, kind.unit});
    ++run_.reasons[entry->second].times;
    std::vector<double>& values = values_[key];
    values.insert(values.end(), kind.values.begin(), kind.values.end());
  }

  void add_worst(const WorstDecision& decision) {
    const auto is_worse = [](const WorstDecision& a, const WorstDecision& b) {
      return a.geometric_px > b.geometric_px;
    };
    std::vector<WorstDecision>& worst = run_.worst;
    if (decision.geometric_px <= 0) return;
    if (worst.size() == ReportRun::kWorst && !is_worse(decision, worst.back())) return;
    worst.insert(std::upper_bound(worst.begin(), worst.end(), decision, is_worse), decision);
    if (worst.size() > ReportRun::kWorst) worst.pop_back();
  }

  ReportRun& run_;
  std::map<std::string, std::size_t> layer_at_;
  std::map<std::pair<std::string, std::string>, std::size_t> reason_at_;
  std::map<std::pair<std::string, std::string>, std::vector<double>> values_;
};

/// Empty where nothing is shown, or a corner lies behind the viewer.
std::optional<SpriteOutline> outline_of(const PackedTable& table, const std::vector<Cell>& row) {
  const auto at = [&](const char* name, double otherwise) {
    const double value = cell_number(table.cell(row, name));
    return std::isnan(value) ? otherwise : value;
  };
  SpriteOutline outline{cell_word(table.cell(row, "layer"))};
  const double width = at("sprite_width", 0), height = at("sprite_height", 0);
  if (width <= 0 || height <= 0 || cell_word(table.cell(row, "decision")) == "drop") return std::nullopt;
  for (int k = 0; k < 4; ++k) {
    const double u = k == 1 || k == 2 ? width : 0, v = k >= 2 ? height : 0;
    const double x = at("sprite_xx", 1) * u + at("sprite_xy", 0) * v + at("sprite_x", 0);
    const double y = at("sprite_yx", 0) * u + at("sprite_yy", 1) * v + at("sprite_y", 0);
    const double w = at("warp_wx", 0) * x + at("warp_wy", 0) * y + at("warp_w", 1);
    outline.x[k] = (at("warp_xx", 1) * x + at("warp_xy", 0) * y + at("warp_x", 0)) / w;
    outline.y[k] = (at("warp_yx", 0) * x + at("warp_yy", 1) * y + at("warp_y", 0)) / w;
    if (w <= 0 || !std::isfinite(outline.x[k]) || !std::isfinite(outline.y[k])) return std::nullopt;
  }
  const bool is_fresh = cell_word(table.cell(row, "decision")) == "rerender";
  outline.age_frames = is_fresh ? 0 : at("frames_since_render", 0);
  return outline;
}

/// Keeps the outlines of the last frame that is not after `wanted`.
void keep_still(Still& still, int wanted, const PackedTable& table, const std::vector<Cell>& row) {
  const int frame = static_cast<int>(cell_or_0(table.cell(row, "frame")));
  if (frame > wanted && still.frame >= 0) return;
  if (frame != still.frame) still = {frame};
  if (std::optional<SpriteOutline> outline = outline_of(table, row))
    still.outlines.push_back(std::move(*outline));
}

/// The frame of the picture in the middle, or that in the middle of the run.
int frame_to_look_at(const ReportRun& run) {
  if (!run.thumbnails.empty()) return run.thumbnails[run.thumbnails.size() / 2].frame;
  const auto frames = run.run.find("frames");
  if (frames == run.run.end() || !frames->is_array() || frames->size() != 2) return 0;
  return ((*frames)[0].get<int>() + (*frames)[1].get<int>()) / 2;
}

/// `columns`: of decisions.jsonl.
void read_decisions(ReportRun& run, const std::vector<ColumnInfo>& columns) {
  const int wanted = frame_to_look_at(run);
  const std::string file = file_of_lines(run.folder, "decisions.jsonl");
  if (file.empty()) return;
  DecisionTally tally(run);
  ChangesBeside changes(file_of_lines(run.folder, "changes.jsonl"));
  run.has_changes = changes.is_there();
  for_each_line_of(file, columns, decision_table().schema, [&](const std::vector<Cell>& decision) {
    std::vector<Cell> row = decision;
    changes.append_to(row, static_cast<int>(cell_or_0(run.decisions.cell(row, "frame"))),
                      cell_word(run.decisions.cell(row, "layer")));
    run.decisions.add(row);
    tally.add(row);
    keep_still(run.still, wanted, run.decisions, row);
  });
  tally.finish();
}

/// What drawing all that `reference` draws would take on talisman-1996; texels are filled `depth` times.
double reference_ms(double polygons, double pixels, double depth) {
  const double filled = pixels * (std::isnan(depth) ? 1 : depth);
  return regulator::modelled_time(regulator::talisman_1996(), std::llround(polygons), std::llround(filled), 0)
      .render_ms;
}

void add_to_sums(FrameSums& sums, const PackedTable& table, const std::vector<Cell>& row) {
  const auto at = [&](const char* name) { return table.cell(row, name); };
  const int frame = static_cast<int>(cell_or_0(at("frame")));
  ++sums.frames;
  sums.first = sums.first < 0 ? frame : std::min(sums.first, frame);
  sums.last = std::max(sums.last, frame);
  sums.polygons += cell_or_0(at("polygons_rendered"));
  sums.polygons_reference += cell_or_0(at("polygons_reference"));
  sums.pixels += cell_or_0(at("pixels_rendered"));
  sums.pixels_reference += cell_or_0(at("pixels_reference"));
  sums.modelled_ms += cell_or_0(at("modelled_ms"));
  sums.modelled_drawing_ms += cell_or_0(at("modelled_drawing_ms"));
  sums.modelled_reference_ms +=
      reference_ms(cell_or_0(at("polygons_reference")), cell_or_0(at("pixels_reference")),
                   cell_number(at("depth_complexity")));
  if (const double flip = cell_number(at("quality_total_flip"));
      !std::isnan(flip) && (!sums.largest_flip || flip > *sums.largest_flip)) {
    sums.largest_flip = flip;
    sums.frame_of_flip = frame;
  }
  if (const double psnr = cell_number(at("quality_total_psnr_db")); !std::isnan(psnr))
    sums.lowest_psnr_db = std::min(psnr, sums.lowest_psnr_db.value_or(psnr));
}

void read_frames(ReportRun& run, const std::vector<ColumnInfo>& columns) {
  const std::string file = file_of_lines(run.folder, "frames.jsonl");
  if (file.empty()) return;
  for_each_line_of(file, columns, frame_table().schema, [&](const std::vector<Cell>& row) {
    run.frames.add(row);
    add_to_sums(run.sums, run.frames, row);
  });
}

void read_timing(ReportRun& run, const std::vector<ColumnInfo>& columns) {
  const std::string file = file_of_lines(run.folder, "timing.jsonl");
  if (file.empty()) return;
  for_each_line_of(
      file, columns, timing_table().schema, [&](const std::vector<Cell>& row) { run.timing.add(row); },
      [&](const std::string& text) {
        Json json = Json::parse(text, nullptr, false);
        if (json.is_object() && text_in(json, "schema") == "talisman.timing_total/1")
          run.timing_total = std::move(json);
      });
}

/// What decides comes first: what would not fit is left out from the end of that order.
void leave_out_what_is_too_much(ReportRun& run) {
  const std::vector<std::string> first = {"layer",           "frame",
                                          "decision",        "reason",
                                          "geometric_px",    "frames_since_render",
                                          "cost_polygons",   "cost_pixels",
                                          "cost_chunks",     "cost_bytes",
                                          "depicts_frame",   "warp_geometric_px",
                                          "resolution",      "geometric_weight",
                                          "uncovered_px",    "turned_px",
                                          "shade_px",        "photometric_color",
                                          "light_angle_rad", "since_frame",
                                          "camera_px",       "own_motion_px",
                                          "light_px",        "other_layers_px",
                                          "separable",       "error_px",
                                          "sprite_xx",       "sprite_xy",
                                          "sprite_x",        "sprite_yx",
                                          "sprite_yy",       "sprite_y",
                                          "sprite_width",    "sprite_height",
                                          "warp_x",          "warp_y",
                                          "warp_xx",         "warp_xy",
                                          "warp_yx",         "warp_yy",
                                          "warp_wx",         "warp_wy",
                                          "warp_w",          "magnification",
                                          "minification",    "anisotropy"};
  const auto rank = [&](const std::string& name) {
    return std::find(first.begin(), first.end(), name) - first.begin();
  };
  std::vector<PackedField*> fields;
  for (PackedField& field : run.decisions.fields())
    if (field.packed) fields.push_back(&field);
  std::stable_sort(fields.begin(), fields.end(),
                   [&](const auto* a, const auto* b) { return rank(a->info.name) < rank(b->info.name); });
  std::size_t sum = 0;
  for (PackedField* field : fields) {
    const std::size_t size = field->packed->finish().size();
    if (sum + size > kMostBytes) {
      run.left_out.push_back(field->info.name);
      field->packed.reset();
    } else {
      sum += size;
    }
  }
}

}  // namespace

ReportRun read_report_run(const std::string& folder, bool thumbnails) {
  const std::vector<ColumnInfo> decisions = columns_of_page(flat_columns(decision_table())),
                                frames = columns_of_page(flat_columns(frame_table())),
                                timing = columns_of_page(flat_columns(timing_table()));
  std::vector<ColumnInfo> of_page = decisions;
  for (const ColumnInfo& column : ChangesBeside::columns_beside()) of_page.push_back(column);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError("is no folder, must be that of a render or a plan", folder);
  ReportRun run{folder,
                file_as_json(folder + "/run.json"),
                file_as_json(folder + "/summary.json"),
                nullptr,
                file_as_json(folder + "/what-if.json"),
                false,
                PackedTable(std::move(of_page), "layer"),
                PackedTable(frames),
                PackedTable(timing)};
  if (!run.run.is_object() || text_in(run.run, "schema").rfind("talisman.run/", 0) != 0 ||
      !run.run.contains("settings") || !run.run["settings"].is_object())
    throw InputError("holds no run (no run.json of ours), must be the folder of a render or a plan", folder);
  require_all_decisions(run.run, folder, "a report");
  const bool is_partial = fs::exists(folder + "/decisions.jsonl.partial", error);
  run.is_complete = run.summary.is_object() && !is_partial;
  if (!run.is_complete) run.summary = nullptr;
  if (thumbnails && text_in(run.run, "kind") == "render") run.thumbnails = thumbnails_of(folder);
  read_decisions(run, decisions);
  read_frames(run, frames);
  read_timing(run, timing);
  leave_out_what_is_too_much(run);
  return run;
}

}  // namespace talisman::sequences
