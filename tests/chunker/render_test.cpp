// SPDX-License-Identifier: Apache-2.0
// The renderer as its callers meet it: equal to the reference, equal to itself on any machine, and right
// where an answer is known.
#include <hwy/targets.h>

#include <cmath>
#include <cstring>
#include <random>

#include <tbb/global_control.h>
#include <glm/geometric.hpp>

#include "tests/chunker/render_support.h"
#include "tests/support/scenes.h"

namespace talisman::chunker::tests {
namespace {

namespace content = talisman::tests;

std::vector<layers::Scene> workloads() {
  return {content::cube_scene(), content::textured_quad_scene(), content::sphere_scene(),
          content::moving_scene(), content::skinned_bar_scene()};
}

layers::SpritePlacement rotated_placement(ivec2 size, double angle, double scale, bool mirrored) {
  layers::SpritePlacement placement = display_placement(size);
  const double c = std::cos(angle) / scale, s = std::sin(angle) / scale;
  const double flip = mirrored ? -1 : 1;
  placement.screen_from_sprite = {flip * c, -s, mirrored ? size.x : 5.25, flip * s, c, -7.5};
  placement.axis_aligned = false;
  return placement;
}

/// Triangles of every size, slope, opacity and order, many of them through each other.
FlatScene random_soup(unsigned seed, ivec2 size, int count, bool translucent) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  FlatScene soup(size);
  for (int n = 0; n < count; ++n) {
    const double reach = std::pow(unit(random), 3) * 2;
    std::vector<FlatScene::Corner> corners;
    const double x = unit(random) * size.x, y = unit(random) * size.y;
    for (int k = 0; k < 3; ++k)
      corners.push_back({x + (unit(random) - 0.5) * reach * size.x, y + (unit(random) - 0.5) * reach * size.y,
                         0.5 + unit(random)});
    const vec3 color(unit(random), unit(random), unit(random));
    soup.add(corners, color, translucent && n % 3 == 0 ? static_cast<float>(unit(random)) : 1.0f);
  }
  return soup;
}

// --- Against the reference

TEST(Render, EqualsTheReferenceOnTheWorkloads) {
  for (const layers::Scene& scene : workloads())
    for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
      RenderOptions options = exact_options();
      options.shading = shading;
      const ivec2 size(70, 45);
      expect_same(render_all(scene, size, options, 0.7).sprite, render_reference(scene, size, options, 0.7),
                  scene.parts[0].name + " shading " + std::to_string(static_cast<int>(shading)));
    }
}

TEST(Render, EqualsTheReferenceThroughRotatedScaledAndMirroredSprites) {
  for (const bool mirrored : {false, true})
    for (const double angle : {0.3, 2.0, -1.2}) {
      const auto placement = rotated_placement({61, 52}, angle, 1.7, mirrored);
      expect_same(render_all(content::moving_scene(), placement, {64, 48}, exact_options()).sprite,
                  render_reference(content::moving_scene(), placement, {64, 48}, exact_options()),
                  std::to_string(angle));
    }
}

// One chunk, one texel more and less, a single texel: the borders of every loop.
TEST(Render, EqualsTheReferenceAroundTheSizeOfAChunk) {
  for (const ivec2 size :
       {ivec2(1, 1), ivec2(31, 33), ivec2(32, 32), ivec2(33, 31), ivec2(65, 1), ivec2(1, 64)}) {
    const FlatScene soup = random_soup(42, size, 30, true);
    expect_same(soup.render(exact_options()).sprite, soup.reference(exact_options()),
                std::to_string(size.x) + "x" + std::to_string(size.y));
  }
}

TEST(Render, EqualsTheReferenceOnRandomSoups) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const FlatScene soup = random_soup(seed, {48, 40}, 120, seed % 2 == 0);
    RenderOptions options = exact_options();
    for (const int samples : {16, 4, 1}) {
      options.samples = samples;
      expect_same(soup.render(options).sprite, soup.reference(options),
                  "seed " + std::to_string(seed) + ", samples " + std::to_string(samples));
    }
  }
}

// The merge rule may change a texel, by what its tolerances say: one code value.
TEST(Render, MergingCostsAtMostOneCodeValue) {
  const layers::Scene scene = content::displaced_sphere_scene(20000);
  for (const int samples : {16, 4}) {
    RenderOptions exactly = exact_options(), merging;
    exactly.samples = merging.samples = samples;
    const RenderResult exact = render_all(scene, {96, 96}, exactly),
                       merged = render_all(scene, {96, 96}, merging);
    EXPECT_GT(merged.counters.fragments_merged, 100);
    EXPECT_EQ(exact.counters.fragments_merged, 0);
    EXPECT_LE(difference(exact.sprite, merged.sprite).largest, 1) << samples;
    dump_picture("ball", merged.sprite);
  }
}

// --- The same bytes always

TEST(Render, ThreadsDoNotChangeBytesOrCounters) {
  const layers::Scene scene = content::displaced_sphere_scene(20000);
  const RenderResult expected = render_all(scene, {200, 150});
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const RenderResult result = render_all(scene, {200, 150});
    expect_same(result.sprite, expected.sprite, std::to_string(threads) + " threads");
    EXPECT_EQ(result.counters, expected.counters);
  }
}

TEST(Render, EveryInstructionSetGivesTheSameBytes) {
  layers::Scene scene = content::moving_scene();
  for (layers::Material& material : scene.materials) {
    material.specular = {0.6f, 0.6f, 0.6f};
    material.shininess = 12;
  }
  scene.materials.back().opacity = 0.5f;
  const ivec2 size(320, 240);
  for (const int samples : {1, 4, 16}) {
    RenderOptions options;
    options.samples = samples;
    const RenderResult expected = render_all(scene, size, options);
    dump_picture("moving", expected.sprite);
    int sets = 0;
    for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1, ++sets) {
      hwy::GetChosenTarget().Update(targets & -targets);
      expect_same(render_all(scene, size, options).sprite, expected.sprite,
                  hwy::TargetName(targets & -targets));
    }
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GE(sets, 1);
  }
}

// Overflow redraws the chunk in quarters, and those again: the buffer's size must not show.
TEST(Render, FragmentOverflowSubdividesToTheSameBytes) {
  const FlatScene soup = random_soup(77, {64, 64}, 200, true);
  RenderOptions small;
  small.max_fragments_per_chunk = 16;
  RenderOptions large;
  large.max_fragments_per_chunk = 1 << 20;
  for (const int samples : {16, 4, 1}) {
    small.samples = large.samples = samples;
    const RenderResult few = soup.render(small), many = soup.render(large);
    dump_picture("soup", few.sprite);
    EXPECT_GT(few.counters.chunk_subdivisions, 4);
    EXPECT_EQ(many.counters.chunk_subdivisions, 0);
    expect_same(few.sprite, many.sprite, "16 fragments against 2^20");
  }
}

// More layers on each pixel than any buffer holds: pixels are drawn one by one, and the sum is still the
// closed form.
TEST(Render, AThousandTranslucentLayersOnOnePixel) {
  FlatScene panes({3, 2});
  for (int n = 0; n < 1000; ++n) {
    const double depth = 1 + ((n * 617) % 1000) * 0.01;
    panes.add({{-1, -1, depth}, {4, -1, depth}, {4, 3, depth}, {-1, 3, depth}}, {1, 1, 1}, 0.002f);
  }
  RenderOptions options;
  options.max_fragments_per_chunk = 16;
  const RenderResult result = panes.render(options);
  EXPECT_GT(result.counters.chunk_subdivisions, 0);
  const double alpha = 1 - std::pow(1 - 0.002, 1000);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(result.sprite.texel(i % 3, i / 3).a, alpha * 255, 1);
    EXPECT_NEAR(result.sprite.texel(i % 3, i / 3).r, std::sqrt(alpha) * 255, 1);
  }
}

// A sprite anchored on the display's lattice is a cut-out of the display, byte for byte.
TEST(Render, AnAnchoredSpriteIsACutOutOfTheDisplay) {
  const ivec2 display(160, 120);
  const RenderResult whole = render_all(content::moving_scene(), display);
  layers::SpritePlacement placement = display_placement({70, 50});
  placement.screen_from_sprite.tx = 45;
  placement.screen_from_sprite.ty = 33;
  const RenderResult part = render_all(content::moving_scene(), placement, display);
  EXPECT_GT(covered_texels(part.sprite), 500);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 70; ++x)
      ASSERT_EQ(part.sprite.texel(x, y), whole.sprite.texel(x + 45, y + 33)) << x << " " << y;
}

// --- Against known answers

TEST(Render, CoverageIsTheShareOfSamples) {
  FlatScene half({8, 8});
  half.add({{2, 1}, {4.5, 1}, {4.5, 6}, {2, 6}}, {1, 1, 1});
  const Sprite sprite = half.render().sprite;
  EXPECT_EQ(sprite.texel(3, 3), (Texel{255, 255, 255, 255}));
  EXPECT_EQ(sprite.texel(4, 3).a, 128);
  EXPECT_EQ(sprite.texel(5, 3), Texel{});
  EXPECT_EQ(sprite.texel(3, 0), Texel{});
}

// A translucent surface shows every sample that is covered twice or not at all as a wrong alpha.
TEST(Render, ATranslucentMeshHasNoSeams) {
  layers::Scene scene = content::sphere_scene();
  scene.meshes[scene.parts[0].mesh] = content::sphere_mesh(48, 96);  // convex: its front covers nothing twice
  for (layers::Material& material : scene.materials) {
    material.unlit = true;
    material.texture = -1;
    material.opacity = 0.5f;
  }
  const Sprite sprite = render_all(scene, {128, 128}, exact_options()).sprite;
  int inside = 0;
  for (int y = 1; y < 127; ++y)
    for (int x = 1; x < 127; ++x) {
      ASSERT_LE(sprite.texel(x, y).a, 128);
      const bool interior = sprite.texel(x - 1, y).a > 0 && sprite.texel(x + 1, y).a > 0 &&
                            sprite.texel(x, y - 1).a > 0 && sprite.texel(x, y + 1).a > 0 &&
                            sprite.texel(x, y).a > 100;
      inside += interior && sprite.texel(x, y).a == 128 ? 1 : 0;
    }
  EXPECT_GT(inside, 3000);
}

// Colour that is linear in the world is not linear on the screen; each texel must show the point its ray
// meets.
TEST(Render, AttributesAreInterpolatedInPerspective) {
  const ivec2 size(64, 64);
  FlatScene floor(size);
  floor.add({{4, 60, 1}, {60, 60, 1}, {60, 4, 8}, {4, 4, 8}}, {1, 1, 1});
  layers::Mesh& mesh = floor.mesh();
  for (const vec3& p : mesh.positions) mesh.colors.push_back(vec3(-p.z / 256, (p.x + 256) / 512, 0));
  const vec3 normal =
      glm::cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]);
  const Sprite sprite = floor.render().sprite;
  for (int y = 8; y < 56; y += 3)
    for (int x = 8; x < 56; x += 3) {
      const vec3 ray = floor.point({x + 0.5, y + 0.5, 1});
      const vec3 hit = ray * (glm::dot(normal, mesh.positions[0]) / glm::dot(normal, ray));
      EXPECT_NEAR(sprite.texel(x, y).r, std::sqrt(-hit.z / 256) * 255, 1) << x << " " << y;
      EXPECT_NEAR(sprite.texel(x, y).g, std::sqrt((hit.x + 256) / 512) * 255, 1) << x << " " << y;
    }
}

// Two slanted surfaces that meet at x = 20: the border is a line of depth, not of geometry.
TEST(Render, InterpenetratingSurfacesMeetWhereTheirDepthsDo) {
  FlatScene cross({40, 8});
  // 1/depth is linear on the screen: 1 … 0.5 against 0.5 … 1, equal in the middle.
  cross.add({{0, 0, 1}, {40, 0, 2}, {40, 8, 2}, {0, 8, 1}}, {1, 0, 0});
  cross.add({{0, 0, 2}, {40, 0, 1}, {40, 8, 1}, {0, 8, 2}}, {0, 1, 0});
  const Sprite sprite = cross.render().sprite;
  for (int x = 0; x < 40; ++x) {
    const Texel t = sprite.texel(x, 4);
    EXPECT_EQ(t.r > 0, x <= 19) << x;
    EXPECT_EQ(t.g > 0, x >= 20) << x;
    EXPECT_EQ(t.a, 255) << x;
  }
}

// A true sphere has a closed form for the colour of each ray; Phong on a fine mesh must come close to it.
TEST(Render, PhongSphereMatchesTheRayTracedOne) {
  layers::Scene scene = content::sphere_scene();
  scene.meshes[scene.parts[0].mesh] = content::sphere_mesh(128, 256);
  layers::Material& material = scene.materials[scene.parts[0].material];
  material.texture = -1;
  material.base_color = {1, 1, 1};
  const ivec2 size(96, 96);
  const layers::SceneFrame frame = scene.at(0);
  const Sprite sprite = render_all(scene, size).sprite;
  const dvec3 eye(frame.camera.world_from_camera[3]);
  const double t = std::tan(frame.camera.fov_y_rad / 2);
  const dvec3 center(frame.world_from_node[scene.parts[0].node][3]);
  int compared = 0;
  for (int y = 0; y < 96; y += 3)
    for (int x = 0; x < 96; x += 3) {
      const layers::dvec4 local((x + 0.5 - 48) / 48 * t, (48 - y - 0.5) / 48 * t, -1, 0);
      const dvec3 ray = glm::normalize(dvec3(frame.camera.world_from_camera * local));
      const double b = glm::dot(ray, eye - center), d = b * b - glm::dot(eye - center, eye - center) + 1;
      if (d < 0.05) continue;  // off the sphere, or at its rim where one texel sees all normals
      const dvec3 normal = eye + ray * (-b - std::sqrt(d)) - center;
      double light = 0;
      for (const layers::LightState& l : frame.lights)
        light += l.color.x *
                 (l.kind == layers::Light::Kind::Ambient ? 1 : std::max(0.0, -glm::dot(normal, l.direction)));
      EXPECT_NEAR(sprite.texel(x, y).r, std::sqrt(std::min(1.0, light)) * 255, 2) << x << " " << y;
      ++compared;
    }
  EXPECT_GT(compared, 50);
}

// --- Facing

TEST(Render, BackFacesAreCulledUnlessTwoSided) {
  FlatScene quad({16, 16});
  quad.add({{2, 2}, {14, 2}, {14, 14}, {2, 14}}, {1, 1, 1});  // clockwise on the screen: seen from behind
  EXPECT_GT(covered_texels(quad.render().sprite), 100);
  quad.scene.materials[0].two_sided = false;
  EXPECT_EQ(covered_texels(quad.render().sprite), 0);
  std::swap(quad.mesh().indices[1], quad.mesh().indices[2]);
  std::swap(quad.mesh().indices[4], quad.mesh().indices[5]);
  EXPECT_GT(covered_texels(quad.render().sprite), 100);
}

// A node of negative scale turns its triangles over, and a mirrored sprite turns everything over: fronts stay
// fronts.
TEST(Render, MirrorsDoNotSwapFrontsAndBacks) {
  layers::Scene scene = content::cube_scene();
  const int expected = covered_texels(render_all(scene, {64, 64}).sprite);
  scene.nodes[scene.parts[0].node].local.scale.x *= -1;
  const RenderResult mirrored_node = render_all(scene, {64, 64});
  EXPECT_NEAR(covered_texels(mirrored_node.sprite), expected, 8);
  const auto placement = rotated_placement({64, 64}, 0, 1, true);
  const RenderResult mirrored_sprite = render_all(content::cube_scene(), placement, {64, 64});
  EXPECT_GT(covered_texels(mirrored_sprite.sprite), expected / 2);
  EXPECT_EQ(mirrored_node.counters.polygons_drawn,
            render_all(content::cube_scene(), {64, 64}).counters.polygons_drawn);
}

// The back of a two-sided surface is lit by its own normal: as bright as the front seen under the same light.
TEST(Render, TwoSidedLightingTurnsTheNormal) {
  for (const Shading shading : {Shading::Flat, Shading::Gouraud, Shading::Phong}) {
    RenderOptions options;
    options.shading = shading;
    layers::Scene scene = content::textured_quad_scene();
    scene.materials[scene.parts[0].material].two_sided = true;
    scene.materials[scene.parts[0].material].texture = -1;
    const Texel front = render_all(scene, {33, 33}, options).sprite.texel(16, 16);
    layers::Mesh& mesh = scene.meshes[scene.parts[0].mesh];
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    for (vec3& n : mesh.normals) n = -n;
    EXPECT_EQ(render_all(scene, {33, 33}, options).sprite.texel(16, 16), front) << static_cast<int>(shading);
    EXPECT_GT(front.r, 60);
  }
}

}  // namespace
}  // namespace talisman::chunker::tests
