// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Do the fiducials tell the truth? `render --audit N`, `talisman audit`.
///
/// Every N-th reuse of a layer is drawn fresh beside its warped sprite, both alone and without what hides them,
/// and the two pictures are compared (pictures/apparent_shift.h). What a fiducial said is set against what the
/// picture says:
///
///   geometric     said: error of what is displayed, px          seen: 95th percentile of the apparent shift
///   photometric   said: largest change of a colour, 0 … √3       seen: RMS that no shift within the geometric
///                 (0 where no light can change)                        fiducial explains
///
/// A frame is *beyond* where the shift exceeds its fiducial by more than kShiftSlack_px, or the RMS exceeds
/// the photometric one by more than kLightSlack. A layer is *marked* when at least kFramesToMark of its audited
/// frames are beyond: for it the fiducials cannot be trusted. The fiducial that should have spoken is the
/// visibility one where the sprite has nothing to show for more than kMissing of the layer, else the geometric
/// one where the shift is beyond, else the photometric one.
///
/// Of each layer the frame that is farthest beyond (or nearest to it) becomes a sheet in DIR/audit: shown, fresh,
/// difference.

#include <map>
#include <string>
#include <vector>

#include "chunker/render.h"
#include "sequences/files/image_io.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

inline constexpr double kShiftSlack_px = 0.5, kLightSlack = 0.02, kMissing = 0.02;
inline constexpr int kFramesToMark = 2;

/// One reuse: what was said and what is seen.
struct AuditedReuse {
  int frame = -1;
  int age_frames = 0;       ///< since the sprite was drawn
  double geometric_px = 0;  ///< said
  double photometric = 0;   ///< said; 0 where it was not computed
  double shift_px = 0;      ///< seen, 95th percentile
  double rms = 0;           ///< seen
  double missing = 0;       ///< seen: share of the layer that the sprite does not have
  double flip = 0;          ///< mean over the layer's part of the display; of the worst frame only
  double psnr_db = 0;  ///< over the pixels that the layer covers by half in either picture, both over grey;
                       ///< infinite where they are the same
  /// In units of the slack, ≤ 1: not beyond.
  double excess() const;
  bool beyond() const { return excess() > 1; }
  std::string should_have_spoken() const;  ///< "geometric", "photometric", "visibility"; empty: none
};

/// One layer over the run.
struct LayerAudit {
  std::string layer;
  int reuses = 0;                 ///< of the run
  int audited = 0, beyond = 0;    ///< frames
  AuditedReuse worst;             ///< with the largest excess
  std::vector<AuditedReuse> all;  ///< the audited ones, by frame
  std::string sheet;              ///< file name in DIR/audit; empty: none
  bool marked() const { return beyond >= kFramesToMark; }
};

/// Audits the frames of one run as they are drawn.
class Auditor {
 public:
  /// `every` ≥ 1; sheets go to `folder`.
  Auditor(int every, std::string folder) : every_(every), folder_(std::move(folder)) {}

  /// After the step that made `report`, with the state that it left. Cost: one drawing of each audited layer.
  void look(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
            const chunker::PreparedScene& prepared);

  /// Writes the sheets. The layers that were reused, in the order of their names' first appearance.
  std::vector<LayerAudit> finish();

 private:
  struct Kept {
    LayerAudit audit{};
    Image8 shown, fresh;  ///< of the worst frame
  };
  Kept& of_layer(const std::string& name);

  int every_;
  std::string folder_;
  std::map<std::string, std::size_t> index_of_;
  std::vector<Kept> layers_;
};

/// Of `talisman audit` and the end table: what was said and seen in the worst frame of each layer.
std::string table_of(const std::vector<LayerAudit>& audit);

}  // namespace talisman::sequences
