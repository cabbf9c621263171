// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/open_seams.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "chunker/pixel.h"
#include "layers/check.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/shade_passes.h"

namespace talisman::sequences {

namespace {

constexpr int kOpenAlpha = 8 * chunker::kOne / 255;

chunker::Frame clear_picture(layers::ivec2 size) {
  return {size.x, size.y, std::vector<chunker::Linear16>(static_cast<std::size_t>(size.x) * size.y)};
}

AlphaPlane alpha_of(std::span<const chunker::PlacedSprite> sprites, layers::ivec2 display_px) {
  chunker::Frame frame = clear_picture(display_px);
  chunker::composite_onto(frame, sprites);
  AlphaPlane plane{frame.width, frame.height, {}};
  plane.alpha.reserve(frame.pixels.size());
  for (const chunker::Linear16& pixel : frame.pixels) plane.alpha.push_back(pixel.a);
  return plane;
}

double distance_to_cut(const CutLine& cut, const layers::dvec2& p) {
  const layers::dvec2 along = cut.b_px - cut.a_px;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - cut.a_px, along) / length2, 0.0, 1.0) : 0;
  return glm::length(p - (cut.a_px + t * along));
}

/// Is everything within the distance of the pixel covered, as far as it is on the display?
bool is_inside(const AlphaPlane& whole, int x, int y, int within) {
  for (int v = std::max(y - within, 0); v <= std::min(y + within, whole.height - 1); ++v)
    for (int u = std::max(x - within, 0); u <= std::min(x + within, whole.width - 1); ++u)
      if (whole.alpha[static_cast<std::size_t>(v) * whole.width + u] < chunker::kOne - kOpenAlpha)
        return false;
  return true;
}

/// The pixels whose middle is within reach of the cut, without those at the border.
template <typename Visit>
void for_each_near(const CutLine& cut, int width, int height, int border_px, const Visit& visit) {
  const layers::dvec2 lo = glm::min(cut.a_px, cut.b_px) - cut.within_px,
                      hi = glm::max(cut.a_px, cut.b_px) + cut.within_px;
  const auto clamped = [border_px](double v, int size) {
    const double most = std::max(size - border_px, border_px);
    return static_cast<int>(std::clamp(std::floor(v), border_px * 1.0, most));
  };
  for (int y = clamped(lo.y, height); y < clamped(hi.y + 1, height); ++y)
    for (int x = clamped(lo.x, width); x < clamped(hi.x + 1, width); ++x)
      if (distance_to_cut(cut, {x + 0.5, y + 0.5}) <= cut.within_px) visit(x, y);
}

}  // namespace

int border_width_px(double uncovered_px) {
  if (!(uncovered_px > 0)) return 0;
  return 1 + static_cast<int>(std::ceil(std::min(uncovered_px, 1e6)));
}

std::int64_t open_pixels(const AlphaPlane& shown, const AlphaPlane& whole, std::span<const CutLine> cuts,
                         int border_px) {
  TALISMAN_CHECK_EQ(shown.alpha.size(), whole.alpha.size());
  std::vector<char> counted(whole.alpha.size(), 0);
  std::int64_t open = 0;
  for (const CutLine& cut : cuts)
    for_each_near(cut, whole.width, whole.height, border_px, [&](int x, int y) {
      const std::size_t at = static_cast<std::size_t>(y) * whole.width + x;
      if (counted[at] != 0 || shown.alpha[at] + kOpenAlpha >= whole.alpha[at]) return;
      if (!is_inside(whole, x, y, static_cast<int>(std::ceil(cut.within_px)))) return;
      counted[at] = 1;
      ++open;
    });
  return open;
}

SeamCounter::SeamCounter(const Pipeline& pipeline)
    : pipeline_(pipeline), edges_(layers::shared_edges(pipeline.scene, pipeline.authored.set())) {
  if (edges_.empty()) return;
  world_at_0_ = pipeline.scene.at(0).world_from_node;
  for (const layers::SharedEdge& edge : edges_) layers_.insert(layers_.end(), {edge.layer, edge.neighbour});
  std::sort(layers_.begin(), layers_.end());
  layers_.erase(std::unique(layers_.begin(), layers_.end()), layers_.end());
}

std::vector<CutLine> SeamCounter::cuts_at(const layers::SceneFrame& frame) const {
  layers::SeamOptions options;
  options.geometric_px = pipeline_.settings.regulator.thresholds.geometric_px;
  const LayerTable& all = pipeline_.authored;
  std::vector<CutLine> cuts;
  for (const layers::SharedEdge& edge : edges_) {
    const layers::ScreenEdge seen =
        layers::screen_edge(frame, edge, world_at_0_, pipeline_.settings.view.display_px);
    if (!seen.in_view) continue;
    const double within =
        layers::seam_reach_px(all[edge.layer], options) + layers::seam_reach_px(all[edge.neighbour], options);
    cuts.push_back({seen.a_px, seen.b_px, within});
  }
  return cuts;
}

std::optional<std::int64_t> SeamCounter::open_in(const PipelineState& state, const FrameReport& report,
                                                 const chunker::PreparedScene& prepared) const {
  if (edges_.empty() || !draws_sprites(pipeline_)) return std::nullopt;
  const auto shares = [&](int layer) { return std::binary_search(layers_.begin(), layers_.end(), layer); };
  std::vector<chunker::PlacedSprite> sprites;
  for (const ShownSprite& shown : report.shown) {
    const layers::Layer& layer = report.layers[shown.layer];
    const bool counts = layer.is_aggregate() ? std::any_of(layer.members.begin(), layer.members.end(), shares)
                                             : layer.base < 0 && shares(layer.id);
    if (!counts) continue;
    sprites.emplace_back();
    sprites.back().sprite = state.sprites.find(shown.layer);
    sprites.back().screen_from_sprite = shown.screen_from_sprite;
  }
  const layers::SceneFrame frame = scene_at(pipeline_, report.frame);
  const std::vector<CutLine> cuts = cuts_at(frame);
  if (cuts.empty()) return 0;
  const layers::ivec2 display_px = pipeline_.settings.view.display_px;
  layers::SpritePlacement all_of_it;
  all_of_it.size_px = display_px;
  ShadowMapStore maps;
  const chunker::RenderResult direct =
      draw_in_one_pass({pipeline_, pipeline_.authored, maps, prepared, frame}, layers_, all_of_it);
  chunker::PlacedSprite whole;
  whole.sprite = &direct.sprite;
  return open_pixels(alpha_of(sprites, display_px), alpha_of({&whole, 1}, display_px), cuts,
                     border_width_px(pipeline_.settings.regulator.thresholds.uncovered_px));
}

}  // namespace talisman::sequences
