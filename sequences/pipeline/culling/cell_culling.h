// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which parts do cells and portals leave (layers/cell_visibility.h), and what is remembered for it?
///
/// What an eye in a cell may see is worked out when an eye first is there; the parts that rest are filed once, those
/// that move in each frame. A part that lies in several cells is seen if it is in one of them; one that lies in none is
/// never hidden. Nothing is hidden while the eye is in no cell, nor while it, or its near plane, is within the bounds of a part that
/// reaches through a cell's faces: inside of a wall nothing is opaque.

#include <memory>
#include <optional>
#include <vector>

#include "layers/cell_visibility.h"
#include "layers/scene.h"
#include "sequences/pipeline/culling/visibility.h"

namespace talisman::sequences {

/// What the tests said of one frame.
struct CellCounts {
  int from = 0;    ///< cells around the eye; 0: nothing was hidden
  int cells = 0;   ///< that are left
  int wedges = 0;  ///< of the eye
  bool in_wall = false;
};

/// Begins with the cells and the boxes of all parts; `moves` by part.
class CellMemory {
 public:
  CellMemory(std::shared_ptr<const layers::CellSet> cells, std::span<const layers::Box3> boxes,
             std::span<const int> moving);

  /// Files these parts anew.
  void refile(std::span<const layers::Box3> boxes, std::span<const int> parts);

  /// Leaves of `parts` those that pass. `view`: as of layers::view_region.
  CellCounts keep_seen(const VisibilityOptions& options, const layers::CameraState& camera,
                       layers::ivec2 display_px, std::span<const layers::Box3> boxes,
                       std::vector<int>& parts);

  /// What an eye in a cell may see; worked out once.
  const std::vector<layers::CellSight>& sights(int cell);
  const layers::CellSet& set() const { return *cells_; }
  const std::vector<int>& cells_of(int part) const { return cells_of_part_[part]; }

 private:
  struct Frame;
  bool is_in_wall(const Frame& frame, std::span<const layers::Box3> boxes) const;
  std::vector<char> cells_left(const VisibilityOptions& options, const Frame& frame);
  const std::vector<char>& objects_of(int cell, std::span<const layers::Box3> boxes);

  std::shared_ptr<const layers::CellSet> cells_;
  std::vector<std::vector<int>> portals_of_;
  std::vector<layers::Box3> cell_boxes_;
  std::vector<std::vector<int>> cells_of_part_;
  std::vector<char> crosses_;                                          ///< by part: reaches through a face
  std::vector<char> moves_;                                            ///< by part
  std::vector<std::optional<std::vector<layers::CellSight>>> sights_;  ///< by cell
  std::vector<std::vector<char>>
      objects_;  ///< by cell: the parts at rest that it may see; empty: not asked for
  double reach_m_ = 0;
};

}  // namespace talisman::sequences
