// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A drawing of one storey from above, as [Fu93 Fig. 4.7]: cells, portals, the eye with its frustum, what it sees of each
/// cell through the portals, and the parts that are drawn or culled, each with its name as a tooltip.
///
/// What is drawn is the slice at the eye's height: cells that reach there, parts that lie in one of these. Of a
/// wedge the planes count that stand upright; those of lintels and floors are left out.

#include <string>
#include <vector>

#include "layers/cell_visibility.h"
#include "layers/region.h"

namespace talisman::sequences {

enum class PlanPart { Drawn, OutsideOfView, BehindWalls };

struct CellPlan {
  struct Part {
    std::string name;
    layers::Box3 box;
    PlanPart is = PlanPart::Drawn;
  };
  const layers::CellSet* cells = nullptr;
  layers::dvec3 eye{0, 0, 0};
  layers::Region view;                    ///< of the camera
  std::vector<layers::CellSight> sights;  ///< what the eye sees of the cells
  std::vector<Part> parts;
  std::string title;
};

/// A rectangle cut off by the upright planes, as corners in x and z; fewer than three: nothing.
std::vector<layers::dvec2> slice_at(const layers::Region& region, const layers::dvec2& lo,
                                    const layers::dvec2& hi, double height_m);

/// An SVG document, at most kPlanWidth_px wide. Pure.
std::string cell_plan_svg(const CellPlan& plan);
inline constexpr double kPlanWidth_px = 1400;

}  // namespace talisman::sequences
