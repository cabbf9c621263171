// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The passes behind shadows and reflections, and how a layer's term of the shading is drawn with them
/// [LS97 2.3, Fig. 5, 6].
///
///   shadow map     the casters' depths as seen from the light; kept while light and casters rest, whichever
///                  layer looks it up
///   reflection     what the layer mirrors, as a mirrored camera sees it, as large and dense as the sprite that
///                  looks it up; drawn with each render of that sprite. What lies behind the mirror is cut
///                  off. A sprite of several mirrors (an aggregate, or `direct`) looks up one picture for
///                  each. One bounce: a mirror in a mirror shows its own colour and reflects nothing. What
///                  is mirrored is mirrored without fades.
///
/// What a scene does not call for makes no pass and allocates nothing.

#include <optional>
#include <span>
#include <vector>

#include "chunker/depth_render.h"
#include "chunker/multipass.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// What drawing reads besides what is drawn: the run and its layers, the scene at an instant, its meshes and
/// textures as the renderer takes them, and the shadow maps at hand, which it may draw anew. Keeps references.
struct Drawing {
  const Pipeline& pipeline;
  const LayerTable& layers;
  ShadowMapStore& maps;
  const chunker::PreparedScene& prepared;
  const layers::SceneFrame& frame;
  std::span<const HeldMap> held = {};  ///< lights whose maps are not simply those of `frame`
  const std::vector<char>* seen =
      nullptr;  ///< by part, of the display at `frame`: the others are not drawn; null: all are
};

/// The layer's term of the shading through `placement`. The counters are those of the sprite and of the
/// reflection behind it.
chunker::RenderResult draw_layer(const Drawing& drawing, const layers::Layer& layer,
                                 const layers::SpritePlacement& placement);

/// The same, chunks drawn when they are first read (chunker/late_chunks.h) where that can be.
chunker::RenderResult draw_layer_late(const Drawing& drawing, const layers::Layer& layer,
                                      const layers::SpritePlacement& placement);

/// The chunks at `places` of what draw_layer draws, with all else that is to be told of them.
chunker::RenderedChunks draw_layer_chunks(const Drawing& drawing, const layers::Layer& layer,
                                          const layers::SpritePlacement& placement,
                                          const std::vector<int>& places);

/// What draw_layer encodes, as it is before that. `blend`: factors of its two textures, in place of what its
/// materials say.
chunker::LinearImage draw_layer_linear(const Drawing& drawing, const layers::Layer& layer,
                                       const layers::SpritePlacement& placement,
                                       std::optional<layers::vec2> blend = std::nullopt);

/// All terms that `layer` holds, one pass each (chunker/multipass.h).
std::vector<chunker::TermImage> draw_terms(const Drawing& drawing, const layers::Layer& layer,
                                           const layers::SpritePlacement& placement,
                                           chunker::BasePasses base);

/// The given geometry layers in one pass, as far as their parts are seen, all terms of their shading at once, and their textures blended as
/// of the drawing's frame. Fades are left to the compositor: sequences/pipeline/direct_picture.h.
chunker::RenderResult draw_in_one_pass(const Drawing& drawing, std::span<const int> geometry_layers,
                                       const layers::SpritePlacement& placement);

/// Some parts of the author's layers over the display, as draw_in_one_pass draws them, with depth; `numbers` as in
/// chunker/depth_render.h. Nothing mirrors.
chunker::DepthRenderResult draw_with_depth(const Drawing& drawing, const std::vector<int>& parts,
                                           std::span<const std::uint32_t> numbers);

/// The multipliers of the layer's sprite at a time.
SpriteMultipliers multipliers_at(const layers::Layer& layer, double time_s);

}  // namespace talisman::sequences
