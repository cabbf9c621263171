// SPDX-License-Identifier: Apache-2.0
// Any bytes in the place of a picture; the first byte says under which name. Only InputError may come out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "sequences/files/image_io.h"
#include "sequences/files/png_frame.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::sequences;
  if (size == 0) return 0;
  static const char* const names[] = {"a.png", "a.jpg", "a.tga", "a.bmp", "a.exr"};
  const std::string path = talisman::fuzz::file_of_bytes(names[data[0] % 5], data + 1, size - 1);
  const auto whole = [](const Image8& image) {
    if (image.rgb.size() !=
        std::size_t(3) * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      std::abort();
  };
  try {
    whole(read_image(path));
  } catch (const InputError&) {
  }
  try {
    whole(read_png_frame(path));
  } catch (const InputError&) {
  }
  return 0;
}
