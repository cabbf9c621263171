// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Material points of many bodies, each place once (is_same_place in clip.h).
///
/// Places are equal within kRoundingOfCrossings of their size, so they are kept in cells of their first coordinate: with
/// cells of the width
///
///   4 kRoundingOfCrossings · (the largest size)
///
/// a place equals none but those of its own cell and the two beside it. Cost: O(1) a place, some 20 ns; few places
/// are compared with each other instead.

#include <cstdint>
#include <vector>

#include "layers/clip.h"

namespace talisman::layers {

class PlaceSet {
 public:
  /// `usual`: how many there will be, about.
  explicit PlaceSet(std::size_t usual) { places_.reserve(usual); }

  /// False: it is there already, where it was added first.
  bool add(const MaterialPoint& place);
  const std::vector<MaterialPoint>& places() const { return places_; }
  std::vector<MaterialPoint> take() { return std::move(places_); }

 private:
  /// As many are compared one by one: what a hull with 26 directions has, and its crossings.
  static constexpr std::size_t kFew = 64;

  std::int64_t cell_of(double x) const;
  bool is_in_cell(std::int64_t cell, const MaterialPoint& place) const;
  void sort_into_cells(double size);
  void put_into_cell(std::size_t i);

  std::vector<MaterialPoint> places_;
  double largest_ = 0;               // of the sizes in the cells
  std::vector<std::int32_t> first_;  // by the hash of a cell: a place, or -1
  std::vector<std::int32_t> next_;   // by place: another of the same hash, or -1
};

}  // namespace talisman::layers
