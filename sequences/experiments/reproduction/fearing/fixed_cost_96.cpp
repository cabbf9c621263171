// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/fearing/fixed_cost_96.h"

#include <algorithm>
#include <ctime>

#include "sequences/files/number_text.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

constexpr int kDirectEvery = 10;

struct MeasuredScenario {
  FrameParts direct, predictive;
};

/// One policy on its way through the frames.
class TimedRun {
 public:
  TimedRun(const layers::Scene& scene, const layers::LayerSet& set, const Settings& settings)
      : pipeline_(make_pipeline(scene, set, settings)), state_(pipeline_) {}
  void draw(int frame, const chunker::PreparedScene& prepared) {
    const std::clock_t begin = std::clock();
    const StageTimes times = step(pipeline_, state_, frame, &prepared).times;
    sum_.cpu_ms += 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    sum_.plan_ms += times.plan_ms;
    sum_.draw_ms += times.render_ms;
    sum_.join_ms += times.composite_ms;
    ++frames_;
  }
  FrameParts mean() const {
    return {sum_.plan_ms / frames_, sum_.draw_ms / frames_, sum_.join_ms / frames_, sum_.cpu_ms / frames_};
  }

 private:
  Pipeline pipeline_;
  PipelineState state_;
  FrameParts sum_;
  int frames_ = 0;
};

MeasuredScenario measured(TestScenario96 scenario) {
  const BuiltScenario96 built = built_scenario(scenario, 1);
  Settings settings;
  settings.view.display_px = built.display_px;
  settings.fps = built.fps;
  settings.frames = built.frames;
  settings.render.samples = 1;
  settings.render.shading = chunker::Shading::Gouraud;
  settings.regulator.thresholds.geometric_px = 0.01;
  settings.regulator.lookahead.frames = 32;
  settings.regulator.policy = regulator::Policy::Direct;
  const chunker::PreparedScene prepared(built.scene, settings.render);
  TimedRun direct(built.scene, built.layers, settings);
  settings.regulator.policy = regulator::Policy::Predictive;
  TimedRun predictive(built.scene, built.layers, settings);
  for (int frame = 0; frame < settings.frames; ++frame) {
    predictive.draw(frame, prepared);
    if (frame % kDirectEvery == 0) direct.draw(frame, prepared);
  }
  return {direct.mean(), predictive.mean()};
}

/// Of the bound.
double asked_of(TestScenario96 scenario) {
  switch (scenario) {
    case TestScenario96::Random:
      return 0.15;
    case TestScenario96::Random50000:
      return 0.4;
    case TestScenario96::Blocks:
      return 0.3;
    case TestScenario96::Particles:
      return 0.7;
    case TestScenario96::Molecules:
      break;
  }
  return 0.84;
}

double printed_factor_of(TestScenario96 scenario) {
  constexpr double kPrinted[] = {2.77, 4.69, 4.04, 15.11, 18.51};
  return kPrinted[static_cast<int>(scenario)];
}

std::string parts_in_words(const FrameParts& parts) {
  return formatted("%.2f ms of processor time (plan %.2f, drawing %.2f, joining %.2f)", parts.cpu_ms,
                   parts.plan_ms, parts.draw_ms, parts.join_ms);
}

}  // namespace

Finding fixed_cost_96(const FrameParts& direct, const FrameParts& predictive, double share) {
  const double speed_up = predictive.cpu_ms > 0 ? direct.cpu_ms / predictive.cpu_ms : 0;
  const double prediction_ms = std::max(predictive.plan_ms - direct.plan_ms, 0.0);
  const double joining_ms = std::max(predictive.join_ms - direct.join_ms, 0.0);
  return {
      formatted("%.2f-fold, %.2f of the bound; fixed %.2f ms: prediction %.2f, joining and clearing %.2f; ",
                speed_up, speed_up / kBound96, prediction_ms + joining_ms, prediction_ms, joining_ms) +
          parts_in_words(predictive) + " beside " + parts_in_words(direct),
      speed_up >= share * kBound96 || (speed_up > 0 && prediction_ms + joining_ms <= kFixed_ms),
      {{"speed_up", speed_up},
       {"prediction_ms", prediction_ms},
       {"joining_ms", joining_ms},
       {"direct_ms", direct.cpu_ms},
       {"predictive_ms", predictive.cpu_ms}}};
}

Item fixed_cost_item_96() {
  std::vector<Claim> claims;
  for (const TestScenario96 scenario : kScenarios96) {
    Claim claim{
        name(scenario),
        name(scenario) + formatted(", 1 %% moving, N = 32: %.2f of 20.16", printed_factor_of(scenario)),
        formatted("%.2f of the bound, or prediction, joining and clearing at most 2 ms a frame",
                  asked_of(scenario)),
        [scenario](PaperBench& bench) {
          const auto& times =
              bench.once("F96 fixed " + name(scenario), [scenario] { return measured(scenario); });
          return fixed_cost_96(times.direct, times.predictive, asked_of(scenario));
        }};
    claim.sequence = sequence_of(scenario);
    claim.derived = claim.pictures = true;
    claims.push_back(std::move(claim));
  }
  return {"fixed", "The fixed cost of shared buffers, on this machine", std::move(claims)};
}

}  // namespace talisman::sequences
