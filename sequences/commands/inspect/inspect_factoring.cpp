// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect/inspect_factoring.h"

#include <filesystem>

#include "sequences/content/factoring/layers_yaml.h"
#include "sequences/content/starter/starter.h"
#include "sequences/files/stage_line.h"
#include "sequences/results/factoring/compared_factorings.h"

namespace talisman::sequences {

std::string inspect_factoring(const Sequence& sequence, int max_layers) {
  if (max_layers < 1 || max_layers > kMostLayers)
    throw InputError("--max-layers is " + std::to_string(max_layers) + ", must be from 1 to " +
                     std::to_string(kMostLayers));
  const ComparedFactoring compared =
      compare_factorings(sequence, {FactoringWay::Velocity, max_layers}, StageLine{"factoring"});
  const std::string extension = std::filesystem::path(sequence.file).extension().string();
  const bool is_model = extension != ".yaml" && extension != ".yml";
  const std::string id = is_model ? id_of_model(sequence.file) + "/" : "";
  const Factoring& chosen = compared.study.chosen;
  return factoring_text(sequence, compared) + "\n" +
         (is_model ? "# instead of the layers and the order of what `talisman init` makes of this model\n"
                   : "# instead of the layers and the order of this sequence\n") +
         cuts_yaml(compared.cuts, id) + layers_yaml(chosen.specs, chosen.pairs(), id, {"ground"});
}

}  // namespace talisman::sequences
