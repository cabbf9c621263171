// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The files of page/ and the chart library, as they were when the tool was built (embed.cmake puts them into it).

#include <string_view>

namespace talisman::sequences {

/// False with TALISMAN_REPORT=OFF: there is neither template nor library, and no report.
bool has_report();

/// By its name: "page.html", "page.css", "page.js", "dygraph.js", "dygraph.css", "dygraph.licence". Empty: there is none.
std::string_view page_asset(std::string_view name);

}  // namespace talisman::sequences
