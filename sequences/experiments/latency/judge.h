// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The numbers of one way of showing frames (displayed.h), added up frame by frame.

#include <map>
#include <vector>

#include "sequences/experiments/latency/displayed.h"
#include "sequences/files/image_io.h"

namespace talisman::sequences {

/// The truth of one frame.
struct TrueFrame {
  layers::CameraState camera;
  std::vector<std::vector<layers::dvec2>> points;  ///< by layer; NaN: not before the camera
  Image8 picture;                                  ///< empty: not drawn
  std::vector<std::int32_t> layer;                 ///< by pixel; -1: none
};

/// A frame as it is shown.
struct ShownFrame {
  std::vector<std::vector<layers::dvec2>>
      points;                 ///< by layer, as many as in the truth or none; NaN: nowhere
  Image8 picture;             ///< empty: not drawn
  std::vector<char> is_open;  ///< by pixel: nothing is shown there
  std::vector<int> ages;      ///< of what is shown
};

class ShownJudge {
 public:
  ShownJudge(std::string name, bool is_whole, const layers::LayerSet& layers, layers::ivec2 display_px);
  void add(const TrueFrame& truth, const ShownFrame& shown);
  void add_polygons(double polygons) { polygons_ += polygons; }
  ShownWay result() const;

 private:
  struct OfLayer {
    std::vector<double> px;
    std::optional<layers::dvec2> before;  ///< mean error in the frame before
    double judder = 0, flip = 0, open = 0;
    std::int64_t steps = 0, pixels = 0;
  };
  void add_points(const std::vector<layers::dvec2>& truth, const std::vector<layers::dvec2>& shown,
                  OfLayer& layer);
  void add_picture(const TrueFrame& truth, const ShownFrame& shown);

  ShownWay way_;
  layers::ivec2 display_px_;
  std::vector<OfLayer> layers_;
  std::vector<double> ages_;
  double polygons_ = 0, flip_ = 0, open_ = 0;
  std::int64_t frames_ = 0, drawn_ = 0, pixels_ = 0, reused_ = 0;
};

Spread spread_of(std::vector<double> values);

}  // namespace talisman::sequences
