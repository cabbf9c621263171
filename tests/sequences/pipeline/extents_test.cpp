// SPDX-License-Identifier: Apache-2.0
// Extents that reach farther beyond the display keep sprites longer and never shorter: of any layer at most one
// render more, and fewer in all. On the shipped sequences, and on scenes drawn by lot:
//
// TALISMAN_RANDOM_SCENES=FIRST-LAST looks at those seeds instead (by hand: 1-500).
#include <cstdio>
#include <cstdlib>
#include <map>

#include <gtest/gtest.h>

#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using Renders = std::map<std::string, int>;  // by layer

Renders renders_of(const Sequence& sequence, double clip_margin) {
  Variant variant = tests::run_of(sequence);
  variant.settings.regulator.policy = regulator::Policy::Threshold;
  variant.settings.view.clip_margin = clip_margin;
  tests::Playback playback(variant.sequence, variant.settings, false);
  Renders renders;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    const FrameReport report = playback.next();
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      renders[report.layers[decision.layer].name] += decision.action == regulator::Action::Rerender;
  }
  return renders;
}

int sum_of(const Renders& renders) {
  int sum = 0;
  for (const auto& [layer, count] : renders) sum += count;
  return sum;
}

struct Totals {
  int near = 0, far = 0;  ///< renders
};

/// Compares extents of a quarter of the display with those of a whole one.
void expect_no_more_renders(const std::string& name, const Sequence& sequence, Totals& totals) {
  const Renders near = renders_of(sequence, 0.25), far = renders_of(sequence, 1);
  for (const auto& [layer, count] : far) {
    if (near.contains(layer)) {
      EXPECT_LE(count, near.at(layer) + 1) << name << ", layer " << layer;
    }
  }
  totals.near += sum_of(near);
  totals.far += sum_of(far);
}

TEST(Extents, OfShippedSequences) {
  for (const char* name : {"carousel", "stage", "canyon"}) {
    Totals totals;
    try {
      expect_no_more_renders(name, load_sequence(name), totals);
    } catch (const InputError&) {
      continue;  // its content was not fetched
    }
    std::printf("%s: %d renders with a margin of 0.25, %d with 1\n", name, totals.near, totals.far);
    EXPECT_LE(totals.far, totals.near) << name;
  }
}

TEST(Extents, OfScenesByLot) {
  unsigned first = 1, last = 30;
  if (const char* asked = std::getenv("TALISMAN_RANDOM_SCENES")) {
    ASSERT_EQ(std::sscanf(asked, "%u-%u", &first, &last), 2) << "FIRST-LAST";
  }
  const tests::TemporaryFolder folder;
  Totals totals;
  for (unsigned seed = first; seed <= last; ++seed)
    expect_no_more_renders("seed " + std::to_string(seed), tests::random_sequence(seed, folder.path()),
                           totals);
  std::printf("%d renders with a margin of 0.25, %d with 1\n", totals.near, totals.far);
  EXPECT_LE(totals.far, totals.near);
}

}  // namespace
}  // namespace talisman::sequences
