// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/renderer/plots.h"
#include "sequences/experiments/renderer/sheets.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"
#include "sequences/results/settings_json.h"

namespace talisman::sequences {
namespace {

using Json = nlohmann::ordered_json;

using chunker::RenderCounters;

template <std::int64_t RenderCounters::*Field>
double drawn(const Measured& m) {
  return m.per_frame(m.counters.*Field);
}

constexpr NamedValue<Measured> kMeasured[] = {
    {"renders", [](const Measured& m) { return m.per_frame(m.renders); }},
    {"polygons", [](const Measured& m) { return m.per_frame(m.polygons); }},
    {"sprite_pixels", [](const Measured& m) { return m.per_frame(m.pixels); }},
    {"pixels_filled", drawn<&RenderCounters::pixels_filled>},
    {"pixels_shaded", drawn<&RenderCounters::pixels_shaded>},
    {"fragments", drawn<&RenderCounters::fragments>},
    {"fragments_merged", drawn<&RenderCounters::fragments_merged>},
    {"texture_samples", drawn<&RenderCounters::texture_samples>},
    {"shadow_lookups", drawn<&RenderCounters::shadow_lookups>},
    {"reflection_lookups", drawn<&RenderCounters::reflection_lookups>},
    {"shadow_maps", [](const Measured& m) { return m.per_frame(m.passes.shadow_maps_drawn); }},
    {"reflections", [](const Measured& m) { return m.per_frame(m.passes.reflections_drawn); }},
    {"sprite_bytes", [](const Measured& m) { return double(m.sprite_bytes); }},
    {"shadow_map_bytes", [](const Measured& m) { return double(m.shadow_map_bytes); }},
    {"texture_bytes", [](const Measured& m) { return double(m.texture_bytes); }},
    {"modelled_ms", [](const Measured& m) { return m.modelled_ms; }},
    {"wall_plan_ms", [](const Measured& m) { return m.plan.median_ms; }},
    {"wall_render_ms", [](const Measured& m) { return m.render.median_ms; }},
    {"wall_composite_ms", [](const Measured& m) { return m.composite.median_ms; }},
    {"wall_drawn_ms", [](const Measured& m) { return m.drawn.median_ms; }},
    {"wall_cpu_ms", [](const Measured& m) { return m.cpu.median_ms; }},
    {"wall_drawn_spread_ms", [](const Measured& m) { return m.drawn.spread_ms; }},
    {"wall_cpu_spread_ms", [](const Measured& m) { return m.cpu.spread_ms; }},
};

constexpr NamedValue<PictureError> kError[] = {
    {"psnr_db", [](const PictureError& e) { return e.quality.psnr_db; }},
    {"ssim", [](const PictureError& e) { return e.quality.ssim; }},
    {"flip", [](const PictureError& e) { return e.quality.flip; }},
    {"max_difference", [](const PictureError& e) { return double(e.quality.max_difference); }},
    {"rms_code_values", [](const PictureError& e) { return e.rms_code_values; }},
};

constexpr NamedValue<RungResult> kRung[] = {
    {"alone_psnr_db", [](const RungResult& r) { return r.alone.quality.psnr_db; }},
    {"alone_flip", [](const RungResult& r) { return r.alone.quality.flip; }},
    {"work", [](const RungResult& r) { return r.work; }},
    {"work_front", [](const RungResult& r) { return double(r.work_front); }},
    {"wall_front", [](const RungResult& r) { return double(r.wall_front); }},
    {"wall_gain_db_per_cpu_ms", [](const RungResult& r) { return r.gain.db_per_ms; }},
    {"wall_gain_flip_per_cpu_ms", [](const RungResult& r) { return r.gain.flip_per_ms; }},
};

// --- JSON

Json knob_json(const RendererReport& report, std::size_t index) {
  const KnobResults& results = report.knobs;
  const Knob& knob = results.ladder.knobs[index];
  Json json = {{"knob", knob.name}, {"in_sprites", knob.in_sprites}, {"called", knob.called()}};
  if (!knob.called()) {
    json["why_not"] = knob.why_not;
    return json;
  }
  json["work_unit"] = name(knob.work);
  json["rungs"] = Json::array();
  for (const RungResult& rung : results.rungs) {
    if (rung.knob != index) continue;
    Json row = {{"rung", knob.rungs[rung.rung].label}, {"is_truth", rung.variant == kTruth}};
    put(row, kError, rung.error);
    put(row, kRung, rung);
    put(row, kMeasured, results.measured[rung.variant]);
    json["rungs"].push_back(row);
  }
  return json;
}

Json measured_json(const Measured& measured) {
  Json json = Json::object();
  put(json, kMeasured, measured);
  return json;
}

Json effect_json(const EffectResult& effect, const Measured& without) {
  Json json = {{"effect", layers::name(effect.call.effect)}, {"why", effect.call.why}};
  json["error_without"] = Json::object();
  put(json["error_without"], kError, effect.error);
  json["without"] = measured_json(without);
  return json;
}

Json effects_json(const EffectResults& effects) {
  Json frame = Json::array(), over_time = Json::array(), not_called = Json::array();
  for (const EffectResult& effect : effects.pictures)
    frame.push_back(effect_json(effect, effects.frames[effect.without]));
  for (const EffectResult& effect : effects.over_time)
    over_time.push_back(effect_json(effect, effects.runs[effect.without]));
  for (const layers::EffectCall& call : effects.not_called)
    not_called.push_back({{"effect", layers::name(call.effect)}, {"why_not", call.why}});
  Json error = Json::object();
  put(error, kError, effects.run_error);
  return {{"frame",
           {{"frames", effects.frame_load.frames},
            {"with", measured_json(effects.frames[0])},
            {"effects", frame}}},
          {"over_time",
           {{"first_frame", effects.run_load.frames.front()},
            {"last_frame", effects.run_load.frames.back()},
            {"frames_compared", effects.run_load.compared},
            {"with", measured_json(effects.runs[0])},
            {"error_with", error},
            {"effects", over_time}}},
          {"not_called", not_called}};
}

// --- Tables

/// "1.23 M", "45.6 k", "789".
std::string count(double value) {
  if (std::fabs(value) >= 1e6) return fixed(value / 1e6, 2) + " M";
  if (std::fabs(value) >= 1e4) return fixed(value / 1e3, 1) + " k";
  return fixed(value, 0);
}

std::string kib(double bytes) { return count(bytes / 1024); }

PageTable knob_table(const KnobResults& results) {
  PageTable table{{"knob", "rung", "paid in", "work", "PSNR dB", "FLIP", "max", "RMS", "alone dB", "FLIP",
                   "render ms", "composite", "cpu ms", "+-", "modelled", "dB/ms", "mFLIP/ms", "front"},
                  {},
                  3};
  for (const RungResult& r : results.rungs) {
    const Knob& knob = results.ladder.knobs[r.knob];
    const Measured& m = results.measured[r.variant];
    const Quality& q = r.error.quality;
    table.rows.push_back(
        {r.rung == 0 ? knob.name : "", knob.rungs[r.rung].label, r.rung == 0 ? name(knob.work) : "",
         count(r.work), fixed(q.psnr_db, 2), fixed(q.flip, 4), std::to_string(q.max_difference),
         fixed(r.error.rms_code_values, 2), fixed(r.alone.quality.psnr_db, 2), fixed(r.alone.quality.flip, 4),
         fixed(m.render.median_ms, 1), fixed(m.composite.median_ms, 1), fixed(m.cpu.median_ms, 1),
         fixed(m.cpu.spread_ms, 1), fixed(m.modelled_ms, 2), fixed(r.gain.db_per_ms, 2),
         fixed(1000 * r.gain.flip_per_ms, 2),
         std::string(r.work_front ? "w" : "") + (r.wall_front ? "t" : "")});
  }
  return table;
}

PageTable not_called_table(const RendererReport& report) {
  PageTable table{{"not called for", "why"}, {}, 2};
  for (const Knob& knob : report.knobs.ladder.knobs)
    if (!knob.called()) table.rows.push_back({"knob " + knob.name, knob.why_not});
  for (const layers::EffectCall& call : report.effects.not_called)
    table.rows.push_back({std::string(layers::name(call.effect)), call.why});
  return table;
}

PageTable effect_table(const EffectResults& effects) {
  PageTable table{{"effect", "PSNR dB", "SSIM", "FLIP", "max", "ms", "+-", "cpu ms", "+-", "% of all",
                   "modelled", "KiB", "shadow maps", "mirrors", "pixels shaded", "samples", "look-ups"},
                  {},
                  1};
  const Measured& with = effects.frames[0];
  for (const EffectResult& effect : effects.pictures) {
    const Measured& without = effects.frames[effect.without];
    const Quality& q = effect.error.quality;
    const double ms = with.drawn.median_ms - without.drawn.median_ms;
    const double cpu = with.cpu.median_ms - without.cpu.median_ms;
    const auto saved = [&](std::int64_t a, std::int64_t b) { return count(with.per_frame(a - b)); };
    table.rows.push_back({std::string(layers::name(effect.call.effect)), fixed(q.psnr_db, 2),
                          fixed(q.ssim, 4), fixed(q.flip, 4), std::to_string(q.max_difference), fixed(ms, 1),
                          fixed(with.drawn.spread_ms + without.drawn.spread_ms, 1), fixed(cpu, 1),
                          fixed(with.cpu.spread_ms + without.cpu.spread_ms, 1),
                          fixed(100 * cpu / with.cpu.median_ms, 1),
                          fixed(with.modelled_ms - without.modelled_ms, 2),
                          kib(double(with.memory_bytes() - without.memory_bytes())),
                          saved(with.passes.shadow_maps_drawn, without.passes.shadow_maps_drawn),
                          saved(with.passes.reflections_drawn, without.passes.reflections_drawn),
                          saved(with.counters.pixels_shaded, without.counters.pixels_shaded),
                          saved(with.counters.texture_samples, without.counters.texture_samples),
                          saved(with.counters.shadow_lookups, without.counters.shadow_lookups)});
  }
  return table;
}

std::vector<std::string> run_row(const std::string& what, const Measured& m, const PictureError& error) {
  return {what,
          fixed(m.per_frame(m.renders), 2),
          count(m.per_frame(m.polygons)),
          count(m.per_frame(m.pixels)),
          fixed(m.plan.median_ms, 2),
          fixed(m.render.median_ms, 1),
          fixed(m.composite.median_ms, 1),
          fixed(m.cpu.median_ms, 1),
          fixed(m.cpu.spread_ms, 1),
          fixed(m.modelled_ms, 2),
          kib(double(m.memory_bytes())),
          fixed(error.quality.psnr_db, 2),
          fixed(error.quality.ssim, 4),
          fixed(error.quality.flip, 4),
          std::to_string(error.quality.max_difference)};
}

PageTable run_table(const EffectResults& effects) {
  PageTable table{{"per frame", "renders", "polygons", "pixels", "plan ms", "render ms", "composite",
                   "cpu ms", "+-", "modelled", "KiB", "PSNR dB", "SSIM", "FLIP", "max"},
                  {},
                  1};
  table.rows.push_back(run_row("as it is", effects.runs[0], effects.run_error));
  for (const EffectResult& effect : effects.over_time)
    table.rows.push_back(run_row("without " + std::string(layers::name(effect.call.effect)),
                                 effects.runs[effect.without], effect.error));
  return table;
}

std::string list_of(const std::vector<int>& frames) {
  std::string text;
  for (const int frame : frames) text += (text.empty() ? "" : ", ") + std::to_string(frame);
  return text;
}

/// What costs most.
std::string verdict_on(const RendererReport& report) {
  const EffectResults& effects = report.effects;
  const double all_ms = effects.frames.empty() ? 0 : effects.frames[0].cpu.median_ms;
  const EffectResult* dearest = nullptr;
  const auto cost = [&](const EffectResult& effect) {
    return all_ms - effects.frames[effect.without].cpu.median_ms;
  };
  for (const EffectResult& effect : effects.pictures)
    if (!dearest || cost(effect) > cost(*dearest)) dearest = &effect;
  if (!dearest) return "No effect of a frame is called for.";
  return "Of " + std::to_string(effects.pictures.size()) + " effects that are called for, " +
         std::string(layers::name(dearest->call.effect)) + " costs most: " + fixed(cost(*dearest), 1) +
         " ms of " + fixed(all_ms, 1) + " ms of processor time a frame; without it FLIP is " +
         fixed(dearest->error.quality.flip, 4) + ".";
}

std::vector<Block> knob_blocks(const RendererReport& report) {
  std::vector<Block> blocks = {
      Heading{2, "Knobs, one turned at a time"},
      Paragraph{
          "against the truth: " + truth_in_words() +
          "\nalone: against the same with this knob as the truth has it; gain over the next coarser rung, - "
          "where times do not differ; front: least FLIP for its work (w), time (t)"},
      knob_table(report.knobs),
      Figure{"renderer-pixels.svg", "Knobs of the one pass: error against processor time."},
      Figure{"renderer-pixels-work.svg", "The same against the count that a knob is paid in."},
      Figure{"renderer-sprites.svg", "Knobs of sprites: error against processor time."},
      Figure{"renderer-sprites-work.svg", "The same against the count that a knob is paid in."}};
  for (const Knob& knob : report.knobs.ladder.knobs)
    if (knob.called())
      blocks.push_back(Figure{knob_sheet_file(knob), knob.name + ", rung by rung, where they differ most."});
  return blocks;
}

std::vector<Block> effect_blocks(const RendererReport& report) {
  const EffectResults& effects = report.effects;
  std::vector<Block> blocks;
  if (!effects.pictures.empty())
    blocks = {
        Heading{2, "Effects of a frame"},
        Paragraph{
            "policy reference: what it buys (the picture without against with) and costs (with - without)"},
        effect_table(effects), Figure{"renderer-effects.svg", "What each effect costs, and what it buys."},
        Figure{"effects.png", "With each effect above, without it below."}};
  if (effects.over_time.empty()) return blocks;
  const Workload& run = effects.run_load;
  blocks.push_back(Heading{2, "Effects over time"});
  blocks.push_back(Paragraph{"frames " + std::to_string(run.frames.front()) + "-" +
                             std::to_string(run.frames.back()) + ", policy " + report.policy + ", " +
                             std::to_string(run.compared.size()) + " of them compared with their direct"});
  blocks.push_back(run_table(effects));
  blocks.push_back(Figure{"renderer-over-time.svg", "Error against time, without each of them."});
  return blocks;
}

}  // namespace

std::string knobs_csv(const RendererReport& report) {
  const KnobResults& results = report.knobs;
  std::string csv = "knob,rung,in_sprites,is_truth,work_unit" + csv_names(kError) + csv_names(kRung) +
                    csv_names(kMeasured) + "\n";
  for (const RungResult& rung : results.rungs) {
    const Knob& knob = results.ladder.knobs[rung.knob];
    csv += knob.name + "," + knob.rungs[rung.rung].label + (knob.in_sprites ? ",1" : ",0") +
           (rung.variant == kTruth ? ",1," : ",0,") + name(knob.work) + csv_cells(kError, rung.error) +
           csv_cells(kRung, rung) + csv_cells(kMeasured, results.measured[rung.variant]) + "\n";
  }
  return csv;
}

std::string effects_csv(const RendererReport& report) {
  const EffectResults& effects = report.effects;
  std::string csv = "workload,without" + csv_names(kError) + csv_names(kMeasured) + "\n";
  const auto line = [&](const char* load, const std::string& without, const PictureError* error,
                        const Measured& measured) {
    csv += std::string(load) + "," + without +
           (error ? csv_cells(kError, *error) : std::string(std::size(kError), ',')) +
           csv_cells(kMeasured, measured) + "\n";
  };
  line("frames", "", nullptr, effects.frames[0]);
  for (const EffectResult& effect : effects.pictures)
    line("frames", std::string(layers::name(effect.call.effect)), &effect.error,
         effects.frames[effect.without]);
  line("run", "", &effects.run_error, effects.runs[0]);
  for (const EffectResult& effect : effects.over_time)
    line("run", std::string(layers::name(effect.call.effect)), &effect.error, effects.runs[effect.without]);
  return csv;
}

std::string json_of(const RendererReport& report) {
  Json knobs = Json::array();
  for (std::size_t k = 0; k < report.knobs.ladder.knobs.size(); ++k) knobs.push_back(knob_json(report, k));
  const Json json = {{"schema", "talisman.renderer/1"},
                     {"sequence", report.sequence},
                     {"display_px", {report.display_px.x, report.display_px.y}},
                     {"settings_given", json_of(report.given)},
                     {"rounds", report.rounds},
                     {"frames", report.knobs.frames},
                     {"truth", truth_in_words()},
                     {"policy_of_runs", report.policy},
                     {"knobs", knobs},
                     {"effects", effects_json(report.effects)}};
  return json.dump(1) + "\n";
}

void write_report(const RendererReport& report, const std::string& dir) {
  write_renderer_plots(report, dir);
  write_renderer_sheets(report, dir);
  write_text_atomically(dir + "/renderer.csv", knobs_csv(report));
  write_text_atomically(dir + "/renderer-effects.csv", effects_csv(report));
  write_text_atomically(dir + "/renderer.json", json_of(report));
}

Page page_of(const RendererReport& report) {
  Page page{"Knobs and effects of the renderer: " + report.sequence, {}, verdict_on(report), "renderer.html"};
  add(page, {Paragraph{report.sequence + ": " + std::to_string(report.display_px.x) + "x" +
                       std::to_string(report.display_px.y) + " px; frames " + list_of(report.knobs.frames) +
                       " drawn from nothing; ms per frame (cpu: of all threads), median of " +
                       std::to_string(report.rounds) + " interleaved rounds, +- its median deviation"}});
  add(page, knob_blocks(report));
  add(page, effect_blocks(report));
  if (const PageTable not_called = not_called_table(report); !not_called.rows.empty())
    add(page, {Heading{2, "Not called for"}, not_called});
  return page;
}

}  // namespace talisman::sequences
