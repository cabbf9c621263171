// SPDX-License-Identifier: Apache-2.0
// Shadow maps: the shadow of a level square on a level floor is a level square, of a sun as large as the caster, of a lamp as
// much larger as it is farther away; worked out in long double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "chunker/shadow_map.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/hard/scenes.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using layers::Light;
using layers::Scene;
using layers::vec3;

constexpr int kMapResolution_px = 512;
/// Half of the filter, the texel in which the edge lies, the sample at which it is taken.
constexpr double kFilterReach_texels = 3;

/// A square of `side`, `height` above the floor; all lengths times `scale`, all of it at `origin` (in metres).
struct SquareOverFloor {
  Light light;  ///< unscaled, relative to `origin`
  double side = 2, height = 1, scale = 1;
  dvec3 origin{0, 0, 0};
  bool roof = false;  ///< also a caster above the light, so that the light is among its casters
  double texel = 0;   ///< side of a texel on the floor, unscaled, along the axis on which it is longest

  Scene scene() const {
    Scene scene = hard_view();
    add_hard_part(scene, level_square(side * scale), hard_material(vec3(1)),
                  origin + dvec3(0, height, 0) * scale);
    if (roof)
      add_hard_part(scene, level_square(side * scale), hard_material(vec3(1)),
                    origin + dvec3(0, 9, 0) * scale);
    scene.lights = {light};
    scene.lights[0].position = origin + light.position * scale;
    scene.lights[0].attenuation = {1, 0, 0};
    scene.lights[0].casts_shadow = true;
    scene.lights[0].shadow.resolution_px = kMapResolution_px;
    return scene;
  }
  struct Shadow {
    Exact x, z, half;
  };
  Shadow shadow() const {
    if (light.kind == Light::Kind::Directional)
      return {-Exact(light.direction.x) / light.direction.y * height,
              -Exact(light.direction.z) / light.direction.y * height, Exact(side) / 2};
    const Exact grown = Exact(light.position.y) / (Exact(light.position.y) - height);
    return {light.position.x * (1 - grown), light.position.z * (1 - grown), Exact(side) / 2 * grown};
  }
};

/// How far a point of the floor lies from the shadow's edge, texels of the map, where it is not what it should be: wholly
/// lit or wholly dark. Points within a few times the shadow.
HardOutcome edge_of_shadow(const SquareOverFloor& square) {
  const Scene scene = square.scene();
  std::vector<int> casters(scene.parts.size());
  std::iota(casters.begin(), casters.end(), 0);
  const chunker::ShadowMap map = chunker::make_shadow_map(scene.at(0), 0, casters);
  const SquareOverFloor::Shadow shadow = square.shadow();
  Random random(12);
  Exact worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const dvec2 at = random.in_square(2);
    const Exact x = Exact(at.x) * shadow.half, z = Exact(at.y) * shadow.half;
    const Exact beyond = std::max(std::fabs(x), std::fabs(z)) - shadow.half;  // > 0: lit
    const dvec3 floor{double(shadow.x + x), 0, double(shadow.z + z)};
    const float seen = map.visibility(square.origin + floor * square.scale);
    if (seen != (beyond > 0 ? 1 : 0)) worst = worse(worst, std::fabs(beyond) / square.texel);
  }
  return {double(worst), map.empty()};
}

/// A sun `elevation_rad` above the horizon: texels are as large as the square allows, and longer on the floor.
SquareOverFloor under_sun(double elevation_rad) {
  SquareOverFloor square;
  square.light.direction = {std::cos(elevation_rad), -std::sin(elevation_rad), 0};
  square.texel = square.side * 1.2 / kMapResolution_px / std::sin(elevation_rad);
  return square;
}

SquareOverFloor under_lamp(Light::Kind kind, dvec3 position, double tan_half) {
  SquareOverFloor square;
  square.light.kind = kind;
  square.light.position = position;
  square.light.outer_cone_rad = std::atan(tan_half);
  square.texel = 2 * tan_half * position.y / kMapResolution_px;
  return square;
}

void add_edges(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, const SquareOverFloor& square) {
    cases.push_back({HardStage::Shadow,
                     name,
                     special,
                     extreme,
                     {kFilterReach_texels, "texels of the map", "rays, long double"},
                     [square] { return edge_of_shadow(square); }});
  };
  const double overhead = std::acos(0.0);
  add("sun overhead", "the map looks straight down", 1, under_sun(overhead));
  add("sun at 5 degrees", "texels 11 times as long on the floor", 11, under_sun(0.0873));
  add("sun at 0.1 degrees", "texels 570 times as long on the floor", 570, under_sun(0.001745));
  for (const auto& [scale, text] :
       {std::pair{1e-6, "sun, 1e-6 m"}, {1e6, "sun, 1e6 m"}, {1e9, "sun, 1e9 m"}}) {
    SquareOverFloor square = under_sun(0.8);
    square.scale = scale;
    add(text, "the same world in other units", scale, square);
  }
  SquareOverFloor distant = under_sun(0.8);
  distant.origin = {1e6, 0, -1e6};
  add("2 m at 1e6 m", "a square far from the world's origin", 1e6, distant);
  SquareOverFloor high = under_sun(0.8);
  high.height = 1e4;
  add("1e4 m above the floor", "a shadow 1e4 m away from what casts it", 1e4, high);
  add("lamp", "one face of a perspective", 1, under_lamp(Light::Kind::Point, {0.3, 3, 0.2}, 0.8));
  SquareOverFloor low = under_lamp(Light::Kind::Point, {0.1, 1.1, 0.2}, 1);
  low.texel = 12.1 * 12.1 / 1.1 * 2 /
              kMapResolution_px;  // on the faces to the sides the floor runs into the distance
  add("lamp 0.1 m above", "a shadow 11 times as large, on six faces", 11, low);
  SquareOverFloor inside = under_lamp(Light::Kind::Point, {0.3, 3, 0.2}, 1);
  inside.roof = true;
  add("lamp among its casters", "six faces", 1, inside);
  add("spot", "one face as wide as its cone", 1, under_lamp(Light::Kind::Spot, {0.3, 3, 0.2}, 1.2));
}

// --- What is lit

/// The floor casts on itself: the share of its points that the sun sees and the map says it does not.
HardOutcome lit_by_itself(double elevation_rad, double scale) {
  Scene scene = hard_view();
  add_hard_part(scene, level_square(10 * scale), hard_material(vec3(1)));
  scene.lights = {under_sun(elevation_rad).light};
  scene.lights[0].shadow.resolution_px = kMapResolution_px;
  scene.lights[0].casts_shadow = true;
  const std::vector<int> casters{0};
  const chunker::ShadowMap map = chunker::make_shadow_map(scene.at(0), 0, casters);
  Random random(13);
  double dark = 0;
  for (int n = 0; n < 20000; ++n) {
    const dvec2 at = random.in_square(4.99 * scale);
    dark += map.visibility({at.x, 0, at.y}) < 1;
  }
  return {dark / 20000, map.empty()};
}

/// A caster on the far side of the lamp, or one that is not a number: what is in the dark and should not be.
HardOutcome lit_without_casters(dvec3 where, bool without_meaning) {
  SquareOverFloor square = under_lamp(Light::Kind::Point, {0, 3, 0}, 1);
  Scene scene = square.scene();
  scene.nodes[0].local.translation = where;
  if (without_meaning)
    for (vec3& p : scene.meshes[0].positions) p.y = std::numeric_limits<float>::quiet_NaN();
  const std::vector<int> casters{0};
  const chunker::ShadowMap map = chunker::make_shadow_map(scene.at(0), 0, casters);
  Random random(14);
  double dark = 0;
  for (int n = 0; n < 20000; ++n) {
    const dvec2 at = random.in_square(20);
    dark += map.visibility({at.x, 0, at.y}) < 1;
  }
  return {dark / 20000, map.empty()};
}

HardOutcome places_without_meaning() {
  const SquareOverFloor square = under_sun(0.8);
  const std::vector<int> casters{0};
  const chunker::ShadowMap map = chunker::make_shadow_map(square.scene().at(0), 0, casters);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  double dark = 0;
  for (const dvec3& p :
       {dvec3(nan, 0, 0), dvec3(inf, 0, 0), dvec3(0, -inf, 0), dvec3(1e300), dvec3(-1e30, 0, 0)})
    dark += map.visibility(p) < 1;
  return {dark, false};
}

/// Two lamps of other hues, both hidden by one square, over a surface with ambient light: the umbra of both shows the
/// ambient light alone. Off by how much, in white.
HardOutcome umbra_of_two_hues(float brightness) {
  Scene scene = hard_view();
  const vec3 ground{0.5f, 0.6f, 0.7f};
  add_hard_part(scene, filling_triangle(4), hard_material(ground));
  layers::Mesh square = level_square(2);
  add_hard_part(scene, square, hard_material(vec3(0)), {0, 30, -3});  // above the view
  Light ambient, red, blue;
  ambient.kind = Light::Kind::Ambient;
  ambient.color = vec3(0.1f);
  red.color = vec3(1, 0.1f, 0) * brightness;
  blue.color = vec3(0, 0.1f, 1) * brightness;
  red.direction = {0.001, -30, -1};  // both throw the square's shadow from there into the middle of the view
  blue.direction = {-0.001, -30, -1};
  scene.lights = {ambient, red, blue};
  for (const int light : {1, 2}) scene.lights[light].casts_shadow = true;
  const HardPicture picture = draw_hard(scene, {33, 33});
  const chunker::LinearColor& c = picture.linear.at(16, 16);
  double worst = 0;
  for (const double off : {c.r - 0.05, c.g - 0.06, c.b - 0.07}) worst = worse(worst, std::fabs(off));
  return {worst, false};
}

void add_lit(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, HardRule rule,
                       std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Shadow, name, special, extreme, rule, std::move(measure)});
  };
  const HardRule lit{0, "of the points", "all are lit"};
  add("floor on itself, 5 degrees", "a slanted caster is its own receiver", 11, lit,
      [] { return lit_by_itself(0.0873, 1); });
  add("floor on itself, 1e-6 m", "the same under a lens", 1e-6, lit, [] { return lit_by_itself(0.5, 1e-6); });
  add("caster behind the lamp", "above a lamp that lights what is below", 1, lit, [] {
    return lit_without_casters({0, 50, 0}, false);
  });
  add("caster not a number", "there is nothing to cast", 1, {0, "of the points", "all are lit", true}, [] {
    return lit_without_casters({0, 1, 0}, true);
  });
  add("places without a meaning", "not a number, infinite, 1e300", 1, {0, "places", "documented: lit"},
      places_without_meaning);
  add("umbra of two hues", "red and blue lamps, both hidden", 1, {1e-6, "of white", "ambient light alone"},
      [] { return umbra_of_two_hues(1); });
  add("umbra of two hues, 1e6", "lamps of 1e6", 1e6, {1e-6, "of white", "ambient light alone"},
      [] { return umbra_of_two_hues(1e6f); });
}

}  // namespace

std::vector<HardCase> hard_shadows() {
  std::vector<HardCase> cases;
  add_edges(cases);
  add_lit(cases);
  return cases;
}

}  // namespace talisman::sequences
