// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the rows of a paper share: sequences that are opened once, plans that are made once, and whatever else several of
/// them look at. Plans have no pixels: decisions and costs are those of a run that draws.

#include <any>
#include <compare>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

struct OpenSequence {
  Sequence sequence;
  Settings settings;  ///< its own
};

/// Throws InputError: no such sequence, or its content is not there.
using SequenceOpener = std::function<OpenSequence(const std::string& name)>;

/// How a sequence is to be planned. Without a policy: as its author says.
struct PlanOf {
  std::string sequence{};
  std::optional<regulator::Policy> policy{};
  double value = 0;              ///< Threshold: px; Hold, Interpolate: frames
  double speed = 1;              ///< > 0; of all motion: 2 shows every second instant, 0.5 twice as many
  bool fixed_camera = false;     ///< it stays where it is in the middle of the sequence
  bool full_resolution = false;  ///< every layer at the display's density
  auto operator<=>(const PlanOf&) const = default;
};

PlanOf own_plan(const std::string& sequence);
PlanOf reference_plan(const std::string& sequence);
/// Drawn in every third frame, and left in place between [LS97 7.2].
PlanOf triple_framing(const std::string& sequence);
/// Drawn in every third frame, and warped between.
PlanOf interpolated_triple_framing(const std::string& sequence);
PlanOf threshold_plan(const std::string& sequence, double px);

struct PlannedRun {
  Summary summary;
  std::vector<double> sprite_depth;  ///< by frame: sprites over a pixel of the display, in the mean
};

class PaperBench {
 public:
  explicit PaperBench(SequenceOpener open) : open_(std::move(open)) {}
  PaperBench(const PaperBench&) = delete;
  PaperBench& operator=(const PaperBench&) = delete;

  /// Throws what the opener throws, each time.
  const OpenSequence& sequence(const std::string& name);

  /// Made at the first question. Those of `plan_all` are made side by side.
  const PlannedRun& plan(const PlanOf& of);
  void plan_all(const std::vector<PlanOf>& all);

  /// The value that `make` returned when it was first asked for under this name.
  template <typename Make>
  auto& once(const std::string& name, const Make& make) {
    using T = std::decay_t<decltype(make())>;
    auto found = kept_.find(name);
    if (found == kept_.end()) found = kept_.emplace(name, std::make_any<T>(make())).first;
    return *std::any_cast<T>(&found->second);
  }

 private:
  SequenceOpener open_;
  std::map<std::string, std::unique_ptr<OpenSequence>> sequences_;
  std::map<PlanOf, PlannedRun> plans_;
  std::map<std::string, std::any> kept_;
};

/// The sequence with which a plan is made: `of` without its policy. Times of the frames are in the settings.
OpenSequence changed(const OpenSequence& original, const PlanOf& of);

/// One number of every frame.
template <typename Number>
std::vector<double> by_frame(const PlannedRun& run, const Number& number) {
  std::vector<double> values;
  for (const FrameLine& line : run.summary.frames) values.push_back(static_cast<double>(number(line)));
  return values;
}

}  // namespace talisman::sequences
