// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/audit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "regulator/policies.h"
#include "sequences/files/folders.h"
#include "sequences/pictures/apparent_shift.h"
#include "sequences/pictures/flip.h"
#include "sequences/pictures/picture_sheet.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/blended_sprites.h"
#include "sequences/results/layer_alone.h"
#include "sequences/results/layer_words.h"

namespace talisman::sequences {

namespace {

/// Both pictures of a reuse, over grey.
struct Pictures {
  Image8 shown, fresh;
};

/// Over the pixels of `crop` that are covered by half in either frame.
double psnr_of_layer(const chunker::Frame& shown, const chunker::Frame& fresh, const Crop& crop,
                     const Pictures& pictures) {
  double squares = 0;
  long covered = 0;
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x) {
      const auto in_frame = static_cast<std::size_t>(y + crop.y) * static_cast<std::size_t>(fresh.width) +
                            static_cast<std::size_t>(x + crop.x);
      if (2 * std::max(shown.pixels[in_frame].a, fresh.pixels[in_frame].a) < static_cast<int>(chunker::kOne))
        continue;
      ++covered;
      const auto in_crop = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(crop.width) +
                                static_cast<std::size_t>(x));
      for (std::size_t k = in_crop; k < in_crop + 3; ++k) {
        const double d = pictures.shown.rgb[k] - pictures.fresh.rgb[k];
        squares += d * d;
      }
    }
  if (squares == 0) return HUGE_VAL;
  return 10 * std::log10(255.0 * 255.0 * 3.0 * static_cast<double>(covered) / squares);
}

std::string audit_line(const char* pattern, auto... values) {
  char line[256];
  std::snprintf(line, sizeof line, pattern, values...);
  return line;
}

std::vector<std::string> audit_title(const LayerAudit& audit) {
  const AuditedReuse& w = audit.worst;
  return {audit_line("%s, frame %d, drawn %d frames before", audit.layer.c_str(), w.frame, w.age_frames),
          audit_line("said: geometric %.2f px, photometric %.3f", w.geometric_px, w.photometric),
          audit_line("seen: shift %.2f px (p95), RMS %.3f, %.1f dB, missing %.1f %%", w.shift_px, w.rms,
                     w.psnr_db, 100 * w.missing)};
}

Image8 sheet_of_worst(const LayerAudit& audit, const Image8& shown, const Image8& fresh) {
  constexpr int kLargest_px = 480, kGain = 4;
  const Crop crop = most_different({&shown}, fresh, kLargest_px, kLargest_px);
  const int scale = std::max(1, kLargest_px / 2 / std::max({crop.width, crop.height, 1}));
  const Image8 a = cropped(shown, crop), b = cropped(fresh, crop);
  return sheet_of(audit_title(audit),
                  {{{"shown"}, {a}}, {{"fresh"}, {b}}, {{"difference x 4"}, {difference(a, b, kGain)}}},
                  scale);
}

}  // namespace

double AuditedReuse::excess() const {
  return std::max((shift_px - geometric_px) / kShiftSlack_px, (rms - photometric) / kLightSlack);
}

std::string AuditedReuse::should_have_spoken() const {
  if (!beyond()) return {};
  if (missing > kMissing) return "visibility";
  return shift_px - geometric_px > kShiftSlack_px ? "geometric" : "photometric";
}

Auditor::Kept& Auditor::of_layer(const std::string& name) {
  const auto [it, is_new] = index_of_.try_emplace(name, layers_.size());
  if (is_new) layers_.emplace_back().audit.layer = name;
  return layers_[it->second];
}

void Auditor::look(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                   const chunker::PreparedScene& prepared) {
  const BlendedSprites blended = blended_sprites(state, report);
  for (const ShownSprite& sprite : report.shown) {
    const regulator::LayerDecision& decision = report.plan.decisions[sprite.layer];
    if (decision.action == regulator::Action::Rerender && !sprite.old) continue;
    Kept& kept = of_layer(report.layers[sprite.layer].name);
    if (++kept.audit.reuses % every_ != 0) continue;
    const chunker::Sprite* old = placed_sprite(sprite, state.sprites, blended).sprite;
    if (!old) continue;
    const layers::ivec2 display_px = pipeline.settings.view.display_px;
    const chunker::Frame shown = shown_alone(*old, sprite.screen_from_sprite, sprite.multipliers,
                                             report.layers[sprite.layer], display_px);
    const chunker::Frame fresh = fresh_alone(pipeline, state, report, sprite.layer, prepared);
    const fiducials::Photometric& photometric = report.assessments[sprite.layer].fiducials.photometric;
    double light = photometric.computed ? photometric.color : 0;
    if (sprite.old)  // as far off as it may fade
      light =
          std::max(light, regulator::kMostFadedError * pipeline.settings.regulator.thresholds.photometric);
    const ApparentShift seen = apparent_shift(shown, fresh, {decision.shown_geometric_px, light});
    Pictures pictures;
    if (seen.seen.width > 0) pictures = {over_grey(shown, seen.seen), over_grey(fresh, seen.seen)};
    AuditedReuse reuse{report.frame,
                       sprite.age_frames,
                       decision.shown_geometric_px,
                       light,
                       seen.p95_px,
                       seen.rms,
                       seen.missing,
                       0,
                       psnr_of_layer(shown, fresh, seen.seen, pictures)};
    ++kept.audit.audited;
    kept.audit.all.push_back(reuse);
    kept.audit.beyond += reuse.beyond();
    if (kept.audit.worst.frame >= 0 && reuse.excess() <= kept.audit.worst.excess()) continue;
    if (seen.seen.width > 0) {
      kept.shown = std::move(pictures.shown), kept.fresh = std::move(pictures.fresh);
      reuse.flip = mean(flip_map(kept.shown, kept.fresh));
    }
    kept.audit.worst = reuse;
  }
}

std::vector<LayerAudit> Auditor::finish() {
  std::vector<LayerAudit> audits;
  for (Kept& kept : layers_) {
    if (kept.fresh.width > 0) {
      prepare_folder(folder_);
      kept.audit.sheet = picture_of(kept.audit.layer);
      write_png(folder_ + "/" + kept.audit.sheet, sheet_of_worst(kept.audit, kept.shown, kept.fresh));
    }
    audits.push_back(kept.audit);
  }
  return audits;
}

std::string table_of(const std::vector<LayerAudit>& audit) {
  std::string rows = audit_line("  %-24s %7s %7s %6s %9s %9s %8s %8s %7s  %s\n", "audit of reuses", "audited",
                                "beyond", "worst", "said px", "seen px", "said", "RMS", "FLIP", "");
  for (const LayerAudit& a : audit) {
    const std::string name = column_of(a.layer);
    if (a.audited == 0) {
      rows += audit_line("  %s %7d\n", name.c_str(), 0);
      continue;
    }
    const std::string verdict = a.marked()     ? "MARKED: " + a.worst.should_have_spoken()
                                : a.beyond > 0 ? a.worst.should_have_spoken()
                                               : "";
    rows += audit_line("  %s %7d %7d %6d %9.3f %9.3f %8.3f %8.3f %7.4f  %s\n", name.c_str(), a.audited,
                       a.beyond, a.worst.frame, a.worst.geometric_px, a.worst.shift_px, a.worst.photometric,
                       a.worst.rms, a.worst.flip, verdict.c_str());
  }
  return rows;
}

}  // namespace talisman::sequences
