// SPDX-License-Identifier: Apache-2.0
// A run in parts: merged they are the bytes of one run, for every policy, whole or killed; and what does not belong
// together is not joined.
#include <algorithm>
#include <atomic>
#include <ctime>
#include <map>
#include <numeric>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/fan_out/shard_command.h"
#include "sequences/commands/render.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/results/exact_sum.h"
#include "sequences/results/shards/merge.h"
#include "sequences/results/shards/shard.h"
#include "sequences/results/shards/shard_file.h"
#include "tests/sequences/commands/tool.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using tests::content;
using tests::message_of;
using tests::TemporaryFolder;

// --- Sums ---

TEST(ExactSum, IsTheNearestDoubleWhateverTheOrder) {
  // 1 + 2⁻⁵³ + 2⁻¹⁰⁶ lies above the half between 1 and the next double; added one by one it stays 1.
  const double half = std::ldexp(1.0, -53), tiny = std::ldexp(1.0, -106);
  std::vector<double> terms = {1, half, tiny, 1e30, -1e30};
  std::sort(terms.begin(), terms.end());
  do {
    ExactSum sum;
    for (const double term : terms) sum += term;
    EXPECT_EQ(sum.value(), 1 + std::ldexp(1.0, -52));
  } while (std::next_permutation(terms.begin(), terms.end()));
  EXPECT_EQ(ExactSum().value(), 0);
}

TEST(ExactSum, OfPartsIsThatOfTheWhole) {
  std::uint64_t state = 1;
  std::vector<double> terms;
  for (int k = 0; k < 1000; ++k) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    terms.push_back(std::ldexp(static_cast<double>(state >> 11U), -static_cast<int>(state % 90)));
  }
  ExactSum whole, first, second;
  for (std::size_t k = 0; k < terms.size(); ++k) whole += terms[k], (k < 333 ? first : second) += terms[k];
  ExactSum merged(first.parts());
  merged += ExactSum(second.parts());
  EXPECT_EQ(merged.value(), whole.value());
}

// --- Ranges ---

std::vector<FrameRange> all_parts(const FrameRange& whole, int of, const std::vector<double>& costs = {}) {
  std::vector<FrameRange> parts;
  for (int index = 0; index < of; ++index) parts.push_back(part_of(whole, {index, of}, costs));
  return parts;
}

TEST(ShardRange, ManyPartsHoldEachFrameOnce) {
  for (const int frames : {1, 2, 7, 40})
    for (const int of : {1, 2, 3, 7, 39, 40, 41, 1000}) {
      const FrameRange whole{5, 4 + frames};
      int next = whole.first, largest = 0, least = frames;
      for (const FrameRange& part : all_parts(whole, of)) {
        const int length = part.last - part.first + 1;
        EXPECT_GE(length, 0);
        if (length > 0) {
          EXPECT_EQ(part.first, next);
        }
        next += length;
        largest = std::max(largest, length), least = std::min(least, length);
      }
      EXPECT_EQ(next, whole.last + 1) << frames << " in " << of;
      EXPECT_LE(largest - least, 1) << frames << " in " << of;
    }
}

/// By hand: costs 6 1 1 1 1 1 1 in two are 6 | 6; in three, 4 each, the dear frame is alone.
TEST(ShardRange, ByCostSharesOutTheCost) {
  const std::vector<double> costs = {6, 1, 1, 1, 1, 1, 1};
  const std::vector<FrameRange> two = all_parts({0, 6}, 2, costs);
  EXPECT_EQ(two[0].last, 0);
  EXPECT_EQ(two[1].first, 1);
  EXPECT_EQ(two[1].last, 6);
  const std::vector<FrameRange> three = all_parts({0, 6}, 3, costs);
  EXPECT_EQ(three[0].last, 0);
  EXPECT_EQ(three[1].first, 1);
  EXPECT_EQ(three[1].last, 2);
  EXPECT_EQ(three[2].last, 6);
  // Frames that cost nothing are shared out as they are many.
  EXPECT_EQ(part_of({0, 3}, {1, 2}, {0, 0, 0, 0}).first, 2);
}

TEST(ShardName, IsReadStrictly) {
  EXPECT_EQ(shard_from("3/16", "/"), (Shard{3, 16}));
  for (const char* text :
       {"", "/", "3", "16/16", "-1/4", "03/16", "3/016", "3/16x", " 3/16", "3/0", "0/100001"})
    EXPECT_FALSE(shard_from(text, "/")) << text;
}

// --- Merged runs ---

/// Every file below a folder but for what may differ, by its path.
std::map<std::string, std::string> files_of(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    const bool differs =
        name == "timing.jsonl" || name == ".lock" || name == "report.html" || name.rfind("shards", 0) == 0;
    if (entry.is_regular_file() && !differs) files[name] = content(entry.path().string());
  }
  return files;
}

void expect_same_files(const std::string& a, const std::string& b, const std::string& what) {
  const auto first = files_of(a), second = files_of(b);
  std::vector<std::string> names_a, names_b;
  for (const auto& [name, bytes] : first) names_a.push_back(name);
  for (const auto& [name, bytes] : second) names_b.push_back(name);
  EXPECT_EQ(names_a, names_b) << what;
  for (const auto& [name, bytes] : first)
    if (second.contains(name)) {
      EXPECT_TRUE(bytes == second.at(name)) << what << ": " << name;
    }
}

class Shards : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    std::string passing = kPassing;
    write("passing.yaml", passing);
    line_.sequence = path("passing.yaml");
    line_.size = "96x72";
    line_.frames = "2-19";
    line_.quiet = line_.no_report = true;
  }

  int render(CommandLine line, const std::string& out, const std::string& shard = "",
             bool plan = false) const {
    line.out = path(out);
    line.shard = shard;
    std::ostringstream said;
    const std::atomic<bool> stop = false;
    return run_sequence(line, plan, stop, said);
  }
  void render_shards(const CommandLine& line, const std::string& out, int of, bool plan = false) const {
    for (int index = of - 1; index >= 0; --index)  // in any order
      EXPECT_EQ(render(line, out, std::to_string(index) + "/" + std::to_string(of), plan), 0);
  }

  CommandLine line_;
};

TEST_F(Shards, OfEveryPolicyMergeToTheBytesOfOneRun) {
  for (const char* policy :
       {"direct", "reference", "hold", "interpolate", "threshold", "budget", "lookahead", "oracle"}) {
    CommandLine line = line_;
    line.policy = policy;
    if (line.policy == "budget") line.budget_polygons = 300;
    const std::string one = std::string("one-") + policy, many = std::string("many-") + policy;
    ASSERT_EQ(render(line, one), 0) << policy;
    render_shards(line, many, 4);
    const Merged merged = merge_shards(path(many), false);
    EXPECT_EQ(merged.shards, 4);
    expect_same_files(path(one), path(many), policy);
  }
}

TEST_F(Shards, OfEveryOptionMergeToTheBytesOfOneRun) {
  CommandLine line = line_;
  line.separate = line.overlay = line.quality = true;
  line.compression = 85;
  line.decisions = "changed";
  line.frames = "0-9";
  ASSERT_EQ(render(line, "one"), 0);
  render_shards(line, "many", 3);
  merge_shards(path("many"), false);
  expect_same_files(path("one"), path("many"), "options");
  line = line_;
  line.late_chunks = "on";
  line.blend = 3;
  line.format = "exr";
  ASSERT_EQ(render(line, "late-one"), 0);
  render_shards(line, "late-many", 5);
  merge_shards(path("late-many"), false);
  expect_same_files(path("late-one"), path("late-many"), "late chunks, fades");
}

TEST_F(Shards, OfAPlanMergeAndAreCutByAPlansCosts) {
  CommandLine line = line_;
  line.frames.clear();
  ASSERT_EQ(render(line, "plan", "", true), 0);
  render_shards(line, "many", 7, true);
  merge_shards(path("many"), false);
  expect_same_files(path("plan"), path("many"), "plan");
  line.shard_plan = path("plan");
  ASSERT_EQ(render(line, "by-cost", "1/2", true), 0);
  const auto shard = read_shard_file(path("by-cost/shards/1-of-2"));
  ASSERT_TRUE(shard);
  EXPECT_GT(shard->range.first, 0);
  EXPECT_EQ(shard->range.last, 39);
  // A plan with other options has other costs.
  line.geometric_px = 1;
  EXPECT_THAT(
      message_of([&] { render(line, "by-cost", "0/2", true); }),
      HasSubstr("holds another run: geometric_px was 4.0, is 1.0, rule: a plan with the same options"));
}

TEST_F(Shards, MoreThanThereAreFramesAreEmptyAndMerge) {
  CommandLine line = line_;
  line.frames = "3-5";
  ASSERT_EQ(render(line, "one"), 0);
  render_shards(line, "many", 8);
  EXPECT_EQ(merge_shards(path("many"), false).shards, 8);
  expect_same_files(path("one"), path("many"), "empty");
}

TEST_F(Shards, WithAReportMergeToAllThatItIsMadeOf) {
  if (!has_report()) GTEST_SKIP() << "this build has no report";
  CommandLine line = line_;
  line.no_report = false;
  ASSERT_EQ(render(line, "one"), 0);
  render_shards(line, "many", 3);
  merge_shards(path("many"), false);
  const auto files = files_of(path("many"));
  EXPECT_TRUE(files.contains("what-if.json") && files.contains("changes.jsonl"));
  EXPECT_TRUE(fs::exists(path("many/report.html")));
  expect_same_files(path("one"), path("many"), "report");
}

/// As a machine that goes away: whatever instant it is killed at, the shard goes on where it was.
TEST_F(Shards, KilledAndResumedMergeToTheBytesOfOneRun) {
  ASSERT_EQ(render(line_, "one"), 0);
  for (int index = 0; index < 3; ++index) {
    const std::string shard = std::to_string(index) + "-of-3";
    const std::string words =
        "render passing.yaml --size 96x72 --frames 2-19 --no-report --quiet --out many --shard " +
        std::to_string(index) + "/3";
    const int second = 2 + 6 * index + 1;
    run_and_signal(words, formatted("many/shards/%s.partial/frames/%04d.png", shard.c_str(), second),
                   SIGKILL);
    EXPECT_FALSE(fs::exists(path("many/shards/" + shard)));
    if (index == 1) {
      EXPECT_THAT(message_of([&] { merge_shards(path("many"), false); }),
                  HasSubstr("1-of-3 is unfinished, 2-of-3 is missing"));
    }
    const Outcome resumed = run(words + " --resume");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
  }
  merge_shards(path("many"), false);
  expect_same_files(path("one"), path("many"), "killed");
  const Outcome again =
      run("render passing.yaml --size 96x72 --frames 2-19 --no-report --out many --shard 1/3 --resume");
  EXPECT_THAT(again.output, HasSubstr("shard 1 of 3, frames 8-13: complete already"));
}

class RefusedShards : public Shards {
 protected:
  void SetUp() override {
    Shards::SetUp();
    line_.frames = "0-7";
    render_shards(line_, "out", 4);
  }
  std::string refused(bool allow_partial = false) const {
    const Outcome outcome = run(std::string("merge out") + (allow_partial ? " --allow-partial" : ""));
    EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    return outcome.output;
  }
};

TEST_F(RefusedShards, AreNamedWithWhatIsWrong) {
  fs::rename(path("out/shards/2-of-4"), path("aside"));
  EXPECT_THAT(refused(), HasSubstr("out: 2-of-4 is missing, rule: all shards of one run"));
  fs::rename(path("aside"), path("out/shards/2-of-4"));

  const std::string picture = read("out/shards/1-of-4/frames/0003.png");
  std::string changed = picture;
  changed[changed.size() / 2] ^= 1;
  fs::remove(path("out/shards/1-of-4/frames/0003.png"));
  write("out/shards/1-of-4/frames/0003.png", changed);
  EXPECT_THAT(refused(), HasSubstr("1-of-4 is damaged (frames/0003.png)"));
  write("out/shards/1-of-4/frames/0003.png", picture);

  const std::string shard = read("out/shards/3-of-4/shard.json");
  write("out/shards/3-of-4/shard.json", shard.substr(0, shard.size() / 2));
  EXPECT_THAT(refused(), HasSubstr("3-of-4 is damaged (shard.json)"));
  std::string older = shard;
  older.replace(older.find("\"version\":\"") + 11, 1, "9");
  write("out/shards/3-of-4/shard.json", older);
  EXPECT_THAT(refused(), HasSubstr("3-of-4 is of version 9"));
  EXPECT_THAT(refused(true), HasSubstr("3-of-4 is of version 9"));
  write("out/shards/3-of-4/shard.json", shard);
  EXPECT_EQ(run("merge out --quiet").exit_code, 0);
}

TEST_F(RefusedShards, OfAnotherRunOrAnotherNumberOrTwiceAreNotJoined) {
  CommandLine other = line_;
  other.geometric_px = 1;
  render(other, "other", "1/4");
  fs::remove_all(path("out/shards/1-of-4"));
  fs::rename(path("other/shards/1-of-4"), path("out/shards/1-of-4"));
  EXPECT_THAT(refused(), HasSubstr("1-of-4 is foreign (geometric_px was 4.0, is 1.0)"));
  EXPECT_THAT(refused(true), HasSubstr("foreign"));
  fs::remove_all(path("out/shards/1-of-4"));
  fs::copy(path("out/shards/2-of-4"), path("out/shards/1-of-4"), fs::copy_options::recursive);
  EXPECT_THAT(refused(), HasSubstr("1-of-4 is foreign (it is 2-of-4)"));
  fs::remove_all(path("out/shards/1-of-4"));
  render(line_, "out", "1/4");
  render(line_, "out", "1/3");
  EXPECT_THAT(refused(), HasSubstr("shards of 3 and of 4"));
  fs::remove_all(path("out/shards/1-of-3"));
  // Cut by other costs, a frame lies in two.
  std::string shard = read("out/shards/2-of-4/shard.json");
  const std::string frames = "\"frames\":[4,5]";
  ASSERT_NE(shard.find(frames), std::string::npos);
  shard.replace(shard.find(frames), frames.size(), "\"frames\":[3,5]");
  write("out/shards/2-of-4/shard.json", shard);
  EXPECT_THAT(refused(), HasSubstr("2-of-4 has frame 3, which a shard before it has, too"));
  fs::create_directory(path("out/shards/holiday"));
  EXPECT_THAT(refused(), HasSubstr("holiday is no shard"));
}

/// What is there can be looked at; the same run with --resume draws the rest, and is the run that it would have been.
TEST_F(RefusedShards, ThatAreMissingCanBeLeftOutAndDrawnLater) {
  fs::remove_all(path("out/shards/1-of-4"));
  EXPECT_THAT(refused(true), HasSubstr("out: without 1 shard (1-of-4 is missing)"));
  EXPECT_FALSE(fs::exists(path("out/summary.json")));
  EXPECT_EQ(files_in("out/frames").size(), 6u);
  CommandLine line = line_;
  line.resume = true;
  ASSERT_EQ(render(line, "out"), 0);
  ASSERT_EQ(render(line_, "one"), 0);
  expect_same_files(path("one"), path("out"), "left out");
}

TEST_F(RefusedShards, DamagedAreMadeAgainByResume) {
  fs::remove(path("out/shards/1-of-4/frames/0002.png"));
  CommandLine line = line_;
  line.resume = true;
  EXPECT_EQ(render(line, "out", "1/4"), 0);
  merge_shards(path("out"), false);
  ASSERT_EQ(render(line_, "one"), 0);
  expect_same_files(path("one"), path("out"), "made again");
}

TEST_F(RefusedShards, OptionsOfShardsHaveNoMeaningWithoutThem) {
  expect_bad_input("render passing.yaml --shard 4/4", {"--shard is '4/4', rule: i/N with 0 <= i < N"});
  expect_bad_input("plan passing.yaml --plan out", {"--plan shares out the frames of --shard"});
  expect_bad_input("plan passing.yaml --resume", {"--resume of a plan is about its --shard"});
  expect_bad_input("render passing.yaml --shard 0/4 --audit 2", {"--audit takes every so many reuses"});
  expect_bad_input("merge nowhere", {"nowhere: holds no shards"});
}

/// Most are empty: what a merge costs beside the bytes.
TEST(ManyShards, MergeInSeconds) {
  const TemporaryFolder folder;
  const std::string yaml = folder.write("s.yaml",
                                        "frames: 120\nfps: 10\ndisplay: [16, 16]\n"
                                        "shapes: [{id: box, box: [1, 1, 1], spin: {deg_per_s: 90}}]\n"
                                        "camera: {position: [0, 0, 5], look_at: [0, 0, 0]}\n");
  CommandLine line;
  line.sequence = yaml;
  line.out = folder / "out";
  line.quiet = line.no_report = true;
  const std::atomic<bool> stop = false;
  std::ostringstream said;
  for (int index = 0; index < 1000; ++index) {
    line.shard = std::to_string(index) + "/1000";
    ASSERT_EQ(run_shard(line, true, stop, said), 0);
  }
  const std::clock_t before = std::clock();
  EXPECT_EQ(merge_shards(line.out, false).shards, 1000);
  EXPECT_LE(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 5);
  line.shard.clear();
  line.out = folder / "one";
  ASSERT_EQ(run_sequence(line, true, stop, said), 0);
  expect_same_files(folder / "one", folder / "out", "a thousand");
}

}  // namespace
}  // namespace talisman::sequences
