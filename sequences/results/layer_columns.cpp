// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/column_tables.h"

#include <utility>
#include <vector>

namespace talisman::sequences {

namespace {

template <typename Get>
Column<LayerRow> of_layer(std::string name, std::string unit, std::string meaning, Get get) {
  const std::string path = name;
  return computed<LayerRow>(std::move(name), path, std::move(unit), std::move(meaning), get);
}

std::vector<Column<LayerRow>> columns_of_renders() {
  return {
      of_layer("name", "", "of the layer; of an aggregate, those of its members",
               [](const LayerRow& r) { return r.layer.name; }),
      of_layer("parts", "parts", "that it is made of", [](const LayerRow& r) { return r.layer.parts; }),
      of_layer("polygons", "triangles", "of these", [](const LayerRow& r) { return r.layer.polygons; }),
      of_layer("renders", "renders", "of its own sprite", [](const LayerRow& r) { return r.layer.renders; }),
      of_layer("refreshes", "refreshes",
               "in which some chunks alone were drawn; absent without --refresh chunks",
               [](const LayerRow& r) {
                 return r.layer.refreshes ? value_of(*r.layer.refreshes) : Value(Absent{});
               }),
      of_layer("merged_renders", "renders", "of aggregates in which it took part; not among renders",
               [](const LayerRow& r) { return r.layer.merged_renders; }),
      of_layer("aggregate", "", "it draws several layers whose order is a cycle",
               [](const LayerRow& r) { return r.layer.is_aggregate; }),
      of_layer("shadow_map", "", "it is the shadow map of a light; rates are not averaged over it",
               [](const LayerRow& r) { return r.layer.is_shadow_map; }),
      of_layer("mirror", "", "it is the pictures that a layer mirrors; rates are not averaged over it",
               [](const LayerRow& r) { return r.layer.is_mirror; }),
      of_layer("share_of_cost", "",
               "of the modelled render time of all rows, each by itself: of polygons or pixels, whichever "
               "take longer",
               [](const LayerRow& r) { return r.share_of_cost; }),
      of_layer("why", "", "the most frequent reason of its renders, the median of its values, how often",
               [](const LayerRow& r) { return r.layer.reasons.text(); }),
      of_layer("frames_deferred", "frames", "in which it was worth drawing and the budget did not suffice",
               [](const LayerRow& r) { return r.layer.frames_deferred; }),
      of_layer("frames_over_budget", "frames", "of these: it is dearer than the whole budget of a frame",
               [](const LayerRow& r) { return r.layer.frames_over_budget; })};
}

std::vector<Column<LayerRow>> columns_of_what_is_shown() {
  return {
      of_layer("frames_shown", "frames",
               "in which its sprite is shown; of a shadow map: in which a layer in view looks it up",
               [](const LayerRow& r) { return r.layer.frames_shown; }),
      of_layer("update_rate", "",
               "renders over the frames of the run; chunks drawn alone count by their share of those stored",
               [](const LayerRow& r) { return r.layer.update_rate(r.frames); }),
      of_layer("mean_geometric_px", "px",
               "error of what is displayed, mean over the frames in which it is shown",
               [](const LayerRow& r) { return r.layer.mean_geometric_px(); }),
      of_layer("max_geometric_px", "px", "the largest of these",
               [](const LayerRow& r) { return r.layer.max_geometric_px; }),
      of_layer("mean_resolution", "", "relative to what the author asks for, mean over the same frames",
               [](const LayerRow& r) { return r.layer.mean_resolution(); }),
      computed<LayerRow>("sprite_width_px", "sprite_px/0", "px", "of the largest sprite, by area",
                         [](const LayerRow& r) { return r.layer.sprite_px.x; }),
      computed<LayerRow>("sprite_height_px", "sprite_px/1", "px", "likewise",
                         [](const LayerRow& r) { return r.layer.sprite_px.y; })};
}

std::vector<Column<LayerRow>> columns_of_layer() {
  std::vector<Column<LayerRow>> columns = columns_of_renders();
  for (Column<LayerRow>& column : columns_of_what_is_shown()) columns.push_back(std::move(column));
  return columns;
}

}  // namespace

const ColumnTable<LayerRow>& layer_table() {
  static const ColumnTable<LayerRow> table{"layers", "", columns_of_layer(), {}};
  return table;
}

const ColumnTable<EffectRow>& effect_table() {
  static const ColumnTable<EffectRow> table{
      "effects",
      "",
      {computed<EffectRow>("called", "called", "", "the scene and the run call for it",
                           [](const EffectRow& r) { return r.effect.called; }),
       computed<EffectRow>("why", "why", "", "what calls for it, or why nothing does",
                           [](const EffectRow& r) { return r.effect.why; }),
       computed<EffectRow>("passes", "passes", "passes",
                           "renders of layers that use it; frames sorted; shadow maps drawn",
                           [](const EffectRow& r) { return r.passes; })},
      {}};
  return table;
}

}  // namespace talisman::sequences
