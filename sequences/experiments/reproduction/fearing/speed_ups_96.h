// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How much faster is it, in shape? [F96 5.2, Tables 5.24 … 5.34]
///
/// The work is counted from runs, the machine is that of the thesis, in three prices (iris.h): so a row says whether words and
/// plan tree of this run, at those prices, give the table. Rules:
///
///   rising      in the columns where something rests, no speed-up is more than 3 % below one of a shorter slice
///   order       at 1 % moving and N = 32: molecules > particles > random 50,000 > blocks > random, ties within 5 %
///   nothing     where all moves the scenarios lose at most as much as is printed, 13 % (blocks)
///   δ           1 px lifts what all moves above 1, and less so with longer slices; 0.5 px lifts it no more than that
///   k = N       two buffers take no notice of δ, and are at least as good as k = 2 where things move or rest
///
/// Cells of the tables that are not looked at (the middle columns of 50,000 quads) are not claimed.

#include <map>
#include <vector>

#include "sequences/experiments/reproduction/fearing/iris.h"
#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// One cell of a table.
struct SpeedUpCell {
  int moving_percent = 0;
  regulator::PlanShape plan;
  double printed = 0, ours = 0;
};

/// Non-decreasing with the slice in each column but 100 %.
Finding rising_96(const std::vector<SpeedUpCell>& cells);
/// Speed-ups at 1 %, N = 32, in the order of kScenarios96.
Finding order_96(const std::vector<double>& at_one_percent);
/// The largest loss where all moves.
Finding nothing_rests_96(const std::vector<SpeedUpCell>& cells);
/// What all moves at δ = 1, by growing N, k = 2.
Finding lifted_96(const std::vector<double>& by_slice);
/// Each of `lower` is at most 5 % above that of `higher`.
Finding no_higher_96(const std::vector<double>& lower, const std::vector<double>& higher);
/// Of k = N: cells of δ = 0.01, 0.5 and 1 px, in one order.
Finding indifferent_96(const std::vector<std::vector<SpeedUpCell>>& by_delta);

Item speed_ups_96();
Item motion_thresholds_96();

}  // namespace talisman::sequences
