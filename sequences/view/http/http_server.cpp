// SPDX-License-Identifier: Apache-2.0
/// The module behind view/http_service.h.

#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <ostream>
#include <thread>

#include <httplib.h>

#include "sequences/view/gate.h"
#include "sequences/view/http/connection.h"
#include "sequences/view/http_service.h"

namespace talisman::sequences {

namespace {

constexpr int kThreads = 64, kWaiting = 1024, kContinue = 100, kNoContent = 204;
constexpr std::chrono::milliseconds kStopCheck{50};
/// What the address with the token answers: a page of ours goes on from there, so that the strict cookie goes along
/// wherever the address was opened from.
constexpr const char* kEntrance =
    "<!doctype html><html lang=\"en\"><title>talisman view</title>"
    "<meta http-equiv=\"refresh\" content=\"0;url=/\"><a href=\"/\">talisman view</a></html>";

RequestHead head_of(const httplib::Request& request) {
  RequestHead head;
  head.method = request.method;
  head.host = request.get_header_value("Host");
  head.origin = request.get_header_value("Origin");
  head.cookie = request.get_header_value("Cookie");
  head.content_length = request.get_header_value("Content-Length");
  head.transfer_encoding = request.get_header_value("Transfer-Encoding");
  head.content_encoding = request.get_header_value("Content-Encoding");
  for (const char* once : {"Host", "Origin", "Cookie", "Content-Length"})
    if (request.get_header_value_count(once) > 1) head.host = "said twice";
  if (request.path == "/") head.token = request.get_param_value("token");
  return head;
}

/// A connection carries one request and is a Connection: bounded.
class BoundedServer : public httplib::Server {
 public:
  explicit BoundedServer(const std::atomic<bool>& stop) : stop_(stop) {}
  /// After it is bound. The library lets five wait for a place; who comes sixth tries again after a second.
  void let_wait(int connections) { ::listen(svr_sock_, connections); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, stop_);
    bool is_closed = false;
    const bool answered = process_request(connection, true, is_closed, [](httplib::Request& request) {
      request.headers.erase("Accept-Encoding");  // on one machine it costs more than it saves
      request.headers.erase("Range");
    });
    connection.finish();
    ::close(socket);
    return answered;
  }

  const std::atomic<bool>& stop_;
};

/// Turns away what may not come in, and moves the token out of the address.
httplib::Server::HandlerResponse guard(const Gate& gate, const httplib::Request& request,
                                       httplib::Response& response) {
  const RequestHead head = head_of(request);
  if (const auto status = gate.refusal(head)) {
    response.status = *status;
    response.set_content("refused\n", "text/plain");
    return httplib::Server::HandlerResponse::Handled;
  }
  if (head.token.empty()) return httplib::Server::HandlerResponse::Unhandled;
  response.set_content(kEntrance, "text/html; charset=utf-8");
  response.set_header("Set-Cookie",
                      gate.cookie_name() + "=" + gate.token + "; Path=/; HttpOnly; SameSite=Strict");
  return httplib::Server::HandlerResponse::Handled;
}

void add_routes(httplib::Server& server, const std::vector<HttpRoute>& routes) {
  for (const HttpRoute& route : routes) {
    const auto answer = [&route](const httplib::Request& request, httplib::Response& response) {
      const ViewAnswer given = route.answer(request.body);
      response.status = given.status;
      response.set_content(given.body, given.type);
    };
    if (route.method == "GET")
      server.Get(route.path, answer);
    else
      server.Post(route.path, answer);
  }
  server.Get("/favicon.ico", [](const httplib::Request&, httplib::Response& response) {
    response.status = kNoContent;  // browsers ask for it
  });
}

void configure(httplib::Server& server) {
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_payload_max_length(kLargestBody_bytes);
  server.set_tcp_nodelay(true);
  server.set_socket_options([](socket_t socket) {  // not SO_REUSEPORT: the port is ours alone
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_default_headers({{"Referrer-Policy", "no-referrer"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Cache-Control", "no-store"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Content-Security-Policy",
                               "default-src 'none'; script-src 'self'; style-src 'self'; style-src-attr "
                               "'unsafe-inline'; img-src 'self' blob:; connect-src 'self'; "
                               "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"}});
}

std::string serve(const HttpService& service) {
  BoundedServer server(service.stop);
  configure(server);
  add_routes(server, service.routes);
  Gate gate{random_token(), service.port};
  const bool bound = service.port == 0 ? (gate.port = server.bind_to_any_port("127.0.0.1")) > 0
                                       : server.bind_to_port("127.0.0.1", service.port);
  if (!bound) return "port " + std::to_string(service.port) + " of 127.0.0.1 cannot be had";
  server.let_wait(kWaiting);
  server.set_pre_routing_handler([&gate](const httplib::Request& request, httplib::Response& response) {
    return guard(gate, request, response);
  });
  server.set_expect_100_continue_handler(
      [&gate](const httplib::Request& request, httplib::Response& response) {
        return response.status = gate.refusal(head_of(request)).value_or(kContinue);
      });
  service.out << "http://127.0.0.1:" << gate.port << "/?token=" << gate.token << "\nends with Ctrl-C"
              << std::endl;
  std::atomic<bool> ended = false;
  std::thread watch([&] {
    while (!ended && !(service.stop && server.is_running())) std::this_thread::sleep_for(kStopCheck);
    if (!ended) server.stop();
  });
  server.listen_after_bind();
  ended = true;
  watch.join();
  return {};
}

}  // namespace
}  // namespace talisman::sequences

extern "C" __attribute__((visibility("default"))) void talisman_serve(
    const talisman::sequences::HttpService& service, std::string& fault) try {
  fault = talisman::sequences::serve(service);
} catch (const std::exception& error) {
  fault = error.what();
}
