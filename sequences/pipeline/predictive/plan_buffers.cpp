// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/predictive/plan_buffers.h"

#include <algorithm>
#include <map>

#include "layers/check.h"
#include "layers/effects.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

namespace {

using chunker::JoinCounters;
using chunker::PlanBuffer;
using chunker::RenderCounters;
using regulator::Joining;

}  // namespace

// --- The plan of a frame

PredictiveMemory::PredictiveMemory(const Pipeline& pipeline)
    : authored_(pipeline.authored),
      options_(pipeline.settings.regulator),
      display_px_(pipeline.settings.view.display_px),
      fps_(pipeline.settings.fps),
      scene_(&pipeline.scene),
      slices_(pipeline) {
  TALISMAN_CHECK_EQ(first_defect(regulator::plan_shape(options_)), std::string());
}

bool PredictiveMemory::is_of(const Pipeline& pipeline) const {
  return scene_ == &pipeline.scene && authored_.is_copy_of(pipeline.authored) &&
         options_ == pipeline.settings.regulator && display_px_ == pipeline.settings.view.display_px &&
         fps_ == pipeline.settings.fps;
}

const PlannedSlice& PredictiveMemory::slice_of(const Pipeline& pipeline, int frame) {
  at_hand_ = &slices_.of(pipeline, frame);
  return *at_hand_;
}

std::vector<ShownPart> PredictiveMemory::parts_shown(int frame) const {
  const int first = at_hand_->slice.first, within = frame - first;
  std::vector<ShownPart> shown;
  shown.reserve(followed().parts.size());
  for (std::size_t i = 0; i < followed().parts.size(); ++i) {
    const regulator::MotionWord& word = at_hand_->motion.words[i];
    const regulator::PlannedDraw draw = at_hand_->intervals.draw_shown(word, within);
    shown.push_back({static_cast<int>(i), draw.level, first + draw.frame,
                     first + regulator::instant_of(word, draw.frame, regulator::DrawnAs::RunStart)});
  }
  return shown;
}

PlanNode PredictiveMemory::node_at(int level, int frame) const {
  const int first = at_hand_->slice.first;
  return {level, first + at_hand_->intervals.first(level, frame - first),
          first + at_hand_->intervals.end(level, frame - first)};
}

// --- Drawing

PlanBuffer PredictiveMemory::draw_node(const Drawing& drawing, const std::vector<ShownPart>& shown, int level,
                                       RenderCounters& counters, JoinCounters& joins) const {
  std::map<int, std::vector<std::uint32_t>> by_instant;
  for (const ShownPart& part : shown)
    if (part.level == level) by_instant[part.instant].push_back(static_cast<std::uint32_t>(part.index));
  PlanBuffer buffer(display_px_);
  bool is_first = true;
  for (const auto& [instant, numbers] : by_instant) {
    std::vector<int> parts;
    for (const std::uint32_t number : numbers) parts.push_back(followed().parts[number].part);
    const layers::SceneFrame frame = Slices::expected(drawing.pipeline, at_hand_->slice, instant);
    chunker::DepthRenderResult drawn = draw_with_depth(
        {drawing.pipeline, drawing.layers, drawing.maps, drawing.prepared, frame}, parts, numbers);
    counters += drawn.counters;
    if (is_first)
      buffer = std::move(drawn.buffer);
    else
      buffer.join(drawn.buffer, joins);
    is_first = false;
  }
  return buffer;
}

/// `nodes`: those with parts, from the root. A buffer for each, joined anew.
template <typename Draw>
PlanBuffer* PredictiveMemory::join_each_frame(const std::vector<PlanNode>& nodes, const Draw& draw,
                                              JoinCounters& joins) {
  picture_ = PlanBuffer(display_px_);
  for (const PlanNode& node : nodes) {
    Held& held = buffers_[node.level];
    if (held.content != std::vector{node}) {
      held.buffer.clear(joins);
      held.buffer = draw(node);
      held.content = {node};
    }
    if (&node == &nodes.front())
      picture_.copy(held.buffer, joins);
    else
      picture_.join(held.buffer, joins);
  }
  return &picture_;
}

/// May the node be drawn into the buffer that it is laid over: does that end with it?
bool PredictiveMemory::goes_on(const Held* under, const PlanNode& node) const {
  if (options_.predictive.joining != Joining::InPlace || under == nullptr) return false;
  const int level = static_cast<int>(under - buffers_.data());
  return node_at(level, node.first).end == node.end;
}

/// What a buffer holds is laid over what those before it show.
template <typename Draw>
PlanBuffer* PredictiveMemory::join_on_the_fly(const std::vector<PlanNode>& nodes, const Draw& draw,
                                              JoinCounters& joins) {
  // The buffer that is farthest on the way to this frame, and how far.
  Held* current = nullptr;
  std::size_t done = 0;
  for (Held& held : buffers_) {
    const std::size_t length = held.content.size();
    if (length > done && length <= nodes.size() &&
        std::equal(held.content.begin(), held.content.end(), nodes.begin())) {
      current = &held;
      done = length;
    }
  }
  for (; done < nodes.size(); ++done) {
    const PlanNode& node = nodes[done];
    PlanBuffer drawn = draw(node);
    Held& target = goes_on(current, node) ? *current : buffers_[node.level];
    if (current == nullptr) {
      target.buffer.clear(joins);
      target.buffer = std::move(drawn);
      target.content.clear();
    } else {
      if (&target != current) {
        target.buffer.copy(current->buffer, joins);
        target.content = current->content;
      }
      target.buffer.join(drawn, joins);
    }
    target.content.push_back(node);
    current = &target;
  }
  return current == nullptr ? nullptr : &current->buffer;
}

PlanBuffer* PredictiveMemory::join(const Drawing& drawing, int frame, RenderCounters& render,
                                   RenderCounters& late, int& late_nodes, JoinCounters& joins) {
  const Stopwatch watch;
  double drawing_ms = 0;
  buffers_.resize(static_cast<std::size_t>(regulator::plan_shape(options_).levels()));
  for (Held& held : buffers_)
    if (held.buffer.size_px() != display_px_) held.buffer = PlanBuffer(display_px_);
  const std::vector<ShownPart> shown = parts_shown(frame);
  std::vector<bool> has_parts(buffers_.size());
  for (const ShownPart& part : shown) has_parts[part.level] = true;
  std::vector<PlanNode> nodes;
  for (int level = 0; level < at_hand_->intervals.levels(); ++level)
    if (has_parts[level]) nodes.push_back(node_at(level, frame));
  const auto draw = [&](const PlanNode& node) {
    const bool is_late = node.first != frame;
    late_nodes += is_late;
    const Stopwatch draw_watch;
    PlanBuffer drawn = draw_node(drawing, shown, node.level, is_late ? late : render, joins);
    drawing_ms += draw_watch.ms();
    return drawn;
  };
  PlanBuffer* const joined = options_.predictive.joining == Joining::EachFrame
                                 ? join_each_frame(nodes, draw, joins)
                                 : join_on_the_fly(nodes, draw, joins);
  joining_ms_ += watch.ms() - drawing_ms;
  return joined;
}

void PredictiveMemory::count_joins(int frame, const std::vector<ShownPart>& shown,
                                   PredictiveReport& report) const {
  const int levels = at_hand_->intervals.levels();
  std::vector<bool> has_parts(static_cast<std::size_t>(levels));
  for (const ShownPart& part : shown) has_parts[part.level] = true;
  for (int level = 1; level < levels; ++level) {
    const PlanNode node = node_at(level, frame);
    const bool in_place =
        options_.predictive.joining == Joining::InPlace && node.end == node_at(level - 1, frame).end;
    const bool is_due =
        options_.predictive.joining == Joining::EachFrame || (node.first == frame && !in_place);
    report.joins_planned += is_due;
    report.joins_without_content += is_due && !has_parts[level];
  }
}

std::int64_t PredictiveMemory::bytes() const {
  std::int64_t sum = 0;
  for (const Held& held : buffers_) sum += held.buffer.bytes();
  return sum;
}

// --- In a run

namespace {

PredictiveMemory& memory_of(const Pipeline& pipeline, PipelineState& state) {
  if (!state.predictive || !state.predictive->is_of(pipeline))
    state.predictive = std::make_shared<PredictiveMemory>(pipeline);
  return *state.predictive;
}

/// Why something is seen through the part, or empty.
std::string seen_through(const layers::Scene& scene, const layers::Part& part) {
  const layers::Material& material = scene.materials[part.material];
  if (material.opacity < 1) return "material '" + material.name + "' has opacity < 1";
  if (material.alpha_cutoff > 0) return {};
  for (const int texture : {material.texture, material.texture2})
    if (texture >= 0 && scene.textures[texture].has_alpha)
      return "texture '" + scene.textures[texture].name + "' has alpha";
  return scene.meshes[part.mesh].alphas.empty() ? ""
                                                : "part '" + part.name + "' has vertex colours with alpha";
}

/// What is drawn of one layer, and what is shown of it.
struct LayerShare {
  int parts = 0, drawn = 0;
  std::int64_t polygons = 0;
  int oldest = 0;  ///< of the instants that are shown
};

std::vector<LayerShare> shares_of(const Pipeline& pipeline, const FollowedParts& followed,
                                  const std::vector<ShownPart>& shown, int frame) {
  std::vector<LayerShare> shares(pipeline.authored.size());
  for (const ShownPart& part : shown) {
    const FollowedPart& what = followed.parts[part.index];
    LayerShare& share = shares[what.layer];
    share.oldest = share.parts == 0 ? part.instant : std::min(share.oldest, part.instant);
    ++share.parts;
    if (part.drawn != frame) continue;
    ++share.drawn;
    share.polygons += pipeline.scene.meshes[pipeline.scene.parts[what.part].mesh].triangle_count();
  }
  return shares;
}

/// Of the layer's rectangle what its share of polygons is: which pixels they fill is not known before they are drawn.
regulator::LayerCost cost_of_share(const regulator::LayerCost& whole, const LayerShare& share) {
  const double part =
      whole.polygons > 0 ? static_cast<double>(share.polygons) / static_cast<double>(whole.polygons) : 0;
  const auto of = [&](std::int64_t value) {
    return static_cast<std::int64_t>(static_cast<double>(value) * part);
  };
  return {share.polygons, of(whole.pixels), of(whole.chunks), of(whole.bytes)};
}

/// ", surprise: 2 parts were not where they were expected".
std::string surprise_in_words(const Slice& slice, int frame) {
  if (slice.surprised == 0 || frame != slice.first) return {};
  return "; surprise, the plan is dropped: " + std::to_string(slice.surprised) +
         (slice.surprised == 1 ? " part was" : " parts were") + " not where expected";
}

void decide_layer(const LayerShare& share, double displayed_px, const std::string& surprise,
                  regulator::LayerDecision& decision) {
  const bool in_view = decision.action != regulator::Action::Drop;
  decision.cost = cost_of_share(decision.cost, share);
  decision.action = share.drawn > 0 ? regulator::Action::Rerender
                    : in_view       ? regulator::Action::Reuse
                                    : regulator::Action::Drop;
  if (decision.action == regulator::Action::Drop) return;
  decision.reason = "policy: predictive, " + std::to_string(share.drawn) + " of " +
                    std::to_string(share.parts) + (share.parts == 1 ? " part due" : " parts due") + surprise;
  decision.depicts_frame = share.oldest;
  decision.shown_geometric_px = displayed_px;
}

/// A surface is drawn with all terms of its shading, and looks up the maps of them all.
void look_up_maps(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps,
                  FrameReport& report) {
  for (const layers::Layer& layer : report.layers) {
    const int surface = layer.base < 0 ? layer.id : layer.base;
    if (report.plan.decisions[surface].action == regulator::Action::Rerender)
      look_up_shadow_maps(pipeline, state, maps, layer.id, report.frame, report);
  }
  finish_shadow_maps(state, report);
}

}  // namespace

void plan_predicted(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps,
                    FrameReport& report) {
  PredictiveMemory& memory = memory_of(pipeline, state);
  const PlannedSlice& planned = memory.slice_of(pipeline, report.frame);
  const Slice& slice = planned.slice;
  const std::vector<ShownPart> shown = memory.parts_shown(report.frame);
  PredictiveReport& what = report.predictive.emplace();
  what.slice_first = slice.first;
  what.slice_frames = slice.frames;
  if (report.frame == slice.first) what.surprised = slice.surprised;
  what.surprises = what.surprised > 0;
  what.parts = static_cast<int>(shown.size());
  what.prediction_vertices = slice.first == report.frame ? planned.motion.vertices : 0;
  memory.count_joins(report.frame, shown, what);
  const std::string surprise = surprise_in_words(slice, report.frame);
  const std::vector<LayerShare> shares = shares_of(pipeline, memory.followed(), shown, report.frame);
  for (regulator::LayerDecision& decision : report.plan.decisions) {
    const layers::Layer& layer = report.layers[decision.layer];
    if (layer.base >= 0 || layer.is_aggregate()) {
      decision.action = regulator::Action::Drop;
      decision.reason = "policy: predictive, drawn with its surface";
      decision.cost = {};
      continue;
    }
    const LayerShare& share = shares[decision.layer];
    what.parts_drawn += share.drawn;
    decide_layer(share, planned.motion.displayed_px(report.frame - slice.first, decision.layer), surprise,
                 decision);
  }
  look_up_maps(pipeline, state, maps, report);
}

chunker::CompositeResult draw_predicted(const Drawing& drawing, PipelineState& state, FrameReport& report) {
  PredictiveMemory& memory = memory_of(drawing.pipeline, state);
  memory.slice_of(drawing.pipeline, report.frame);
  chunker::RenderCounters late;
  const double joined_before_ms = memory.joining_ms();
  const chunker::PlanBuffer* joined =
      memory.join(drawing, report.frame, report.render, late, report.late_renders, report.predictive->joined);
  report.predictive->buffer_bytes = memory.bytes();
  const Stopwatch watch;
  const layers::ivec2 display_px = drawing.pipeline.settings.view.display_px;
  chunker::Sprite sprite(display_px);
  if (joined != nullptr) sprite = joined->sprite();
  if (joined != nullptr && drawing.pipeline.settings.render.samples > 1)
    report.predictive->edge_pixels = joined->edge_texels();
  chunker::PlacedSprite placed;
  placed.sprite = &sprite;
  if (report.late) placed.screen_from_sprite = report.late->whole_picture;
  chunker::CompositeResult result =
      chunker::composite({&placed, 1}, display_px, drawing.pipeline.scene.background);
  report.times.composite_ms = memory.joining_ms() - joined_before_ms + watch.ms();
  return result;
}

std::string unpredictable(const layers::Scene& scene, const layers::LayerSet& set) {
  for (const layers::Layer& layer : set.layers) {
    if (layer.is_aggregate()) continue;
    if (!layer.fade.values.empty())
      return "layer '" + layer.name +
             "' is faded, must not be: buffers that are joined by depth know no order";
    if (layer.holds.reflection || layer.kind == layers::LayerKind::Reflection)
      return "layer '" + layer.name + "' mirrors others, must not: what it shows moves though it rests";
    for (const int part : layer.parts)
      if (const std::string why = seen_through(scene, scene.parts[part]); !why.empty())
        return why + ", must be opaque: buffers that are joined by depth know no order";
  }
  return {};
}

}  // namespace talisman::sequences
