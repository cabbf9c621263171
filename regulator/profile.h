// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What would the work have cost on hardware? A few published rates turn counters into modelled milliseconds.
///
///   render    = max(polygons / polygon rate, filled pixels / renderer pixel rate)
///   composite = composited pixels / compositor pixel rate
///   upload    = bytes of new frames of moving pictures / upload rate
///   frame     = max(render, composite, upload): they run in parallel [LS97 1.1]
///
/// A functional model: no pipeline stalls, no memory contention.

#include <cstdint>
#include <string_view>
#include <vector>

namespace talisman::regulator {

/// One number of a profile, with where it comes from.
struct ProfileNumber {
  std::string_view name;
  double value = 0;
  std::string_view unit;
  std::string_view source;
  bool confirmed = false;  ///< false: an assumption of this model
};

struct HardwareProfile {
  std::string_view name;
  double renderer_pixels_per_s = 0;
  double compositor_pixels_per_s = 0;
  double polygons_per_s = 0;
  double upload_bytes_per_s = 0;
  std::vector<ProfileNumber> numbers;  ///< the same and the rest, as printed
};

/// The Talisman reference design, with each figure's source.
const HardwareProfile& talisman_1996();

struct ModelledTime {
  double render_ms = 0, composite_ms = 0, upload_ms = 0, frame_ms = 0;
};

ModelledTime modelled_time(const HardwareProfile& profile, std::int64_t polygons,
                           std::int64_t pixels_rendered, std::int64_t pixels_composited,
                           std::int64_t bytes_uploaded = 0);

}  // namespace talisman::regulator
