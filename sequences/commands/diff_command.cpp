// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/diff_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <ostream>

#include <nlohmann/json.hpp>

#include "sequences/files/number_text.h"
#include "sequences/files/utf8.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/run_difference.h"

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
                const std::optional<RunDifference>& runs, std::ostream& out) {
  nlohmann::json document{{"schema", "talisman.diff/1"},
                          {"a", utf8_from(options.a)},
                          {"b", utf8_from(options.b)},
                          {"frames", nlohmann::json::array()}};
  for (const FrameDiff& frame : report.frames) {
    nlohmann::json line = json_of(frame.quality, options.quality);
    line["name"] = utf8_from(frame.name);
    document["frames"].push_back(line);
  }
  const bool has_pictures = !report.frames.empty();
  document["mean"] = has_pictures ? json_of(summary.mean, options.quality) : nlohmann::json();
  document["worst"] = has_pictures ? json_of(summary.worst, options.quality) : nlohmann::json();
  for (const auto& [key, names] : {std::pair{"only_a", &report.only_a}, {"only_b", &report.only_b}}) {
    document[key] = nlohmann::json::array();
    for (const std::string& name : *names) document[key].push_back(utf8_from(name));
  }
  if (runs) document["runs"] = json_of(*runs);
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

/// A plan and a run without frame files have none.
bool has_pictures(const std::string& folder) {
  std::error_code error;
  return std::filesystem::is_directory(folder + "/frames", error) &&
         !std::filesystem::is_empty(folder + "/frames", error);
}

/// Both are folders in which a run lies: what else they differ in is compared, too. Of a run that was stopped there
/// are pictures alone.
bool are_runs(const DiffOptions& options) {
  if (!holds_run(options.a) || !holds_run(options.b)) return false;
  if (!has_pictures(options.a) || !has_pictures(options.b)) return true;
  for (const std::string& folder : {options.a, options.b}) {
    std::error_code error;
    if (!std::filesystem::exists(folder + "/decisions.jsonl.partial", error)) continue;
    std::fprintf(stderr, "note: %s holds a run that is not complete: pictures alone are compared\n",
                 folder.c_str());
    return false;
  }
  return true;
}

std::string frames_in_words(std::size_t count, const std::string& where) {
  return std::to_string(count) + (count == 1 ? " frame is in " : " frames are in ") + where + " only";
}

/// Why the result is partial, in one line.
void say_why_partial(const DiffOptions& options, std::size_t only_a, std::size_t only_b) {
  const std::string a = only_a > 0 ? frames_in_words(only_a, options.a) : "",
                    b = only_b > 0 ? frames_in_words(only_b, options.b) : "";
  std::fprintf(stderr, "error: %s%s%s: the others were compared\n", a.c_str(),
               a.empty() || b.empty() ? "" : ", ", b.c_str());
}

}  // namespace

int run_diff(const DiffOptions& options, std::ostream& out) {
  DiffOptions effective = options;
  effective.quality.flip = options.quality.flip || !options.map_dir.empty();
  std::optional<RunDifference> runs;
  if (are_runs(options)) runs = run_difference(options.a, options.b);
  const bool compares_pictures = !runs || (has_pictures(options.a) && has_pictures(options.b));
  if (!compares_pictures && !options.map_dir.empty())
    throw InputError("--map needs pictures, but " + (has_pictures(options.a) ? options.b : options.a) +
                     " has none");
  const DiffReport report = compares_pictures ? diff(effective) : DiffReport{};
  const DiffSummary summary = summarize(report.frames);
  if (options.json) {
    print_json(report, summary, effective, runs, out);
  } else {
    if (runs) out << text_of(*runs) << "\n";
    if (compares_pictures)
      print_table(report, summary, effective, out);
    else
      out << "no pictures were compared: " << (has_pictures(options.a) ? options.b : options.a)
          << " has none\n";
  }
  if (!report.partial() && !(runs && runs->is_partial())) return kSuccess;
  const bool by_pictures = report.partial();
  say_why_partial(options, by_pictures ? report.only_a.size() : runs->only_a.size(),
                  by_pictures ? report.only_b.size() : runs->only_b.size());
  return kPartialResult;
}

}  // namespace talisman::sequences
