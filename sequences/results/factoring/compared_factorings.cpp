// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/factoring/compared_factorings.h"

#include <algorithm>
#include <map>
#include <memory>

#include <tbb/parallel_for.h>

#include "layers/glob.h"
#include "sequences/content/own_settings.h"
#include "sequences/files/quoted.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

namespace {

using layers::LayerSpec;

std::string ordinal_name(const std::string& how) { return how == "node" ? "per node" : how; }

PlannedLayers planned_layers(const std::string& name, const Sequence& sequence) {
  const Settings settings = own_settings(sequence);
  const FrameRange range{0, sequence.frames - 1};
  PlannedFactoring plan;
  const auto add = [&](const FrameReport& report) { add_frame(report, settings.view.display_px, plan); };
  PlannedLayers result{name, sequence.layer_specs.size(), planned(sequence, settings, range, add), 0, 0};
  result.shown_px = plan.shown_px / sequence.frames;
  result.work_ms = plan.work_ms() / sequence.frames;
  return result;
}

/// What an author said of it cannot be left out: the picture would be another.
bool is_kept(const LayerSpec& spec) {
  const layers::ShadingSpec& shading = spec.shading;
  return shading.shadows || shading.specular || shading.reflection || shading.textures ||
         !spec.fade.values.empty() || !spec.casts_shadows;
}

/// Parts by the layer of the author's that has them; -1: none.
std::vector<int> layers_now(const Sequence& sequence) {
  std::vector<int> layer_of(sequence.scene->parts.size(), -1);
  for (const layers::Layer& layer : sequence.layers.layers)
    if (layer.base < 0)
      for (const int part : layer.parts) layer_of[part] = layer.id;
  return layer_of;
}

class Changes {
 public:
  Changes(const Sequence& sequence, const FactoringStudy& study)
      : sequence_(sequence), study_(study), settings_(own_settings(sequence)) {}

  std::vector<LayerChange> wanted() {
    std::vector<Asked> asked;
    const std::vector<int> now = layers_now(sequence_);
    std::map<int, std::map<std::size_t, std::vector<int>>> by_layer;
    std::map<std::size_t, std::map<int, std::vector<int>>> by_group;
    for (std::size_t i = 0; i < study_.chosen.pieces.size(); ++i)
      for (const int piece : study_.chosen.pieces[i]) {
        if (!study_.pieces.is_free(piece)) continue;
        const int layer = now[study_.pieces.layers[piece].parts.front()];
        by_layer[layer][i].push_back(piece);
        by_group[i][layer].push_back(piece);
      }
    for (const auto& [layer, groups] : by_layer) {
      if (groups.size() < 2 || layer < 0) continue;
      Asked change{
          "split '" + sequence_.layers.layers[layer].name + "' into " + std::to_string(groups.size()),
          {},
          {}};
      change.before.emplace_back();
      for (const auto& [group, pieces] : groups) {
        change.before[0].insert(change.before[0].end(), pieces.begin(), pieces.end());
        change.after.push_back(pieces);
      }
      asked.push_back(change);
    }
    for (const auto& [group, of] : by_group) {
      if (of.size() < 2) continue;
      Asked change{"", {}, {study_.chosen.pieces[group]}};
      std::vector<std::string> names;
      for (const auto& [layer, pieces] : of) {
        names.push_back(layer < 0 ? "what is in no layer" : sequence_.layers.layers[layer].name);
        change.before.push_back(pieces);
      }
      change.what = "join " + quoted(names);
      asked.push_back(change);
    }
    return planned_changes(asked);
  }

  std::vector<LayerChange> further() {
    std::vector<Asked> asked;
    const Factoring& chosen = study_.chosen;
    for (std::size_t i = 0; i < chosen.pieces.size(); ++i) {
      if (chosen.pieces[i].size() < 2 || !study_.pieces.is_free(chosen.pieces[i][0])) continue;
      if (chosen.pieces[i].size() > kMostPiecesSplit) continue;
      Asked change{"split '" + chosen.specs[i].name + "' into " + std::to_string(chosen.pieces[i].size()),
                   {chosen.pieces[i]},
                   {}};
      for (const int piece : chosen.pieces[i]) change.after.push_back({piece});
      asked.push_back(change);
    }
    for (const auto& [a, b] : study_.nearest_joins) {
      Asked change{"join " + quoted({chosen.specs[a].name, chosen.specs[b].name}),
                   {chosen.pieces[a], chosen.pieces[b]},
                   {chosen.pieces[a]}};
      change.after[0].insert(change.after[0].end(), chosen.pieces[b].begin(), chosen.pieces[b].end());
      asked.push_back(change);
    }
    return planned_changes(asked);
  }

 private:
  static constexpr std::size_t kMostPiecesSplit = 24;

  using Groups = std::vector<std::vector<int>>;
  struct Asked {
    std::string what;
    Groups before, after;
  };

  /// A group that several changes are about is planned once; all over the frames that the study looked at.
  std::vector<LayerChange> planned_changes(std::vector<Asked> asked) {
    std::map<std::vector<int>, std::size_t> place_of;
    std::vector<LayerSpec> specs;
    for (Asked& change : asked)
      for (Groups* side : {&change.before, &change.after})
        for (std::vector<int>& group : *side) {
          std::sort(group.begin(), group.end());
          if (place_of.try_emplace(group, specs.size()).second)
            specs.push_back(specs_of_groups(*sequence_.scene, {}, study_.pieces, {group}).front());
        }
    const int frames = study_.chosen.plan.frames;
    const std::vector<PlannedFactoring> plans = specs.empty()
                                                    ? std::vector<PlannedFactoring>{}
                                                    : plans_apart(*sequence_.scene, specs, settings_, frames);
    const auto sum_of = [&](const Groups& side) {
      PlannedFactoring sum;
      for (const std::vector<int>& group : side) {
        const PlannedFactoring& plan = plans[place_of.at(group)];
        sum.renders += plan.renders;
        sum.polygons += plan.polygons;
        sum.pixels += plan.pixels;
      }
      sum.frames = frames;
      return sum;
    };
    std::vector<LayerChange> changes;
    for (const Asked& change : asked)
      changes.push_back({change.what, sum_of(change.before), sum_of(change.after)});
    std::stable_sort(changes.begin(), changes.end(), [](const LayerChange& a, const LayerChange& b) {
      return a.after.work_ms() - a.before.work_ms() < b.after.work_ms() - b.before.work_ms();
    });
    return changes;
  }

  const Sequence& sequence_;
  const FactoringStudy& study_;
  Settings settings_;
};

}  // namespace

Sequence with_layers(const Sequence& sequence, const Factoring& factoring) {
  Sequence changed = sequence;
  changed.layer_specs = factoring.specs;
  changed.layers = factoring.set;
  changed.explicit_order = ids_of(factoring.pairs(), changed.layers);
  return changed;
}

namespace {

/// The sequence as it is, of the scene whose parts are cut, with seams: the pieces of a part are in its layer.
Sequence with_cuts(const Sequence& sequence, const CutStudy& found) {
  Sequence cut = sequence;
  const std::vector<int> now = layers_now(sequence);
  for (const CutEntry& entry : found.cuts)
    for (std::size_t part = 0; part < now.size(); ++part) {
      if (now[part] < 0 || !layers::glob_matches(entry.parts, sequence.scene->parts[part].name)) continue;
      const std::string& layer = sequence.layers.layers[static_cast<std::size_t>(now[part])].name;
      for (LayerSpec& spec : cut.layer_specs)
        if (spec.name == layer) spec.part_globs.push_back(entry.parts + "~*");
    }
  layers::Scene scene = *sequence.scene;
  apply_cuts(found.cuts, scene);
  cut.scene = std::make_shared<const layers::Scene>(std::move(scene));
  cut.seam = Seam::Auto;  // as the lines to paste say (cuts_yaml)
  cut.layers = layers::factor(*cut.scene, cut.layer_specs);
  return cut;
}

}  // namespace

ComparedFactoring compare_factorings(const Sequence& sequence, const AutoLayers& options,
                                     const std::function<void(const std::string&)>& begins) {
  std::vector<LayerSpec> kept;
  for (const LayerSpec& spec : sequence.layer_specs)
    if (is_kept(spec)) kept.push_back(spec);
  Settings settings = own_settings(sequence);
  settings.explicit_order.clear();
  ComparedFactoring compared;
  CutStudy found = study_with_cuts({*sequence.scene, std::move(kept), {}, settings, begins}, options);
  const Sequence cut = found.cuts.empty() ? sequence : with_cuts(sequence, found);
  compared.study = std::move(found.study);
  compared.cuts = std::move(found.cuts);
  std::vector<std::pair<std::string, const Factoring*>> proposals{{"proposed", &compared.study.chosen}};
  for (const Factoring& other : compared.study.others)
    proposals.emplace_back(ordinal_name(other.how), &other);
  compared.all.resize(1 + proposals.size());
  if (begins) begins("planning " + std::to_string(compared.all.size()) + " whole");
  tbb::parallel_for(std::size_t{0}, compared.all.size(), [&](std::size_t i) {
    compared.all[i] =
        i == 0 ? planned_layers("now", sequence)
               : planned_layers(proposals[i - 1].first, with_layers(cut, *proposals[i - 1].second));
  });
  if (begins) begins("planning each change");
  Changes changes(cut, compared.study);
  compared.wanted = changes.wanted();
  compared.further = changes.further();
  return compared;
}

}  // namespace talisman::sequences
