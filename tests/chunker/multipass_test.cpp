// SPDX-License-Identifier: Apache-2.0
// Factored against unfactored [LS97 appendix]: the error must be the predicted one, and nothing else.
#include <iostream>

#include "tests/chunker/shade_support.h"

namespace talisman::chunker::tests {
namespace {

LinearColor over(const LinearColor& a, const LinearColor& b) {
  const float t = 1 - a.a;
  return {a.r + b.r * t, a.g + b.g * t, a.b + b.b * t, a.a + b.a * t};
}
float channel(const LinearColor& c, int k) { return k == 0 ? c.r : (k == 1 ? c.g : c.b); }
float channel(const Linear16& c, int k) {
  return static_cast<float>(k == 0 ? c.r : (k == 1 ? c.g : c.b)) / static_cast<float>(kOne);
}

/// One light with a shadow, and a narrow floor, so that shadows fall across its edges.
ShadeScene narrow_stage() {
  ShadeScene shaded;
  shaded.size = {120, 90};
  shaded.scene.lights[ShadeScene::kSun].casts_shadow = false;
  shaded.scene.lights[ShadeScene::kSun].color = vec3(0);
  shaded.scene.nodes[ShadeScene::kFloor].local.scale = {0.35, 0.35, 0.35};
  return shaded;
}

const vec3 kBehind{0.1f, 0.3f, 0.05f};

TEST(Multipass, FactoredErrorIsThePredictedOne) {
  ShadeScene shaded = narrow_stage();
  const LinearImage unfactored = shaded.multipass(shaded.inputs()),
                    base = shaded.linear(shaded.inputs(ShadeTerm::Base)),
                    shadow = shaded.linear(shaded.inputs(ShadeTerm::Shadow, ShadeScene::kSpot)),
                    specular = shaded.linear(shaded.inputs(ShadeTerm::Specular)),
                    reflection = shaded.linear(shaded.inputs(ShadeTerm::Reflection));
  const LinearColor behind{kBehind.x, kBehind.y, kBehind.z, 1};
  float largest = 0, unexplained = 0;
  int elsewhere = 0;
  for (std::size_t i = 0; i < base.texels.size(); ++i) {
    const LinearColor truth = over(unfactored.texels[i], behind);
    LinearColor factored = over(shadow.texels[i], over(base.texels[i], behind));
    factored = over(reflection.texels[i], over(specular.texels[i], factored));
    const LinearColor predicted = predicted_factoring_error(base.texels[i], shadow.texels[i].a, kBehind);
    for (int k = 0; k < 3; ++k) {
      const float error = channel(factored, k) - channel(truth, k);
      unexplained = std::max(unexplained, std::abs(error - channel(predicted, k)));
      largest = std::max(largest, std::abs(error));
      elsewhere += channel(predicted, k) == 0 ? 1 : 0;
    }
  }
  EXPECT_LT(unexplained, 1e-6f);
  EXPECT_GT(largest, 0.005f);  // shadows do fall across edges here, or the test proves nothing
  EXPECT_GT(elsewhere, 1000);
  std::cout << "factored - unfactored: largest " << largest << ", beyond the prediction " << unexplained
            << "\n";
}

// The same with the sprites of four bytes and the compositor as they are.
TEST(Multipass, CompositedSpritesMatchThePredictionWithinTheirRounding) {
  ShadeScene shaded = narrow_stage();
  const Sprite sprites[] = {shaded.render(shaded.inputs(ShadeTerm::Base)).sprite,
                            shaded.render(shaded.inputs(ShadeTerm::Shadow, ShadeScene::kSpot)).sprite,
                            shaded.render(shaded.inputs(ShadeTerm::Specular)).sprite,
                            shaded.render(shaded.inputs(ShadeTerm::Reflection)).sprite};
  std::vector<PlacedSprite> placed;
  for (const Sprite& sprite : sprites) {
    placed.emplace_back();
    placed.back().sprite = &sprite;
  }
  const Frame factored = composite(placed, shaded.size, kBehind).frame;
  const LinearImage unfactored = shaded.multipass(shaded.inputs()),
                    base = shaded.linear(shaded.inputs(ShadeTerm::Base)),
                    shadow = shaded.linear(shaded.inputs(ShadeTerm::Shadow, ShadeScene::kSpot));
  const LinearColor behind{kBehind.x, kBehind.y, kBehind.z, 1};
  float unexplained = 0;
  double squares = 0;
  for (std::size_t i = 0; i < base.texels.size(); ++i) {
    const LinearColor truth = over(unfactored.texels[i], behind);
    const LinearColor predicted = predicted_factoring_error(base.texels[i], shadow.texels[i].a, kBehind);
    for (int k = 0; k < 3; ++k) {
      const float rest =
          channel(factored.pixels[i], k) - std::min(channel(truth, k), 1.0f) - channel(predicted, k);
      unexplained = std::max(unexplained, std::abs(rest));
      squares += static_cast<double>(rest) * rest;
    }
  }
  // Three sprites of square-root bytes, √x / 255 each at most, and three of alpha, 1 / 510 each.
  EXPECT_LT(unexplained, 0.012f);
  std::cout << "composited: beyond the prediction " << unexplained << " at most, "
            << std::sqrt(squares / (3.0 * static_cast<double>(base.texels.size()))) << " rms\n";
}

// In one pass every sample has its own shadow; in several passes means are multiplied. They differ only where
// colour and shadow vary together inside a texel.
TEST(Multipass, DiffersFromOnePassOnlyWhereTexelsAreMixed) {
  ShadeScene shaded = narrow_stage();
  const LinearImage unfactored = shaded.multipass(shaded.inputs(), exact_options()),
                    full = shaded.linear(shaded.inputs(), exact_options());
  std::vector<float> differences;
  for (std::size_t i = 0; i < full.texels.size(); ++i) {
    EXPECT_EQ(full.texels[i].a, unfactored.texels[i].a);
    differences.push_back(std::abs(full.texels[i].g - unfactored.texels[i].g));
  }
  std::sort(differences.begin(), differences.end());
  const auto mixed = differences.end() - std::upper_bound(differences.begin(), differences.end(), 1e-5f);
  EXPECT_LT(mixed, static_cast<std::ptrdiff_t>(differences.size()) / 5);
  EXPECT_LT(differences.back(), 0.2f);
  std::cout << "several passes - one pass: largest " << differences.back() << ", above 1e-5 in " << mixed
            << " of " << differences.size() << " texels\n";
}

TEST(Multipass, MakesOnlyThePassesThatAreCalledFor) {
  ShadeScene shaded = narrow_stage();
  const std::int64_t one = shaded.render({}).counters.polygons_in;
  EXPECT_EQ(shaded.multipass(shaded.inputs()).counters.polygons_in, 5 * one);  // the sun still has a map
  for (layers::Material& material : shaded.scene.materials) {
    material.specular = vec3(0);
    material.reflectivity = 0;
  }
  EXPECT_EQ(shaded.multipass({}).counters.polygons_in, one);
}

TEST(PredictedFactoringError, VanishesWhereItMust) {
  const LinearColor base{0.3f, 0.2f, 0.1f, 0.5f};
  EXPECT_EQ(predicted_factoring_error(base, 0, kBehind).r, 0);
  EXPECT_EQ(predicted_factoring_error({0.3f, 0.2f, 0.1f, 1}, 0.7f, kBehind).r, 0);
  EXPECT_EQ(predicted_factoring_error({}, 0.7f, kBehind).r, 0);
  EXPECT_EQ(predicted_factoring_error(base, 0.5f, {0.6f, 0.4f, 0.2f}).g, 0);
  // β (1-β) (1-s) (B - G) = ½ · ½ · ½ · (0.6 - 0.1), A = (1-s) β = ¼
  EXPECT_NEAR(predicted_factoring_error(base, 0.25f, kBehind).r, 0.0625f, 1e-7f);
}

TEST(EncodeSprite, IsWhatRenderGives) {
  ShadeScene shaded;
  const Difference d =
      difference(encode_sprite(shaded.linear(shaded.inputs())), shaded.render(shaded.inputs()).sprite);
  EXPECT_EQ(d.texels, 0);
}

// --- Mirrors

TEST(MirroredFrame, PointsOfTheMirrorKeepTheirPlaceAndTwiceIsOnce) {
  ShadeScene shaded;
  const layers::SceneFrame frame = shaded.scene.at(0);
  const dvec3 point(0.3, -0.2, 0.1), normal(0.2, 3, -0.4);
  const layers::SceneFrame mirrored = mirrored_frame(frame, point, normal),
                           twice = mirrored_frame(mirrored, point, normal);
  const dvec3 across = glm::normalize(glm::cross(normal, dvec3(1, 0, 0)));
  const glm::dvec4 p(point + across * 0.7, 1);
  const glm::dvec4 a = layers::clip_from_world(frame.camera, shaded.size) * p,
                   b = layers::clip_from_world(mirrored.camera, shaded.size) * p;
  EXPECT_NEAR(a.x / a.w, b.x / b.w, 1e-12);
  EXPECT_NEAR(a.y / a.w, b.y / b.w, 1e-12);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(twice.camera.world_from_camera[column][row], frame.camera.world_from_camera[column][row],
                  1e-12);
}

TEST(MirroredFrame, DegeneratePlanesLeaveTheCamera) {
  const layers::SceneFrame frame = ShadeScene().scene.at(0);
  const double nan = std::nan(""), inf = HUGE_VAL;
  for (const dvec3& normal : {dvec3(0), dvec3(nan, 0, 0), dvec3(inf, 1, 0)})
    EXPECT_EQ(mirrored_frame(frame, dvec3(0), normal).camera, frame.camera);
  EXPECT_EQ(mirrored_frame(frame, dvec3(nan), dvec3(0, 1, 0)).camera, frame.camera);
}

// The mirrored camera sees what the camera would see of a mirrored world: fronts stay fronts.
TEST(MirroredFrame, ShowsTheMirroredWorld) {
  ShadeScene shaded;
  shaded.size = {80, 60};
  for (layers::Material& material : shaded.scene.materials) material.unlit = true;
  ShadeScene world = shaded;
  for (const int node : {ShadeScene::kCube, ShadeScene::kBall}) {
    world.scene.nodes[node].local.translation.y *= -1;
    world.scene.nodes[node].local.scale.y *= -1;
  }
  const std::vector<int> parts{ShadeScene::kCube, ShadeScene::kBall};
  const PreparedScene prepared(shaded.scene), prepared_world(world.scene);
  const auto placement = display_placement(shaded.size);
  const Sprite seen = chunker::render(prepared, mirrored_frame(shaded.scene.at(0), dvec3(0), {0, 1, 0}),
                                      parts, shaded.size, placement)
                          .sprite;
  const Sprite expected =
      chunker::render(prepared_world, world.scene.at(0), parts, shaded.size, placement).sprite;
  EXPECT_GT(covered_texels(seen), 100);
  EXPECT_LE(difference(seen, expected).texels, 5);  // a vertex may snap to the other side of a half
}

// A mirror through the eye is seen edge-on: nothing to reflect, and nothing that is not a number.
TEST(MirroredFrame, PlaneThroughTheEye) {
  ShadeScene shaded;
  const layers::SceneFrame frame = shaded.scene.at(0);
  const dvec3 eye(frame.camera.world_from_camera[3]);
  const layers::SceneFrame mirrored = mirrored_frame(frame, eye, {0, 1, 0});
  EXPECT_NEAR(glm::length(dvec3(mirrored.camera.world_from_camera[3]) - eye), 0, 1e-12);
  const PreparedScene prepared(shaded.scene);
  const RenderResult result = chunker::render(prepared, mirrored, all_parts(shaded.scene), shaded.size,
                                              display_placement(shaded.size));
  EXPECT_EQ(result.sprite.size_px(), shaded.size);
}

// The reflection of the cube appears in the floor before it, where the mirrored cube is seen.
TEST(Reflection, AddsWhatTheMirrorShows) {
  ShadeScene shaded;
  shaded.scene.parts.resize(2);
  const LinearImage with = shaded.linear(shaded.inputs(), exact_options()),
                    term = shaded.linear(shaded.inputs(ShadeTerm::Reflection), exact_options());
  ShadeInputs without = shaded.inputs();
  without.reflections = {};
  const LinearImage plain = shaded.linear(without, exact_options());
  float most = 0;
  for (std::size_t i = 0; i < with.texels.size(); ++i) {
    EXPECT_NEAR(with.texels[i].r, plain.texels[i].r + term.texels[i].r, 1e-6f);
    most = std::max(most, term.texels[i].r);
  }
  EXPECT_GT(most, 0.02f);
}

}  // namespace
}  // namespace talisman::chunker::tests
