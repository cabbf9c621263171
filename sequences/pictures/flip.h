// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How different do two pictures look when they take turns in the same place?
///
/// LDR-FLIP, after Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference
/// Evaluator for Alternating Images", HPG 2020. Two pipelines, per pixel:
///
///   colour   linear RGB → (Y, Cx, Cz); each channel blurred by the eye's contrast sensitivity; back to
///            RGB, clamped; L*a*b* with the Hunt adjustment (a, b scaled by L/100); distance
///            |ΔL| + √(Δa² + Δb²), to the power 0.7, mapped to 0 … 1:  ΔE_c
///   feature  luminance through edge (first derivative) and point (second derivative) detectors; the
///            larger difference of the two magnitudes, /√2, to the power 0.5:  ΔE_f
///   FLIP     ΔE_c ^ (1 - ΔE_f)
///
/// All filters are separable; the detectors because normalising their positive and negative parts in the
/// plane equals normalising them along the line. Powers are computed by our own polynomials (relative error
/// below 2e-6), since those of the C library differ in the last bit between CPUs.

#include <vector>

#include "sequences/files/image_io.h"
#include "sequences/pictures/separable_filter.h"

namespace talisman::sequences {

/// Constants of the publication, section 4.
namespace flip_constants {
/// Contrast sensitivity in space: a₁ √(π/b₁) exp(-π² d² / b₁) + a₂ …, d in degrees.
inline constexpr double kAchromaticB = 0.0047;
inline constexpr double kRedGreenB = 0.0053;
inline constexpr double kBlueYellowA1 = 34.1, kBlueYellowB1 = 0.04;
inline constexpr double kBlueYellowA2 = 13.5, kBlueYellowB2 = 0.025;
inline constexpr double kColorExponent = 0.7;  ///< qc
inline constexpr double kKneeDistance =
    0.4;                                    ///< pc: share of the largest distance at which the mapping bends
inline constexpr double kKneeError = 0.95;  ///< pt: error at the knee
inline constexpr double kFeatureWidthDeg = 0.082;  ///< w: peak-to-trough width of the detectors, degrees
inline constexpr double kFeatureExponent = 0.5;    ///< qf
/// CIE XYZ of linear sRGB primaries (rows X, Y, Z), D65; white is their sum.
inline constexpr double kXyzFromRgb[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
}  // namespace flip_constants

/// FLIP error per pixel, 0 … 1, row by row. Same sizes; 0 < pixels_per_degree ≤ 10000 (programmer errors
/// otherwise). Raising pixels_per_degree widens every filter: cost O(pixels · pixels_per_degree).
std::vector<float> flip_map(const Image8& test, const Image8& reference, double pixels_per_degree = 67.02);

/// A picture of an error map: black (0) over violet and orange to pale yellow (1), lightness rising steadily
/// so that it survives grey print and colour blindness. Values are clamped; NaN is black.
Image8 heat_map(const std::vector<float>& error, int width, int height);

}  // namespace talisman::sequences
