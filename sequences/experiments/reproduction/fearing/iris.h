// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How fast was a frame on the machine of the thesis? [F96 5.1, Tables 5.24 … 5.34]
///
/// Of a scenario the work is counted in this run, from the words of its parts and the plan tree; the machine, an Iris 4DXG of
/// 134 MHz, is three prices:
///
///   frame = quads drawn · c + primitives · 0.05 ms + joins · 120 ms            speed-up = all quads · c / frame
///
/// c is the printed time without prediction: random 0.628 ms a quad (62.8 s, the mean of Table 5.24's control row), blocks
/// 0.168 (101 s), particles 0.0983 (23.6 min), molecules 0.09 (45 min). A join is that of two buffers of 300×300 px with
/// content, in two passes through the stencil. Its price, that of a primitive and c of the 50,000 quads, 0.41 ms, whose time is not printed, are
/// fitted to the 125 cells of Tables 5.25, 5.27, 5.28, 5.29 and 5.31, with the closed form of Table 5.26 for what is drawn:
/// 6 % in the root mean square. Where objects rest or move all the time, two prices explain the tables.

#include <string>
#include <vector>

#include "layers/layer.h"
#include "regulator/plan_tree.h"

namespace talisman::sequences {

/// The scenarios, as their tables name them.
enum class TestScenario96 { Random, Random50000, Blocks, Particles, Molecules };
inline constexpr TestScenario96 kScenarios96[] = {TestScenario96::Random, TestScenario96::Random50000,
                                                  TestScenario96::Blocks, TestScenario96::Particles,
                                                  TestScenario96::Molecules};
std::string name(TestScenario96 scenario);         ///< "random, 50,000"
std::string sequence_of(TestScenario96 scenario);  ///< "fearing/random"
double quad_ms(TestScenario96 scenario);           ///< c

/// A scenario with another share that moves, in one layer.
struct BuiltScenario96 {
  layers::Scene scene;
  layers::LayerSet layers;
  layers::ivec2 display_px{300, 300};
  double fps = 30;
  int frames = 100;
  int quads_of_thing = 1;
};
/// `is_slow`: the ranges of the tests of δ, ±0.02 units and ±1° [F96 Appendix A]. Throws InputError: the sequence is not there.
BuiltScenario96 built_scenario(TestScenario96 scenario, double moving_percent, bool is_slow = false);

/// What a run is counted of.
struct Run96 {
  TestScenario96 scenario = TestScenario96::Blocks;
  double moving_percent = 100;
  bool is_slow = false;
  double delta_px = 0.01;
  regulator::PlanShape plan;
};

/// A frame, in the mean.
struct Work96 {
  double quads = 0, quads_drawn = 0;
  double primitives = 0;
  double joins = 0;  ///< with buffers that have content
};

Work96 counted_work(const Run96& run);

double speed_up(TestScenario96 scenario, const Work96& work);

}  // namespace talisman::sequences
