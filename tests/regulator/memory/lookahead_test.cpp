// SPDX-License-Identifier: Apache-2.0
// Where an eye may come to, and what it may see from there: by hand in three rooms, and against walks by lot in a building.
#include "regulator/memory/lookahead.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/animation.h"
#include "sequences/content/culling/building.h"

namespace talisman::regulator {
namespace {

using layers::dvec3;

/// Rooms of 4 m along x, with doors of 1 × 2 m in the middle of the walls between them.
std::shared_ptr<layers::CellSet> row_of_rooms(int count) {
  auto set = std::make_shared<layers::CellSet>();
  for (int i = 0; i < count; ++i)
    set->cells.push_back({"room " + std::to_string(i), {4.0 * i, 0, 0}, {4.0 * i + 4, 3, 4}});
  for (int i = 1; i < count; ++i) {
    const double x = 4.0 * i;
    set->portals.push_back({{i - 1, i}, {{x, 0, 1.5}, {x, 2, 1.5}, {x, 2, 2.5}, {x, 0, 2.5}}});
  }
  return set;
}

layers::CameraState camera_at(const dvec3& eye, const dvec3& forward) {
  layers::dmat4 world(glm::mat4_cast(layers::look_rotation(forward, {0, 0, -1}, 0)));
  world[3] = layers::dvec4(eye, 1);
  return {world, 1, 0.05, 100};
}

/// At 10 frames per second.
Observer observer_at(const dvec3& eye, const dvec3& forward, const PrefetchOptions& options) {
  return observer(camera_at(eye, forward), {640, 480}, options, 10);
}

std::vector<int> cells_of(const std::vector<RangeCell>& range) {
  std::vector<int> cells;
  for (const RangeCell& cell : range) cells.push_back(cell.cell);
  return cells;
}

StoredThing thing_at(const dvec3& middle, double size, int item, std::vector<std::int64_t> polygons) {
  return {layers::box_of(middle - dvec3(size / 2), middle + dvec3(size / 2)), item, std::move(polygons)};
}

TEST(RangeCells, AreEnteredAfterTheWayThroughTheDoors) {
  const auto set = row_of_rooms(4);
  PrefetchOptions options;
  options.speed_m_per_s = 1;  // 0.1 m a frame
  const Observer who = observer_at({3, 1.5, 2}, {1, 0, 0}, options);
  const std::vector<int> around = {0};
  options.frames = 9;
  EXPECT_EQ(cells_of(range_cells(*set, set->portals_of(), around, who, options)), (std::vector<int>{0}));
  options.frames = 10;
  const auto range = range_cells(*set, set->portals_of(), around, who, options);
  ASSERT_EQ(cells_of(range), (std::vector<int>{0, 1}));
  EXPECT_EQ(range[0].frames, 0);
  EXPECT_NEAR(range[1].frames, 10, 1e-4);
  options.frames = 1000;
  const auto all = range_cells(*set, set->portals_of(), around, who, options);
  EXPECT_EQ(cells_of(all), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_NEAR(all[3].frames, 90, 1e-4) << "4 m from door to door";
}

TEST(RangeCells, CullsKeepThoseAheadAndTheOnesAroundTheEye) {
  const auto set = row_of_rooms(5);
  PrefetchOptions options;
  options.frames = 1000;
  const std::vector<int> around = {2};
  const auto cells = [&](RangeCull cull, const dvec3& forward) {
    options.range = cull;
    return cells_of(
        range_cells(*set, set->portals_of(), around, observer_at({9, 1.5, 2}, forward, options), options));
  };
  EXPECT_EQ(cells(RangeCull::Any, {1, 0, 0}), (std::vector<int>{2, 1, 3, 0, 4}));
  EXPECT_EQ(cells(RangeCull::Plane, {1, 0, 0}), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(cells(RangeCull::Frustum, {1, 0, 0}), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(cells(RangeCull::Direction, {1, 0, 0}), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(cells(RangeCull::Direction, {0, 0, 1}), (std::vector<int>{2}));
  EXPECT_EQ(cells(RangeCull::Direction, glm::normalize(dvec3(1, 0, -0.25))), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(cells(RangeCull::Direction, {-1, 0, 0}), (std::vector<int>{2, 1, 0}));
}

TEST(RangeCells, AnEyeInADoorwayIsInBothRooms) {
  const auto set = row_of_rooms(3);
  PrefetchOptions options;
  options.frames = 1, options.range = RangeCull::Direction;
  const dvec3 eye(4, 1.5, 2);
  const auto range = range_cells(*set, set->portals_of(), cells_around(*set, eye, 0),
                                 observer_at(eye, {0, 0, 1}, options), options);
  EXPECT_EQ(cells_of(range), (std::vector<int>{0, 1})) << "whatever the cull says";
  EXPECT_EQ(range[1].frames, 0);
}

/// The same in units of 1e-4 and 1e6, also far from the origin.
TEST(RangeCells, DoNotDependOnTheUnit) {
  for (const double unit : {1e-4, 1.0, 1e6}) {
    auto set = row_of_rooms(6);
    const dvec3 shift(3 * unit, -7 * unit, 5 * unit);
    for (layers::Cell& cell : set->cells) cell.lo = unit * cell.lo + shift, cell.hi = unit * cell.hi + shift;
    for (layers::Portal& portal : set->portals)
      for (dvec3& corner : portal.corners) corner = unit * corner + shift;
    ASSERT_EQ(first_defect(*set), "");
    std::vector<StoredThing> things;
    for (int i = 0; i < 6; ++i)
      things.push_back(thing_at(unit * dvec3(4 * i + 2, 1, 2) + shift, 0.5 * unit, i, {5, 20, 80}));
    PrefetchOptions options;
    options.speed_m_per_s = unit, options.frames = 60;
    Lookahead ahead(things, set, options, 100);
    const Observer who = observer_at(unit * dvec3(3, 1.5, 2) + shift, {1, 0, 0}, options);
    EXPECT_EQ(cells_of(range_cells(*set, set->portals_of(), std::vector<int>{0}, who, options)),
              (std::vector<int>{0, 1, 2}))
        << unit;
    std::set<int> items;
    for (const LevelWant& want : ahead.wants(who)) items.insert(want.item);
    EXPECT_EQ(items.size(), 6u) << unit << ", all in one line of sight";
  }
}

TEST(Lookahead, BringsWhatIsSeenFromTheNextRoomBeforeItIsEntered) {
  const auto set = row_of_rooms(3);
  // One in each room, out of sight of the other rooms' doors but their own.
  std::vector<StoredThing> things;
  for (int i = 0; i < 3; ++i) things.push_back(thing_at({4.0 * i + 2, 0.5, 3.6}, 0.4, i, {10, 100}));
  things.push_back(thing_at({50, 0, 0}, 0.4, 3, {10}));  // in no room
  PrefetchOptions options;
  options.speed_m_per_s = 1;
  const auto items = [&](int frames) {
    options.frames = frames;
    Lookahead ahead(things, set, options, 1);
    std::map<int, int> soonest;
    for (const LevelWant& want : ahead.wants(observer_at({3, 1.5, 2}, {1, 0, 0}, options)))
      soonest.try_emplace(want.item, want.soonest);
    return soonest;
  };
  EXPECT_TRUE(items(0).empty());
  EXPECT_EQ(items(1), (std::map<int, int>{{0, 1}, {1, 1}, {3, 1}})) << "neighbours are seen whole";
  // The door is 1 m away, 10 frames; from behind it the last room is a neighbour.
  EXPECT_EQ(items(9).size(), 3u);
  EXPECT_EQ(items(10), (std::map<int, int>{{0, 1}, {1, 1}, {2, 10}, {3, 1}}));
}

TEST(Lookahead, ByCellBringsAllThatIsInIt) {
  const auto set = row_of_rooms(4);
  std::vector<StoredThing> things = {thing_at({14, 0.5, 2}, 0.4, 0, {10}),       // straight behind the doors
                                     thing_at({12.5, 0.5, 3.7}, 0.4, 1, {10})};  // beside the last one
  PrefetchOptions options;
  options.frames = 1;
  const auto count = [&](PrefetchUnit unit) {
    options.unit = unit;
    Lookahead ahead(things, set, options, 1);
    return ahead.wants(observer_at({1, 1.5, 2}, {1, 0, 0}, options)).size();
  };
  EXPECT_EQ(count(PrefetchUnit::Object), 1u);
  EXPECT_EQ(count(PrefetchUnit::Cell), 2u);
}

TEST(Lookahead, LevelsFollowTheLeastDistance) {
  // Alone in the world: from 10 m, 1 m a frame. r = √3/2 m; f = 480 / (2 tan 0.5) = 439 px.
  PrefetchOptions options;
  options.speed_m_per_s = 10;
  const std::vector<StoredThing> things = {thing_at({0, 0, -10}, 1, 0, {1, 10, 100, 1000})};
  const auto level = [&](int frames) {
    options.frames = frames;
    Lookahead ahead(things, nullptr, options, 100);
    const auto wants = ahead.wants(observer_at({0, 0, 0}, {0, 0, -1}, options));
    return wants.empty() ? -1 : wants.back().level;
  };
  // π r² f² / d²: 5.6e3 px at 9 m, 1.8e4 at 5 m, 2.2e5 at 1.43 m, all of 307,200 nearer than that.
  EXPECT_EQ(level(1), 1);
  EXPECT_EQ(level(5), 2);
  EXPECT_EQ(level(9), 3);
  EXPECT_EQ(level(0), -1);
  Lookahead ahead(things, nullptr, options, 100);
  EXPECT_EQ(ahead.drawn(0, observer_at({0, 0, 0}, {0, 0, -1}, options)), (LevelWant{0, 1, 0}));
}

TEST(Lookahead, WithoutCellsWhatIsBehindIsThereAfterTheTurn) {
  PrefetchOptions options;
  options.frames = 20;
  options.turn_deg_per_s = 100, options.speed_m_per_s = 0.01;  // 10 degrees a frame
  const Observer who = observer_at({0, 0, 0}, {0, 0, -1}, options);
  const double corner_deg = who.half_diagonal_rad * 180 / M_PI;
  const Ball behind = {{0, 0, 100}, 0.001};
  EXPECT_EQ(frames_until_in_view(behind, who, 20), static_cast<int>(std::ceil((180 - corner_deg) / 10)));
  EXPECT_EQ(frames_until_in_view(behind, who, 5), 6) << "not within five";
  EXPECT_EQ(frames_until_in_view({{0, 0, -50}, 1}, who, 20), 0);
  EXPECT_EQ(frames_until_in_view({{0, 0, 0.5}, 1}, who, 20), 0) << "the eye is in it";
  EXPECT_EQ(frames_until_in_view(ball_around(layers::kEverywhere), who, 20), 0);
}

/// Somebody who walks to the doors and turns as they like, no faster than allowed.
class Walker {
 public:
  Walker(const layers::CellSet& set, const PrefetchOptions& options, unsigned seed)
      : set_(set), portals_of_(set.portals_of()), options_(options), lot_(seed) {
    cell_ = std::uniform_int_distribution<>(0, static_cast<int>(set.cells.size()) - 1)(lot_);
    eye_ = 0.5 * (set.cells[cell_].lo + set.cells[cell_].hi);
    aim();
  }
  void step() {
    double left = options_.speed_m_per_s / 10;
    while (left > 0) {
      const double way = glm::distance(eye_, target_);
      if (way > left) {
        eye_ += left / way * (target_ - eye_);
        break;
      }
      left -= way, eye_ = target_, cell_ = next_;
      aim();
    }
    const double turn = options_.turn_deg_per_s / 10 * M_PI / 180;
    std::uniform_real_distribution<double> unit(-1, 1);
    const dvec3 axis = glm::normalize(dvec3(unit(lot_), 3 + unit(lot_), unit(lot_)));
    forward_ = glm::angleAxis(turn * unit(lot_), axis) * forward_;
  }
  layers::CameraState camera() const { return camera_at(eye_, forward_); }

 private:
  void aim() {
    const auto& portals = portals_of_[cell_];
    const int portal = portals[std::uniform_int_distribution<std::size_t>(0, portals.size() - 1)(lot_)];
    const auto& corners = set_.portals[portal].corners;
    target_ = dvec3(0);
    for (const dvec3& corner : corners) target_ += corner / static_cast<double>(corners.size());
    next_ = set_.portals[portal].cells[set_.portals[portal].cells[0] == cell_];
  }
  const layers::CellSet& set_;
  std::vector<std::vector<int>> portals_of_;
  PrefetchOptions options_;
  std::mt19937 lot_;
  int cell_ = 0, next_ = 0;
  dvec3 eye_, target_, forward_{1, 0, 0};
};

struct FurnishedBuilding {
  std::shared_ptr<layers::CellSet> set;
  std::vector<StoredThing> things;
};

/// Things by lot in the rooms of a building.
FurnishedBuilding furnished_building() {
  layers::Scene scene;
  sequences::BuildingContent content;
  content.rooms = 4, content.atrium_rooms = 1, content.furniture = 0;
  FurnishedBuilding made{std::make_shared<layers::CellSet>(sequences::add_building(scene, content)), {}};
  std::mt19937 lot(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const layers::Cell& cell : made.set->cells)
    for (int k = 0; k < 5; ++k) {
      const dvec3 middle = cell.lo + dvec3(unit(lot), unit(lot), unit(lot)) * (cell.hi - cell.lo);
      made.things.push_back(
          thing_at(middle, 0.1 + unit(lot), static_cast<int>(made.things.size()), {8, 40, 200}));
    }
  return made;
}

/// What a walker sees is wanted before, as finely and as soon, whatever they do within the bounds.
TEST(Lookahead, HoldsWhateverAWalkerComesToSee) {
  const FurnishedBuilding building = furnished_building();
  const auto portals_of = building.set->portals_of();
  PrefetchOptions options;
  options.frames = 12, options.speed_m_per_s = 6, options.turn_deg_per_s = 400;
  Lookahead ahead(building.things, building.set, options, 100);
  int checked = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Walker walker(*building.set, options, seed);
    std::vector<std::map<int, std::pair<int, int>>> wanted;  // by frame: of an item the level and its time
    for (int frame = 0; frame < 60; ++frame, walker.step()) {
      const Observer who = observer(walker.camera(), {640, 480}, options, 10);
      auto& now = wanted.emplace_back();
      for (const LevelWant& want : ahead.wants(who)) {
        auto& known = now.try_emplace(want.item, -1, want.soonest).first->second;
        known.first = std::max(known.first, want.level);
      }
      const auto around = cells_around(*building.set, who.eye, 0);
      ASSERT_FALSE(around.empty());
      const auto sights =
          sights_from_eye(*building.set, portals_of, around, who.eye, 0.06, std::span(who.view).subspan(1));
      for (std::size_t i = 0; i < building.things.size(); ++i) {
        const layers::Box3& box = building.things[i].box;
        const bool is_seen = std::any_of(sights.sights.begin(), sights.sights.end(), [&](const auto& sight) {
          const auto& cell = building.set->cells[sight.cell];
          const layers::Box3 inside = intersection(box, layers::box_of(cell.lo, cell.hi));
          return !inside.empty() && !layers::RegionTest(sight.region, 100).misses(inside);
        });
        if (!is_seen) continue;
        const LevelWant drawn = ahead.drawn(static_cast<int>(i), who);
        for (int before = std::max(0, frame - options.frames); before < frame; ++before) {
          const auto found = wanted[before].find(drawn.item);
          ASSERT_NE(found, wanted[before].end())
              << "seed " << seed << ", frame " << frame << " from " << before;
          EXPECT_GE(found->second.first, drawn.level);
          EXPECT_LE(found->second.second, frame - before);
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 5000);
}

/// Dijkstra against relaxing until nothing changes.
TEST(RangeCells, AreThoseOfRelaxingUntilNothingChanges) {
  const FurnishedBuilding building = furnished_building();
  const auto& set = *building.set;
  const auto portals_of = set.portals_of();
  PrefetchOptions options;
  options.frames = 40, options.speed_m_per_s = 3;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Walker walker(set, options, seed);
    for (int k = 0; k < 7; ++k) walker.step();
    const Observer who = observer(walker.camera(), {640, 480}, options, 10);
    const auto around = cells_around(set, who.eye, 0);
    std::vector<double> way_m(2 * set.portals.size(), HUGE_VAL), cell_m(set.cells.size(), HUGE_VAL);
    for (const int cell : around) cell_m[cell] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t way = 0; way < way_m.size(); ++way) {
        const layers::Portal& portal = set.portals[way / 2];
        const int into = portal.cells[way % 2], from = portal.cells[1 - way % 2];
        const layers::Box3 box = layers::box_of(portal.corners);
        double least = std::count(around.begin(), around.end(), from) ? 0 : HUGE_VAL;
        for (std::size_t before = 0; before < way_m.size(); ++before)
          if (set.portals[before / 2].cells[before % 2] == from && before / 2 != way / 2)
            least =
                std::min(least, way_m[before] + gap(layers::box_of(set.portals[before / 2].corners), box));
        const double now = std::max(least, gap(box, who.eye));
        if (now < way_m[way]) way_m[way] = now, changed = true;
        cell_m[into] = std::min(cell_m[into], way_m[way]);
      }
    }
    std::map<int, double> expected, found;
    for (std::size_t cell = 0; cell < cell_m.size(); ++cell)
      if (cell_m[cell] <= options.frames * who.step_m)
        expected[static_cast<int>(cell)] = cell_m[cell] / who.step_m;
    for (const RangeCell& cell : range_cells(set, portals_of, around, who, options))
      found[cell.cell] = cell.frames;
    ASSERT_EQ(found.size(), expected.size()) << "seed " << seed;
    for (const auto& [cell, frames] : expected) EXPECT_NEAR(found.at(cell), frames, 1e-9 * (1 + frames));
  }
}

TEST(Lookahead, StabListsAreWorkedOutOnceAndHoldTheCellItself) {
  const FurnishedBuilding building = furnished_building();
  std::vector<layers::Box3> boxes;
  for (const StoredThing& thing : building.things) boxes.push_back(thing.box);
  StabLists lists(building.set, boxes);
  for (int cell = 0; cell < static_cast<int>(building.set->cells.size()); ++cell) {
    const std::vector<StabEntry>& seen = lists.seen_from(cell);
    EXPECT_EQ(&seen, &lists.seen_from(cell));
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end(),
                               [](const StabEntry& a, const StabEntry& b) { return a.cell < b.cell; }));
    const auto own =
        std::find_if(seen.begin(), seen.end(), [&](const StabEntry& entry) { return entry.cell == cell; });
    ASSERT_NE(own, seen.end());
    EXPECT_EQ(own->things, lists.things_in(cell)) << "all of its own";
  }
}

}  // namespace
}  // namespace talisman::regulator
