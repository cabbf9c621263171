// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The bounds of all layers, by id. A copy shares them: a bound never changes once it is in the table, so
/// that a table can grow by an aggregate without its hundreds of points and triangles being copied each
/// time.

#include <cstddef>
#include <memory>
#include <vector>

#include "layers/polyhedron.h"

namespace talisman::sequences {

class BoundTable {
 public:
  std::size_t size() const { return bounds_.size(); }
  const layers::LayerBound& operator[](std::size_t id) const { return *bounds_[id]; }

  /// `id` is that of a layer in the table, or the next one.
  void put(std::size_t id, layers::LayerBound bound) {
    if (id >= bounds_.size()) bounds_.resize(id + 1);
    bounds_[id] = std::make_shared<const layers::LayerBound>(std::move(bound));
  }

 private:
  std::vector<std::shared_ptr<const layers::LayerBound>> bounds_;
};

}  // namespace talisman::sequences
