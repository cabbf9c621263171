// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The tables of docs/sequence-format.md, from the tables of the reader. The document is written by hand but for
/// its blocks
///
///   <!-- keys of camera -->
///   …
///   <!-- end -->
///
/// which hold a heading and one row per key; `<!-- rules -->` opens the list of what no schema can say.

#include <string>
#include <vector>

#include "sequences/content/map_keys.h"

namespace talisman::sequences {

/// Heading and table of one kind of map.
std::string markdown_of(const MapKeys& keys);

/// A line for each rule that a table knows and a schema cannot say.
std::string rules_in_markdown(const MapKeys& root);

/// The document with every block made anew from the tables below `root`. Throws std::invalid_argument for a
/// block of a table that does not exist, one without an end, and a table or the rules without a block.
std::string documented(const std::string& document, const MapKeys& root);

}  // namespace talisman::sequences
