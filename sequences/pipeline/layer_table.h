// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The layers of a run by id, each with its bound: the author's and, behind them, the aggregates.
///
/// An immutable snapshot, which a copy shares: one pointer. Who holds one (the report of a frame, a job that
/// writes it) keeps it as it is, however the run goes on.

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "layers/layer.h"
#include "layers/polyhedron.h"
#include "sequences/pipeline/bound_table.h"

namespace talisman::sequences {

class LayerTable {
 public:
  LayerTable() : LayerTable(layers::LayerSet{}, BoundTable{}) {}
  /// One bound per layer.
  LayerTable(layers::LayerSet set, BoundTable bounds)
      : content_(std::make_shared<const Content>(Content{std::move(set), std::move(bounds)})) {}
  LayerTable(const LayerTable&) = default;  // nothing is taken out of a table: there is no empty one
  LayerTable& operator=(const LayerTable&) = default;

  std::size_t size() const { return content_->set.layers.size(); }
  const layers::Layer& operator[](std::size_t id) const { return content_->set.layers[id]; }
  std::vector<layers::Layer>::const_iterator begin() const { return content_->set.layers.begin(); }
  std::vector<layers::Layer>::const_iterator end() const { return content_->set.layers.end(); }
  const layers::LayerBound& bound(std::size_t id) const { return content_->bounds[id]; }
  const layers::LayerSet& set() const { return content_->set; }
  const BoundTable& bounds() const { return content_->bounds; }

  /// Is it a copy of the other, whatever that holds?
  bool is_copy_of(const LayerTable& other) const { return content_ == other.content_; }

 private:
  struct Content {
    layers::LayerSet set;
    BoundTable bounds;
  };
  std::shared_ptr<const Content> content_;
};

}  // namespace talisman::sequences
