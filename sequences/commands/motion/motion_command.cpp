// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/motion_command.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "layers/glob.h"
#include "sequences/commands/words.h"
#include "sequences/content/factoring/layers_yaml.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/starter/starter.h"

namespace talisman::sequences {

namespace {

bool is_model(const Sequence& sequence) {
  const std::string& file = sequence.file;
  return !file.ends_with(".yaml") && !file.ends_with(".yml");
}

MotionStudyOptions study_options(const MotionCommand& command, const Sequence& sequence) {
  CommandLine line;  // reads and checks a size as a run does
  line.size = command.size;
  MotionStudyOptions options;
  options.display_px = content_options(line).display_px.value_or(sequence.display_px);
  options.frames = sequence.frames;
  options.fps = sequence.fps;
  options.motion.delta_px = command.geometric_px.value_or(sequence.regulator.thresholds.geometric_px);
  if (!(options.motion.delta_px >= 0))
    throw InputError("--geometric-px is " + std::to_string(options.motion.delta_px) + ", must be at least 0");
  if (!command.norm.empty()) options.motion.norm = choice("--motion-norm", command.norm, kMotionNormWords);
  options.plan = {command.lookahead.value_or(options.plan.frames),
                  command.tree_k.value_or(options.plan.children)};
  if (const std::string defect = regulator::first_defect(options.plan); !defect.empty())
    throw InputError(defect);
  return options;
}

std::string yaml_of(const Sequence& sequence, const MotionStudy& study) {
  const std::string id = is_model(sequence) ? id_of_model(sequence.file) + "/" : "";
  return "# parts that move as one, for the layers of " +
         (is_model(sequence) ? std::string("what `talisman init` makes of this model\n")
                             : sequence.file + "\n") +
         layers_yaml(layers_of_groups(sequence, study), {}, id, {"ground"});
}

}  // namespace

std::vector<layers::LayerSpec> layers_of_groups(const Sequence& sequence, const MotionStudy& study) {
  std::vector<layers::LayerSpec> specs;
  for (const std::vector<int>& group : study.groups) {
    layers::LayerSpec spec;
    const auto name_of = [&](int i) -> const std::string& {
      return sequence.scene->parts[study.followed.parts[i].part].name;
    };
    for (const int i : group) spec.part_globs.push_back(layers::glob_of_name(name_of(i)));
    spec.name = name_of(group.front());
    specs.push_back(std::move(spec));
  }
  return specs;
}

int run_motion(const MotionCommand& command, std::ostream& out) {
  if (command.json + command.csv + command.yaml > 1)
    throw InputError("--json, --csv and --yaml are different prints, must be one of them");
  if (command.sequence.empty()) throw InputError("no SEQUENCE is given, must be a name or a path");
  const Sequence sequence = load_with_warnings(command.sequence, command.content);
  const MotionStudy study = study_motion(*sequence.scene, sequence.layers, study_options(command, sequence));
  out << (command.json   ? motion_json(sequence, study)
          : command.csv  ? motion_csv(sequence, study)
          : command.yaml ? yaml_of(sequence, study)
                         : motion_text(sequence, study, command.all));
  return kSuccess;
}

}  // namespace talisman::sequences
