// SPDX-License-Identifier: Apache-2.0
// This file is compiled once per instruction set: foreach_target.h includes it again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "chunker/join_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "chunker/join_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace talisman::chunker::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void join_lanes_of_target(const JoinLanes<const float, const std::uint32_t>& other,
                          const JoinLanes<float, std::uint32_t>& mine, int count) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < count; i += lanes) {
    const auto a = hn::LoadU(d, mine.z + i), b = hn::LoadU(d, other.z + i);
    const auto may_be = hn::Ge(b, a);
    if (hn::AllFalse(d, may_be)) continue;
    const auto p = hn::LoadU(du, mine.part + i), q = hn::LoadU(du, other.part + i);
    const auto is_lower = hn::RebindMask(d, hn::Lt(q, p));
    const auto take = hn::And(may_be, hn::Or(hn::Gt(b, a), is_lower));
    if (hn::AllFalse(d, take)) continue;
    const auto take_words = hn::RebindMask(du, take);
    hn::StoreU(hn::IfThenElse(take, b, a), d, mine.z + i);
    hn::StoreU(hn::IfThenElse(take_words, q, p), du, mine.part + i);
    const auto under = hn::LoadU(du, mine.color + i), over = hn::LoadU(du, other.color + i);
    hn::StoreU(hn::IfThenElse(take_words, over, under), du, mine.color + i);
  }
}

}  // namespace talisman::chunker::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talisman::chunker {
namespace {

HWY_EXPORT(join_lanes_of_target);

}  // namespace

void join_lanes(const JoinLanes<const float, const std::uint32_t>& other,
                const JoinLanes<float, std::uint32_t>& mine, int count) {
  HWY_DYNAMIC_DISPATCH(join_lanes_of_target)(other, mine, count);
}

}  // namespace talisman::chunker
#endif  // HWY_ONCE
