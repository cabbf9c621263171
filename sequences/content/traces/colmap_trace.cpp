// SPDX-License-Identifier: Apache-2.0
// images.txt of COLMAP: two lines for each image, in no order; world→camera; no times.
#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

#include <glm/gtc/quaternion.hpp>

#include "layers/animation.h"
#include "sequences/content/traces/trace_readers.h"

namespace talisman::sequences {

namespace {

struct Image {
  std::string name;
  RawPose pose;
};

/// "frame_0012.png": what is around its last digits, and these.
struct NumberedName {
  std::string around;
  std::optional<std::int64_t> number;
};

NumberedName numbered(const std::string& name) {
  const std::size_t end = name.find_last_of("0123456789", name.find_last_of('.'));
  if (end == std::string::npos) return {name, {}};
  std::size_t begin = end;
  while (begin > 0 && name[begin - 1] >= '0' && name[begin - 1] <= '9') --begin;
  std::int64_t number = 0;
  const auto parsed = std::from_chars(name.data() + begin, name.data() + end + 1, number);
  if (parsed.ec != std::errc() || number > 1'000'000'000'000) return {name, {}};
  return {name.substr(0, begin) + "#" + name.substr(end + 1), number};
}

Image image_of(const TraceText& text, std::string_view line) {
  constexpr std::size_t kWords = 10;
  const std::vector<std::string_view> words = words_of(line, " \t", kWords);
  if (words.size() != kWords)
    text.fail("has " + std::to_string(words.size()) +
              " words, rule: id qw qx qy qz tx ty tz camera name, and a line of points behind it");
  std::array<double, 7> n{};
  for (std::size_t i = 0; i < n.size(); ++i) {
    const std::optional<double> number = trace_number(words[i + 1]);
    if (!number)
      text.fail("word " + std::to_string(i + 2) + " is " + word_in_message(words[i + 1]) +
                ", rule: a number from -1e9 to 1e9");
    n[i] = *number;
  }
  Image image;
  image.name = std::string(line.substr(static_cast<std::size_t>(words.back().data() - line.data())));
  image.pose.rotation = glm::conjugate(glm::dquat(n[0], n[1], n[2], n[3]));
  // −Rᵀt of the rotation that a quaternion nearly of unit length means; of others the sieve says so.
  image.pose.position = -(layers::unit(image.pose.rotation) * layers::dvec3(n[4], n[5], n[6]));
  image.pose.line = text.line();
  return image;
}

std::vector<Image> images_in(TraceText& text) {
  std::vector<Image> images;
  for (std::string_view line; text.next_line(line);) {
    if (line.find_first_not_of(" \t") == std::string_view::npos || line.front() == '#') continue;
    if (images.size() == kMostImages)
      text.fail("has more than " + std::to_string(kMostImages) + " images, rule: at most as many");
    images.push_back(image_of(text, line));
    if (images.back().name.size() > 255)
      text.fail("has a name of " + std::to_string(images.back().name.size()) + " bytes, rule: at most 255");
    text.skip_line();  // its points, which may be none or thousands
  }
  return images;
}

/// There are images. Where all names differ in one number alone, that is when they were taken, in units of the largest common step.
bool count_by_number(std::vector<Image>& images, double fps) {
  std::vector<std::int64_t> numbers;
  std::string around;
  for (const Image& image : images) {
    const NumberedName name = numbered(image.name);
    if (!name.number || (!numbers.empty() && name.around != around)) return false;
    around = name.around;
    numbers.push_back(*name.number);
  }
  const std::int64_t first = *std::min_element(numbers.begin(), numbers.end());
  std::int64_t step = 0;
  for (const std::int64_t number : numbers) step = std::gcd(step, number - first);
  for (std::size_t i = 0; i < images.size(); ++i)
    images[i].pose.stamp = {
        0, static_cast<double>((numbers[i] - first) / std::max<std::int64_t>(step, 1)) / fps};
  std::stable_sort(images.begin(), images.end(), [](const Image& a, const Image& b) {
    return a.pose.stamp.fraction_s < b.pose.stamp.fraction_s;
  });
  return true;
}

}  // namespace

void read_colmap(TraceText& text, double fps, const PoseSink& sink) {
  std::vector<Image> images = images_in(text);
  if (images.empty()) return;
  if (!count_by_number(images, fps)) {
    std::stable_sort(images.begin(), images.end(),
                     [](const Image& a, const Image& b) { return a.name < b.name; });
    for (std::size_t i = 0; i < images.size(); ++i) images[i].pose.stamp = {0, static_cast<double>(i) / fps};
  }
  for (const Image& image : images)
    if (!sink(image.pose)) return;
}

}  // namespace talisman::sequences
