// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/report.h"

#include <algorithm>

#include "sequences/files/atomic_file.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/pictures/page_text.h"
#include "sequences/pictures/scatter.h"
#include "sequences/results/json_text.h"
#include "sequences/results/reason_kind.h"
#include "sequences/results/report/verdict.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Rows that a table has without JavaScript; the instrument has all of them.
constexpr std::size_t kMostRows = 200;

double number_in(const Json& json, const char* key) {
  const auto value = json.find(key);
  return value != json.end() && value->is_number() ? value->get<double>() : 0;
}

std::string page_name(const ReportRun& run) {
  return text_in(run.run, "sequence") + (text_in(run.run, "kind") == "plan" ? " (plan)" : "");
}

std::string data_url(const Thumbnail& thumbnail) { return "data:image/png;base64," + base64(thumbnail.png); }

/// The picture of that frame or of the last one before it; null: there is none.
const Thumbnail* thumbnail_at(const ReportRun& run, int frame) {
  const Thumbnail* best = nullptr;
  for (const Thumbnail& thumbnail : run.thumbnails)
    if (thumbnail.frame <= frame) best = &thumbnail;
  return best;
}

std::string still_svg(const ReportRun& run) {
  const Json& settings = run.run["settings"];
  const auto size = settings.find("display_px");
  if (size == settings.end() || !size->is_array() || size->size() != 2 || run.still.frame < 0) return {};
  const std::string width = (*size)[0].dump(), height = (*size)[1].dump();
  std::string svg = "<figure id=\"still\"><svg viewBox=\"0 0 " + width + " " + height +
                    "\" role=\"img\" aria-label=\"frame " + std::to_string(run.still.frame) +
                    " with the outlines of its sprites\">\n<rect width=\"" + width + "\" height=\"" + height +
                    "\" class=\"display\"/>\n";
  const Thumbnail* picture = thumbnail_at(run, run.still.frame);
  if (picture && picture->frame == run.still.frame)
    svg += "<image href=\"" + data_url(*picture) + "\" width=\"" + width + "\" height=\"" + height + "\"/>\n";
  for (const SpriteOutline& outline : run.still.outlines) {
    std::string points;
    for (int k = 0; k < 4; ++k) points += formatted("%.2f,%.2f ", outline.x[k], outline.y[k]);
    svg += "<polygon class=\"" + std::string(outline.age_frames > 0 ? "old" : "fresh") + "\" points=\"" +
           points + "\"><title>" + escaped(outline.layer) + "</title></polygon>\n";
  }
  return svg + "</svg>\n<figcaption>Frame " + std::to_string(run.still.frame) +
         ": solid outlines were drawn for it, dashed ones are older sprites, warped.</figcaption></figure>\n";
}

/// A table of a run; with a suffix it is one of two, and its name says so.
std::string table_of_run(const std::string& id, const std::string& suffix, const std::string& caption,
                         const std::vector<std::string>& header,
                         const std::vector<std::vector<std::string>>& rows, int text_columns) {
  const std::string label = suffix.empty() ? "" : caption + ", run " + (suffix == "-a" ? "A" : "B");
  return html_table(id + suffix, caption, header, rows, text_columns, label);
}

std::string layers_table(const ReportRun& run, const std::string& suffix) {
  std::vector<const LayerCounts*> layers;
  for (const LayerCounts& layer : run.layers) layers.push_back(&layer);
  std::stable_sort(layers.begin(), layers.end(), [](auto* a, auto* b) { return a->pixels > b->pixels; });
  const int frames = std::max(1, run.sums.frames);
  std::vector<std::vector<std::string>> rows;
  for (const LayerCounts* layer : layers) {
    if (rows.size() == kMostRows) break;
    const int shown = layer->renders + layer->reuses;
    std::string why;
    int most = 0;
    for (const auto& [words, times] : layer->why)
      if (times > most) why = words, most = times;
    rows.push_back({escaped(layer->name), escaped(why), std::to_string(layer->renders),
                    std::to_string(layer->reuses), number_element(100.0 * layer->renders / frames, 1),
                    large(layer->polygons), large(layer->pixels),
                    number_element(shown > 0 ? layer->sum_geometric_px / shown : 0),
                    number_element(layer->max_geometric_px),
                    layer->frame_of_max >= 0 ? std::to_string(layer->frame_of_max) : ""});
  }
  std::string caption = "Layers, the most expensive first";
  if (layers.size() > kMostRows) caption += formatted(": %zu of %zu", kMostRows, layers.size());
  return table_of_run("layers", suffix, caption,
                      {"layer", "mostly drawn for", "renders", "reuses", "rate %", "polygons", "texels",
                       "mean px", "max px", "in frame"},
                      rows, 2);
}

std::string reasons_table(const ReportRun& run, const std::string& suffix) {
  std::vector<std::vector<std::string>> rows;
  for (const ReasonCounts& reason : run.reasons) {
    if (rows.size() == kMostRows) break;
    rows.push_back({escaped(reason.decision), escaped(reason.words), std::to_string(reason.times),
                    reason.median ? number_element(*reason.median) + " " + escaped(reason.unit) : ""});
  }
  return table_of_run("reasons", suffix, "Reasons, the most frequent first",
                      {"decision", "reason", "times", "median value"}, rows, 2);
}

std::string worst_table(const ReportRun& run, const std::string& suffix) {
  std::vector<std::vector<std::string>> rows;
  for (const WorstDecision& worst : run.worst) {
    rows.push_back({escaped(worst.layer), escaped(worst.decision), escaped(worst.reason),
                    "<a href=\"#frame=" + std::to_string(worst.frame) + "&amp;layer=" +
                        escaped(url_encoded(worst.layer)) + "\">" + std::to_string(worst.frame) + "</a>",
                    number_element(worst.geometric_px, 4)});
  }
  return table_of_run("worst", suffix, "The worst decisions: what is displayed is farthest from its place",
                      {"layer", "decision", "reason", "frame", "error px"}, rows, 3);
}

/// The plans at other thresholds, the run itself among them; empty: there are none.
std::vector<Json> what_if_plans_of(const ReportRun& run) {
  const bool is_there =
      run.what_if.is_object() && run.what_if.contains("plans") && run.what_if["plans"].is_array();
  return is_there ? run.what_if["plans"].get<std::vector<Json>>() : std::vector<Json>();
}

/// "Another threshold: at 2 px 66.1 ms a frame for drawing (+24 %), …". Empty: not known.
std::string what_if_words(const ReportRun& run) {
  constexpr const char* kCost = "modelled_drawing_ms";
  double own_ms = 0;
  for (const Json& plan : what_if_plans_of(run))
    if (number_in(plan, "factor") == 1) own_ms = number_in(plan, kCost);
  std::string words;
  for (const Json& plan : what_if_plans_of(run)) {
    const double ms = number_in(plan, kCost);
    if (own_ms > 0 && number_in(plan, "factor") != 1)
      words += formatted("%s %.4g px %.3g ms a frame for drawing (%+.0f %%)", words.empty() ? "at" : ", at",
                         number_in(plan, "geometric_px"), ms, 100 * (ms / own_ms - 1));
  }
  return words.empty() ? words : "Another threshold, as planned: " + words;
}

std::string what_if_table(const ReportRun& run, const std::string& suffix) {
  const std::vector<Json> plans = what_if_plans_of(run);
  if (plans.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  for (const Json& plan : plans) {
    const auto number = [&](const char* key) { return number_in(plan, key); };
    rows.push_back({formatted("%.4g px", number("geometric_px")), formatted("%.4g ×", number("factor")),
                    number_element(100 * number("mean_update_rate"), 1), large(number("polygons_rendered")),
                    large(number("pixels_rendered")), number_element(number("modelled_drawing_ms")),
                    number_element(number("max_geometric_px"))});
  }
  return table_of_run(
      "what-if", suffix, "What would another threshold cost? Planned with the same sequence",
      {"threshold", "of this run's", "rate %", "polygons", "texels", "modelled drawing ms", "max px"}, rows,
      1);
}

/// Each run, and what other thresholds would make of it; empty where that is one point alone.
std::string cost_against_error(const std::vector<ReportRun>& runs) {
  ScatterPicture scatter{"Cost against error: what was chosen, and half and twice the threshold",
                         "modelled drawing, ms a frame",
                         "largest geometric error, px",
                         {}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const ReportRun& run = runs[k];
    const std::string name = runs.size() > 1 ? std::string(1, static_cast<char>('A' + k)) + ": " : "";
    const int series = static_cast<int>(k);
    const std::vector<Json> plans = what_if_plans_of(run);
    if (!plans.empty())
      for (const Json& plan : plans)
        scatter.points.push_back({number_in(plan, "modelled_drawing_ms"), number_in(plan, "max_geometric_px"),
                                  series, name + formatted("%.4g px", number_in(plan, "geometric_px"))});
    else if (run.sums.frames > 0)
      scatter.points.push_back({run.sums.modelled_drawing_ms / run.sums.frames,
                                run.worst.empty() ? 0 : run.worst[0].geometric_px, series,
                                name + page_name(run)});
  }
  if (!runs.empty() && runs[0].sums.frames > 0)
    scatter.points.push_back({runs[0].sums.modelled_reference_ms / runs[0].sums.frames, 0, 2, "reference"});
  if (scatter.points.size() < 3) return {};
  return "<figure id=\"cost-error\">\n" + svg(scatter) + "<figcaption>" + escaped(scatter.caption) +
         "</figcaption></figure>\n";
}

/// Of a run with --audit: what the fiducials said, and what the pictures say.
std::string audit_table_of(const ReportRun& run, const std::string& suffix) {
  if (!run.summary.is_object() || !run.summary.contains("audit") || !run.summary["audit"].is_array())
    return {};
  std::vector<std::vector<std::string>> rows;
  for (const Json& layer : run.summary["audit"]) {
    if (!layer.is_object() || rows.size() == kMostRows) continue;
    const auto cell = [&](const char* key) -> std::string {
      const auto value = layer.find(key);
      if (value == layer.end()) return {};
      if (value->is_number_integer()) return std::to_string(value->get<std::int64_t>());
      return value->is_number()   ? number_element(value->get<double>(), 3)
             : value->is_string() ? escaped(value->get<std::string>())
                                  : "";
    };
    const std::string sheet = cell("sheet"), name = cell("layer");
    rows.push_back({sheet.empty()
                        ? name
                        : "<a href=\"audit/" + escaped(url_encoded(layer["sheet"].get<std::string>())) +
                              "\">" + name + "</a>",
                    layer.value("marked", false) ? "marked" : "", cell("should_have_spoken"), cell("reuses"),
                    cell("audited"), cell("beyond"), cell("worst_frame"), cell("geometric_px"),
                    cell("shift_p95_px"), cell("photometric"), cell("rms")});
  }
  return table_of_run("audit", suffix,
                      "Audit: did the fiducials tell the truth? Of each layer the worst audited frame",
                      {"layer", "", "should have spoken", "reuses", "audited", "beyond", "in frame",
                       "said px", "seen px", "said light", "seen light"},
                      rows, 3);
}

/// Layers that one of two runs has and the other has not.
std::string unmatched_table(const std::vector<ReportRun>& runs) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < 2; ++k)
    for (const LayerCounts& layer : runs[k].layers) {
      const auto& others = runs[1 - k].layers;
      const bool is_there = std::any_of(others.begin(), others.end(),
                                        [&](const LayerCounts& other) { return other.name == layer.name; });
      if (!is_there)
        rows.push_back(
            {escaped(layer.name), k == 0 ? "A" : "B", std::to_string(layer.renders), large(layer.pixels)});
    }
  const std::size_t all = rows.size();
  rows.resize(std::min(all, kMostRows));
  if (rows.empty()) return {};
  return html_table("unmatched", "Layers of one run alone: " + std::to_string(all),
                    {"layer", "run", "renders", "texels"}, rows, 2);
}

std::string run_section(const ReportRun& run, const std::string& suffix, const std::string& heading) {
  std::string text = "<section class=\"run\" aria-label=\"" + escaped(heading) + "\">\n";
  if (!suffix.empty()) text += "<h2>" + escaped(heading) + "</h2>\n";
  text += "<p class=\"facts\">" + escaped(what_ran(run)) + "</p>\n<p class=\"verdict\" id=\"verdict" +
          suffix + "\">" + escaped(verdict_on(run)) + "</p>\n";
  if (const std::string words = what_if_words(run); !words.empty())
    text +=
        "<p class=\"facts\">" + escaped(words) + ". <a href=\"#what-if" + suffix + "\">The table.</a></p>\n";
  if (const std::string times = measured_times(run); !times.empty())
    text += "<p class=\"measured\">Measured with a clock, on one machine: " + escaped(times) + ".</p>\n";
  if (!run.left_out.empty()) {
    text += "<p class=\"note\">Not in this page for its size, but in decisions.jsonl:";
    for (const std::string& name : run.left_out) text += " " + escaped(name);
    text += ".</p>\n";
  }
  return text + "</section>\n";
}

std::string run_tables(const ReportRun& run, const std::string& suffix, const std::string& heading) {
  const std::string title = suffix.empty() ? "" : "<h2>" + escaped(heading) + "</h2>\n";
  return title + what_if_table(run, suffix) + layers_table(run, suffix) + reasons_table(run, suffix) +
         worst_table(run, suffix) + audit_table_of(run, suffix);
}

Json page_json(PackedTable& table, const std::string& prefix, std::string& scripts) {
  Json json = {{"rows", table.rows()}, {"columns", Json::array()}};
  for (PackedField& field : table.fields()) {
    Json column = {{"name", field.info.name}, {"unit", field.info.unit}, {"meaning", field.info.meaning}};
    if (field.packed) {
      const std::string id = prefix + "-" + field.info.name;
      column["data"] = id;
      scripts +=
          "<script type=\"text/plain\" id=\"" + id + "\">" + base64(field.packed->finish()) + "</script>\n";
    }
    if (field.is_words) {
      column["words"] = field.words;
      if (field.info.name == "reason") {
        column["numbers"] = table.reason_numbers();
        column["kinds"] = Json::array();
        for (const std::string& reason : field.words) {
          std::string plain = reason;  // any number will do where one stood
          for (std::size_t at; (at = plain.find('\x01')) != std::string::npos;) plain.replace(at, 2, "0");
          column["kinds"].push_back(kind_of_reason(plain).words);
        }
      }
    }
    json["columns"].push_back(std::move(column));
  }
  return json;
}

Json page_json(ReportRun& run, const std::string& prefix, std::string& scripts) {
  Json pictures = Json::array();
  for (const Thumbnail& thumbnail : run.thumbnails)
    pictures.push_back({{"frame", thumbnail.frame}, {"src", data_url(thumbnail)}});
  Json layers = Json::array();
  for (const LayerCounts& layer : run.layers)
    layers.push_back(
        {{"name", layer.name},
         {"renders", layer.renders},
         {"reuses", layer.reuses},
         {"polygons", layer.polygons},
         {"pixels", layer.pixels},
         {"mean_px",
          layer.renders + layer.reuses > 0 ? layer.sum_geometric_px / (layer.renders + layer.reuses) : 0},
         {"max_px", layer.max_geometric_px}});
  return {{"name", page_name(run)},
          {"folder", run.folder},
          {"what", what_ran(run)},
          {"complete", run.is_complete},
          {"changes", run.has_changes},
          {"run", run.run},
          {"layers", std::move(layers)},
          {"worst", run.worst.empty() ? Json(nullptr)
                                      : Json{{"frame", run.worst[0].frame}, {"layer", run.worst[0].layer}}},
          {"still", run.still.frame},
          {"pictures", std::move(pictures)},
          {"decisions", page_json(run.decisions, prefix + "d", scripts)},
          {"frames", page_json(run.frames, prefix + "f", scripts)},
          {"timing", page_json(run.timing, prefix + "t", scripts)}};
}

}  // namespace

std::string report_html(std::vector<ReportRun>& runs) {
  if (!has_report()) throw OutputError("this build has no report, rule: TALISMAN_REPORT=ON");
  std::string title, head, tables, scripts;
  Json data = {{"schema", "talisman.report/1"}, {"runs", Json::array()}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string suffix = runs.size() > 1 ? std::string("-") + static_cast<char>('a' + k) : "";
    const std::string heading = runs.size() > 1
                                    ? std::string(1, static_cast<char>('A' + k)) + ": " + runs[k].folder
                                    : page_name(runs[k]);
    title += (k > 0 ? " | " : "") + page_name(runs[k]);
    head += run_section(runs[k], suffix, heading);
    tables += run_tables(runs[k], suffix, heading);
    data["runs"].push_back(page_json(runs[k], std::string(1, static_cast<char>('a' + k)), scripts));
  }
  if (runs.size() == 2) tables = unmatched_table(runs) + tables;
  tables = cost_against_error(runs) + tables;
  const auto asset = [](const char* name) { return std::string(page_asset(name)); };
  return filled(page_asset("page.html"), {{"title", escaped(title)},
                                          {"css", asset("page.css") + asset("dygraph.css")},
                                          {"head", head},
                                          {"still", runs.empty() ? "" : still_svg(runs[0])},
                                          {"tables", tables},
                                          {"data", json_in_script(data)},
                                          {"columns", scripts},
                                          {"library", asset("dygraph.js")},
                                          {"script", asset("page.js") + asset("report.js")}});
}

std::string write_report(const std::vector<std::string>& folders, const std::string& file, bool thumbnails) {
  if (!has_report()) throw OutputError("this build has no report, rule: TALISMAN_REPORT=ON");
  std::vector<ReportRun> runs;
  for (const std::string& folder : folders) runs.push_back(read_report_run(folder, thumbnails));
  std::string path = file.empty() ? folders.front() + "/report.html" : file;
  write_text_atomically(path, report_html(runs));
  return path;
}

}  // namespace talisman::sequences
