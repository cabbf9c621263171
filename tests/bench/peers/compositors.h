// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Compositors of others, 8-bit premultiplied: each lays the stack over the background into `frame`, on one thread.
/// Only those are linked whose library was found (TALISMAN_PEER_…).

#include <functional>

#include "tests/bench/peers/sprite_stack.h"

namespace talisman::bench {

using ArgbFrame = std::vector<std::uint32_t>;  ///< kDisplay

/// What is prepared once (images, maps) lives in the function; `stack` and `frame` must outlive it.
std::function<void()> qt5_compositor(const SpriteStack& stack, ArgbFrame& frame);
std::function<void()> pixman_compositor(const SpriteStack& stack, ArgbFrame& frame);
std::function<void()> opencv_compositor(const SpriteStack& stack, ArgbFrame& frame);

}  // namespace talisman::bench
