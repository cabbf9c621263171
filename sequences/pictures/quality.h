// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far is a picture from the truth?
///
///   PSNR  10 log₁₀(255² / MSE) over all channels of the sRGB bytes, dB; infinity when identical (JSON: null)
///   SSIM  Wang et al. 2004: 11×11 Gaussian window, σ = 1.5, on luma (0.299 R + 0.587 G + 0.114 B of the
///         sRGB bytes), mean over the picture with replicated borders; best 1
///           (2 μa μb + C1)(2 σab + C2) / ((μa² + μb² + C1)(σa² + σb² + C2))
///           C1 = (0.01 · 255)², C2 = (0.03 · 255)²
///   FLIP  Andersson et al. 2020 (LDR-FLIP): perceived difference when alternating, mean over the picture;
///         0 best … 1
///   max   largest channel difference, 0 … 255

#include <string>
#include <vector>

#include "sequences/files/image_io.h"
#include "sequences/pictures/flip.h"

namespace talisman::sequences {

struct QualityOptions {
  /// FLIP's observer, (0, 10000]; default: 0.7 m from a 0.7 m wide 3840-pixel display. More widens the
  /// filters.
  double pixels_per_degree = 67.02;
  bool flip = true;  ///< the costliest of the four
  bool ssim = true;
};

struct Quality {
  double psnr_db = 0;  ///< infinity when identical
  double ssim = 1;
  double flip = 0;
  int max_difference = 0;
  double changed_pixels = 0;  ///< share of pixels that differ at all, 0 … 1
};

/// Luma structural similarity alone. Same sizes (programmer error otherwise); 1 for empty pictures.
double ssim(const Image8& test, const Image8& reference);

/// Mean of an error map, summed in order; 0 when it is empty.
double mean(const std::vector<float>& values);

/// Same sizes (programmer error otherwise).
Quality compare(const Image8& test, const Image8& reference, const QualityOptions& options = {});

}  // namespace talisman::sequences
