// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/culling/cell_culling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talisman::sequences {

using layers::Box3;
using layers::CellSight;
using layers::RegionTest;

namespace {

/// Sights of a frame, ready to be asked about boxes, by cell.
class SightTests {
 public:
  SightTests(std::size_t cells, double reach_m) : tests_(cells), reach_m_(reach_m) {}
  void add(std::span<const CellSight> sights) {
    for (const CellSight& sight : sights) tests_[sight.cell].emplace_back(sight.region, reach_m_);
  }
  bool reaches(int cell) const { return !tests_[cell].empty(); }
  bool shows(int cell, const Box3& box) const {
    return std::any_of(tests_[cell].begin(), tests_[cell].end(),
                       [&](const RegionTest& test) { return !test.misses(box); });
  }

 private:
  std::vector<std::vector<RegionTest>> tests_;
  double reach_m_;
};

/// From the eye to the corners of what lies in the near plane.
double near_reach(const layers::CameraState& camera, layers::ivec2 display_px) {
  const double aspect = std::max(display_px.x, 1) / static_cast<double>(std::max(display_px.y, 1));
  const double tan_y = std::tan(camera.fov_y_rad / 2), tan_x = aspect * tan_y;
  return 1.001 * camera.near_m * std::sqrt(1 + tan_x * tan_x + tan_y * tan_y);
}

}  // namespace

struct CellMemory::Frame {
  layers::dvec3 eye;
  double reach;
  layers::Region view;
  std::vector<int> from;
};

CellMemory::CellMemory(std::shared_ptr<const layers::CellSet> cells, std::span<const Box3> boxes,
                       std::span<const int> moving)
    : cells_(std::move(cells)),
      portals_of_(cells_->portals_of()),
      cells_of_part_(boxes.size()),
      crosses_(boxes.size(), 0),
      moves_(boxes.size(), 0),
      sights_(cells_->cells.size()),
      objects_(cells_->cells.size()),
      reach_m_(layers::reach_of(boxes)) {
  for (const layers::Cell& cell : cells_->cells) cell_boxes_.push_back(layers::box_of(cell.lo, cell.hi));
  for (const int part : moving) moves_[part] = 1;
  std::vector<int> all(boxes.size());
  std::iota(all.begin(), all.end(), 0);
  refile(boxes, all);
}

void CellMemory::refile(std::span<const Box3> boxes, std::span<const int> parts) {
  for (const int part : parts) {
    std::vector<int>& cells = cells_of_part_[part];
    cells.clear();
    bool is_within_one = false;
    for (std::size_t cell = 0; cell < cell_boxes_.size(); ++cell) {
      if (!meet(boxes[part], cell_boxes_[cell])) continue;
      cells.push_back(static_cast<int>(cell));
      is_within_one = is_within_one || joined(boxes[part], cell_boxes_[cell]) == cell_boxes_[cell];
    }
    crosses_[part] = !cells.empty() && !is_within_one;
    reach_m_ = std::max(reach_m_, layers::reach_of({&boxes[part], 1}));
  }
}

const std::vector<CellSight>& CellMemory::sights(int cell) {
  if (!sights_[cell]) sights_[cell] = layers::sights_from_cell(*cells_, portals_of_, cell);
  return *sights_[cell];
}

/// The parts at rest that an eye in the cell may see.
const std::vector<char>& CellMemory::objects_of(int cell, std::span<const Box3> boxes) {
  std::vector<char>& objects = objects_[cell];
  if (!objects.empty() || boxes.empty()) return objects;
  SightTests tests(cell_boxes_.size(), reach_m_);
  tests.add(sights(cell));
  objects.assign(boxes.size(), 0);
  for (std::size_t part = 0; part < boxes.size(); ++part)
    for (const int in : cells_of_part_[part])
      if (tests.shows(in, intersection(boxes[part], cell_boxes_[in]))) objects[part] = 1;
  return objects;
}

bool CellMemory::is_in_wall(const Frame& frame, std::span<const Box3> boxes) const {
  const layers::dvec3 by(frame.reach);
  const Box3 near = layers::box_of(frame.eye - by, frame.eye + by);
  for (std::size_t part = 0; part < boxes.size(); ++part)
    if (crosses_[part] && meet(boxes[part], near)) return true;
  return false;
}

/// By cell: is it left by the tests of cells alone?
std::vector<char> CellMemory::cells_left(const VisibilityOptions& options, const Frame& frame) {
  std::vector<char> left(cell_boxes_.size(), 1);
  if (options.precomputed != Precomputed::None) {
    left.assign(left.size(), 0);
    for (const int cell : frame.from)
      for (const CellSight& sight : sights(cell)) left[sight.cell] = 1;
  }
  if (options.cells != ViewTest::Frustum) return left;
  const RegionTest view(frame.view, reach_m_);
  for (std::size_t cell = 0; cell < left.size(); ++cell)
    left[cell] = left[cell] && !view.misses(cell_boxes_[cell]);
  return left;
}

CellCounts CellMemory::keep_seen(const VisibilityOptions& options, const layers::CameraState& camera,
                                 layers::ivec2 display_px, std::span<const Box3> boxes,
                                 std::vector<int>& parts) {
  Frame frame{layers::dvec3(camera.world_from_camera[3]),
              near_reach(camera, display_px),
              view_region(camera, display_px, 0),
              {}};
  frame.from = cells_around(*cells_, frame.eye, frame.reach);
  CellCounts counts;
  counts.in_wall = !frame.from.empty() && is_in_wall(frame, boxes);
  if (frame.from.empty() || counts.in_wall) return counts;
  std::vector<char> left = cells_left(options, frame);
  SightTests wedges(left.size(), reach_m_);
  if (options.cells == ViewTest::Eye) {
    const layers::EyeSights eye = sights_from_eye(*cells_, portals_of_, frame.from, frame.eye, frame.reach,
                                                  std::span(frame.view).subspan(1), left);
    if (eye.gave_up) return counts;
    wedges.add(eye.sights);
    counts.wedges = static_cast<int>(eye.sights.size());
    for (std::size_t cell = 0; cell < left.size(); ++cell)
      left[cell] = left[cell] && wedges.reaches(static_cast<int>(cell));
  }
  counts.from = static_cast<int>(frame.from.size());
  counts.cells = static_cast<int>(std::count(left.begin(), left.end(), 1));
  SightTests objects(left.size(), reach_m_);  // of those that move
  if (options.precomputed == Precomputed::CellToObject)
    for (const int cell : frame.from) objects.add(sights(cell));
  std::erase_if(parts, [&](int part) {
    if (cells_of_part_[part].empty()) return false;
    if (options.precomputed == Precomputed::CellToObject && !moves_[part] &&
        std::none_of(frame.from.begin(), frame.from.end(), [&](int c) { return objects_of(c, boxes)[part]; }))
      return true;
    return std::none_of(cells_of_part_[part].begin(), cells_of_part_[part].end(), [&](int cell) {
      if (!left[cell]) return false;
      const Box3 inside = intersection(boxes[part], cell_boxes_[cell]);
      if (options.precomputed == Precomputed::CellToObject && moves_[part] && !objects.shows(cell, inside))
        return false;
      return options.objects != ViewTest::Eye || wedges.shows(cell, inside);
    });
  });
  return counts;
}

}  // namespace talisman::sequences
