// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What one frame frees the next one needs again: triangles, attributes, chunks, pictures, some tens of MB. The
/// C library gives large blocks back to the system at once and gets them again page by page, each with a fault
/// and zeroed, which took half of the time to draw 500,000 triangles. A program that draws one frame after the
/// other keeps them instead; it holds its largest frame's memory to its end.

#include <malloc.h>

namespace talisman::sequences {

/// For the whole process, so for main() alone; where the C library is not glibc nothing happens.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kNever_bytes = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kNever_bytes);
  mallopt(M_TRIM_THRESHOLD, kNever_bytes);
#endif
}

/// The C library gives threads that allocate at once pools of their own, eight for each core, and what is freed goes back
/// into the pool that it came from. A server whose requests are answered by whatever thread is free so ends with many
/// pools, each as large as its largest request ever was. One serves all threads here. For the whole process, before it has
/// others.
inline void share_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace talisman::sequences
