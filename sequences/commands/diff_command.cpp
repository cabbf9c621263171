// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/diff_command.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include <nlohmann/json.hpp>

#include "sequences/files/number_text.h"

namespace talisman::sequences {
namespace {

/// PSNR without infinity: what a table and JSON show of it.
nlohmann::json json_of(const Quality& quality, const QualityOptions& options) {
  nlohmann::json j{{"max_difference", quality.max_difference}, {"changed_pixels", quality.changed_pixels}};
  j["psnr_db"] = nlohmann::json(number_or_null(quality.psnr_db));
  if (options.ssim) j["ssim"] = quality.ssim;
  if (options.flip) j["flip"] = quality.flip;
  return j;
}

void print_json(const DiffReport& report, const DiffSummary& summary, const DiffOptions& options,
                std::ostream& out) {
  nlohmann::json document{
      {"schema", "talisman.diff/1"}, {"a", options.a}, {"b", options.b}, {"frames", nlohmann::json::array()}};
  for (const FrameDiff& frame : report.frames) {
    nlohmann::json line = json_of(frame.quality, options.quality);
    line["name"] = frame.name;
    document["frames"].push_back(line);
  }
  document["mean"] = json_of(summary.mean, options.quality);
  document["worst"] = json_of(summary.worst, options.quality);
  document["only_a"] = report.only_a;
  document["only_b"] = report.only_b;
  out << document.dump(2) << "\n";
}

void print_row(const std::string& name, const Quality& q, const QualityOptions& options,
               std::size_t name_width, std::ostream& out) {
  out << std::left << std::setw(static_cast<int>(name_width)) << name << std::right << std::setw(10)
      << (std::isfinite(q.psnr_db) ? fixed(q.psnr_db, 2) : "identical");
  out << std::setw(9) << (options.ssim ? fixed(q.ssim, 5) : "-") << std::setw(9)
      << (options.flip ? fixed(q.flip, 5) : "-");
  out << std::setw(5) << q.max_difference << std::setw(10) << fixed(100 * q.changed_pixels, 2) << "\n";
}

void print_missing(const std::vector<std::string>& names, const std::string& there,
                   const std::string& not_there, std::ostream& out) {
  for (const std::string& name : names)
    out << "frame " << name << " is in " << there << " only, not in " << not_there << "\n";
}

void print_table(const DiffReport& report, const DiffSummary& summary, const DiffOptions& options,
                 std::ostream& out) {
  std::size_t width = 7;
  for (const FrameDiff& frame : report.frames) width = std::max(width, frame.name.size() + 1);
  out << std::left << std::setw(static_cast<int>(width)) << "frame"
      << "   psnr_db     ssim     flip  max  changed%\n";
  for (const FrameDiff& frame : report.frames)
    print_row(frame.name, frame.quality, options.quality, width, out);
  if (report.frames.size() > 1) {
    print_row("mean", summary.mean, options.quality, width, out);
    print_row("worst", summary.worst, options.quality, width, out);
  }
  print_missing(report.only_a, options.a, options.b, out);
  print_missing(report.only_b, options.b, options.a, out);
}

}  // namespace

int run_diff(const DiffOptions& options, std::ostream& out) {
  DiffOptions effective = options;
  effective.quality.flip = options.quality.flip || !options.map_dir.empty();
  const DiffReport report = diff(effective);
  const DiffSummary summary = summarize(report.frames);
  if (options.json)
    print_json(report, summary, effective, out);
  else
    print_table(report, summary, effective, out);
  return report.partial() ? kPartialResult : kSuccess;
}

}  // namespace talisman::sequences
