// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/factoring_keys.h"

namespace talisman::sequences {

const Table<AutoLayers>& auto_layers_keys() {
  static const Table<AutoLayers> table =
      Table<AutoLayers>("auto")
          .key("auto", &AutoLayers::way,
               choice<FactoringWay>({{"node", FactoringWay::Node},
                                     {"velocity", FactoringWay::Velocity},
                                     {"motion", FactoringWay::Motion},
                                     {"amortised", FactoringWay::Amortised}}),
               "",
               "`node`: one per moving node, or per top-level node where nothing moves; `velocity`: parts "
               "that move "
               "alike on the display and lie together, never dearer than `node`; `motion`: parts whose "
               "relative transforms stay constant over all frames; `amortised`: one for each "
               "part, with "
               "`regroup: amortised`")
          .required()
          .key("max", &AutoLayers::max, whole(1, kMostLayers), "layers",
               "no more than so many are made; those that a model's author named are not counted")
          .otherwise("40; `motion`, `amortised`: 1000");
  return table;
}

}  // namespace talisman::sequences
