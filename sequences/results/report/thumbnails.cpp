// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/thumbnails.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "sequences/files/errors.h"
#include "sequences/files/png_frame.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

std::map<int, std::string> files_of_frames(const std::string& folder) {
  std::map<int, std::string> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder + "/frames", error)) {
    const std::string stem = entry.path().stem().string(), extension = entry.path().extension().string();
    const bool is_numbered =
        !stem.empty() && stem.size() < 9 && stem.find_first_not_of("0123456789") == std::string::npos;
    if (is_numbered && (extension == ".png" || extension == ".exr"))
      files[std::stoi(stem)] = entry.path().string();
  }
  return files;
}

std::vector<Thumbnail> thumbnail_from(int frame, const std::string& file) {
  try {
    const Image8 image = file.ends_with(".png") ? read_png_frame(file) : read_image(file);
    const Image8 small = shrunk(image, std::min(image.width, kThumbnailWidth_px));
    const EncodedPicture encoded = encoded_png(small);
    if (!encoded.error.empty()) return {};
    return {{frame, small.width, small.height, {encoded.bytes.begin(), encoded.bytes.end()}}};
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

Image8 shrunk(const Image8& image, int width) {
  const int height =
      std::max(1, static_cast<int>(static_cast<std::int64_t>(image.height) * width / image.width));
  Image8 small{width, height, {}};
  small.rgb.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(width) *
                   static_cast<std::size_t>(height));
  const auto at = [](const Image8& i, int x, int y, int c) {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(i.width) + static_cast<std::size_t>(x)) *
               3 +
           static_cast<std::size_t>(c);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int x0 = x * image.width / width, x1 = std::max(x0 + 1, (x + 1) * image.width / width);
      const int y0 = y * image.height / height, y1 = std::max(y0 + 1, (y + 1) * image.height / height);
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u) sum += image.rgb[at(image, u, v, c)];
        const int area = (x1 - x0) * (y1 - y0);
        small.rgb[at(small, x, y, c)] = static_cast<std::uint8_t>((sum + area / 2) / area);
      }
    }
  return small;
}

std::vector<Thumbnail> thumbnails_of(const std::string& folder) {
  const std::map<int, std::string> files = files_of_frames(folder);
  if (files.empty()) return {};
  const std::vector<std::pair<int, std::string>> all(files.begin(), files.end());
  // The size of the picture in the middle tells how many there is room for.
  const std::vector<Thumbnail> sample = thumbnail_from(all[all.size() / 2].first, all[all.size() / 2].second);
  if (sample.empty()) return {};
  const std::size_t room =
      std::max<std::size_t>(1, kThumbnailBytes / std::max<std::size_t>(1, sample[0].png.size()));
  const std::size_t count = std::min(all.size(), room);
  std::vector<Thumbnail> thumbnails;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [frame, file] = all[k * all.size() / count];
    for (Thumbnail& thumbnail : thumbnail_from(frame, file)) {
      bytes += thumbnail.png.size();
      if (bytes <= kThumbnailBytes || thumbnails.empty()) thumbnails.push_back(std::move(thumbnail));
    }
  }
  return thumbnails;
}

}  // namespace talisman::sequences
