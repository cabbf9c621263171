// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Image error of two frames, or of two folders frame by frame (`talisman diff A B`, diff_command.h).
///
/// Of two folders the files NNNN.png (or NNNN.exr; one extension for both folders is not required) are
/// matched by number; where a folder holds a folder frames/ and no frames itself, that one is meant, so that
/// two results of `talisman render` can be named directly. A frame without its counterpart is reported and
/// makes the result partial.

#include <limits>
#include <string>
#include <vector>

#include "sequences/pictures/quality.h"

namespace talisman::sequences {

struct DiffOptions {
  std::string a;           ///< test: file or folder
  std::string b;           ///< reference: the same kind
  bool json = false;       ///< one JSON document (schema talisman.diff/1) in place of the table
  std::string map_dir;     ///< FLIP heat maps go here, NNNN.png (NAME.png for two files); empty: none
  QualityOptions quality;  ///< costs per frame: see there; maps ask for FLIP whatever this says
};

struct FrameDiff {
  std::string name;  ///< "0012", or A's file name
  Quality quality;
};

struct DiffReport {
  std::vector<FrameDiff> frames;    ///< by number
  std::vector<std::string> only_a;  ///< names of frames without counterpart
  std::vector<std::string> only_b;
  bool partial() const { return !only_a.empty() || !only_b.empty(); }
};

/// Mean and worst over frames. PSNR is averaged as mean squared error (of dB values, one identical frame
/// would make the mean infinite).
struct DiffSummary {
  Quality mean;
  Quality worst;
  int frames = 0;
};
DiffSummary summarize(const std::vector<FrameDiff>& frames);

/// Reads, compares and, if asked to, writes the maps. Throws InputError: unreadable, a file against a folder,
/// sizes that differ, no frame in common.
DiffReport diff(const DiffOptions& options);

}  // namespace talisman::sequences
