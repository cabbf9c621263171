// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which tests decide what of a frame is drawn at all? The triples of [Fu93 Table 4.1].
///
///   precomputed  none | ctc: cells that some eye in the eye's cell sees | cto: objects that it sees
///   cells        none | frustum: cells that meet the frustum | eye: that are seen through a row of portals
///   objects      none | frustum: objects that meet the frustum | eye: that are seen through the portals
///
/// What is drawn is what passes all three, each of which keeps all that can be seen: so the picture is the same for all
/// triples, and only the time and what is left differ. `eye` of objects needs `eye` of cells, which leaves 21.
/// Only `none,none,frustum` does without cells (layers/cells.h).

#include <optional>
#include <string>
#include <string_view>

namespace talisman::sequences {

enum class Precomputed { None, CellToCell, CellToObject };
enum class ViewTest { None, Frustum, Eye };

struct VisibilityOptions {
  Precomputed precomputed = Precomputed::None;
  ViewTest cells = ViewTest::None, objects = ViewTest::None;
  bool any() const { return *this != VisibilityOptions{}; }
  bool needs_cells() const {
    return precomputed != Precomputed::None || cells != ViewTest::None || objects == ViewTest::Eye;
  }
  bool operator==(const VisibilityOptions&) const = default;
};

/// "cto,eye,eye"
std::string text_of(const VisibilityOptions& options);
/// Empty: no triple, or one of the six that cannot be.
std::optional<VisibilityOptions> visibility_from(std::string_view text);
inline constexpr const char* kVisibilityRule =
    "PRE,CELL,OBJECT with PRE none, ctc or cto, the others none, frustum or eye, and OBJECT eye only with "
    "CELL eye";

}  // namespace talisman::sequences
