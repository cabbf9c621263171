// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/server.h"

#include "sequences/files/errors.h"
#include "sequences/files/program_folder.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/view/http_service.h"
#include "sequences/view/live_view.h"

namespace talisman::sequences {

namespace {

/// A file of the page, by its name.
HttpRoute page_route(const std::string& path, const std::string& asset, const std::string& type) {
  return {"GET", path, [asset, type](const std::string&) {
            return ViewAnswer{200, std::string(page_asset(asset)), type};
          }};
}

std::vector<HttpRoute> routes_of(LiveView& view) {
  std::vector<HttpRoute> routes = {page_route("/", "view.html", "text/html; charset=utf-8")};
  for (const std::string style : {"page.css", "dygraph.css", "view.css"})
    routes.push_back(page_route("/" + style, style, "text/css"));
  for (const std::string script : {"page.js", "dygraph.js", "view.js"})
    routes.push_back(page_route("/" + script, script, "text/javascript"));
  routes.push_back({"GET", "/about", [&view](const std::string&) { return view.about(); }});
  const auto ask = [&](const char* path, ViewAnswer (LiveView::*answer)(const std::string&)) {
    routes.push_back(
        {"POST", path, [&view, answer](const std::string& body) { return (view.*answer)(body); }});
  };
  ask("/plan", &LiveView::plan);
  ask("/frame", &LiveView::frame);
  ask("/lines", &LiveView::lines);
  ask("/picture", &LiveView::picture);
  ask("/flight", &LiveView::save);
  return routes;
}

}  // namespace

void serve_view(ViewSource source, int port, const std::atomic<bool>& stop, std::ostream& out) {
  if (!has_report()) throw OutputError("this build has no live view, rule: TALISMAN_REPORT=ON");
  auto* const serve = reinterpret_cast<HttpServeFunction*>(
      program_symbol("talisman_view.so", kHttpServeSymbol, "the live view cannot be served"));
  LiveView view(std::move(source), stop);
  std::string fault;
  serve({routes_of(view), port, stop, out}, fault);
  if (!fault.empty()) throw OutputError(fault);
}

}  // namespace talisman::sequences
