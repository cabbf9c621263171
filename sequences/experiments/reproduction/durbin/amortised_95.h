// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What [D95] prints: when an optimisation pays, and what it makes of an amusement park.
///
/// Table 1, its measurements of single objects, is missing from the copies in circulation.

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// When the utility test says yes, with the paper's own figures.
Item utility_test_95();

/// Frames a second of the park, without and with.
Item amusement_park_95();

// --- Judgements, for tests ---

/// `first_yes`: frames from which on the test says yes; 0: never. `printed` as the figures of the paper have it.
Finding break_even_finding(int first_yes, double formula_frames);

/// Frames a second before and after; the paper's grow 2.42-fold.
Finding park_finding(double direct_ms, double parts_ms, double regrouped_ms);

}  // namespace talisman::sequences
