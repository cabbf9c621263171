// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pieces of the page as HTML. Names are whatever an author or a hostile file wrote: all of them go through `escaped`.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

/// Text of an element or an attribute. Bytes that are no UTF-8 become U+FFFD, control characters too.
std::string escaped(const std::string& text);

/// JSON inside a script element: no '<' is left in it.
std::string json_in_script(const nlohmann::ordered_json& json);

/// For a link: all but letters, digits and -_.~ as %XX.
std::string url_encoded(const std::string& text);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

/// `<data value="0.99290000000000003">0.993</data>`: what is read is rounded, what is meant is exact. Empty where it is
/// not finite.
std::string number_element(double value, int digits = 3);

/// 48400 as "48.4 k", 6.73e6 as "6.73 M".
std::string large(double value);

/// A table with a caption, in a region of its own that can be scrolled by keys; cells are HTML. Columns after the first
/// `text_columns` are right-aligned. `label` names the region where the caption does not, or
/// is not the only one of its words.
std::string html_table(const std::string& id, const std::string& caption,
                       const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows, int text_columns,
                       const std::string& label = {});

/// Every `{{name}}` in the template replaced by its value, once: values are not looked into.
std::string filled(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace talisman::sequences
