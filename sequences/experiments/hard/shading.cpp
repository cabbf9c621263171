// SPDX-License-Identifier: Apache-2.0
// Shading: one surface that fills the display, whose light has a closed form, worked out in long double; and the slow
// renderer.
#include <algorithm>
#include <cmath>
#include <functional>

#include "layers/point_shading.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/hard/scenes.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using layers::Light;
using layers::Scene;
using layers::vec3;

constexpr int kShadedSide_px = 65;  // odd: one texel is the very middle

struct ExactVector {
  Exact x = 0, y = 0, z = 0;
  ExactVector operator-(const ExactVector& o) const { return {x - o.x, y - o.y, z - o.z}; }
  ExactVector operator+(const ExactVector& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Exact dot(const ExactVector& o) const { return x * o.x + y * o.y + z * o.z; }
  Exact length() const { return std::sqrt(dot(*this)); }
  ExactVector unit() const { return {x / length(), y / length(), z / length()}; }
};

ExactVector exact_vector(dvec3 v) { return {v.x, v.y, v.z}; }

/// A light on a surface that fills the display, `depth` before the eye.
struct LitSurface {
  Light light;
  double depth = 1, fov_rad = std::acos(0.0);
  vec3 base{1, 1, 1}, specular{0, 0, 0};
  float shininess = 0;

  Scene scene() const {
    Scene scene = hard_view(fov_rad, depth * 0.01);
    layers::Material material = hard_material(base);
    material.specular = specular;
    material.shininess = shininess;
    add_hard_part(scene, filling_triangle(depth), material);
    scene.lights = {light};
    return scene;
  }
  ExactVector place(int x, int y) const {
    const Exact tan_half = std::tan(Exact(fov_rad) / 2);
    return {(x + Exact(0.5) - kShadedSide_px / Exact(2)) / (kShadedSide_px / Exact(2)) * tan_half * depth,
            (kShadedSide_px / Exact(2) - y - Exact(0.5)) / (kShadedSide_px / Exact(2)) * tan_half * depth,
            -Exact(depth)};
  }
  /// Red of the formulas of chunker/shade.h.
  Exact right(int px, int py) const {
    const ExactVector p = place(px, py);
    const bool far = light.kind == Light::Kind::Directional;
    const ExactVector offset = exact_vector(light.position) - p;
    const ExactVector to_light = far ? (ExactVector{} - exact_vector(light.direction)).unit() : offset.unit();
    const Exact nl = to_light.z;
    if (nl <= 0) return 0;
    Exact color = light.color.x;
    if (!far) {
      const Exact d = offset.length();
      color /= light.attenuation.x + light.attenuation.y * d + light.attenuation.z * d * d;
    }
    if (light.kind == Light::Kind::Spot) color *= cone(to_light);
    const ExactVector half = (to_light + (ExactVector{} - p).unit()).unit();
    const Exact highlight = specular.x > 0 ? specular.x * std::pow(half.z, Exact(shininess)) : 0;
    return color * (base.x * nl + highlight);
  }
  /// By the half angle, since the cosine of a small one is all 1.
  Exact cone(const ExactVector& to_light) const {
    const ExactVector axis = exact_vector(light.direction).unit(), off = axis + to_light;
    const auto versine = [](Exact angle) { return 2 * std::sin(angle / 2) * std::sin(angle / 2); };
    const Exact outer = versine(light.outer_cone_rad), inner = versine(light.inner_cone_rad);
    const Exact here = off.dot(off) / 2;
    if (outer == inner) return here <= inner ? 1 : 0;
    const Exact t = std::clamp((outer - here) / (outer - inner), Exact(0), Exact(1));
    return t * t * (3 - 2 * t);
  }
};

/// Largest error over all texels, relative to the texel itself (`of_each`) or to the brightest.
HardOutcome against_closed_form(const LitSurface& lit, bool of_each) {
  const HardPicture picture = draw_hard(lit.scene(), {kShadedSide_px, kShadedSide_px}, unmerged());
  Exact worst = 0, brightest = 0;
  for (int y = 0; y < kShadedSide_px; ++y)
    for (int x = 0; x < kShadedSide_px; ++x) {
      const Exact right = lit.right(x, y), got = picture.linear.at(x, y).r;
      if (!std::isfinite(got)) return {HUGE_VAL, false};
      brightest = std::max(brightest, right);
      worst = worse(worst, std::fabs(got - right) / (of_each && right > 0 ? right : Exact(1)));
    }
  return {double(of_each || brightest == 0 ? worst : worst / brightest), false};
}

Light sun_along(dvec3 direction, float color = 1) {
  Light light;
  light.direction = direction;
  light.color = vec3(color);
  return light;
}

Light local_light(Light::Kind kind, dvec3 position, dvec3 attenuation = {1, 0, 0}) {
  Light light;
  light.kind = kind;
  light.position = position;
  light.direction = {0, 0, -1};
  light.attenuation = attenuation;
  return light;
}

Light spot_of(double inner_rad, double outer_rad) {
  Light light = local_light(Light::Kind::Spot, {0, 0, 0});
  light.inner_cone_rad = inner_rad;
  light.outer_cone_rad = outer_rad;
  return light;
}

LitSurface lit_by(const Light& light) {
  LitSurface lit;
  lit.light = light;
  return lit;
}

void add_lights(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, double most,
                       const LitSurface& lit, bool of_each = true) {
    cases.push_back({HardStage::Shading,
                     name,
                     special,
                     extreme,
                     {most, of_each ? "of the texel" : "of the brightest", "closed form, long double"},
                     [lit, of_each] { return against_closed_form(lit, of_each); }});
  };
  add("grazing 1e-3", "a sun 1e-3 rad above the surface", 1e3, 1e-5, lit_by(sun_along({1, 0, -1e-3})));
  add("grazing 1e-9", "a sun 1e-9 rad above the surface", 1e9, 1e-5, lit_by(sun_along({1, 0, -1e-9})));
  add("tangent", "a sun in the surface: exactly black", 1, 0, lit_by(sun_along({1, 0, 0})));
  add("brightness 1e-20", "a light of 1e-20", 1e-20, 1e-5, lit_by(sun_along({0.3, 0, -1}, 1e-20f)));
  add("brightness 1e20", "a light of 1e20", 1e20, 1e-5, lit_by(sun_along({0.3, 0, -1}, 1e20f)));
  add("lamp at 1e-2 m", "1/d2 of 1e4, 1e-2 m above a surface", 1e4, 1e-3,
      lit_by(local_light(Light::Kind::Point, {0, 0, -0.99}, {0, 0, 1})));
  add("lamp at 1e12 m", "as far as a sun", 1e12, 1e-5,
      lit_by(local_light(Light::Kind::Point, {1e11, 0, 1e12})));
  LitSurface far = lit_by(local_light(Light::Kind::Point, {2e6, 1e6, 0}, {0, 0, 1}));
  far.depth = 1048576;
  add("1e6 m, 1/d2", "a surface and a lamp in 1e6 m", 1e6, 1e-5, far);
  add("spot with a hard edge", "inner = outer", 1, 1e-6, lit_by(spot_of(0.3, 0.3)), false);
  for (const double cone : {1e-2, 1e-3}) {
    LitSurface narrow = lit_by(spot_of(cone, 2 * cone));
    narrow.fov_rad = 5 * cone;
    // Three cosines near 1 are rounded to 2^-24 each; their differences are 1.5 cone², and the step is 1.5 steep.
    const double most = 1.5 * 3 * 0x1p-24 / (1.5 * cone * cone);
    add(cone > 5e-3 ? "spot of 1e-2 rad" : "spot of 1e-3 rad", "cosines that differ in few digits", 1 / cone,
        most, narrow, false);
  }
  for (const auto& [exponent, text] :
       {std::pair{1e-3f, "exponent 1e-3"}, {50.0f, "exponent 50"}, {1e4f, "exponent 1e4"}}) {
    LitSurface shiny = lit_by(sun_along({0, 0, -1}));
    shiny.base = vec3(0);
    shiny.specular = vec3(0.5f);
    shiny.shininess = exponent;
    add(text, "a highlight from no lobe to a pixel", exponent, 5e-3, shiny, false);
  }
}

// --- What is seen

/// A surface behind another that is drawn first, `gap` of its depth apart: the share of texels that show it.
HardOutcome wrong_in_front(double depth, double gap) {
  Scene scene = hard_view(std::acos(0.0), depth * 1e-3);
  for (const bool behind : {true, false}) {
    layers::Material material = hard_material(behind ? vec3(1, 0, 0) : vec3(0, 1, 0));
    material.unlit = true;
    add_hard_part(scene, filling_triangle(depth), material, {0, 0, behind ? -depth * gap : 0});
  }
  const HardPicture picture = draw_hard(scene, {kShadedSide_px, kShadedSide_px});
  double wrong = 0;
  for (const chunker::LinearColor& c : picture.linear.texels) wrong += c.g != 1 || c.r != 0;
  return {wrong / (kShadedSide_px * kShadedSide_px), false};
}

/// Many half-transparent sheets that cross one another, in fragment memory that is far too small.
HardOutcome crossing_sheets(int count, int fragments) {
  Scene scene = hard_view();
  Random random(8);
  for (int i = 0; i < count; ++i) {
    layers::Material material =
        hard_material({float(random.uniform(0, 1)), 0.5f, float(random.uniform(0, 1))});
    material.opacity = float(random.uniform(0.05, 0.9));
    material.two_sided = material.unlit = true;
    const int part = add_hard_part(scene, level_square(4), material,
                                   {random.uniform(-1, 1), 0, -2 - random.uniform(0, 1)});
    scene.nodes[scene.parts[part].node].local.rotation =
        glm::angleAxis(random.uniform(0, 6), dvec3(0.6, 0.0, 0.8));
  }
  chunker::RenderOptions options = unmerged();
  options.max_fragments_per_chunk = fragments;
  const HardPicture picture = draw_hard(scene, {48, 48}, options, true);
  return {double(largest_code_difference(picture.sprite, picture.reference)), false};
}

HardOutcome world_against_reference(double t_s) {
  const HardPicture picture = draw_hard(hard_world(), {96, 72}, unmerged(), true, t_s);
  return {double(largest_code_difference(picture.sprite, picture.reference)), false};
}

/// A texture with `repeats` repetitions over the display: each texel must show the mean of it.
HardOutcome minified(double repeats) {
  Scene scene = hard_world();
  Scene flat = hard_view();
  flat.textures = scene.textures;
  layers::Material material = hard_material(vec3(1));
  material.unlit = true;
  material.texture = 0;
  add_hard_part(flat, filling_triangle(1, repeats), material);
  const HardPicture picture = draw_hard(flat, {kShadedSide_px, kShadedSide_px});
  const auto linear = [](double srgb) { return std::pow((srgb / 255 + 0.055) / 1.055, 2.4); };
  const double mean = (linear(230) + linear(60)) / 2;
  double worst = 0;
  for (const chunker::LinearColor& c : picture.linear.texels) worst = worse(worst, std::fabs(c.r - mean));
  return {worst, false};
}

/// Opacity as alpha and as a factor of the colour.
HardOutcome faint(float opacity) {
  Scene scene = hard_view();
  layers::Material material = hard_material({1, 0.5f, 0.25f});
  material.unlit = true;
  material.opacity = opacity;
  add_hard_part(scene, filling_triangle(1), material);
  const HardPicture picture = draw_hard(scene, {kShadedSide_px, kShadedSide_px});
  double worst = 0;
  for (const chunker::LinearColor& c : picture.linear.texels)
    for (const double off : {c.a - opacity, c.r - opacity, c.b - opacity / 4})
      worst = worse(worst, std::fabs(off));
  return {worst / opacity, false};
}

/// The decision side shades points by the same formulas: 200 points under lights of all kinds.
HardOutcome decision_side() {
  Random random(9);
  Exact worst = 0;
  for (int n = 0; n < 200; ++n) {
    LitSurface lit =
        lit_by(sun_along({random.uniform(-1, 1), random.uniform(-1, 1), -random.log_uniform(1e-6, 1)}));
    if (n % 2 == 1)
      lit.light =
          local_light(Light::Kind::Point, {random.uniform(-9, 9), 1, random.uniform(-0.9, 9)}, {1, 0, 0.3});
    lit.specular = vec3(0.25f);
    lit.base = vec3(0.5f);
    lit.shininess = float(random.log_uniform(1e-3, 1e4));
    layers::MeanSurface surface;
    surface.base = dvec3(0.5);
    surface.specular = dvec3(0.25);
    surface.shininess = lit.shininess;
    const layers::SceneFrame frame = lit.scene().at(0);
    const ExactVector p = lit.place(n % kShadedSide_px, n / kShadedSide_px * 16);
    const layers::SurfacePoint point{{double(p.x), double(p.y), double(p.z)}, {0, 0, 1}, {0, 0, 0}};
    const Exact right = std::min(Exact(1), lit.right(n % kShadedSide_px, n / kShadedSide_px * 16));
    worst = worse(worst, std::fabs(layers::shaded_color(surface, frame.lights, point).x - right));
  }
  return {double(worst), false};
}

void add_surfaces_seen(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, HardRule rule,
                       std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Shading, name, special, extreme, rule, std::move(measure)});
  };
  const HardRule wrong{0, "of the texels", "the nearer is seen"}, same{0, "code values", "slow renderer"};
  add("1e-5 apart", "two surfaces, the farther drawn first", 1e5, wrong,
      [] { return wrong_in_front(1, 1e-5); });
  add("1e-5 apart at 1e9 m", "the same in the distance", 1e9, wrong,
      [] { return wrong_in_front(1e9, 1e-5); });
  add("1e-5 apart at 1e-9 m", "the same under a lens", 1e-9, wrong,
      [] { return wrong_in_front(1e-9, 1e-5); });
  add("60 crossing sheets", "16 fragments for a chunk", 60, same, [] { return crossing_sheets(60, 16); });
  add("a whole world", "textures, shadows, highlights", 1, same, [] { return world_against_reference(1.3); });
  add("1e6 repeats", "a texture of 64 million texels across", 1e6, {1e-3, "of white", "mean of the texture"},
      [] { return minified(1e6); });
  add("opacity 1e-6", "almost nothing", 1e-6, {1e-5, "of the opacity", "closed form"},
      [] { return faint(1e-6f); });
  add("points of the decision side", "highlights 1e-3 ... 1e4, grazing 1e-6", 1e7,
      {1e-5, "of white", "closed form, long double"}, decision_side);
}

}  // namespace

std::vector<HardCase> hard_shading() {
  std::vector<HardCase> cases;
  add_lights(cases);
  add_surfaces_seen(cases);
  return cases;
}

}  // namespace talisman::sequences
