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
///
/// A profile of our own renderer is another sum, since one thread does one thing after the other:
///
///   draw = n_d t_d + n_v t_v + n_e t_e + n_p t_p + n_l t_l + n_h t_h + n_t t_t + n_s t_s         t: ns each (software_1)
///
///     d  draws, v  vertices of the meshes, p  pixels filled, l  of them times lights that shine on them, h  times lights
///     that make highlights, t  filtered look-ups of textures, s  of shadow maps
///     e  pixels at edges of triangles: √(pixels · triangles drawn), as of triangles of one shape, at most all pixels
///
/// A pixel inside of a large triangle is filled with its neighbours, one at an edge becomes a fragment, which is most of the
/// work there; so small triangles cost by their edges, which neither term by itself says.

#include <array>
#include <cstddef>
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

/// What is counted of draws, and how often; or the ns that each takes.
inline constexpr std::size_t kDrawTerms = 8;
using DrawWork = std::array<double, kDrawTerms>;
inline constexpr std::array<std::string_view, kDrawTerms> kDrawTermNames = {
    "draw", "vertex", "edge pixel", "pixel", "light", "highlight", "texture look-up", "shadow look-up"};

/// Of one draw, all ≥ 0.
struct DrawCounts {
  double vertices = 0, polygons = 0;  ///< of the meshes; triangles drawn, after culling
  double pixels = 0;                  ///< filled
  double lights = 0, highlights = 0;  ///< that shine on a pixel, and that make highlights there; means
  double texture_lookups = 0, shadow_lookups = 0;
};
DrawWork draw_work(const DrawCounts& counts);

/// Σ terms · work.
double draw_ms(const DrawWork& terms, const DrawWork& work);

/// Times of our own renderer.
struct SoftwareProfile {
  std::string_view name;
  DrawWork terms;  ///< ns
};

/// One thread of the machine on which tests/bench/fit_profile fitted it, when nothing else runs there. Default options of the
/// renderer: 16 samples, shading per pixel, trilinear; sprites as layers draw them.
const SoftwareProfile& software_1();

ModelledTime modelled_time(const HardwareProfile& profile, std::int64_t polygons,
                           std::int64_t pixels_rendered, std::int64_t pixels_composited,
                           std::int64_t bytes_uploaded = 0);

}  // namespace talisman::regulator
