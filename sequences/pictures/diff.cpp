// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/diff.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "sequences/files/folders.h"

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
  if (!options.map_dir.empty()) prepare_folder(options.map_dir);
  if (folder) return diff_folders(options);
  return {{diff_files(fs::path(options.a).stem().string(), options.a, options.b, options)}, {}, {}};
}

}  // namespace talisman::sequences
