// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Parts that are cut before anything is factored: the list `cuts` of a sequence file, `{parts: GLOB, into: N}`, and how it
/// is found which parts are worth it.

#include <string>
#include <vector>

#include "layers/scene.h"
#include "sequences/content/factoring/factoring.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

struct CutEntry {
  std::string parts;  ///< glob
  int into = 2;       ///< pieces (layers/cut.h)
  std::string file;   ///< and line: where it is written
  int line = 0;
};

const Table<CutEntry>& cut_keys();

/// Cuts every part that an entry's glob matches, entry by entry. Throws InputError for a glob that matches no part, or one that
/// deforms.
void apply_cuts(const std::vector<CutEntry>& entries, layers::Scene& scene);

/// `cuts:` to paste, and `seam: auto`, without which cracks open between pieces; `in_model` as of layers_yaml. Empty where
/// there are none.
std::string cuts_yaml(const std::vector<CutEntry>& entries, const std::string& in_model = "");

/// A layer is worth a look if it takes at least this share of all work and is drawn in at least that share of the frames.
inline constexpr double kDearShare = 0.15, kOftenShare = 0.25;
/// A cut must save as much of its part's work, and all cuts of the scene's.
inline constexpr double kCutMustSave = 0.2, kCutsMustSave = 0.1;
/// Numbers of pieces that are tried, and how many parts of a layer: those of the largest bounds.
inline constexpr int kTriedPieces[] = {2, 4, 8, 16};
inline constexpr int kMostPartsTried = 4;
inline constexpr int kLeastCutTriangles = 8;
inline constexpr int kCutRounds = 3;

/// A study of a scene, or of the same with parts cut where one warp no longer serves and several do [LS97 2.1]:
///
///   1  what is the dearest of the layers that are found, and often drawn, is planned part by part, whole and cut
///   2  cuts that save kCutMustSave of their part's work are made, and the scene is factored again
///   3  the cuts stay if that, with seams (layers/seam.h), costs less by kCutsMustSave; then the pieces may be cut again
struct CutStudy {
  FactoringStudy study;
  std::vector<CutEntry>
      cuts{};  ///< with which the scene is that the study is of (apply_cuts); none: nothing is worth it
};

/// Only FactoringWay::Velocity cuts. Cost: as `study`, and again where something is cut.
CutStudy study_with_cuts(const Unfactored& scene, const AutoLayers& options);

}  // namespace talisman::sequences
