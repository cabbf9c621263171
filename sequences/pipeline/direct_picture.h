// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a frame look like without sprites? The policy `direct`, and a truth of --quality.
///
/// All layers are drawn in one pass of the renderer over the display: surfaces hide each other sample by
/// sample, every term of the shading is evaluated together, each mirror looks its own reflection up, and
/// textures are blended as of this frame.
///
/// A fade belongs to a layer as a whole. A layer of two surfaces that is faded to f shows the nearer one over
/// what is behind the layer,
///
///   C ← f · S + (1 - f α_S) · C      S: the layer alone, premultiplied;  C: all that is behind it
///
/// and not the farther surface through the nearer one, as fading each surface would. One pass cannot do that,
/// so a frame in which a layer is faded is drawn in groups, back to front: each faded layer is one (none
/// where f = 0), and so are all unfaded layers between two of them. The order is that of the policy
/// `reference` without memory. Layers that hide each other in a cycle are one group, whose fade is what they
/// have in common. Groups are composited with `over`: where a pixel is covered in part by two of them it is
/// treated as sprites treat it, not sample by sample.
///
/// A frame without fades makes one pass, as if there were no fades at all.

#include "chunker/composite.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/pipeline/shade_passes.h"

namespace talisman::sequences {

/// Geometry layers that are drawn in one pass, and the fade of their picture.
struct DirectGroup {
  std::vector<int> layers;
  float alpha = 1;  ///< > 0
  bool operator==(const DirectGroup&) const = default;
};

/// Back to front. Cost: that of a capture and a sort where a
/// layer is faded, else nothing.
std::vector<DirectGroup> direct_groups(const Pipeline& pipeline, int frame);

struct DirectPicture {
  chunker::CompositeResult composite;
  chunker::RenderCounters render;
};

/// `drawing` is of the author's layers, and of the scene at `frame`. `carried`: how the whole picture is moved when it is
/// shown (latency/last_warp.h).
DirectPicture draw_directly(const Drawing& drawing, int frame,
                            const layers::dmat3& carried = layers::dmat3(1.0));

}  // namespace talisman::sequences
