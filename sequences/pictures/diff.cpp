// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/diff.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <map>
#include <ostream>
#include <sstream>

#include <nlohmann/json.hpp>

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;

/// Frame numbers as they are written: four digits or, from 10000, more; so the shorter is the smaller.
struct ByNumber {
  bool operator()(const std::string& a, const std::string& b) const {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  }
};
using Frames = std::map<std::string, fs::path, ByNumber>;

bool is_frame(const fs::path& path) {
  const std::string stem = path.stem().string(), extension = path.extension().string();
  return stem.size() >= 4 &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         (extension == ".png" || extension == ".exr");
}

/// The frame files of a folder by number. When a number is there as PNG and as EXR the PNG is taken.
Frames frames_of(const fs::path& folder) {
  Frames frames;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!is_frame(it->path())) continue;
    fs::path& place = frames[it->path().stem().string()];
    if (place.empty() || it->path().extension() == ".png") place = it->path();
  }
  if (error) throw InputError("cannot be listed: " + error.message(), folder.string());
  if (frames.empty() && fs::is_directory(folder / "frames", error)) return frames_of(folder / "frames");
  if (frames.empty()) throw InputError("no frames, rule: files named NNNN.png or NNNN.exr", folder.string());
  return frames;
}

std::string size_text(const Image8& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

FrameDiff diff_files(const std::string& name, const std::string& a, const std::string& b,
                     const DiffOptions& options) {
  const Image8 test = read_image(a), reference = read_image(b);
  if (test.width != reference.width || test.height != reference.height)
    throw InputError(
        "size " + size_text(test) + ", rule: the same as " + b + ", which is " + size_text(reference), a);
  QualityOptions quality = options.quality;
  const bool map = !options.map_dir.empty();
  if (map) quality.flip = false;  // it comes out of the map
  FrameDiff result{name, compare(test, reference, quality)};
  if (map) {
    const std::vector<float> error = flip_map(test, reference, options.quality.pixels_per_degree);
    result.quality.flip = mean(error);
    write_png((fs::path(options.map_dir) / (name + ".png")).string(),
              heat_map(error, test.width, test.height));
  }
  return result;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError(folder + ": cannot be created: " + error.message());
}

DiffReport diff_folders(const DiffOptions& options) {
  const Frames a = frames_of(options.a), b = frames_of(options.b);
  DiffReport report;
  for (const auto& [name, file] : b)
    if (a.count(name) == 0) report.only_b.push_back(name);
  for (const auto& [name, file] : a) {
    const auto other = b.find(name);
    if (other == b.end())
      report.only_a.push_back(name);
    else
      report.frames.push_back(diff_files(name, file.string(), other->second.string(), options));
  }
  if (report.frames.empty()) throw InputError("no frame number in common with " + options.b, options.a);
  return report;
}

/// PSNR without infinity: what a table and JSON show of it.
nlohmann::json json_of(const Quality& quality, const QualityOptions& options) {
  nlohmann::json j{{"max_difference", quality.max_difference}, {"changed_pixels", quality.changed_pixels}};
  j["psnr_db"] = std::isfinite(quality.psnr_db) ? nlohmann::json(quality.psnr_db) : nlohmann::json(nullptr);
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

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
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

DiffSummary summarize(const std::vector<FrameDiff>& frames) {
  DiffSummary summary;
  summary.frames = static_cast<int>(frames.size());
  summary.mean = summary.worst = Quality{std::numeric_limits<double>::infinity(), 1, 0, 0, 0};
  if (frames.empty()) return summary;
  double squared_error = 0, ssim = 0, flip = 0, changed = 0;
  for (const auto& [name, q] : frames) {
    squared_error += std::pow(10, -q.psnr_db / 10);  // relative to 255²; 0 when identical
    ssim += q.ssim, flip += q.flip, changed += q.changed_pixels;
    summary.worst.psnr_db = std::min(summary.worst.psnr_db, q.psnr_db);
    summary.worst.ssim = std::min(summary.worst.ssim, q.ssim);
    summary.worst.flip = std::max(summary.worst.flip, q.flip);
    summary.worst.max_difference = std::max(summary.worst.max_difference, q.max_difference);
    summary.worst.changed_pixels = std::max(summary.worst.changed_pixels, q.changed_pixels);
  }
  const double n = summary.frames;
  summary.mean = {-10 * std::log10(squared_error / n), ssim / n, flip / n, summary.worst.max_difference,
                  changed / n};
  return summary;
}

DiffReport diff(const DiffOptions& options) {
  for (const std::string& side : {options.a, options.b})
    if (!fs::exists(side)) throw InputError("does not exist", side);
  const bool folder = fs::is_directory(options.a);
  if (folder != fs::is_directory(options.b))
    throw InputError(std::string("is a ") + (folder ? "folder" : "file") + " but " + options.b +
                         " is not, rule: two of a kind",
                     options.a);
  if (!options.map_dir.empty()) make_folder(options.map_dir);
  if (folder) return diff_folders(options);
  return {{diff_files(fs::path(options.a).stem().string(), options.a, options.b, options)}, {}, {}};
}

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
