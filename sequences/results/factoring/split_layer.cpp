// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/factoring/split_layer.h"

#include <algorithm>
#include <set>

#include "layers/glob.h"
#include "sequences/content/nearest_word.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/results/factoring/plan_sums.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerSpec;

std::size_t index_of_spec(const std::vector<LayerSpec>& specs, const Sequence& sequence,
                          const std::string& layer) {
  std::vector<std::string> names;
  for (const LayerSpec& spec : specs) names.push_back(spec.name);
  const auto found = std::find(names.begin(), names.end(), layer);
  if (found == names.end())
    throw InputError("--split: no layer is called '" + layer + "'" + did_you_mean(layer, names),
                     sequence.file);
  return static_cast<std::size_t>(found - names.begin());
}

const Layer& layer_of(const Sequence& sequence, const std::string& name) {
  return *std::find_if(sequence.layers.layers.begin(), sequence.layers.layers.end(),
                       [&](const Layer& layer) { return layer.base < 0 && layer.name == name; });
}

/// The names of the layer's parts, each once: parts of one name stay together.
std::vector<std::string> part_names(const Sequence& sequence, const Layer& layer) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const int part : layer.parts)
    if (const std::string& name = sequence.scene->parts[part].name; seen.insert(name).second)
      names.push_back(name);
  return names;
}

/// Unlike all names that there are.
std::string free_name(std::string name, const std::vector<LayerSpec>& specs) {
  const auto is_taken = [&](const std::string& tried) {
    return std::any_of(specs.begin(), specs.end(), [&](const LayerSpec& spec) { return spec.name == tried; });
  };
  while (is_taken(name)) name += "'";
  return name;
}

/// Of both, and of their shade layers: the pieces stand for the layer.
std::vector<int> ids_now(const std::string& name, const std::string& layer,
                         const std::vector<std::string>& pieces, const layers::LayerSet& set) {
  std::vector<std::string> names{name};
  if (name == layer) names = pieces;
  if (name.rfind(layer + "/", 0) == 0) {
    names.clear();
    for (const std::string& piece : pieces) names.push_back(piece + name.substr(layer.size()));
  }
  std::vector<int> ids;
  for (const Layer& now : set.layers)
    if (std::find(names.begin(), names.end(), now.name) != names.end()) ids.push_back(now.id);
  return ids;
}

std::vector<layers::ExplicitPair> pairs_of_pieces(const Sequence& before, const SplitSequence& split,
                                                  const std::string& layer) {
  std::vector<layers::ExplicitPair> pairs;
  for (const layers::ExplicitPair& pair : before.explicit_order)
    for (const int behind :
         ids_now(before.layers.layers[pair.behind].name, layer, split.pieces, split.sequence.layers))
      for (const int front :
           ids_now(before.layers.layers[pair.front].name, layer, split.pieces, split.sequence.layers))
        pairs.push_back({behind, front});
  return pairs;
}

const LayerSummary* planned_row(const Summary& summary, const std::string& name) {
  for (const LayerSummary& row : summary.layers)
    if (!row.is_aggregate && row.name == name) return &row;
  return nullptr;
}

void add_split_row(PageTable& table, const Summary& summary, const std::string& name,
                   const std::string& indent) {
  const LayerSummary* row = planned_row(summary, name);
  if (!row) return;
  const double frames = static_cast<double>(std::max<std::size_t>(summary.frames.size(), 1));
  const int renders = row->renders + row->merged_renders;
  table.rows.push_back({indent + name, std::to_string(row->polygons), std::to_string(renders),
                        row->merged_renders > 0 ? std::to_string(row->merged_renders) : "",
                        fixed(row->render_ms / frames, 3)});
}

std::string changed_by(double now, double then) {
  return now > 0 ? formatted("%+.1f %%", 100 * (then / now - 1)) : "";
}

}  // namespace

SplitSequence split_layer(const Sequence& sequence, const std::string& layer) {
  const std::size_t at = index_of_spec(sequence.layer_specs, sequence, layer);
  const std::vector<std::string> parts = part_names(sequence, layer_of(sequence, layer));
  if (parts.size() < 2 || parts.size() > kMostPieces)
    throw InputError(formatted("--split: layer '%s' has %zu part%s, rule: 2 to %zu", layer.c_str(),
                               parts.size(), parts.size() == 1 ? "" : "s", kMostPieces),
                     sequence.file);
  SplitSequence split{sequence, {}};
  std::vector<LayerSpec>& specs = split.sequence.layer_specs;
  const LayerSpec whole = specs[at];
  specs.erase(specs.begin() + static_cast<std::ptrdiff_t>(at));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    LayerSpec piece = whole;
    piece.name = free_name(parts[i], specs);
    piece.part_globs = {layers::glob_of_name(parts[i])};
    split.pieces.push_back(piece.name);
    specs.insert(specs.begin() + static_cast<std::ptrdiff_t>(at + i), piece);
  }
  split.sequence.layers = layers::factor(*sequence.scene, specs);
  if (!split.sequence.layers.defect.empty())
    throw InputError("--split: " + split.sequence.layers.defect, sequence.file);
  split.sequence.explicit_order = pairs_of_pieces(sequence, split, layer);
  return split;
}

std::string split_table(const Summary& now, const Summary& split, const std::string& layer,
                        const std::vector<std::string>& pieces) {
  PageTable layers_table{{"layer", "polygons", "renders", "merged", "ms a frame"}, {}, 1};
  add_split_row(layers_table, now, layer, "");
  for (const std::string& piece : pieces) add_split_row(layers_table, split, piece, "  ");
  PageTable sums{{"in all", "now", "split", "change"}, {}, 1};
  const auto add = [&](const char* name, double a, double b, int digits) {
    sums.rows.push_back({name, fixed(a, digits), fixed(b, digits), changed_by(a, b)});
  };
  add("renders", renders_in(now), renders_in(split), 0);
  add("polygons", static_cast<double>(now.polygons_rendered()),
      static_cast<double>(split.polygons_rendered()), 0);
  add("texels", static_cast<double>(now.pixels_rendered()), static_cast<double>(split.pixels_rendered()), 0);
  add("modelled ms a frame", modelled_ms(now), modelled_ms(split), 3);
  return formatted("%s: %zu frames; what if '%s' were %zu layers?\n\n", now.sequence.c_str(),
                   now.frames.size(), layer.c_str(), pieces.size()) +
         plain_text(layers_table) + "\n" + plain_text(sums);
}

}  // namespace talisman::sequences
