// SPDX-License-Identifier: Apache-2.0
// The plan of what an eye sees of cells, from above.
#include "sequences/content/culling/cell_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

using layers::dvec2;
using testing::HasSubstr;
using testing::Not;

/// Twice the area, by the corners.
double doubled_area(const std::vector<dvec2>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return std::fabs(sum);
}

TEST(CellPlan, TheSliceIsCutByUprightPlanesAlone) {
  const layers::Plane east{{1, 0, 0}, -1}, ahead{{0, 0, -2}, 4}, floor{{0, 1, 0}, -5};  // x ≥ 1, z ≤ 2, y ≥ 5
  EXPECT_EQ(doubled_area(slice_at({}, {0, 0}, {4, 3}, 1)), 24);
  EXPECT_EQ(doubled_area(slice_at({east}, {0, 0}, {4, 3}, 1)), 18);
  EXPECT_EQ(doubled_area(slice_at({east, ahead}, {0, 0}, {4, 3}, 1)), 12);
  EXPECT_EQ(doubled_area(slice_at({east, ahead, floor}, {0, 0}, {4, 3}, 1)), 12) << "a floor is left out";
  EXPECT_LT(slice_at({{{1, 0, 0}, -9}}, {0, 0}, {4, 3}, 1).size(), 3u);
  EXPECT_EQ(doubled_area(slice_at({{{1, 0, 1}, -3.5}}, {0, 0}, {4, 3}, 1)), 24 - 3.5 * 3.5 + 0.5 * 0.5);
}

TEST(CellPlan, ShowsWhatIsOnTheEyesStoreyAndWhy) {
  layers::CellSet set;
  set.cells = {
      {"hall <A>", {0, 0, 0}, {4, 3, 4}}, {"store", {4, 0, 0}, {8, 3, 4}}, {"attic", {0, 3, 0}, {8, 6, 4}}};
  set.portals = {{{0, 1}, {{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 0, 2}}}};
  CellPlan plan;
  plan.cells = &set;
  plan.eye = {1, 1.5, 2};
  plan.sights = {{0, {}}};
  plan.parts = {{"chair", layers::box_of({1, 0, 1}, {2, 1, 2}), PlanPart::Drawn},
                {"shelf", layers::box_of({6, 0, 1}, {7, 1, 2}), PlanPart::BehindWalls},
                {"carpet", layers::box_of({0, 0, 0}, {4, 0.1, 4}), PlanPart::Drawn},
                {"trunk", layers::box_of({1, 4, 1}, {2, 5, 2}), PlanPart::OutsideOfView},
                {"everywhere", layers::kEverywhere, PlanPart::Drawn},
                {"nothing", layers::Box3{}, PlanPart::Drawn}};
  plan.title = "a & b";
  const std::string svg = cell_plan_svg(plan);
  for (const char* there : {"<title>hall &lt;A&gt;</title>", "<title>store</title>", "seen of hall",
                            "<title>chair</title>", "<title>shelf</title>", "a &amp; b", "<line", "</svg>"})
    EXPECT_THAT(svg, HasSubstr(there));
  for (const char* not_there : {"attic", "trunk", "carpet", "everywhere", "nothing", "nan", "inf"})
    EXPECT_THAT(svg, Not(HasSubstr(not_there)));
}

TEST(CellPlan, AnEyeOnNoStoreyHasAPlanOfItself) {
  layers::CellSet set;
  set.cells = {{"hall", {0, 0, 0}, {4, 3, 4}}};
  CellPlan plan;
  plan.cells = &set;
  plan.eye = {1, 100, 2};
  const std::string svg = cell_plan_svg(plan);
  EXPECT_THAT(svg, HasSubstr("<circle"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace talisman::sequences
