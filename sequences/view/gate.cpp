// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/gate.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

constexpr int kBadRequest = 400, kForbidden = 403, kLengthRequired = 411, kTooLarge = 413, kUnsupported = 415,
              kMisdirected = 421;

/// The value of a cookie; empty: there is none.
std::string cookie_value(const std::string& cookies, const std::string& name) {
  for (std::size_t at = 0; at < cookies.size();) {
    at = cookies.find_first_not_of("; ", at);
    if (at == std::string::npos) break;
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    if (cookies.compare(at, name.size() + 1, name + "=") == 0)
      return cookies.substr(at + name.size() + 1, end - at - name.size() - 1);
    at = end;
  }
  return {};
}

bool is_ours(const std::string& host, int port) {
  const std::string with_port = ":" + std::to_string(port);
  return host == "127.0.0.1" + with_port || host == "localhost" + with_port;
}

std::optional<int> refusal_of_body(const RequestHead& head) {
  if (!head.transfer_encoding.empty()) return kLengthRequired;
  if (!head.content_encoding.empty()) return kUnsupported;
  if (head.content_length.empty())
    return head.method == "POST" ? std::optional(kLengthRequired) : std::nullopt;
  std::size_t length = 0;
  const char* end = head.content_length.data() + head.content_length.size();
  const auto [read_to, error] = std::from_chars(head.content_length.data(), end, length);
  if (error == std::errc::result_out_of_range) return kTooLarge;
  if (error != std::errc() || read_to != end) return kBadRequest;
  if (length > kLargestBody_bytes) return kTooLarge;
  return std::nullopt;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw OutputError("no random bytes for the address of the view");
  std::string text;
  for (const unsigned char byte : bytes)
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  return text;
}

bool equal_in_constant_time(const std::string& a, const std::string& b) {
  unsigned char different = a.size() != b.size();
  for (std::size_t k = 0; k < a.size(); ++k)
    different |= static_cast<unsigned char>(a[k] ^ b[k < b.size() ? k : 0]);
  return different == 0 && !a.empty();
}

std::optional<int> Gate::refusal(const RequestHead& head) const {
  if (head.method != "GET" && head.method != "POST") return kBadRequest;
  if (!is_ours(head.host, port)) return kMisdirected;
  if (!head.origin.empty() && (head.origin.rfind("http://", 0) != 0 || head.origin.substr(7) != head.host))
    return kForbidden;
  const std::string said = head.token.empty() ? cookie_value(head.cookie, cookie_name()) : head.token;
  if (!equal_in_constant_time(said, token)) return kForbidden;
  return refusal_of_body(head);
}

}  // namespace talisman::sequences
