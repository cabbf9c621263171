// SPDX-License-Identifier: Apache-2.0
// Every term of the shading expression on its own: equal to the reference, in line with the others, and right
// where an answer is known.
#include <hwy/targets.h>

#include <tbb/global_control.h>

#include "chunker/shade.h"
#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

float largest_color(const LinearImage& image) {
  float largest = 0;
  for (const LinearColor& c : image.texels) largest = std::max({largest, c.r, c.g, c.b});
  return largest;
}

float largest_alpha(const LinearImage& image) {
  float largest = 0;
  for (const LinearColor& c : image.texels) largest = std::max(largest, c.a);
  return largest;
}

TEST(ShadeTerm, EqualsTheReferenceInEveryShading) {
  ShadeScene shaded;
  shaded.scene.materials[ShadeScene::kFloor].texture2 = 1;
  shaded.scene.materials[ShadeScene::kFloor].texture_blend = {0.7f, 0.2f};
  for (const ShadeTerm term : kAllTerms)
    for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
      RenderOptions options = exact_options();
      options.shading = shading;
      const RenderResult result = shaded.render(shaded.inputs(term), options);
      expect_same(result.sprite, shaded.reference(shaded.inputs(term), options), name_of(term));
      EXPECT_GT(result.sprite.stored_chunks(), 0) << name_of(term);
      if (shading == Shading::Phong)
        dump_picture("term" + std::to_string(static_cast<int>(term)), result.sprite);
    }
}

// Lanes, threads: nothing of it may show in a byte.
TEST(ShadeTerm, HasTheSameBytesForAnyLanesAndThreads) {
  ShadeScene shaded;
  shaded.size = {90, 70};
  shaded.scene.materials[ShadeScene::kCube].shininess = 1e4f;
  for (const ShadeTerm term : {ShadeTerm::Full, ShadeTerm::Shadow, ShadeTerm::Specular}) {
    const ShadeInputs inputs = shaded.inputs(term);
    const Sprite expected = shaded.render(inputs).sprite;
    for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
      hwy::GetChosenTarget().Update(targets & -targets);
      expect_same(shaded.render(inputs).sprite, expected, hwy::TargetName(targets & -targets));
    }
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    expect_same(shaded.render(inputs).sprite, expected, "one thread");
  }
}

// Maps that say nothing, of whatever form, must leave the picture and the counters alone.
TEST(ShadeTerm, InputsWithoutContentCostNothing) {
  ShadeScene shaded;
  const RenderResult plain = shaded.render({});
  const ShadowMap empty;
  const std::vector<const ShadowMap*> maps{nullptr, &empty, nullptr, &empty};
  ShadeInputs inputs;
  inputs.shadow_maps = maps;
  const RenderResult same = shaded.render(inputs);
  expect_same(plain.sprite, same.sprite, "empty maps");
  EXPECT_EQ(plain.counters, same.counters);
  EXPECT_EQ(same.counters.shadow_lookups + same.counters.reflection_lookups, 0);
  // Terms that do not ask for shadows look none up, even when maps are there.
  for (const ShadeTerm term : {ShadeTerm::Base, ShadeTerm::Reflection, ShadeTerm::Texture1})
    EXPECT_EQ(shaded.render(shaded.inputs(term)).counters.shadow_lookups, 0) << name_of(term);
  EXPECT_GT(shaded.render(shaded.inputs(ShadeTerm::Shadow)).counters.shadow_lookups, 0);
  EXPECT_EQ(shaded.render(shaded.inputs(ShadeTerm::Shadow)).counters.texture_samples, 0);
}

TEST(ShadeTerm, AddedTermsHaveNoAlphaAndShadowsNoColour) {
  ShadeScene shaded;
  shaded.scene.materials[ShadeScene::kFloor].texture2 = 1;
  for (const ShadeTerm term : {ShadeTerm::Specular, ShadeTerm::Reflection, ShadeTerm::Texture2}) {
    const LinearImage image = shaded.linear(shaded.inputs(term));
    EXPECT_EQ(largest_alpha(image), 0) << name_of(term);
    EXPECT_GT(largest_color(image), 0.02f) << name_of(term);
  }
  const LinearImage shadow = shaded.linear(shaded.inputs(ShadeTerm::Shadow));
  EXPECT_EQ(largest_color(shadow), 0);
  EXPECT_GT(largest_alpha(shadow), 0.3f);
  EXPECT_LE(largest_alpha(shadow), 1);
}

// A matte cube over a shiny, mirroring floor: where the cube is seen the floor adds nothing.
TEST(ShadeTerm, HiddenSurfacesStayHidden) {
  ShadeScene shaded;
  shaded.scene.materials[ShadeScene::kCube].specular = {0, 0, 0};
  shaded.scene.parts.pop_back();
  const PreparedScene prepared(shaded.scene);
  const std::vector<int> cube{ShadeScene::kCube}, both{ShadeScene::kFloor, ShadeScene::kCube};
  const auto draw = [&](std::span<const int> parts, ShadeTerm term) {
    ShadeInputs inputs;
    inputs.term = term;
    return render_linear(prepared, shaded.scene.at(0), parts, shaded.size, display_placement(shaded.size), {},
                         inputs);
  };
  const LinearImage cover = draw(cube, ShadeTerm::Base), specular = draw(both, ShadeTerm::Specular),
                    floor = draw(std::vector<int>{ShadeScene::kFloor}, ShadeTerm::Specular);
  int covered = 0;
  float would_show = 0;
  for (std::size_t i = 0; i < cover.texels.size(); ++i) {
    if (cover.texels[i].a < 1) continue;
    ++covered;
    EXPECT_EQ(specular.texels[i].g, 0) << i;
    would_show = std::max(would_show, floor.texels[i].g);
  }
  EXPECT_GT(covered, 20);
  EXPECT_GT(would_show, 0.001f);  // or the test could not fail
}

// Inside one triangle no texel mixes surfaces: one shadow of the hue of the ambient light, which is what black
// with alpha can show, must be that of one pass in every one.
TEST(ShadeTerm, AddUpToFullInsideASurface) {
  for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
    ShadeScene shaded;
    shaded.scene.lights.resize(2);
    shaded.inputs();
    shaded.scene.parts.resize(1);
    shaded.scene.meshes[ShadeScene::kFloor] = talisman::tests::quad_mesh(6, 1, 3);
    shaded.scene.meshes[ShadeScene::kFloor].indices.resize(3);
    int whole = 0;
    RenderOptions options = exact_options();
    options.shading = shading;
    const LinearImage full = shaded.linear(shaded.inputs(), options),
                      unfactored = shaded.multipass(shaded.inputs(), options);
    for (std::size_t i = 0; i < full.texels.size(); ++i) {
      if (full.texels[i].a < 1) continue;
      ++whole;
      EXPECT_NEAR(full.texels[i].r, unfactored.texels[i].r, 2e-6f) << i;
      EXPECT_NEAR(full.texels[i].b, unfactored.texels[i].b, 2e-6f) << i;
    }
    EXPECT_GT(whole, 200);
  }
}

/// The stage under its ambient light and those of `lights`, each with its own shadow map.
LinearImage under(std::initializer_list<int> lights, const RenderOptions& options) {
  ShadeScene shaded;
  for (const int light : {ShadeScene::kSpot, ShadeScene::kSun})
    if (std::find(lights.begin(), lights.end(), light) == lights.end())
      shaded.scene.lights[light].color = vec3(0);
  ShadeInputs inputs = shaded.inputs();
  inputs.reflections = {};  // a picture in bytes, of another light each time
  return shaded.linear(inputs, options);
}

// Light adds up [LS97 2.3]: a picture under two lamps is the sum of the pictures under one, each with its own
// shadows and highlights, whatever their hues, on every texel. What is there without them counts once.
TEST(ShadeTerm, FullIsTheSumOverTheLights) {
  for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
    RenderOptions options = exact_options();
    options.shading = shading;
    const LinearImage both = under({ShadeScene::kSpot, ShadeScene::kSun}, options),
                      spot = under({ShadeScene::kSpot}, options), sun = under({ShadeScene::kSun}, options),
                      neither = under({}, options);
    for (std::size_t i = 0; i < both.texels.size(); ++i) {
      const LinearColor &a = spot.texels[i], &b = sun.texels[i], &none = neither.texels[i];
      ASSERT_NEAR(both.texels[i].r, a.r + b.r - none.r, 2e-6f) << i;
      ASSERT_NEAR(both.texels[i].g, a.g + b.g - none.g, 2e-6f) << i;
      ASSERT_NEAR(both.texels[i].b, a.b + b.b - none.b, 2e-6f) << i;
    }
  }
}

// Two equal lamps and nothing else: hidden from both there is no light at all, hidden from one half of it. A
// product of what each leaves would be a quarter.
TEST(ShadeTerm, WhereBothLampsAreHiddenIsNoLight) {
  for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
    ShadeScene shaded;
    shaded.scene.lights[0].color = vec3(0);
    for (const int light : {ShadeScene::kSpot, ShadeScene::kSun}) {
      shaded.scene.lights[light] = {};
      shaded.scene.lights[light].direction = {light == ShadeScene::kSpot ? 0.3 : -0.3, -1, 0};
      shaded.scene.lights[light].color = vec3(0.4f);
      shaded.scene.lights[light].casts_shadow = true;
    }
    for (layers::Material& material : shaded.scene.materials) material.specular = material.emissive = vec3(0);
    shaded.scene.materials[ShadeScene::kFloor].texture = -1;
    shaded.scene.materials[ShadeScene::kFloor].reflectivity = 0;
    ShadeInputs inputs = shaded.inputs();
    inputs.reflections = {};
    RenderOptions options = exact_options();
    options.shading = shading;
    const LinearImage image = shaded.linear(inputs, options);
    const float lit = shaded.scene.materials[ShadeScene::kFloor].base_color.x * 0.8f * (1 / std::sqrt(1.09f));
    int dark = 0, half = 0, full = 0;
    for (const LinearColor& c : image.texels) {
      if (c.a < 1) continue;
      dark += c.r == 0;
      half += std::abs(c.r - lit / 2) < 1e-5f;
      full += std::abs(c.r - lit) < 1e-5f;
    }
    EXPECT_GT(dark, 20) << static_cast<int>(shading);
    EXPECT_GT(half, 20) << static_cast<int>(shading);
    EXPECT_GT(full, 100) << static_cast<int>(shading);
  }
}

// What the light does not reach for facing away has no light to lose: nothing is darkened twice.
TEST(ShadeTerm, NoShadowOnSurfacesThatFaceAway) {
  ShadeScene shaded;
  shaded.scene.lights.resize(2);
  shaded.scene.lights[ShadeScene::kSpot].position = {0, -3, 0};  // below the floor, which is seen from above
  shaded.scene.lights[ShadeScene::kSpot].direction = {0, 1, 0};
  shaded.scene.lights[ShadeScene::kSpot].outer_cone_rad = 1.5;
  shaded.scene.parts.resize(1);
  const std::vector<int> casters{ShadeScene::kFloor};
  const ShadowMap map = make_shadow_map(shaded.scene.at(0), ShadeScene::kSpot, casters);
  const std::vector<const ShadowMap*> maps{nullptr, &map};
  ShadeInputs inputs;
  inputs.shadow_maps = maps;
  for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
    RenderOptions options;
    options.shading = shading;
    inputs.term = ShadeTerm::Shadow;
    EXPECT_EQ(largest_alpha(shaded.linear(inputs, options)), 0);
    inputs.term = ShadeTerm::Full;
    const float lit = largest_color(shaded.linear(inputs, options));
    EXPECT_NEAR(lit, largest_color(shaded.linear({}, options)), 1e-6f);
  }
}

// A pane in front: at alpha 0 it is not there, at alpha 1 nothing is behind it, between it dims what is
// added.
TEST(ShadeTerm, TranslucentOverAdditive) {
  const ivec2 size(8, 8);
  const auto highlight = [&](float opacity) {
    FlatScene flat(size);
    layers::Material& floor =
        flat.add({{-9, -9, 2}, {20, -9, 2}, {20, 20, 2}, {-9, 20, 2}}, {0.5f, 0.5f, 0.5f});
    floor.unlit = false;
    floor.specular = vec3(0.5f);
    floor.shininess = 0;                        // the same everywhere
    flat.mesh().normals.assign(4, {0, 0, -1});  // seen from its back, where normals are turned
    flat.add({{-9, -9, 1}, {20, -9, 1}, {20, 20, 1}, {-9, 20, 1}}, {1, 1, 1}, opacity);
    flat.scene.lights.resize(1);
    flat.scene.lights[0].direction = {0, 0, -1};
    const PreparedScene prepared(flat.scene);
    ShadeInputs inputs;
    inputs.term = ShadeTerm::Specular;
    return render_linear(prepared, flat.scene.at(0), all_parts(flat.scene), size, display_placement(size), {},
                         inputs)
        .at(4, 4);
  };
  EXPECT_NEAR(highlight(0).r, 0.5f, 1e-6f);
  EXPECT_NEAR(highlight(0.25f).r, 0.375f, 1e-6f);
  EXPECT_EQ(highlight(1).r, 0);
  for (const float opacity : {0.0f, 0.25f, 1.0f}) EXPECT_EQ(highlight(opacity).a, 0);
}

TEST(ShadeTerm, ExtremeExponentsEqualTheReference) {
  for (const float shininess : {0.0f, 1e4f}) {
    ShadeScene shaded;
    for (layers::Material& material : shaded.scene.materials) material.shininess = shininess;
    expect_same(shaded.render(shaded.inputs(ShadeTerm::Specular), exact_options()).sprite,
                shaded.reference(shaded.inputs(ShadeTerm::Specular), exact_options()),
                std::to_string(shininess));
  }
}

// A light that is not a number is left out, its map is empty, and the rest of the picture stays.
TEST(ShadeTerm, LightsThatAreNotFiniteAreLeftOut) {
  ShadeScene broken, dark;
  broken.scene.lights[ShadeScene::kSpot].color.x = std::nanf("");
  broken.scene.lights[ShadeScene::kSpot].position.x = std::nan("");
  dark.scene.lights[ShadeScene::kSpot].color = vec3(0);
  for (const ShadeTerm term : {ShadeTerm::Full, ShadeTerm::Shadow, ShadeTerm::Specular})
    expect_same(broken.render(broken.inputs(term)).sprite, dark.render(dark.inputs(term)).sprite,
                name_of(term));
}

// The highlight of one light, and then of the other: together the highlights of both.
TEST(ShadeTerm, HighlightsOfSingleLightsAddUp) {
  ShadeScene shaded;
  const LinearImage all = shaded.linear(shaded.inputs(ShadeTerm::Specular), exact_options()),
                    spot =
                        shaded.linear(shaded.inputs(ShadeTerm::Specular, ShadeScene::kSpot), exact_options()),
                    sun =
                        shaded.linear(shaded.inputs(ShadeTerm::Specular, ShadeScene::kSun), exact_options());
  EXPECT_GT(largest_color(spot), 0.01f);
  EXPECT_GT(largest_color(sun), 0.01f);
  for (std::size_t i = 0; i < all.texels.size(); ++i)
    EXPECT_NEAR(all.texels[i].r, spot.texels[i].r + sun.texels[i].r, 1e-6f) << i;
}

// (N·L) T₁ and (N·L) T₂ with their blend factors are the base [LS97 2.3].
TEST(ShadeTerm, TexturesBlendToTheBase) {
  ShadeScene shaded;
  shaded.scene.parts.resize(1);
  shaded.scene.materials[ShadeScene::kFloor].texture2 = 1;
  shaded.scene.materials[ShadeScene::kFloor].texture_blend = {0.75f, 0.5f};
  const LinearImage base = shaded.linear(shaded.inputs(ShadeTerm::Base), exact_options()),
                    one = shaded.linear(shaded.inputs(ShadeTerm::Texture1), exact_options()),
                    two = shaded.linear(shaded.inputs(ShadeTerm::Texture2), exact_options());
  EXPECT_GT(largest_color(two), 0.05f);
  for (std::size_t i = 0; i < base.texels.size(); ++i) {
    EXPECT_EQ(base.texels[i].a, one.texels[i].a);
    EXPECT_NEAR(base.texels[i].g, 0.75f * one.texels[i].g + 0.5f * two.texels[i].g, 1e-6f) << i;
  }
}

// --- Spot lights

TEST(Light, SpotFallsOffBetweenItsCones) {
  layers::SceneFrame frame;
  frame.lights.resize(1);
  frame.lights[0].kind = layers::Light::Kind::Spot;
  frame.lights[0].position = {0, 0, 0};
  frame.lights[0].direction = {0, 0, -1};
  frame.lights[0].inner_cone_rad = 0.2;
  frame.lights[0].outer_cone_rad = 0.5;
  const LightSet lights = light_set(frame);
  ASSERT_EQ(lights.spot.size(), 1u);
  Shader shader;
  shader.lights = &lights;
  const auto at = [&](float angle) {  // lit square on, in every direction
    const Float4 position{std::sin(angle), 0, -std::cos(angle), 0};
    return light(shader, -position, position).diffuse[0];
  };
  EXPECT_FLOAT_EQ(at(0), 1);
  EXPECT_FLOAT_EQ(at(0.19f), 1);
  EXPECT_EQ(at(0.51f), 0);
  EXPECT_EQ(at(3), 0);
  float before = 1;
  for (float angle = 0.2f; angle < 0.5f; angle += 0.01f) {
    EXPECT_LE(at(angle), before + 1e-6f);
    before = at(angle);
  }
  const double half = (std::cos(0.2) + std::cos(0.5)) / 2;  // t = ½ gives ½
  EXPECT_NEAR(at(static_cast<float>(std::acos(half))), 0.5f, 1e-5f);
}

// --- Samples, filters

TEST(RenderOptions, FewerSamplesEqualTheReference) {
  for (const int samples : {1, 4}) {
    ShadeScene shaded;
    RenderOptions options = exact_options();
    options.samples = samples;
    expect_same(shaded.render(shaded.inputs(), options).sprite, shaded.reference(shaded.inputs(), options),
                std::to_string(samples) + " samples");
  }
}

TEST(RenderOptions, SamplesAreTheStepsOfAnEdge) {
  FlatScene flat({40, 40});
  flat.add({{3, 2}, {37, 9}, {11, 36}}, {1, 1, 1});
  for (const int samples : {1, 4, 16}) {
    RenderOptions options;
    options.samples = samples;
    const RenderResult result = flat.render(options);
    int partial = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const float steps = static_cast<float>(result.sprite.texel(x, y).a) / 255.0f * samples;
        EXPECT_NEAR(steps, std::round(steps), 0.05f) << samples << " at " << x << " " << y;
        partial += result.sprite.texel(x, y).a % 255 != 0 ? 1 : 0;
      }
    EXPECT_EQ(partial > 0, samples > 1);
    if (samples == 1) {
      EXPECT_EQ(result.counters.fragments, 0);
    }
    EXPECT_NEAR(covered_texels(result.sprite), 34 * 34 / 2, 120);
  }
}

TEST(RenderOptions, FiltersEqualTheReference) {
  ShadeScene shaded;
  RenderOptions options = exact_options();
  for (const TextureFilter filter :
       {TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear})
    for (const int anisotropy : {1, 8}) {
      options.filter = filter;
      options.max_anisotropy = anisotropy;
      expect_same(shaded.render({}, options).sprite, shaded.reference({}, options),
                  std::to_string(static_cast<int>(filter)) + " " + std::to_string(anisotropy));
    }
}

// A checkered floor seen at a grazing angle: the truth is the same picture at four times the resolution,
// averaged. More samples along the line of anisotropy must come closer to it.
TEST(RenderOptions, AnisotropicSamplesComeCloserToTheTruth) {
  ShadeScene shaded;
  shaded.scene.parts.resize(1);
  shaded.scene.nodes[3].local.translation = {0, 0.5, 3.5};
  shaded.scene.nodes[3].local.rotation = glm::angleAxis(-0.15, dvec3(1, 0, 0));
  const int k = 4;
  ShadeScene fine = shaded;
  fine.size = shaded.size * k;
  const LinearImage truth = fine.linear({});
  const auto error = [&](int anisotropy) {
    RenderOptions options;
    options.max_anisotropy = anisotropy;
    const LinearImage image = shaded.linear({}, options);
    double sum = 0;
    for (int y = 0; y < shaded.size.y; ++y)
      for (int x = 0; x < shaded.size.x; ++x) {
        double mean = 0;
        for (int j = 0; j < k; ++j)
          for (int i = 0; i < k; ++i) mean += truth.at(x * k + i, y * k + j).g;
        const double d = image.at(x, y).g - mean / (k * k);
        sum += d * d;
      }
    return sum;
  };
  const double isotropic = error(1), two = error(2), eight = error(8);
  EXPECT_LT(two, isotropic);
  EXPECT_LT(eight, 0.5 * isotropic);
}

TEST(Anisotropic, DegenerateDerivativesAreOneSample) {
  const Pyramid pyramid = build_pyramid(talisman::tests::checker_texture(4, 8));
  const float inf = HUGE_VALF, nan = std::nanf("");
  for (const TextureDerivatives& d :
       {TextureDerivatives{splat(0), splat(0)}, TextureDerivatives{Float4{inf, 0, 0, 0}, splat(1)},
        TextureDerivatives{Float4{nan, 0, 0, 0}, splat(nan)}, TextureDerivatives{splat(3), splat(3)}}) {
    int samples = 0;
    const Float4 c = anisotropic(pyramid, 0.3f, 0.4f, d, 16, samples);
    EXPECT_EQ(samples, 1);
    EXPECT_TRUE(c[0] >= 0 && c[0] <= 1);
  }
  int samples = 0;
  anisotropic(pyramid, 0.3f, 0.4f, {Float4{100, 0, 0, 0}, Float4{0, 0.01f, 0, 0}}, 16, samples);
  EXPECT_EQ(samples, 16);
}

}  // namespace
}  // namespace talisman::chunker::tests
