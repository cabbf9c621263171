// SPDX-License-Identifier: Apache-2.0
// What the live view answers is what the tool prints for the same settings.
#include "sequences/commands/view.h"

#include <atomic>

#include "sequences/commands/run_words.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/view/live_view.h"
#include "sequences/view/view_request.h"
#include "tests/sequences/commands/tool.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

class View : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
  }
  std::unique_ptr<LiveView> opened(const std::string& file, const std::vector<std::string>& given = {}) {
    ViewOptions options;
    options.line = command_line_from(path(file), given, false);
    options.line.out = path("out");
    options.given = given;
    return std::make_unique<LiveView>(view_source(options), stop_);
  }
  static std::string body(Json request) {
    static int count = 0;
    request["tab"] = "tab";
    request["request"] = ++count;
    return request.dump();
  }
  static Json answer(const ViewAnswer& answer, int status = 200) {
    EXPECT_EQ(answer.status, status) << answer.body.substr(0, 200);
    return Json::parse(answer.body);
  }
  std::string planned(const std::string& options, const std::string& file = "passing.yaml") {
    const Outcome outcome = run("plan " + file + " --out p --force --quiet " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return read("p/decisions.jsonl");
  }
  /// The plan, asked for slice by slice as the page does.
  static Json slices(LiveView& view, const Json& settings) {
    Json all = Json::object();
    for (int from = 0;;) {
      const Json slice = answer(view.plan(body({{"settings", settings}, {"from", from}})));
      for (const auto& [name, list] : slice["decisions"].items())
        for (const Json& value : list) all[name].push_back(value);
      from = slice["planned"];
      if (from == slice["frames"]) return all;
    }
  }

  std::atomic<bool> stop_ = false;
};

TEST_F(View, PlansWhatThePlanCommandPrints) {
  const auto view = opened("passing.yaml");
  const std::vector<std::pair<Json, std::string>> cases = {
      {Json::object(), ""},
      {{{"geometric-px", 40}}, "--geometric-px 40"},
      {{{"geometric-px", "0"}}, "--geometric-px 0"},
      {{{"policy", "hold"}, {"hold", 5}}, "--policy hold --hold 5"},
      {{{"policy", "lookahead"}, {"lookahead", 12}}, "--policy lookahead --lookahead 12"},
      {{{"policy", "budget"}, {"budget-polygons", 40}}, "--policy budget --budget-polygons 40"},
      {{{"warp", "iso"}, {"bound", "dop26"}}, "--warp iso --bound dop26"},
      {{{"compositor", "extended"}}, "--compositor extended"},
      {{{"shadow-map-px", 3}, {"size", "320x240"}}, "--shadow-map-px 3 --size 320x240"},
      {{{"regroup", "amortised"}, {"regroup-dwell", 2}}, "--regroup amortised --regroup-dwell 2"},
      {{{"visibility", "none,none,frustum"}}, "--visibility none,none,frustum"},
      {Json::object(), ""}};
  std::set<std::string> plans;
  for (const auto& [settings, words] : cases) {
    const std::string plan = planned(words);
    EXPECT_TRUE(view->lines(body({{"settings", settings}})).body == plan) << words;
    plans.insert(plan);
  }
  EXPECT_GE(plans.size(), 6u);  // settings change what is planned
  const Outcome outcome =
      run("render passing.yaml --out r --quiet --no-report --format none --size 160x120 --resolution 0.5");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(view->lines(body({{"settings", {{"size", "160x120"}, {"resolution", 0.5}}}})).body ==
              read("r/decisions.jsonl"));
}

TEST_F(View, PlansPartsInSharedBuffersAsThePlanCommandDoes) {
  std::string plain = kPassing;  // without shadows, which have sprites of their own
  for (const std::string of_shadows : {", casts_shadow: true", ", shading: {shadows: {}}"})
    plain.erase(plain.find(of_shadows), of_shadows.size());
  write("plain.yaml", plain);
  const auto view = opened("plain.yaml");
  const Json settings = {
      {"policy", "predictive"}, {"lookahead", 8}, {"tree-k", 2}, {"joining", "copy"}, {"hold", 3}};
  const std::string plan =
      planned("--policy predictive --lookahead 8 --tree-k 2 --joining copy", "plain.yaml");
  EXPECT_TRUE(view->lines(body({{"settings", settings}})).body == plan);
  EXPECT_FALSE(plan.empty());
  const Json frame = answer(view->frame(body({{"settings", settings}, {"frame", 17}})))["columns"];
  EXPECT_EQ(frame["layer"].size(), 2u);
  const ViewAnswer picture = view->picture(body({{"settings", settings}, {"frame", 17}, {"mode", "shown"}}));
  EXPECT_EQ(picture.status, 200) << picture.body.substr(0, 200);
}

TEST_F(View, PicturesOfSpritesAreRefusedWhereThereAreNone) {
  const auto view = opened("passing.yaml");
  for (const std::string mode : {"age", "depth"}) {
    const Json request = {{"settings", {{"policy", "direct"}}}, {"frame", 3}, {"mode", mode}};
    EXPECT_EQ(answer(view->picture(body(request)), 422)["error"],
              "policy is 'direct', must be one with sprites: '" + mode + "' is a picture of them");
    EXPECT_EQ(view->picture(body({{"frame", 3}, {"mode", mode}})).status, 200);
  }
}

TEST_F(View, EveryOptionThatThePageMaySetHasAControl) {
  CLI::App command;
  CommandLine line;
  add_decision_options(command, line, "flights", "out");
  add_drawing_options(command, line);
  const std::vector<ViewControl> controls = view_controls(command);
  std::set<std::string> shown;
  for (const ViewControl& control : controls) shown.insert(control.option);
  EXPECT_EQ(shown, std::set<std::string>(settable_options().begin(), settable_options().end()));
  for (const ViewControl& control : controls) {
    if (control.option == "samples") {
      EXPECT_THAT(control.words, testing::ElementsAre("1", "4", "16"));
    }
    if (control.option == "visibility") {
      EXPECT_THAT(control.words, testing::Contains("cto,eye,eye"));
    }
  }
}

TEST_F(View, SlicesAndFramesHoldTheNumbersOfTheLines) {
  const auto view = opened("passing.yaml");
  planned("--geometric-px 2");
  const Json slices = this->slices(*view, {{"geometric-px", 2}});
  std::vector<Json> lines;
  for (const std::string& text : this->lines("p/decisions.jsonl")) lines.push_back(Json::parse(text));
  ASSERT_EQ(slices["frame"].size(), lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (const char* name : {"frame", "layer", "decision", "reason", "geometric_px"})
      EXPECT_EQ(slices[name][k], lines[k].value(name, Json())) << name << " of line " << k;
    EXPECT_EQ(slices["cost_polygons"][k], lines[k]["cost"]["polygons"]);
    EXPECT_EQ(slices["cost_pixels"][k], lines[k]["cost"]["pixels"]);
  }
  const Json frame =
      answer(view->frame(body({{"settings", {{"geometric-px", 2}}}, {"frame", 17}})))["columns"];
  std::size_t at = 0;
  for (const Json& line : lines) {
    if (line["frame"] != 17) continue;
    EXPECT_EQ(frame["layer"][at], line["layer"]);
    EXPECT_EQ(frame["warp_x"][at], line["warp"][2]);
    const bool has_sprite = line.contains("sprite") && !line["sprite"].is_null();
    EXPECT_EQ(frame["sprite_width"][at], has_sprite ? line["sprite"]["size"][0] : Json());
    ++at;
  }
  EXPECT_EQ(frame["layer"].size(), at);
  EXPECT_GE(at, 3u);
}

TEST_F(View, OptionsOfTheCommandLineHoldUntilThePageSaysOtherwise) {
  const auto view = opened("passing.yaml", {"--geometric-px=1.5", "--policy=lookahead"});
  EXPECT_EQ(view->lines(body(Json::object())).body, planned("--geometric-px 1.5 --policy lookahead"));
  EXPECT_EQ(view->lines(body({{"settings", {{"policy", "threshold"}}}})).body,
            planned("--geometric-px 1.5 --policy threshold"));
  EXPECT_EQ(view->lines(body({{"settings", {{"policy", "hold"}}}})).body, planned("--policy hold"));
}

// The page has the controls of all policies, whichever is chosen; the command line is told of a slip.
TEST_F(View, WhatThePolicyDoesNotReadIsLeftOut) {
  const auto view = opened("passing.yaml");
  const Json settings = {
      {"geometric-px", 1.5}, {"budget-ms", 3}, {"policy", "hold"}, {"hold", 5}, {"lookahead", 4}};
  EXPECT_EQ(view->lines(body({{"settings", settings}})).body, planned("--policy hold --hold 5"));
  expect_bad_input("view passing.yaml --policy hold --geometric-px 2",
                   {"--geometric-px is no option of policy hold"});
}

TEST_F(View, AnInvalidSettingIsTheToolsOwnLineAndKeepsThePlan) {
  const auto view = opened("passing.yaml");
  const Json request = {{"settings", {{"geometric-px", 2}}}};
  const std::string before = view->lines(body(request)).body;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"geometric-px", "-4"}, {"geometric-px", "four"}, {"policy", "thresold"},
      {"bound", "ball"},      {"warp", "bent"},         {"size", "0x0"}};
  for (const auto& [option, value] : cases) {
    const Json line = answer(view->plan(body({{"settings", {{option, value}}}})), 422);
    const Outcome outcome = run("plan passing.yaml --out q --force --quiet --" + option + "=" + value);
    EXPECT_EQ(outcome.exit_code, 2) << option;
    EXPECT_EQ("error: " + line.value("error", "") + "\n", outcome.output) << option;
  }
  EXPECT_EQ(view->lines(body(request)).body, before);
}

TEST_F(View, PicturesAreThoseOfTheRun) {
  const auto view = opened("passing.yaml");
  const std::string size = "--size 160x120 --geometric-px 2";
  const Outcome outcome = run("render passing.yaml --out r --frames 0-9 --quiet --no-report " + size);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const Json settings = {{"size", "160x120"}, {"geometric-px", 2}};
  // Forwards, back, and the same again.
  for (const int frame : {0, 1, 7, 3, 3, 9}) {
    const ViewAnswer png = view->picture(body({{"settings", settings}, {"frame", frame}}));
    ASSERT_EQ(png.status, 200) << png.body;
    EXPECT_EQ(png.type, "image/png");
    EXPECT_EQ(png.body, read("r/frames/000" + std::to_string(frame) + ".png")) << frame;
  }
  for (const char* mode : {"direct", "beside", "difference", "flip", "overlay", "age", "depth"})
    EXPECT_EQ(view->picture(body({{"settings", settings}, {"frame", 9}, {"mode", mode}})).status, 200)
        << mode;
  EXPECT_EQ(view->picture(body({{"mode", "nonsense"}})).status, 422);
  EXPECT_EQ(view->picture(body({{"frame", 40}})).status, 422);
}

TEST_F(View, WhatWasAskedBeforeIsStale) {
  const auto view = opened("passing.yaml");
  answer(view->plan(R"({"tab": "a", "request": 7, "settings": {"geometric-px": 2}})"));
  answer(view->plan(R"({"tab": "a", "request": 6})"), 409);
  answer(view->plan(R"({"tab": "b", "request": 6})"));
  EXPECT_EQ(view->picture(R"({"tab": "a", "request": 9})").status, 200);
  EXPECT_EQ(view->picture(R"({"tab": "a", "request": 8})").status, 409);
}

TEST_F(View, EffectsGoOffOneByOne) {
  const auto view = opened("passing.yaml");
  const Json about = answer(view->about());
  std::set<std::string> names;
  for (const Json& effect : about["effects"]) names.insert(effect["name"]);
  ASSERT_TRUE(names.contains("shadow_map")) << about["effects"];
  const std::string with = view->lines(body(Json::object())).body;
  EXPECT_THAT(with, HasSubstr("shadow map of lamp"));
  EXPECT_THAT(view->lines(body({{"without", {"shadow_map"}}})).body,
              testing::Not(HasSubstr("shadow map of lamp")));
  EXPECT_EQ(view->lines(body(Json::object())).body, with);
}

// What the policy does with a flown camera is what it does with the file that the flight is saved as.
TEST_F(View, ASavedFlightIsPlannedAsItWasFlown) {
  const auto view = opened("passing.yaml");
  Json flight = Json::array();
  for (int f = 0; f < 12; ++f) flight.push_back({2 + 0.3 * f, 1, 12 - 0.7 * f, 0.1 * f, 0, 0});
  const std::string flown = view->lines(body({{"flight", flight}})).body;
  const Json saved = answer(view->save(body({{"flight", flight}, {"name", "dive"}})));
  EXPECT_EQ(saved["file"], path("out") + "/dive.yaml");
  EXPECT_EQ(planned("", "out/dive.yaml"), flown);
  // Though the camera was dragged to it, and another plan was made on the way.
  const Json settings = {{"size", "160x120"}};
  for (int f = 1; f <= 12; ++f) {
    const Json part(flight.begin(), flight.begin() + f);
    const Json request = {{"settings", settings}, {"flight", part}, {"frame", f - 1}, {"scale", 0.5}};
    EXPECT_EQ(view->picture(body(request)).status, 200);
    answer(view->plan(body({{"settings", settings}, {"flight", part}})));
  }
  EXPECT_EQ(view->lines(body({{"flight", flight}})).body, flown);
  const Outcome outcome = run("render out/dive.yaml --size 160x120 --frames 11 --quiet --no-report --out d");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const ViewAnswer png = view->picture(body({{"settings", settings}, {"flight", flight}, {"frame", 11}}));
  EXPECT_TRUE(png.body == read("d/frames/0011.png"));
  // Never over a file that is there, and nowhere else.
  const std::string before = read("out/dive.yaml");
  answer(view->save(body({{"flight", flight}, {"name", "dive"}})), 422);
  for (const char* name : {"", ".", "..", "../x", "a/b", "/tmp/x", "a.yaml", "a b", "\xc3\xa4"})
    answer(view->save(body({{"flight", flight}, {"name", name}})), 422);
  answer(view->save(body({{"name", "none"}})), 422);
  EXPECT_EQ(read("out/dive.yaml"), before);
  EXPECT_EQ(files_in("out"), std::set<std::string>{"dive.yaml"});
}

// A name of a file is data wherever it stands.
TEST_F(View, AFlightExtendsAFileOfAnyName) {
  const std::string name = "a\nframes: 3\n\"b\\ #.yaml";
  write(name, kPassing);
  const auto view = opened(name);
  const Json flight = {{2, 1, 12, 0, 0, 0}, {2, 1, 11, 0, 0, 0}};
  answer(view->save(body({{"flight", flight}, {"name", "dive"}})));
  EXPECT_EQ(planned("", "out/dive.yaml"), view->lines(body({{"flight", flight}})).body);
}

TEST_F(View, ASceneThatCannotBeReadIsAFault) {
  const auto view = opened("missing.yaml");
  EXPECT_THAT(answer(view->about(), 422)["error"].get<std::string>(), HasSubstr("missing.yaml"));
}

TEST_F(View, EndsOnCtrlC) {
  if (!has_report()) GTEST_SKIP() << "this build has no live view";
  write("wait.sh", "'" + tool() +
                       "' view passing.yaml > said & pid=$!\n"
                       "while ! grep -qs token said; do sleep 0.01; done\nkill -INT $pid\nwait $pid\n");
  const Outcome outcome = run_shell("timeout 60 bash wait.sh");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.output, "");
  EXPECT_THAT(read("said"), HasSubstr("http://127.0.0.1:"));
  EXPECT_TRUE(files_in("out").empty());  // nobody saved anything
  expect_bad_input("view passing.yaml --port 70000", {"--port", "70000"});
  expect_bad_input("view passing.yaml --port x", {"--port"});
}

}  // namespace
}  // namespace talisman::sequences
