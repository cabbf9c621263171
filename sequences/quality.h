// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far is a picture from the truth?
///
///   PSNR  10 log₁₀(255² / MSE) over all channels of the sRGB bytes, dB; identical pictures give infinity
///   (kIdenticalPsnr in JSON: null) SSIM  Wang et al. 2004: 11×11 Gaussian window, σ = 1.5, on luma, mean
///   over the picture; best 1 FLIP  Andersson et al. 2020 (LDR-FLIP): perceived difference when alternating,
///   mean over the picture; 0 best … 1 max   largest channel difference, 0 … 255

#include <string>
#include <vector>

#include "sequences/image_io.h"

namespace talisman::sequences {

struct QualityOptions {
  double pixels_per_degree = 67.02;  ///< FLIP's default observer: 0.7 m from a 0.7 m wide 3840-pixel display
  bool flip = true;                  ///< the costliest of the four
  bool ssim = true;
};

struct Quality {
  double psnr_db = 0;  ///< infinity when identical
  double ssim = 1;
  double flip = 0;
  int max_difference = 0;
  double changed_pixels = 0;  ///< share of pixels that differ at all, 0 … 1
};

/// Same sizes (programmer error otherwise).
Quality compare(const Image8& test, const Image8& reference, const QualityOptions& options = {});

/// FLIP error per pixel, 0 … 1, row by row.
std::vector<float> flip_map(const Image8& test, const Image8& reference, double pixels_per_degree = 67.02);

}  // namespace talisman::sequences
