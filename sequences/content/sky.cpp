// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/sky.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "sequences/content/tile_image.h"
#include "sequences/import/texture_io.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

constexpr int kDomeColumns = 32, kDomeRows = 16;

layers::dvec3 direction(double azimuth_deg, double elevation_deg) {
  const double a = glm::radians(azimuth_deg), e = glm::radians(elevation_deg);
  return {std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)};
}

/// The place of the patch at s, t in 0 … 1 (s from left to right, t from top to bottom), seen from the
/// centre.
layers::dvec3 patch_point(const SkyContent& sky, double s, double t) {
  const double azimuth = sky.azimuth_deg.x + s * (sky.azimuth_deg.y - sky.azimuth_deg.x);
  const double elevation = sky.elevation_deg.y + t * (sky.elevation_deg.x - sky.elevation_deg.y);
  if (sky.kind == SkyContent::Kind::Dome) return sky.radius_m * direction(azimuth, elevation);
  const double middle = (sky.azimuth_deg.x + sky.azimuth_deg.y) / 2,
               half = (sky.azimuth_deg.y - sky.azimuth_deg.x) / 2;
  const layers::dvec3 ahead = direction(middle, 0), right = direction(middle + 90, 0);
  const double across = (2 * s - 1) * std::tan(glm::radians(half));
  const double top = std::tan(glm::radians(sky.elevation_deg.y)),
               bottom = std::tan(glm::radians(sky.elevation_deg.x));
  return sky.radius_m * (ahead + across * right + layers::dvec3{0, top + t * (bottom - top), 0});
}

layers::Mesh patch_mesh(const SkyContent& sky) {
  const bool dome = sky.kind == SkyContent::Kind::Dome;
  const int columns = dome ? kDomeColumns : 1, rows = dome ? kDomeRows : 1;
  // Half a texel is kept away from the border, where a repeating texture would show its other side.
  const auto inset = [](double s, int texels) { return (0.5 + s * (texels - 1)) / texels; };
  layers::Mesh mesh;
  mesh.name = sky.name;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double s = static_cast<double>(i) / columns, t = static_cast<double>(j) / rows;
      const layers::dvec3 p = patch_point(sky, s, t);
      mesh.positions.push_back(layers::vec3(p));
      mesh.normals.push_back(layers::vec3(-glm::normalize(p)));
      mesh.uvs.push_back(
          {static_cast<float>(inset(s, sky.texels.x)), static_cast<float>(inset(t, sky.texels.y))});
    }
  const auto stride = static_cast<std::uint32_t>(columns + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j)
    for (std::uint32_t i = 0; i + 1 < stride; ++i) {
      const std::uint32_t a = j * stride + i, b = a + 1, c = a + stride, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, c, d, a, d, b});
    }
  return mesh;
}

/// Cover of the clouds, 0 … 1, on a plane over the centre; thinned out towards the horizon, where the plane
/// is far.
class Clouds {
 public:
  explicit Clouds(const SkyContent& sky) : sky_(sky) {
    if (!sky.clouds_file.empty()) tile_ = cover_tile(read_texture(sky.clouds_file));
  }
  float operator()(const layers::dvec3& toward) const {
    if (!tile_ || toward.y <= 0) return 0;
    const double scale = sky_.cloud_height_m / (toward.y * sky_.clouds_m);
    const double thin = std::clamp((toward.y - 0.02) / 0.2, 0.0, 1.0);
    return static_cast<float>(sky_.cloud_cover * thin) * (*tile_)(toward.x * scale, toward.z * scale).x;
  }

 private:
  const SkyContent& sky_;
  std::optional<TileImage> tile_;
};

layers::vec3 sky_color(const SkyContent& sky, const Clouds& clouds, const layers::dvec3& toward) {
  const double top = std::sin(glm::radians(std::max(1.0, sky.elevation_deg.y)));
  const double up = std::clamp(toward.y / top, 0.0, 1.0);
  const float share =
      static_cast<float>(std::sqrt(up));  // the haze is a band: most of the change is low in the sky
  const layers::vec3 clear = sky.horizon + share * (sky.zenith - sky.horizon);
  return clear + clouds(toward) * (layers::vec3(0.92f) - clear);
}

layers::Texture bake_sky(const SkyContent& sky) {
  const Clouds clouds(sky);
  layers::Texture texture;
  texture.name = sky.name;
  texture.width = sky.texels.x;
  texture.height = sky.texels.y;
  for (int y = 0; y < texture.height; ++y)
    for (int x = 0; x < texture.width; ++x) {
      const double s = static_cast<double>(x) / (texture.width - 1),
                   t = static_cast<double>(y) / (texture.height - 1);
      const layers::vec3 color = sky_color(sky, clouds, glm::normalize(patch_point(sky, s, t)));
      for (int k = 0; k < 3; ++k) texture.rgba.push_back(srgb_byte(color[k]));
      texture.rgba.push_back(255);
    }
  return texture;
}

}  // namespace

void add_sky(layers::Scene& scene, const SkyContent& sky) {
  layers::Material material;
  material.name = sky.name;
  material.base_color = layers::vec3(1);
  material.texture = static_cast<int>(scene.textures.size());
  material.two_sided = true;
  material.unlit = true;
  scene.parts.push_back({sky.name, static_cast<int>(scene.nodes.size()),
                         static_cast<int>(scene.meshes.size()), static_cast<int>(scene.materials.size()),
                         -1});
  layers::Node node;
  node.name = sky.name;
  node.local.translation = sky.center;
  scene.nodes.push_back(node);
  scene.textures.push_back(bake_sky(sky));
  scene.materials.push_back(material);
  scene.meshes.push_back(patch_mesh(sky));
}

}  // namespace talisman::sequences
