// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/http/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace talisman::sequences {

namespace {

constexpr std::chrono::milliseconds kStopCheck_each{50}, kDrain{200};
constexpr std::size_t kMostDrained_bytes = 1 << 20;
constexpr const char* kLoopback = "127.0.0.1";

}  // namespace

bool Connection::wait(short events, Clock::time_point until) const {
  while (!stop_) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
    if (left.count() <= 0) return false;
    pollfd asked{socket_, events, 0};
    const int found = ::poll(&asked, 1, static_cast<int>(std::min(left, kStopCheck_each).count()));
    if (found > 0) return true;
    if (found < 0 && errno != EINTR) return false;
  }
  return false;
}

bool Connection::is_readable() const {
  if (begin_ < end_) return true;
  if (!read_until_) read_until_ = Clock::now() + kPatience;
  return wait(POLLIN, *read_until_);
}

bool Connection::is_writable() const {
  return wait(POLLOUT, write_until_.value_or(Clock::now() + kPatience));
}

ssize_t Connection::read(char* to, std::size_t size) {
  if (begin_ == end_) {
    if (read_bytes_ >= kLargestRequest_bytes || !is_readable()) return -1;
    const ssize_t got = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    if (got <= 0) return got;
    begin_ = 0;
    end_ = static_cast<std::size_t>(got);
    read_bytes_ += end_;
  }
  const std::size_t count = std::min(size, end_ - begin_);
  std::memcpy(to, buffer_.data() + begin_, count);
  begin_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* from, std::size_t size) {
  if (!write_until_) write_until_ = Clock::now() + kPatience;
  if (!is_writable()) return -1;
  return ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Connection::finish() {
  ::shutdown(socket_, SHUT_WR);
  const auto until = Clock::now() + kDrain;
  std::size_t drained = 0;
  while (drained < kMostDrained_bytes && wait(POLLIN, until)) {
    const ssize_t got = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (got <= 0) break;
    drained += static_cast<std::size_t>(got);
  }
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = kLoopback;
  port = 0;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip = kLoopback;
  port = 0;
}

}  // namespace talisman::sequences
