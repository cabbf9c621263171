// SPDX-License-Identifier: Apache-2.0
// The server as whoever is on the machine meets it: bytes on a socket.
#include "sequences/view/server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <future>
#include <mutex>
#include <regex>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/errors.h"
#include "sequences/pictures/page_assets.h"

namespace talisman::sequences {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Written by one thread and read by another.
class SharedText : public std::stringbuf {
 public:
  std::string text() {
    const std::lock_guard lock(mutex_);
    return str();
  }

 protected:
  std::streamsize xsputn(const char* from, std::streamsize count) override {
    const std::lock_guard lock(mutex_);
    return std::stringbuf::xsputn(from, count);
  }
  int_type overflow(int_type c) override {
    const std::lock_guard lock(mutex_);
    return std::stringbuf::overflow(c);
  }

 private:
  std::recursive_mutex mutex_;
};

class Server : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_report()) GTEST_SKIP() << "this build has no live view";
    ViewSource source;
    source.name = "nothing";
    source.fault = "nothing.yaml: there is no such file";
    source.resolve = [](const std::vector<std::string>&) -> Variant { throw InputError("there is nothing"); };
    serving_ = std::async(std::launch::async, [this, source] { serve_view(source, 0, stop_, out_); });
    const std::regex address("http://127.0.0.1:([0-9]+)/\\?token=([0-9a-f]{32})\n");
    std::string text;
    std::smatch found;
    while (!std::regex_search(text, found, address)) {
      std::this_thread::sleep_for(milliseconds(5));
      text = printed_.text();
    }
    port_ = std::stoi(found[1]);
    token_ = found[2];
  }
  void TearDown() override {
    stop_ = true;
    if (serving_.valid()) serving_.get();
  }

  int connected() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port_));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    return socket;
  }
  static bool send(int socket, const std::string& bytes) {
    return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  /// All that comes until the other side ends it; "" after `patience`.
  static std::string answer(int socket, milliseconds patience = seconds(10)) {
    std::string text;
    const auto until = steady_clock::now() + patience;
    for (;;) {
      const auto left = std::chrono::duration_cast<milliseconds>(until - steady_clock::now()).count();
      pollfd asked{socket, POLLIN, 0};
      char buffer[4096];
      if (left <= 0 || ::poll(&asked, 1, static_cast<int>(left)) <= 0) return "";
      const ssize_t got = ::recv(socket, buffer, sizeof buffer, 0);
      if (got <= 0) return text;
      text.append(buffer, static_cast<std::size_t>(got));
    }
  }
  std::string ask(const std::string& bytes) const {
    const int socket = connected();
    send(socket, bytes);
    std::string text = answer(socket);
    ::close(socket);
    return text;
  }
  std::string host() const { return "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n"; }
  std::string cookie() const { return "Cookie: talisman_" + std::to_string(port_) + "=" + token_ + "\r\n"; }
  std::string get(const std::string& path, const std::string& heads) const {
    return ask("GET " + path + " HTTP/1.1\r\n" + heads + "\r\n");
  }
  std::string post(const std::string& path, const std::string& body, const std::string& more = "") const {
    return ask("POST " + path + " HTTP/1.1\r\n" + host() + cookie() + more +
               "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  bool answers() const { return get("/", host() + cookie()).rfind("HTTP/1.1 200", 0) == 0; }

  static double memory_mb() {
    std::ifstream in("/proc/self/statm");
    long pages = 0, resident = 0;
    in >> pages >> resident;
    return static_cast<double>(resident * ::sysconf(_SC_PAGESIZE)) / 1e6;
  }

  std::atomic<bool> stop_ = false;
  SharedText printed_;
  std::ostream out_{&printed_};
  std::future<void> serving_;
  std::string token_;
  int port_ = 0;
};

TEST_F(Server, TheTokenMovesFromTheAddressIntoACookie) {
  const std::string text = get("/?token=" + token_, host());
  EXPECT_THAT(text, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(text, HasSubstr("Set-Cookie: talisman_" + std::to_string(port_) + "=" + token_ +
                              "; Path=/; HttpOnly; SameSite=Strict"));
  EXPECT_THAT(text, HasSubstr("content=\"0;url=/\""));
  const std::string page = get("/", host() + cookie());
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none';"));
  EXPECT_THAT(page, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page, Not(HasSubstr(token_)));
  EXPECT_THAT(page, Not(HasSubstr("://")));  // nothing from elsewhere
}

TEST_F(Server, WhoHasNoTokenGetsNothing) {
  for (const char* path : {"/", "/about", "/view.js", "/page.css", "/nothing"}) {
    EXPECT_THAT(get(path, host()), StartsWith("HTTP/1.1 403")) << path;
    EXPECT_THAT(get(path, host() + "Cookie: talisman_" + std::to_string(port_) + "=0\r\n"),
                StartsWith("HTTP/1.1 403"));
  }
  EXPECT_THAT(get("/?token=" + std::string(32, '0'), host()), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get("/about?token=" + token_, host()), StartsWith("HTTP/1.1 403"));  // the entrance is one
}

TEST_F(Server, ForeignHostsAndOriginsAreRefused) {
  EXPECT_THAT(get("/", "Host: evil.example\r\n" + cookie()), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(get("/", cookie()), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(get("/", host() + "Host: evil.example\r\n" + cookie()), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(get("/about", host() + cookie() + "Origin: http://evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get("/about", host() + cookie() + "Origin: null\r\n"), StartsWith("HTTP/1.1 403"));
}

TEST_F(Server, NoPathNamesAFile) {
  for (const char* path :
       {"/../../etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd", "/etc/passwd", "/page/view.html",
        "/%2e%2e/%2e%2e/etc/passwd", "/about/../../etc/passwd", "http://127.0.0.1/etc/passwd", "/pagexcss/",
        "/.", "/view.js/../../CMakeLists.txt"}) {
    const std::string text = get(path, host() + cookie());
    EXPECT_THAT(text, testing::AnyOf(StartsWith("HTTP/1.1 404"), StartsWith("HTTP/1.1 400"))) << path;
    EXPECT_THAT(text, Not(HasSubstr("root:"))) << path;
  }
}

TEST_F(Server, ALargeBodyIsRefusedBeforeItIsRead) {
  const int socket = connected();
  const auto began = steady_clock::now();
  send(socket, "POST /plan HTTP/1.1\r\n" + host() + cookie() + "Content-Length: 100000000\r\n\r\n");
  EXPECT_THAT(answer(socket), StartsWith("HTTP/1.1 413"));
  EXPECT_LT(steady_clock::now() - began, seconds(2));
  ::close(socket);
  // Who asks first whether to go on is told not to.
  EXPECT_THAT(ask("POST /plan HTTP/1.1\r\n" + host() + cookie() +
                  "Expect: 100-continue\r\nContent-Length: 100000000\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(post("/plan", "[]", "Transfer-Encoding: chunked\r\n"), StartsWith("HTTP/1.1 411"));
  EXPECT_TRUE(answers());
}

// Who sends all the same is not read to the end, and costs no memory.
TEST_F(Server, AHundredMegabytesAreNotKept) {
  EXPECT_TRUE(answers());
  const double before = memory_mb();
  for (int k = 0; k < 4; ++k) {
    const int socket = connected();
    send(socket, "POST /plan HTTP/1.1\r\n" + host() + cookie() + "Content-Length: 100000000\r\n\r\n");
    const std::string piece(1 << 20, 'x');
    int sent = 0;
    while (sent < 100 && send(socket, piece)) ++sent;
    EXPECT_LT(sent, 100);
    ::close(socket);
  }
  // A head without end, and a line without end.
  for (const char* piece : {"X-Padding: aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\r\n",
                            "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"}) {
    const int socket = connected();
    send(socket, "GET / HTTP/1.1\r\n" + host());
    std::string pieces;
    while (pieces.size() < (1 << 20)) pieces += piece;
    int sent = 0;
    while (sent < 100 && send(socket, pieces)) ++sent;
    EXPECT_LT(sent, 100);
    ::close(socket);
  }
  EXPECT_TRUE(answers());
  EXPECT_LT(memory_mb() - before, 50);
}

TEST_F(Server, ASlowRequestIsGivenUp) {
  const int silent = connected(), dripping = connected();
  const auto began = steady_clock::now();
  const std::string head = "POST /plan HTTP/1.1\r\n" + host() + cookie() + "Content-Length: 100\r\n\r\n";
  std::size_t sent = 0;
  bool is_open = true;
  while (is_open && steady_clock::now() - began < seconds(9)) {  // a byte every 100 ms: never silent for long
    is_open = send(dripping, std::string(1, sent < head.size() ? head[sent] : ' '));
    ++sent;
    std::this_thread::sleep_for(milliseconds(100));
  }
  EXPECT_FALSE(is_open);
  EXPECT_LT(steady_clock::now() - began, seconds(7));
  EXPECT_GT(steady_clock::now() - began, seconds(4));
  EXPECT_EQ(answer(silent, seconds(1)), "");  // ended, not waited for
  char byte = 0;
  EXPECT_EQ(::recv(silent, &byte, 1, MSG_DONTWAIT), 0);
  ::close(silent);
  ::close(dripping);
  EXPECT_TRUE(answers());
}

TEST_F(Server, AThousandAbortedRequestsAreSurvived) {
  const std::string whole =
      "POST /plan HTTP/1.1\r\n" + host() + cookie() + "Content-Length: 12\r\n\r\n{\"tab\": \"a\"}";
  EXPECT_TRUE(answers());
  const double before = memory_mb();
  for (std::size_t k = 0; k < 1000; ++k) {
    const int socket = connected();
    send(socket, whole.substr(0, k % (whole.size() + 1)));
    if (k % 3 == 0) {  // not closed but broken off
      const linger at_once{1, 0};
      ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    }
    ::close(socket);
  }
  EXPECT_TRUE(answers());
  EXPECT_LT(memory_mb() - before, 20);
}

TEST_F(Server, ASceneThatCannotBeReadSaysWhy) {
  EXPECT_THAT(get("/", host() + cookie()), StartsWith("HTTP/1.1 200"));
  const std::string about = get("/about", host() + cookie());
  EXPECT_THAT(about, StartsWith("HTTP/1.1 422"));
  EXPECT_THAT(about, HasSubstr("nothing.yaml: there is no such file"));
  EXPECT_THAT(post("/plan", "{}"), StartsWith("HTTP/1.1 422"));
  EXPECT_THAT(post("/plan", "{"), StartsWith("HTTP/1.1 422"));
}

TEST_F(Server, EndsAtOnceThoughConnectionsAreOpen) {
  std::vector<int> sockets;
  for (int k = 0; k < 100; ++k) sockets.push_back(connected());
  send(sockets[0], "POST /pl");
  const auto began = steady_clock::now();
  stop_ = true;
  serving_.get();
  EXPECT_LT(steady_clock::now() - began, seconds(2));
  for (const int socket : sockets) ::close(socket);
}

TEST_F(Server, APortThatIsTakenIsSaid) {
  std::ostringstream out;
  ViewSource source;
  EXPECT_THROW(serve_view(source, port_, stop_, out), OutputError);
  EXPECT_EQ(out.str(), "");
}

TEST_F(Server, IsOnTheLoopbackAlone) {
  std::ifstream in("/proc/net/tcp");
  std::ostringstream port;
  port << std::uppercase << std::hex << port_;
  int found = 0;
  for (std::string line; std::getline(in, line);)
    if (line.find(" 0A ") != std::string::npos && line.find(":" + port.str() + " ") != std::string::npos) {
      EXPECT_THAT(line, HasSubstr("0100007F:" + port.str()));
      ++found;
    }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace talisman::sequences
