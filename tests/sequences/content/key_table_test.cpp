// SPDX-License-Identifier: Apache-2.0
// A small table by which everything is seen that a table can say: what is read, what is refused, and what the
// document and the schema make of it.
#include "sequences/content/key_table.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/content/key_docs.h"
#include "sequences/content/key_schema.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::message_of;

struct Inner {
  int count = 3;
};

struct Thing {
  double size_m = 2;
  float share = 0.25f;
  std::optional<double> turn_rad;
  bool big = false;
  std::string kind = "plain";
  int stripes = 0;
  Inner inner;
  std::vector<Inner> list;
};

const Table<Inner>& inner_keys() {
  static const Table<Inner> table =
      Table<Inner>("inner").key("count", &Inner::count, whole(1, 9), "", "how many");
  return table;
}

const Table<Thing>& thing_keys() {
  static const Table<Thing> table =
      Table<Thing>("thing")
          .key("size_m", &Thing::size_m, number(kPositive), "m", "its size")
          .required()
          .key("share", &Thing::share, number({0, 1}), "", "its share")
          .key("turn_deg", &Thing::turn_rad, degrees({-90, 90}), "°", "its turn")
          .not_with({"share"})
          .key("big", &Thing::big, truth(), "", "whether")
          .only_with("share")
          .key("kind", &Thing::kind, one_of({"plain", "striped"}), "", "its kind")
          .when(is("kind", {"striped"}), Table<Thing>()
                                             .begins([](Thing& t) { t.stripes = 7; })
                                             .key("stripes", &Thing::stripes, whole(1, 99), "", "how many"))
          .key("list", &Thing::list, list_of(inner_keys()), "", "more of them")
          .otherwise("none")
          .include(&Thing::inner, inner_keys())
          .rule("size_m at most 100 when big", [](const Thing& t) { return !t.big || t.size_m <= 100; });
  return table;
}

Thing read(const std::string& text) { return thing_keys().read(read_yaml_text(text, "a.yaml")); }
std::string refusal_of(const std::string& text) {
  return message_of([&] { read(text); });
}

TEST(Table, ValuesArriveInTheirMembersAndTheRestIsAsItWas) {
  const Thing t = read("size_m: 5\nshare: 0.5\nkind: striped\ncount: 9\nlist: [{count: 1}, {}]\n");
  EXPECT_EQ(t.size_m, 5);
  EXPECT_EQ(t.share, 0.5f);
  EXPECT_FALSE(t.turn_rad);
  EXPECT_EQ(t.stripes, 7) << "the default of a branch that holds";
  EXPECT_EQ(t.inner.count, 9) << "of a table that was included";
  ASSERT_EQ(t.list.size(), 2u);
  EXPECT_EQ(t.list[0].count, 1);
  EXPECT_EQ(t.list[1].count, 3);
  EXPECT_NEAR(*read("size_m: 5\nturn_deg: 90\n").turn_rad, std::acos(0.0), 1e-15);
  EXPECT_EQ(read("size_m: 5\nkind: plain\n").stripes, 0);
}

TEST(Table, UnknownKeyIsAnsweredWithTheKeysAndTheNearest) {
  EXPECT_EQ(
      refusal_of("size_m: 1\nshaer: 1\n"),
      "a.yaml:2: shaer is '1', rule: key 'shaer' is not known here; keys are big, count, kind, list, share, "
      "size_m, turn_deg; did you mean 'share'");
  EXPECT_THAT(refusal_of("size_m: 1\nwings: 1\n"), ::testing::EndsWith("size_m, turn_deg"));
}

TEST(Table, MisspeltKeyThatIsRequiredIsNamedWhereItStands) {
  EXPECT_THAT(refusal_of("share: 1\nsise_m: 1\n"), HasSubstr("a.yaml:2: sise_m is '1'"));
  EXPECT_THAT(refusal_of("share: 1\n"), HasSubstr("a.yaml:1: the file is a map, rule: has the key 'size_m'"));
}

TEST(Table, KeyOfABranchIsKnownWhileItHolds) {
  EXPECT_EQ(read("size_m: 1\nkind: striped\nstripes: 2\n").stripes, 2);
  EXPECT_THAT(refusal_of("size_m: 1\nstripes: 2\n"),
              HasSubstr("a.yaml:2: stripes is '2', rule: key 'stripes' is not known"));
  EXPECT_THAT(refusal_of("size_m: 1\nstripes: 2\n"), HasSubstr("; stripes goes with kind striped"));
  EXPECT_THAT(refusal_of("size_m: 1\nkind: stripd\nstripes: 2\n"),
              HasSubstr("one of plain, striped; did you mean 'striped'"));
  EXPECT_THAT(refusal_of("stripes: 2\n"), HasSubstr("has the key 'size_m'")) << "what is missing comes first";
}

TEST(Table, CompanyAndRulesAreKept) {
  EXPECT_THAT(refusal_of("size_m: 1\nshare: 1\nturn_deg: 1\n"),
              HasSubstr("a.yaml:3: turn_deg is '1', rule: not together with share"));
  EXPECT_THAT(refusal_of("size_m: 1\nbig: true\n"),
              HasSubstr("big is 'true', rule: only together with share"));
  EXPECT_THAT(refusal_of("size_m: 101\nshare: 1\nbig: true\n"),
              HasSubstr("rule: size_m at most 100 when big"));
}

TEST(KeyDocs, ARowSaysValueUnitDefaultAndMeaning) {
  EXPECT_EQ(markdown_of(thing_keys().keys()),
            "### Keys of thing\n\n"
            "| key | value | unit | without it | meaning |\n"
            "|---|---|---|---|---|\n"
            "| `size_m` | a number from 1e-09 to 1e+09 | m | required | its size |\n"
            "| `share` | a number from 0 to 1 | | `0.25` | its share |\n"
            "| `turn_deg` | a number from -90 to 90 | ° | | its turn. Not together with `share` |\n"
            "| `big` | true or false | | `false` | whether. Only together with `share` |\n"
            "| `kind` | `plain`, `striped` | | `plain` | its kind |\n"
            "| `list` | list of maps: [inner](#keys-of-inner) | | none | more of them |\n"
            "| keys of [inner](#keys-of-inner) | | | | |\n"
            "| `stripes`, with kind striped | a whole number from 1 to 99 | | `7` | how many |\n");
}

TEST(KeyDocs, BlocksAreFilledAndTheRestIsLeftAlone) {
  const std::string
      before =
          "# Title\n<!-- keys of inner -->\nold\n<!-- end -->\nwords\n<!-- keys of thing -->\n<!-- end -->\n",
      rules = "<!-- rules -->\n<!-- end -->\nlast";
  const std::string document = documented(before + rules, thing_keys().keys());
  EXPECT_THAT(document, ::testing::StartsWith("# Title\n<!-- keys of inner -->\n### Keys of inner\n"));
  EXPECT_THAT(document, HasSubstr("<!-- end -->\nwords\n<!-- keys of thing -->\n### Keys of thing\n"));
  EXPECT_THAT(document, ::testing::EndsWith(
                            "<!-- rules -->\n- `thing`: size_m at most 100 when big\n<!-- end -->\nlast"));
  EXPECT_EQ(documented(document, thing_keys().keys()), document) << "a second time changes nothing";
}

TEST(KeyDocs, BlockThatIsMissingUnknownOrOpenIsAnError) {
  const auto error = [](const std::string& document) {
    return message_of([&] { documented(document, inner_keys().keys()); });
  };
  EXPECT_THAT(error("<!-- rules -->\n<!-- end -->\n"), HasSubstr("no block for 'keys of inner'"));
  EXPECT_THAT(error("<!-- keys of outer -->\n<!-- end -->\n"),
              HasSubstr("no table for the block 'keys of outer'"));
  EXPECT_THAT(error("<!-- rules -->\n"), HasSubstr("without an end"));
}

TEST(JsonSchema, ADefinitionSaysWhatTheTableSays) {
  const auto schema = nlohmann::json::parse(json_schema(thing_keys().keys()));
  EXPECT_EQ(schema["$ref"], "#/$defs/thing");
  const auto& thing = schema["$defs"]["thing"];
  EXPECT_EQ(thing["additionalProperties"], false);
  EXPECT_EQ(thing["properties"]["size_m"],
            nlohmann::json::parse(
                R"({"type": "number", "minimum": 1e-09, "maximum": 1e9, "description": "its size [m]"})"));
  EXPECT_EQ(thing["properties"]["share"]["default"], 0.25);
  EXPECT_EQ(thing["properties"]["kind"]["enum"], nlohmann::json::parse(R"(["plain", "striped"])"));
  EXPECT_EQ(thing["properties"]["kind"]["default"], "plain");
  EXPECT_EQ(thing["properties"]["count"]["$ref"], "#/$defs/inner/properties/count");
  EXPECT_EQ(thing["dependentRequired"], nlohmann::json::parse(R"({"big": ["share"]})"));
  EXPECT_EQ(
      thing["dependentSchemas"]["stripes"],
      nlohmann::json::parse(R"({"properties": {"kind": {"enum": ["striped"]}}, "required": ["kind"]})"));
  EXPECT_EQ(thing["allOf"][0], nlohmann::json::parse(R"({"not": {"required": ["turn_deg", "share"]}})"));
  EXPECT_EQ(thing["allOf"][1], nlohmann::json::parse(R"({"required": ["size_m"]})"));
}

}  // namespace
}  // namespace talisman::sequences
