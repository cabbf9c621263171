// SPDX-License-Identifier: Apache-2.0
// This file is compiled once per instruction set: foreach_target.h includes it again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chunker/shade_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "chunker/shade_batch.h"

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

void Interpolate(const Shader& shader, const Interpolator& t, ShadeBatch& batch) {
  const Floats d;
  const int uv = shader.layout.uv;
  for (int i = 0; i < batch.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vec dx = hn::Load(d, &batch.dx[i]), dy = hn::Load(d, &batch.dy[i]);
    const Vec s = hn::Add(hn::Add(set(t.s0), hn::Mul(set(t.sx), dx)), hn::Mul(set(t.sy), dy));
    const Vec r = hn::Div(set(1), s);
    const Vec one = clamped(hn::Mul(plane(t.q1x, dx, t.q1y, dy), r));
    const Vec two = clamped(hn::Mul(plane(t.q2x, dx, t.q2y, dy), r));
    hn::Store(one, d, &batch.one[i]);
    hn::Store(two, d, &batch.two[i]);
    if (uv < 0) continue;
    hn::Store(channel(t, uv, 0, one, two), d, &batch.u[i]);
    hn::Store(channel(t, uv, 1, one, two), d, &batch.v[i]);
    if (!shader.mipmaps) continue;
    const MipLevel& finest = shader.pyramid->levels[0];
    const Vec x = squared_derivative(t, uv, finest, one, two, r, t.q1x, t.q2x, t.sx);
    const Vec y = squared_derivative(t, uv, finest, one, two, r, t.q1y, t.q2y, t.sy);
    hn::Store(hn::IfThenElse(hn::Lt(x, y), y, x), d, &batch.footprint[i]);
  }
}

/// The Phong lobe lane by lane: it needs more precision than a float has.
HWY_INLINE Vec lobes(Vec cosine, float shininess) {
  const Floats d;
  HWY_ALIGN float lane[16];
  hn::Store(cosine, d, lane);
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) lane[i] = power_of_unit(lane[i], shininess);
  return hn::Load(d, lane);
}

struct Lit {
  Vec3 diffuse, specular;
};

HWY_INLINE void add_light(const Shader& shader, const Vec3& normal, const Vec3& to_eye, const Vec3& to_light,
                          Float4 color, Lit& lit) {
  const Vec facing = dot(normal, to_light);
  const auto lit_side = hn::Gt(facing, set(0));
  if (hn::AllFalse(Floats(), lit_side)) return;
  const Vec3 diffuse = sum(lit.diffuse, scaled(set3(color), facing));
  lit.diffuse = {hn::IfThenElse(lit_side, diffuse.x, lit.diffuse.x),
                 hn::IfThenElse(lit_side, diffuse.y, lit.diffuse.y),
                 hn::IfThenElse(lit_side, diffuse.z, lit.diffuse.z)};
  if (!shader.has_specular) return;
  const Vec lobe = lobes(dot(normal, unit(sum(to_light, to_eye))), shader.shininess);
  const Vec3 specular = sum(lit.specular, scaled(product(set3(color), set3(shader.specular)), lobe));
  lit.specular = {hn::IfThenElse(lit_side, specular.x, lit.specular.x),
                  hn::IfThenElse(lit_side, specular.y, lit.specular.y),
                  hn::IfThenElse(lit_side, specular.z, lit.specular.z)};
}

HWY_INLINE void store3(const Vec3& v, std::array<ShadeBatch::Row, 3>& rows, int i) {
  hn::Store(v.x, Floats(), &rows[0][i]);
  hn::Store(v.y, Floats(), &rows[1][i]);
  hn::Store(v.z, Floats(), &rows[2][i]);
}

/// light() at every point.
void LightPoints(const Shader& shader, const Interpolator& t, ShadeBatch& batch) {
  const Floats d;
  for (int i = 0; i < batch.count; i += static_cast<int>(hn::Lanes(d))) {
    const Vec one = hn::Load(d, &batch.one[i]), two = hn::Load(d, &batch.two[i]);
    const Vec3 normal = unit(attribute3(t, shader.layout.normal, one, two));
    const Vec3 nowhere{set(0), set(0), set(0)};
    const Vec3 position =
        shader.layout.position >= 0 ? attribute3(t, shader.layout.position, one, two) : nowhere;
    const Vec3 to_eye = shader.has_specular
                            ? unit(Vec3{hn::Neg(position.x), hn::Neg(position.y), hn::Neg(position.z)})
                            : nowhere;
    Lit lit{set3(shader.lights->ambient), nowhere};
    for (const auto& source : shader.lights->directional)
      add_light(shader, normal, to_eye, set3(source.to_light), source.color, lit);
    for (const auto& source : shader.lights->point)
      add_light(shader, normal, to_eye, unit(minus(set3(source.position), position)), source.color, lit);
    store3(lit.diffuse, batch.diffuse, i);
    if (shader.has_specular) store3(lit.specular, batch.specular, i);
  }
}

}  // namespace talisman::chunker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talisman::chunker {
namespace {

HWY_EXPORT(Interpolate);
HWY_EXPORT(LightPoints);

template <bool kTextured>
Float4 texel_of(const Shader& shader, const ShadeBatch& batch, int i) {
  if constexpr (!kTextured) return shader.texel;
  if (!shader.mipmaps) return bilinear(shader.pyramid->levels[0], batch.u[i], batch.v[i]);
  return trilinear(*shader.pyramid, batch.u[i], batch.v[i], batch.footprint[i]);
}

template <bool kPerPixel>
Lighting lighting_of(const Shader& shader, const Interpolator& t, const ShadeBatch& batch, int i) {
  const AttributeLayout& layout = shader.layout;
  const Lambda at{batch.one[i], batch.two[i], 0};
  const Float4 color = layout.color >= 0 ? attribute(t, at, layout.color) : shader.base;
  if constexpr (kPerPixel) {
    const Float4 diffuse{batch.diffuse[0][i], batch.diffuse[1][i], batch.diffuse[2][i], 0};
    const Float4 specular{batch.specular[0][i], batch.specular[1][i], batch.specular[2][i], 0};
    return {color * diffuse, shader.has_specular ? specular : splat(0)};
  } else {
    return {color, layout.specular >= 0 ? attribute(t, at, layout.specular) : splat(0)};
  }
}

template <bool kTextured, bool kPerPixel>
void combine(const Shader& shader, const Interpolator& t, ShadeBatch& batch) {
  for (int i = 0; i < batch.count; ++i)
    batch.color[i] =
        combined(shader, texel_of<kTextured>(shader, batch, i), lighting_of<kPerPixel>(shader, t, batch, i));
}

}  // namespace

void shade_batch(const Shader& shader, const Interpolator& t, ShadeBatch& batch) {
  HWY_DYNAMIC_DISPATCH(Interpolate)(shader, t, batch);
  const bool textured = shader.pyramid != nullptr;
  if (shader.per_pixel) {
    HWY_DYNAMIC_DISPATCH(LightPoints)(shader, t, batch);
    textured ? combine<true, true>(shader, t, batch) : combine<false, true>(shader, t, batch);
  } else {
    textured ? combine<true, false>(shader, t, batch) : combine<false, false>(shader, t, batch);
  }
}

}  // namespace talisman::chunker
#endif  // HWY_ONCE
