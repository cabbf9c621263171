// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The vertex stage: where are a part's vertices on the sprite, and what do they look like?
///
///   (X, Y, w) = sprite_from_screen · screen_from_clip · clip_from_world · world_from_node · p,      texel =
///   (X/w, Y/w)
///
/// One 3×4 matrix per part, in double. Normals go by the cofactor matrix (the inverse transpose times the
/// determinant), which exists even where a node is scaled to zero along an axis. Skinned parts take their
/// world positions from layers::world_positions.

#include <optional>
#include <vector>

#include "chunker/clip.h"
#include "chunker/rows34.h"
#include "chunker/shade.h"
#include "layers/region.h"

namespace talisman::chunker {

Rows34 operator*(const Rows34& outer, const layers::dmat4& inner);

/// How a frame is seen through a sprite.
struct SpriteView {
  layers::ivec2 size_px{0, 0};
  Rows34 sprite_from_world;
  ClipRegion region;
  layers::dvec3 eye{0, 0, 0};
  bool mirrored = false;  ///< the placement, or else the camera, turns the picture over
};

/// Empty when the placement is: no texels, or a map that is singular or not finite. `kept`: the half-space of
/// the world that is drawn; one that is not finite or has no direction cuts nothing.
std::optional<SpriteView> sprite_view(const layers::SceneFrame& frame, layers::ivec2 display_px,
                                      const layers::SpritePlacement& placement,
                                      const std::optional<HalfSpace>& kept = std::nullopt);

/// What of the world the sprite shows: a part whose box is outside of it has no triangle that is not (layers/region.h).
layers::Region sprite_region(const SpriteView& view);

/// Why a vertex may need more than drawing. A triangle whose corners share one of kOutsideFlags lies wholly
/// outside.
enum VertexFlag : std::uint8_t {
  kLeftOfSprite = 1,
  kRightOfSprite = 2,
  kAboveSprite = 4,
  kBelowSprite = 8,
  kBeforeNear = 16,
  kOutsideGuard = 32,
  kNotFinite = 64,
  kCutAway = 128,  ///< beyond ClipRegion::kept
};
inline constexpr std::uint8_t kOutsideFlags =
    kLeftOfSprite | kRightOfSprite | kAboveSprite | kBelowSprite | kBeforeNear | kCutAway;
inline constexpr std::uint8_t kClipFlags = kBeforeNear | kOutsideGuard | kCutAway;

struct ProjectedVertex {
  std::int32_t x = 0, y = 0;  ///< 1/256 texel; valid without kClipFlags and kNotFinite
  float depth = 0;            ///< 1/w
  std::uint8_t flags = 0;
};

/// Never kCutAway: few views cut, so who draws one that does asks ClipRegion::kept.
ProjectedVertex project(const SpriteView& view, const layers::dvec3& point);

/// Of a vertex made by clip_triangle: it lies on the border of the region up to rounding; this puts it there.
ProjectedVertex project_cut(const SpriteView& view, layers::dvec3 point);

/// The vertices of one part. Whether they are skinned is asked once, by the caller, not at each of them.
class PartVertices {
 public:
  /// No more of a vertex is read than `shader` asks for; by default its place alone.
  PartVertices(const layers::SceneFrame& frame, const layers::Part& part, const SpriteView& view,
               const Shader& shader = {});

  int size() const { return static_cast<int>(mesh_->positions.size()); }
  const layers::Mesh& mesh() const { return *mesh_; }
  /// Skinned or morphed: world positions are made for it.
  bool skinned() const {
    return (layers::is_built(layers::Effect::Skinning) || layers::is_built(layers::Effect::Morphing)) &&
           !world_.empty();
  }
  template <bool kSkinned>
  layers::dvec3 sprite_point(int i) const {
    return sprite_from_source_(source<kSkinned>(i));
  }
  layers::dvec3 sprite_point(int i) const {
    return skinned() ? sprite_point<true>(i) : sprite_point<false>(i);
  }
  /// World axes, relative to the eye.
  template <bool kSkinned>
  layers::dvec3 eye_position(int i) const {
    return eye_from_source_(source<kSkinned>(i));
  }
  layers::dvec3 eye_position(int i) const {
    return skinned() ? eye_position<true>(i) : eye_position<false>(i);
  }
  template <bool kSkinned>
  ShadePoint shade_point(int i) const;
  ShadePoint shade_point(int i) const { return skinned() ? shade_point<true>(i) : shade_point<false>(i); }
  bool mirrored() const { return mirrored_; }  ///< the node turns the mesh inside out

 private:
  template <bool kSkinned>
  layers::dvec3 source(int i) const {
    if constexpr (kSkinned) return world_[i];
    return layers::dvec3(mesh_->positions[i]);
  }
  template <bool kSkinned>
  Float4 world_normal(int i) const;

  const layers::Mesh* mesh_;
  std::vector<layers::dvec3> world_;          ///< skinned and morphed parts only
  std::vector<layers::dvec3> normals_;        ///< morphed parts only: in the mesh's space
  std::vector<layers::dmat3> joint_normals_;  ///< skinned parts only: cofactors of the palette
  Rows34 sprite_from_source_, eye_from_source_;
  layers::dmat3 normal_from_mesh_{1.0};  ///< of parts without a skin
  bool mirrored_ = false;
  bool reads_position_ = false, reads_normal_ = false, reads_color_ = false, reads_uv_ = false;
};

}  // namespace talisman::chunker
