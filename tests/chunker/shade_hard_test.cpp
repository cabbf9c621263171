// SPDX-License-Identifier: Apache-2.0
// Hard cases of the shading terms, each in pixels and against a closed form or the reference.
#include <cmath>

#include <glm/geometric.hpp>

#include "chunker/compression.h"
#include "tests/chunker/composite_fixtures.h"
#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

constexpr float kAmbient = 0.2f;

/// The floor of the scene, alone and matte, under ambient light and one sun; other parts cast at most.
struct Floor {
  Floor() {
    shaded.scene.lights.resize(2);
    shaded.scene.lights[1] = {};
    shaded.scene.lights[1].direction = {1, -2, -0.5};
    shaded.scene.lights[1].color = vec3(0.4f, 0.35f, 0.3f);
    layers::Material& material = shaded.scene.materials[ShadeScene::kFloor];
    material.specular = vec3(0);
    material.texture = -1;
    material.reflectivity = 0;
  }

  LinearImage draw(ShadeTerm term, std::span<const ShadowMap* const> maps,
                   const RenderOptions& options = exact_options()) const {
    const PreparedScene prepared(shaded.scene);
    ShadeInputs inputs;
    inputs.term = term;
    inputs.shadow_maps = maps;
    return render_linear(prepared, shaded.scene.at(0), std::vector<int>{ShadeScene::kFloor}, shaded.size,
                         display_placement(shaded.size), options, inputs);
  }
  LinearImage draw_with(ShadeTerm term, std::span<const int> casters, int resolution_px = 256,
                        const RenderOptions& options = exact_options()) const {
    layers::ShadowMapOptions shadow;
    shadow.resolution_px = resolution_px;
    const ShadowMap map = make_shadow_map(shaded.scene.at(0), 1, casters, shadow);
    const std::vector<const ShadowMap*> maps{nullptr, &map};
    return draw(term, maps, options);
  }

  ShadeScene shaded;
};

const std::vector<int> kCube{ShadeScene::kCube};
constexpr Shading kShadings[] = {Shading::Flat, Shading::Gouraud, Shading::Phong};

int covered(const LinearImage& image) {
  int count = 0;
  for (const LinearColor& c : image.texels) count += c.a > 0 ? 1 : 0;
  return count;
}

// --- Lights and casters

// A lamp inside a closed box: outside of it the world looks as if the lamp were not there.
TEST(HardShadow, LightInsideAnObjectLightsNothingOutside) {
  Floor floor;
  layers::Light& lamp = floor.shaded.scene.lights[1];
  lamp.kind = layers::Light::Kind::Point;
  lamp.color = {0.5f, 0.3f, 0.1f};     // of another hue than the ambient light: nothing of it may be left
  lamp.position = {-0.35, 0.8, 0.02};  // the cube spans (-0.9, 0.4, -0.5) to (0.1, 1.4, 0.5)
  Floor dark = floor;
  dark.shaded.scene.lights.resize(1);
  const LinearImage expected = dark.draw(ShadeTerm::Full, {}), without = floor.draw(ShadeTerm::Full, {});
  for (const Shading shading : kShadings) {
    RenderOptions options = exact_options();
    options.shading = shading;
    const LinearImage image = floor.draw_with(ShadeTerm::Full, kCube, 256, options);
    float lit = 0;
    for (std::size_t i = 0; i < image.texels.size(); ++i) {
      ASSERT_NEAR(image.texels[i].r, expected.texels[i].r, 1e-6f) << i;
      lit = std::max(lit, without.texels[i].r - expected.texels[i].r);
    }
    EXPECT_GT(lit, 0.2f);  // the lamp would light the floor, were it not for the box
  }
}

// Light that comes from behind the floor: no shadow, and the picture of ambient light alone.
TEST(HardShadow, LightBehindTheReceiverIsAmbientAlone) {
  Floor floor;
  floor.shaded.scene.lights[1].direction = {0.3, 1, 0.2};
  Floor dark = floor;
  dark.shaded.scene.lights.resize(1);
  const LinearImage shadow = floor.draw_with(ShadeTerm::Shadow, kCube),
                    full = floor.draw_with(ShadeTerm::Full, kCube), expected = dark.draw(ShadeTerm::Full, {});
  EXPECT_GT(covered(expected), 500);
  for (std::size_t i = 0; i < full.texels.size(); ++i) {
    ASSERT_EQ(shadow.texels[i].a, 0) << i;
    ASSERT_NEAR(full.texels[i].g, expected.texels[i].g, 1e-6f) << i;
  }
}

// Light along the floor: N · L is 0, or nearly. There is next to nothing to take away, and never more.
TEST(HardShadow, ReceiverEdgeOnToTheLight) {
  for (const double slope : {0.0, 1e-9, 1e-4}) {
    Floor floor;
    floor.shaded.scene.lights[1].direction = {1, -slope, 0};
    const LinearImage shadow = floor.draw_with(ShadeTerm::Shadow, kCube),
                      full = floor.draw_with(ShadeTerm::Full, kCube);
    const double most = 0.4 * slope / (kAmbient + 0.4 * slope) + 1e-6;
    const vec3 base = floor.shaded.scene.materials[ShadeScene::kFloor].base_color;
    for (std::size_t i = 0; i < full.texels.size(); ++i) {
      ASSERT_TRUE(shadow.texels[i].a >= 0 && shadow.texels[i].a <= most) << slope;
      if (full.texels[i].a < 1) continue;
      ASSERT_NEAR(full.texels[i].r, kAmbient * base.x, 0.4 * slope + 1e-6);
    }
  }
}

// A receiver that is seen edge-on has no texel, in any term.
TEST(HardShadow, ReceiverEdgeOnToTheEyeShowsNothing) {
  ShadeScene shaded;
  shaded.scene.nodes[3].local.translation = {0, 0, 4};
  shaded.scene.nodes[3].local.rotation = {1, 0, 0, 0};
  shaded.scene.parts.resize(1);
  for (const ShadeTerm term : kAllTerms) {
    const RenderResult result = shaded.render(shaded.inputs(term), exact_options());
    EXPECT_LE(result.counters.polygons_drawn, 18) << name_of(term);  // 3 × 3 cells
    EXPECT_EQ(covered_texels(result.sprite), 0) << name_of(term);
    expect_same(result.sprite, shaded.reference(shaded.inputs(term), exact_options()), name_of(term));
  }
}

// A roof that fills the whole map: every texel has exactly the sun's share of the light as its shadow.
TEST(HardShadow, CasterThatFillsTheMap) {
  Floor floor;
  floor.shaded.scene.nodes[ShadeScene::kCube].local.translation = {0, 40, 0};
  floor.shaded.scene.nodes[ShadeScene::kCube].local.scale = {200, 0.01, 200};
  const layers::Light& sun = floor.shaded.scene.lights[1];
  const double facing = 2 / glm::length(sun.direction);
  const auto y_of = [](const vec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; };
  const double sunlight = y_of(sun.color) * facing, share = sunlight / (kAmbient + sunlight);
  for (const Shading shading : kShadings) {
    RenderOptions options = exact_options();
    options.shading = shading;
    const LinearImage shadow = floor.draw_with(ShadeTerm::Shadow, kCube, 256, options),
                      base = floor.draw_with(ShadeTerm::Base, kCube, 256, options);
    EXPECT_GT(covered(base), 500);
    for (std::size_t i = 0; i < shadow.texels.size(); ++i)
      ASSERT_NEAR(shadow.texels[i].a, share * base.texels[i].a, 1e-5) << i;
  }
}

// A caster whose shadow falls elsewhere: the map is looked up, and the bytes are those without it.
TEST(HardShadow, CasterThatMissesTheReceiver) {
  Floor floor;
  floor.shaded.scene.nodes[ShadeScene::kCube].local.translation = {50, 0.9, 0};
  const LinearImage image = floor.draw_with(ShadeTerm::Full, kCube), plain = floor.draw(ShadeTerm::Full, {});
  EXPECT_GT(image.counters.shadow_lookups, 500);
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    ASSERT_EQ(image.texels[i].r, plain.texels[i].r) << i;
    ASSERT_EQ(image.texels[i].a, plain.texels[i].a) << i;
  }
}

// --- Mirrors

// The plane of the mirror goes through the eye: what it mirrors is what is seen anyway, half of it is cut
// off, and the mirror itself is edge-on. Nothing of it may reach the picture.
TEST(HardReflection, PlaneThroughTheEyeAddsNothing) {
  ShadeScene shaded;
  shaded.scene.nodes[3].local.translation = {0, 0, 4};
  shaded.scene.nodes[3].local.rotation = {1, 0, 0, 0};
  const layers::SceneFrame frame = shaded.scene.at(0);
  ShadeInputs inputs = shaded.inputs();
  const PreparedScene prepared(shaded.scene);
  ShadeInputs of_mirrored;
  of_mirrored.kept = before_mirror(frame, dvec3(0), {0, 1, 0});
  const std::vector<int> mirrored_parts{ShadeScene::kCube, ShadeScene::kBall};
  const Sprite picture = chunker::render(prepared, mirrored_frame(frame, dvec3(0), {0, 1, 0}), mirrored_parts,
                                         shaded.size, display_placement(shaded.size), {}, of_mirrored)
                             .sprite;
  EXPECT_GT(covered_texels(picture), 20);  // the cube and the ball are before the mirror, wholly
  const Reflection reflection{&picture, {}, {}};
  inputs.reflections = {&reflection, 1};
  const RenderResult with = shaded.render(inputs, exact_options());
  inputs.reflections = {};
  expect_same(with.sprite, shaded.render(inputs, exact_options()).sprite, "edge-on mirror");
}

// --- Highlights

/// One triangle across the view (two would share texels, each shaded at its own part of them), lit from the
/// eye's direction: at angle θ from the axis the half vector is θ/2 off the normal, and the highlight is ks ·
/// cos(θ/2)ⁿ.
LinearImage highlight(ivec2 size, float exponent) {
  FlatScene flat(size);
  layers::Material& sheet = flat.add({{-90, -90}, {-90, 300}, {300, -90}}, {0, 0, 0});
  sheet.unlit = sheet.two_sided = false;
  sheet.specular = vec3(0.5f);
  sheet.shininess = exponent;
  flat.mesh().normals.assign(3, {0, 0, 1});
  flat.scene.lights.resize(1);
  flat.scene.lights[0].direction = {0, 0, -1};
  const PreparedScene prepared(flat.scene);
  ShadeInputs inputs;
  inputs.term = ShadeTerm::Specular;
  return render_linear(prepared, flat.scene.at(0), all_parts(flat.scene), size, display_placement(size),
                       exact_options(), inputs);
}

// From no lobe at all to one of a third of a pixel. An odd display has a texel at the very centre; an even
// one has four around it, and their highlight must not vanish either.
TEST(HardHighlight, ExponentsFrom0To10000FollowTheClosedForm) {
  for (const ivec2 size : {ivec2(65, 65), ivec2(64, 64)})
    for (const float exponent : {0.0f, 1e-3f, 1.0f, 50.0f, 1e4f}) {
      const LinearImage image = highlight(size, exponent);
      float most = 0;
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const double off = std::hypot(x + 0.5 - size.x * 0.5, y + 0.5 - size.y * 0.5);
          const double half = std::atan(off / (size.y * 0.5)) / 2;
          ASSERT_TRUE(std::isfinite(image.at(x, y).r));
          ASSERT_NEAR(image.at(x, y).r, 0.5 * std::pow(std::cos(half), exponent), 2e-3)
              << exponent << " at " << x << " " << y;
          most = std::max(most, image.at(x, y).r);
        }
      EXPECT_GT(most, size.x % 2 == 1 ? 0.499f : 0.25f) << exponent;
    }
}

// --- Alpha 0 and 1

// A texture whose texels are wholly there or not at all: exactly 1 and exactly 0, and what is not there
// neither covers nor hides.
TEST(HardAlpha, TexelsOfAlphaZeroAndOneAreExact) {
  const ivec2 size(32, 32);
  FlatScene flat(size);
  layers::Texture halves;
  halves.width = halves.height = 4;
  halves.has_alpha = true;
  for (int i = 0; i < 16; ++i) {
    const std::uint8_t a = i % 4 < 2 ? 255 : 0;
    halves.rgba.insert(halves.rgba.end(), {255, 255, 255, a});
  }
  flat.scene.textures = {halves};
  flat.add({{0, 0}, {32, 0}, {32, 32}, {0, 32}}, {1, 1, 1}).texture = 0;
  flat.mesh().uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  flat.add({{0, 0, 2}, {32, 0, 2}, {32, 32, 2}, {0, 32, 2}}, {0, 1, 0});
  RenderOptions options = exact_options();
  options.filter = TextureFilter::Nearest;
  const Sprite sprite = flat.render(options).sprite;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      ASSERT_EQ(sprite.texel(x, y), x < 16 ? (Texel{255, 255, 255, 255}) : (Texel{0, 255, 0, 255}))
          << x << " " << y;
  flat.scene.parts.pop_back();
  const Sprite alone = flat.render(options).sprite;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) ASSERT_EQ(alone.texel(x, y).a, x < 16 ? 255 : 0) << x << " " << y;
}

// --- The compositor

// [S, 0] adds, [T, t] covers: in front of the pane the light is added whole, behind it what the pane lets
// through.
TEST(HardOver, TranslucentAndAdditiveInBothOrders) {
  const Texel light{100, 60, 20, 0}, pane{90, 90, 120, 128};
  const Sprite sprites[2] = {solid({40, 40}, light), solid({40, 40}, pane)};
  const auto draw = [&](int behind, int before) {
    std::vector<PlacedSprite> stack(2);
    stack[0].sprite = &sprites[behind];
    stack[1].sprite = &sprites[before];
    const Frame frame = composite(stack, {40, 40}, {0.25f, 0.25f, 0.25f}).frame;
    EXPECT_EQ(frame, reference::composite(stack, {40, 40}, {0.25f, 0.25f, 0.25f}));
    return frame.pixels[20 * 40 + 20];
  };
  const Linear16 lit_pane = draw(1, 0), pane_over_light = draw(0, 1), l = decode(light), p = decode(pane);
  const double open = 1 - static_cast<double>(p.a) / kOne, ground = 0.25 * kOne;
  EXPECT_NEAR(lit_pane.r, p.r + ground * open + l.r, 2);
  EXPECT_NEAR(pane_over_light.r, p.r + (ground + l.r) * open, 2);
  EXPECT_NEAR(lit_pane.b, p.b + ground * open + l.b, 2);
  EXPECT_NEAR(pane_over_light.b, p.b + (ground + l.b) * open, 2);
}

// Chunks of nothing, of one texel and of one colour, next to each other, after compression: the first is
// still nothing, alpha is the same everywhere, and the picture is off by what quality 100 may be off.
TEST(HardCompression, EmptyFullAndOneTexelChunksShowTheSamePicture) {
  const auto texel = [](int x, int y) {
    if (x < 32) return x == 13 && y == 17 ? Texel{200, 100, 50, 255} : Texel{};
    if (x < 64) return Texel{};
    return Texel{180, 90, 30, 255};
  };
  const Sprite sprite = make_sprite({96, 32}, texel), back = decompress(compress(sprite, {100}));
  EXPECT_EQ(back.stored_chunks(), sprite.stored_chunks());
  EXPECT_EQ(back.chunk(1, 0), nullptr);
  EXPECT_LE(difference(sprite, back).largest, 2);
  std::vector<PlacedSprite> before(1), after(1);
  before[0].sprite = &sprite;
  after[0].sprite = &back;
  const auto a = srgb_bytes(composite(before, {96, 32}, {0, 0, 0}).frame),
             b = srgb_bytes(composite(after, {96, 32}, {0, 0, 0}).frame);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 96; ++x) {
      ASSERT_EQ(back.texel(x, y).a, texel(x, y).a) << x << " " << y;
      for (int k = 0; k < 3; ++k) {
        const std::size_t i = 3 * (static_cast<std::size_t>(y) * 96 + x) + k;
        ASSERT_NEAR(a[i], b[i], texel(x, y).a == 0 ? 0 : 3) << x << " " << y;
      }
    }
}

// --- Scale

// A shadow in a sprite of an eighth of the resolution: equal to the reference, and where the shadow is even,
// what the full one has there on average.
TEST(HardScale, ShadowAtAnEighth) {
  ShadeScene shaded;
  shaded.size = {160, 120};
  const ShadeInputs inputs = shaded.inputs(ShadeTerm::Shadow, ShadeScene::kSun);
  layers::SpritePlacement coarse = display_placement({20, 15});
  coarse.screen_from_sprite = {8, 0, 0, 0, 8, 0};
  const PreparedScene prepared(shaded.scene);
  const std::vector<int> floor{ShadeScene::kFloor};
  const auto draw = [&](const layers::SpritePlacement& placement) {
    return render_linear(prepared, shaded.scene.at(0), floor, shaded.size, placement, exact_options(),
                         inputs);
  };
  expect_same(
      chunker::render(prepared, shaded.scene.at(0), floor, shaded.size, coarse, exact_options(), inputs)
          .sprite,
      reference::render(prepared, shaded.scene.at(0), floor, shaded.size, coarse, exact_options(), inputs),
      "an eighth");
  const LinearImage small = draw(coarse), full = draw(display_placement(shaded.size));
  int even = 0, dark = 0;
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 20; ++x) {
      float lo = 1, hi = 0;
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
          lo = std::min(lo, full.at(8 * x + i, 8 * y + j).a);
          hi = std::max(hi, full.at(8 * x + i, 8 * y + j).a);
        }
      if (hi - lo > 0.02f) continue;
      ++even;
      dark += lo > 0.1f ? 1 : 0;
      ASSERT_NEAR(small.at(x, y).a, (lo + hi) / 2, 0.011f) << x << " " << y;
    }
  EXPECT_GT(even, 150);
  EXPECT_GT(dark, 3);
}

}  // namespace
}  // namespace talisman::chunker::tests
