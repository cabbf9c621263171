// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/regrouping/sprite_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "regulator/policies.h"
#include "sequences/pipeline/layer_planning.h"
#include "warp/quadrilateral.h"

namespace talisman::sequences {

namespace {

using layers::LayerState;
using regulator::Action;

/// What was not seen for so long is forgotten: a pair; a set, and that it had to be split.
constexpr int kKeepPair_frames = 48, kKeepSet_frames = 1024;

double recency(const Pipeline& pipeline) { return pipeline.settings.regulator.regroup.recency; }

/// A sprite that is shown: it was drawn again, or it was not.
void count_shown(const Pipeline& pipeline, const regulator::LayerDecision& decision,
                 regulator::RunLength& run) {
  if (decision.action == Action::Rerender && decision.reason.find("first_appearance") == std::string::npos)
    run.ended(recency(pipeline));
  run.frame_passed();
}

/// The sprite that a layer has from before, while it shares another.
OwnSprite stored_sprite(const LayerMemory& memory) {
  return {*memory.then, memory.placement, memory.frame_rendered, true};
}

OwnSprite imagined_sprite(const Pipeline& pipeline, PipelineState& state, int layer, int frame) {
  return {captured_states(pipeline, state, frame)[layer], captured_placement(pipeline, state, layer, frame),
          frame, false};
}

/// A sprite that is not shown: would it have to be drawn again?
void count_imagined(const Pipeline& pipeline, PipelineState& state, int layer, int frame, LayerRuns& runs) {
  if (!runs.own) {
    const LayerMemory& memory = state.memory[layer];
    runs.own = memory.then ? stored_sprite(memory) : imagined_sprite(pipeline, state, layer, frame);
  }
  const LayerState& now = captured_states(pipeline, state, frame)[layer];
  const regulator::LayerAssessment assessment = assess_sprite(
      pipeline, state.layers, runs.own->then, runs.own->placement, now, std::abs(frame - runs.own->frame));
  if (!regulator::violation_of(assessment, pipeline.settings.regulator).empty()) {
    runs.run.ended(recency(pipeline));
    runs.own = imagined_sprite(pipeline, state, layer, frame);
  }
  runs.run.frame_passed();
}

void append(const layers::Correspondences& from, layers::Correspondences& to) {
  for (std::size_t i = 0; i < from.then_px.size(); ++i) {
    to.then_px.push_back(from.then_px[i]);
    to.now_px.push_back(from.now_px[i]);
    to.point.push_back(from.point[i]);
  }
  to.overlap = to.overlap && from.overlap;
}

/// How far off one warp for both would be, px. `pers` has no surface in common: the affine warp stands for it.
double joint_error_px(const Pipeline& pipeline, const PairRuns& pair, const LayerState& behind,
                      const LayerState& front, int frames) {
  layers::Correspondences matched =
      layers::correspond(pair.behind, behind, pipeline.authored.bound(behind.layer).hull, frames);
  append(layers::correspond(pair.front, front, pipeline.authored.bound(front.layer).hull, frames), matched);
  if (!matched.overlap || matched.then_px.size() < regulator::kFewestMatchedPoints) return HUGE_VAL;
  const warp::Curve curve = pipeline.settings.curve;
  const bool in_space = curve == warp::Curve::pers || curve == warp::Curve::pers2;
  const warp::FitResult fitted = warp::fit({matched.then_px.data(), matched.then_px.size()},
                                           {matched.now_px.data(), matched.now_px.size()},
                                           in_space ? warp::Curve::aff : curve, pipeline.settings.fit);
  return fitted.usable() ? fitted.max_px : HUGE_VAL;
}

double geometric_limit_px(const Pipeline& pipeline, int layer) {
  return pipeline.settings.regulator.thresholds.geometric_px /
         pipeline.authored[layer].preferences.importance.geometric;
}

void count_pair(const Pipeline& pipeline, const std::vector<LayerState>& states, int behind, int front,
                int frame, PairRuns& pair) {
  const bool goes_on = pair.seen == frame - 1;
  const int frames = std::max(static_cast<int>(pair.run.current()), 1);
  const double most_px = std::min(geometric_limit_px(pipeline, behind), geometric_limit_px(pipeline, front));
  const bool ended =
      goes_on && !(joint_error_px(pipeline, pair, states[behind], states[front], frames) <= most_px);
  if (ended) pair.run.ended(recency(pipeline));
  if (!goes_on) pair.run.interrupted();
  if (ended || !goes_on) {
    pair.behind = states[behind];
    pair.front = states[front];
  }
  pair.run.frame_passed();
  pair.seen = frame;
}

void count_neighbours(const Pipeline& pipeline, PipelineState& state, int frame) {
  const std::vector<LayerState>& states = captured_states(pipeline, state, frame);
  const std::vector<int>& line = state.regroup.line;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (line[i - 1] >= 0 && line[i] >= 0)
      count_pair(pipeline, states, line[i - 1], line[i], frame, state.regroup.pairs[{line[i - 1], line[i]}]);
}

void count_sprite(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                  const LineSprite& sprite) {
  const regulator::LayerDecision& decision = report.plan.decisions[sprite.id];
  RegroupMemory& memory = state.regroup;
  if (sprite.members.size() == 1 && sprite.id == sprite.members.front()) {
    const auto [it, is_new] = memory.layers.try_emplace(sprite.id);
    LayerRuns& runs = it->second;
    if (is_new) runs.changed = report.frame;  // nothing is known of it yet
    runs.own.reset();
    return count_shown(pipeline, decision, runs.run);
  }
  const auto [set, is_new] = memory.sets.try_emplace(report.layers[sprite.id].members);
  if (is_new) set->second.run = regulator::RunLength(expected_run(memory, sprite.members));
  set->second.seen = report.frame;
  count_shown(pipeline, decision, set->second.run);
  for (const int member : sprite.members)
    count_imagined(pipeline, state, member, report.frame, memory.layers[member]);
}

}  // namespace

std::vector<LineSprite> line_sprites(const PipelineState& state, const FrameReport& report) {
  std::vector<LineSprite> sprites;
  for (const int layer : state.regroup.line) {
    if (layer < 0) {
      if (!sprites.empty()) sprites.back().ends_stretch = true;
      continue;
    }
    const int into = report.order.merged_into[layer], id = into >= 0 ? into : layer;
    if (sprites.empty() || sprites.back().id != id || sprites.back().ends_stretch)
      sprites.push_back({id, {}, false});
    sprites.back().members.push_back(layer);
  }
  if (!sprites.empty()) sprites.back().ends_stretch = true;
  return sprites;
}

void count_runs(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                const std::vector<LineSprite>& sprites) {
  count_neighbours(pipeline, state, report.frame);
  for (const LineSprite& sprite : sprites) count_sprite(pipeline, state, report, sprite);
  std::erase_if(state.regroup.pairs,
                [&](const auto& pair) { return pair.second.seen + kKeepPair_frames < report.frame; });
  std::erase_if(state.regroup.sets, [&](const auto& set) {
    return std::max(set.second.seen, set.second.not_before) + kKeepSet_frames < report.frame;
  });
}

double expected_run(const RegroupMemory& memory, std::span<const int> layers) {
  double frames = HUGE_VAL;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto alone = memory.layers.find(layers[i]);
    frames = std::min(frames, alone != memory.layers.end() ? alone->second.run.expected() : 1.0);
    if (i == 0) continue;
    const auto pair = memory.pairs.find({layers[i - 1], layers[i]});
    frames = std::min(frames, pair != memory.pairs.end() ? pair->second.run.expected() : 1.0);
  }
  SharedSet set(layers.begin(), layers.end());
  std::sort(set.begin(), set.end());
  const auto known = memory.sets.find(set);
  return known != memory.sets.end() ? std::min(frames, known->second.run.expected()) : frames;
}

}  // namespace talisman::sequences
