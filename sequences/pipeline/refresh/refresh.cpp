// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/refresh/refresh.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "chunker/pixel.h"
#include "chunker/sprite.h"
#include "fiducials/fiducials.h"
#include "layers/mesh_clusters.h"
#include "regulator/policies.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using regulator::ChunkAssessment;
using regulator::LayerAssessment;
using regulator::LayerContent;

static_assert(regulator::kRefreshChunk == chunker::kChunkSize);

/// Half a code value: what less changes, nobody sees.
constexpr double kSameLight = 1.0 / 512;

using ClustersOfMesh = std::map<int, std::vector<layers::MeshCluster>>;

LayerContent content_of(const layers::Scene& scene, const Layer& layer, ClustersOfMesh& known) {
  LayerContent content;
  for (std::size_t k = 0; k < layer.parts.size(); ++k) {
    const layers::Part& part = scene.parts[layer.parts[k]];
    const layers::Mesh& mesh = scene.meshes[part.mesh];
    content.deforms = content.deforms || layers::deforms(scene, part);
    content.vertices += static_cast<std::int64_t>(mesh.positions.size());
    content.triangles += mesh.triangle_count();
    const auto [it, is_new] = known.try_emplace(part.mesh);
    if (is_new) it->second = layers::mesh_clusters(mesh, kChunkContentTriangles);
    for (const layers::MeshCluster& cluster : it->second)
      content.boxes.push_back({static_cast<int>(k), cluster.lo, cluster.hi, cluster.triangles});
  }
  return content;
}

/// Has the light on the layer changed since then, or may it have without that anyone knows?
bool light_changed(const Layer& layer, const LayerState& then, const LayerState& now,
                   const LayerAssessment& assessment) {
  if (then.lights != now.lights || then.pictures != now.pictures) return true;
  if (then.world_from_influence != now.world_from_influence || assessment.fiducials.shade.px > 0) return true;
  const fiducials::Photometric& light = assessment.fiducials.photometric;
  if (!light.computed)
    return layer.holds.specular || (!now.lights.empty() && then.world_from_part != now.world_from_part);
  const layers::dvec3 off = layers::dvec3(1.0) - light.multiplier;
  return !(light.color <= kSameLight && std::max({off.x, off.y, off.z}) <= kSameLight);
}

/// What forbids to draw chunks alone, whatever they show.
std::string why_never(const Layer& layer, const LayerMemory& memory) {
  if (layer.is_aggregate()) return "it shares its sprite";
  if (layer.kind != layers::LayerKind::Geometry) return "it is a term of shading";
  if (layer.holds.reflection) return "it mirrors";
  if (layer.preferences.motion_blur > 0) return "it is blurred by motion";
  if (layer.preferences.max_update_rate < 1) return "its update rate is limited";
  if (!memory.maps.empty() || memory.has_old_shadows) return "its shadow maps are old";
  if (memory.placement.empty()) return "its sprite is empty";
  return {};
}

/// What its fiducials are under the warp that its chunks were fitted with.
fiducials::Report fiducials_by_chunks(const PipelineState& state, const LayerState& now,
                                      const LayerAssessment& assessment,
                                      const regulator::ChunkJudgement& judged) {
  const LayerMemory& memory = state.memory[now.layer];
  const layers::Correspondences matched = layers::correspond(
      *memory.then, now, state.layers.bound(now.layer).hull, assessment.frames_since_render);
  fiducials::Report report = fiducials::assess(*memory.then, now, memory.placement, matched, judged.fitted);
  if (assessment.preferences.whole_extents) report.sampling.magnification /= memory.placement.density_kept;
  report.geometric = {judged.left_px, judged.where_px, -1};
  report.photometric = assessment.fiducials.photometric;
  report.turned = assessment.fiducials.turned;
  return report;
}

regulator::LayerCost cost_of_chunks(const LayerContent& content, const regulator::ChunkJudgement& judged) {
  regulator::LayerCost cost;
  if (judged.over.empty()) return cost;
  cost.polygons = std::min(content.triangles, content.vertices + judged.polygons);
  cost.pixels = judged.pixels;
  cost.chunks = static_cast<std::int64_t>(judged.over.size());
  cost.bytes = cost.chunks * static_cast<std::int64_t>(sizeof(chunker::Chunk));
  return cost;
}

/// Texels drawn, in shares of those of all of the sprite: what drawing mostly costs here. On hardware that is bound by
/// polygons chunks pay less, since all vertices are transformed.
double price_of(const LayerMemory& memory, const regulator::LayerCost& cost) {
  const layers::ivec2 size = memory.placement.size_px;
  return static_cast<double>(cost.pixels) / (static_cast<double>(size.x) * size.y);
}

regulator::ChunkJudgement judge(const Pipeline& pipeline, LayerMemory& memory, const Layer& layer,
                                const LayerState& now, double limit_px) {
  const LayerContent& content = (*pipeline.contents)[layer.id];
  if (!memory.chunks)
    memory.chunks = regulator::whole_sprite(
        memory.placement, regulator::chunk_instant(content, regulator::content_view(*memory.then),
                                                   memory.placement, {}, memory.depicts_frame));
  return regulator::judge_chunks(content, *memory.chunks, regulator::content_view(now), memory.placement,
                                 now.view.display_px,
                                 {limit_px, curve_of(pipeline, layer), pipeline.settings.fit});
}

}  // namespace

bool refreshes_chunks(const Pipeline& pipeline) {
  return pipeline.contents && regulator::refreshes_chunks(pipeline.settings.regulator) &&
         !pipeline.settings.compression && pipeline.settings.accumulate <= 1;
}

std::vector<LayerContent> layer_contents(const layers::Scene& scene, const LayerTable& layers) {
  std::vector<LayerContent> contents;
  ClustersOfMesh known;
  for (const Layer& layer : layers) contents.push_back(content_of(scene, layer, known));
  return contents;
}

void assess_chunks(const Pipeline& pipeline, PipelineState& state, int layer_id, int frame,
                   LayerAssessment& assessment) {
  if (!refreshes_chunks(pipeline) || !assessment.in_view || !assessment.has_sprite) return;
  LayerMemory& memory = state.memory[layer_id];
  const Layer& layer = state.layers[layer_id];
  const double limit_px =
      pipeline.settings.regulator.thresholds.geometric_px / assessment.preferences.importance.geometric;
  const bool mixed = memory.chunks && memory.chunks->mixed();
  const bool serves = assessment.identical || assessment.fiducials.geometric.px <= limit_px;
  if (!mixed && (serves || !regulator::has_sound_fit(assessment) || !asks_for_chunks(memory.ledger))) return;
  const LayerState& now = captured_states(pipeline, state, frame)[layer_id];
  ChunkAssessment& chunks = assessment.chunks.emplace();
  chunks.mixed = mixed;
  if (mixed) assessment.identical = false;
  memory.ledger.hopeless = !mixed;
  chunks.why_whole = why_never(layer, memory);
  if (chunks.why_whole.empty() && light_changed(layer, *memory.then, now, assessment))
    chunks.why_whole = "the light on it has changed";
  if (!chunks.why_whole.empty()) return;
  regulator::ChunkJudgement judged = judge(pipeline, memory, layer, now, limit_px);
  chunks.why_whole = judged.why_whole;
  chunks.cost = cost_of_chunks((*pipeline.contents)[layer_id], judged);
  if (chunks.why_whole.empty() && !pays(memory.ledger, frame, price_of(memory, chunks.cost)))
    chunks.why_whole = "that costs less a frame";
  if (!chunks.why_whole.empty()) return;
  memory.ledger.hopeless = false;
  chunks.fitted = judged.fitted;
  chunks.fiducials = fiducials_by_chunks(state, now, assessment, judged);
  chunks.share = judged.share;
  chunks.over = std::move(judged.over);
  if (!mixed) return;
  assessment.fitted = chunks.fitted;
  assessment.fiducials = chunks.fiducials;
  assessment.fiducials.geometric.px = judged.worst_px;
}

void remember_refresh(const Pipeline& pipeline, PipelineState& state, int frame,
                      const LayerAssessment& assessment) {
  LayerMemory& memory = state.memory[assessment.layer];
  const ChunkAssessment& chunks = *assessment.chunks;
  const LayerState& now = captured_states(pipeline, state, frame)[assessment.layer];
  regulator::set_chunks(
      chunks.over,
      regulator::chunk_instant((*pipeline.contents)[assessment.layer], regulator::content_view(now),
                               memory.placement, chunks.fitted.warp.affine(), frame),
      *memory.chunks);
  memory.ledger = regulator::after_chunks(memory.ledger, frame, price_of(memory, chunks.cost));
}

RefreshReport refreshed(const regulator::FramePlan& plan) {
  RefreshReport report;
  for (const regulator::LayerDecision& decision : plan.decisions) {
    if (!decision.chunks) continue;
    report.layers += decision.action == regulator::Action::Refresh;
    report.chunks += decision.chunks->drawn;
    report.step_px = std::max(report.step_px, decision.chunks->step_px);
    report.torn_borders += decision.chunks->torn_borders;
  }
  return report;
}

std::vector<int> places_of(const regulator::SpriteChunks& chunks, std::size_t instant) {
  std::vector<int> places;
  for (std::size_t c = 0; c < chunks.of_chunk.size(); ++c)
    if (chunks.of_chunk[c] == instant) places.push_back(static_cast<int>(c));
  return places;
}

layers::SpritePlacement placement_of(const LayerMemory& memory, std::size_t instant) {
  layers::SpritePlacement placement = memory.placement;
  placement.screen_from_sprite = memory.chunks->instants[instant]->carried * placement.screen_from_sprite;
  return placement;
}

}  // namespace talisman::sequences
