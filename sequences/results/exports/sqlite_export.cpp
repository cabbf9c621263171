// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/exports/sqlite_export.h"

#include <algorithm>
#include <memory>

#include <sqlite3.h>

#include "sequences/files/atomic_file.h"
#include "sequences/results/exports/finished_tables.h"

namespace talisman::sequences {

namespace {

/// A database under construction: a file that nobody else sees, so it needs no journal.
class Database {
 public:
  Database(const std::string& file, std::string target) : target_(std::move(target)) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open(file.c_str(), &opened);
    database_.reset(opened);
    check(code);
    run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; BEGIN");
  }
  void run(const std::string& sql) {
    check(sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
  }
  void check(int code) const {
    if (code == SQLITE_OK || code == SQLITE_DONE) return;
    throw OutputError(target_ + ": cannot be written: " +
                      (database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(code)));
  }
  sqlite3* get() const { return database_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
  };
  std::string target_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// Puts rows into a table.
class Insertion {
 public:
  Insertion(const Database& database, const FinishedTable& table)
      : database_(database), places_(table.columns) {
    std::string marks;
    for (std::size_t k = 0; k < places_.size(); ++k) marks += k > 0 ? ",?" : "?";
    const std::string sql = "INSERT INTO " + table.name + " VALUES (" + marks + ")";
    sqlite3_stmt* prepared = nullptr;
    database.check(sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &prepared, nullptr));
    statement_.reset(prepared);
  }
  void insert(const ExportedRow& row) {
    for (std::size_t k = 0; k < places_.size(); ++k)
      database_.check(bind(static_cast<int>(k) + 1, places_.at(row, k)));
    database_.check(sqlite3_step(statement_.get()));
    database_.check(sqlite3_reset(statement_.get()));
  }

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };

  int bind(int place, const ExportedRow* value) {
    sqlite3_stmt* to = statement_.get();
    if (!value) return sqlite3_bind_null(to, place);
    if (value->is_boolean()) return sqlite3_bind_int(to, place, value->get<bool>());
    if (value->is_number_float()) return sqlite3_bind_double(to, place, value->get<double>());
    if (value->is_number()) return sqlite3_bind_int64(to, place, value->get<std::int64_t>());
    const std::string text = value->is_string() ? value->get<std::string>() : value->dump();
    return sqlite3_bind_text(to, place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }

  const Database& database_;
  RowPlaces places_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Names of columns are ours: letters, digits and '_'.
std::string sql_table(const FinishedTable& table) {
  std::string sql = "CREATE TABLE " + table.name + " (\n";
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const ColumnInfo& column = table.columns[k];
    sql += "  \"" + column.name + "\"" + (k + 1 < table.columns.size() ? "," : "") + "  -- " +
           (column.unit.empty() ? "" : column.unit + ": ") + column.meaning + "\n";
  }
  return sql + ")";
}

}  // namespace

std::string export_sqlite(const std::string& folder, bool with_timing) {
  std::string name = "results.sqlite";
  const std::string target = folder + "/" + name;
  const std::vector<FinishedTable> tables = finished_tables(folder, with_timing);
  write_atomically(target, [&](const std::string& temporary) {
    Database database(temporary, target);
    for (const FinishedTable& table : tables) {
      database.run(sql_table(table));
      Insertion insertion(database, table);
      table.read([&](const ExportedRow& row) { insertion.insert(row); });
    }
    const bool has_decisions = std::any_of(
        tables.begin(), tables.end(), [](const FinishedTable& table) { return table.name == "decisions"; });
    if (has_decisions) database.run("CREATE INDEX decisions_by_layer ON decisions (layer, frame)");
    database.run("COMMIT");
  });
  return name;
}

}  // namespace talisman::sequences
