// SPDX-License-Identifier: Apache-2.0
#include "layers/cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::layers {
namespace {

using testing::HasSubstr;

/// Two rooms of 4 m that share the face x = 4, with a door of 1 × 2 m.
CellSet two_rooms() {
  CellSet set;
  set.cells = {{"west", {0, 0, 0}, {4, 3, 4}}, {"east", {4, 0, 0}, {8, 3, 4}}};
  set.portals = {{{0, 1}, {{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 0, 2}}}};
  return set;
}

TEST(Cells, ASetWithoutDefectHasNone) {
  EXPECT_EQ(first_defect(two_rooms()), "");
  EXPECT_EQ(first_defect(CellSet{}), "");
  EXPECT_EQ(two_rooms().extent(), 8);
}

TEST(Cells, DefectsOfCellsAreNamed) {
  CellSet set = two_rooms();
  set.cells[1].name = "west";
  EXPECT_THAT(first_defect(set), HasSubstr("cell 'west': named twice"));
  set = two_rooms();
  set.cells[1].name.clear();
  EXPECT_THAT(first_defect(set), HasSubstr("cell 1: no name"));
  set = two_rooms();
  set.cells[1].hi.y = -1;
  EXPECT_THAT(first_defect(set), HasSubstr("cell 'east': inside out along y"));
  set = two_rooms();
  set.cells[1].hi.y = set.cells[1].lo.y;
  EXPECT_THAT(first_defect(set), HasSubstr("inside out"));
  set = two_rooms();
  set.cells[1].lo.x = std::nan("");
  EXPECT_THAT(first_defect(set), HasSubstr("not finite"));
  set = two_rooms();
  set.cells[1].lo.x = 3.9;
  EXPECT_THAT(first_defect(set), HasSubstr("cells 'west' and 'east' overlap"));
}

TEST(Cells, DefectsOfPortalsAreNamed) {
  const auto defect = [](auto change) {
    CellSet set = two_rooms();
    change(set.portals[0]);
    return first_defect(set);
  };
  EXPECT_THAT(defect([](Portal& p) { p.cells[1] = 2; }), HasSubstr("portal 0: cell 2, rule: below 2"));
  EXPECT_THAT(defect([](Portal& p) { p.cells[1] = -1; }), HasSubstr("cell -1"));
  EXPECT_THAT(defect([](Portal& p) { p.cells[1] = 0; }), HasSubstr("one cell twice"));
  EXPECT_THAT(defect([](Portal& p) { p.corners.resize(2); }), HasSubstr("fewer than three corners"));
  EXPECT_THAT(defect([](Portal& p) { p.corners[2].x = 4.1; }), HasSubstr("off the shared face"));
  EXPECT_THAT(defect([](Portal& p) { p.corners[2].y = 3.1; }), HasSubstr("outside of 'west' or 'east'"));
  EXPECT_THAT(defect([](Portal& p) { p.corners[2].y = std::nan(""); }), HasSubstr("not finite"));
  EXPECT_THAT(defect([](Portal& p) { p.corners[2] = {4, 0.5, 1.2}; }), HasSubstr("not convex"));
  EXPECT_THAT(defect([](Portal& p) { std::swap(p.corners[1], p.corners[2]); }), HasSubstr("not convex"));
  EXPECT_THAT(defect([](Portal& p) {
                p.corners = {{4, 0, 1}, {4, 1, 1}, {4, 2, 1}};
              }),
              HasSubstr("without area"));
  // A star of five corners turns the same way at each, and goes round twice.
  EXPECT_THAT(defect([](Portal& p) {
                p.corners.clear();
                for (int k = 0; k < 5; ++k)
                  p.corners.push_back({4, 1.5 + std::cos(4 * M_PI * k / 5), 2 + std::sin(4 * M_PI * k / 5)});
              }),
              HasSubstr("not convex"));
}

TEST(Cells, APortalBetweenCellsThatDoNotTouchIsRefused) {
  CellSet set = two_rooms();
  set.cells[1].lo.x = 5;
  EXPECT_THAT(first_defect(set), HasSubstr("'west' and 'east' do not touch"));
}

// Corners may go round either way; any convex polygon is a portal.
TEST(Cells, PortalsOfEitherOrientationAndManyCorners) {
  CellSet set = two_rooms();
  std::reverse(set.portals[0].corners.begin(), set.portals[0].corners.end());
  EXPECT_EQ(first_defect(set), "");
  set.portals[0].corners.clear();
  for (int k = 0; k < 40; ++k)
    set.portals[0].corners.push_back({4, 1.5 + std::cos(2 * M_PI * k / 40), 2 + std::sin(2 * M_PI * k / 40)});
  EXPECT_EQ(first_defect(set), "");
}

}  // namespace
}  // namespace talisman::layers
