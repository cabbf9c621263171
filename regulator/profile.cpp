// SPDX-License-Identifier: Apache-2.0
#include "regulator/profile.h"

#include <algorithm>
#include <cmath>

namespace talisman::regulator {

const HardwareProfile& talisman_1996() {
  static const HardwareProfile profile{
      "talisman-1996",
      40e6,
      320e6,
      1.5e6,
      132e6,
      {
          {"renderer", 40e6, "pixels/s", "[LS97] footnote 1, planned prototype", true},
          {"compositor", 320e6, "pixels/s", "[LS97] footnote 1, planned prototype", true},
          {"chunk", 32, "texels, each side", "[LS97 1.1]", true},
          {"sub-pixel grid", 4, "samples, each axis", "Peddie, Chasing Pixels: Microsoft's Talisman", true},
          {"polygons", 1.5e6, "1/s", "20,000-polygon scenes (Peddie) at 75 Hz", false},
          {"upload", 132e6, "bytes/s", "PCI, 32 bit at 33 MHz, at its peak: the card's bus", false},
          {"display width", 1344, "pixels", "directx.com graphics archive; other sources 1024", false},
          {"display height", 1024, "pixels", "directx.com graphics archive; other sources 768", false},
          {"refresh", 75, "Hz", "directx.com graphics archive; other sources 72", false},
          {"shared memory", 4e6, "bytes", "trade press, quoted in a forum", false},
          {"memory bandwidth", 1.2e9, "bytes/s", "trade press, quoted in a forum", false},
          {"sprite compression", 10, "ratio", "lecture slides of Lastra", false},
          {"compositor band", 32, "lines", "assumption of this model", false},
      }};
  return profile;
}

DrawWork draw_work(const DrawCounts& c) {
  const double edges = std::min(c.pixels, std::sqrt(c.pixels * c.polygons));
  return {1,
          c.vertices,
          edges,
          c.pixels,
          c.pixels * c.lights,
          c.pixels * c.highlights,
          c.texture_lookups,
          c.shadow_lookups};
}

double draw_ms(const DrawWork& terms, const DrawWork& work) {
  double ns = 0;
  for (std::size_t k = 0; k < kDrawTerms; ++k) ns += terms[k] * work[k];
  return 1e-6 * ns;
}

const SoftwareProfile& software_1() {
  static const SoftwareProfile profile{"software-1", {29000, 106, 197, 8.2, 8.3, 17, 11.4, 37}};
  return profile;
}

ModelledTime modelled_time(const HardwareProfile& profile, std::int64_t polygons,
                           std::int64_t pixels_rendered, std::int64_t pixels_composited,
                           std::int64_t bytes_uploaded) {
  ModelledTime time;
  time.render_ms = 1e3 * std::max(static_cast<double>(polygons) / profile.polygons_per_s,
                                  static_cast<double>(pixels_rendered) / profile.renderer_pixels_per_s);
  time.composite_ms = 1e3 * static_cast<double>(pixels_composited) / profile.compositor_pixels_per_s;
  time.upload_ms = 1e3 * static_cast<double>(bytes_uploaded) / profile.upload_bytes_per_s;
  time.frame_ms = std::max({time.render_ms, time.composite_ms, time.upload_ms});
  return time;
}

}  // namespace talisman::regulator
