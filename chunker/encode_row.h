// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From premultiplied linear colours to sprite texels, four channels at a time: encode() of pixel.h, bit by
/// bit.

#include "chunker/float4.h"
#include "chunker/pixel.h"

namespace talisman::chunker {

void encode_row(const Float4* colors, int count, Texel* texels);

}  // namespace talisman::chunker
