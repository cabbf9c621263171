// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/pictures/plot_layout.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class PlotFilesTest : public testing::Test {
 protected:
  std::string content(const std::string& name) const { return folder_.read(name); }
  std::size_t files() const { return folder_.names().size(); }
  tests::TemporaryFolder folder_;
  const std::string dir_ = folder_.path();
};

Plot sample() {
  return {"Rate & error <1>",
          {"error", "px", true},
          {"update rate", "%", false},
          {{"aff_i", {{0.5, 90}, {1, 60.1}, {4, 1.0 / 3}}, SeriesStyle::LinePoints},
           {"hold", {{0.5, 20}, {4, 20}}, SeriesStyle::Line}}};
}

// The shortest digits that read back as the same double: 1/3 in full, 0.5 as it is.
TEST(PlotCsv, OneTidyLinePerPointWithUnitsInTheHeader) {
  EXPECT_EQ(plot_csv(sample()),
            "series,error [px],update rate "
            "[%]\naff_i,0.5,90\naff_i,1,60.1\naff_i,4,0.3333333333333333\nhold,0.5,20\nhold,4,20\n");
}

TEST(PlotCsv, AwkwardNamesAreQuotedAndHolesAreEmpty) {
  Plot plot;
  plot.x = {"a,b", "", false}, plot.y = {"say \"y\"", "ms", false};
  plot.series = {{"two\nlines", {{NAN, 1}, {2, HUGE_VAL}}, SeriesStyle::Points}};
  EXPECT_EQ(plot_csv(plot), "series,\"a,b\",\"say \"\"y\"\" [ms]\"\n\"two\nlines\",,1\n\"two\nlines\",2,\n");
}

TEST(PlotCsv, NoSeriesIsAHeader) {
  EXPECT_EQ(plot_csv(Plot{"", {"x", "s", false}, {"y", "", false}, {}}), "series,x [s],y\n");
}

// A layer may be named anything; nothing of it may become a gnuplot command.
TEST(PlotScript, TextCannotLeaveItsQuotes) {
  Plot plot = sample();
  plot.title = "it's\nsystem('true')\n`true`";
  const std::string script = plot_script(plot);
  EXPECT_THAT(script, HasSubstr("set title 'it''s system(''true'') `true`'\n"));
  EXPECT_THAT(script, Not(HasSubstr("\nsystem")));
}

TEST(PlotScript, PointsThatCannotBeDrawnLeaveAGap) {
  Plot plot = sample();
  plot.series = {{"s", {{1, 2}, {-1, 5}, {0, 6}, {2, NAN}, {3, 4}}, SeriesStyle::Line}};
  EXPECT_THAT(plot_script(plot), HasSubstr("END_OF_DATA\n1 2\n\n\n\n3 4\nEND_OF_DATA\n"));
}

// Thousands of points must show where they are dense.
TEST_F(PlotFilesTest, CloudsAreTranslucentPointsWithoutALine) {
  Plot plot = sample();
  plot.series = {{"samples", {{1, 2}, {3, 4}}, SeriesStyle::Cloud}};
  const std::string script = plot_script(plot);
  EXPECT_THAT(script, HasSubstr("with points linecolor rgb '#A00072B2' pointtype 7"));
  EXPECT_THAT(script, Not(HasSubstr("linewidth 2")));
  write_plot(dir_, "cloud", plot);
  EXPECT_THAT(content("cloud.svg"), HasSubstr("samples"));
}

TEST_F(PlotFilesTest, SvgAndCsvAndNothingElse) {
  write_plot(dir_, "rate", sample());
  EXPECT_EQ(files(), 2u);
  EXPECT_EQ(content("rate.csv"), plot_csv(sample()));
  const std::string svg = content("rate.svg");
  for (const char* text :
       {"<svg", "</svg>", "error (px)", "update rate (%)", "aff_i", "hold", "Rate &amp; error &lt;1>"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
}

TEST_F(PlotFilesTest, ScriptIsKeptWhenAskedFor) {
  write_plot(dir_, "rate", sample(), {true, 640, 400});
  EXPECT_EQ(content("rate.gp"), plot_script(sample(), {true, 640, 400}));
  EXPECT_THAT(content("rate.svg"), HasSubstr("width=\"640\" height=\"400\""));
}

TEST_F(PlotFilesTest, SameBytesEveryTime) {
  write_plot(dir_, "a", sample());
  write_plot(dir_, "b", sample());
  EXPECT_EQ(content("a.svg"), content("b.svg"));
}

// gnuplot itself fails on all of these.
TEST_F(PlotFilesTest, PlotsWithoutDrawablePointsSayNoData) {
  Plot none = sample(), negative = sample(), nan = sample();
  none.series.clear();
  negative.series = {{"s", {{-1, 5}, {0, 5}}, SeriesStyle::Line}};
  nan.series = {{"s", {{NAN, NAN}}, SeriesStyle::Points}, {"t", {}, SeriesStyle::Steps}};
  for (const Plot& plot : {none, negative, nan}) {
    write_plot(dir_, "p", plot);
    EXPECT_THAT(content("p.svg"), HasSubstr("no data"));
  }
}

TEST_F(PlotFilesTest, OnePointEqualValuesAndExtremesAreDrawn) {
  Plot plot = sample();
  plot.x.logarithmic = false;
  for (const auto& points : std::vector<std::vector<PlotPoint>>{{{1, 1}},
                                                                {{1, 7}, {2, 7}, {3, 7}},
                                                                {{0, 0}, {0, 0}},
                                                                {{1e-300, 1}, {1, 2}},
                                                                {{1e200, 1e200}, {2e200, 3e200}}}) {
    plot.series = {{"s", points, SeriesStyle::LinePoints}};
    write_plot(dir_, "p", plot);
    EXPECT_THAT(content("p.svg"), HasSubstr("</svg>"));
  }
}

TEST_F(PlotFilesTest, MoreSeriesThanColors) {
  Plot plot = sample();
  for (int i = 0; i < 20; ++i)
    plot.series.push_back({"series " + std::to_string(i), {{1, 1.0 * i}, {2, 2.0 * i}}, SeriesStyle::Line});
  write_plot(dir_, "many", plot);
  for (int i = 0; i < 20; ++i)
    EXPECT_THAT(content("many.svg"), HasSubstr("series " + std::to_string(i) + "<")) << i;
}

/// What follows `word` in each curve of the script.
std::vector<std::string> of_curves(const std::string& script, const std::string& word) {
  std::vector<std::string> found;
  for (std::size_t at = script.find("plot $"); (at = script.find(word, at)) != std::string::npos;) {
    at += word.size();
    found.push_back(script.substr(at, script.find_first_of(" \n,", at) - at));
  }
  return found;
}

// 40 kinds of point: no two look alike, and the first twelve have twelve colours.
TEST(PlotScript, NoTwoSeriesHaveOneColorAndOneMarker) {
  Plot plot = sample();
  plot.series.clear();
  for (int i = 0; i < 40; ++i)
    plot.series.push_back({"s" + std::to_string(i), {{1, 1.0 * i}}, SeriesStyle::Points});
  const std::string script = plot_script(plot);
  const auto colors = of_curves(script, "linecolor rgb "), markers = of_curves(script, "pointtype ");
  ASSERT_EQ(colors.size(), 40u);
  ASSERT_EQ(markers.size(), 40u);
  EXPECT_EQ(std::set<std::string>(colors.begin(), colors.begin() + 12).size(), 12u);
  std::set<std::pair<std::string, std::string>> looks;
  for (std::size_t i = 0; i < colors.size(); ++i) looks.insert({colors[i], markers[i]});
  EXPECT_EQ(looks.size(), 40u);
}

// The partner of a curve has its colour, its own marker, and is dashed.
TEST(PlotScript, ASeriesMayAskForTheColorOfAnother) {
  Plot plot = sample();
  plot.series[1].style = SeriesStyle::LinePoints;
  plot.series[1].color = 0;
  const std::string script = plot_script(plot);
  const auto colors = of_curves(script, "linecolor rgb "), markers = of_curves(script, "pointtype ");
  EXPECT_EQ(colors[0], colors[1]);
  EXPECT_NE(markers[0], markers[1]);
  EXPECT_EQ(of_curves(script, "dashtype "), std::vector<std::string>{"2"});
}

// The mean of nine is hollow, that of ten is not; the file has the counts.
TEST_F(PlotFilesTest, PointsOfFewSamplesAreHollowAndSaySo) {
  Plot plot = sample();
  plot.series[0].samples = {100, kFewSamples, kFewSamples - 1};
  EXPECT_THAT(plot_script(plot), HasSubstr("$few << END_OF_DATA\n4 0.3333333333333333\nEND_OF_DATA\n"));
  write_plot(dir_, "few", plot);
  EXPECT_THAT(content("few.svg"), HasSubstr("hollow: fewer than 10 samples"));
  EXPECT_THAT(content("few.csv"), HasSubstr("update rate [%],samples\naff_i,0.5,90,100\n"));
  EXPECT_THAT(content("few.csv"), HasSubstr("\nhold,4,20,\n"));
  plot.series[0].samples = {10, 10, 10};
  EXPECT_THAT(plot_script(plot), Not(HasSubstr("hollow")));
}

// A title and a name of 300 letters stay inside the picture, cut with dots.
TEST_F(PlotFilesTest, LongWordsAreCut) {
  Plot plot = sample();
  plot.title = plot.series[0].name = plot.x.label = plot.y.label = std::string(300, 'w');
  write_plot(dir_, "long", plot);
  EXPECT_THAT(content("long.svg"), HasSubstr("…"));
  EXPECT_THAT(content("long.svg"), Not(HasSubstr(std::string(80, 'w'))));
}

TEST_F(PlotFilesTest, LabelsAreWrittenBesideTheirPoints) {
  Plot plot = sample();
  plot.series[0].labels = {"it's", "", "last"};
  EXPECT_THAT(plot_script(plot), HasSubstr("set label 'it''s' at screen "));
  write_plot(dir_, "labels", plot);
  EXPECT_THAT(content("labels.svg"), HasSubstr("last"));
}

TEST_F(PlotFilesTest, FolderThatCannotBeWrittenIsNamed) {
  const std::string message = tests::message_of([&] { write_plot(dir_ + "/none", "rate", sample()); });
  EXPECT_THAT(message, HasSubstr("none/rate.csv"));
}

// A gnuplot that fails leaves no half picture and its last words are reported.
TEST_F(PlotFilesTest, FailingGnuplotIsReported) {
  const std::string path = std::getenv("PATH");
  const auto fake = fs::path(dir_) / "bin" / "gnuplot";
  fs::create_directory(fake.parent_path());
  std::ofstream(fake) << "#!/bin/sh\necho half a picture\necho 'terminal type svg is unknown' >&2\nexit 3\n";
  fs::permissions(fake, fs::perms::owner_all);
  ::setenv("PATH", (fake.parent_path().string() + ":" + path).c_str(), 1);
  const std::string failing = tests::message_of([&] { write_plot(dir_, "rate", sample()); });
  ::setenv("PATH", (dir_ + "/nothing-here").c_str(), 1);
  const std::string missing = tests::message_of([&] { write_plot(dir_, "rate", sample()); });
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(failing, HasSubstr("rate.svg: gnuplot failed: terminal type svg is unknown"));
  EXPECT_THAT(missing, HasSubstr("No such file"));
  EXPECT_EQ(files(), 2u);  // bin/ and rate.csv
}

// Bars stand on 0, whatever the least of them, and the outer ones are whole.
TEST(PlotScript, BarsStandOnZeroUnderTheirNames) {
  Plot plot{"rates", {"sprite", "", false, false, {"sky", "it's"}}, {"rate", "%", false}, {}};
  plot.series.push_back({"rate", {{1, 40}, {2, 50}}, SeriesStyle::Bars});
  const PlotLayout layout = plot_layout(plot, {});
  EXPECT_EQ(layout.y.lo, 0);
  EXPECT_LE(layout.x.lo, 0.5);
  EXPECT_GE(layout.x.hi, 2.5);
  const std::string script = plot_script(plot);
  EXPECT_THAT(script, HasSubstr("with boxes"));
  EXPECT_THAT(script, HasSubstr("('sky' 1, 'it''s' 2)"));
}

TEST(PlotLayout, AnAxisFromZeroHasZeroOnIt) {
  Plot plot{"", {"frame", "", false}, {"error", "px", false, true}, {}};
  plot.series.push_back({"a", {{10, 40}, {20, 50}}, SeriesStyle::Line});
  EXPECT_EQ(plot_layout(plot, {}).y.lo, 0);
  EXPECT_GT(plot_layout(plot, {}).x.lo, 0);
}

}  // namespace
}  // namespace talisman::sequences
