// SPDX-License-Identifier: Apache-2.0
// Degenerate input is expected input: what must not break, and what must cost nothing.
#include <cmath>
#include <limits>

#include "tests/chunker/render_support.h"
#include "tests/support/scenes.h"

namespace talisman::chunker::tests {
namespace {

namespace content = talisman::tests;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// --- Placements

TEST(RenderPlacement, SingularOrNotFiniteShowsNothing) {
  using layers::Affine2;
  for (const Affine2& map :
       {Affine2{0, 0, 0, 0, 0, 0}, Affine2{1, 2, 0, 2, 4, 0}, Affine2{kNotANumber, 0, 0, 0, 1, 0},
        Affine2{1, 0, kInfinite, 0, 1, 0}, Affine2{1e-200, 0, 0, 0, 1e-200, 0}}) {
    layers::SpritePlacement placement = display_placement({40, 40});
    placement.screen_from_sprite = map;
    const RenderResult result = render_all(content::cube_scene(), placement, {40, 40});
    EXPECT_EQ(result.counters.polygons_drawn, 0);
    EXPECT_EQ(result.counters.polygons_in, 12);
    EXPECT_EQ(result.sprite.stored_chunks(), 0);
    EXPECT_EQ(result.sprite.size_px(), ivec2(40, 40));
  }
}

TEST(RenderPlacement, EmptyGivesAnEmptySprite) {
  for (const ivec2 size : {ivec2(0, 0), ivec2(0, 10), ivec2(-3, 5)}) {
    const RenderResult result = render_all(content::cube_scene(), display_placement(size), {64, 64});
    EXPECT_EQ(result.sprite.size_px(), ivec2(0, 0));
    EXPECT_EQ(result.counters.chunks_rendered + result.counters.chunks_clear, 0);
  }
}

// The cost of a sprite is that of its content, not of its size.
TEST(RenderPlacement, ALargeSpriteWithOneTinyTriangleStoresOneChunk) {
  FlatScene tiny({4096, 4096});
  tiny.add({{2000.1, 3000.1}, {2003, 3000.3}, {2001, 3003}}, {1, 1, 1});
  const RenderResult result = tiny.render();
  EXPECT_EQ(result.counters.chunks_rendered, 1);
  EXPECT_EQ(result.counters.chunks_clear, 128 * 128 - 1);
  EXPECT_EQ(result.counters.polygon_chunks, 1);
  EXPECT_LT(result.counters.pixels_shaded, 16);
  EXPECT_LT(result.sprite.bytes(), 128 * 128 * 4 + 2 * 4096);
}

TEST(RenderDeathTest, OptionsOutOfRangeAreProgrammerMistakes) {
  RenderOptions options;
  options.max_fragments_per_chunk = 15;
  EXPECT_DEATH(render_all(content::cube_scene(), {8, 8}, options), "check failed");
  EXPECT_DEATH(render_all(content::cube_scene(), {20000, 8}), "check failed");
}

// --- Triangles

// A vertex that is not finite takes only its own triangles with it.
TEST(RenderTriangles, VerticesThatAreNotFiniteAreSkipped) {
  for (const double bad : {kNotANumber, kInfinite, -kInfinite}) {
    FlatScene scene({32, 32});
    scene.add({{1, 1}, {31, 1}, {31, 31}, {1, 31}}, {1, 1, 1});
    scene.mesh().positions[3].y = static_cast<float>(bad);
    const RenderResult result = scene.render();
    EXPECT_EQ(result.counters.polygons_drawn, 1);
    EXPECT_EQ(result.sprite.texel(25, 8).a, 255);
    EXPECT_EQ(result.sprite.texel(5, 25), Texel{});
  }
}

TEST(RenderTriangles, WithoutAreaNothingIsDrawn) {
  FlatScene scene({32, 32});
  scene.add({{1, 1}, {1, 1}, {20, 20}}, {1, 1, 1});          // two corners coincide
  scene.add({{1, 1}, {10, 10}, {30, 30}}, {1, 1, 1});        // collinear
  scene.add({{5, 5}, {5, 5}, {5, 5}}, {1, 1, 1});            // a point
  scene.add({{5, 5}, {5.0001, 5}, {5, 5.0001}}, {1, 1, 1});  // less than the lattice
  const RenderResult result = scene.render();
  EXPECT_EQ(result.counters.polygons_in, 4);
  EXPECT_EQ(result.counters.polygons_drawn, 0);
  EXPECT_EQ(covered_texels(result.sprite), 0);
}

TEST(RenderTriangles, OutsideOrBehindTheyAreRejected) {
  FlatScene scene({32, 32});
  scene.add({{-50, 1}, {-1, 1}, {-1, 30}}, {1, 1, 1});
  scene.add({{1, 33}, {30, 33}, {30, 90}}, {1, 1, 1});
  scene.add({{1, 1, -1}, {30, 1, -1}, {30, 30, -1}}, {1, 1, 1});
  const RenderResult result = scene.render();
  EXPECT_EQ(result.counters.polygons_drawn, 0);
  EXPECT_EQ(result.counters.polygon_chunks, 0);
}

// One corner far behind the eye, the others far in front: the triangle contains the whole screen and crosses
// w = 0.
TEST(RenderTriangles, SpanningTheNearPlaneAndTheScreenCoversEverything) {
  FlatScene scene({64, 64});
  layers::Material& material = scene.add({{0, 0}, {1, 0}, {0, 1}}, {1, 1, 1});
  material.two_sided = true;
  scene.mesh().positions = {{-1e5f, 1e5f, -1e4f}, {1e5f, 1e5f, -1e4f}, {0, -1e5f, 1e3f}};
  const RenderResult result = scene.render(exact_options());
  EXPECT_EQ(covered_texels(result.sprite), 64 * 64);
  EXPECT_EQ(difference(result.sprite, scene.reference(exact_options())).texels, 0);
}

// The floor under the viewer's feet: it reaches from behind the camera to the horizon.
TEST(RenderTriangles, AFloorThroughTheNearPlaneEndsAtTheHorizon) {
  FlatScene scene({64, 64});
  scene.add({{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {1, 1, 1});
  const float far = 1e6f;
  scene.mesh().positions = {{-far, -1, far}, {far, -1, far}, {far, -1, -far}, {-far, -1, -far}};
  const Sprite sprite = scene.render().sprite;
  for (int x = 0; x < 64; ++x) {
    EXPECT_EQ(sprite.texel(x, 31), Texel{});
    for (int y = 33; y < 64; ++y) ASSERT_EQ(sprite.texel(x, y).a, 255) << x << " " << y;
  }
}

TEST(RenderTriangles, FromInsideAMeshEveryPixelIsCovered) {
  layers::Scene scene = content::sphere_scene();
  scene.nodes.assign(1, {});
  scene.cameras.assign(1, {});
  scene.lights.clear();
  scene.parts[0].node = 0;
  for (layers::Material& material : scene.materials) material.two_sided = true;
  EXPECT_EQ(covered_texels(render_all(scene, {80, 60}).sprite), 80 * 60);
}

// --- Scales

// The same world in other units is the same picture, from a tenth of a millimetre to a thousand kilometres.
TEST(RenderScale, UnitsDoNotShow) {
  const Sprite expected = render_all(content::moving_scene(), {160, 120}, {}, 1.0).sprite;
  for (const auto& scene : {content::tiny_scene(), content::huge_scene()}) {
    const Difference d = difference(render_all(scene, {160, 120}, {}, 1.0).sprite, expected);
    EXPECT_LT(d.texels, 160 * 120 / 100)
        << "largest " << d.largest << " at " << d.where.x << " " << d.where.y;
  }
}

// --- Materials

TEST(RenderMaterial, OpacityZeroCostsNothing) {
  FlatScene scene({32, 32});
  scene.add({{1, 1}, {31, 1}, {31, 31}, {1, 31}}, {1, 1, 1}, 0);
  const RenderResult result = scene.render();
  EXPECT_EQ(result.counters.polygons_in, 2);
  EXPECT_EQ(result.counters.polygons_drawn, 0);
  EXPECT_EQ(result.counters.pixels_shaded, 0);
  EXPECT_EQ(result.sprite.stored_chunks(), 0);
}

TEST(RenderMaterial, OpacityIsTheAlphaOfTheSprite) {
  for (const float opacity : {0.25f, 0.5f, 1.0f, 7.0f}) {
    FlatScene scene({32, 32});
    scene.add({{0, 0}, {32, 0}, {32, 32}, {0, 32}}, {1, 0.25f, 0}, opacity);
    const Texel t = scene.render().sprite.texel(7, 9);
    const float alpha = std::min(opacity, 1.0f);
    EXPECT_EQ(t, encode({alpha, alpha * 0.25f, 0, alpha})) << opacity;
  }
}

// Numbers that an author should not have written: every texel must still be a valid one, and those that are
// covered opaque.
TEST(RenderMaterial, AbsurdNumbersStayInsideTheSprite) {
  layers::Scene scene = content::sphere_scene();
  layers::Material& material = scene.materials[scene.parts[0].material];
  material.specular = {1e30f, 1, 1};
  material.shininess = 1e4f;
  material.emissive = {static_cast<float>(kNotANumber), -5, 1e30f};
  const Texel t = render_all(scene, {33, 33}).sprite.texel(16, 16);
  EXPECT_EQ(t.a, 255);
  EXPECT_EQ(t.r, 0);    // NaN is shown as nothing
  EXPECT_EQ(t.g, 0);    // darker than black is black
  EXPECT_EQ(t.b, 255);  // brighter than white is white
}

TEST(RenderMaterial, TexturesWithoutCoordinatesOrTexelsAreHarmless) {
  layers::Scene scene = content::textured_quad_scene();
  scene.meshes[scene.parts[0].mesh].uvs.clear();
  const RenderResult missing = render_all(scene, {33, 33});
  EXPECT_EQ(missing.counters.texture_samples, 0);
  EXPECT_EQ(missing.sprite.texel(16, 16).a, 255);
  scene = content::textured_quad_scene();
  for (vec2& uv : scene.meshes[scene.parts[0].mesh].uvs) uv = {static_cast<float>(kNotANumber), 1e38f};
  EXPECT_EQ(render_all(scene, {33, 33}).sprite.texel(16, 16).a, 255);
  scene.textures[0] = layers::Texture();
  EXPECT_EQ(render_all(scene, {33, 33}).counters.texture_samples, 0);
}

TEST(RenderMaterial, TextureAlphaTimesOpacityIsTranslucent) {
  layers::Scene scene = content::textured_quad_scene();
  for (std::size_t i = 3; i < scene.textures[0].rgba.size(); i += 4) scene.textures[0].rgba[i] = 128;
  scene.textures[0].has_alpha = true;
  scene.materials[scene.parts[0].material].opacity = 0.5f;
  EXPECT_EQ(render_all(scene, {33, 33}).sprite.texel(16, 16).a, 64);
}

// A checkerboard far below one texel per cell must be grey; without mip levels it aliases to either colour.
TEST(RenderMaterial, MipmapsKeepMinifiedTexturesFromAliasing) {
  layers::Scene scene = content::textured_quad_scene();
  scene.materials[scene.parts[0].material].unlit = true;
  for (vec2& uv : scene.meshes[scene.parts[0].mesh].uvs) uv *= 37.3f;
  const auto range = [&](bool mipmaps) {
    RenderOptions options;
    options.mipmaps = mipmaps;
    const Sprite sprite = render_all(scene, {64, 64}, options).sprite;
    int lo = 255, hi = 0;
    for (int i = 0; i < 400; ++i) {
      const int v = sprite.texel(22 + i % 20, 22 + i / 20).r;
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
    return hi - lo;
  };
  EXPECT_LT(range(true), 8);
  EXPECT_GT(range(false), 60);
}

// --- Costs

TEST(RenderCounters, AddUp) {
  const RenderResult result = render_all(content::moving_scene(), {200, 150});
  const RenderCounters& c = result.counters;
  EXPECT_EQ(c.chunks_rendered + c.chunks_clear, 7 * 5);
  EXPECT_EQ(c.chunks_rendered, result.sprite.stored_chunks());
  EXPECT_GE(c.polygon_chunks, c.chunks_rendered);
  EXPECT_LE(c.polygons_drawn, c.polygons_in);
  EXPECT_GE(c.pixels_shaded, c.pixels_filled);
  EXPECT_LE(c.fragments + c.fragments_merged, c.pixels_filled);
  EXPECT_GT(c.texture_samples, 0);
  RenderCounters twice = c;
  twice += c;
  EXPECT_EQ(twice.pixels_shaded, 2 * c.pixels_shaded);
  EXPECT_EQ(twice.chunk_subdivisions, 2 * c.chunk_subdivisions);
}

// What a scene does not use costs nothing: no texture, no translucency, no edge inside the sprite.
TEST(RenderCounters, UnusedEffectsCountNothing) {
  FlatScene scene({64, 32});
  scene.add({{-9, -9}, {200, -9}, {-9, 200}}, {1, 1, 1});
  const RenderCounters c = scene.render().counters;
  EXPECT_EQ(c.pixels_filled, 64 * 32);
  EXPECT_EQ(c.pixels_shaded, 64 * 32);
  EXPECT_EQ(c.fragments, 0);
  EXPECT_EQ(c.texture_samples, 0);
  EXPECT_EQ(c.polygon_chunks, 2);
}

// What lies behind a finished texel is not shaded.
TEST(RenderCounters, HiddenTexelsAreNotShaded) {
  FlatScene scene({32, 32});
  for (const double depth : {1.0, 2.0, 3.0})
    scene.add({{-9, -9, depth}, {90, -9, depth}, {-9, 90, depth}}, {1, 1, 1});
  EXPECT_EQ(scene.render().counters.pixels_shaded, 32 * 32);
}

TEST(PreparedScene, HoldsOnlyTexturesThatPartsUse) {
  layers::Scene scene = content::textured_quad_scene();
  const std::int64_t used = PreparedScene(scene).texture_bytes();
  EXPECT_GT(used, 0);
  scene.textures.push_back(content::checker_texture(64, 4));
  EXPECT_EQ(PreparedScene(scene).texture_bytes(), used);
  scene.materials[scene.parts[0].material].texture = -1;
  EXPECT_EQ(PreparedScene(scene).texture_bytes(), 0);
}

}  // namespace
}  // namespace talisman::chunker::tests
