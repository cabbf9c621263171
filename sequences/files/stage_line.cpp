// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/stage_line.h"

#include <cstdio>
#include <utility>

#include <unistd.h>

namespace talisman::sequences {

namespace {
constexpr const char* kClearLine = "\r\033[K";
}

struct StageLine::Line {
  std::string what;
  bool is_begun = false;
  ~Line() {
    if (is_begun) std::fputs(kClearLine, stderr);
  }
};

StageLine::StageLine(std::string what) : line_(std::make_shared<Line>()) { line_->what = std::move(what); }

void StageLine::operator()(const std::string& stage) const {
  if (isatty(STDERR_FILENO) == 0) return;
  line_->is_begun = true;
  std::fprintf(stderr, "%s%s: %s ...", kClearLine, line_->what.c_str(), stage.c_str());
  std::fflush(stderr);
}

}  // namespace talisman::sequences
