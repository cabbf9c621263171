// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/factoring/measured.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"

namespace talisman::sequences {

using layers::dvec3;

void ErrorSum::add(double error) {
  squares += error * error;
  largest = std::max(largest, std::fabs(error));
  ++count;
}

ErrorSum& ErrorSum::operator+=(const ErrorSum& o) {
  squares += o.squares;
  largest = std::max(largest, o.largest);
  count += o.count;
  return *this;
}

double ErrorSum::rms() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0; }

void PredictionCheck::add(const FramePrediction& prediction, const chunker::Frame& shown) {
  TALISMAN_CHECK_EQ(prediction.pixels.size(), shown.pixels.size());
  for (std::size_t i = 0; i < prediction.pixels.size(); ++i) {
    const PixelPrediction& pixel = prediction.pixels[i];
    const dvec3 is = linear_of(shown.pixels[i]) - pixel.truth, should = pixel.error();
    for (int c = 0; c < 3; ++c) {
      const double off = is[c] - should[c];
      predicted.add(should[c]);
      by_formula.add(pixel.over[c]);
      measured.add(is[c]);
      unexplained.add(off);
      if (std::fabs(should[c]) < kNothing) elsewhere.add(is[c]);
      largest_bound = std::max(largest_bound, pixel.bound[c]);
      largest_share_of_bound = std::max(largest_share_of_bound, std::fabs(off) / pixel.bound[c]);
      beyond_bound += std::fabs(off) > pixel.bound[c];
    }
  }
}

PredictionCheck& PredictionCheck::operator+=(const PredictionCheck& o) {
  predicted += o.predicted;
  by_formula += o.by_formula;
  measured += o.measured;
  unexplained += o.unexplained;
  elsewhere += o.elsewhere;
  largest_bound = std::max(largest_bound, o.largest_bound);
  largest_share_of_bound = std::max(largest_share_of_bound, o.largest_share_of_bound);
  beyond_bound += o.beyond_bound;
  return *this;
}

const char* name(Picture picture) {
  switch (picture) {
    case Picture::OverAlone:
      return "over alone";
    case Picture::ShadeResolution:
      return "+ shade resolution";
    case Picture::Placement:
      return "+ placement";
    case Picture::Reuse:
      return "+ reuse";
    case Picture::AsShade:
      return "shadows as shade";
    case Picture::AsLight:
      return "shadows as light";
    case Picture::AsMultiply:
      return "shadows as multiply";
    case Picture::AsAtop:
      return "shadows as atop";
    case Picture::OnePass:
      return "unfactored, one pass";
    case Picture::UnfactoredReuse:
      return "unfactored, reuse";
  }
  return "";
}

}  // namespace talisman::sequences
