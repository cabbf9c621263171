// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <tbb/parallel_for.h>

#include "regulator/profile.h"
#include "sequences/experiments/amortised/groupings.h"
#include "sequences/experiments/amortised/measured.h"
#include "sequences/experiments/regulator/setting_run.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using regulator::Policy;
using regulator::Regroup;
using regulator::RegroupPrices;

/// A row: which layers, run how.
struct AmortisedSetting {
  std::string name, grouping;
  const Sequence* sequence = nullptr;
  regulator::RegulatorOptions options;
};

struct Groupings {
  const Sequence& authored;
  std::optional<Sequence> parts;
  Sequence one;
};

std::vector<AmortisedSetting> amortised_settings(const Groupings& groupings,
                                                 regulator::RegulatorOptions base) {
  base.policy = Policy::Threshold;
  base.regroup.by = Regroup::None;
  base.regroup.prices = RegroupPrices::Modelled;
  regulator::RegulatorOptions direct = base, regrouped = base, by_1995 = base;
  direct.policy = Policy::Direct;
  regrouped.regroup.by = by_1995.regroup.by = Regroup::Amortised;
  by_1995.regroup.prices = RegroupPrices::Durbin1995;
  std::vector<AmortisedSetting> settings = {
      {"direct", "none", &groupings.authored, direct},
      {"author's layers", "author", &groupings.authored, base},
      {"author's layers, regrouped", "author", &groupings.authored, regrouped},
      {"one per group", "groups", &groupings.one, base}};
  if (!groupings.parts) return settings;
  const Sequence* parts = &*groupings.parts;
  settings.push_back({"one per part", "parts", parts, base});
  settings.push_back({"one per part, regrouped", "parts", parts, regrouped});
  settings.push_back({"one per part, as in 1995", "parts", parts, by_1995});
  return settings;
}

/// What changed in the grouping from one frame to the next.
class ChangeCounter {
 public:
  void add(const FrameReport& report, const PipelineState& state, AmortisedResult& result) {
    std::map<std::vector<int>, bool> now;
    for (const Merger& merger : report.order.mergers)
      if (merger.why.rfind("cheaper", 0) == 0) now[report.layers[merger.layer].members] = true;
    for (const auto& [set, is_there] : now) result.merges += !before_.contains(set);
    for (const auto& [set, is_there] : before_) result.splits += !now.contains(set) && !is_within(set, now);
    result.above_ceiling += state.regroup.changes_above_ceiling;
    result.sprites += static_cast<double>(report.shown.size());
    before_ = std::move(now);
  }

 private:
  static bool is_within(const std::vector<int>& set, const std::map<std::vector<int>, bool>& sets) {
    return std::any_of(sets.begin(), sets.end(), [&set](const auto& other) {
      return std::includes(other.first.begin(), other.first.end(), set.begin(), set.end());
    });
  }
  std::map<std::vector<int>, bool> before_;
};

Settings settings_for(const AmortisedSetting& setting, Settings settings) {
  settings.explicit_order = setting.sequence->explicit_order;
  settings.regulator = setting.options;
  return settings;
}

AmortisedResult measure_setting(const AmortisedSetting& setting, const Settings& settings,
                                const ExperimentFrames& frames, const chunker::PreparedScene& prepared,
                                const std::map<int, Image8>& truth) {
  SettingRun run(*setting.sequence, settings_for(setting, settings), {setting.name, "", 0, setting.options});
  AmortisedResult result;
  result.name = setting.name;
  result.grouping = setting.grouping;
  result.layers = static_cast<int>(setting.sequence->layer_specs.size());
  const std::vector<int> sampled = sampled_frames(frames);
  ChangeCounter changes;
  for (int frame = 0; frame <= frames.last; ++frame) {
    const bool is_judged = is_sampled(sampled, frame), is_drawn = is_judged || is_sampled(sampled, frame + 1);
    run.advance(frame, is_drawn ? &prepared : nullptr);
    changes.add(run.report(), run.state(), result);
    if (frame < frames.first) continue;
    run.count();
    const PlannedCost cost = planned_cost(run.report(), setting.options.policy);
    result.planned_render_ms += cost.render_ms;
    result.planned_composite_ms += cost.composite_ms;
    result.polygons_reference += run.report().reference.polygons;
    if (is_judged) run.judge({frame > 0 ? truth.at(frame - 1) : Image8{}, truth.at(frame)});
  }
  const double count = std::max(frames.last - frames.first + 1, 1);
  result.planned_render_ms /= count;
  result.planned_composite_ms /= count;
  result.sprites /= frames.last + 1;
  result.measured = run.result();
  return result;
}

/// The sampled frames and those before them as `direct` shows them.
std::map<int, Image8> truth_of(const Sequence& sequence, const Settings& settings,
                               const ExperimentFrames& frames, const chunker::PreparedScene& prepared) {
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  std::map<int, Image8> pictures;
  for (const int frame : drawn_frames(frames))
    pictures[frame] = to_image8(draw_direct(pipeline, frame, prepared));
  return pictures;
}

double planned_ms_of(const Sequence& sequence, const Settings& settings, const ExperimentFrames& frames) {
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  double sum_ms = 0;
  for (int frame = 0; frame <= frames.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    if (frame < frames.first) continue;
    const PlannedCost cost = planned_cost(report, settings.regulator.policy);
    sum_ms += cost.render_ms + cost.composite_ms;
  }
  return sum_ms;
}

/// May layers with different wishes, or in different groups, be in one set?
bool is_allowed(const Sequence& parts, const std::vector<int>& set_of) {
  for (std::size_t a = 0; a < set_of.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const layers::LayerSpec &one = parts.layer_specs[a], &other = parts.layer_specs[b];
      if (set_of[a] == set_of[b] && !(one.group == other.group && one.preferences == other.preferences))
        return false;
    }
  return true;
}

/// Of all groupings of the parts the one that is planned cheapest.
Sequence best_grouping(const Sequence& parts, const AmortisedSetting& setting, const Settings& settings,
                       const ExperimentFrames& frames, int& tried) {
  std::vector<std::vector<int>> ways = partitions(static_cast<int>(parts.layer_specs.size()));
  std::erase_if(ways, [&](const std::vector<int>& way) { return !is_allowed(parts, way); });
  std::vector<double> ms(ways.size());
  tbb::parallel_for(std::size_t{0}, ways.size(), [&](std::size_t i) {
    const Sequence joined = joined_layers(parts, ways[i]);
    AmortisedSetting own = setting;
    own.sequence = &joined;
    ms[i] = planned_ms_of(joined, settings_for(own, settings), frames);
  });
  tried = static_cast<int>(ways.size());
  return joined_layers(parts, ways[std::min_element(ms.begin(), ms.end()) - ms.begin()]);
}

}  // namespace

PlannedCost planned_cost(const FrameReport& report, Policy policy) {
  const regulator::HardwareProfile& profile = regulator::talisman_1996();
  const layers::dvec2 display(report.display_px);
  if (policy == Policy::Direct)
    return {
        regulator::modelled_time(profile, report.reference.polygons, std::llround(display.x * display.y), 0)
            .render_ms,
        0};
  std::int64_t polygons = 0, pixels = 0;
  for (const regulator::LayerDecision& decision : report.plan.decisions) {
    polygons += decision.cost.polygons;
    pixels += decision.cost.pixels;
  }
  for (const ShadowMapRow& map : report.shadow_maps) {
    polygons += map.decision.cost.polygons;
    pixels += map.decision.cost.pixels;
  }
  double shown_px = 0;
  for (const ShownSprite& sprite : report.shown) {
    layers::RectD bounds;
    for (const layers::dvec2& corner : {layers::dvec2{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const layers::dvec3 p =
          sprite.screen_from_sprite * layers::dvec3(corner * layers::dvec2(sprite.size_px), 1.0);
      bounds.include(layers::dvec2(p) / p.z);
    }
    const layers::RectD seen = layers::intersection(bounds, {{0, 0}, display});
    if (!seen.empty()) shown_px += seen.width() * seen.height();
  }
  const regulator::ModelledTime time =
      regulator::modelled_time(profile, polygons, pixels, std::llround(shown_px));
  return {time.render_ms, time.composite_ms};
}

AmortisedExperiment measure_amortised(const Sequence& sequence, const Settings& settings,
                                      const ExperimentFrames& frames, ProgressKind progress) {
  AmortisedExperiment experiment{sequence.name, settings.view.display_px, frames, {}, {}, 0};
  const Groupings groupings{sequence, one_layer_per_part(sequence, settings), one_layer_per_group(sequence)};
  if (!groupings.parts) experiment.left_out = "one per part: there are too many";
  std::vector<AmortisedSetting> compared = amortised_settings(groupings, settings.regulator);
  const chunker::PreparedScene prepared(*sequence.scene, settings.render);
  const std::map<int, Image8> truth = truth_of(sequence, settings, frames, prepared);
  std::optional<Sequence> best;
  if (groupings.parts && groupings.parts->layer_specs.size() <= kMostGrouped) {
    AmortisedSetting setting = compared[1];
    best = best_grouping(*groupings.parts, setting, settings, frames, experiment.groupings_tried);
    setting.name = "best of all groupings";
    setting.grouping = "best";
    setting.sequence = &*best;
    compared.push_back(setting);
  }
  Progress bar(progress, "settings", static_cast<int>(compared.size()));
  for (const AmortisedSetting& setting : compared) {
    experiment.results.push_back(measure_setting(setting, settings, frames, prepared, truth));
    bar.advance();
  }
  return experiment;
}

}  // namespace talisman::sequences
