// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/layer_words.h"

#include <algorithm>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

/// Of UTF-8: every byte that does not continue a character begins one.
bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }

std::size_t characters_in(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

std::string first_characters(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (; end < text.size(); ++end)
    if (begins_character(text[end]) && count-- == 0) break;
  return text.substr(0, end);
}

}  // namespace

std::string column_of(const std::string& layer) {
  constexpr std::size_t kWidth = 24;
  const std::size_t count = characters_in(layer);
  if (count > kWidth) return first_characters(layer, kWidth - 3) + "...";
  return layer + std::string(kWidth - count, ' ');
}

std::string picture_of(std::string layer) {
  std::replace(layer.begin(), layer.end(), '/', '-');
  return layer + ".png";
}

std::string picture_of(int frame, const std::string& layer) {
  return formatted("%04d-", frame) + picture_of(layer);
}

}  // namespace talisman::sequences
