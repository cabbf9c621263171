// SPDX-License-Identifier: Apache-2.0
#include "chunker/shade.h"

#include <cstring>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "chunker/shade_batch.h"
#include "chunker/triangle.h"
#include "tests/support/scenes.h"

namespace talisman::chunker {
namespace {

/// A material with everything, lights of every kind.
struct Everything {
  layers::Scene scene;
  layers::SceneFrame frame;
  std::unique_ptr<PreparedScene> prepared;
  LightSet lights;
  RenderOptions options;

  Everything() {
    scene = talisman::tests::textured_quad_scene();
    layers::Material& material = scene.materials[scene.parts[0].material];
    material.specular = {0.5f, 0.4f, 0.3f};
    material.shininess = 20;
    material.emissive = {0.01f, 0.02f, 0.03f};
    material.opacity = 0.75f;
  }
  Shader shader() {
    frame = scene.at(0);
    layers::LightState point;
    point.kind = layers::Light::Kind::Point;
    point.position = {1, 2, 3};
    frame.lights.push_back(point);
    prepared = std::make_unique<PreparedScene>(scene);
    lights = light_set(frame);
    return make_shader(*prepared, scene.parts[0], lights, options);
  }
};

Interpolator random_interpolator(std::mt19937& random, const Shader& shader) {
  std::uniform_int_distribution<std::int32_t> at(-20000, 20000);
  std::normal_distribution<float> value(0, 1);
  Triangle t;
  do {
    for (int k = 0; k < 3; ++k) {
      t.x[k] = at(random);
      t.y[k] = at(random);
      t.depth[k] = 0.1f + std::abs(value(random));
      t.vertex[k] = static_cast<std::uint32_t>(k);
    }
  } while (doubled_area(t) <= 0);
  std::vector<Float4> attributes(static_cast<std::size_t>(3) * shader.layout.count);
  for (Float4& a : attributes) a = Float4{value(random), value(random), value(random), 1};
  return interpolator_of(t, gradients_of(t), attributes.data(), shader.layout.count);
}

// The lanes must do what the one-point formula does, to the last bit, whatever the material uses.
TEST(ShadeBatch, EqualsShadeBitByBit) {
  const unsigned seed = 1234;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(-80,
                                           80);  // far outside some triangles too: clamped, not extrapolated
  auto batch = std::make_unique<ShadeBatch>();
  for (int variant = 0; variant < 32; ++variant) {
    Everything e;
    layers::Material& material = e.scene.materials[e.scene.parts[0].material];
    if (variant & 1) material.texture = -1;
    if (variant & 2) material.specular = {0, 0, 0};
    if (variant & 4) e.options.shading = Shading::Gouraud;
    if (variant & 8) e.options.mipmaps = false;
    if (variant & 16) material.unlit = true;
    const Shader shader = e.shader();
    for (int n = 0; n < 20; ++n) {
      const Interpolator t = random_interpolator(random, shader);
      batch->count = 1 + static_cast<int>(random() % ShadeBatch::kPoints);
      for (int i = 0; i < batch->count; ++i) {
        batch->dx[i] = at(random);
        batch->dy[i] = at(random);
      }
      shade_batch(shader, t, *batch);
      for (int i = 0; i < batch->count; ++i) {
        const Float4 expected = shade(shader, t, batch->dx[i], batch->dy[i]);
        // The same to the bit, signs of zero included. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
        ASSERT_EQ(std::memcmp(&expected, &batch->color[i], sizeof(Float4)), 0)
            << "seed " << seed << " variant " << variant << " n " << n << " point " << i;
      }
    }
  }
}

// What a material does not use must not be carried by its vertices.
TEST(MakeShader, CarriesOnlyWhatTheMaterialUses) {
  Everything everything;
  EXPECT_EQ(everything.shader().layout.count, 3);  // uv, normal, position
  Everything plain;
  layers::Material& material = plain.scene.materials[plain.scene.parts[0].material];
  material.unlit = true;
  material.texture = -1;
  EXPECT_EQ(plain.shader().layout.count, 0);
  Everything gouraud;
  gouraud.options.shading = Shading::Gouraud;
  gouraud.scene.materials[gouraud.scene.parts[0].material].specular = {0, 0, 0};
  const Shader shader = gouraud.shader();
  EXPECT_EQ(shader.layout.count, 2);  // uv, colour
  EXPECT_FALSE(shader.per_pixel);
}

TEST(MakeShader, AmbientLightAloneNeedsNoNormals) {
  Everything e;
  e.shader();
  LightSet ambient;
  ambient.ambient = Float4{0.5f, 0.5f, 0.5f, 0};
  const Shader shader = make_shader(*e.prepared, e.scene.parts[0], ambient, {});
  EXPECT_FALSE(shader.lit);
  EXPECT_EQ(shader.layout.normal, -1);
  EXPECT_FLOAT_EQ(shader.base[0], 0.5f * e.scene.materials[e.scene.parts[0].material].base_color.x);
}

// A texture without coordinates: the mean of it, not a stray texel and not white.
TEST(MakeShader, MissingCoordinatesGiveTheMeanOfTheTexture) {
  Everything e;
  e.scene.meshes[e.scene.parts[0].mesh].uvs.clear();
  const Shader shader = e.shader();
  EXPECT_EQ(shader.pyramid, nullptr);
  EXPECT_NEAR(shader.texel[0], (linear_from_srgb(230) + linear_from_srgb(60)) / 2, 1e-5);
}

TEST(Light, LambertAndBlinnPhongHaveTheirPeaks) {
  LightSet lights;
  lights.ambient = Float4{0.1f, 0.1f, 0.1f, 0};
  lights.directional.push_back({Float4{0, 0, 1, 0}, Float4{1, 1, 1, 0}});
  Shader shader;
  shader.lights = &lights;
  shader.has_specular = true;
  shader.specular = Float4{0.5f, 0.5f, 0.5f, 0};
  shader.shininess = 10;
  const Float4 ahead{0, 0, -5, 0};  // seen along -z: light, eye and normal in line
  EXPECT_FLOAT_EQ(light(shader, Float4{0, 0, 1, 0}, ahead).diffuse[0], 1.1f);
  EXPECT_FLOAT_EQ(light(shader, Float4{0, 0, 1, 0}, ahead).specular[0], 0.5f);
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  EXPECT_NEAR(light(shader, Float4{s, 0, c, 0}, ahead).diffuse[0], 0.1f + c, 1e-6);
  EXPECT_NEAR(light(shader, Float4{s, 0, c, 0}, ahead).specular[0], 0.5f * std::pow(c, 10), 1e-6);
  const Lighting away = light(shader, Float4{0, 0, -1, 0}, ahead);
  EXPECT_FLOAT_EQ(away.diffuse[0], 0.1f);
  EXPECT_EQ(away.specular[0], 0.0f);
}

// Degenerate directions are zero, not NaN: a normal of length 0, a light at the point itself, an eye at the
// point.
TEST(Light, DegenerateDirectionsStayFinite) {
  LightSet lights;
  lights.point.push_back({Float4{1, 2, 3, 0}, Float4{1, 1, 1, 0}});
  Shader shader;
  shader.lights = &lights;
  shader.has_specular = true;
  shader.specular = splat(1);
  for (const float shininess : {0.0f, 1e4f}) {
    shader.shininess = shininess;
    for (const Float4 position : {Float4{1, 2, 3, 0}, Float4{0, 0, 0, 0}, Float4{1e30f, 0, 0, 0}})
      for (const Float4 normal : {Float4{0, 0, 0, 0}, Float4{0, 1, 0, 0}}) {
        const Lighting lit = light(shader, normal, position);
        for (int c = 0; c < 3; ++c) {
          EXPECT_TRUE(std::isfinite(lit.diffuse[c]));
          EXPECT_TRUE(std::isfinite(lit.specular[c]));
        }
      }
  }
}

TEST(LightSet, LeavesOutLightsThatAreNotFinite) {
  layers::SceneFrame frame;
  frame.lights.resize(2);
  frame.lights[0].position.x = std::nan("");
  EXPECT_EQ(light_set(frame).directional.size(), 1u);
}

}  // namespace
}  // namespace talisman::chunker
