// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/barnyard_pictures.h"

#include "sequences/experiments/regulator/experiment.h"
#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr int kSampledFrames = 20;
constexpr double kHalfTheError = 0.5, kNearlyAlike_flip = 0.05;
constexpr std::size_t kHeld = 0, kInterpolated = 1, kFirstThreshold = 2;

RegulatorSetting barnyard_setting(const OpenSequence& original, const std::string& name, const PlanOf& of) {
  return {name, "", 0, changed(original, of).settings.regulator};
}

const std::vector<SeenError>& pictures_measured(PaperBench& bench) {
  return bench.once("barnyard pictures", [&] {
    const std::string name = barnyard_sequence().name;
    const OpenSequence& open = bench.sequence(name);
    std::vector<RegulatorSetting> settings{
        barnyard_setting(open, "reference", reference_plan(name)),
        barnyard_setting(open, "held", triple_framing(name)),
        barnyard_setting(open, "interpolated", interpolated_triple_framing(name))};
    for (const double px : barnyard_thresholds())
      settings.push_back(barnyard_setting(open, formatted("%g px", px), threshold_plan(name, px)));
    const int frames = open.sequence.frames;
    const ExperimentFrames sampled{0, frames - 1, std::max(1, frames / kSampledFrames)};
    std::vector<SeenError> errors;
    for (const SettingResult& result :
         measure_regulator(open.sequence, open.settings, settings, sampled, ProgressKind::None))
      if (result.setting.series != "reference")
        errors.push_back({result.setting.series, result.quality.flip});
    return errors;
  });
}

std::string flip_words(const std::vector<SeenError>& errors) {
  std::string text;
  for (const SeenError& each : errors)
    text += (text.empty() ? "" : ", ") + each.name + " " + fixed(each.flip, 4);
  return text;
}

NamedNumbers flip_numbers(const std::vector<SeenError>& errors) {
  NamedNumbers numbers;
  for (const SeenError& each : errors) numbers.emplace_back("flip " + each.name, each.flip);
  return numbers;
}

Claim barnyard_claim(const char* id, const char* paper, const char* rule,
                     Finding (*test)(const std::vector<SeenError>&)) {
  Claim claim{id, paper, rule, [test](PaperBench& bench) { return test(pictures_measured(bench)); },
              [](PaperBench& bench) { return "FLIP of all: " + flip_words(pictures_measured(bench)); }};
  claim.sequence = barnyard_sequence().name;
  claim.pictures = true;
  return claim;
}

}  // namespace

Finding interpolation_is_seen(const std::vector<SeenError>& errors) {
  if (errors.size() <= kInterpolated) return {"nothing", false, {}};
  const double held = errors[kHeld].flip, interpolated = errors[kInterpolated].flip;
  return {"FLIP " + fixed(interpolated, 4) + " against " + fixed(held, 4),
          held > 0 && interpolated <= kHalfTheError * held, flip_numbers(errors)};
}

Finding thresholds_look_alike(const std::vector<SeenError>& errors) {
  if (errors.size() <= kFirstThreshold) return {"nothing", false, {}};
  bool same = true;
  for (std::size_t k = kFirstThreshold; k < errors.size(); ++k)
    same = same && errors[k].flip <= kNearlyAlike_flip && errors[k].flip < errors[kInterpolated].flip;
  return {"FLIP " + flip_words({errors.begin() + kFirstThreshold, errors.end()}), same, flip_numbers(errors)};
}

Item barnyard_pictures() {
  return {
      "7.2",
      "7.2: barnyard, what one sees",
      {barnyard_claim("interpolation", "the most dramatic gain is seen with interpolation",
                      "FLIP at most half of held triple framing", interpolation_is_seen),
       barnyard_claim("thresholds", "with thresholds nearly indistinguishable",
                      "FLIP at most 0.05, and below interpolated triple framing", thresholds_look_alike)}};
}

}  // namespace talisman::sequences
