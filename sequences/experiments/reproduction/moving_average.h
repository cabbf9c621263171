// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How is a quantity of every frame made into a curve that can be read? [LS97 Fig. 22]
///
///   average(k) = (x(k) + … + x(k + n - 1)) / n          whole windows alone: N - n + 1 of them
///   share(k)   = average(k) / average of triple framing(k)
///
/// Triple framing draws in one frame of three, so a window of 15 frames holds five of its beats wherever it begins,
/// and its own curve does not wave.

#include <vector>

namespace talisman::sequences {

inline constexpr int kWindow_frames = 15;

/// Empty where there are fewer values than `window`, ≥ 1 (programmer error otherwise).
std::vector<double> moving_average(const std::vector<double>& values, int window = kWindow_frames);

/// Number by number; not a number where `whole` is 0. As many in both (programmer error otherwise).
std::vector<double> shares_of(const std::vector<double>& values, const std::vector<double>& whole);

/// 0 of no values; not a number where one of them is none.
double mean_of(const std::vector<double>& values);
/// The largest; infinite where one of them is not a number, 0 of no values.
double largest_of(const std::vector<double>& values);

}  // namespace talisman::sequences
