// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/audit.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/make_pipeline.h"
#include "tests/sequences/small_run.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

std::vector<LayerAudit> audit_of(const SmallRun& small, int frames, int every, const std::string& folder) {
  Settings settings = small.settings;
  settings.frames = frames;
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, settings);
  const chunker::PreparedScene prepared(small.scene);
  PipelineState state(pipeline);
  Auditor auditor(every, folder);
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, &prepared);
    auditor.look(pipeline, state, report, prepared);
  }
  return auditor.finish();
}

const LayerAudit& named(const std::vector<LayerAudit>& audits, const std::string& name) {
  for (const LayerAudit& audit : audits)
    if (audit.layer == name) return audit;
  throw std::logic_error("no layer " + name);
}

TEST(AuditedReuse, SaysWhichFiducialWasTooSmall) {
  EXPECT_EQ((AuditedReuse{.geometric_px = 1, .shift_px = 1.4}.should_have_spoken()), "");
  EXPECT_EQ((AuditedReuse{.geometric_px = 1, .shift_px = 1.6}.should_have_spoken()), "geometric");
  EXPECT_EQ((AuditedReuse{.photometric = 0.03, .rms = 0.04}.should_have_spoken()), "");
  EXPECT_EQ((AuditedReuse{.photometric = 0.03, .rms = 0.06}.should_have_spoken()), "photometric");
  EXPECT_EQ((AuditedReuse{.rms = 0.2, .missing = 0.1}.should_have_spoken()), "visibility");
}

TEST(Auditor, MarksNothingOfTheMovingScene) {
  const tests::TemporaryFolder folder;
  const SmallRun small = SmallRun(tests::moving_scene()).policy(regulator::Policy::Threshold, 2);
  const std::vector<LayerAudit> audits = audit_of(small, 40, 3, folder.path() + "/audit");
  int audited = 0;
  for (const LayerAudit& audit : audits) {
    // Not even its ground, which is flat and large and seen in perspective: an affine warp is off by more between
    // its corners than at them (layers/foreshortening.h).
    EXPECT_FALSE(audit.marked()) << audit.layer << ": " << audit.worst.should_have_spoken();
    EXPECT_EQ(audit.audited, audit.reuses / 3);
    EXPECT_EQ(std::filesystem::exists(folder.path() + "/audit/" + audit.sheet), audit.audited > 0);
    audited += audit.audited;
  }
  EXPECT_GT(audited, 5);
}

TEST(Auditor, MarksALayerWhoseInnerMotionItsBoundDoesNotSee) {
  // An arm turns before a torso, in one layer with one box around both and no material points: nothing sees it.
  const tests::TemporaryFolder folder;
  const std::string man =
      folder.write("man.yaml",
                   "frames: 40\n"
                   "shapes:\n"
                   "  - {id: torso, box: [1, 2, 0.6], color: \"#40d040\"}\n"
                   "  - {id: arm, box: [0.3, 1.6, 0.3], color: \"#d04040\", position: [0, 0, 0.5],"
                   " spin: {axis: [0, 0, 1], deg_per_s: 45}}\n"
                   "camera: {fov_deg: 40, position: [0, 0, 6], look_at: [0, 0, 0]}\n");
  SmallRun small{layers::Scene(*load_sequence(man).scene)};
  layers::LayerSpec all{"all", {"*"}, layers::OrderGroup::Normal, {}};
  all.preferences.bound_each_part = false;
  small.layers = layers::factor(small.scene, {&all, 1});
  small.policy(regulator::Policy::Threshold, 2);
  small.settings.material_points = 0;
  const LayerAudit blind = named(audit_of(small, 40, 2, folder.path() + "/blind"), "all");
  EXPECT_TRUE(blind.marked());
  EXPECT_EQ(blind.worst.should_have_spoken(), "geometric");
}

TEST(Auditor, ChangesNoPicture) {
  const tests::TemporaryFolder folder;
  const SmallRun small = SmallRun(tests::moving_scene()).policy(regulator::Policy::Threshold, 2);
  const std::vector<FrameReport> plain = small.run(12, true);
  Settings settings = small.settings;
  settings.frames = 12;
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, settings);
  const chunker::PreparedScene prepared(small.scene);
  PipelineState state(pipeline);
  Auditor auditor(1, folder.path());
  for (int frame = 0; frame < 12; ++frame) {
    const FrameReport report = step(pipeline, state, frame, &prepared);
    auditor.look(pipeline, state, report, prepared);
    EXPECT_EQ(report.picture, plain[static_cast<std::size_t>(frame)].picture) << frame;
  }
}

}  // namespace
}  // namespace talisman::sequences
