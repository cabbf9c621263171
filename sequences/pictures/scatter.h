// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A few points in a page, quality against cost: each has a name and may be a link. Unlike plots (plot.h), which are
/// pictures, it follows the page from light to dark, and its points are reached by keys.

#include <string>
#include <vector>

namespace talisman::sequences {

struct ScatterPoint {
  double x = 0, y = 0;
  int series = 0;      ///< points of one are joined in their order, and share colour and shape
  std::string label;   ///< written beside it
  std::string href{};  ///< what it opens; empty: nothing
};

struct ScatterPicture {
  std::string caption, x_label, y_label;
  std::vector<ScatterPoint> points;
  bool logarithmic = false;  ///< both axes; else they begin at 0
};

/// An SVG element; points that are not finite, or ≤ 0 on logarithmic axes, are left out.
std::string svg(const ScatterPicture& scatter);

}  // namespace talisman::sequences
