// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/plot.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(content("many.svg"), HasSubstr("series 19"));
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

}  // namespace
}  // namespace talisman::sequences
