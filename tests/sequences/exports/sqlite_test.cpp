// SPDX-License-Identifier: Apache-2.0
// The SQLite file, read by SQLite, against what the JSON says.
#include <memory>
#include <string>

#include <sqlite3.h>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using Json = nlohmann::json;

class Sqlite : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    std::string yaml = kPassing;
    yaml.replace(yaml.find("{name: ball"), 11, "{name: \"Robert'); DROP TABLE decisions;--\"");
    write("passing.yaml", yaml);
    ASSERT_EQ(
        run("render passing.yaml --frames 0-14 --size 96x72 --quality --progress none --out o").exit_code, 0);
    const Outcome exported = run("export o --sqlite");
    ASSERT_EQ(exported.output, "wrote results.sqlite in o\n");
  }
  /// All rows, each as an array of its columns.
  Json query(const std::string& sql) const {
    sqlite3* opened = nullptr;
    EXPECT_EQ(sqlite3_open(path("o/results.sqlite").c_str(), &opened), SQLITE_OK);
    const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database(opened, sqlite3_close);
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(opened, sql.c_str(), -1, &statement, nullptr), SQLITE_OK)
        << sqlite3_errmsg(opened);
    Json rows = Json::array();
    while (sqlite3_step(statement) == SQLITE_ROW) {
      Json row = Json::array();
      for (int k = 0; k < sqlite3_column_count(statement); ++k) row.push_back(value(statement, k));
      rows.push_back(row);
    }
    sqlite3_finalize(statement);
    return rows;
  }

 private:
  static Json value(sqlite3_stmt* statement, int k) {
    switch (sqlite3_column_type(statement, k)) {
      case SQLITE_INTEGER:
        return sqlite3_column_int64(statement, k);
      case SQLITE_FLOAT:
        return sqlite3_column_double(statement, k);
      case SQLITE_TEXT:
        return reinterpret_cast<const char*>(sqlite3_column_text(statement, k));
      default:
        return nullptr;
    }
  }
};

TEST_F(Sqlite, DecisionsAreThoseOfTheJson) {
  const std::vector<std::string> json_lines = lines("o/decisions.jsonl");
  const Json rows = query(
      "SELECT frame, layer, decision, reason, warp_x, geometric_px, magnification, cost_pixels FROM "
      "decisions "
      "ORDER BY rowid");
  ASSERT_EQ(rows.size(), json_lines.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Json d = Json::parse(json_lines[k]);
    const Json magnification = d["fiducials"].is_null() ? Json(nullptr) : d["fiducials"]["magnification"];
    EXPECT_EQ(rows[k], Json::array({d["frame"], d["layer"], d["decision"], d["reason"], d["warp"][2],
                                    d["geometric_px"], magnification, d["cost"]["pixels"]}));
  }
}

TEST_F(Sqlite, OtherTablesAreThoseOfTheJson) {
  const Json summary = Json::parse(read("o/summary.json"));
  EXPECT_EQ(query("SELECT sequence, mean_update_rate FROM run"),
            Json::array({Json::array({summary["sequence"], summary["mean_update_rate"]})}));
  EXPECT_EQ(query("SELECT count(*) FROM layers")[0][0], summary["layers"].size());
  EXPECT_EQ(query("SELECT aggregate FROM layers WHERE name = 'wall'")[0][0], 0);
  EXPECT_EQ(query("SELECT count(*), sum(renders) FROM frames")[0][0], 15);
  EXPECT_EQ(query("SELECT quality_total_flip FROM frames WHERE frame = 3")[0][0],
            Json::parse(lines("o/frames.jsonl")[3])["quality"]["total"]["flip"]);
  EXPECT_EQ(query("SELECT count(*) FROM timing")[0][0], 15);
  EXPECT_EQ(query("PRAGMA integrity_check")[0][0], "ok");
  ASSERT_EQ(run("export o --sqlite --no-timing").exit_code, 0);
  EXPECT_EQ(query("SELECT count(*) FROM sqlite_master WHERE name = 'timing'")[0][0], 0);
}

TEST_F(Sqlite, AFileThatCannotBeWrittenIsOneErrorLine) {
  std::filesystem::remove(folder_ / "o/results.sqlite");
  std::filesystem::create_directories(folder_ / "o/results.sqlite/in the way");
  const Outcome outcome = run("export o --sqlite");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::HasSubstr("results.sqlite"));
}

}  // namespace
}  // namespace talisman
