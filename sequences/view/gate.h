// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Who may talk to the live view? Only pages that it served itself, to whoever has read the address that it printed.
///
///   token    128 random bits in the printed address. The first answer moves it into a cookie (HttpOnly, SameSite=Strict, named
///            after the port, since cookies know no ports) and out of the address.
///   Host     must be the loopback address and port: a foreign name that resolves to 127.0.0.1 is turned away.
///   Origin   where a browser says it, must be the same: no page of another origin gets an answer.
///   length   of a body: at most kLargestBody_bytes, said before it is sent, and not compressed.
///
/// All of it is judged by the head of a request, before its body is read.

#include <cstddef>
#include <optional>
#include <string>

namespace talisman::sequences {

inline constexpr std::size_t kLargestBody_bytes = 64 * 1024;

/// 32 hexadecimal digits from the system's source of random bytes. Throws OutputError where there is none.
std::string random_token();

/// Takes as long for a wrong first character as for a wrong last one.
bool equal_in_constant_time(const std::string& a, const std::string& b);

/// What a request says of itself before its body. Headers that are not there are empty.
struct RequestHead {
  std::string method, host, origin, cookie, content_length, transfer_encoding, content_encoding;
  std::string token;  ///< of the address; empty: none
};

struct Gate {
  std::string token;
  int port = 0;

  std::string cookie_name() const { return "talisman_" + std::to_string(port); }
  /// The status with which the request is turned away; empty: it may come in.
  std::optional<int> refusal(const RequestHead& head) const;
};

}  // namespace talisman::sequences
