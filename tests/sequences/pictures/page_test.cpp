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
