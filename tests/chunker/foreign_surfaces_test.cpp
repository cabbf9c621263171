// SPDX-License-Identifier: Apache-2.0
// What models of other programs ask for: textures that do not repeat, emission by a map, alpha that is cut or
// lies in the vertices, lamps that fade, meshes that morph.
#include <gtest/gtest.h>

#include "chunker/texture.h"
#include "layers/tangents.h"
#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

using layers::Wrap;

/// Two texels, black and white.
MipLevel black_white(Wrap wrap) { return {2, 1, {splat(0), splat(1)}, wrap, Wrap::Repeat}; }

TEST(WrappedTexture, ClampedShowsItsBorderBeyondIt) {
  const MipLevel level = black_white(Wrap::Clamp);
  for (const float u : {-5.0f, -0.1f, 0.0f, 0.1f, 0.25f}) EXPECT_EQ(bilinear(level, u, 0)[0], 0) << u;
  for (const float u : {0.75f, 0.9f, 1.0f, 1.1f, 40.0f}) EXPECT_EQ(bilinear(level, u, 0)[0], 1) << u;
  EXPECT_FLOAT_EQ(bilinear(level, 0.5f, 0)[0], 0.5f);
}

TEST(WrappedTexture, MirroredTurnsOverAtWholeNumbers) {
  const MipLevel level = black_white(Wrap::Mirror);
  for (const float u : {1.0f, 0.8f, 1.2f, -0.8f, -1.2f, 3.2f})
    EXPECT_FLOAT_EQ(bilinear(level, u, 0)[0], 1) << u;
  for (const float u : {0.0f, 0.2f, -0.2f, 1.8f, 2.2f, -2.0f})
    EXPECT_FLOAT_EQ(bilinear(level, u, 0)[0], 0) << u;
}

/// The shaded with one thing of foreign models, drawn in lanes and by the definition.
void expect_like_the_definition(const ShadeScene& shaded) {
  ASSERT_EQ(layers::first_defect(shaded.scene), "");
  for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong})
    for (const bool mipmaps : {true, false}) {
      RenderOptions options = exact_options();
      options.shading = shading;
      options.mipmaps = mipmaps;
      expect_same(shaded.render({}, options).sprite, shaded.reference({}, options),
                  std::to_string(static_cast<int>(shading)) + (mipmaps ? " with mipmaps" : ""));
    }
}

TEST(ForeignSurface, WrappedTexturesAreDrawnAsDefined) {
  for (const auto& [u, v] :
       {std::pair{Wrap::Clamp, Wrap::Mirror}, {Wrap::Repeat, Wrap::Clamp}, {Wrap::Mirror, Wrap::Repeat}}) {
    ShadeScene shaded;
    shaded.scene.textures[0].wrap_u = u;
    shaded.scene.textures[0].wrap_v = v;
    expect_like_the_definition(shaded);
  }
}

TEST(ForeignSurface, TexturesOfOtherFiltersAreDrawnAsDefined) {
  for (bool layers::Texture::*filter : {&layers::Texture::nearest, &layers::Texture::finest,
                                        &layers::Texture::nearest_minified, &layers::Texture::one_level}) {
    ShadeScene shaded;
    shaded.scene.textures[0].*filter = true;
    expect_like_the_definition(shaded);
  }
}

TEST(ForeignSurface, EmissiveMapsAreDrawnAsDefined) {
  ShadeScene shaded;
  layers::Material& floor = shaded.scene.materials[ShadeScene::kFloor];
  floor.emissive = {0.5f, 0.2f, 0};
  floor.emissive_texture = 1;
  expect_like_the_definition(shaded);
  layers::Mesh& mesh = shaded.scene.meshes[ShadeScene::kFloor];
  mesh.emissive_uvs = mesh.uvs;
  for (layers::vec2& uv : mesh.emissive_uvs) uv = 0.5f * uv + layers::vec2(0.1f, 0.2f);
  expect_like_the_definition(shaded);
}

/// A bump in each cell of the picture, by the bytes of (x, y, 1).
layers::Texture bumps() {
  layers::Texture texture{"bumps", 8, 8, {}};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      texture.rgba.insert(texture.rgba.end(), {static_cast<std::uint8_t>(28 * x + 20),
                                               static_cast<std::uint8_t>(230 - 28 * y), 230, 255});
  return texture;
}

ShadeScene bumpy_scene() {
  ShadeScene shaded;
  shaded.scene.textures.push_back(bumps());
  for (const int part : {ShadeScene::kFloor, ShadeScene::kBall}) {
    layers::derive_tangents(shaded.scene.meshes[part]);
    shaded.scene.materials[part].normal_texture = 2;
    shaded.scene.materials[part].normal_scale = 0.7f;
  }
  return shaded;
}

TEST(ForeignSurface, NormalMapsAreDrawnAsDefined) {
  ShadeScene shaded = bumpy_scene();
  expect_like_the_definition(shaded);
  layers::Mesh& mesh = shaded.scene.meshes[ShadeScene::kFloor];
  mesh.normal_uvs = mesh.uvs;
  for (layers::vec2& uv : mesh.normal_uvs) uv = 0.5f * uv + layers::vec2(0.1f, 0.2f);
  shaded.scene.materials[ShadeScene::kBall].two_sided = true;
  expect_like_the_definition(shaded);
  ShadeScene looked_up = bumpy_scene();
  for (const ShadeTerm term : kAllTerms) {
    const ShadeInputs inputs = looked_up.inputs(term, ShadeScene::kSpot);
    expect_same(looked_up.render(inputs, exact_options()).sprite,
                looked_up.reference(inputs, exact_options()), name_of(term));
  }
}

TEST(ForeignSurface, AFlatNormalMapChangesAtMostOneCodeValue) {
  ShadeScene shaded = bumpy_scene();
  layers::Texture& flat = shaded.scene.textures[2];
  for (std::size_t i = 0; i < flat.rgba.size(); ++i) flat.rgba[i] = i % 4 < 2 ? 128 : 255;
  for (layers::Material& material : shaded.scene.materials) material.specular = vec3(0);
  ShadeScene plain = shaded;
  for (layers::Material& material : plain.scene.materials) material.normal_texture = -1;
  EXPECT_LE(difference(shaded.render({}).sprite, plain.render({}).sprite).largest, 1);
}

TEST(ForeignSurface, NormalMapsNeedAPixelToBeSeen) {
  const ShadeScene bumpy = bumpy_scene();
  ShadeScene plain = bumpy_scene();
  for (layers::Material& material : plain.scene.materials) material.normal_texture = -1;
  for (const Shading shading : {Shading::Flat, Shading::Gouraud}) {
    RenderOptions options;
    options.shading = shading;
    expect_same(bumpy.render({}, options).sprite, plain.render({}, options).sprite, "shading");
  }
  EXPECT_GT(difference(bumpy.render({}).sprite, plain.render({}).sprite).largest, 20);
  EXPECT_GT(PreparedScene(bumpy.scene).texture_bytes(), PreparedScene(plain.scene).texture_bytes());
}

TEST(ForeignSurface, LampsThatFadeAreDrawnAsDefined) {
  ShadeScene shaded;
  shaded.scene.lights[ShadeScene::kSpot].attenuation = {0.2, 0.1, 0.05};
  shaded.scene.lights[ShadeScene::kSpot].range_m = 6;
  expect_like_the_definition(shaded);
  shaded.scene.lights[ShadeScene::kSpot].kind = layers::Light::Kind::Point;
  expect_like_the_definition(shaded);
}

TEST(ForeignSurface, AlphaOfVerticesIsDrawnAsDefined) {
  ShadeScene shaded;
  layers::Mesh& mesh = shaded.scene.meshes[ShadeScene::kFloor];
  mesh.colors.assign(mesh.positions.size(), vec3(0.9f));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.alphas.push_back(i % 3 == 0 ? 0.25f : 1.0f);
  expect_like_the_definition(shaded);
  shaded.scene.materials[ShadeScene::kFloor].alpha_cutoff = 0.6f;
  expect_like_the_definition(shaded);
}

/// A square that fills the picture, and the colour of its middle in linear light.
LinearColor middle_of(layers::Scene scene) {
  scene.cameras.emplace_back();
  scene.cameras[0].fov_y_rad = 1;
  const PreparedScene prepared(scene);
  const ivec2 size{8, 8};
  const LinearImage image =
      render_linear(prepared, scene.at(0), all_parts(scene), size, display_placement(size), {}, {});
  return image.texels[4 * 8 + 4];
}

layers::Scene wall() {
  layers::Scene scene;
  scene.meshes = {talisman::tests::quad_mesh(8)};
  scene.nodes.resize(1);
  scene.nodes[0].local.translation = {0, 0, -2};
  scene.materials.resize(1);
  scene.materials[0].base_color = {1, 1, 1};
  scene.parts = {{"wall", 0, 0, 0, -1}};
  return scene;
}

TEST(ForeignSurface, LampFadesWithTheSquareOfItsDistance) {
  layers::Scene scene = wall();
  scene.lights.resize(1);
  scene.lights[0].kind = layers::Light::Kind::Point;  // 2 m before the wall
  scene.lights[0].attenuation = {0, 0, 1};
  scene.lights[0].color = {2, 2, 2};
  EXPECT_NEAR(middle_of(scene).r, 0.5, 0.01);  // 2 / 2²
  scene.lights[0].range_m = 4;
  EXPECT_NEAR(middle_of(scene).r, 0.5 * (1 - 1.0 / 16), 0.01);
}

// The lamp is at the eye, the wall 2 m before it: 4 cd are about 1 lx. KHR_lights_punctual has t² on the ramp of the cosines.
TEST(ForeignSurface, LampOfAForeignFileFadesAsTheSquareOfItsCone) {
  layers::Scene scene = wall();
  scene.lights.resize(1);
  layers::Light& lamp = scene.lights[0];
  lamp.kind = layers::Light::Kind::Spot;
  lamp.attenuation = {0, 0, 1};
  lamp.color = {4, 4, 4};
  lamp.inner_cone_rad = 0;
  lamp.outer_cone_rad = std::acos(0.4);  // 1 - cos is 0 … 0.6
  lamp.direction = {0.6, 0, -0.8};
  const double half_pixel =
      2 * std::tan(0.5) / 8;  // the texel's centre is that far right of and below the middle
  const layers::dvec3 way(half_pixel, -half_pixel, -2);
  const double length = glm::length(way), t = (glm::dot(lamp.direction, way) / length - 0.4) / 0.6;
  EXPECT_NEAR(t, 0.73, 0.01);
  EXPECT_NEAR(middle_of(scene).r, 4 / (length * length) * (2 / length) * t * t, 0.002);
  lamp.attenuation = {4, 0, 0};  // an author's lamp, which does not fade with its distance
  EXPECT_NEAR(middle_of(scene).r, 2 / length * t * t * (3 - 2 * t), 0.002);
}

TEST(ForeignSurface, AlphaBelowTheCutoffIsNotThere) {
  layers::Scene scene = wall();
  scene.materials[0].unlit = true;
  scene.materials[0].base_color = {0.5f, 0, 0};
  scene.materials[0].texture = 0;
  scene.textures.resize(1);
  scene.textures[0] = {"grey", 1, 1, {255, 255, 255, 128}, true};
  scene.materials[0].alpha_cutoff = 0.5f;  // 128 / 255 is more
  EXPECT_FLOAT_EQ(middle_of(scene).r, 0.5f);
  EXPECT_FLOAT_EQ(middle_of(scene).a, 1);
  scene.materials[0].alpha_cutoff = 0.6f;
  EXPECT_EQ(middle_of(scene).a, 0);
}

TEST(ForeignSurface, MorphedMeshIsDrawnWhereItsWeightsPutIt) {
  layers::Scene scene = wall();
  scene.materials[0].unlit = true;
  layers::MorphTarget away;
  away.positions.assign(scene.meshes[0].positions.size(), vec3(20, 0, 0));
  scene.meshes[0].morphs = {away};
  scene.nodes[0].morph_weights = {0};
  EXPECT_EQ(middle_of(scene).a, 1);
  scene.nodes[0].morph_weights = {1};
  EXPECT_EQ(middle_of(scene).a, 0);
}

}  // namespace
}  // namespace talisman::chunker::tests
