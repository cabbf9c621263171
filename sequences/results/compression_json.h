// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The entry "compression" of frames.jsonl and summary.json. Ratio, PSNR and hit rate are computed from the
/// sums beside them; a PSNR without any error is null.

#include <nlohmann/json.hpp>

#include "sequences/pipeline/sprite_compression.h"

namespace talisman::sequences {

nlohmann::ordered_json compression_json(const CompressionReport& report);
/// Throws nlohmann::json::exception if an entry is missing or has another type.
CompressionReport compression_from_json(const nlohmann::ordered_json& json);

}  // namespace talisman::sequences
