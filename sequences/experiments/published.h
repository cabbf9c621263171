// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How do measured numbers become files and words? The same way for every experiment, which says
///
///   write_report(report, dir)   its tables and pictures, as files
///   page_of(report)             what a reader sees of them, and the verdict; without blocks: nothing was measured
///
/// and gets a page beside the files, and the same words in the terminal.

#include <ostream>
#include <string>
#include <vector>

#include "layers/geometry2.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

inline void add(Page& page, const std::vector<Block>& blocks) {
  page.blocks.insert(page.blocks.end(), blocks.begin(), blocks.end());
}

/// Into the folder, which is there. Throws OutputError.
template <typename Report>
void publish(const Report& report, const std::string& dir, std::ostream& out) {
  write_report(report, dir);
  const Page page = page_of(report);
  if (page.blocks.empty()) return;
  write_page(page, dir);
  out << plain_text(page);
}

/// "canyon: frames 0-249, 512x288 px": what every page of a sequence begins with.
template <typename Range>
std::string measured_on(const std::string& sequence, const Range& frames, layers::ivec2 display_px) {
  return sequence + ": frames " + std::to_string(frames.first) + "-" + std::to_string(frames.last) + ", " +
         std::to_string(display_px.x) + "x" + std::to_string(display_px.y) + " px";
}

}  // namespace talisman::sequences
