// SPDX-License-Identifier: Apache-2.0
// The one plane of the world at which a picture is cut off, and the mirrors for which that is done.
#include <random>

#include <glm/geometric.hpp>

#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

const double kNaNPlane = std::nan("");

LinearImage draw_kept(const layers::Scene& scene, ivec2 size, const std::optional<HalfSpace>& kept,
                      const RenderOptions& options = exact_options()) {
  const PreparedScene prepared(scene);
  ShadeInputs inputs;
  inputs.kept = kept;
  return render_linear(prepared, scene.at(0), all_parts(scene), size, display_placement(size), options,
                       inputs);
}

HalfSpace through(const dvec3& point, const dvec3& normal) { return {normal, glm::dot(normal, point)}; }
HalfSpace other_side(const HalfSpace& h) { return {-h.normal, -h.offset}; }

/// A sheet of cells² · 2 jittered triangles that fills the display and more, at slightly varying depths.
FlatScene sheet(ivec2 size, int cells, float opacity, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  std::vector<FlatScene::Corner> corners;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      corners.push_back({(i + jitter(random)) * 1.6 * size.x / cells - 0.3 * size.x,
                         (j + jitter(random)) * 1.6 * size.y / cells - 0.3 * size.y, 1 + jitter(random) / 9});
  std::vector<std::uint32_t> indices;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (cells + 1) + i), b = a + 1, c = a + cells + 1, d = c + 1;
      indices.insert(indices.end(), {a, b, d, a, d, c});
    }
  FlatScene scene(size);
  scene.add(corners, indices, {1, 1, 1}, opacity);
  return scene;
}

// --- The plane itself

TEST(HalfSpace, RoundingCountsAsOnThePlane) {
  const HalfSpace h = through({1e6, -2e6, 3e5}, glm::normalize(dvec3(0.3, -0.9, 0.2)));
  const dvec3 along = glm::normalize(glm::cross(h.normal, dvec3(1, 0, 0)));
  for (int i = -20; i <= 20; ++i) EXPECT_EQ(h.height(dvec3(1e6, -2e6, 3e5) + along * (i * 1e3)), 0) << i;
  EXPECT_GT(h.height(dvec3(1e6, -2e6, 3e5) + h.normal), 0.9);
  EXPECT_LT(h.height(dvec3(1e6, -2e6, 3e5) - h.normal), -0.9);
}

// --- Watertight

// What is on one side and what is on the other make the whole: every sample once, none twice, also along the
// cut.
TEST(KeptHalfSpace, TwoSidesMakeTheWhole) {
  const ivec2 size(70, 50);
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const FlatScene scene = sheet(size, 2 + static_cast<int>(seed), 1, seed);
    const HalfSpace kept =
        through({unit(random) * 9, unit(random) * 9, -25}, {unit(random), unit(random), unit(random)});
    const LinearImage one = draw_kept(scene.scene, size, kept),
                      two = draw_kept(scene.scene, size, other_side(kept));
    int cut = 0;
    for (std::size_t i = 0; i < one.texels.size(); ++i) {
      ASSERT_EQ(one.texels[i].a + two.texels[i].a, 1) << "seed " << seed << " texel " << i;
      cut += one.texels[i].a > 0 && two.texels[i].a > 0 ? 1 : 0;
    }
    EXPECT_GT(cut, 5) << seed;
  }
}

// A translucent sheet shows every crack and every sample that is covered twice.
TEST(KeptHalfSpace, TranslucentSheetHasNoSeams) {
  const ivec2 size(64, 48);
  const FlatScene scene = sheet(size, 9, 0.5f, 3);
  const dvec3 normal(0.4, 1, 0);  // not along the view: the eye lies in the plane, the cut is a straight line
  const LinearImage image = draw_kept(scene.scene, size, through({0, 0, 0}, normal));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const dvec2 p(x + 0.5 - size.x * 0.5, size.y * 0.5 - y - 0.5);
      const double above = (normal.x * p.x + normal.y * p.y) / std::hypot(normal.x, normal.y);
      const float a = image.at(x, y).a, steps = a * 32;
      if (std::abs(above) > 1) {
        ASSERT_EQ(a, above > 0 ? 0.5f : 0.0f) << x << " " << y;
      }
      ASSERT_EQ(steps, std::round(steps)) << x << " " << y;  // sixteenths of a half
    }
}

// --- Against a ray

/// Does the ray through the centre of a pixel meet the unit sphere's kept part, from outside or from inside?
bool ray_meets(ivec2 size, int x, int y, const dvec3& centre, const HalfSpace& kept) {
  const dvec3 d = glm::normalize(dvec3(x + 0.5 - size.x * 0.5, size.y * 0.5 - y - 0.5, -size.y * 0.5));
  const double along = glm::dot(d, centre), inside = 1 - glm::dot(centre, centre) + along * along;
  if (inside < 0) return false;
  for (const double t : {along - std::sqrt(inside), along + std::sqrt(inside)})
    if (t > 0 && kept.height(d * t) >= 0) return true;
  return false;
}

TEST(KeptHalfSpace, SphereMatchesTheRayTracedOne) {
  const ivec2 size(120, 90);
  const dvec3 centre(0.2, -0.1, -2.2);
  FlatScene flat(size);
  flat.add({{0, 0}, {1, 0}, {0, 1}}, {1, 1, 1});
  flat.scene.meshes[0] = talisman::tests::sphere_mesh(96, 192, 1);
  flat.scene.nodes[0].local.translation = centre;
  for (const dvec3& normal : {dvec3(0, 1, 0), dvec3(0.3, 0.5, -0.8), dvec3(-1, 0.2, 0.4)}) {
    const HalfSpace kept = through(centre + dvec3(0.1, 0.05, 0), normal);
    const LinearImage image = draw_kept(flat.scene, size, kept);
    int differing = 0, covered = 0, mixed = 0;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const bool expected = ray_meets(size, x, y, centre, kept);
        covered += expected ? 1 : 0;
        // On an outline a centre is not the mean of sixteen samples; elsewhere it is.
        const bool whole = image.at(x, y).a == 0 || image.at(x, y).a == 1;
        differing += whole && (image.at(x, y).a == 1) != expected ? 1 : 0;
        mixed += whole ? 0 : 1;
      }
    EXPECT_GT(covered, 700);
    EXPECT_LT(mixed, 300);
    EXPECT_EQ(differing, 0) << normal.x;
  }
}

TEST(KeptHalfSpace, EqualsTheReferenceInEveryTermAndShading) {
  ShadeScene shaded;
  const HalfSpace kept = through({-0.4, 0.9, 0}, {0.4, 1, 0.3});  // through the cube's centre
  for (const ShadeTerm term : {ShadeTerm::Full, ShadeTerm::Shadow, ShadeTerm::Specular})
    for (const Shading shading : {Shading::Flat, Shading::Phong}) {
      RenderOptions options = exact_options();
      options.shading = shading;
      ShadeInputs inputs = shaded.inputs(term);
      const Sprite whole = shaded.render(inputs, options).sprite;
      inputs.kept = kept;
      const Sprite cut = shaded.render(inputs, options).sprite;
      expect_same(cut, shaded.reference(inputs, options), name_of(term));
      EXPECT_GT(difference(cut, whole).texels, 20);
    }
}

// --- At no cost, and on hard planes

// None asked for, one that is none, and one that cuts nothing: the same picture and the same work.
TEST(KeptHalfSpace, PlanesThatCutNothingChangeNothing) {
  ShadeScene shaded;
  const RenderResult whole = shaded.render(shaded.inputs());
  for (const HalfSpace& none :
       {HalfSpace{{0, 0, 0}, 1}, HalfSpace{{kNaNPlane, 0, 1}, 0}, HalfSpace{{0, 1, 0}, kNaNPlane},
        HalfSpace{{HUGE_VAL, 1, 0}, 0}, HalfSpace{{0, 1, 0}, -1e6}}) {
    ShadeInputs inputs = shaded.inputs();
    inputs.kept = none;
    const RenderResult same = shaded.render(inputs);
    expect_same(same.sprite, whole.sprite, std::to_string(none.offset));
    EXPECT_EQ(same.counters, whole.counters);
  }
}

TEST(KeptHalfSpace, WhollyBehindCostsNoTriangle) {
  ShadeScene shaded;
  ShadeInputs inputs = shaded.inputs();
  inputs.kept = HalfSpace{{0, 1, 0}, 1e3};
  const RenderResult nothing = shaded.render(inputs);
  EXPECT_EQ(nothing.counters.polygons_drawn, 0);
  EXPECT_EQ(nothing.sprite.stored_chunks(), 0);
}

// A surface that lies in the plane stays whole on both sides of it, however the world is turned and however
// far away it is: rounding must not tear holes.
TEST(KeptHalfSpace, CoplanarSurfaceStaysWhole) {
  const ivec2 size(40, 30);
  std::mt19937 random(23);
  std::normal_distribution<double> normal(0, 1);
  for (const double far : {0.0, 1e4, 1e6})
    for (int n = 0; n < 15; ++n) {
      layers::Scene scene = talisman::tests::textured_quad_scene();
      scene.meshes[scene.parts[0].mesh] = talisman::tests::quad_mesh(2, 7);
      for (layers::Material& material : scene.materials) material.two_sided = true;
      layers::Node turn;
      turn.local.rotation =
          glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
      turn.local.translation = far * dvec3(normal(random), normal(random), normal(random));
      for (layers::Node& node : scene.nodes) node.parent = node.parent < 0 ? 0 : node.parent + 1;
      scene.nodes.insert(scene.nodes.begin(), turn);  // above everything, the camera included
      ++scene.parts[0].node;
      ++scene.cameras[0].node;
      const auto world = scene.at(0).world_from_node[scene.parts[0].node];
      const HalfSpace plane = through(dvec3(world[3]), dvec3(world[2]));
      const LinearImage whole = draw_kept(scene, size, std::nullopt);
      for (const HalfSpace& side : {plane, other_side(plane)}) {
        const LinearImage same = draw_kept(scene, size, side);
        ASSERT_EQ(same.counters, whole.counters) << far << " " << n;
        for (std::size_t i = 0; i < whole.texels.size(); ++i)
          ASSERT_EQ(same.texels[i].a, whole.texels[i].a) << far << " " << n;
      }
    }
}

// Touching: corners and edges on the plane, everything else behind it. What is left has no area.
TEST(KeptHalfSpace, TouchingFromBehindShowsNothing) {
  layers::Scene scene = talisman::tests::cube_scene();  // its centre at the node's place, 1 m
  const dvec3 centre(scene.at(0).world_from_node[scene.parts[0].node][3]);
  for (const dvec3& outwards : {dvec3(0, 1, 1), dvec3(1, 1, 1)}) {  // at an edge, at a corner
    const dvec3 corner = centre + 0.5 * glm::sign(outwards);
    const LinearImage image = draw_kept(scene, {64, 48}, through(corner, outwards));
    for (const LinearColor& c : image.texels) ASSERT_EQ(c.a, 0);
  }
}

// The plane through the eye is a line on the display, and the near plane cuts across it.
TEST(KeptHalfSpace, PlaneThroughTheEyeIsALine) {
  const ivec2 size(64, 48);
  FlatScene flat(size);
  flat.add({{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {1, 1, 1});
  const float far = 1e5f;
  flat.mesh().positions = {{-far, -1, far}, {far, -1, far}, {far, -1, -far}, {-far, -1, -far}};
  const LinearImage image = draw_kept(flat.scene, size, HalfSpace{{1, 0, 0}, 0});
  for (int y = 26; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) ASSERT_EQ(image.at(x, y).a, x < 32 ? 0 : 1) << x << " " << y;
}

// --- Mirrors

/// A cube that reaches through the mirror y = 0.
ShadeScene sunken_stage() {
  ShadeScene shaded;
  shaded.size = {80, 60};
  shaded.scene.nodes[ShadeScene::kCube].local.translation.y = 0.1;
  for (layers::Material& material : shaded.scene.materials) material.unlit = true;
  return shaded;
}

Sprite draw_cube(const layers::Scene& scene, const layers::SceneFrame& frame, ivec2 size,
                 const std::optional<HalfSpace>& kept) {
  const PreparedScene prepared(scene);
  ShadeInputs inputs;
  inputs.kept = kept;
  return chunker::render(prepared, frame, std::vector<int>{ShadeScene::kCube}, size, display_placement(size),
                         exact_options(), inputs)
      .sprite;
}

// The oracle turns the world over instead of the camera, and cuts it there.
TEST(BeforeMirror, CutsOffWhatIsBehindTheMirror) {
  ShadeScene shaded = sunken_stage(), world = sunken_stage();
  world.scene.nodes[ShadeScene::kCube].local.translation.y *= -1;
  world.scene.nodes[ShadeScene::kCube].local.scale.y *= -1;
  const layers::SceneFrame frame = shaded.scene.at(0), mirrored = mirrored_frame(frame, dvec3(0), {0, 1, 0});
  const auto kept = before_mirror(frame, dvec3(0), {0, 1, 0});
  const Sprite seen = draw_cube(shaded.scene, mirrored, shaded.size, kept),
               expected = draw_cube(world.scene, world.scene.at(0), shaded.size, HalfSpace{{0, -1, 0}, 0}),
               uncut = draw_cube(shaded.scene, mirrored, shaded.size, std::nullopt);
  EXPECT_LE(difference(seen, expected).texels, 5);  // a vertex may snap to the other side of a half
  EXPECT_GT(covered_texels(seen), 100);
  EXPECT_GT(covered_texels(uncut), covered_texels(seen) + 50);
}

TEST(BeforeMirror, IsTheEyesSideWhicheverThatIs) {
  ShadeScene shaded;
  const dvec3 above(0, 5, 0), below(0, -5, 0);
  for (const double height : {2.5, -2.5}) {
    shaded.scene.nodes[3].local.translation.y = height;
    for (const dvec3& normal : {dvec3(0, 2, 0), dvec3(0, -3, 0)}) {
      const auto kept = before_mirror(shaded.scene.at(0), dvec3(0), normal);
      ASSERT_TRUE(kept);
      EXPECT_EQ(kept->height(above) > 0, height > 0) << normal.y;
      EXPECT_EQ(kept->height(below) > 0, height < 0) << normal.y;
    }
  }
  // In the plane itself either side would do.
  shaded.scene.nodes[3].local.translation.y = 0;
  EXPECT_EQ(before_mirror(shaded.scene.at(0), dvec3(0), {0, 1, 0})->height(above), 5);
}

TEST(BeforeMirror, DegeneratePlanesCutNothing) {
  const layers::SceneFrame frame = ShadeScene().scene.at(0);
  for (const dvec3& normal : {dvec3(0), dvec3(kNaNPlane, 0, 0), dvec3(HUGE_VAL, 1, 0)})
    EXPECT_FALSE(before_mirror(frame, dvec3(0), normal));
  EXPECT_FALSE(before_mirror(frame, dvec3(kNaNPlane), {0, 1, 0}));
}

// --- Several mirrors in one pass

// Each part looks up the picture that names it: in one pass as in a pass for each.
TEST(Reflections, EachPartLooksUpItsOwn) {
  ShadeScene shaded;
  shaded.scene.materials[ShadeScene::kCube].reflectivity = 0.5f;
  const Sprite red = [] {
    Sprite sprite({45, 37});
    Chunk chunk;
    for (Texel& t : chunk.texels) t = {255, 0, 0, 255};
    sprite.store(0, 0, chunk);
    return sprite;
  }();
  const ShadeInputs one = shaded.inputs(ShadeTerm::Reflection);
  const std::vector<int> floor{ShadeScene::kFloor}, cube{ShadeScene::kCube};
  const Reflection of_floor{one.reflections[0].picture, {}, floor}, of_cube{&red, {}, cube};
  const auto draw = [&](std::vector<Reflection> reflections) {
    ShadeInputs inputs = one;
    inputs.reflections = reflections;
    LinearImage image = shaded.linear(inputs, exact_options());
    expect_same(shaded.render(inputs, exact_options()).sprite, shaded.reference(inputs, exact_options()),
                std::to_string(reflections.size()));
    return image;
  };
  const LinearImage both = draw({of_floor, of_cube}), first = draw({of_floor}), second = draw({of_cube});
  float most_first = 0, most_second = 0;
  for (std::size_t i = 0; i < both.texels.size(); ++i) {
    ASSERT_NEAR(both.texels[i].r, first.texels[i].r + second.texels[i].r, 1e-6f) << i;
    ASSERT_NEAR(both.texels[i].g, first.texels[i].g + second.texels[i].g, 1e-6f) << i;
    most_first = std::max(most_first, first.texels[i].g);
    most_second = std::max(most_second, second.texels[i].r);
  }
  EXPECT_GT(most_first, 0.02f);
  EXPECT_GT(most_second, 0.2f);
}

// --- Blends of some parts

TEST(TextureBlends, StandInForTheMaterials) {
  ShadeScene shaded, authored;
  for (ShadeScene* s : {&shaded, &authored}) s->scene.materials[ShadeScene::kFloor].texture2 = 1;
  authored.scene.materials[ShadeScene::kFloor].texture_blend = {0.25f, 0.75f};
  const std::vector<int> floor{ShadeScene::kFloor}, cube{ShadeScene::kCube};
  const TextureBlend of_floor{{0.25f, 0.75f}, floor}, of_cube{{0, 1}, cube};
  for (const ShadeTerm term : {ShadeTerm::Full, ShadeTerm::Base}) {
    ShadeInputs inputs = shaded.inputs(term);
    const Sprite plain = shaded.render(inputs).sprite;
    const std::vector<TextureBlend> blends{of_cube, of_floor};
    inputs.texture_blends = blends;
    const Sprite blended = shaded.render(inputs).sprite;
    expect_same(blended, authored.render(authored.inputs(term)).sprite, name_of(term));
    EXPECT_GT(difference(blended, plain).texels, 100);
  }
}

}  // namespace
}  // namespace talisman::chunker::tests
