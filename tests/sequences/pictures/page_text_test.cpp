// SPDX-License-Identifier: Apache-2.0
// Names are whatever an author or a hostile file wrote; in a page they are text.
#include "sequences/pictures/page_text.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/pictures/page_assets.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Escaped, IsTextWhateverItWas) {
  EXPECT_EQ(escaped("</script><b a=\"1\">&"), "&lt;/script&gt;&lt;b a=&quot;1&quot;&gt;&amp;");
  EXPECT_EQ(escaped("é\n\t"), "é\n\t");
  EXPECT_EQ(escaped(std::string("a\0b\x1b", 4)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
  EXPECT_EQ(escaped("\xff"), "\xEF\xBF\xBD") << "no UTF-8";
}

TEST(JsonInScript, CannotEndItsElement) {
  const nlohmann::ordered_json json = {{"</script>", "<!--"}};
  EXPECT_EQ(json_in_script(json), "{\"\\u003c/script>\":\"\\u003c!--\"}");
  EXPECT_EQ(nlohmann::ordered_json::parse(json_in_script(json)), json);
}

TEST(UrlEncoded, KeepsWhatRfc3986CallsUnreserved) {
  EXPECT_EQ(url_encoded("aZ09-_.~"), "aZ09-_.~");
  EXPECT_EQ(url_encoded("horse 1/é#&"), "horse%201%2F%C3%A9%23%26");
}

TEST(NumberElement, ShowsItRoundedAndMeansItExactly) {
  EXPECT_EQ(number_element(1.0 / 3), "<data value=\"0.3333333333333333\">0.333</data>");
  EXPECT_EQ(number_element(2, 1), "<data value=\"2\">2.0</data>");
  EXPECT_EQ(number_element(NAN), "");
  EXPECT_EQ(number_element(HUGE_VAL), "");
}

TEST(Large, HasThreeDigitsAndASign) {
  EXPECT_EQ(large(9999), "9999");
  EXPECT_EQ(large(48400), "48.4 k");
  EXPECT_EQ(large(6.73e6), "6.73 M");
  EXPECT_EQ(large(1.5e9), "1.5 G");
}

TEST(HtmlTable, HasHeadsForReadersAndItsNumbersOnTheRight) {
  const std::string table = html_table("t", "Layers", {"layer", "px"}, {{"a", "1"}}, 1);
  EXPECT_THAT(table, HasSubstr("aria-label=\"Layers\""));
  EXPECT_THAT(table, HasSubstr("tabindex=\"0\""));
  EXPECT_THAT(table, HasSubstr("<caption>Layers</caption>"));
  EXPECT_THAT(table, HasSubstr("<th scope=\"col\">layer</th><th scope=\"col\" class=\"n\">px</th>"));
  EXPECT_THAT(table, HasSubstr("<th scope=\"row\">a</th><td class=\"n\">1</td>"));
  const std::string unnamed = html_table("t", "", {"layer"}, {{"a"}}, 1, "table 1");
  EXPECT_THAT(unnamed, HasSubstr("aria-label=\"table 1\""));
  EXPECT_THAT(unnamed, Not(HasSubstr("<caption>")));
}

TEST(Filled, ValuesAreNotLookedInto) {
  EXPECT_EQ(filled("<{{a}}{{b}}{{unknown}}>{{a}}", {{"a", "{{b}}"}, {"b", "2"}}), "<{{b}}2>{{b}}");
  EXPECT_EQ(filled("a {{b", {}), "a {{b");
}

TEST(PageAssets, OfExperimentsAreThereWithoutTheReportToo) {
  for (const char* name : {"page.css", "theme.js", "experiment.html"})
    EXPECT_NE(page_asset(name), "") << name;
  EXPECT_EQ(page_asset("none"), "");
  EXPECT_EQ(page_asset("page.html").empty(), !has_report());
}

}  // namespace
}  // namespace talisman::sequences
