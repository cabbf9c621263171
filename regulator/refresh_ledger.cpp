// SPDX-License-Identifier: Apache-2.0
#include "regulator/refresh_ledger.h"

#include <algorithm>

namespace talisman::regulator {

bool pays(const RefreshLedger& ledger, int frame, double price) {
  const int drawn = ledger.last < 0 ? ledger.whole_frame : ledger.last;
  return price * (frame - ledger.whole_frame) <= (1 + ledger.spent) * (frame - drawn);
}

RefreshLedger after_chunks(RefreshLedger ledger, int frame, double price) {
  ledger.spent += price;
  if (ledger.first < 0) ledger.first = frame;
  ledger.last = frame;
  return ledger;
}

RefreshLedger after_whole(RefreshLedger ledger, int frame) {
  const bool tried = ledger.first >= 0;
  // Without chunks: 1 for each first - whole frames.
  const bool lost =
      tried && (1 + ledger.spent) * (ledger.first - ledger.whole_frame) >= frame - ledger.whole_frame;
  if (lost || (!tried && ledger.hopeless))
    ledger.wait = std::min(2 * ledger.wait + 1, kMostSkipped);
  else if (tried)
    ledger.wait = 0;
  if (lost || ledger.hopeless)
    ledger.skip = ledger.wait;
  else
    ledger.skip = std::max(ledger.skip - 1, 0);
  ledger.spent = 0;
  ledger.whole_frame = frame;
  ledger.first = ledger.last = -1;
  ledger.hopeless = false;
  return ledger;
}

}  // namespace talisman::regulator
