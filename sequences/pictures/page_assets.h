// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The files of page/ and the chart library, as they were when the tool was built (embed.cmake puts them into it).

#include <string_view>

namespace talisman::sequences {

/// False with TALISMAN_REPORT=OFF: there is neither template nor library, and no report.
bool has_report();

/// By its name. Empty: there is none.
///
///   page.css, theme.js                          what all pages share; also where there is no report
///   experiment.html                             the pages of experiments (pictures/page.h); likewise
///   page.js                                     what the report and the live view share, theme.js in front
///   page.html, report.js                        the report
///   view.html, view.css, view.js                the live view
///   dygraph.js, dygraph.css, dygraph.licence    the library
std::string_view page_asset(std::string_view name);

}  // namespace talisman::sequences
