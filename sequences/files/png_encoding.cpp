// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/png_encoding.h"

#include <spng.h>
#include <zlib.h>

#include <cstdlib>
#include <memory>

namespace talisman::sequences {
namespace {

constexpr std::uint8_t kTrueColor = SPNG_COLOR_TYPE_TRUECOLOR;
constexpr std::uint8_t kPerceptualIntent = 0;

using Encoder = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

/// Run lengths of differences to the left: on frames of the canyon an eighth of the time of the defaults for 9 % more
/// bytes; level 1 with filters chosen line by line takes twice as long for 8 % more again.
Encoder encoder_of_frames() {
  Encoder encoder(spng_ctx_new(SPNG_CTX_ENCODER), &spng_ctx_free);
  if (!encoder) return encoder;
  spng_set_option(encoder.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_option(encoder.get(), SPNG_IMG_COMPRESSION_LEVEL, 1);
  spng_set_option(encoder.get(), SPNG_IMG_COMPRESSION_STRATEGY, Z_RLE);
  spng_set_option(encoder.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB);
  return encoder;
}

/// 0 or libspng's number of what went wrong.
int encode(spng_ctx& encoder, int width, int height, const std::uint8_t* rgb) {
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(width);
  header.height = static_cast<std::uint32_t>(height);
  header.bit_depth = 8;
  header.color_type = kTrueColor;
  if (const int error = spng_set_ihdr(&encoder, &header)) return error;
  if (const int error = spng_set_srgb(&encoder, kPerceptualIntent)) return error;
  const std::size_t bytes = std::size_t{3} * header.width * header.height;
  return spng_encode_image(&encoder, rgb, bytes, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
}

}  // namespace

EncodedPicture encoded_as_png(int width, int height, const std::uint8_t* rgb) {
  EncodedPicture encoded;
  const Encoder encoder = encoder_of_frames();
  int error = encoder ? encode(*encoder, width, height, rgb) : static_cast<int>(SPNG_EMEM);
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      error ? nullptr : spng_get_png_buffer(encoder.get(), &size, &error), &std::free);
  if (error) {
    encoded.error = spng_strerror(error);
    return encoded;
  }
  const auto* first = static_cast<const unsigned char*>(bytes.get());
  encoded.bytes.assign(first, first + size);
  return encoded;
}

}  // namespace talisman::sequences
