// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/culling/cell_plan.h"

#include <algorithm>
#include <cmath>

#include "sequences/files/number_text.h"
#include "sequences/pictures/page_text.h"

namespace talisman::sequences {

namespace {

using layers::Box3;
using layers::dvec2;

constexpr double kPlanMargin_px = 20, kPlanCaption_px = 46;

const char* fill_of_part(PlanPart is) {
  switch (is) {
    case PlanPart::Drawn:
      return "#0072b2";
    case PlanPart::OutsideOfView:
      return "#d0d0d0";
    case PlanPart::BehindWalls:
      return "#e69f00";
  }
  return "";
}

class PlanDrawing {
 public:
  explicit PlanDrawing(const CellPlan& plan) : plan_(plan) {
    for (const layers::Cell& cell : plan.cells->cells) {
      if (!is_at_height(cell)) continue;
      lo_ = {std::min(lo_.x, cell.lo.x), std::min(lo_.y, cell.lo.z)};
      hi_ = {std::max(hi_.x, cell.hi.x), std::max(hi_.y, cell.hi.z)};
    }
    if (!(lo_.x < hi_.x)) lo_ = dvec2(plan.eye.x, plan.eye.z) - 10.0, hi_ = lo_ + 20.0;
    scale_ = (kPlanWidth_px - 2 * kPlanMargin_px) / std::max({hi_.x - lo_.x, 2 * (hi_.y - lo_.y), 1e-9});
  }

  std::string draw() {
    const dvec2 size = scale_ * (hi_ - lo_) + 2 * kPlanMargin_px;
    svg_ = formatted(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"sans-serif\" "
        "font-size=\"14\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
        std::max(size.x, 700.0), size.y + kPlanCaption_px);
    add_cells();
    add_wedges();
    add_parts();
    add_portals();
    add_eye();
    add_caption(size.y);
    return svg_ + "</svg>\n";
  }

 private:
  bool is_at_height(const layers::Cell& cell) const {
    return cell.lo.y <= plan_.eye.y && plan_.eye.y <= cell.hi.y;
  }
  dvec2 at(const dvec2& p) const { return scale_ * (p - lo_) + kPlanMargin_px; }

  void add_polygon(const std::vector<dvec2>& corners, const std::string& style, const std::string& name) {
    if (corners.size() < 3) return;
    svg_ += "<polygon points=\"";
    for (const dvec2& corner : corners) svg_ += formatted("%.1f,%.1f ", at(corner).x, at(corner).y);
    svg_ += "\" " + style + "><title>" + escaped(name) + "</title></polygon>\n";
  }
  void add_box(const dvec2& lo, const dvec2& hi, const std::string& style, const std::string& name) {
    add_polygon({lo, {hi.x, lo.y}, hi, {lo.x, hi.y}}, style, name);
  }

  void add_cells() {
    for (const layers::Cell& cell : plan_.cells->cells)
      if (is_at_height(cell))
        add_box({cell.lo.x, cell.lo.z}, {cell.hi.x, cell.hi.z},
                "fill=\"#f7f7f2\" stroke=\"#444\" stroke-width=\"1.5\"", cell.name);
  }
  void add_wedges() {
    for (const layers::CellSight& sight : plan_.sights) {
      const layers::Cell& cell = plan_.cells->cells[sight.cell];
      if (is_at_height(cell))
        add_polygon(slice_at(sight.region, {cell.lo.x, cell.lo.z}, {cell.hi.x, cell.hi.z}, plan_.eye.y),
                    "fill=\"#56b4e9\" fill-opacity=\"0.35\"", "seen of " + cell.name);
    }
  }
  /// What covers half of a cell is its floor or its ceiling.
  bool is_shown(const Box3& box) const {
    if (box.empty() || box == layers::kEverywhere) return false;
    bool is_in_one = false;
    for (const layers::Cell& cell : plan_.cells->cells) {
      if (!meet(box, layers::box_of(cell.lo, cell.hi))) continue;
      is_in_one = is_in_one || is_at_height(cell);
      const Box3 inside = intersection(box, layers::box_of(cell.lo, cell.hi));
      const double area = double(inside.hi[0] - inside.lo[0]) * (inside.hi[2] - inside.lo[2]);
      if (area > 0.5 * (cell.hi.x - cell.lo.x) * (cell.hi.z - cell.lo.z)) return false;
    }
    return is_in_one;
  }
  void add_parts() {
    for (const PlanPart is : {PlanPart::OutsideOfView, PlanPart::BehindWalls, PlanPart::Drawn})
      for (const CellPlan::Part& part : plan_.parts)
        if (part.is == is && is_shown(part.box))
          add_box({part.box.lo[0], part.box.lo[2]}, {part.box.hi[0], part.box.hi[2]},
                  formatted("fill=\"%s\" fill-opacity=\"0.75\"", fill_of_part(is)), part.name);
  }
  void add_portals() {
    for (const layers::Portal& portal : plan_.cells->portals) {
      if (!is_at_height(plan_.cells->cells[portal.cells[0]]) ||
          !is_at_height(plan_.cells->cells[portal.cells[1]]))
        continue;
      const Box3 box = layers::box_of(portal.corners);
      const dvec2 a = at({box.lo[0], box.lo[2]}), b = at({box.hi[0], box.hi[2]});
      svg_ += formatted(
          "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#009e73\" stroke-width=\"4\"/>\n",
          a.x, a.y, b.x, b.y);
    }
  }
  void add_eye() {
    add_polygon(slice_at(plan_.view, lo_, hi_, plan_.eye.y),
                "fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"", "frustum");
    const dvec2 eye = at({plan_.eye.x, plan_.eye.z});
    svg_ += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"6\" fill=\"#d55e00\"/>\n", eye.x, eye.y);
  }
  void add_caption(double y) {
    svg_ += formatted("<text x=\"%.0f\" y=\"%.1f\">", kPlanMargin_px, y + 14) + escaped(plan_.title) +
            "</text>\n";
    double x = kPlanMargin_px;
    for (const auto& [color, words] : {std::pair{"#0072b2", "drawn"},
                                       {"#e69f00", "in the frustum, no row of portals shows it"},
                                       {"#d0d0d0", "outside of the frustum"},
                                       {"#56b4e9", "seen"},
                                       {"#009e73", "portal"}}) {
      svg_ += formatted(
          "<rect x=\"%.0f\" y=\"%.1f\" width=\"12\" height=\"12\" fill=\"%s\"/>"
          "<text x=\"%.0f\" y=\"%.1f\">%s</text>\n",
          x, y + 24, color, x + 18, y + 35, words);
      x += 40 + 7.5 * double(std::string(words).size());
    }
  }

  const CellPlan& plan_;
  dvec2 lo_{HUGE_VAL, HUGE_VAL}, hi_{-HUGE_VAL, -HUGE_VAL};
  double scale_ = 1;
  std::string svg_;
};

}  // namespace

std::vector<dvec2> slice_at(const layers::Region& region, const dvec2& lo, const dvec2& hi, double height_m) {
  std::vector<dvec2> corners = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
  for (const layers::Plane& plane : region) {
    const double along = std::hypot(plane.normal.x, plane.normal.z);
    if (!(along > std::fabs(plane.normal.y))) continue;
    const auto height = [&](const dvec2& p) { return plane.height({p.x, height_m, p.y}); };
    std::vector<dvec2> left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
      const double ha = height(a), hb = height(b);
      if (ha >= 0) left.push_back(a);
      if ((ha >= 0) != (hb >= 0)) left.push_back(a + ha / (ha - hb) * (b - a));
    }
    corners = std::move(left);
  }
  return corners;
}

std::string cell_plan_svg(const CellPlan& plan) { return PlanDrawing(plan).draw(); }

}  // namespace talisman::sequences
