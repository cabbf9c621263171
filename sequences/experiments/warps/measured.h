// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman warps` has measured, after [LS97 4.2]: update rate against error threshold of all curves,
/// figure by figure, and the picture quality of each curve at one equal update rate (experiment.h). Data
/// alone: what prints it looks down on it.

#include <string>
#include <vector>

#include "sequences/experiments/warps/objects.h"
#include "sequences/experiments/warps/quality.h"
#include "sequences/experiments/warps/ranking.h"

namespace talisman::sequences {

/// One object in one motion.
struct RateFigure {
  std::size_t object = 0;  ///< index into WarpReport::objects
  bool main = false;       ///< in the main motion, which is the paper's
  bool studied = false;    ///< the object is looked at in every motion and in pictures
  WarpMotion motion;
  std::vector<UpdateCurve> curves;
  Ranking ranking;
};

/// One object in the main motion.
struct QualityRun {
  std::size_t object = 0;  ///< index into WarpReport::objects
  std::vector<CurveQuality> curves;
};

struct WarpReport {
  std::vector<WarpObject> objects;
  std::vector<MissingObject> missing;  ///< left out, since their content is not there
  std::string bound;                   ///< name of the characteristic polyhedron
  std::vector<double> thresholds;      ///< px, ascending; of every figure
  std::vector<RateFigure> figures;     ///< the main motion of all objects first, those studied before others
  std::vector<QualityRun> qualities;
  RateOptions rate;  ///< of `qualities`
};

}  // namespace talisman::sequences
