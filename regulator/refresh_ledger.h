// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does it pay to draw chunks alone once more, or is it time to draw the whole sprite?
///
/// All of a sprite is drawn at frame w, for the price of 1; then chunks at frames f_1 < f_2 < …, for prices q_i in shares of
/// that, which keep it for some frames each. What it costs a frame is least when chunks are drawn as long as they cost
/// less a frame than the sprite has cost so far [renewal reward: a part is replaced when its marginal cost reaches its
/// mean cost]. How long the chunks of this frame f will last is not known; the last ones have for f - f_last frames:
///
///   q / (f - f_last)  ≤  (1 + Σ q_i) / (f - w)
///
/// The first time both are the age of the sprite, and chunks are tried. Whether that was worth it is seen when the whole is
/// drawn again: without chunks it would have been at f_1, for 1 / (f_1 - w) a frame. If it was not, or if no chunk could be
/// drawn alone, chunks are not asked about for 1, 3, 7, … kMostSkipped renders.

namespace talisman::regulator {

inline constexpr int kMostSkipped = 15;

/// Of one layer. A plain value that begins with its first sprite.
struct RefreshLedger {
  double spent = 0;           ///< Σ q_i
  int whole_frame = -1;       ///< w
  int first = -1, last = -1;  ///< f_1, f_last; -1: none yet
  int wait = 0;               ///< renders that are skipped after a failure
  int skip = 0;               ///< of them, those that are left
  bool hopeless = false;      ///< no chunk could be drawn alone when the sprite was asked about
};

/// Is the sprite to be asked about at all?
inline bool asks_for_chunks(const RefreshLedger& ledger) { return ledger.skip == 0; }
bool pays(const RefreshLedger& ledger, int frame, double price);
RefreshLedger after_chunks(RefreshLedger ledger, int frame, double price);
RefreshLedger after_whole(RefreshLedger ledger, int frame);

}  // namespace talisman::regulator
