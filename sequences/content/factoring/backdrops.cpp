// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/backdrops.h"

#include <algorithm>
#include <numeric>

#include "layers/seam.h"
#include "sequences/content/default_view.h"
#include "sequences/content/factoring/seen_order.h"

namespace talisman::sequences {

namespace {

using Body = std::vector<int>;

/// Pieces that share edges, directly or through others.
std::vector<Body> surfaces_of(const layers::Scene& scene, const Pieces& pieces) {
  layers::LayerSet set;
  set.layers = pieces.layers;
  std::vector<int> root(pieces.free);
  std::iota(root.begin(), root.end(), 0);
  for (const layers::SharedEdge& edge : layers::shared_edges(scene, set)) {
    if (!pieces.is_free(edge.layer) || !pieces.is_free(edge.neighbour)) continue;
    const int a = root[edge.layer], b = root[edge.neighbour];
    if (a != b) std::replace(root.begin(), root.end(), std::max(a, b), std::min(a, b));
  }
  std::vector<Body> surfaces(pieces.free);
  for (int piece = 0; piece < static_cast<int>(pieces.free); ++piece) surfaces[root[piece]].push_back(piece);
  std::erase_if(surfaces, [](const Body& surface) { return surface.empty(); });
  return surfaces;
}

layers::WorldBounds box_of(const layers::SceneFrame& frame, const Pieces& pieces, const Body& group) {
  layers::WorldBounds box;
  for (const int piece : group)
    for (const int part : pieces.layers[piece].parts) {
      const layers::WorldBounds own = bounds_of_part(frame, frame.scene->parts[part]);
      box.lo = glm::min(box.lo, own.lo);
      box.hi = glm::max(box.hi, own.hi);
    }
  return box;
}

bool boxes_meet(const layers::WorldBounds& a, const layers::WorldBounds& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.lo[axis] > b.hi[axis] || b.lo[axis] > a.hi[axis]) return false;
  return true;
}

/// Is it around enough of the others?
bool is_around_many(const std::vector<layers::WorldBounds>& boxes, std::size_t body) {
  int met = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) met += i != body && boxes_meet(boxes[i], boxes[body]);
  return met >= std::max<double>(kFewestAround, kMostlyAround * static_cast<double>(boxes.size() - 1));
}

/// Was it seen in front of nothing at all, not even of what lies behind?
bool is_last(const DepthSamples& depths, const Body& body, int pieces) {
  for (const int piece : body)
    for (int other = 0; other < pieces; ++other)
      if (!std::binary_search(body.begin(), body.end(), other) && depths.in_front(piece, other) > 0)
        return false;
  return true;
}

/// Pieces to which the order matters: not those of the body, nor those behind.
Body others_than(const Body& body, const std::vector<bool>& behind, const Pieces& pieces) {
  Body others;
  for (int piece = 0; piece < static_cast<int>(pieces.layers.size()); ++piece) {
    const bool is_own = std::binary_search(body.begin(), body.end(), piece);
    if (!is_own && !behind[piece] && pieces.layers[piece].group == layers::OrderGroup::Normal)
      others.push_back(piece);
  }
  return others;
}

}  // namespace

std::vector<bool> pieces_behind(const layers::Scene& scene, const Pieces& pieces,
                                const DepthSamples& depths) {
  const std::vector<Body> bodies = surfaces_of(scene, pieces);
  const layers::SceneFrame frame = scene.at(0);
  std::vector<layers::WorldBounds> boxes;
  for (const Body& body : bodies) boxes.push_back(box_of(frame, pieces, body));
  std::vector<bool> behind(pieces.layers.size(), false);
  for (bool any = true; any;) {
    any = false;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (behind[bodies[i].front()]) continue;
      const Body others = others_than(bodies[i], behind, pieces);
      const double in_front = pixels_in_front(depths, bodies[i], others);
      const double after = pixels_in_front(depths, others, bodies[i]);
      const bool is_mostly_last = in_front <= kHidden * (in_front + after) && is_around_many(boxes, i);
      if (after == 0 || !(is_mostly_last || is_last(depths, bodies[i], depths.pieces()))) continue;
      for (const int piece : bodies[i]) behind[piece] = true;
      any = true;
    }
  }
  return behind;
}

std::vector<std::vector<int>> cut_by(const std::vector<bool>& behind,
                                     const std::vector<std::vector<int>>& groups) {
  std::vector<Body> cut;
  for (const Body& group : groups)
    for (const bool side : {false, true}) {
      Body part;
      std::copy_if(group.begin(), group.end(), std::back_inserter(part),
                   [&](int piece) { return behind[piece] == side; });
      if (!part.empty()) cut.push_back(std::move(part));
    }
  std::sort(cut.begin(), cut.end());
  return cut;
}

}  // namespace talisman::sequences
