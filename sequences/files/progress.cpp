// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/progress.h"

#include <unistd.h>

#include <cstdio>

namespace talisman::sequences {

namespace {
constexpr int kBarWidth = 30;
constexpr int kPercentPerLine = 10;

std::string duration(double seconds) {
  char text[32];
  if (seconds < 60)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else
    std::snprintf(text, sizeof text, "%d min %02d s", static_cast<int>(seconds) / 60,
                  static_cast<int>(seconds) % 60);
  return text;
}
}  // namespace

Progress::Progress(ProgressKind kind, std::string what, int total, int done)
    : kind_(kind),
      what_(std::move(what)),
      total_(total),
      done_(done),
      done_at_start_(done),
      start_(std::chrono::steady_clock::now()) {
  if (kind_ == ProgressKind::Auto) kind_ = isatty(STDERR_FILENO) ? ProgressKind::Bar : ProgressKind::Plain;
}

Progress::~Progress() {
  if (kind_ == ProgressKind::Bar && last_percent_ >= 0) std::fputc('\n', stderr);
}

void Progress::advance() {
  ++done_;
  print();
}

void Progress::print() {
  if (kind_ == ProgressKind::None || total_ <= 0) return;
  const int percent = static_cast<int>(100LL * done_ / total_);
  if (kind_ == ProgressKind::Plain && last_percent_ >= 0 &&
      percent / kPercentPerLine == last_percent_ / kPercentPerLine)
    return;
  last_percent_ = percent;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double per_second = seconds > 0 ? (done_ - done_at_start_) / seconds : 0;
  const std::string left = per_second > 0 ? duration((total_ - done_) / per_second) : "?";
  if (kind_ == ProgressKind::Bar) {
    const std::string bar(static_cast<std::size_t>(kBarWidth * done_ / total_), '#');
    std::fprintf(stderr, "\r%s [%-*s] %3d%%  %d/%d  %.1f frames/s  %s left   ", what_.c_str(), kBarWidth,
                 bar.c_str(), percent, done_, total_, per_second, left.c_str());
  } else {
    std::fprintf(stderr, "%d%% %s %d/%d %.1f frames/s %s left\n", percent, what_.c_str(), done_, total_,
                 per_second, left.c_str());
  }
  std::fflush(stderr);
}

}  // namespace talisman::sequences
