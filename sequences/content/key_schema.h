// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The JSON Schema (draft 2020-12) of a sequence file, from the tables of the reader: for editors that complete
/// and check while one types. A definition per table; what it cannot say is listed in docs/sequence-format.md.

#include <string>

#include "sequences/content/map_keys.h"

namespace talisman::sequences {

/// Indented text that ends with a line end.
std::string json_schema(const MapKeys& root);

}  // namespace talisman::sequences
