// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/explained_frame.h"

#include <algorithm>
#include <cmath>

#include "sequences/pictures/picture_sheet.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/layer_alone.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

void add_lines(const PipelineState& state, const FrameReport& report, DecisionHistory& history) {
  for (const DecisionRow& row : decision_rows(state, report)) history.add(Json::parse(json_of(row)));
}

/// The id of a layer or aggregate; -1: there is none of the name now.
int id_of(const LayerTable& layers, const std::string& name) {
  for (std::size_t id = 0; id < layers.size(); ++id)
    if (layers[static_cast<int>(id)].name == name) return static_cast<int>(id);
  return -1;
}

/// A sprite with where it lies.
struct KeptSprite {
  chunker::Sprite sprite;
  layers::dmat3 screen_from_sprite;
};

/// The sprite that the layer has before a frame is planned.
std::optional<KeptSprite> kept_sprite(const PipelineState& state, const std::string& layer) {
  const int id = id_of(state.layers, layer);
  const chunker::Sprite* sprite = id < 0 ? nullptr : state.sprites.find(id);
  if (!sprite || !state.memory[id].drawn) return std::nullopt;
  return KeptSprite{*sprite, layers::to_mat3(state.memory[id].placement.screen_from_sprite)};
}

/// As the frame shows the old sprite, or would have shown it had it not been drawn again.
chunker::Frame old_alone(const Pipeline& pipeline, const FrameReport& report, int layer,
                         const KeptSprite& kept) {
  const regulator::LayerDecision& decision = report.plan.decisions[layer];
  const regulator::LayerAssessment& assessed = report.assessments[layer];
  const bool is_shown = decision.action == regulator::Action::Reuse;
  const warp::Warp& warp = is_shown ? decision.shown_warp : assessed.fitted.warp;
  SpriteMultipliers multipliers = multipliers_at(report.layers[layer], time_of(pipeline, report.frame));
  multipliers.color *=
      layers::vec3(is_shown ? decision.shown_color : assessed.fiducials.photometric.multiplier);
  return shown_alone(kept.sprite, warp.now_from_then * kept.screen_from_sprite, multipliers,
                     report.layers[layer], pipeline.settings.view.display_px);
}

/// Plans the frame and draws the layer.
FrameReport look_at(const Pipeline& pipeline, PipelineState& state, int frame, const std::string& layer,
                    const chunker::PreparedScene& prepared, ExplainedFrame& explained) {
  const std::optional<KeptSprite> kept = kept_sprite(state, layer);
  FrameReport report = step(pipeline, state, frame, &prepared);
  const int id = id_of(report.layers, layer);
  const bool has_line = id >= 0 && report.plan.decisions[id].action != regulator::Action::Drop;
  if (has_line && kept && report.assessments[id].has_sprite)
    explained.pictures = {old_alone(pipeline, report, id, *kept),
                          fresh_alone(pipeline, state, report, id, prepared)};
  return report;
}

/// The picture's part in which either frame has something, grown by a border; the whole where nothing is.
Crop box_of(const LayerPictures& pictures) {
  constexpr int kBorder_px = 8;
  const chunker::Frame& a = pictures.old;
  int x0 = a.width, y0 = a.height, x1 = -1, y1 = -1;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x);
      if (a.pixels[at].a == 0 && pictures.fresh.pixels[at].a == 0) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  if (x1 < 0) return {0, 0, a.width, a.height};
  x0 = std::max(0, x0 - kBorder_px), y0 = std::max(0, y0 - kBorder_px);
  x1 = std::min(a.width - 1, x1 + kBorder_px), y1 = std::min(a.height - 1, y1 + kBorder_px);
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

/// At most `most` wide and high, of a box, around a place.
Crop cut_around(const Crop& box, layers::dvec2 place, int most) {
  Crop crop = box;
  const auto cut = [most](int& from, int& size, double middle) {
    if (size <= most) return;
    const int wanted = static_cast<int>(std::lround(middle)) - most / 2;
    from = std::clamp(wanted, from, from + size - most);
    size = most;
  };
  cut(crop.x, crop.width, place.x);
  cut(crop.y, crop.height, place.y);
  return crop;
}

/// A cross that leaves the place itself free.
void mark(Image8& image, layers::dvec2 place) {
  constexpr Rgb kMark{255, 40, 200};
  constexpr double kInner_px = 5, kOuter_px = 14;
  for (const layers::dvec2 way : {layers::dvec2{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    draw_line(image, place + kInner_px * way, place + kOuter_px * way, kMark);
}

}  // namespace

ExplainedFrame explained_frame(const Sequence& sequence, const Settings& settings, int frame,
                               const std::string& layer) {
  ExplainedFrame explained;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  std::optional<chunker::PreparedScene> prepared;
  if (!layer.empty()) prepared.emplace(*sequence.scene, settings.render);
  DecisionHistory history(frame);
  for (int k = 0; k < settings.frames && (k <= frame || !history.is_complete()); ++k) {
    const bool is_before = prepared && k == frame - 1;
    const FrameReport report = prepared && k == frame
                                   ? look_at(pipeline, state, k, layer, *prepared, explained)
                                   : step(pipeline, state, k, is_before ? &*prepared : nullptr);
    add_lines(state, report, history);
    explained.last_planned = k;
  }
  explained.layers = history.layers();
  return explained;
}

ExplainedFrame explained_folder(const std::string& folder, int frame, Json& settings) {
  const Json run = finished_run(folder);
  require_all_decisions(run, folder, "explain");
  settings = run["settings"];
  DecisionHistory history(frame);
  for (const Json& line : finished_decisions(folder)) history.add(line);
  ExplainedFrame explained;
  explained.layers = history.layers();
  explained.last_planned = history.last_frame();
  if (explained.layers.empty())
    throw InputError(
        "has no frame " + std::to_string(frame) + ", the last one is " + std::to_string(history.last_frame()),
        folder + "/decisions.jsonl");
  return explained;
}

Image8 explanation_sheet(const std::vector<std::string>& title, const LayerPictures& pictures,
                         layers::dvec2 worst_px) {
  constexpr int kLargest_px = 360, kGain = 4;
  const Crop crop = cut_around(box_of(pictures), worst_px, kLargest_px);
  const int scale = std::max(1, kLargest_px / std::max(crop.width, crop.height));
  const layers::dvec2 place = worst_px - layers::dvec2(crop.x, crop.y);
  Image8 old = over_grey(pictures.old, crop), fresh = over_grey(pictures.fresh, crop);
  Image8 different = difference(old, fresh, kGain);
  for (Image8* image : {&old, &fresh, &different}) {
    *image = enlarged(*image, scale);
    mark(*image, static_cast<double>(scale) * place);
  }
  return sheet_of(title, {{{"old sprite"}, {old}}, {{"fresh"}, {fresh}}, {{"difference x 4"}, {different}}},
                  1);
}

}  // namespace talisman::sequences
