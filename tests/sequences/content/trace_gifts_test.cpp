// SPDX-License-Identifier: Apache-2.0
// Traces that are not there, or hold more than they say: what stands in, and what is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/content/traces/trace.h"
#include "tests/sequences/content/trace_files.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;

Sequence with_trace(const TemporaryFolder& folder, const std::string& trace) {
  return load_sequence(folder.write("s.yaml",
                                    "frames: 30\nfps: 30\nshapes: [{id: box, box: [1, 1, 1]}]\n"
                                    "camera: {near_m: 0.1, far_m: 50, trace: {" +
                                        trace + "}}\n"));
}

TEST(Traces, StandInForWhatIsNotThere) {
  const TemporaryFolder folder;
  folder.write("own.tum", tests::WrittenTrace().tum());
  const char* gone = "file: \"no-such-package:/usr/head.tum\"";
  EXPECT_THAT(message_of([&] { with_trace(folder, gone); }), HasSubstr("s.yaml:4"));
  const Sequence instead = with_trace(folder, std::string(gone) + ", otherwise: own.tum");
  ASSERT_EQ(instead.warnings.size(), 1u);
  EXPECT_THAT(instead.warnings[0], HasSubstr("own.tum stands in for a trace: "));
  EXPECT_THAT(instead.warnings[0], HasSubstr("no-such-package"));
  const Sequence asked = with_trace(folder, "file: own.tum, otherwise: own.tum");
  EXPECT_TRUE(asked.warnings.empty());
  EXPECT_EQ(instead.scene->at(0.4).camera, asked.scene->at(0.4).camera);
  EXPECT_THAT(message_of([&] { with_trace(folder, std::string(gone) + ", otherwise: gone.tum"); }),
              HasSubstr("gone.tum"));
}

/// Boxing_Toes.bvh of assimp-testmodels is such a file.
TEST(Traces, WithWholeFramesMoreThanTheySayLeaveThemOut) {
  const TemporaryFolder folder;
  const tests::WrittenTrace written;
  folder.write("head.bvh", written.bvh());
  std::string more = written.bvh();
  const std::size_t last = more.rfind('\n', more.size() - 2) + 1;
  folder.write("more.bvh", more + more.substr(last));
  const Sequence as_said = with_trace(folder, "file: head.bvh, scale: 0.01");
  const Sequence left_out = with_trace(folder, "file: more.bvh, scale: 0.01");
  EXPECT_EQ(as_said.scene->at(0.7).camera, left_out.scene->at(0.7).camera);
  TraceOptions options;
  options.file = folder.write("more.bvh", more + more.substr(last));
  EXPECT_EQ(look_through_trace(options).poses, written.poses);
  EXPECT_EQ(look_through_trace(options).remark,
            "holds 1 frames more than the 61 that it says, which are left out");
  options.file = folder.write("words.bvh", more + more.substr(last) + "and so on\n");
  EXPECT_THAT(message_of([&] { look_through_trace(options); }), HasSubstr("goes on with '"));
}

}  // namespace
}  // namespace talisman::sequences
