// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What would other layers cost? A sequence as it is, beside the layers that are proposed for it, one layer per node and one
/// for all, each planned over the whole sequence; and what each change on the way would save by itself.

#include <functional>
#include <string>
#include <vector>

#include "sequences/content/factoring/cuts.h"
#include "sequences/content/factoring/factoring.h"
#include "sequences/content/sequence.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

struct PlannedLayers {
  std::string name;        ///< "now", "proposed", "per node", "one"
  std::size_t layers = 0;  ///< of geometry
  Summary summary;
  double shown_px = 0;  ///< of all sprites on the display, per frame
  double work_ms = 0;   ///< per frame: polygons and pixels added up (PlannedFactoring::work_ms)
};

/// Some layers made into others: one split, or several joined.
struct LayerChange {
  std::string what;                ///< "split 'land' into 6", "join 'hull', 'wing'"
  PlannedFactoring before, after;  ///< of the layers that it is about, each as if it were alone
};

struct ComparedFactoring {
  std::vector<PlannedLayers> all;    ///< now, proposed, per node, one
  std::vector<LayerChange> wanted;   ///< from what is now to what is proposed
  std::vector<LayerChange> further;  ///< of what is proposed: what was not done
  FactoringStudy study;
  std::vector<CutEntry> cuts;  ///< with which the proposal and the others are made
};

/// Plans all. `options` as of the key `layers`. What an author has factored of a layer's shading, its fade and that it casts no shadow
/// is kept with the layer: no other factoring shows the same picture. All else of the author's layers is forgotten.
/// `begins` hears what is done next.
ComparedFactoring compare_factorings(const Sequence& sequence, const AutoLayers& options,
                                     const std::function<void(const std::string&)>& begins = nullptr);

/// The sequence with the layers that are proposed.
Sequence with_layers(const Sequence& sequence, const Factoring& factoring);

std::string factoring_text(const Sequence& sequence, const ComparedFactoring& compared);

}  // namespace talisman::sequences
