// SPDX-License-Identifier: Apache-2.0
// This file is compiled once per instruction set: foreach_target.h includes it again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chunker/shade_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "chunker/shade_block.h"

HWY_BEFORE_NAMESPACE();
namespace talisman::chunker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;  // divides kPoints for every width
using Vec = hn::Vec<Floats>;

/// Three coordinates of as many points as there are lanes.
struct Vec3 {
  Vec x, y, z;
};

HWY_INLINE Vec set(float v) { return hn::Set(Floats(), v); }
HWY_INLINE Vec3 set3(Float4 v) { return {set(v[0]), set(v[1]), set(v[2])}; }
HWY_INLINE Vec3 scaled(const Vec3& v, Vec s) { return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)}; }
HWY_INLINE Vec3 sum(const Vec3& a, const Vec3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vec3 minus(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 product(const Vec3& a, const Vec3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

HWY_INLINE Vec dot(const Vec3& a, const Vec3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vec3 unit(const Vec3& v) {
  const Vec squared = dot(v, v);
  const auto some = hn::Gt(squared, set(0));
  const Vec r = hn::Div(set(1), hn::Sqrt(squared));
  const Vec3 u = scaled(v, r);
  return {hn::IfThenElseZero(some, u.x), hn::IfThenElseZero(some, u.y), hn::IfThenElseZero(some, u.z)};
}

/// a · x + b · y, and c + that.
HWY_INLINE Vec plane(float a, Vec x, float b, Vec y) {
  return hn::Add(hn::Mul(set(a), x), hn::Mul(set(b), y));
}

HWY_INLINE Vec clamped(Vec v) {
  return hn::IfThenElseZero(hn::Gt(v, set(0)), hn::IfThenElse(hn::Lt(v, set(1)), v, set(1)));
}

HWY_INLINE Vec channel(const Interpolator& t, int index, int c, Vec one, Vec two) {
  const Vec first = hn::Add(set(t.a0[index][c]), hn::Mul(set(t.d1[index][c]), one));
  return hn::Add(first, hn::Mul(set(t.d2[index][c]), two));
}

HWY_INLINE Vec3 attribute3(const Interpolator& t, int index, Vec one, Vec two) {
  return {channel(t, index, 0, one, two), channel(t, index, 1, one, two), channel(t, index, 2, one, two)};
}

/// Squared length of one screen derivative of (u, v), in texels: `s` is the derivative of 1/w.
HWY_INLINE Vec squared_derivative(const Interpolator& t, int uv, const MipLevel& finest, Vec one, Vec two,
                                  Vec r, float q1, float q2, float s) {
  const Vec along_one = hn::Mul(hn::Sub(set(q1), hn::Mul(one, set(s))), r);
  const Vec along_two = hn::Mul(hn::Sub(set(q2), hn::Mul(two, set(s))), r);
  const float size[2] = {static_cast<float>(finest.width), static_cast<float>(finest.height)};
  Vec squares[2] = {set(0), set(0)};
  for (int c = 0; c < 2; ++c) {
    const Vec d = hn::Add(hn::Mul(set(t.d1[uv][c]), along_one), hn::Mul(set(t.d2[uv][c]), along_two));
    const Vec texels = hn::Mul(d, set(size[c]));
    squares[c] = hn::Mul(texels, texels);
  }
  return hn::Add(squares[0], squares[1]);
}

using Ints = hn::RebindToSigned<Floats>;
using IntVec = hn::Vec<Ints>;

/// floor_to_int() in lanes.
HWY_INLINE IntVec floor_to_int(Vec x) {
  const Ints di;
  const IntVec i = hn::ConvertTo(di, x);
  const auto above = hn::Lt(x, hn::ConvertTo(Floats(), i));
  return hn::Add(i, hn::IfThenElseZero(hn::RebindMask(di, above), hn::Set(di, -1)));
}

struct Taps {
  IntVec first, second;
  Vec share;
};

/// tap() in lanes.
HWY_INLINE Taps taps(Vec coordinate, IntVec size) {
  const Floats d;
  const Ints di;
  const Vec repeated = hn::Sub(coordinate, hn::ConvertTo(d, floor_to_int(coordinate)));
  const Vec x = hn::Sub(hn::Mul(repeated, hn::ConvertTo(d, size)), set(0.5f));
  const IntVec below = floor_to_int(x), above = hn::Add(below, hn::Set(di, 1));
  const IntVec first = hn::IfThenElse(hn::Lt(below, hn::Zero(di)), hn::Add(below, size), below);
  const IntVec second = hn::IfThenElse(hn::Lt(above, size), above, hn::Sub(above, size));
  return {first, second, hn::Sub(x, hn::ConvertTo(d, below))};
}

/// bordered_tap() in lanes.
HWY_INLINE Taps bordered_taps(Vec coordinate, IntVec size, layers::Wrap wrap) {
  const Floats d;
  const Ints di;
  Vec inside = clamped(coordinate);
  if (wrap == layers::Wrap::Mirror) {
    const Vec half = hn::Mul(coordinate, set(0.5f));
    const Vec there_and_back = hn::Mul(set(2), hn::Sub(half, hn::ConvertTo(d, floor_to_int(half))));
    const auto back = hn::Gt(there_and_back, set(1));
    inside = hn::IfThenElse(back, hn::Sub(set(2), there_and_back), there_and_back);
  }
  const Vec x = hn::Sub(hn::Mul(inside, hn::ConvertTo(d, size)), set(0.5f));
  const IntVec below = floor_to_int(x), one = hn::Set(di, 1);
  return {hn::Max(below, hn::Zero(di)), hn::Min(hn::Add(below, one), hn::Sub(size, one)),
          hn::Sub(x, hn::ConvertTo(d, below))};
}

/// `kWraps`: the texture does not repeat along both axes.
template <bool kWraps>
HWY_INLINE Taps taps_of(Vec coordinate, IntVec size, [[maybe_unused]] layers::Wrap wrap) {
  if constexpr (kWraps)
    if (wrap != layers::Wrap::Repeat) return bordered_taps(coordinate, size, wrap);
  return taps(coordinate, size);
}

template <bool kWraps>
HWY_INLINE void store_taps(const MipLevel& finest, Vec u, Vec v, IntVec width, IntVec height, BlockTaps& out,
                           int i) {
  const Floats d;
  const Ints di;
  const Taps x = taps_of<kWraps>(u, width, finest.wrap_u), y = taps_of<kWraps>(v, height, finest.wrap_v);
  const IntVec upper = hn::Mul(y.first, width), lower = hn::Mul(y.second, width);
  hn::Store(hn::Add(upper, x.first), di, &out.texel[0][i]);
  hn::Store(hn::Add(upper, x.second), di, &out.texel[1][i]);
  hn::Store(hn::Add(lower, x.first), di, &out.texel[2][i]);
  hn::Store(hn::Add(lower, x.second), di, &out.texel[3][i]);
  hn::Store(x.share, d, &out.x_share[i]);
  hn::Store(y.share, d, &out.y_share[i]);
}

/// coarse_log2() in lanes.
HWY_INLINE Vec log2_of(Vec x) {
  const Floats d;
  const Ints di;
  const IntVec bits = hn::BitCast(di, x);
  const IntVec mantissa = hn::Or(hn::And(bits, hn::Set(di, 0x007fffff)), hn::Set(di, 0x3f800000));
  const Vec m = hn::Sub(hn::BitCast(d, mantissa), set(1));
  const Vec e = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 127)));
  return hn::Add(hn::Add(e, m), hn::Mul(hn::Mul(set(0.3465f), m), hn::Sub(set(1), m)));
}

/// The taps of trilinear(): magnified points need one level, and where all are, no table is looked at.
template <bool kWraps>
HWY_INLINE void choose_taps(const Pyramid& pyramid, Vec u, Vec v, Vec footprint, ShadeBlock& block, int i) {
  const Floats d;
  const Ints di;
  const auto minified = hn::Gt(footprint, set(1));
  const MipLevel& finest = pyramid.levels[0];
  if (hn::AllFalse(d, minified)) {
    hn::Store(hn::Zero(di), di, &block.level[i]);
    hn::Store(set(0), d, &block.level_share[i]);
    store_taps<kWraps>(finest, u, v, hn::Set(di, finest.width), hn::Set(di, finest.height), block.fine, i);
    return;
  }
  const Vec last = set(static_cast<float>(pyramid.levels.size() - 1));
  const Vec half_log = hn::Mul(set(0.5f), log2_of(footprint));
  const Vec lambda = hn::IfThenElseZero(minified, hn::IfThenElse(hn::Lt(last, half_log), last, half_log));
  const IntVec level = hn::ConvertTo(di, lambda);
  const IntVec next = hn::Min(hn::Add(level, hn::Set(di, 1)), hn::ConvertTo(di, last));
  hn::Store(level, di, &block.level[i]);
  hn::Store(hn::Sub(lambda, hn::ConvertTo(d, level)), d, &block.level_share[i]);
  const std::int32_t *widths = pyramid.widths.data(), *heights = pyramid.heights.data();
  store_taps<kWraps>(finest, u, v, hn::GatherIndex(di, widths, level), hn::GatherIndex(di, heights, level),
                     block.fine, i);
  store_taps<kWraps>(finest, u, v, hn::GatherIndex(di, widths, next), hn::GatherIndex(di, heights, next),
                     block.coarse, i);
}

/// What is looked up besides λ.
enum class Footprint { None, Finest, Level };

template <Footprint kFootprint, bool kWraps = false>
HWY_INLINE void interpolate(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  const Floats d;
  [[maybe_unused]] const int uv = shader.layout.uv;
  for (int i = 0; i < block.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vec dx = hn::LoadU(d, block.dx + i), dy = hn::LoadU(d, block.dy + i);
    const Vec s = hn::Add(hn::Add(set(t.s0), hn::Mul(set(t.sx), dx)), hn::Mul(set(t.sy), dy));
    const Vec r = hn::Div(set(1), s);
    const Vec one = clamped(hn::Mul(plane(t.q1x, dx, t.q1y, dy), r));
    const Vec two = clamped(hn::Mul(plane(t.q2x, dx, t.q2y, dy), r));
    hn::Store(one, d, &block.one[i]);
    hn::Store(two, d, &block.two[i]);
    if constexpr (kFootprint == Footprint::None) continue;
    const MipLevel& finest = shader.pyramid->levels[0];
    const Vec u = channel(t, uv, 0, one, two), v = channel(t, uv, 1, one, two);
    if constexpr (kFootprint == Footprint::Finest) {
      const Ints di;
      store_taps<kWraps>(finest, u, v, hn::Set(di, finest.width), hn::Set(di, finest.height), block.fine, i);
    } else {
      const Vec x = squared_derivative(t, uv, finest, one, two, r, t.q1x, t.q2x, t.sx);
      const Vec y = squared_derivative(t, uv, finest, one, two, r, t.q1y, t.q2y, t.sy);
      choose_taps<kWraps>(*shader.pyramid, u, v, hn::IfThenElse(hn::Lt(x, y), y, x), block, i);
    }
  }
}

void interpolate_lanes(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  interpolate<Footprint::None>(shader, t, block);
}
void interpolate_bilinear_lanes([[maybe_unused]] const Shader& shader, [[maybe_unused]] const Interpolator& t,
                                [[maybe_unused]] ShadeBlock& block) {
  if constexpr (layers::is_built(layers::Effect::Texture)) interpolate<Footprint::Finest>(shader, t, block);
}
void interpolate_trilinear_lanes([[maybe_unused]] const Shader& shader,
                                 [[maybe_unused]] const Interpolator& t, [[maybe_unused]] ShadeBlock& block) {
  if constexpr (layers::is_built(layers::Effect::Texture)) interpolate<Footprint::Level>(shader, t, block);
}

void interpolate_wrapped_lanes([[maybe_unused]] const Shader& shader, [[maybe_unused]] const Interpolator& t,
                               [[maybe_unused]] ShadeBlock& block) {
  if constexpr (layers::is_built(layers::Effect::Texture)) {
    if (shader.mipmaps)
      interpolate<Footprint::Level, true>(shader, t, block);
    else
      interpolate<Footprint::Finest, true>(shader, t, block);
  }
}

/// The Phong lobe lane by lane: it needs more precision than a float has.
HWY_INLINE Vec lobes(Vec cosine, float shininess) {
  const Floats d;
  HWY_ALIGN float lane[16];
  hn::Store(cosine, d, lane);
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i)
    lane[i] = layers::power_of_unit(lane[i], shininess);
  return hn::Load(d, lane);
}

struct Lit {
  Vec3 diffuse, specular;
  Vec3 whole;  ///< diffuse, as it is without shadows; kShadowed alone
};

HWY_INLINE Vec luminance_of(const Vec3& c) {
  return hn::Add(hn::Add(hn::Mul(c.x, set(kLuminance[0])), hn::Mul(c.y, set(kLuminance[1]))),
                 hn::Mul(c.z, set(kLuminance[2])));
}

/// `more` is added where the light shines.
template <class Mask>
HWY_INLINE void add_where(Mask shines, const Vec3& more, Vec3& to) {
  const Vec3 added = sum(to, more);
  to = {hn::IfThenElse(shines, added.x, to.x), hn::IfThenElse(shines, added.y, to.y),
        hn::IfThenElse(shines, added.z, to.z)};
}

/// `visibility`: of the lights with maps, at the first lane's point; kShadowed alone.
template <bool kShadowed, bool kSpecular>
HWY_INLINE void add_light(const Shader& shader, const Vec3& normal, const Vec3& to_eye, const Vec3& to_light,
                          const Vec3& color, [[maybe_unused]] int map,
                          [[maybe_unused]] const ShadeBlock& block, [[maybe_unused]] int first, Lit& lit) {
  const Vec facing = dot(normal, to_light);
  const auto shines = hn::Gt(facing, set(0));
  if (hn::AllFalse(Floats(), shines)) return;
  const Vec3 own = scaled(color, facing);
  [[maybe_unused]] Vec seen = set(1);
  if constexpr (kShadowed) {
    if (map >= 0) seen = hn::Load(Floats(), &block.visibility[map][first]);
    add_where(shines, own, lit.whole);
    add_where(shines, scaled(own, seen), lit.diffuse);
  } else {
    add_where(shines, own, lit.diffuse);
  }
  if constexpr (!kSpecular) return;
  const Vec lobe = lobes(dot(normal, unit(sum(to_light, to_eye))), shader.shininess);
  Vec3 highlight = scaled(product(color, set3(shader.specular)), lobe);
  if constexpr (kShadowed) highlight = scaled(highlight, seen);
  add_where(shines, highlight, lit.specular);
}

HWY_INLINE void store3(const Vec3& v, std::array<BlockRow, 3>& rows, int i) {
  hn::Store(v.x, Floats(), &rows[0][i]);
  hn::Store(v.y, Floats(), &rows[1][i]);
  hn::Store(v.z, Floats(), &rows[2][i]);
}

/// The colour of a spot at points from which it lies in the direction `to_light`.
HWY_INLINE Vec3 spot_color(const LightSet::Spot& source, const Vec3& to_light) {
  const Vec cosine = hn::Neg(dot(set3(source.axis), to_light));
  const Vec t = clamped(hn::Mul(hn::Sub(cosine, set(source.cos_outer)), set(source.inverse_width)));
  const Vec falloff = hn::Mul(hn::Mul(t, t), hn::Sub(set(source.ramp), hn::Mul(set(source.ramp_slope), t)));
  return scaled(set3(source.color), falloff);
}

/// faded() in lanes, times the colour.
HWY_INLINE Vec3 faded_color(const LightSet::Fading& fading, const Vec3& apart, const Vec3& color) {
  if (!layers::is_built(layers::Effect::LightFalloff) || !fading.any) return color;
  const Vec squared = dot(apart, apart), distance = hn::Sqrt(squared);
  const Vec slope = hn::Add(set(fading.linear), hn::Mul(distance, set(fading.quadratic)));
  const Vec below = hn::Add(set(fading.constant), hn::Mul(distance, slope));
  const Vec relative = hn::Mul(squared, set(fading.per_range2));
  const Vec in_range = hn::Sub(set(1), hn::Mul(relative, relative));
  const Vec least = set(1e-12f);
  const Vec factor = hn::Div(hn::IfThenElseZero(hn::Gt(in_range, set(0)), in_range),
                             hn::IfThenElse(hn::Gt(below, least), below, least));
  return scaled(color, factor);
}

/// share_left() of the luminances.
HWY_INLINE void store_shadow(const Lit& lit, int first, ShadeBlock& block) {
  const Floats d;
  const Vec whole = luminance_of(lit.whole);
  const auto some = hn::Gt(whole, set(0));
  hn::Store(hn::IfThenElse(some, hn::Div(luminance_of(lit.diffuse), whole), set(1)), d, &block.shadow[first]);
}

HWY_INLINE Vec3 load3(const std::array<BlockRow, 3>& rows, int i) {
  const Floats d;
  return {hn::Load(d, &rows[0][i]), hn::Load(d, &rows[1][i]), hn::Load(d, &rows[2][i])};
}

/// light() at every point. `kMapped`: normals were looked up.
template <bool kShadowed, bool kSpecular, bool kMapped = false>
HWY_INLINE void light_points(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  const Floats d;
  for (int i = 0; i < block.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vec one = hn::Load(d, &block.one[i]), two = hn::Load(d, &block.two[i]);
    const Vec3 normal =
        kMapped ? load3(block.normal, i) : unit(attribute3(t, shader.layout.normal, one, two));
    const Vec3 nowhere{set(0), set(0), set(0)};
    const Vec3 position =
        shader.layout.position >= 0 ? attribute3(t, shader.layout.position, one, two) : nowhere;
    const Vec3 to_eye =
        kSpecular ? unit(Vec3{hn::Neg(position.x), hn::Neg(position.y), hn::Neg(position.z)}) : nowhere;
    const Vec3 ambient = set3(shader.lights->ambient);
    Lit lit{ambient, nowhere, ambient};
    for (const auto& source : shader.lights->directional)
      add_light<kShadowed, kSpecular>(shader, normal, to_eye, set3(source.to_light), set3(source.color),
                                      source.shadow, block, i, lit);
    for (const auto& source : shader.lights->point) {
      const Vec3 apart = minus(set3(source.position), position);
      add_light<kShadowed, kSpecular>(shader, normal, to_eye, unit(apart),
                                      faded_color(source.fading, apart, set3(source.color)), source.shadow,
                                      block, i, lit);
    }
    for (const auto& source : shader.lights->spot) {
      const Vec3 apart = minus(set3(source.position), position), to_light = unit(apart);
      add_light<kShadowed, kSpecular>(shader, normal, to_eye, to_light,
                                      faded_color(source.fading, apart, spot_color(source, to_light)),
                                      source.shadow, block, i, lit);
    }
    store3(lit.diffuse, block.diffuse, i);
    if constexpr (kSpecular) store3(lit.specular, block.specular, i);
    if constexpr (kShadowed) store_shadow(lit, i, block);
  }
}

void light_points_lanes(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  light_points<false, false>(shader, t, block);
}
void light_shiny_points_lanes(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  light_points<false, true>(shader, t, block);
}
void light_shadowed_points_lanes(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  light_points<true, false>(shader, t, block);
}
void light_shadowed_shiny_points_lanes(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  light_points<true, true>(shader, t, block);
}

void light_mapped_points_lanes([[maybe_unused]] const Shader& shader, [[maybe_unused]] const Interpolator& t,
                               [[maybe_unused]] ShadeBlock& block) {
  if constexpr (layers::is_built(layers::Effect::NormalMap)) {
    if (shader.shadowed && shader.has_specular)
      light_points<true, true, true>(shader, t, block);
    else if (shader.shadowed)
      light_points<true, false, true>(shader, t, block);
    else if (shader.has_specular)
      light_points<false, true, true>(shader, t, block);
    else
      light_points<false, false, true>(shader, t, block);
  }
}

}  // namespace talisman::chunker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talisman::chunker {

HWY_EXPORT(interpolate_lanes);
HWY_EXPORT(interpolate_bilinear_lanes);
HWY_EXPORT(interpolate_trilinear_lanes);
HWY_EXPORT(interpolate_wrapped_lanes);
HWY_EXPORT(light_points_lanes);
HWY_EXPORT(light_shiny_points_lanes);
HWY_EXPORT(light_shadowed_points_lanes);
HWY_EXPORT(light_shadowed_shiny_points_lanes);
HWY_EXPORT(light_mapped_points_lanes);

void interpolate_block(const Shader& shader, const Interpolator& t, Texels texels, ShadeBlock& block) {
  const bool fetched = texels == Texels::Trilinear || texels == Texels::Bilinear;
  if (fetched && shader.pyramid->wraps())
    HWY_DYNAMIC_DISPATCH(interpolate_wrapped_lanes)(shader, t, block);
  else if (texels == Texels::Trilinear)
    HWY_DYNAMIC_DISPATCH(interpolate_trilinear_lanes)(shader, t, block);
  else if (texels == Texels::Bilinear)
    HWY_DYNAMIC_DISPATCH(interpolate_bilinear_lanes)(shader, t, block);
  else
    HWY_DYNAMIC_DISPATCH(interpolate_lanes)(shader, t, block);
}

void light_block(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  if (shader.normal_map != nullptr)
    HWY_DYNAMIC_DISPATCH(light_mapped_points_lanes)(shader, t, block);
  else if (shader.shadowed && shader.has_specular)
    HWY_DYNAMIC_DISPATCH(light_shadowed_shiny_points_lanes)(shader, t, block);
  else if (shader.shadowed)
    HWY_DYNAMIC_DISPATCH(light_shadowed_points_lanes)(shader, t, block);
  else if (shader.has_specular)
    HWY_DYNAMIC_DISPATCH(light_shiny_points_lanes)(shader, t, block);
  else
    HWY_DYNAMIC_DISPATCH(light_points_lanes)(shader, t, block);
}

}  // namespace talisman::chunker
#endif  // HWY_ONCE
