// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/terminal_text.h"

#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

/// The character that begins the text, where it is one of those of two or three bytes that are not shown; else 0.
unsigned unseen_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.size() >= 2 && byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0) return byte(1);
  if (text.size() < 3 || byte(0) != 0xe2 || (byte(1) != 0x80 && byte(1) != 0x81)) return 0;
  const unsigned character = 0x2000u | (byte(1) & 0x3fu) << 6 | (byte(2) & 0x3fu);
  const bool turns = character == 0x200e || character == 0x200f ||
                     (character >= 0x2028 && character <= 0x202e) ||
                     (character >= 0x2066 && character <= 0x2069);
  return turns ? character : 0;
}

}  // namespace

std::string harmless(std::string_view text, bool keeps_lines) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (const unsigned character = unseen_character(text); character != 0) {
      safe += formatted("\\u%04x", character);
      text.remove_prefix(character < 0x100 ? 2 : 3);
      continue;
    }
    if ((first < 0x20 || first == 0x7f) && !(keeps_lines && first == '\n'))
      safe += formatted("\\x%02x", static_cast<unsigned>(first));
    else
      safe += text[0];
    text.remove_prefix(1);
  }
  return safe;
}

}  // namespace talisman::sequences
