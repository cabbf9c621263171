// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/ply_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "sequences/files/errors.h"
#include "sequences/import/surfaces/obj_text.h"
#include "sequences/import/wide_text.h"

namespace talisman::sequences {

namespace {

constexpr std::array<std::pair<const char*, PlyType>, 16> kPlyTypes = {{{"char", PlyType::Int8},
                                                                        {"int8", PlyType::Int8},
                                                                        {"uchar", PlyType::Uint8},
                                                                        {"uint8", PlyType::Uint8},
                                                                        {"short", PlyType::Int16},
                                                                        {"int16", PlyType::Int16},
                                                                        {"ushort", PlyType::Uint16},
                                                                        {"uint16", PlyType::Uint16},
                                                                        {"int", PlyType::Int32},
                                                                        {"int32", PlyType::Int32},
                                                                        {"uint", PlyType::Uint32},
                                                                        {"uint32", PlyType::Uint32},
                                                                        {"float", PlyType::Float},
                                                                        {"float32", PlyType::Float},
                                                                        {"double", PlyType::Double},
                                                                        {"float64", PlyType::Double}}};

enum class Encoding { Text, Little, Big };

[[noreturn]] void refuse_ply(const std::string& why) {
  throw InputError("cannot be read as a model: " + why);
}

class PlyReader {
 public:
  explicit PlyReader(std::string bytes) : bytes_(std::move(bytes)) {}

  PlyFile read() {
    read_header();
    for (PlyElement& element : file_.elements) read_values(element);
    return std::move(file_);
  }

 private:
  // --- The header

  /// Ends of lines are those of any system.
  std::string header_line() {
    const std::size_t end = bytes_.find_first_of("\r\n", at_);
    if (end == std::string::npos) refuse_ply("its header has no end_header");
    std::string line = bytes_.substr(at_, end - at_);
    at_ = end + (bytes_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++line_;
    return line;
  }

  void read_header() {
    if (rest_of_line(header_line(), 0) != "ply") refuse_ply("it does not begin with 'ply'");
    for (bool has_format = false;;) {
      const std::string line = header_line();
      std::istringstream words(line);
      std::string keyword;
      words >> keyword;
      if (keyword == "end_header") {
        if (!has_format) refuse_ply("its header has no format");
        return;
      }
      has_format |= keyword == "format";
      if (keyword == "format") encoding_ = encoding_of(words);
      if (keyword == "element") add_element(words, line);
      if (keyword == "property") add_property(words, line);
      if (keyword == "comment" && words >> keyword && keyword == "TextureFile")
        file_.pictures.push_back(rest_of_line(line, line.find("TextureFile") + 11));
    }
  }

  Encoding encoding_of(std::istringstream& words) const {
    std::string word;
    words >> word;
    if (word == "ascii") return Encoding::Text;
    if (word == "binary_little_endian") return Encoding::Little;
    if (word == "binary_big_endian") return Encoding::Big;
    refuse_line("format '" + word + "', rule: ascii, binary_little_endian or binary_big_endian");
  }

  [[noreturn]] void refuse_line(const std::string& why) const {
    refuse_ply("line " + std::to_string(line_) + " of its header: " + why);
  }

  void add_element(std::istringstream& words, const std::string& line) {
    PlyElement element;
    double count = -1;
    if (!(words >> element.name >> count) || count < 0 || count != std::floor(count) || count > 4e9)
      refuse_line("'" + line.substr(0, 60) + "', rule: 'element', a name and a number");
    element.count = static_cast<std::size_t>(count);
    file_.elements.push_back(std::move(element));
  }

  PlyType type_of(const std::string& word) const {
    for (const auto& [name, type] : kPlyTypes)
      if (word == name) return type;
    refuse_line("type '" + word + "', rule: char, uchar, short, ushort, int, uint, float or double");
  }

  void add_property(std::istringstream& words, const std::string& line) {
    if (file_.elements.empty()) refuse_line("'" + line.substr(0, 60) + "', rule: after an element");
    PlyProperty property;
    std::string type;
    words >> type;
    if (type == "list") {
      property.is_list = true;
      words >> type;
      property.count_type = type_of(type);
      words >> type;
    }
    property.type = type_of(type);
    words >> property.name;
    file_.elements.back().properties.push_back(property);
  }

  // --- The values

  void read_values(PlyElement& element) {
    const std::size_t least = element.count * element.properties.size();
    if (least > bytes_.size()) refuse_short(element, 0);
    element.values.reserve(least);
    for (std::size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        if (!property.is_list) {
          element.values.push_back(next_value(property.type, element, i));
          continue;
        }
        const double length = next_value(property.count_type, element, i);
        if (!(length >= 0 && length == std::floor(length)))
          refuse_ply("the list '" + property.name + "' of " + element.name + " " + std::to_string(i) +
                     " has " + std::to_string(length) + " entries, rule: a whole number from 0");
        element.values.push_back(length);
        for (double k = 0; k < length; ++k) element.values.push_back(next_value(property.type, element, i));
      }
  }

  [[noreturn]] static void refuse_short(const PlyElement& element, std::size_t item) {
    refuse_ply("it ends within " + element.name + " " + std::to_string(item) + " of " +
               std::to_string(element.count));
  }

  double next_value(PlyType type, const PlyElement& element, std::size_t item) {
    return encoding_ == Encoding::Text ? next_word(element, item) : next_binary(type, element, item);
  }

  double next_word(const PlyElement& element, std::size_t item) {
    at_ = bytes_.find_first_not_of(" \t\r\n", at_);
    if (at_ == std::string::npos) refuse_short(element, item);
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
    const char *first = bytes_.data() + at_ + (bytes_[at_] == '+' ? 1 : 0), *last = bytes_.data() + end;
    double value = 0;
    const auto [stop, error] = std::from_chars(first, last, value);
    if (error == std::errc::invalid_argument || stop != last)
      refuse_ply("'" + bytes_.substr(at_, std::min<std::size_t>(end - at_, 40)) + "' in " + element.name +
                 " " + std::to_string(item) + ", rule: a number");
    at_ = end;
    return value;
  }

  template <typename T>
  double taken() {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (encoding_ == Encoding::Big) std::reverse(raw.begin(), raw.end());
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(value);
  }

  double next_binary(PlyType type, const PlyElement& element, std::size_t item) {
    static constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
    if (bytes_.size() - at_ < kSizes[static_cast<std::size_t>(type)]) refuse_short(element, item);
    switch (type) {
      case PlyType::Int8:
        return taken<std::int8_t>();
      case PlyType::Uint8:
        return taken<std::uint8_t>();
      case PlyType::Int16:
        return taken<std::int16_t>();
      case PlyType::Uint16:
        return taken<std::uint16_t>();
      case PlyType::Int32:
        return taken<std::int32_t>();
      case PlyType::Uint32:
        return taken<std::uint32_t>();
      case PlyType::Float:
        return taken<float>();
      case PlyType::Double:
        break;
    }
    return taken<double>();
  }

  std::string bytes_;
  std::size_t at_ = 0, line_ = 0;
  Encoding encoding_ = Encoding::Text;
  PlyFile file_;
};

}  // namespace

int PlyElement::property(std::initializer_list<const char*> names) const {
  for (const char* name : names)
    for (std::size_t k = 0; k < properties.size(); ++k)
      if (properties[k].name == name) return static_cast<int>(k);
  return -1;
}

const PlyElement* PlyFile::element(const std::string& name) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const PlyElement& element) { return element.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

bool PlyItems::next() {
  if (item_++ >= element_.count) return false;
  for (std::size_t k = 0; k < starts_.size(); ++k) {
    starts_[k] = at_;
    at_ += element_.properties[k].is_list ? 1 + static_cast<std::size_t>(element_.values[at_]) : 1;
  }
  return true;
}

PlyFile read_ply_file(const std::string& path) {
  const auto in = open_text(path);
  if (!*in) throw InputError("cannot be opened");
  return PlyReader(std::string(std::istreambuf_iterator<char>(*in), {})).read();
}

}  // namespace talisman::sequences
