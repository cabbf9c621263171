// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/verdict.h"

#include "sequences/files/number_text.h"
#include "sequences/pictures/page_text.h"
#include "sequences/results/json_text.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

std::string setting_word(const Json& json, const char* key) {
  const auto value = json.find(key);
  return value != json.end() && value->is_string() ? value->get<std::string>() : std::string();
}

double setting_number(const Json& json, const char* key) {
  const auto value = json.find(key);
  return value != json.end() && value->is_number() ? value->get<double>() : 0;
}

std::string drawn_of(double part, double whole, const char* unit) {
  return large(part) + " of " + large(whole) + " " + unit + " (" + percent_of(part, whole) + " %)";
}

/// What was seen in the pictures.
std::string picture_error(const ReportRun& run) {
  std::string text = "picture error not measured";
  if (run.sums.largest_flip)
    text = formatted("largest picture error FLIP %.4f in frame %d", *run.sums.largest_flip,
                     run.sums.frame_of_flip) +
           (run.sums.lowest_psnr_db ? formatted(", lowest PSNR %.1f dB", *run.sums.lowest_psnr_db) : "");
  const auto audit = run.summary.find("audit");
  if (!run.summary.is_object() || audit == run.summary.end() || !audit->is_array()) return text;
  std::string marked;
  for (const Json& layer : *audit)
    if (layer.is_object() && layer.contains("marked") && layer["marked"] == true)
      marked += (marked.empty() ? "" : ", ") + setting_word(layer, "layer");
  return text + (marked.empty() ? "; the audit marks no layer" : "; the audit marks " + marked);
}

/// The layer that takes most texels; nothing where nothing is drawn.
std::string dearest_layer(const ReportRun& run) {
  const LayerCounts* dearest = nullptr;
  double all = 0;
  for (const LayerCounts& layer : run.layers) {
    all += layer.pixels;
    if (!dearest || layer.pixels > dearest->pixels) dearest = &layer;
  }
  return dearest && all > 0 ? "; " + dearest->name + " is the most expensive layer, " +
                                  percent_of(dearest->pixels, all) + " % of these texels"
                            : std::string();
}

/// A plan knows what drawing takes, and no more; so it is with what `reference` would draw.
std::string modelled_ms(const ReportRun& run) {
  const FrameSums& sums = run.sums;
  const std::string drawing =
      formatted("%.3g ms for drawing (reference %.3g ms)", sums.modelled_drawing_ms / sums.frames,
                sums.modelled_reference_ms / sums.frames);
  if (text_in(run.run, "kind") == "plan") return "modelled " + drawing + " a frame";
  return formatted("modelled %.3g ms a frame as drawn; as planned, ", sums.modelled_ms / sums.frames) +
         drawing;
}

}  // namespace

std::string what_ran(const ReportRun& run) {
  const Json& settings = run.run["settings"];
  const std::string kind = setting_word(run.run, "kind");
  std::string text = (kind.empty() ? "run" : kind) + " of " + setting_word(run.run, "sequence");
  if (const auto frames = run.run.find("frames");
      frames != run.run.end() && frames->is_array() && frames->size() == 2)
    text += ", frames " + (*frames)[0].dump() + " to " + (*frames)[1].dump();
  if (const auto size = settings.find("display_px");
      size != settings.end() && size->is_array() && size->size() == 2)
    text += ", " + (*size)[0].dump() + " × " + (*size)[1].dump() + " px";
  const std::string policy = setting_word(settings, "policy");
  text += ", policy " + policy;
  if (policy == "threshold" || policy == "lookahead" || policy == "oracle")
    text += formatted(" at %.4g px", setting_number(settings, "geometric_px"));
  return text + ", warp " + setting_word(settings, "warp") + ", talisman " + setting_word(run.run, "version");
}

std::string verdict_on(const ReportRun& run) {
  const FrameSums& sums = run.sums;
  if (sums.frames == 0) return "No frame is complete yet.";
  std::string text = text_in(run.run, "kind") == "plan" ? "Would draw " : "Drew ";
  text += drawn_of(sums.polygons, sums.polygons_reference, "polygons") + " and " +
          drawn_of(sums.pixels, sums.pixels_reference, "texels") + " of what reference draws, " +
          modelled_ms(run);
  const WorstDecision* worst = run.worst.empty() ? nullptr : run.worst.data();
  text += dearest_layer(run);
  text += worst ? formatted("; largest error of a fiducial %.4g px", worst->geometric_px) + " (" +
                      worst->layer + ", frame " + std::to_string(worst->frame) + ")"
                : std::string("; no fiducial says an error");
  text += "; " + picture_error(run) + ".";
  if (!run.is_complete) text = "Not complete: " + std::to_string(sums.frames) + " frames so far. " + text;
  return text;
}

std::string measured_times(const ReportRun& run) {
  if (!run.timing_total.is_object()) return {};
  const auto wall = run.timing_total.find("wall_ms");
  if (wall == run.timing_total.end() || !wall->is_object()) return {};
  std::string text;
  for (const auto& [stage, ms] : wall->items())
    if (ms.is_number())
      text += (text.empty() ? "" : ", ") + stage + formatted(" %.3g s", ms.get<double>() / 1000);
  return text;
}

}  // namespace talisman::sequences
