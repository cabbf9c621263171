// SPDX-License-Identifier: Apache-2.0
#include "regulator/motion_words.h"

#include <algorithm>
#include <bit>

namespace talisman::regulator {

bool MotionWord::rests_over(int first, int last) const {
  last = std::min(last, frames_ - 1);
  for (int frame = first; frame <= last;) {
    const int shift = frame % 64, end = std::min(last + 1, frame - shift + 64);
    const std::uint64_t upper = end % 64 == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (end % 64)) - 1;
    if ((bits_[frame / 64] & upper) >> shift) return false;
    frame = end;
  }
  return true;
}

int MotionWord::run_start(int frame) const {
  while (!changes_at(frame)) --frame;
  return frame;
}

int MotionWord::runs() const {
  int count = 0;
  for (const std::uint64_t bits : bits_) count += std::popcount(bits);
  return count;
}

std::string MotionWord::marks() const {
  std::string text(frames_, '.');
  for (int frame = 0; frame < frames_; ++frame)
    if (changes_at(frame)) text[frame] = '#';
  return text;
}

}  // namespace talisman::regulator
