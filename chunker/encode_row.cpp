// SPDX-License-Identifier: Apache-2.0
// This file is compiled once per instruction set: foreach_target.h includes it again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chunker/encode_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "chunker/encode_row.h"

HWY_BEFORE_NAMESPACE();
namespace talisman::chunker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void encode_row_of_target(const float* colors, int channels, std::uint8_t* bytes) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto one = hn::Set(d, 1.0f), scale = hn::Set(d, 255.0f), half = hn::Set(d, 0.5f);
  // Outside the loop: inside, the compiler spells it as sixteen stores and a load that waits for them.
  const auto lane = hn::Iota(di, 0);
  for (int i = 0; i < channels; i += lanes) {
    // Every fourth channel is alpha, which stays linear. There may be fewer lanes than channels of a texel.
    const auto channel = hn::And(hn::Add(lane, hn::Set(di, i)), hn::Set(di, 3));
    const auto is_alpha = hn::RebindMask(d, hn::Eq(channel, hn::Set(di, 3)));
    const auto v = hn::LoadU(d, colors + i);
    const auto clamped = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), hn::IfThenElse(hn::Lt(v, one), v, one));
    const auto curved = hn::IfThenElse(is_alpha, clamped, hn::Sqrt(clamped));
    const auto code = hn::ConvertTo(di, hn::Add(hn::Mul(curved, scale), half));
    hn::StoreU(hn::DemoteTo(d8, code), d8, bytes + i);
  }
}

}  // namespace talisman::chunker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talisman::chunker {
namespace {

HWY_EXPORT(encode_row_of_target);
constexpr int kGroup = 4;  ///< texels of the widest lane group

}  // namespace

void encode_row(const Float4* colors, int count, Texel* texels) {
  const int whole = count / kGroup * kGroup;
  HWY_DYNAMIC_DISPATCH(encode_row_of_target)
  (reinterpret_cast<const float*>(colors), whole * 4, reinterpret_cast<std::uint8_t*>(texels));
  for (int i = whole; i < count; ++i)
    texels[i] = encode({colors[i][0], colors[i][1], colors[i][2], colors[i][3]});
}

}  // namespace talisman::chunker
#endif  // HWY_ONCE
