// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/page_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Valid UTF-8, by way of the JSON writer, which replaces what is not.
std::string as_utf8(const std::string& text) {
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(quoted).get<std::string>();
}

std::string shortest_text(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : as_utf8(text)) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (code < 32 && c != '\n' && c != '\t')
      result += "\xEF\xBF\xBD";
    else
      result += c;
  }
  return result;
}

std::string json_in_script(const Json& json) {
  std::string result;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    result += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return result;
}

std::string url_encoded(const std::string& text) {
  std::string result;
  for (const char c : as_utf8(text)) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          std::string_view("-_.~").find(c) != std::string_view::npos;
    result += is_plain ? std::string(1, c)
                       : formatted("%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return result;
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = (bits << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[(bits >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

std::string number_element(double value, int digits) {
  if (!std::isfinite(value)) return {};
  return "<data value=\"" + shortest_text(value) + "\">" + fixed(value, digits) + "</data>";
}

std::string large(double value) {
  if (value >= 1e9) return formatted("%.3g G", value / 1e9);
  if (value >= 1e6) return formatted("%.3g M", value / 1e6);
  if (value >= 1e4) return formatted("%.3g k", value / 1e3);
  return formatted("%.0f", value);
}

std::string html_table(const std::string& id, const std::string& caption,
                       const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows, int text_columns,
                       const std::string& label) {
  const auto class_of = [&](std::size_t k) {
    return static_cast<int>(k) < text_columns ? "" : " class=\"n\"";
  };
  std::string text = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                     (label.empty() ? caption : label) + "\"><table id=\"" + id + "\">" +
                     (caption.empty() ? "" : "<caption>" + caption + "</caption>") + "\n<thead><tr>";
  for (std::size_t k = 0; k < header.size(); ++k)
    text += "<th scope=\"col\"" + std::string(class_of(k)) + ">" + header[k] + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    text += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      text += (k == 0 && !row[k].empty() ? "<th scope=\"row\">" + row[k] + "</th>"
                                         : "<td" + std::string(class_of(k)) + ">" + row[k] + "</td>");
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string filled(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text;
  while (!page.empty()) {
    const std::size_t open = page.find("{{"), close = page.find("}}", open);
    if (close == std::string_view::npos) break;
    text += page.substr(0, open);
    const std::string name(page.substr(open + 2, close - open - 2));
    const auto value =
        std::find_if(values.begin(), values.end(), [&](const auto& entry) { return entry.first == name; });
    if (value != values.end()) text += value->second;
    page.remove_prefix(close + 2);
  }
  return text.append(page);
}

}  // namespace talisman::sequences
