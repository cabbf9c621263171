// SPDX-License-Identifier: Apache-2.0
#include "layers/place_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talisman::layers {

namespace {

double size_of(const MaterialPoint& place) {
  const dvec4& p = place.clip[0];
  return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) + std::fabs(p.w);
}

std::size_t hash_of(std::int64_t cell, std::size_t mask) {
  const std::uint64_t mixed = static_cast<std::uint64_t>(cell) * 0x9e3779b97f4a7c15u;
  return static_cast<std::size_t>(mixed >> 32) & mask;
}

}  // namespace

std::int64_t PlaceSet::cell_of(double x) const {
  const double width = std::max(4 * kRoundingOfCrossings * largest_, std::numeric_limits<double>::min());
  return static_cast<std::int64_t>(std::floor(x / width));  // |x| ≤ largest_: fewer than 1e10 of them
}

bool PlaceSet::is_in_cell(std::int64_t cell, const MaterialPoint& place) const {
  for (std::int32_t i = first_[hash_of(cell, first_.size() - 1)]; i >= 0; i = next_[i])
    if (is_same_place(places_[i], place)) return true;
  return false;
}

void PlaceSet::put_into_cell(std::size_t i) {
  std::int32_t& first = first_[hash_of(cell_of(places_[i].clip[0].x), first_.size() - 1)];
  next_[i] = first;
  first = static_cast<std::int32_t>(i);
}

/// Anew, with room for another, of this size.
void PlaceSet::sort_into_cells(double size) {
  std::size_t slots = 4 * kFew;
  while (slots < 4 * places_.size()) slots *= 2;
  first_.assign(slots, -1);
  next_.assign(places_.size(), -1);
  for (const MaterialPoint& place : places_)
    if (std::isfinite(size_of(place))) size = std::max(size, size_of(place));
  largest_ = 2 * size;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (std::isfinite(size_of(places_[i]))) put_into_cell(i);
}

bool PlaceSet::add(const MaterialPoint& place) {
  const double size = size_of(place);
  const bool is_number = std::isfinite(size);  // else it equals nothing, not even itself
  if (is_number && places_.size() < kFew) {
    const auto is_same = [&](const MaterialPoint& p) {  // what is infinite would be near everything
      return is_same_place(p, place) && std::isfinite(size_of(p));
    };
    if (std::any_of(places_.begin(), places_.end(), is_same)) return false;
  } else if (is_number) {
    if (first_.empty() || size > largest_ || 2 * places_.size() >= first_.size()) sort_into_cells(size);
    const std::int64_t cell = cell_of(place.clip[0].x);
    for (const std::int64_t near : {cell, cell - 1, cell + 1})
      if (is_in_cell(near, place)) return false;
  }
  places_.push_back(place);
  if (first_.empty()) return true;
  next_.push_back(-1);
  if (is_number) put_into_cell(places_.size() - 1);
  return true;
}

}  // namespace talisman::layers
