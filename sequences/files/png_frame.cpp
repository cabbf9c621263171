// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/png_frame.h"

#include <spng.h>

#include <memory>
#include <optional>
#include <vector>

#include "sequences/files/file_text.h"

namespace talisman::sequences {
namespace {

constexpr std::uint32_t kMostPixelsOnASide = 16'384;

/// 0 or libspng's number of what went wrong.
int decode(spng_ctx& decoder, const std::vector<char>& bytes, Image8& image) {
  if (const int error = spng_set_image_limits(&decoder, kMostPixelsOnASide, kMostPixelsOnASide)) return error;
  if (const int error = spng_set_png_buffer(&decoder, bytes.data(), bytes.size())) return error;
  spng_ihdr header{};
  if (const int error = spng_get_ihdr(&decoder, &header)) return error;
  std::size_t size = 0;
  if (const int error = spng_decoded_image_size(&decoder, SPNG_FMT_RGB8, &size)) return error;
  image = {static_cast<int>(header.width), static_cast<int>(header.height), std::vector<std::uint8_t>(size)};
  return spng_decode_image(&decoder, image.rgb.data(), size, SPNG_FMT_RGB8, 0);
}

}  // namespace

Image8 read_png_frame(const std::string& path) {
  const std::optional<std::string> found = text_of_file(path);
  if (!found) throw InputError("cannot be read", path);
  const std::vector<char> bytes(found->begin(), found->end());
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> decoder(spng_ctx_new(0), &spng_ctx_free);
  Image8 image;
  const int error = decoder ? decode(*decoder, bytes, image) : static_cast<int>(SPNG_EMEM);
  if (error) throw InputError(std::string("is no whole PNG: ") + spng_strerror(error), path);
  return image;
}

}  // namespace talisman::sequences
