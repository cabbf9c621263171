// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/utf8.h"

#include <array>
#include <cstdint>

namespace talisman::sequences {

namespace {

/// A row of table 3-7: lead bytes, the range of the second byte, and how many bytes there are. All later
/// bytes are 80 … BF.
struct Form {
  std::uint8_t first, last;
  std::uint8_t second_low, second_high;
  std::size_t length;
};

constexpr std::array kForms = {
    Form{0x01, 0x7F, 0x00, 0x00, 1}, Form{0xC2, 0xDF, 0x80, 0xBF, 2}, Form{0xE0, 0xE0, 0xA0, 0xBF, 3},
    Form{0xE1, 0xEC, 0x80, 0xBF, 3}, Form{0xED, 0xED, 0x80, 0x9F, 3}, Form{0xEE, 0xEF, 0x80, 0xBF, 3},
    Form{0xF0, 0xF0, 0x90, 0xBF, 4}, Form{0xF1, 0xF3, 0x80, 0xBF, 4}, Form{0xF4, 0xF4, 0x80, 0x8F, 4}};

/// Bytes of the well-formed sequence at the start of a text that is not empty; 0: there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(text[k]); };
  for (const Form& form : kForms) {
    if (byte(0) < form.first || byte(0) > form.last) continue;
    if (text.size() < form.length) return 0;
    if (form.length > 1 && (byte(1) < form.second_low || byte(1) > form.second_high)) return 0;
    for (std::size_t k = 2; k < form.length; ++k)
      if (byte(k) < 0x80 || byte(k) > 0xBF) return 0;
    return form.length;
  }
  return 0;
}

}  // namespace

std::optional<std::size_t> first_not_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return std::nullopt;
}

std::string utf8_from(std::string_view text) {
  std::string good;
  good.reserve(text.size());
  while (const std::optional<std::size_t> wrong = first_not_utf8(text)) {
    good.append(text.substr(0, *wrong));
    const auto byte = static_cast<std::uint8_t>(text[*wrong]);
    if (byte == 0)
      good.append("\xE2\x90\x80");
    else
      good.append({static_cast<char>(0xC0 | byte >> 6), static_cast<char>(0x80 | (byte & 0x3F))});
    text.remove_prefix(*wrong + 1);
  }
  return good.append(text);
}

}  // namespace talisman::sequences
