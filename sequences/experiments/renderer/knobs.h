// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which knobs of the renderer are turned, and how far? One at a time, all others as the truth has them:
///
///   in one pass (policy direct)
///     samples             1, 4, 16
///     merge tolerances    the default, 0
///     texture filter      nearest, bilinear, trilinear, anisotropy 2 … 16        where a texture is called for
///     shading             flat, Gouraud, Phong                                   … lighting
///     normal map          off, on                                                … normal maps
///     shadow map          128 … 2048 texels                                      … a shadow map
///     shadow filter       percentage-closer radius 0 … 3 texels                  … a shadow map
///   through sprites (policy reference)
///     sprite resolution   0.25 … 2 texels per pixel, all layers
///     shade resolution    0.125 … 1, all shade layers, and each kind alone       … a shade layer
///     compression         quality 30 … 95, off
///     motion blur         as the layers ask for, off                             … motion blur
///
/// The truth is one stated setting: the finest of every knob in one pass (sprites at the display's resolution
/// have no part in it). A knob whose effect the scene does not call for is not measured, and says why.
///
/// A ladder goes from coarse to fine. A shadow's filter is the exception to "finer is nearer to the truth of
/// the scene": a larger radius is smoother, and what is called truth here is the smoothest.

#include <string>
#include <vector>

#include "sequences/experiments/variant.h"

namespace talisman::sequences {

/// What a knob is paid in: the count that grows with it.
enum class WorkKind {
  Fragments,       ///< stored
  TextureSamples,  ///< filtered look-ups
  Lightings,       ///< evaluations of the lights, at most: pixels, or corners of triangles, or triangles
  MapBytes,        ///< of the shadow maps
  DepthCompares,   ///< look-ups in shadow maps · (2 r + 1)²
  PixelsShaded,
  SpriteBytes,  ///< in the store
};
const char* name(WorkKind kind);  ///< "fragments", "texture_samples", …

inline constexpr std::size_t kTruth = 0;           ///< variant: direct, everything at its finest
inline constexpr std::size_t kTruthInSprites = 1;  ///< the same under policy reference

struct KnobRung {
  std::string label;        ///< "trilinear", "1024 px"
  std::size_t variant = 0;  ///< index into RendererLadder::variants; several rungs may share one
};

struct Knob {
  std::string name;             ///< "texture filter"
  bool in_sprites = false;      ///< measured under policy reference
  std::string why_not;          ///< empty: it is measured
  std::vector<KnobRung> rungs;  ///< coarse to fine; empty where the knob is not measured
  WorkKind work = WorkKind::PixelsShaded;

  bool called() const { return why_not.empty(); }
  /// The variant in which this knob, too, is as the truth has it.
  std::size_t base() const { return in_sprites ? kTruthInSprites : kTruth; }
};

struct RendererLadder {
  std::vector<Variant> variants;
  std::vector<Knob> knobs;
};

/// "16 samples, anisotropy 16, …": the truth in words.
std::string truth_in_words();

/// The finest setting of every knob of `given`, in one pass.
Variant finest(const Variant& given);

RendererLadder renderer_ladder(const Variant& given);

}  // namespace talisman::sequences
