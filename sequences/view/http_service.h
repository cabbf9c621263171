// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the module talisman_view.so serves (view/http/), and how it is asked to. The library that speaks HTTP brings others
/// with it, TLS among them, so it is loaded when a view is served and not before.

#include <atomic>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace talisman::sequences {

struct ViewAnswer {
  int status = 200;  ///< of HTTP; 409: stale, 422: invalid, and `body` has the tool's line
  std::string body;
  std::string type = "application/json";
};

/// A path and what it answers, to the body of a POST; a GET has none.
struct HttpRoute {
  std::string method, path;
  std::function<ViewAnswer(const std::string& body)> answer;
};

struct HttpService {
  std::vector<HttpRoute> routes;
  int port = 0;  ///< of 127.0.0.1; 0: any that is free
  const std::atomic<bool>& stop;
  std::ostream& out;  ///< the address is printed there
};

/// Serves until `stop` becomes true. `fault`: why it cannot; empty: it did.
using HttpServeFunction = void(const HttpService&, std::string& fault);
inline constexpr const char* kHttpServeSymbol = "talisman_serve";

}  // namespace talisman::sequences
