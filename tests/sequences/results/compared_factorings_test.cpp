// SPDX-License-Identifier: Apache-2.0
// What is proposed costs what it costs once it is pasted.
#include "sequences/results/factoring/compared_factorings.h"

#include <string>

#include <gmock/gmock.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::SizeIs;

/// A land of one part, over which the eye flies low.
std::string land(const std::string& layers) {
  return "frames: 24\nfps: 24\ndisplay: [100, 100]\n"
         "camera: {fov_deg: 60, near_m: 0.1, flight: [{t: 0, position: [0, 2, 40], target: [0, 1, 0]},"
         " {t: 1, position: [0, 2, 34], target: [0, 1, -6]}]}\n"
         "shapes:\n  - {id: land, plane: [60, 80], segments: 32, color: [0.2, 0.4, 0.1]}\n"
         "regulator: {geometric_px: 1}\n" +
         layers;
}

TEST(ComparedFactorings, CutsAreProposedWithWhatTheirSeamsCost) {
  const tests::TemporaryFolder folder;
  const Sequence whole = load_sequence(folder.write("whole.yaml", land("layers: {auto: node}\n"))),
                 found = load_sequence(folder.write("found.yaml", land("layers: {auto: velocity}\n")));
  const ComparedFactoring compared = compare_factorings(whole, {});
  ASSERT_THAT(compared.cuts, SizeIs(1));
  EXPECT_EQ(compared.cuts[0].parts, "land");
  const PlannedLayers &now = compared.all[0], &proposed = compared.all[1];
  EXPECT_EQ(now.layers, 1u);
  EXPECT_LT(proposed.work_ms, 0.9 * now.work_ms);
  // Read from a file that leaves the layers to the tool, the same are planned with their seams.
  ASSERT_EQ(found.seam, Seam::Auto);
  const PlannedLayers pasted = compare_factorings(found, {}).all[0];
  EXPECT_EQ(proposed.layers, pasted.layers);
  EXPECT_EQ(proposed.summary.polygons_rendered(), pasted.summary.polygons_rendered());
  EXPECT_EQ(proposed.summary.pixels_rendered(), pasted.summary.pixels_rendered());
  // The pieces are in the layer that had the part: split by itself, it is one change.
  ASSERT_THAT(compared.wanted, SizeIs(1));
}

}  // namespace
}  // namespace talisman::sequences
