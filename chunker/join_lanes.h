// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Of two pictures with depth the nearer texel, and of equally near ones that of the lower part (chunker/plan_buffer.h),
/// for as many texels at a time as the widest registers hold. Comparisons and selections alone: one result for all widths.
///
/// Depths are looked at first. Where none of a group is to be taken over, and none may be at equal depth, neither colours nor
/// parts are read, and nothing is written: of what lies behind, a third of the bytes.

#include <cstdint>

namespace talisman::chunker {

/// One of the two: depth, part and colour of each texel.
template <typename Z, typename Word>
struct JoinLanes {
  Z* z;
  Word* part;
  Word* color;
};

/// `count` is a multiple of 16.
void join_lanes(const JoinLanes<const float, const std::uint32_t>& other,
                const JoinLanes<float, std::uint32_t>& mine, int count);

}  // namespace talisman::chunker
