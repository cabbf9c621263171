// SPDX-License-Identifier: Apache-2.0
// What the page says of a run is what its files say: added up here a second time, line by line.
#include "sequences/results/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/profile.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/results/report/verdict.h"
#include "tests/sequences/commands/tool.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class Report : public Tool {
 protected:
  void SetUp() override {
    if (!has_report()) GTEST_SKIP() << "a build without the report";
    Tool::SetUp();
  }
  void plan(const std::string& out, const std::string& more = "") const {
    const Outcome outcome =
        run("plan carousel --frames 0-19 --size 160x120 --progress none --out " + out + " " + more);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  }
  std::vector<Json> lines(const std::string& file) const {
    std::vector<Json> all;
    std::istringstream in(read(file));
    for (std::string line; std::getline(in, line);) all.push_back(Json::parse(line));
    return all;
  }
  std::string page(const std::vector<std::string>& folders) const {
    std::vector<ReportRun> runs;
    for (const std::string& folder : folders) runs.push_back(read_report_run(path(folder), false));
    return report_html(runs);
  }
};

TEST_F(Report, SumsAreThoseOfTheFiles) {
  plan("o");
  const ReportRun run = read_report_run(path("o"), true);
  std::map<std::string, LayerCounts> layers;
  double largest_px = 0;
  for (const Json& line : lines("o/decisions.jsonl")) {
    LayerCounts& layer = layers[line["layer"]];
    ++(line["decision"] == "rerender" ? layer.renders
       : line["decision"] == "reuse"  ? layer.reuses
                                      : layer.drops);
    layer.polygons += line["cost"]["polygons"].get<double>();
    if (line["decision"] != "drop") largest_px = std::max(largest_px, line["geometric_px"].get<double>());
  }
  ASSERT_EQ(run.layers.size(), layers.size());
  for (const LayerCounts& layer : run.layers) {
    const LayerCounts& expected = layers.at(layer.name);
    EXPECT_EQ(layer.renders, expected.renders) << layer.name;
    EXPECT_EQ(layer.reuses, expected.reuses) << layer.name;
    EXPECT_EQ(layer.drops, expected.drops) << layer.name;
    EXPECT_EQ(layer.polygons, expected.polygons) << layer.name;
  }
  ASSERT_FALSE(run.worst.empty());
  EXPECT_EQ(run.worst[0].geometric_px, largest_px);
  EXPECT_LE(run.worst.size(), std::size_t{ReportRun::kWorst});
  EXPECT_TRUE(run.is_complete);
  EXPECT_TRUE(run.thumbnails.empty()) << "a plan has no pictures";
}

TEST_F(Report, TheVerdictSaysWhatReferenceWouldTake) {
  plan("o");
  const ReportRun run = read_report_run(path("o"), false);
  double ms = 0, reference_ms = 0;
  const auto frames = lines("o/frames.jsonl");
  for (const Json& line : frames) {
    ms += line["modelled_drawing_ms"].get<double>();
    reference_ms +=
        regulator::modelled_time(regulator::talisman_1996(), line["polygons_reference"].get<std::int64_t>(),
                                 line["pixels_reference"].get<std::int64_t>(), 0)
            .render_ms;
  }
  char words[100];
  std::snprintf(words, sizeof words, "modelled %.3g ms for drawing (reference %.3g ms) a frame", ms / 20,
                reference_ms / 20);
  EXPECT_THAT(verdict_on(run), HasSubstr(words));
  EXPECT_THAT(verdict_on(run), HasSubstr("picture error not measured"));
  EXPECT_LT(ms, reference_ms);
}

TEST_F(Report, TheVerdictNamesTheDearestLayer) {
  plan("o");
  std::map<std::string, double> texels;
  double all = 0;
  for (const Json& line : lines("o/decisions.jsonl")) {
    const double drawn = line["decision"] == "rerender" ? line["cost"]["pixels"].get<double>() : 0;
    texels[line["layer"]] += drawn, all += drawn;
  }
  const auto dearest = std::max_element(texels.begin(), texels.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  EXPECT_THAT(verdict_on(read_report_run(path("o"), false)),
              HasSubstr("; " + dearest->first + " is the most expensive layer, " +
                        percent_of(dearest->second, all) + " % of these texels"));
}

TEST_F(Report, OfReferenceTakesWhatReferenceTakes) {
  plan("o", "--policy reference");
  const ReportRun run = read_report_run(path("o"), false);
  EXPECT_NEAR(run.sums.modelled_drawing_ms, run.sums.modelled_reference_ms,
              1e-9 * run.sums.modelled_reference_ms);
}

TEST_F(Report, OfAKilledRunHasItsWholeLines) {
  plan("o");
  const std::string decisions = read("o/decisions.jsonl");
  const std::size_t half = decisions.find('\n', decisions.size() / 2) + 1;
  std::filesystem::remove(path("o/decisions.jsonl"));
  std::filesystem::remove(path("o/summary.json"));
  write("o/decisions.jsonl.partial", decisions.substr(0, half + 30));
  const ReportRun run = read_report_run(path("o"), false);
  EXPECT_FALSE(run.is_complete);
  EXPECT_EQ(run.decisions.rows(),
            static_cast<std::size_t>(
                std::count(decisions.begin(), decisions.begin() + static_cast<std::ptrdiff_t>(half), '\n')));
  EXPECT_THAT(verdict_on(run), HasSubstr("Not complete"));
}

TEST_F(Report, OfWhatIsNoRunIsRefusedInOneLine) {
  EXPECT_THROW(read_report_run(path("none"), false), InputError);
  std::filesystem::create_directories(path("empty"));
  EXPECT_THROW(read_report_run(path("empty"), false), InputError);
  plan("o");
  const std::string decisions = read("o/decisions.jsonl");
  write("o/decisions.jsonl", "{\"schema\": \"other/1\"}\n" + decisions);
  const Outcome outcome = run("report o");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("decisions.jsonl:1"));
  write("o/decisions.jsonl", decisions);
  write("o/changes.jsonl", "[]\n");
  EXPECT_THAT(run("report o").output, HasSubstr("changes.jsonl:1"));
}

TEST_F(Report, WordAmongTheNumbersOfAColumnIsNamedWithItsLine) {
  plan("o");
  std::string text = read("o/decisions.jsonl");
  const std::string key = "\"resolution\":";
  const std::size_t line_2 = text.find('\n') + 1, at = text.find(key, line_2) + key.size();
  text.replace(at, text.find_first_of(",}", at) - at, "\"old\"");
  write("o/decisions.jsonl", text);
  const Outcome refused = run("report o");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.output,
            "error: o/decisions.jsonl:2: 'resolution' has numbers and words, must be one of the two\n");
}

TEST_F(Report, ChangesStandBesideTheirDecisions) {
  plan("o");
  ReportRun whole = read_report_run(path("o"), false);
  EXPECT_TRUE(whole.has_changes);
  const auto is_there = [](ReportRun& run) {
    for (PackedField& field : run.decisions.fields())
      if (field.info.name == "own_motion_px") return field.packed.has_value();
    return false;
  };
  EXPECT_TRUE(is_there(whole));
  std::filesystem::remove(path("o/changes.jsonl"));
  ReportRun without = read_report_run(path("o"), false);
  EXPECT_FALSE(without.has_changes);
  EXPECT_FALSE(is_there(without));
  EXPECT_EQ(without.decisions.rows(), whole.decisions.rows());
}

TEST_F(Report, OfTwoRunsListsTheLayersOfOneAlone) {
  plan("o");
  ASSERT_EQ(run("plan cube.obj --frames 0-3 --size 64x48 --progress none --out p").exit_code, 0);
  const std::string both = page({"o", "p"});
  EXPECT_THAT(both, HasSubstr("id=\"unmatched\""));
  EXPECT_THAT(both, HasSubstr("<th scope=\"row\">horse 1</th><td>A</td>"));
  EXPECT_THAT(page({"o", "o"}), Not(HasSubstr("id=\"unmatched\"")));
}

TEST_F(Report, OfAnAuditHasWhatItFound) {
  ASSERT_EQ(run("audit carousel --frames 0-7 --every 2 --size 64x48 --progress none --out a").exit_code, 0);
  const Json audit = Json::parse(read("a/summary.json")).at("audit");
  const std::string text = read("a/report.html");
  EXPECT_THAT(text, HasSubstr("id=\"audit\""));
  for (const Json& layer : audit) EXPECT_THAT(text, HasSubstr(layer["layer"].get<std::string>() + "</"));
}

/// Layers may be called anything; the page has one script per column, and no other.
TEST_F(Report, HostileNamesStayText) {
  plan("o");
  for (const char* file : {"o/decisions.jsonl", "o/changes.jsonl"}) {
    std::string text = read(file);
    const std::string name = "\"roof\"";
    for (std::size_t at; (at = text.find(name)) != std::string::npos;)
      text.replace(at, name.size(), "\"</script><script>alert(1)</script>\"");
    write(file, text);
  }
  const std::string text = page({"o"});
  EXPECT_THAT(text, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(text, HasSubstr("&lt;script&gt;alert(1)"));
}

}  // namespace
}  // namespace talisman::sequences
