// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/layer_pairs.h"

#include "layers/glob.h"
#include "sequences/content/nearest_word.h"

namespace talisman::sequences {

namespace {

using layers::ExplicitPair;
using layers::Layer;

[[noreturn]] void fail(const LayerPairEntry& entry, const std::string& what) {
  throw InputError("order {behind: " + entry.behind + ", front: " + entry.front + "}: " + what, entry.file,
                   entry.line);
}

std::vector<int> matching(const LayerPairEntry& entry, const std::string& glob,
                          std::span<const Layer> layers) {
  std::vector<int> ids;
  std::vector<std::string> names;
  for (const Layer& layer : layers) {
    if (layer.base >= 0) continue;
    names.push_back(layer.name);
    if (layers::glob_matches(glob, layer.name)) ids.push_back(layer.id);
  }
  if (ids.empty())
    fail(entry, "'" + glob + "' matches no layer, rule: the name of a layer, * any run, ? one character" +
                    did_you_mean(glob, names));
  return ids;
}

/// Which layers the pairs put somewhere in front of which.
class Reach {
 public:
  explicit Reach(std::size_t layers) : in_front_(layers, std::vector<bool>(layers, false)) {}
  bool is_in_front(int layer, int behind) const { return in_front_[behind][layer]; }
  void add(const ExplicitPair& pair) {
    if (is_in_front(pair.front, pair.behind)) return;
    for (std::size_t b = 0; b < in_front_.size(); ++b) {
      if (static_cast<int>(b) != pair.behind && !in_front_[b][pair.behind]) continue;
      in_front_[b][pair.front] = true;
      for (std::size_t f = 0; f < in_front_.size(); ++f)
        if (in_front_[pair.front][f]) in_front_[b][f] = true;
    }
  }

 private:
  std::vector<std::vector<bool>> in_front_;  // [behind][in front]
};

void check(const LayerPairEntry& entry, const Layer& behind, const Layer& front, const Reach& reach) {
  if (behind.group > front.group)
    fail(entry,
         "the groups put '" + behind.name + "' in front of '" + front.name + "', rule: groups come first");
  if (reach.is_in_front(behind.id, front.id))
    fail(entry, "entries before it put '" + behind.name + "' in front of '" + front.name +
                    "', rule: pairs do not go round");
}

}  // namespace

const Table<LayerPairEntry>& layer_pair_keys() {
  using P = LayerPairEntry;
  static const Table<P> table = Table<P>("pair")
                                    .placed([](P& pair, const YamlValue& self) {
                                      pair.file = self.file();
                                      pair.line = self.line();
                                    })
                                    .key("behind", &P::behind, with_rule(text(), "matches a layer"), "",
                                         "glob over the names of layers")
                                    .required()
                                    .key("front", &P::front, with_rule(text(), "matches another layer"), "",
                                         "those in front of all that `behind` names")
                                    .required();
  return table;
}

std::vector<ExplicitPair> resolve_layer_pairs(std::span<const LayerPairEntry> entries,
                                              std::span<const Layer> layers) {
  std::vector<ExplicitPair> pairs;
  Reach reach(layers.size());
  for (const LayerPairEntry& entry : entries) {
    const std::size_t before = pairs.size();
    for (const int behind : matching(entry, entry.behind, layers))
      for (const int front : matching(entry, entry.front, layers)) {
        if (behind == front) continue;
        check(entry, layers[behind], layers[front], reach);
        reach.add({behind, front});
        pairs.push_back({behind, front});
      }
    if (pairs.size() == before) fail(entry, "names one layer twice, rule: two layers");
  }
  return pairs;
}

void add_free_pairs(std::span<const ExplicitPair> more, std::span<const Layer> layers,
                    std::vector<ExplicitPair>& pairs) {
  Reach reach(layers.size());
  for (const ExplicitPair& pair : pairs) reach.add(pair);
  for (const ExplicitPair& pair : more) {
    if (layers[pair.behind].group > layers[pair.front].group || reach.is_in_front(pair.behind, pair.front))
      continue;
    reach.add(pair);
    pairs.push_back(pair);
  }
}

}  // namespace talisman::sequences
