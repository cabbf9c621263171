// SPDX-License-Identifier: Apache-2.0
// A trace against the decisions that it is made from.
#include <cmath>
#include <map>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using Json = nlohmann::json;

class Trace : public Tool {
 protected:
  /// A run of a scene whose layers are merged and split again.
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
    ASSERT_EQ(run("render passing.yaml --size 96x72 --progress none --format none --out o").exit_code, 0);
  }
  Json trace(const std::string& options) {
    const Outcome outcome = run("export o --trace" + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_EQ(outcome.output, "wrote trace.json in o\n");
    return Json::parse(read("o/trace.json"), nullptr, false);
  }
  static std::map<int, std::string> tracks(const Json& trace) {
    std::map<int, std::string> names;
    for (const Json& event : trace["traceEvents"])
      if (event["name"] == "thread_name" && event["pid"] == 1) names[event["tid"]] = event["args"]["name"];
    return names;
  }
};

/// What the format's description asks of each kind of event.
TEST_F(Trace, EventsHaveTheFieldsOfTheFormat) {
  const Json t = trace("");
  ASSERT_TRUE(t.is_object());
  ASSERT_GT(t["traceEvents"].size(), 100u);
  for (const Json& event : t["traceEvents"]) {
    ASSERT_TRUE(event["ph"].is_string() && event["pid"].is_number_integer()) << event;
    ASSERT_TRUE(event["tid"].is_number_integer() && event["name"].is_string()) << event;
    const std::string phase = event["ph"];
    EXPECT_NE(std::string("MXCsf").find(phase), std::string::npos) << event;
    const auto whole = [&](const char* name) { return event[name].is_number_integer() && event[name] >= 0; };
    EXPECT_TRUE(phase == "M" || whole("ts")) << event;
    EXPECT_TRUE(phase != "X" || whole("dur")) << event;
    EXPECT_TRUE((phase != "s" && phase != "f") || (whole("id") && event.contains("cat"))) << event;
    for (const Json& value : phase == "C" ? event["args"] : Json::array())
      EXPECT_TRUE(value.is_number()) << event;
  }
}

TEST_F(Trace, TracksAreTheLayersInTheirOrder) {
  const Json summary = Json::parse(read("o/summary.json"));
  const std::map<int, std::string> names = tracks(trace(""));
  std::vector<std::string> expected = {"frames"}, found;
  for (const Json& layer : summary["layers"]) expected.push_back(layer["name"]);
  for (const auto& [track, name] : names) found.push_back(name);
  ASSERT_GT(found.size(), 3u) << "an aggregate must have been there";
  EXPECT_EQ(std::vector(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(expected.size())),
            expected);
}

TEST_F(Trace, SlicesOfATrackNeverOverlapAndShowEveryRender) {
  const Json t = trace("");
  const std::map<int, std::string> names = tracks(t);
  std::map<std::pair<int, int>, std::map<std::int64_t, std::int64_t>> slices;
  std::map<std::pair<std::string, int>, Json> drawn;
  for (const Json& event : t["traceEvents"]) {
    if (event["ph"] != "X") continue;
    auto& track = slices[{event["pid"], event["tid"]}];
    EXPECT_TRUE(track.emplace(event["ts"], event["dur"]).second || event["dur"] == 0) << event;
    if (event["cat"] == "drawn")
      drawn[{names.at(event["tid"]), event["ts"].get<int>() / 1000000}] = event["args"];
  }
  for (const auto& [track, of_track] : slices) {
    std::int64_t end = 0;
    for (const auto& [begin, duration] : of_track) {
      EXPECT_GE(begin, end) << track.first << " " << track.second;
      end = begin + duration;
    }
  }
  std::size_t renders = 0;
  for (const std::string& line : lines("o/decisions.jsonl")) {
    const Json decision = Json::parse(line);
    if (decision["decision"] != "rerender") continue;
    ++renders;
    const auto slice = drawn.find({decision["layer"], decision["frame"]});
    ASSERT_NE(slice, drawn.end()) << line;
    EXPECT_EQ(slice->second["reason"], decision["reason"]);
    EXPECT_EQ(slice->second["fiducials"], decision["fiducials"]);
    EXPECT_EQ(slice->second["cost"], decision["cost"]);
  }
  EXPECT_EQ(drawn.size(), renders);
}

TEST_F(Trace, WithoutTimingItHasTheSameBytesEverywhere) {
  const Json timed = trace(""), untimed = trace(" --no-timing");
  const auto measured = [](const Json& t) {
    return std::count_if(t["traceEvents"].begin(), t["traceEvents"].end(),
                         [](const Json& event) { return event["pid"] == 2; });
  };
  // Plan and composite of each frame; what takes less than a microsecond, as drawing nothing may, is not there.
  EXPECT_GE(measured(timed), 40 * 2);
  EXPECT_EQ(measured(untimed), 0);
  const std::string first = read("o/trace.json");
  ASSERT_EQ(
      run("render passing.yaml --size 96x72 --progress none --format none --threads 1 --out o").exit_code, 0);
  trace(" --no-timing");
  EXPECT_EQ(read("o/trace.json"), first);
}

/// A look ahead draws sprites as of later frames: those arrows go from the life to the frame.
TEST_F(Trace, FlowsNeverRunBackwards) {
  ASSERT_EQ(run("plan passing.yaml --size 96x72 --policy lookahead --geometric-px 4 --progress none --out la")
                .exit_code,
            0);
  ASSERT_EQ(run("export la --trace --no-timing").exit_code, 0);
  const Json t = Json::parse(read("la/trace.json"));
  std::map<int, Json> starts;
  int flows = 0, to_frames = 0;
  for (const Json& event : t["traceEvents"]) {
    if (event["ph"] == "s") starts[event["id"]] = event;
    if (event["ph"] != "f") continue;
    ++flows;
    ASSERT_TRUE(starts.contains(event["id"]));
    EXPECT_LE(starts[event["id"]]["ts"], event["ts"]);
    EXPECT_EQ((starts[event["id"]]["tid"] == 1) + (event["tid"] == 1), 1) << "one end is a frame";
    to_frames += event["tid"] == 1;
  }
  EXPECT_GT(flows, 5);
  EXPECT_GT(to_frames, 0);
}

/// 30000/1001 frames a second is no whole number of microseconds: neighbours must meet all the same.
TEST_F(Trace, TimesAreRoundedToMicroseconds) {
  std::string yaml = kPassing;
  yaml.replace(yaml.find("fps: 1"), 6, "fps: 29.97");
  write("ntsc.yaml", yaml);
  ASSERT_EQ(run("plan ntsc.yaml --size 96x72 --frames 0-9 --progress none --out n").exit_code, 0);
  ASSERT_EQ(run("export n --trace").exit_code, 0);
  const Json t = Json::parse(read("n/trace.json"));
  int frames = 0;
  for (const Json& event : t["traceEvents"]) {
    if (event["ph"] != "X" || event["cat"] != "frame") continue;
    const std::int64_t begin = std::llround(frames * 1e6 / 29.97), end = std::llround(++frames * 1e6 / 29.97);
    EXPECT_EQ(event["ts"], begin);
    EXPECT_EQ(event["dur"], end - begin);
  }
  EXPECT_EQ(frames, 10);
}

TEST_F(Trace, OfDamagedLinesIsOneErrorLine) {
  const std::string decisions = read("o/decisions.jsonl");
  write("o/decisions.jsonl", "{\"schema\":\"talisman.decision/1\",\"frame\":0,\"layer\":7}\n");
  expect_bad_input("export o --trace", {"o", "not as the run wrote them"});
  write("o/decisions.jsonl", decisions);
  std::filesystem::remove(folder_ / "o/run.json");
  expect_bad_input("export o --trace", {"o", "run.json"});
}

}  // namespace
}  // namespace talisman
