// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the renderer's tests share: scenes made of a few triangles, pictures as plain values, and a way to
/// look at them.

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "chunker/composite.h"
#include "chunker/reference.h"
#include "chunker/render.h"

namespace talisman::chunker::tests {

using layers::dvec2;
using layers::dvec3;
using layers::ivec2;
using layers::vec2;
using layers::vec3;

/// The sprite that lies on the display, texel on pixel.
inline layers::SpritePlacement display_placement(ivec2 size) {
  layers::SpritePlacement placement;
  placement.size_px = size;
  return placement;
}

inline std::vector<int> all_parts(const layers::Scene& scene) {
  std::vector<int> parts(scene.parts.size());
  std::iota(parts.begin(), parts.end(), 0);
  return parts;
}

inline RenderResult render_all(const layers::Scene& scene, const layers::SpritePlacement& placement,
                               ivec2 display_px, const RenderOptions& options = {}, double t_s = 0) {
  const PreparedScene prepared(scene);
  return render(prepared, scene.at(t_s), all_parts(scene), display_px, placement, options);
}
inline RenderResult render_all(const layers::Scene& scene, ivec2 size, const RenderOptions& options = {},
                               double t_s = 0) {
  return render_all(scene, display_placement(size), size, options, t_s);
}
inline Sprite render_reference(const layers::Scene& scene, const layers::SpritePlacement& placement,
                               ivec2 display_px, const RenderOptions& options = {}, double t_s = 0) {
  const PreparedScene prepared(scene);
  return reference::render(prepared, scene.at(t_s), all_parts(scene), display_px, placement, options);
}
inline Sprite render_reference(const layers::Scene& scene, ivec2 size, const RenderOptions& options = {},
                               double t_s = 0) {
  return render_reference(scene, display_placement(size), size, options, t_s);
}

/// No merging: the fast path is then exactly the reference.
inline RenderOptions exact_options() {
  RenderOptions options;
  options.merge_depth = options.merge_color = 0;
  return options;
}

struct Difference {
  int texels = 0;   ///< that differ
  int largest = 0;  ///< code values, over all channels
  ivec2 where{-1, -1};
};

inline Difference difference(const Sprite& a, const Sprite& b) {
  Difference d;
  EXPECT_EQ(a.size_px(), b.size_px());
  for (int y = 0; y < a.size_px().y; ++y)
    for (int x = 0; x < a.size_px().x; ++x) {
      const Texel p = a.texel(x, y), q = b.texel(x, y);
      const int most =
          std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b), std::abs(p.a - q.a)});
      if (most > 0) ++d.texels;
      if (most > d.largest) {
        d.largest = most;
        d.where = {x, y};
      }
    }
  return d;
}

inline void expect_same(const Sprite& a, const Sprite& b, const std::string& what) {
  const Difference d = difference(a, b);
  EXPECT_EQ(d.texels, 0) << what << ": largest " << d.largest << " at " << d.where.x << " " << d.where.y;
}

inline int covered_texels(const Sprite& sprite) {
  int count = 0;
  for (int y = 0; y < sprite.size_px().y; ++y)
    for (int x = 0; x < sprite.size_px().x; ++x) count += sprite.texel(x, y).a > 0 ? 1 : 0;
  return count;
}

/// Looks at the renderer's output: writes NAME.ppm over mid grey into the folder named by TALISMAN_PICTURES,
/// if that is set.
inline void dump_picture(const std::string& name, const Sprite& sprite) {
  const char* folder = std::getenv("TALISMAN_PICTURES");
  if (folder == nullptr) return;
  std::ofstream out(std::string(folder) + "/" + name + ".ppm", std::ios::binary);
  out << "P6\n" << sprite.size_px().x << " " << sprite.size_px().y << "\n255\n";
  for (int y = 0; y < sprite.size_px().y; ++y)
    for (int x = 0; x < sprite.size_px().x; ++x) {
      const Linear16 c = decode(sprite.texel(x, y));
      const std::uint32_t behind = (kOne - c.a) / 5;
      for (const std::uint16_t v : {c.r, c.g, c.b})
        out.put(static_cast<char>(
            srgb_from_linear16(static_cast<std::uint16_t>(std::min<std::uint32_t>(v + behind, kOne)))));
    }
}

/// A scene in pixels: a camera at the origin, 90° high, looks along -z, so that the plane z = -size.y/2 lies
/// on the display pixel for pixel. Corners are given as (x, y) pixels with y down and a depth factor (1: that
/// plane, 2: twice as far at the same pixel).
class FlatScene {
 public:
  explicit FlatScene(ivec2 size) : size_(size) {
    layers::Camera camera;
    camera.fov_y_rad = std::acos(0.0);
    camera.near_m = 0.01;
    scene.cameras.push_back(camera);
  }

  struct Corner {
    double x, y, depth = 1;
  };

  vec3 point(const Corner& c) const {
    const dvec3 p(c.x - size_.x * 0.5, size_.y * 0.5 - c.y, -size_.y * 0.5);
    return vec3(p * c.depth);
  }

  /// Adds a part of its own, unlit and two-sided, and returns its material for further wishes.
  layers::Material& add(const std::vector<Corner>& corners, vec3 color, float opacity = 1) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 2; i < corners.size(); ++i) indices.insert(indices.end(), {0, i - 1, i});
    return add(corners, indices, color, opacity);
  }

  layers::Material& add(const std::vector<Corner>& corners, const std::vector<std::uint32_t>& indices,
                        vec3 color, float opacity = 1) {
    layers::Mesh mesh;
    for (const Corner& c : corners) mesh.positions.push_back(point(c));
    mesh.indices = indices;
    layers::Material material;
    material.base_color = color;
    material.opacity = opacity;
    material.unlit = material.two_sided = true;
    layers::Part part;
    part.mesh = part.material = static_cast<int>(scene.meshes.size());
    part.node = 0;
    if (scene.nodes.empty()) scene.nodes.emplace_back();
    scene.meshes.push_back(mesh);
    scene.materials.push_back(material);
    scene.parts.push_back(part);
    return scene.materials.back();
  }

  layers::Mesh& mesh() { return scene.meshes.back(); }
  RenderResult render(const RenderOptions& options = {}) const { return render_all(scene, size_, options); }
  Sprite reference(const RenderOptions& options = {}) const {
    return render_reference(scene, size_, options);
  }

  layers::Scene scene;

 private:
  ivec2 size_;
};

}  // namespace talisman::chunker::tests
