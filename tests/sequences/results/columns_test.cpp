// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/columns.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/results/column_json.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/columns_doc.h"
#include "tests/sequences/csv_rows.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Rows of a small table of all kinds of columns.
struct Ship {
  std::string name = "hull";
  int masts = 3;
  double length_m = 2.5;
  std::optional<double> keel_m;
  bool has_crew = false;
  std::int64_t crew = 0;
};

ColumnTable<Ship> ship_table() {
  return {"ships",
          "test.ship/1",
          {stored<Ship>(
               "name", "name", "", "of it", [](auto& s) -> auto& { return s.name; }),
           stored<Ship>(
               "masts", "rig/masts", "masts", "", [](auto& s) -> auto& { return s.masts; }),
           stored<Ship>(
               "length_m", "size/0", "m", "", [](auto& s) -> auto& { return s.length_m; }),
           computed<Ship>("half_m", "size/1", "m", "", [](const Ship& s) { return s.length_m / 2; }),
           computed<Ship>("keel_m", "keel_m", "m", "", [](const Ship& s) { return s.keel_m; }),
           stored<Ship>(
               "crew", "crew/count", "", "", [](auto& s) -> auto& { return s.crew; })},
          {{"crew", "with a crew", false, [](const Ship& s) { return s.has_crew; },
            [](Ship& s) { s.has_crew = true; }}}};
}

TEST(RowJson, WritesColumnsInOrderIntoTheirPlaces) {
  const ColumnTable<Ship> table = ship_table();
  const RowJson<Ship> json(table);
  Ship ship;
  EXPECT_EQ(json.write(ship).dump(),
            R"({"schema":"test.ship/1","name":"hull","rig":{"masts":3},"size":[2.5,1.25],"keel_m":null})");
  ship.has_crew = true;
  ship.keel_m = NAN;
  EXPECT_THAT(json.write(ship).dump(), HasSubstr(R"("keel_m":null,"crew":{"count":0})"));
}

TEST(RowJson, ReadsBackWhatIsStored) {
  const ColumnTable<Ship> table = ship_table();
  const RowJson<Ship> json(table);
  Ship ship{"tub", 1, 0.1, 5.0, true, 12'345'678'901};
  Ship back;
  json.read(nlohmann::ordered_json::parse(json.write(ship).dump()), back);
  EXPECT_EQ(back.name, "tub");
  EXPECT_EQ(back.masts, 1);
  EXPECT_EQ(back.length_m, 0.1);
  EXPECT_TRUE(back.has_crew);
  EXPECT_EQ(back.crew, 12'345'678'901);
  EXPECT_FALSE(back.keel_m) << "is not stored";
}

TEST(RowJson, MissingEntriesAndOtherKindsAreRefused) {
  const ColumnTable<Ship> table = ship_table();
  const RowJson<Ship> json(table);
  for (const char* text :
       {"{}", "[]", "3", R"({"name":1,"rig":{"masts":3},"size":[1.0]})",
        R"({"name":"a","rig":3,"size":[1.0]})", R"({"name":"a","rig":{"masts":"3"},"size":[1.0]})",
        R"({"name":"a","rig":{"masts":3},"size":[]})", R"({"name":"a","rig":{"masts":3},"size":[{}]})"}) {
    Ship ship;
    EXPECT_ANY_THROW(json.read(nlohmann::ordered_json::parse(text), ship)) << text;
  }
}

template <typename Row>
void expect_well_formed(const ColumnTable<Row>& table) {
  std::set<std::string> names, paths;
  for (const ColumnInfo& column : flat_columns(table)) {
    EXPECT_TRUE(names.insert(column.name).second) << table.name << ": two columns " << column.name;
    EXPECT_TRUE(paths.insert(column.path).second) << table.name << ": two columns at " << column.path;
    EXPECT_NE(column.meaning, "") << table.name << ": " << column.name;
    EXPECT_EQ(column.meaning.find('|'), std::string::npos) << "would break the documentation's table";
  }
  for (const ColumnGroup<Row>& group : table.groups) {
    int members = 0;
    for (const std::string& path : paths) members += path.rfind(group.path + "/", 0) == 0;
    EXPECT_GT(members, 0) << table.name << ": nothing is in the group " << group.path;
  }
}

TEST(ColumnTables, EveryColumnHasItsOwnNameAndPlaceAndAMeaning) {
  expect_well_formed(decision_table());
  expect_well_formed(frame_table());
  expect_well_formed(timing_table());
  expect_well_formed(layer_table());
  expect_well_formed(effect_table());
  expect_well_formed(run_table());
}

// Names carry units: who reads a column "…_ms" must find milliseconds in it, and the other way round.
TEST(ColumnTables, NamesEndInTheUnit) {
  const auto expect_units = [](const std::vector<ColumnInfo>& columns) {
    for (const ColumnInfo& c : columns)
      for (const std::string unit : {"px", "ms", "bytes", "rad", "dB"}) {
        const std::string ending = unit == "dB" ? "_db" : "_" + unit;
        const bool named = c.name.size() > ending.size() && c.name.ends_with(ending);
        if (named) {
          EXPECT_EQ(c.unit, unit) << c.name;
        }
      }
  };
  expect_units(flat_columns(decision_table()));
  expect_units(flat_columns(frame_table()));
  expect_units(flat_columns(timing_table()));
  expect_units(flat_columns(layer_table()));
  expect_units(flat_columns(run_table()));
}

TEST(ColumnTables, TheDocumentationHasThemAsTheyAre) {
  const std::string documented = tests::content(std::string(TALISMAN_SOURCE_DIR) + "/docs/outputs.md");
  ASSERT_NE(documented, "");
  EXPECT_EQ(with_column_tables(documented), documented)
      << "renew them with: talisman columns docs/outputs.md";
  for (const char* name : {"decisions", "frames", "timing", "layers", "effects", "run"})
    EXPECT_THAT(documented, HasSubstr(std::string("<!-- columns: ") + name + " -->\n"));
}

TEST(WithColumnTables, ReplacesWhatIsBetweenTheMarksAndNothingElse) {
  const std::string text = "a\n<!-- columns: timing -->\nold\n<!-- end of columns -->\nb\n";
  const std::string made = with_column_tables(text);
  EXPECT_THAT(made, HasSubstr("a\n<!-- columns: timing -->\n\n| CSV | JSON | unit | meaning |\n"));
  EXPECT_THAT(made, HasSubstr("| `plan_ms` | `plan_ms` | ms | to decide what is drawn |\n"));
  EXPECT_THAT(made, HasSubstr("\n<!-- end of columns -->\nb\n"));
  EXPECT_THAT(made, Not(HasSubstr("old")));
  EXPECT_EQ(with_column_tables(made), made);
  EXPECT_EQ(with_column_tables("no tables\n"), "no tables\n");
}

TEST(WithColumnTables, UnknownNamesAndTablesWithoutEndAreErrors) {
  EXPECT_EQ(tests::message_of([] { with_column_tables("a\n<!-- columns: ships -->\n"); }),
            "line 2: no table 'ships'");
  EXPECT_EQ(tests::message_of([] { with_column_tables("<!-- columns: run -->\nb\n"); }),
            "line 1: table 'run' has no end");
}

}  // namespace
}  // namespace talisman::sequences
