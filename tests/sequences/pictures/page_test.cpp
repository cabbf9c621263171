// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/page.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;
using testing::Not;

Page example() {
  Page page;
  page.title = "A < B & C";
  page.blocks = {Heading{2, "numbers"}, Paragraph{"a \"quoted\" <tag>"},
                 PageTable{{"curve", "rate"}, {{"so | soi", "1.5"}, {"µ", "20.25"}}, 1}};
  return page;
}

TEST(Markdown, BarsInCellsAreEscaped) {
  EXPECT_EQ(markdown(example()),
            "# A < B & C\n\n## numbers\n\na \"quoted\" <tag>\n\n| curve | rate |\n|---|---:|\n"
            "| so \\| soi | 1.5 |\n| µ | 20.25 |\n");
}

TEST(Html, TextCannotBecomeMarkup) {
  const std::string text = html(example(), ".");
  EXPECT_THAT(text, HasSubstr("<h1>A &lt; B &amp; C</h1>"));
  EXPECT_THAT(text, HasSubstr("a &quot;quoted&quot; &lt;tag&gt;"));
  EXPECT_THAT(text, Not(HasSubstr("<tag>")));
  EXPECT_THAT(text, HasSubstr("<td class=\"n\">20.25</td>"));
}

TEST(Html, FiguresAreInsideAndKeepTheirOwnIds) {
  // Two pictures with the same identifier: references of each must find its own.
  const tests::TemporaryFolder folder;
  for (const char* name : {"a.svg", "b.svg"})
    folder.write(name,
                 "<?xml version=\"1.0\"?>\n<svg><g id=\"p\"/><use href=\"#p\"/><use xlink:href='#p'/></svg>");
  Page page;
  page.blocks = {Figure{"a.svg", "first"}, Figure{"b.svg", "second"}};
  const std::string text = html(page, folder.path());
  EXPECT_THAT(text, HasSubstr("<g id=\"f1-p\"/><use href=\"#f1-p\"/><use xlink:href='#f1-p'/>"));
  EXPECT_THAT(text, HasSubstr("<g id=\"f2-p\"/>"));
  EXPECT_THAT(text, Not(HasSubstr("<?xml")));
  page.blocks.push_back(Figure{"missing.svg", ""});
  EXPECT_THROW(html(page, folder.path()), OutputError);
}

TEST(Html, PointsAndRowsOpenWhatTheyStandFor) {
  const tests::TemporaryFolder folder;
  folder.write("a.svg", "<svg><g/></svg>");
  Page page;
  page.blocks = {Figure{"a.svg", "both", {{10, 20.25, "at \"4\" px", "runs/a.html"}}},
                 PageTable{{"run", "n"}, {{"a", "1"}, {"b", "2"}}, 1, {"runs/a.html", ""}}};
  const std::string text = html(page, folder.path());
  EXPECT_THAT(text,
              HasSubstr("<svg role=\"group\" aria-label=\"both\"><g/><a href=\"runs/a.html\" aria-label=\"at "
                        "&quot;4&quot; px\"><circle cx=\"10.0\" cy=\"20.2\" r=\"8\"/>"));
  EXPECT_THAT(text, HasSubstr("<th scope=\"row\"><a href=\"runs/a.html\">a</a></th>"));
  EXPECT_THAT(text, HasSubstr("<th scope=\"row\">b</th>"));
}

TEST(Html, PicturesOfPixelsAreInside) {
  const tests::TemporaryFolder folder;
  folder.write("a.png", "Man");
  Page page;
  page.blocks = {Figure{"a.png", "a \"sheet\""}};
  EXPECT_THAT(html(page, folder.path()),
              HasSubstr("<img alt=\"a &quot;sheet&quot;\" src=\"data:image/png;base64,TWFu\">"));
}

TEST(WritePage, HasTheVerdictOnTop) {
  const tests::TemporaryFolder folder;
  Page page = example();
  page.verdict = "1 < 2";
  page.file = "x.html";
  write_page(page, folder.path());
  const std::string text = folder.read("x.html");
  EXPECT_LT(text.find("<p class=\"verdict\" id=\"verdict\">1 &lt; 2</p>"), text.find("<main"));
}

TEST(PlainText, AHeadingStandsOnItsWordsAndTheVerdictIsLast) {
  Page page = example();
  page.verdict = "so is best";
  page.blocks.push_back(Verbatim{"a: 1\nb: 2\n"});
  page.blocks.push_back(Figure{"nowhere.svg", "not in a terminal"});
  EXPECT_EQ(plain_text(page), R"(numbers
a "quoted" <tag>
curve      rate
so | soi    1.5
µ         20.25

    a: 1
    b: 2

so is best
)");
}

TEST(PlainText, WordsOfStrangersMoveNoCursor) {
  Page page;
  page.verdict = "a\x1b[2J";
  page.blocks = {Paragraph{"b\x1b\nc"}};
  EXPECT_EQ(plain_text(page), "b\\x1b\nc\n\na\\x1b[2J\n");
}

TEST(PlainText, ColumnsLineUpByCodePoints) {
  const PageTable table{{"µs", "n"}, {{"é", "1"}, {"abc", "100"}}, 1};
  EXPECT_EQ(plain_text(table), "µs     n\né      1\nabc  100\n");
}

TEST(Fixed, NotANumberIsADash) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");
  EXPECT_EQ(fixed(NAN, 2), "-");
  EXPECT_EQ(fixed(HUGE_VAL, 2), "-");
}

}  // namespace
}  // namespace talisman::sequences
