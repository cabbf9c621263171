// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What [Fu93] prints of reading ahead (Tables 5.1, 5.3 and 5.7), and of queues between stages (Table 6.4).

#include <span>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// Levels skipped over the frames looked ahead.
Item prefetch_93();

/// What a queue before the renderer does to the time of an answer.
Item queues_93();

// --- Judgements, for tests ---

/// `skipped`: over kPrefetchDepths.
Finding depth_finding_93(const std::vector<double>& skipped);
/// After a sharp turn, with both culls `any`, and with `direction` and `frustum`.
Finding turn_finding_93(double any, double frugal);

/// Two stages with a queue of `depth` between: s of each frame in the first and the second. The first waits while the
/// queue is full. Of frame k
///
///   front(k) = max(front(k-1), back(k-depth-1)) + first(k)        when it leaves the first stage; back: the second
///   back(k)  = max(front(k), back(k-1)) + second(k)
struct QueueTimes {
  double frame_s = 0;     ///< from one picture to the next, mean
  double response_s = 0;  ///< from the start of the first stage to the picture, mean
};
QueueTimes queue_times(std::span<const double> first_s, std::span<const double> second_s, int depth);
/// With queues of 4, 16 and 64.
Finding queue_finding_93(const QueueTimes& few, const QueueTimes& more, const QueueTimes& most);

}  // namespace talisman::sequences
