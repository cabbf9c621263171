// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/audit.h"
#include "tests/sequences/results/calibration.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using tests::Calibration;
using tests::kLeastPsnr_db;

struct Tally {
  long audited = 0, displaced = 0, noisy = 0;
  int marked = 0;
  double share(long of) const { return static_cast<double>(of) / static_cast<double>(std::max(audited, 1l)); }
  std::string text() const {
    char line[160];
    std::snprintf(line, sizeof line,
                  "%ld reuses audited, %ld displaced, %ld below %.0f dB (%.2f %% together), %d layers marked",
                  audited, displaced, noisy, kLeastPsnr_db, 100 * share(displaced + noisy), marked);
    return line;
  }
};

/// Counts the reuses of one run, and prints those that are worse than the thresholds promise.
void count(const std::string& name, const std::vector<LayerAudit>& audits, const Calibration& limits,
           bool prints, Tally& tally) {
  for (const LayerAudit& a : audits) {
    tally.marked += a.marked();
    for (const AuditedReuse& r : a.all) {
      ++tally.audited;
      const bool displaced = r.shift_px > limits.geometric_px + kShiftSlack_px;
      const bool noisy = !displaced && r.psnr_db < kLeastPsnr_db;
      tally.displaced += displaced;
      tally.noisy += noisy;
      if (prints && (displaced || noisy))
        std::printf(
            "%s, layer %s, frame %d: said %.2f px %.3f, seen %.2f px %.3f, %.1f dB, missing %.2f, age %d\n",
            name.c_str(), a.layer.c_str(), r.frame, r.geometric_px, r.photometric, r.shift_px, r.rms,
            r.psnr_db, r.missing, r.age_frames);
    }
  }
}

/// Every `every`-th reuse of each layer at these thresholds, drawn fresh.
std::vector<LayerAudit> audit_of_sequence(const Sequence& sequence, int frames, const Calibration& limits,
                                          int every, const std::string& folder) {
  Settings settings = tests::run_of(sequence).settings;
  settings.regulator.policy = regulator::Policy::Threshold;
  settings.regulator.thresholds.geometric_px = limits.geometric_px;
  settings.regulator.thresholds.photometric = limits.photometric;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  const chunker::PreparedScene prepared(*sequence.scene);
  PipelineState state(pipeline);
  Auditor auditor(every, folder + "/audit");
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, &prepared);
    auditor.look(pipeline, state, report, prepared);
  }
  return auditor.finish();
}

/// By hand: the table of tests/sequences/results/calibration.h.
TEST(AuditRandom, CalibrationByShippedSequences) {
  if (!std::getenv("TALISMAN_CALIBRATE")) GTEST_SKIP() << "TALISMAN_CALIBRATE asks for it";
  const tests::TemporaryFolder folder;
  constexpr int kFrames = 60;
  for (const double geometric_px : {0.25, 0.5, 1.0, 2.0})
    for (const double photometric : {0.02, 0.05}) {
      Tally tally;
      const Calibration limits{geometric_px, photometric};
      for (const char* name : {"carousel", "stage", "canyon"}) {
        const Sequence sequence = load_sequence(name);
        count(name, audit_of_sequence(sequence, kFrames, limits, 2, folder.path()), limits, false, tally);
      }
      std::printf("%.2f px, %.2f: %s\n", geometric_px, photometric, tally.text().c_str());
    }
}

/// Scenes that were drawn only after the thresholds were frozen.
constexpr int kFirstSeed = 1000;

/// By hand, TALISMAN_AUDIT_SCENES=500: the figures of docs/bound.md. In the suite 12 of them.
TEST(AuditRandom, NearlyNoReuseIsWorseThanItsFiducialsSay) {
  const char* asked = std::getenv("TALISMAN_AUDIT_SCENES");
  const int scenes = asked ? std::atoi(asked) : 12;
  const tests::TemporaryFolder folder;
  Tally tally;
  for (int seed = kFirstSeed; seed < kFirstSeed + scenes; ++seed) {
    const Sequence sequence = tests::random_sequence(static_cast<std::uint32_t>(seed), folder.path());
    count("seed " + std::to_string(seed),
          audit_of_sequence(sequence, sequence.frames, tests::kCalibration, 1, folder.path()),
          tests::kCalibration, true, tally);
  }
  std::printf("%d scenes: %s\n", scenes, tally.text().c_str());
  EXPECT_GT(tally.audited, 10 * scenes);
  EXPECT_LE(tally.share(tally.displaced), 0.01);
  // Wanted is 1 % here too; of 500 scenes it is 2.1 %, of twelve 4 %: what resampling blurs no fiducial says (docs/bound.md).
  EXPECT_LE(tally.share(tally.noisy), 0.05);
}

}  // namespace
}  // namespace talisman::sequences
