// SPDX-License-Identifier: Apache-2.0
// What does the visibility order of n moving layers cost per frame? Boxes of random shape in a ball around
// the eye that grows with their number, so that each overlaps some ten others in view (fewer below n = 1000:
// the cost per layer grows with that number, so see "pairs"); each drifts and turns. The second argument is
// the motion per frame in 1/1000 of a body's size; the eye moves as fast as the bodies.
//
//   incremental   one frame after the other, as the pipeline does
//   scratch       a new sorter for every frame: no coherence, but the tree
//   brute_force   all pairs tested on the hulls, sorted from scratch; small n only
//
// tests/bench/plot_visibility draws the three over n. Counters are per frame: pairs that overlap in view,
// bodies looked up in the tree, exact tests, layers sorted.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/convex.h"
#include "layers/visibility.h"
#include "layers/visibility_order.h"
#include "tests/layers/visibility_oracle.h"

namespace talisman::layers {
namespace {

/// Boxes with half-extents 0.2 … 0.8 around the eye, in a ball whose radius grows as √n: the number of bodies
/// per solid angle and their angular size then change together, and the depth complexity stays about 1. They
/// start apart from each other.
class Swarm {
 public:
  Swarm(int count, double motion) : radius_(0.3 * std::sqrt(count) + 3) {
    tests::Dice dice(1);
    for (int i = 0; i < count; ++i) {
      Body b;
      b.half = glm::abs(dice.in_cube(0.6)) + 0.2;
      do b.centre = dice.direction() * (radius_ * std::cbrt(dice.uniform(0.1, 1)));
      while (crowded(b));
      b.velocity = dice.direction() * motion;
      b.axis = dice.direction();
      b.rate = dice.uniform(-motion, motion);
      bodies_.push_back(b);
    }
    motion_ = motion;
    points_.resize(bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      layers_.push_back({static_cast<int>(i), OrderGroup::Normal, {{}}});
  }

  void go_to(int frame) {
    // Back and forth, so that a long run does not disperse the swarm.
    const double t = 200 * std::sin(frame / 200.0);
    eye_ = dvec3{motion_ * t, 0, 0};
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& b = bodies_[i];
      const glm::dquat turn = glm::angleAxis(b.rate * t, b.axis);
      points_[i] = tests::box({0, 0, 0}, b.half);
      for (dvec3& p : points_[i]) p = b.centre + b.velocity * t + turn * p;
      layers_[i].bodies[0] = points_[i];
    }
  }
  const dvec3& eye() const { return eye_; }
  const std::vector<Occluder>& layers() const { return layers_; }

 private:
  struct Body {
    dvec3 half, centre, velocity, axis;
    double rate;
  };
  bool crowded(const Body& b) const {
    for (const Body& other : bodies_) {
      const dvec3 d = b.centre - other.centre;
      const double room = 0.8 * (glm::length(b.half) + glm::length(other.half));
      if (glm::dot(d, d) < room * room) return true;
    }
    return false;
  }

  double radius_, motion_ = 0;
  dvec3 eye_{0, 0, 0};
  std::vector<Body> bodies_;
  std::vector<tests::Points> points_;
  std::vector<Occluder> layers_;
};

/// Adds up the counters and shows their means.
class Means {
 public:
  void add(const VisibilityCounters& c) {
    ++frames_;
    pairs_ += c.pairs, queries_ += c.queries, exact_ += c.exact_tests, sorted_ += c.sorted;
    edges_ += c.edges, merged_ += c.merged_layers, swaps_ += c.swaps;
  }
  void show(benchmark::State& state) const {
    const double f = std::max(1, frames_);
    state.counters["pairs"] = pairs_ / f, state.counters["lookups"] = queries_ / f;
    state.counters["exact"] = exact_ / f, state.counters["sorted"] = sorted_ / f;
    state.counters["edges"] = edges_ / f, state.counters["merged"] = merged_ / f;
    state.counters["swaps"] = swaps_ / f;
  }

 private:
  int frames_ = 0;
  double pairs_ = 0, queries_ = 0, exact_ = 0, sorted_ = 0, edges_ = 0, merged_ = 0, swaps_ = 0;
};

void incremental(benchmark::State& state) {
  Swarm swarm(static_cast<int>(state.range(0)), static_cast<double>(state.range(1)) / 1000);
  VisibilitySorter sorter;
  int frame = 0;
  for (; frame < 10; ++frame) swarm.go_to(frame), sorter.sort(swarm.eye(), swarm.layers());
  Means means;
  for (auto _ : state) {
    state.PauseTiming();
    swarm.go_to(frame++);
    state.ResumeTiming();
    means.add(sorter.sort(swarm.eye(), swarm.layers()).counters);
  }
  means.show(state);
}

void scratch(benchmark::State& state) {
  Swarm swarm(static_cast<int>(state.range(0)), 0.002);
  swarm.go_to(10);
  Means means;
  for (auto _ : state) means.add(VisibilitySorter().sort(swarm.eye(), swarm.layers()).counters);
  means.show(state);
}

/// All pairs on the hulls, nothing kept and nothing culled.
void brute_force(benchmark::State& state) {
  Swarm swarm(static_cast<int>(state.range(0)), 0.002);
  swarm.go_to(10);
  const dvec3 eye = swarm.eye();
  const int n = static_cast<int>(swarm.layers().size());
  for (auto _ : state) {
    std::vector<OrderEdge> edges;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        const ConvexSet front{swarm.layers()[a].bodies[0]}, behind{swarm.layers()[b].bodies[0], &eye};
        if (a != b && decide_depth(front, behind, 1e-3).deeper) edges.push_back({b, a});
      }
    benchmark::DoNotOptimize(sort_line(n, edges));
  }
}

BENCHMARK(incremental)->ArgsProduct({{100, 119, 300, 1000, 3000, 10000}, {2}})->Unit(benchmark::kMicrosecond);
BENCHMARK(incremental)->ArgsProduct({{119, 10000}, {0, 1, 5, 20}})->Unit(benchmark::kMicrosecond);
BENCHMARK(scratch)->Arg(100)->Arg(300)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMicrosecond);
BENCHMARK(brute_force)->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace talisman::layers
