// SPDX-License-Identifier: Apache-2.0
// The visibility sort: rays from the eye through boxes, in long double. Of two boxes on one ray the nearer must be drawn
// later, or both in one sprite.
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "layers/visibility.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using layers::VisibilityOrder;

struct SortedBox {
  dvec3 centre{0, 0, 0}, half{0.5, 0.5, 0.5};
};

struct BoxWorld {
  std::vector<SortedBox> boxes;
  dvec3 eye{0, 0, 0};
  std::vector<layers::ExplicitPair> pairs;
};

using Corners8 = std::vector<dvec3>;

std::vector<Corners8> corners_of(const BoxWorld& world) {
  std::vector<Corners8> all;
  for (const SortedBox& box : world.boxes) {
    all.emplace_back();
    for (int k = 0; k < 8; ++k)
      all.back().push_back(box.centre + box.half * dvec3{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1});
  }
  return all;
}

VisibilityOrder sort_boxes(layers::VisibilitySorter& sorter, const BoxWorld& world) {
  const std::vector<Corners8> corners = corners_of(world);
  std::vector<layers::Occluder> occluders;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    occluders.emplace_back();
    occluders.back().layer = int(i);
    occluders.back().bodies = {corners[i]};
  }
  return sorter.sort(world.eye, occluders, world.pairs);
}

struct RayRange {
  Exact in = 0, out = -1;
  bool hits() const { return in < out; }
};

/// Where the ray from the eye is inside the box, by slabs.
RayRange range_of(const SortedBox& box, const dvec3& eye, const dvec3& direction) {
  RayRange range{0, HUGE_VALL};
  for (int k = 0; k < 3; ++k) {
    const Exact from = Exact(box.centre[k]) - box.half[k] - eye[k],
                to = Exact(box.centre[k]) + box.half[k] - eye[k];
    if (direction[k] == 0) {
      if (from > 0 || to < 0) return {};
      continue;
    }
    const Exact a = from / direction[k], b = to / direction[k];
    range.in = std::max(range.in, std::min(a, b));
    range.out = std::min(range.out, std::max(a, b));
  }
  return range.hits() ? range : RayRange{};
}

/// Rays on which a nearer box is drawn before a farther one. Boxes that a ray merely touches, or that overlap on it, decide
/// nothing.
int violations(const BoxWorld& world, const VisibilityOrder& order, Random& random, int rays) {
  std::vector<int> place(world.boxes.size(), 0);
  for (std::size_t g = 0; g < order.groups_back_to_front.size(); ++g)
    for (const int layer : order.groups_back_to_front[g]) place[layer] = int(g);
  int wrong = 0;
  for (int n = 0; n < rays; ++n) {
    const SortedBox& aim = world.boxes[n % world.boxes.size()];
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const dvec3 direction = aim.centre + aim.half * dvec3(x, y, z) - world.eye;
    std::vector<RayRange> ranges;
    for (const SortedBox& box : world.boxes) ranges.push_back(range_of(box, world.eye, direction));
    bool right = true;
    for (std::size_t i = 0; i < ranges.size(); ++i)
      for (std::size_t j = 0; j < ranges.size(); ++j)
        if (ranges[i].hits() && ranges[j].hits() && ranges[i].out < ranges[j].in && place[i] < place[j])
          right = false;
    wrong += !right;
  }
  return wrong;
}

HardOutcome rays_against_order(const BoxWorld& world) {
  layers::VisibilitySorter sorter;
  const VisibilityOrder order = sort_boxes(sorter, world);
  Random random(15);
  constexpr int kRays = 4000;
  return {violations(world, order, random, kRays) / double(kRays),
          !order.merged.empty() || !order.defect.empty()};
}

/// Boxes that do not meet: those of a jittered grid.
BoxWorld scattered_boxes(double scale, dvec3 origin, double flat = 1) {
  Random random(16);
  BoxWorld world;
  for (int k = 0; k < 48; ++k) {
    const double x = k % 4 + random.uniform(-0.1, 0.1), y = k / 4 % 3 + random.uniform(-0.1, 0.1), z = k / 12;
    const double a = random.uniform(0.05, 0.38), b = random.uniform(0.05, 0.38),
                 c = random.uniform(0.05, 0.38);
    world.boxes.push_back({origin + dvec3(x, y, z) * scale, dvec3(a, b, c * flat) * scale});
  }
  world.eye = origin + dvec3(1.4, 0.7, 9) * scale;
  return world;
}

BoxWorld two_boxes(double overlap) {
  BoxWorld world;
  world.boxes = {{{0, 0, 0}, dvec3(0.5)}, {{0.1, 0.2, 1 - overlap}, dvec3(0.5)}};
  world.eye = {0.3, 0.4, 7};
  return world;
}

BoxWorld stack_of_sheets(double gap) {
  BoxWorld world;
  for (int i = 0; i < 30; ++i) world.boxes.push_back({{0, 0, i * 7 % 30 * gap}, {0.5, 0.5, 0}});
  world.eye = {0.2, 0.1, 5};
  return world;
}

/// Fifty frames in small steps, in which most answers are those of the frame before.
HardOutcome flight_in_small_steps(double step) {
  layers::VisibilitySorter sorter;
  Random random(17);
  int wrong = 0;
  constexpr int kFrames = 50, kRays = 200;
  for (int f = 0; f < kFrames; ++f) {
    BoxWorld world = scattered_boxes(1, {0, 0, 0});
    world.eye += dvec3(-3, 1, -2.5) * (f * step);
    for (std::size_t i = 0; i < world.boxes.size(); ++i)
      world.boxes[i].centre.y += 0.05 * std::sin(f * step * 20 + double(i));
    wrong += violations(world, sort_boxes(sorter, world), random, kRays);
  }
  return {wrong / double(kFrames * kRays), false};
}

void add_worlds(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, const BoxWorld& world,
                       bool refused = false) {
    cases.push_back({HardStage::Order,
                     name,
                     special,
                     extreme,
                     {0, "of the rays", "4,000 rays, long double", refused},
                     [world] { return rays_against_order(world); }});
  };
  add("48 boxes", "none of them meet", 1, scattered_boxes(1, {0, 0, 0}));
  add("48 boxes of 1e-9 m", "the same under a lens", 1e-9, scattered_boxes(1e-9, {0, 0, 0}));
  add("48 boxes of 1e12 m", "the same as a planetary system", 1e12, scattered_boxes(1e12, {0, 0, 0}));
  add("48 boxes at 1e9 m", "7 digits are left", 1e9, scattered_boxes(1, {1e9, -1e9, 1e9}));
  add("48 cards", "boxes without thickness", 1, scattered_boxes(1, {0, 0, 0}, 0));
  BoxWorld around = scattered_boxes(1, {0, 0, 0});
  around.eye = {1.5, 1.5, 1.5};
  add("all around the eye", "half of them behind the camera", 1, around);
  BoxWorld mixed = scattered_boxes(1, {0, 0, 0});
  mixed.boxes.push_back({{0, 0, -2e6}, {1e7, 1e7, 1e6}});
  add("1 m before 1e6 m", "a mountain behind the boxes", 1e7, mixed);
  add("sheets 1e-6 apart", "30 cards in a stack of 30 micrometres", 1e6, stack_of_sheets(1e-6));
  BoxWorld holding = scattered_boxes(1, {0, 0, 0});
  holding.eye = {0, 0, 3};
  holding.boxes[36] = {{0, 0, 3}, dvec3(0.3)};
  add("eye in a box", "it is in front of all", 1, holding);
  add("touching", "two boxes with a face in common", 1, two_boxes(0));
  add("overlap of 1e-4", "less than what counts as touching", 1e4, two_boxes(1e-4));
  add("overlap of 1e-2", "there is no order: one sprite", 100, two_boxes(1e-2), true);
  BoxWorld planks;
  planks.boxes = {{{0, -1, 0}, {2, 0.2, 0.1}},
                  {{1, 0, 0.25}, {0.2, 2, 0.1}},
                  {{0, 0.8, 0.5}, {2, 0.2, 0.1}},
                  {{-1, 0, 0.9}, {0.2, 2, 0.1}}};
  planks.eye = {0, 0, 9};
  add("planks across", "crossing in the view and not in space", 1, planks);
}

/// Three bars along the axes, each passes before the next from a corner: a cycle.
BoxWorld cyclic_bars(double scale) {
  BoxWorld world;
  world.boxes = {{dvec3(0, 1, -1) * scale, dvec3(3, 0.3, 0.3) * scale},
                 {dvec3(-1, 0, 1) * scale, dvec3(0.3, 3, 0.3) * scale},
                 {dvec3(1, -1, 0) * scale, dvec3(0.3, 0.3, 3) * scale}};
  world.eye = dvec3(12, 12, 12) * scale;
  return world;
}

HardOutcome unrelated_to_nothing() {
  BoxWorld world = scattered_boxes(1, {0, 0, 0});
  world.boxes[20].centre.x = std::numeric_limits<double>::quiet_NaN();
  layers::VisibilitySorter sorter;
  const VisibilityOrder order = sort_boxes(sorter, world);
  Random random(18);
  BoxWorld rest = world;
  rest.boxes[20] = {{0, 0, -1e9}, dvec3(1e-9)};  // no ray meets it
  return {violations(rest, order, random, 4000) / 4000.0, !order.merged.empty()};
}

void add_special(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, bool refused,
                       std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Order,
                     name,
                     special,
                     extreme,
                     {0, "of the rays", "rays, long double", refused},
                     std::move(measure)});
  };
  for (const auto& [scale, text] :
       {std::pair{1.0, "three bars"}, {1e-6, "three bars of 1e-6 m"}, {1e6, "three bars of 1e6 m"}})
    add(text, "each before the next: one sprite", scale, true,
        [scale = scale] { return rays_against_order(cyclic_bars(scale)); });
  BoxWorld contradicted = scattered_boxes(1, {0, 0, 0});
  contradicted.boxes.resize(3);
  contradicted.pairs = {{0, 1}, {1, 2}, {2, 0}};
  add("pairs in a circle", "the author's pairs cannot be kept", 1, true,
      [contradicted] { return rays_against_order(contradicted); });
  add("not a number", "one box without a place", 1, false, unrelated_to_nothing);
  add("steps of 1e-3", "50 frames, answers of the frame before", 1e3, false,
      [] { return flight_in_small_steps(1e-3); });
  add("steps of 2e-2", "50 frames, through between the boxes", 50, false,
      [] { return flight_in_small_steps(2e-2); });
}

}  // namespace

std::vector<HardCase> hard_orders() {
  std::vector<HardCase> cases;
  add_worlds(cases);
  add_special(cases);
  return cases;
}

}  // namespace talisman::sequences
