// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The stream between talisman_import and the tool: magic, version, then every field in the order of its
/// struct, each array behind its length, in the byte order of the machine on which both run.
///
/// The `…_from_bytes` throw InputError on anything malformed, also on a scene with a first_defect; no length
/// is believed before as many bytes are there.

#include <cstdint>
#include <span>
#include <vector>

#include "sequences/import/model_import.h"

namespace talisman::sequences {

std::vector<std::uint8_t> bytes_from_scene(const layers::Scene& scene);
layers::Scene scene_from_bytes(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> bytes_from_model(const ImportedModel& model);
ImportedModel model_from_bytes(std::span<const std::uint8_t> bytes);

}  // namespace talisman::sequences
