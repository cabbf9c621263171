// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/wide_text.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>

namespace talisman::sequences {

namespace {

bool has_wide_mark(const std::string& bytes) {
  return bytes.size() >= 2 && (bytes.compare(0, 2, "\xFF\xFE") == 0 || bytes.compare(0, 2, "\xFE\xFF") == 0);
}

void append_utf8(std::string& text, std::uint32_t c) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | (c >> shift & 0x3F)); };
  if (c < 0x80) {
    text += static_cast<char>(c);
  } else if (c < 0x800) {
    text += static_cast<char>(0xC0 | c >> 6), tail(0);
  } else if (c < 0x10000) {
    text += static_cast<char>(0xE0 | c >> 12), tail(6), tail(0);
  } else {
    text += static_cast<char>(0xF0 | c >> 18), tail(12), tail(6), tail(0);
  }
}

bool is_high(std::uint32_t unit) { return unit >= 0xD800 && unit < 0xDC00; }
bool is_low(std::uint32_t unit) { return unit >= 0xDC00 && unit < 0xE000; }

}  // namespace

std::optional<std::string> utf8_of_utf16(const std::string& bytes) {
  if (!has_wide_mark(bytes) || bytes.size() % 2 != 0) return std::nullopt;
  const std::size_t high = bytes[0] == '\xFE' ? 0 : 1;
  const auto unit = [&](std::size_t at) -> std::uint32_t {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + high])) << 8 |
           static_cast<unsigned char>(bytes[at + 1 - high]);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at < bytes.size(); at += 2) {
    std::uint32_t c = unit(at);
    if (is_high(c)) {
      if (at + 2 >= bytes.size() || !is_low(unit(at + 2))) return std::nullopt;
      at += 2;
      c = 0x10000 + ((c - 0xD800) << 10) + (unit(at) - 0xDC00);
    } else if (c == 0 || is_low(c)) {
      return std::nullopt;
    }
    append_utf8(text, c);
  }
  return text;
}

std::optional<std::string> utf8_of_wide_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(2, '\0');
  if (!in.read(bytes.data(), 2) || !has_wide_mark(bytes)) return std::nullopt;
  bytes.append(std::istreambuf_iterator<char>(in), {});
  return utf8_of_utf16(bytes);
}

std::unique_ptr<std::istream> open_text(const std::string& path) {
  if (auto text = utf8_of_wide_file(path)) return std::make_unique<std::istringstream>(std::move(*text));
  return std::make_unique<std::ifstream>(path, std::ios::binary);
}

}  // namespace talisman::sequences
