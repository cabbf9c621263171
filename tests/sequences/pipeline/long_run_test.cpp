// SPDX-License-Identifier: Apache-2.0
// A run without end: aggregates come and go, and what is kept of them stays bounded.
#include <map>

#include <gtest/gtest.h>

#include "layers/layer.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/summary.h"
#include "tests/support/fleet.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

/// Ships that fly through each other, on paths that take 40 seconds to repeat: of the sets that are merged
/// nearly every one is new.
struct Fleet {
  layers::Scene scene = tests::fleet_scene(40, 7, 40);
  layers::LayerSet layers = layers::factor(scene, tests::one_layer_per_part(scene));
  Settings settings;
  Fleet() { settings.frames = kFrames; }
  static constexpr int kFrames = 700;
};

/// The members and the name of the aggregates of a frame.
std::map<std::vector<int>, std::string> merged_in(const FrameReport& report) {
  std::map<std::vector<int>, std::string> merged;
  for (const Merger& merger : report.order.mergers) {
    const layers::Layer& layer = report.layers[merger.layer];
    merged[layer.members] = layer.name;
  }
  return merged;
}

TEST(LongRun, IdsOfAggregatesThatAreGoneAreUsedAgain) {
  const Fleet fleet;
  const Pipeline pipeline = make_pipeline(fleet.scene, fleet.layers, fleet.settings);
  PipelineState state(pipeline);
  std::map<std::vector<int>, int> last_seen;  // as if nothing were forgotten
  std::size_t most_kept = 0;
  for (int frame = 0; frame < Fleet::kFrames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    for (const auto& [members, name] : merged_in(report)) last_seen[members] = frame;
    std::size_t kept = 0;
    for (const auto& [members, seen] : last_seen) kept += seen + kKeepAggregate_frames >= frame;
    most_kept = std::max(most_kept, kept);
    ASSERT_EQ(report.layers.size(), fleet.layers.layers.size() + state.order.slots.size());
    ASSERT_EQ(state.memory.size(), report.layers.size());
    ASSERT_EQ(report.plan.decisions.size(), report.layers.size());
  }
  EXPECT_EQ(state.order.history.records.size(), last_seen.size());
  EXPECT_EQ(state.order.slots.size(), most_kept);
  EXPECT_LT(most_kept, last_seen.size()) << "no id had to be used again";
}

// An id that is used again must not bring anything of its last owner along: neither its name, nor a sprite
// that shows other layers.
TEST(LongRun, NamesAndSpritesAreThoseOfTheMembers) {
  const Fleet fleet;
  const Pipeline pipeline = make_pipeline(fleet.scene, fleet.layers, fleet.settings);
  PipelineState state(pipeline);
  std::map<std::vector<int>, std::string> names;
  std::map<std::vector<int>, int> last_seen;
  std::map<std::string, std::vector<int>> owners;
  int forgotten = 0;
  for (int frame = 0; frame < Fleet::kFrames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    for (const Merger& merger : report.order.mergers) {
      const layers::Layer& layer = report.layers[merger.layer];
      ASSERT_EQ(names.try_emplace(layer.members, layer.name).first->second, layer.name) << frame;
      ASSERT_EQ(owners.try_emplace(layer.name, layer.members).first->second, layer.members) << frame;
      const bool is_new = last_seen.count(layer.members) == 0;
      const bool is_forgotten = !is_new && last_seen[layer.members] + kKeepAggregate_frames < frame;
      forgotten += is_forgotten;
      const regulator::LayerDecision& decision = report.plan.decisions[merger.layer];
      if ((is_new || is_forgotten) && decision.action != regulator::Action::Drop) {
        ASSERT_EQ(decision.action, regulator::Action::Rerender) << frame;
        ASSERT_EQ(decision.reason.rfind("first_appearance", 0), 0u) << frame << ": " << decision.reason;
      }
      ASSERT_EQ(state.captured.at(frame).states[merger.layer].world_from_part.size(), layer.parts.size());
      last_seen[layer.members] = frame;
    }
  }
  RecordProperty("returned_after_being_forgotten", forgotten);
}

TEST(LongRun, TheSummaryListsEveryAggregateThatExisted) {
  const Fleet fleet;
  const Pipeline pipeline = make_pipeline(fleet.scene, fleet.layers, fleet.settings);
  PipelineState state(pipeline);
  Summary summary = start_summary(pipeline, "fleet");
  std::map<std::string, int> shown;  // frames, by name
  std::vector<std::string> in_order;
  for (int frame = 0; frame < 300; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    add_decisions(summary, report, state);
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      shown[report.layers[decision.layer].name] += decision.action != regulator::Action::Drop;
    for (const auto& merger : report.order.mergers) {
      const std::string& name = report.layers[merger.layer].name;
      if (std::find(in_order.begin(), in_order.end(), name) == in_order.end()) in_order.push_back(name);
    }
    const std::vector<int> lines = layers_with_lines(state, report);
    ASSERT_EQ(lines.size(), fleet.layers.layers.size() + report.order.mergers.size());
    for (std::size_t i = 1; i < lines.size(); ++i)
      ASSERT_LT(row_in_run(state, lines[i - 1]), row_in_run(state, lines[i]));
  }
  ASSERT_EQ(summary.layers.size(), fleet.layers.layers.size() + in_order.size());
  for (const LayerSummary& row : summary.layers) EXPECT_EQ(row.frames_shown, shown[row.name]) << row.name;
  for (std::size_t k = 0; k < in_order.size(); ++k)
    EXPECT_EQ(summary.layers[fleet.layers.layers.size() + k].name, in_order[k]);
}

}  // namespace
}  // namespace talisman::sequences
