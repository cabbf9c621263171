// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/plots.h"

#include <cmath>

#include "sequences/experiments/large_plot.h"

namespace talisman::sequences {
namespace {

/// One series per knob; `x` of a rung is asked for with the last rung of its knob.
template <typename X>
Plot knob_plot(const RendererReport& report, bool in_sprites, Plot plot, X x) {
  const KnobResults& results = report.knobs;
  for (std::size_t k = 0; k < results.ladder.knobs.size(); ++k) {
    const Knob& knob = results.ladder.knobs[k];
    if (knob.in_sprites != in_sprites || !knob.called()) continue;
    PlotSeries series{knob.name, {}, SeriesStyle::LinePoints, {}};
    const RungResult* last = nullptr;
    for (const RungResult& rung : results.rungs)
      if (rung.knob == k) last = &rung;
    for (const RungResult& rung : results.rungs) {
      if (rung.knob != k) continue;
      series.points.push_back({x(rung, *last), rung.alone.quality.flip});
      series.labels.push_back(knob.rungs[rung.rung].label);
    }
    plot.series.push_back(series);
  }
  return plot;
}

PlotAxis flip_axis(bool in_sprites) {
  return {in_sprites ? "FLIP of the knob alone: less is better" : "FLIP against the truth: less is better",
          "", true};
}

/// What a mean is of: "stage, 2 frames".
std::string drawn_from(const RendererReport& report, std::size_t frames) {
  return " (" + report.sequence + ", " + std::to_string(frames) + (frames == 1 ? " frame)" : " frames)");
}

const char* means(bool in_sprites) { return in_sprites ? "knobs of sprites" : "knobs of the one pass"; }

}  // namespace

Plot knob_time_plot(const RendererReport& report, bool in_sprites) {
  const Plot plot{std::string(means(in_sprites)) + ": picture error against time" +
                      drawn_from(report, report.knobs.frames.size()),
                  {"measured processor time per frame", "ms", false},
                  flip_axis(in_sprites),
                  {}};
  return knob_plot(report, in_sprites, plot, [&](const RungResult& rung, const RungResult&) {
    return report.knobs.measured[rung.variant].cpu.median_ms;
  });
}

Plot knob_work_plot(const RendererReport& report, bool in_sprites) {
  const Plot plot{std::string(means(in_sprites)) + ": picture error against work" +
                      drawn_from(report, report.knobs.frames.size()),
                  {"the count that the knob is paid in, of its last rung", "%", true},
                  flip_axis(in_sprites),
                  {}};
  return knob_plot(report, in_sprites, plot, [](const RungResult& rung, const RungResult& last) {
    return last.work > 0 ? 100 * rung.work / last.work : NAN;
  });
}

Plot effect_plot(const RendererReport& report) {
  Plot plot{"effects of a frame: what each one costs and buys" +
                drawn_from(report, report.effects.frame_load.frames.size()),
            {"cost: measured processor time with - without, per frame", "ms", false},
            {"gain: FLIP of the picture without it", "", true},
            {}};
  const EffectResults& effects = report.effects;
  for (const EffectResult& effect : effects.pictures) {
    const double ms = effects.frames[0].cpu.median_ms - effects.frames[effect.without].cpu.median_ms;
    const std::string name(layers::name(effect.call.effect));
    plot.series.push_back({name, {{ms, effect.error.quality.flip}}, SeriesStyle::Points, {name}});
  }
  return plot;
}

Plot run_plot(const RendererReport& report) {
  Plot plot{"effects over time: time against error, without each" +
                drawn_from(report, report.effects.run_load.frames.size()),
            {"measured processor time per frame", "ms", false},
            {"FLIP against its direct: less is better", "", true},
            {}};
  const EffectResults& effects = report.effects;
  const auto add = [&](const std::string& name, const std::string& label, const Measured& m,
                       const PictureError& error) {
    plot.series.push_back({name, {{m.cpu.median_ms, error.quality.flip}}, SeriesStyle::Points, {label}});
  };
  add("as it is", "as it is", effects.runs[0], effects.run_error);
  for (const EffectResult& effect : effects.over_time) {
    const std::string name(layers::name(effect.call.effect));
    add("without " + name, name, effects.runs[effect.without], effect.error);
  }
  return plot;
}

void write_renderer_plots(const RendererReport& report, const std::string& dir) {
  write_plot(dir, "renderer-pixels", knob_time_plot(report, false), kLargePlot);
  write_plot(dir, "renderer-pixels-work", knob_work_plot(report, false), kLargePlot);
  write_plot(dir, "renderer-sprites", knob_time_plot(report, true), kLargePlot);
  write_plot(dir, "renderer-sprites-work", knob_work_plot(report, true), kLargePlot);
  write_plot(dir, "renderer-effects", effect_plot(report), kLargePlot);
  write_plot(dir, "renderer-over-time", run_plot(report), kLargePlot);
}

}  // namespace talisman::sequences
