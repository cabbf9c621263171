// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which format has a picture whose file has no name? Its first bytes say it.

#include <cstdint>
#include <span>
#include <string>

namespace talisman::sequences {

/// The usual extension without the dot; "png" where the bytes are of no known kind, so that a reader says so.
inline std::string picture_extension(std::span<const std::uint8_t> bytes) {
  const auto begins = [&](std::size_t at, std::string_view with) {
    if (bytes.size() < at + with.size()) return false;
    for (std::size_t i = 0; i < with.size(); ++i)
      if (bytes[at + i] != static_cast<std::uint8_t>(with[i])) return false;
    return true;
  };
  if (begins(0, "\xff\xd8\xff")) return "jpg";
  if (begins(0, "RIFF") && begins(8, "WEBP")) return "webp";
  if (begins(0, "GIF8")) return "gif";
  if (begins(0, "BM")) return "bmp";
  if (begins(0, "DDS ")) return "dds";
  if (begins(0, std::string_view("\x49\x49\x2a\x00", 4)) ||
      begins(0, std::string_view("\x4d\x4d\x00\x2a", 4)))
    return "tif";
  if (begins(0, "P6") || begins(0, "P5")) return "ppm";
  return "png";
}

}  // namespace talisman::sequences
