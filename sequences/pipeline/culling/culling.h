// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What of a frame can be seen at all, before anything is captured or drawn.
///
/// The objects are parts. Their boxes lie in a tree (layers/box_tree.h), which is fitted again where nodes move
/// and parts deform; what passes the tests of `Settings::visibility` (visibility.h) is *seen*, a layer if one of its
/// parts is. Of a layer that is not seen nothing is captured, unless others look at where it is (what casts a
/// shadow, is mirrored, or receives one of the two): it is out of view. Shadow maps and mirrors are drawn from all
/// that there is: they look from elsewhere.
///
/// Policy `direct` draws the parts that are seen; the others draw the layers that are, with all their parts: a
/// sprite is looked at later, too.

#include <memory>
#include <string>
#include <vector>

#include "layers/advance.h"
#include "layers/box_tree.h"
#include "layers/part_box.h"
#include "sequences/pipeline/culling/cell_culling.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// What is seen in one frame.
struct SeenParts {
  int frame = -1;
  std::vector<char> part;   ///< by part
  std::vector<char> layer;  ///< by id of the author's layers
  int parts = 0;
  std::int64_t polygons = 0;
  layers::QueryCounters query;  ///< of the frustum
  std::vector<char> in_view;    ///< by layer: a part is in the frustum, where that is asked for
  CellCounts cells;
};

/// What does not change during a run.
class Culling {
 public:
  Culling(const layers::Scene& scene, const LayerTable& authored, const Settings& settings);

  const VisibilityOptions& options() const { return options_; }
  const layers::SceneMotion& motion() const { return motion_; }
  const std::vector<layers::MeshBox>& boxes() const { return mesh_boxes_; }
  /// Parts whose boxes may change, ascending.
  const std::vector<int>& moving_parts() const { return moving_parts_; }
  int layer_of(int part) const { return layer_of_part_[part]; }
  /// Is the state of the layer needed even where nobody sees it?
  bool is_looked_at(int layer) const { return looked_at_[layer] != 0; }

 private:
  VisibilityOptions options_;
  layers::SceneMotion motion_;
  std::vector<layers::MeshBox> mesh_boxes_;
  std::vector<int> moving_parts_, layer_of_part_;
  std::vector<char> looked_at_;
};

/// The scene as it was looked at last, and what was seen.
struct CullingMemory {
  std::shared_ptr<const Culling> of;
  layers::SceneFrame now;           ///< as the run knows it
  layers::SceneFrame walked;        ///< as it is; empty where that is `now`
  std::vector<layers::Box3> boxes;  ///< by part
  layers::BoxTree tree;
  std::optional<CellMemory> cells;
  std::vector<int> found;
  SeenParts seen[2];  ///< of the last two frames that were asked for
  int last = 0;
};

/// What is seen in a frame; null where the run does not ask (Settings::visibility). Holds until the frame after the
/// next is asked for. Cost: O(moving nodes and parts + what is seen).
const SeenParts* seen_at(const Pipeline& pipeline, PipelineState& state, int frame);

/// Why a layer that is not seen is culled.
const char* why_culled(const SeenParts& seen, int layer);

/// What was seen is asked for anew: the scene may have changed since.
void forget_seen(PipelineState& state);

/// Does the policy draw each layer when it is seen, so that what is not seen need not be known?
bool allows_culling(regulator::Policy policy);

/// Makes the state of a layer that is not seen one out of view.
void hide(layers::LayerState& state);

}  // namespace talisman::sequences
