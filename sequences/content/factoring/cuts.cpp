// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/cuts.h"

#include "layers/cut.h"
#include "layers/glob.h"
#include "sequences/content/nearest_word.h"
#include "sequences/content/starter/yaml_page.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

const Table<CutEntry>& cut_keys() {
  static const Table<CutEntry> table =
      Table<CutEntry>("cuts")
          .key("parts", &CutEntry::parts, text(), "",
               "glob over names of parts: `*` any run, `?` one character")
          .required()
          .key("into", &CutEntry::into, whole(2, layers::kMostCutPieces), "pieces",
               "that lie together and face alike; those of the part `a` are the parts `a~1`, `a~2`, …")
          .required()
          .placed([](CutEntry& entry, const YamlValue& self) {
            entry.file = self.file();
            entry.line = self.line();
          });
  return table;
}

void apply_cuts(const std::vector<CutEntry>& entries, layers::Scene& scene) {
  for (const CutEntry& entry : entries) {
    std::vector<std::string> names;
    for (const layers::Part& part : scene.parts) names.push_back(part.name);
    bool is_any = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!layers::glob_matches(entry.parts, names[i])) continue;
      is_any = true;
      if (const std::string defect = layers::cut_defect(scene, static_cast<int>(i)); !defect.empty())
        throw InputError("cuts: part '" + names[i] + "' " + defect + ", must be rigid to be cut", entry.file,
                         entry.line);
      layers::cut_part(scene, static_cast<int>(i), entry.into);
    }
    if (!is_any)
      throw InputError("cuts: '" + entry.parts +
                           "' matches no part, rule: the name of a part, * any run, ? one character" +
                           did_you_mean(entry.parts, names),
                       entry.file, entry.line);
  }
}

std::string cuts_yaml(const std::vector<CutEntry>& entries, const std::string& in_model) {
  if (entries.empty()) return "";
  std::string yaml = "cuts:\n";
  for (const CutEntry& entry : entries)
    yaml +=
        "  - {parts: " + yaml_text(in_model + entry.parts) + ", into: " + std::to_string(entry.into) + "}\n";
  return yaml + "seam: auto\n";
}

}  // namespace talisman::sequences
