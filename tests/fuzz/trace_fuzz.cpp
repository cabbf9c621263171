// SPDX-License-Identifier: Apache-2.0
// Any text in the place of a trace of poses; the first byte says in which format and how it is read. What is accepted is a
// motion whose every pose is finite.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "layers/animation.h"
#include "sequences/content/traces/trace.h"
#include "sequences/files/errors.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::sequences;
  if (size == 0) return 0;
  TraceOptions options;
  options.file = talisman::fuzz::file_of_bytes("trace", data + 1, size - 1);
  options.format = static_cast<TraceFormat>(data[0] % 5);
  options.resample = data[0] & 32 ? Resampling::Cubic : Resampling::Slerp;
  options.jumps = data[0] & 64 ? Jumps::Clip : Jumps::Keep;
  if (data[0] & 128 || options.format == TraceFormat::Colmap) options.fps = 30;
  try {
    look_through_trace(options);
    const talisman::layers::Track track{0, track_of(read_trace(options, 2), options.resample)};
    for (const double t_s : {0.0, 0.3, 1.99, 5.0}) {
      const auto place = talisman::layers::transform_at(track, {}, t_s).matrix();
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
          if (!std::isfinite(place[column][row])) std::abort();
    }
  } catch (const InputError&) {
  }
  return 0;
}
