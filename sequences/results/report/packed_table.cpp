// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/packed_table.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr const char* kReasonNumbers[] = {"warp_geometric_px", "geometric_px",       "held_geometric_px",
                                          "photometric_color", "light_angle_rad",    "magnification",
                                          "minification",      "anisotropy",         "uncovered_px",
                                          "turned_px",         "frames_since_render"};

bool is_number_sign(char c) { return (c >= '0' && c <= '9') || c == '.'; }

}  // namespace

std::optional<std::string> four_digits(double value) {
  if (!std::isfinite(value) || value < 1e-4 || value >= 1e4) return std::nullopt;
  // Exactly half way printf goes to the even digit, a browser to the larger one.
  const std::string all = number_text("%.60e", value);  // d.ddd5000…e±XX
  const std::string rest = all.substr(5, all.find('e') - 5);
  if (rest[0] == '5' && rest.find_first_not_of('0', 1) == std::string::npos) return std::nullopt;
  const std::string text = number_text("%.4g", value);
  if (text.find('e') != std::string::npos) return std::nullopt;
  return text;
}

PackedTable::PackedTable(std::vector<ColumnInfo> columns, const std::string& series) {
  for (ColumnInfo& column : columns) {
    by_name_[column.name] = fields_.size();
    if (column.name == "reason") reason_ = fields_.size();
    if (!series.empty() && column.name == series) series_ = fields_.size();
    fields_.push_back({std::move(column)});
  }
  for (const char* name : kReasonNumbers)
    if (by_name_.contains(name)) reason_numbers_.emplace_back(name);
}

const Cell* PackedTable::cell(const std::vector<Cell>& row, const std::string& name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &row[found->second];
}

std::uint32_t PackedTable::index(PackedField& field, const std::string& word) {
  const auto [entry, is_new] =
      field.index_of.try_emplace(word, static_cast<std::uint32_t>(field.words.size()));
  if (is_new) field.words.push_back(word);
  return entry->second;
}

/// The rows so far had no value.
void PackedTable::start(PackedField& field, bool is_words) {
  field.is_words = is_words;
  if (is_words) field.words = {""};
  field.packed.emplace(is_words ? 4 : 8);
  for (const std::uint32_t series : series_of_row_) {
    if (is_words)
      field.packed->add(series, std::uint32_t{0});
    else
      field.packed->add(series, std::numeric_limits<double>::quiet_NaN());
  }
}

std::string PackedTable::with_marks(const std::string& reason, const std::vector<Cell>& row) const {
  if (reason.find('\x01') != std::string::npos) return reason;  // as it is: the page shows the sign itself
  std::string text;
  for (std::size_t i = 0; i < reason.size();) {
    const bool begins = is_number_sign(reason[i]) && (i == 0 || reason[i - 1] == ' ' || reason[i - 1] == '(');
    std::size_t end = i + 1;
    while (begins && end < reason.size() && is_number_sign(reason[end])) ++end;
    const std::string token = reason.substr(i, end - i);
    std::string mark;
    for (std::size_t k = 0; begins && mark.empty() && k < reason_numbers_.size(); ++k) {
      const auto* value = std::get_if<double>(cell(row, reason_numbers_[k]));
      if (value && four_digits(*value) == token) mark = {'\x01', static_cast<char>('a' + k)};
    }
    text += mark.empty() ? token : mark;
    i = end;
  }
  return text;
}

void PackedTable::add(const std::vector<Cell>& row) {
  const auto* name = series_ ? std::get_if<std::string>(&row[*series_]) : nullptr;
  std::uint32_t series = 0;
  if (name) {
    PackedField& field = fields_[*series_];
    if (!field.packed) start(field, true);
    series = index(field, *name);
  }
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    PackedField& field = fields_[k];
    const Cell& value = row[k];
    const bool is_word = std::holds_alternative<std::string>(value);
    if (!field.packed) {
      if (std::holds_alternative<std::monostate>(value)) continue;
      start(field, is_word);
    }
    if (!std::holds_alternative<std::monostate>(value) && field.is_words != is_word)
      throw std::invalid_argument("'" + field.info.name + "' has numbers and words, must be one of the two");
    if (!field.is_words) {
      const auto* number = std::get_if<double>(&value);
      field.packed->add(series, number ? *number : std::numeric_limits<double>::quiet_NaN());
    } else if (is_word) {
      const auto& word = std::get<std::string>(value);
      field.packed->add(series_ == k ? 0 : series, index(field, reason_ == k ? with_marks(word, row) : word));
    } else {
      field.packed->add(series, std::uint32_t{0});
    }
  }
  series_of_row_.push_back(series);
}

}  // namespace talisman::sequences
