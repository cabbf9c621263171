// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/flat_line.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

double cell_number(const Cell* cell) {
  const auto* value = cell ? std::get_if<double>(cell) : nullptr;
  return value ? *value : std::nan("");
}

double cell_or_0(const Cell* cell) {
  const double value = cell_number(cell);
  return std::isnan(value) ? 0 : value;
}

std::string cell_word(const Cell* cell) {
  const auto* value = cell ? std::get_if<std::string>(cell) : nullptr;
  return value ? *value : std::string();
}

/// Follows the text down the tree of places. A node of -1: no column lies below.
struct FlatLine::Handler : nlohmann::json_sax<nlohmann::json> {
  explicit Handler(FlatLine& flat_line) : line(flat_line) {}

  FlatLine& line;
  std::vector<std::pair<int, int>> open;  ///< node, and the next index; -1: an object
  int here = 0;                           ///< the node of the value to come
  bool at_schema = false;

  void next() {
    if (open.empty() || open.back().second < 0) return;
    const int index = open.back().second++;
    here = open.back().first < 0 ? -1 : line.child(open.back().first, std::to_string(index));
  }
  bool put(Cell cell) {
    next();
    if (here >= 0 && line.nodes_[here].column >= 0) line.cells_[line.nodes_[here].column] = std::move(cell);
    return true;
  }
  bool null() override { return put({}); }
  bool boolean(bool value) override { return put(value ? 1.0 : 0.0); }
  bool number_integer(number_integer_t value) override { return put(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return put(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return put(value); }
  bool string(string_t& value) override {
    if (at_schema) line.schema_ = value;
    return put(std::move(value));
  }
  bool binary(binary_t&) override { return false; }
  bool begin(int index) {
    next();
    open.emplace_back(open.empty() ? 0 : here, index);
    return true;
  }
  bool end() {
    open.pop_back();
    return true;
  }
  bool start_object(std::size_t) override { return begin(-1); }
  bool end_object() override { return end(); }
  bool start_array(std::size_t) override { return begin(0); }
  bool end_array() override { return end(); }
  bool key(string_t& name) override {
    at_schema = open.size() == 1 && name == "schema";
    here = open.back().first < 0 ? -1 : line.child(open.back().first, name);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }
};

FlatLine::FlatLine(const std::vector<ColumnInfo>& columns) : nodes_(1), cells_(columns.size()) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    int node = 0;
    for (std::size_t from = 0; from <= columns[k].path.size();) {
      const std::size_t to = std::min(columns[k].path.find('/', from), columns[k].path.size());
      const std::string name = columns[k].path.substr(from, to - from);
      int next = child(node, name);
      if (next < 0) {
        next = static_cast<int>(nodes_.size());
        nodes_.emplace_back();
        nodes_[node].children.emplace_back(name, next);
      }
      node = next;
      from = to + 1;
    }
    nodes_[node].column = static_cast<int>(k);
  }
}

int FlatLine::child(int node, const std::string& name) const {
  for (const auto& [text, id] : nodes_[node].children)
    if (text == name) return id;
  return -1;
}

bool FlatLine::read(const std::string& text) {
  for (Cell& cell : cells_) cell = std::monostate{};
  schema_.clear();
  if (text.empty() || text.front() != '{') return false;
  Handler handler(*this);
  return nlohmann::json::sax_parse(text, &handler);
}

}  // namespace talisman::sequences
