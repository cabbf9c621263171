// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One connection of the live view, bounded in time and in bytes: whatever a client sends, or does not send, it holds a
/// thread for kPatience at most, and no more than kLargestRequest_bytes of memory.
///
///   reading   all of the request within kPatience of its first wait; not kPatience for each byte
///   writing   all of the answer within kPatience of its first byte
///   ending    both give up as soon as `stop` becomes true

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include <httplib.h>

#include "sequences/view/gate.h"

namespace talisman::sequences {

class Connection : public httplib::Stream {
 public:
  static constexpr std::chrono::seconds kPatience{5};
  static constexpr std::size_t kLargestHead_bytes = 32 * 1024;
  static constexpr std::size_t kLargestRequest_bytes = kLargestHead_bytes + kLargestBody_bytes;

  /// The socket stays its owner's; non-blocking or not.
  Connection(int socket, const std::atomic<bool>& stop) : socket_(socket), stop_(stop) {}

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* to, std::size_t size) override;
  ssize_t write(const char* from, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

  /// Ends what is written and throws away, for a moment, what still comes in: a socket that is closed with bytes unread
  /// takes the answer with it.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  bool wait(short events, Clock::time_point until) const;

  int socket_;
  const std::atomic<bool>& stop_;
  mutable std::optional<Clock::time_point> read_until_;
  std::optional<Clock::time_point> write_until_;
  std::array<char, 4096> buffer_;
  std::size_t begin_ = 0, end_ = 0, read_bytes_ = 0;
};

}  // namespace talisman::sequences
