// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/fearing/iris.h"

#include <algorithm>

#include "sequences/content/asset_paths.h"
#include "sequences/content/scene_builder.h"
#include "sequences/content/sequence_file.h"
#include "sequences/files/errors.h"
#include "sequences/pipeline/predictive/part_motion.h"

namespace talisman::sequences {

namespace {

constexpr double kPrimitive_ms = 0.05, kJoin_ms = 120;

/// Ranges of the tests of δ.
constexpr double kSlow_m = 0.02, kSlow_deg = 1;

/// What one slice adds: drawings, and levels that have something to show in each frame.
void add_slice(const MotionSlice& slice, int last, const regulator::PlanShape& plan, Work96& work) {
  const int shown = std::min(slice.frames, last + 1 - slice.first);
  std::vector<char> has_parts(static_cast<std::size_t>(shown) * plan.levels());
  for (const regulator::MotionWord& word : slice.words)
    for (int frame = 0; frame < shown;) {
      const regulator::PlannedDraw draw = regulator::draw_due(plan, word, frame);
      ++work.quads_drawn;
      const int end = std::min(frame + draw.frames, shown);
      for (; frame < end; ++frame)
        has_parts[static_cast<std::size_t>(frame) * plan.levels() + draw.level] = 1;
    }
  for (int frame = 0; frame < shown; ++frame) {
    const auto begin = has_parts.begin() + static_cast<std::ptrdiff_t>(frame) * plan.levels();
    work.joins +=
        static_cast<double>(std::max<std::ptrdiff_t>(std::count(begin, begin + plan.levels(), 1) - 1, 0));
  }
}

}  // namespace

std::string name(TestScenario96 scenario) {
  switch (scenario) {
    case TestScenario96::Random:
      return "random";
    case TestScenario96::Random50000:
      return "random, 50,000";
    case TestScenario96::Blocks:
      return "blocks";
    case TestScenario96::Particles:
      return "particles";
    case TestScenario96::Molecules:
      return "molecules";
  }
  return "?";
}

std::string sequence_of(TestScenario96 scenario) {
  return "fearing/" + (scenario == TestScenario96::Random50000 ? "random" : name(scenario));
}

double quad_ms(TestScenario96 scenario) {
  switch (scenario) {
    case TestScenario96::Random:
      return 0.628;
    case TestScenario96::Random50000:
      return 0.41;
    case TestScenario96::Blocks:
      return 0.168;
    case TestScenario96::Particles:
      return 0.0983;
    case TestScenario96::Molecules:
      return 0.09;
  }
  return 0;
}

BuiltScenario96 built_scenario(TestScenario96 scenario, double moving_percent, bool is_slow) {
  const std::string path = sequence_file_of(sequence_of(scenario));
  if (path.empty()) throw InputError(sequence_of(scenario) + " is not there");
  const SequenceFile file = read_sequence_file(path);
  SceneRecipe recipe = file.recipe;
  recipe.times = {file.settings.fps, file.settings.frames, file.settings.display_px};
  SwarmContent& swarm = *recipe.swarm;
  swarm.moving_percent = moving_percent;
  if (scenario == TestScenario96::Random50000) swarm.count = 50'000;
  if (is_slow) {
    swarm.translation_m = kSlow_m;
    swarm.rotation_deg = kSlow_deg;
  }
  BuiltScenario96 built;
  built.scene = build_scene(recipe).scene;
  layers::LayerSpec all;
  all.name = "swarm";
  all.part_globs = {"*"};
  built.layers = layers::factor(built.scene, {&all, 1});
  built.display_px = file.settings.display_px;
  built.fps = file.settings.fps;
  built.frames = file.settings.frames;
  built.quads_of_thing = quads_of(swarm.shape);
  return built;
}

Work96 counted_work(const Run96& run) {
  const BuiltScenario96 built = built_scenario(run.scenario, run.moving_percent, run.is_slow);
  const FollowedParts followed = followed_parts(built.scene, built.layers);
  // As printed: along each axis, and what leaves the view is no exception.
  const MotionOptions options{run.delta_px, regulator::MotionNorm::Axis,
                              regulator::MotionReference::LastDrawn, false};
  const int last = built.frames - 1;
  const FrameAt frame_at = [&](int frame) { return built.scene.at(frame / built.fps); };
  Work96 work;
  for (int first = 0; first < built.frames; first += run.plan.frames)
    add_slice(follow_parts(followed, built.display_px, first, run.plan.frames, last, frame_at, options), last,
              run.plan, work);
  work.primitives = static_cast<double>(followed.parts.size());
  work.quads = built.quads_of_thing * work.primitives;
  work.quads_drawn *= static_cast<double>(built.quads_of_thing) / built.frames;
  work.joins /= built.frames;
  return work;
}

double speed_up(TestScenario96 scenario, const Work96& work) {
  const double c = quad_ms(scenario);
  return work.quads * c / (work.quads_drawn * c + work.primitives * kPrimitive_ms + work.joins * kJoin_ms);
}

}  // namespace talisman::sequences
