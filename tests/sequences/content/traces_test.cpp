// SPDX-License-Identifier: Apache-2.0
// Recorded poses: one motion in five formats is one camera, and what is wrong in a trace is refused with its line.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/content/traces/pose_sieve.h"
#include "sequences/content/traces/trace.h"
#include "sequences/content/traces/trace_text.h"
#include "tests/sequences/content/trace_files.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::dmat4;
using layers::dvec3;
using ::testing::HasSubstr;
using tests::known_pose;
using tests::message_of;
using tests::TemporaryFolder;
using tests::WrittenTrace;

Sequence seen_by(const TemporaryFolder& folder, const std::string& trace, const std::string& more = "") {
  return load_sequence(folder.write("s.yaml",
                                    "frames: 30\nfps: 30\nshapes: [{id: box, box: [1, 1, 1]}]\n"
                                    "camera: {near_m: 0.1, far_m: 50, trace: {" +
                                        trace + "}" + more + "}\n"));
}

dmat4 camera_at(const Sequence& sequence, double t_s) {
  return sequence.scene->at(t_s).camera.world_from_camera;
}

double largest_difference(const dmat4& a, const dmat4& b) {
  double most = 0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) most = std::max(most, std::fabs(a[column][row] - b[column][row]));
  return most;
}

/// What linear interpolation between poses of the closed form gives.
dmat4 expected_at(const WrittenTrace& written, double t_s) {
  const int k = std::min(static_cast<int>(t_s * written.fps + 1e-9), written.poses - 2);
  const double tau = t_s * written.fps - k;
  const tests::KnownPose a = known_pose(written.t_of(k)), b = known_pose(written.t_of(k + 1));
  dmat4 m = glm::mat4_cast(glm::slerp(a.rotation, b.rotation, tau));
  m[3] = {(1 - tau) * a.position + tau * b.position, 1};
  return m;
}

std::string tum_line(double t_s, const dvec3& p = {0, 0, 0}, double turn_deg = 0) {
  const double half = glm::radians(turn_deg) / 2;
  return tests::numbers({t_s, p.x, p.y, p.z, 0, std::sin(half), 0, std::cos(half)}, " ") + "\n";
}

TEST(Traces, OfAllFormatsAreTheSameCamera) {
  const TemporaryFolder folder;
  const WrittenTrace written;
  folder.write("head.tum", written.tum());
  folder.write("head.csv", written.euroc());
  folder.write("images.txt", written.colmap());
  folder.write("head.json", written.iwer());
  folder.write("head.bvh", written.bvh());
  for (const char* trace : {"file: head.tum", "file: head.csv", "file: images.txt, fps: 50",
                            "file: head.json", "file: head.bvh, scale: 0.01, joint: Head"}) {
    const Sequence sequence = seen_by(folder, trace);
    EXPECT_TRUE(sequence.warnings.empty()) << trace << ": " << ::testing::PrintToString(sequence.warnings);
    for (int frame = 0; frame < sequence.frames; ++frame)
      EXPECT_LE(largest_difference(camera_at(sequence, frame / 30.0), expected_at(written, frame / 30.0)),
                1e-9)
          << trace << " in frame " << frame;
  }
}

TEST(Traces, BeginWhereTheSequenceSays) {
  const TemporaryFolder folder;
  const WrittenTrace written;
  folder.write("head.tum", written.tum());
  const Sequence sequence = seen_by(folder, "file: head.tum, start_s: 0.13");
  for (const int frame : {0, 11, 29})
    EXPECT_LE(
        largest_difference(camera_at(sequence, frame / 30.0), expected_at(written, 0.13 + frame / 30.0)),
        1e-9);
  EXPECT_THAT(message_of([&] { seen_by(folder, "file: head.tum, start_s: 1.21"); }),
              HasSubstr("lasts 1.2 s and begins 1.21 s after"));
}

/// A tracked body whose x is forward, as that of EuRoC's drone: the camera's place on it is a matter of the sequence.
TEST(Traces, CarryWhatIsFixedToWhatWasTracked) {
  const TemporaryFolder folder;
  const WrittenTrace written;
  folder.write("head.tum", written.tum());
  const Sequence sequence =
      seen_by(folder, "file: head.tum", ", position: [0.1, 0.2, 0.3], rotation_deg: [0, 90, 0]");
  dmat4 mount = glm::mat4_cast(glm::angleAxis(std::acos(0.0), dvec3{0, 1, 0}));
  mount[3] = {0.1, 0.2, 0.3, 1};
  EXPECT_LE(largest_difference(camera_at(sequence, 0.5), expected_at(written, 0.5) * mount), 1e-9);
}

/// By hand: a camera of an optical frame that stands 3 m up in a world whose z is up, and looks along its x. Forward is the
/// optical z, so R's third column is x; down is −z of the world, the second; right is −y, the first.
TEST(Traces, OfAWorldWithZUpAreTurnedUpright) {
  const TemporaryFolder folder;
  const glm::dquat q = glm::quat_cast(glm::dmat3(dvec3{0, -1, 0}, dvec3{0, 0, -1}, dvec3{1, 0, 0}));
  const std::string pose = tests::numbers({7, 8, 3, q.x, q.y, q.z, q.w}, " ") + "\n";
  folder.write("a.tum", "0 " + pose + "9 " + pose);
  const dmat4 m = camera_at(seen_by(folder, "file: a.tum, up: z"), 0);
  // (x, y, z) → (x, z, −y): it stands at (7, 3, −8); looks along +x, so −z of the camera is x; up is y; right is z.
  const dmat4 right = {{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {7, 3, -8, 1}};
  EXPECT_LE(largest_difference(m, right), 1e-15);
}

/// Three times the stamp's last digit is below what a double of the whole stamp can hold.
TEST(TraceStamps, AreReadToTheirLastDigit) {
  const Stamp a = *stamp_in_seconds("1305031102.175304123"), b = *stamp_in_seconds("1305031102.175304126");
  EXPECT_NEAR(b.since(a), 3e-9, 1e-16);
  EXPECT_EQ(stamp_in_seconds("1.305031102175304123e+09")->since(a), 0);
  EXPECT_EQ(stamp_in_seconds("12e-1")->since({1, 0}), 0.2);
  EXPECT_EQ(stamp_in_seconds("-0.5")->since({0, 0}), -0.5);
  EXPECT_EQ(stamp_in_nanoseconds("1403636579758555392")->whole_s, 1403636579);
  for (const char* word :
       {"", "-", ".", "1e", "1e99", "nan", "inf", "0x10", "1.2.3", "1e400", "99999999999999999999"})
    EXPECT_FALSE(stamp_in_seconds(word)) << word;
  for (const char* word : {"", "1.5", "1e9", "99999999999999999999"})
    EXPECT_FALSE(stamp_in_nanoseconds(word)) << word;
}

struct BadTrace {
  const char* name;
  std::string text;
  const char* message;  ///< the end of the file's name, the line and what is wrong
};

/// Two poses a second apart.
std::string two_poses() { return tum_line(0) + tum_line(1); }

std::vector<BadTrace> bad_lines() {
  const std::string good = two_poses();
  return {{"a.tum", "", "a.tum: has no pose"},
          {"a.tum", "# nothing\n\n", "a.tum: has no pose"},
          {"a.tum", tum_line(0), "a.tum: has one pose"},
          {"a.tum", good + "2 nan 0 0 0 0 0 1\n", "a.tum:3: word 2 is 'nan'"},
          {"a.tum", good + "2 1e300 0 0 0 0 0 1\n", "a.tum:3: word 2 is '1e300'"},
          {"a.tum", good + "2 0 0 0 0 0 0 0\n", "a.tum:3: has a quaternion of norm 0"},
          {"a.tum", good + "2 0 0 0 0 0 0 1.02\n", "a.tum:3: has a quaternion of norm 1.02"},
          {"a.tum", good + "zwei 0 0 0 0 0 0 1\n", "a.tum:3: stamp is 'zwei'"},
          {"a.tum", good + "2 0 0 0 0 0 0\n", "a.tum:3: has 7 words"},
          {"a.tum", good + "2 0 0 0 0 0 0 1 5\n", "a.tum:3: has more than 8 words"},
          {"a.tum", good + tum_line(1), "a.tum:3: has a stamp 1 s after the first"},
          {"a.tum", good + tum_line(0.5), "a.tum:3: has a stamp 0.5 s after the first"},
          {"a.tum", good + std::string(100'000, '1'), "a.tum:3: has a line of more than 4096 bytes"},
          {"a.tum", good + std::string("\0\0\0\0", 4), "a.tum:3: has 1 words"},
          {"a.csv", "1,0,0,0,1,0,0\n", "a.csv:1: has 7 values"},
          {"a.csv", "1.5,0,0,0,1,0,0,0\n", "a.csv:1: stamp is '1.5', rule: whole nanoseconds"},
          {"images.txt", "1 1 0 0 0 0 0 0 1\n\n", "images.txt:1: has 9 words"},
          {"images.txt", "", "images.txt: has no pose"},
          {"images.txt", "# Image list\n", "images.txt: has no pose"},
          {"images.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n", "images.txt: has one pose"}};
}

std::vector<BadTrace> bad_recordings_and_skeletons() {
  const std::string skeleton =
      "HIERARCHY\nROOT Head\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n";
  return {
      {"a.json", "[]", "a.json:1: is a list"},
      {"a.json", "{}", "a.json:1: has no `frames`"},
      {"a.json", "{\"frames\": [\n[0,0,0,0,0,0,0,1],\n[20,0,0,0,0,0,null,1]]}", "a.json:3: frame 1 has null"},
      {"a.json", "{\"frames\": [\n[0,0,0,0,0,0,0,1],\n[20,0,0]]}", "a.json:3: frame 1 has 3 numbers"},
      {"a.json", "{\"frames\": [[0,0,0,0,0,0,0,1],\n[20,0,0,", "a.json:2: is no JSON"},
      {"a.json", "{\"frames\": 1}", "a.json:1: has no `frames`"},
      {"a.json", std::string(100'000, '['), "a.json:1: "},
      {"a.json", "{\"a\": \"" + std::string(100'000, ','), "a.json:1: has a word without end"},
      {"a.bvh", "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0", "a.bvh:4: ends too early"},
      {"a.bvh", skeleton + "MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n0 0",
       "a.bvh:11: ends in frame 1 of 2"},
      {"a.bvh", skeleton + "MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n0 x 0\n", "a.bvh:11: has 'x'"},
      {"a.bvh", skeleton + "MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n0 0 0\n7",
       "a.bvh:12: goes on with '7'"},
      {"a.bvh", skeleton + "MOTION\nFrames: 2\nFrame Time: 0\n0 0 0\n0 0 0\n", "a.bvh:9: has Frame Time: 0"},
      {"a.bvh", "HIERARCHY\nROOT Hips\n{\nCHANNELS 7 a\n}\n", "a.bvh:4: has CHANNELS 7"},
      {"a.bvh", "HIERARCHY\nROOT Hips\n{\n}\nMOTION", "a.bvh: has no joint 'Head', rule: one of 'Hips'"}};
}

TEST(BadTraces, AreRefusedWithTheirLine) {
  const TemporaryFolder folder;
  for (const std::vector<BadTrace>& traces : {bad_lines(), bad_recordings_and_skeletons()})
    for (const BadTrace& bad : traces) {
      folder.write(bad.name, bad.text);
      const std::string trace =
          std::string("file: ") + bad.name + (bad.name == std::string("images.txt") ? ", fps: 30" : "");
      const std::string message = message_of([&] { seen_by(folder, trace); });
      EXPECT_THAT(message, HasSubstr(bad.message)) << bad.text.substr(0, 200);
      EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
    }
}

TEST(BadTraces, OptionsThatTheFormatHasNoUseForAreRefused) {
  const TemporaryFolder folder;
  folder.write("head.tum", WrittenTrace().tum());
  folder.write("images.txt", WrittenTrace().colmap());
  EXPECT_THAT(message_of([&] { seen_by(folder, "file: head.tum, fps: 30"); }),
              HasSubstr("s.yaml:4: trace has fps"));
  EXPECT_THAT(message_of([&] { seen_by(folder, "file: images.txt"); }),
              HasSubstr("s.yaml:4: trace has no fps"));
  EXPECT_THAT(message_of([&] { seen_by(folder, "file: none.tum"); }), HasSubstr("'none.tum' is not there"));
  EXPECT_THAT(message_of([&] { seen_by(folder, "file: head.tum", ", look_at: [1, 2, 3]"); }),
              HasSubstr("look_at"));
}

/// An image that COLMAP could not place leaves a gap in time, and does not move those behind it forward.
TEST(Traces, OfColmapKeepTheTimesOfMissingImages) {
  const TemporaryFolder folder;
  std::string text;
  for (const int k : {0, 1, 2, 3, 4, 9, 10})
    text += sequences::formatted("%d 1 0 0 0 %d 0 0 1 %03d.jpg\n\n", k + 1, -k, k);
  folder.write("images.txt", text);
  const Sequence sequence = seen_by(folder, "file: images.txt, fps: 10");
  for (const double t_s : {0.25, 0.7, 0.95}) EXPECT_NEAR(camera_at(sequence, t_s)[3].x, 10 * t_s, 1e-12);
  ASSERT_EQ(sequence.warnings.size(), 1u);
  EXPECT_THAT(sequence.warnings[0], HasSubstr("1 gap of more than three periods of 0.1"));
}

TEST(Traces, SayTheirGapsAndTheirEnd) {
  const TemporaryFolder folder;
  std::string text;
  for (int k = 0; k <= 20; ++k)
    if (k < 6 || k > 9) text += tum_line(0.05 * k, {0.01 * k, 0, 0});  // 0.25 s, five periods
  folder.write("a.tum", text);
  const Sequence gap = seen_by(folder, "file: a.tum");
  ASSERT_EQ(gap.warnings.size(), 1u);
  EXPECT_THAT(gap.warnings[0], HasSubstr("a.tum:7: 1 gap of more than three periods of 0.05"));
  EXPECT_NEAR(camera_at(gap, 0.375)[3].x, 0.075, 1e-12);
  // Beyond the gap there is nothing to say of it; the sequence outlasts what is left.
  const Sequence behind = seen_by(folder, "file: a.tum, start_s: 0.5");
  ASSERT_EQ(behind.warnings.size(), 1u);
  EXPECT_THAT(behind.warnings[0], HasSubstr("ends 0.4667 s before the sequence does, its last pose holds"));
  EXPECT_EQ(camera_at(behind, 0.9)[3].x, 0.2);
}

/// Turns of 1° a step, but for one of 34°, as the first frames of recordings of CMU have it; and one bad pose, out and back.
TEST(Traces, SayJumpsAndTakeThemOutWhenAsked) {
  const TemporaryFolder folder;
  std::string text;
  for (int k = 0; k <= 30; ++k)
    text += tum_line(0.04 * k, {0.01 * k + (k == 20 ? 3 : 0), 0, 0}, k + (k >= 8 ? 33 : 0));
  folder.write("a.tum", text);
  const Sequence kept = seen_by(folder, "file: a.tum, frame: gl");
  ASSERT_EQ(kept.warnings.size(), 1u);
  EXPECT_THAT(kept.warnings[0], HasSubstr("a.tum:9: 3 jumps, the largest here, by 34° and 0 m"));
  const Sequence clipped = seen_by(folder, "file: a.tum, frame: gl, jumps: clip");
  EXPECT_TRUE(clipped.warnings.empty());
  for (const int k : {3, 7, 8, 15, 20, 21, 24}) {
    const dmat4 m = camera_at(clipped, 0.04 * k);
    EXPECT_NEAR(m[3].x, 0.01 * k, 1e-12) << k;
    EXPECT_NEAR(glm::degrees(std::atan2(m[2].x, m[2].z)), k, 1e-9) << k;
  }
}

/// Motion that begins and ends at full speed has large steps beside small ones, and no jump.
TEST(Traces, OfAMotionThatStartsAtOnceHaveNoJump) {
  const TemporaryFolder folder;
  std::string text;
  for (int k = 0; k <= 40; ++k) text += tum_line(0.03 * k, {k < 10 ? 0 : k > 30 ? 6 : 0.3 * (k - 10), 0, 0});
  folder.write("a.tum", text);
  EXPECT_TRUE(seen_by(folder, "file: a.tum").warnings.empty());
}

/// The slope of the parabola through three poses is exact on a parabola, however unevenly it was sampled; straight pieces
/// are off by the square of the step.
TEST(Traces, ResampledByCubicsAreExactOnParabolas) {
  const TemporaryFolder folder;
  std::string text;
  const auto place = [](double t_s) { return dvec3{t_s * t_s - t_s, 3 * t_s, 1}; };
  for (const double t_s : {0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.8, 0.9, 1.1, 1.2})
    text += tum_line(t_s, place(t_s));
  folder.write("a.tum", text);
  const Sequence cubic = seen_by(folder, "file: a.tum, resample: cubic");
  const Sequence straight = seen_by(folder, "file: a.tum");
  for (const double t_s : {0.15, 0.27, 0.41, 0.7, 0.95})
    EXPECT_NEAR(camera_at(cubic, t_s)[3].x, place(t_s).x, 1e-12) << t_s;
  EXPECT_NEAR(camera_at(straight, 0.4)[3].x - place(0.4).x, 0.01, 1e-12);  // h² / 4, h = 0.2
}

/// Rotations by cubics stay rotations, near those of the closed form, and have no step in speed at a pose.
TEST(Traces, ResampledByCubicsTurnWithoutSteps) {
  const TemporaryFolder folder;
  folder.write("head.tum", WrittenTrace().tum());
  const Sequence cubic = seen_by(folder, "file: head.tum, resample: cubic");
  const double h = 1e-5;
  for (const double t_s : {0.2, 0.5, 0.84}) {
    const dmat4 a = camera_at(cubic, t_s - h), b = camera_at(cubic, t_s), c = camera_at(cubic, t_s + h);
    EXPECT_LE(largest_difference((c - b) / h, (b - a) / h), 2e-3) << t_s;
    EXPECT_NEAR(glm::determinant(glm::dmat3(b)), 1, 1e-12);
  }
  for (const double t_s : {0.211, 0.507, 0.853}) {
    const tests::KnownPose pose = known_pose(t_s);
    EXPECT_LE(
        largest_difference(dmat4(glm::mat3_cast(pose.rotation)), dmat4(glm::dmat3(camera_at(cubic, t_s)))),
        1e-3);
  }
}

TEST(Traces, MoveShapesAndTheirLightsAndBelongToTheContent) {
  const TemporaryFolder folder;
  const WrittenTrace written;
  const std::string trace = folder.write("head.tum", written.tum());
  const Sequence sequence = load_sequence(
      folder.write("s.yaml",
                   "frames: 20\nfps: 20\nshapes: [{id: head, sphere: 1, trace: {file: head.tum}}]\n"
                   "camera: {position: [0, 0, 9], look_at: [0, 0, 0]}\n"
                   "lights: [{kind: point, trace: {file: head.tum}, position: [0, 0, -1]}]\n"));
  EXPECT_EQ(std::count(sequence.content_files.begin(), sequence.content_files.end(), trace), 2);
  const layers::SceneFrame frame = sequence.scene->at(0.5);
  const dmat4 expected = expected_at(written, 0.5);
  const int node = sequence.scene->parts[0].node;
  EXPECT_LE(largest_difference(frame.world_from_node[static_cast<std::size_t>(node)], expected), 1e-9);
  EXPECT_LE(glm::distance(frame.lights[0].position, dvec3(expected * glm::dvec4(0, 0, -1, 1))), 1e-9);
}

/// Poses that the sequence does not need are read past: two before it, two behind it.
TEST(Traces, AreKeptInTheirRangeAlone) {
  const TemporaryFolder folder;
  std::string text;
  for (int k = 0; k < 100'000; ++k)
    text += sequences::formatted("%d.%03d 0 0 0 0 0 0 1\n", k / 1000, k % 1000);
  text += "this line is not reached\n";
  TraceOptions options;
  options.file = folder.write("long.tum", text);
  options.start_s = 50;
  const Trace trace = read_trace(options, 1);
  EXPECT_GE(trace.positions.times_s.size(), 1001u);
  EXPECT_LE(trace.positions.times_s.size(), 1005u);
  EXPECT_THAT(message_of([&] { look_through_trace(options); }), HasSubstr("long.tum:100001: has 5 words"));
}

TEST(TraceFindings, OfManyValuesAreRightToOnePerCent) {
  LogHistogram few, many;
  for (int k = 1; k <= 20'000; ++k) {
    if (k <= 4096) few.add(0.001 * k);
    many.add(0.001 * k);
  }
  EXPECT_EQ(few.quantile(0.5), 0.001 * 2049);
  EXPECT_NEAR(many.quantile(0.5), 10, 0.1);
  EXPECT_NEAR(many.quantile(0.95), 19, 0.19);
  EXPECT_EQ(many.max(), 20);
  EXPECT_EQ(LogHistogram().quantile(0.5), 0);
}

TEST(TraceFindings, AreThoseOfAKnownMotion) {
  const TemporaryFolder folder;
  std::string text;
  // 100 steps of 10 ms: 90 at 1 m/s and 30 °/s, ten at 2 m/s and 60 °/s.
  double x = 0, turn_deg = 0;
  for (int k = 0; k <= 100; ++k) {
    text += tum_line(0.01 * k, {x, 0, 0}, turn_deg);
    const double times = k % 10 == 5 ? 2 : 1;
    x += 0.01 * times, turn_deg += 0.3 * times;
  }
  TraceOptions options;
  options.file = folder.write("a.tum", text);
  const TraceFindings findings = look_through_trace(options);
  EXPECT_EQ(findings.poses, 101);
  EXPECT_NEAR(findings.length_s, 1, 1e-12);
  EXPECT_NEAR(findings.way_m, 1.1, 1e-9);
  EXPECT_NEAR(findings.period_s(), 0.01, 1e-4);
  EXPECT_NEAR(findings.speed_m_per_s.quantile(0.5), 1, 0.01);
  EXPECT_NEAR(findings.speed_m_per_s.quantile(0.95), 2, 0.02);
  EXPECT_NEAR(findings.turn_deg_per_s.quantile(0.5), 30, 0.3);
  EXPECT_NEAR(findings.turn_deg_per_s.max(), 60, 1e-6);
  EXPECT_TRUE(findings.gaps().empty());
  EXPECT_EQ(findings.jump_count, 0);
}

}  // namespace
}  // namespace talisman::sequences
