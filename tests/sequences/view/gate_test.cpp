// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/gate.h"

#include <set>

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

const Gate kGate{"0123456789abcdef0123456789abcdef", 8080};

RequestHead from_our_page() {
  RequestHead head;
  head.method = "POST";
  head.host = "127.0.0.1:8080";
  head.origin = "http://127.0.0.1:8080";
  head.cookie = "talisman_8080=" + kGate.token;
  head.content_length = "12";
  return head;
}

TEST(Gate, OurPageComesIn) {
  EXPECT_FALSE(kGate.refusal(from_our_page()));
  RequestHead head = from_our_page();
  head.host = "localhost:8080";
  head.origin = "http://localhost:8080";
  EXPECT_FALSE(kGate.refusal(head));
  head.method = "GET";
  head.origin = head.content_length = "";
  EXPECT_FALSE(kGate.refusal(head));
}

TEST(Gate, TheAddressOpensItOnce) {
  RequestHead head{"GET", "127.0.0.1:8080", "", "", "", "", "", kGate.token};
  EXPECT_FALSE(kGate.refusal(head));
  // A token that is wrong is not mended by a cookie that is right.
  head.token = "0" + kGate.token.substr(1, 30) + "0";
  head.cookie = from_our_page().cookie;
  EXPECT_EQ(kGate.refusal(head), 403);
}

TEST(Gate, AnotherTokenIsRefused) {
  for (const std::string& token : {std::string(), std::string("0"), kGate.token.substr(1), kGate.token + "0",
                                   kGate.token + std::string(1, '\0'), std::string(1 << 20, 'a')}) {
    RequestHead head = from_our_page();
    head.cookie = "talisman_8080=" + token;
    EXPECT_EQ(kGate.refusal(head), 403) << token.substr(0, 40);
  }
}

TEST(Gate, ACookieOfAnotherPortOrNameIsNone) {
  for (const char* name :
       {"talisman_8081", "talisman_808", "xtalisman_8080", "talisman_80800", "TALISMAN_8080"}) {
    RequestHead head = from_our_page();
    head.cookie = name + ("=" + kGate.token);
    EXPECT_EQ(kGate.refusal(head), 403) << name;
    // Beside others ours is found.
    head.cookie += "; talisman_8080=" + kGate.token + "; z=1";
    EXPECT_FALSE(kGate.refusal(head)) << name;
  }
  for (const char* cookies : {";", "; ;", "=", "talisman_8080", "talisman_8080=", ";;talisman_8080=;"}) {
    RequestHead head = from_our_page();
    head.cookie = cookies;
    EXPECT_EQ(kGate.refusal(head), 403) << cookies;
  }
}

TEST(Gate, AForeignHostIsRefused) {
  // Names that resolve to 127.0.0.1, and what only looks like it.
  for (const char* host : {"", "evil.example:8080", "127.0.0.1", "127.0.0.1:8081", "127.0.0.1:80800",
                           "localhost.evil.example:8080", "127.0.0.1:8080.evil.example", "127.0.0.1:8080 ",
                           "[::1]:8080", "0.0.0.0:8080", "LOCALHOST:8080", "user@127.0.0.1:8080"}) {
    RequestHead head = from_our_page();
    head.host = host;
    head.origin = "";
    EXPECT_EQ(kGate.refusal(head), 421) << host;
  }
}

TEST(Gate, AForeignOriginIsRefused) {
  for (const char* origin :
       {"null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:8081", "http://127.0.0.1",
        "http://localhost:8080", "http://127.0.0.1:8080.evil.example", "http://127.0.0.1:8080/",
        "127.0.0.1:8080"}) {
    RequestHead head = from_our_page();
    head.origin = origin;
    EXPECT_EQ(kGate.refusal(head), 403) << origin;
  }
}

TEST(Gate, ABodyIsAsLongAsItMayBeAndSaysSo) {
  const auto with_length = [](const std::string& length) {
    RequestHead head = from_our_page();
    head.content_length = length;
    return kGate.refusal(head);
  };
  EXPECT_FALSE(with_length("0"));
  EXPECT_FALSE(with_length("65536"));
  EXPECT_EQ(with_length("65537"), 413);
  EXPECT_EQ(with_length("100000000"), 413);
  EXPECT_EQ(with_length("99999999999999999999999999"), 413);
  for (const char* length : {"-1", "+5", " 5", "5 ", "0x10", "1e3", "5,5", "five"})
    EXPECT_EQ(with_length(length), 400) << length;
  EXPECT_EQ(with_length(""), 411);
}

TEST(Gate, ABodyIsNeitherInPiecesNorCompressed) {
  RequestHead head = from_our_page();
  head.transfer_encoding = "chunked";
  EXPECT_EQ(kGate.refusal(head), 411);
  head = from_our_page();
  head.content_encoding = "gzip";
  EXPECT_EQ(kGate.refusal(head), 415);
}

TEST(Gate, OnlyGetAndPost) {
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD", "TRACE", "", "get"}) {
    RequestHead head = from_our_page();
    head.method = method;
    EXPECT_EQ(kGate.refusal(head), 400) << method;
  }
}

// Who has no token learns from the answer nothing about lengths.
TEST(Gate, TheTokenIsAskedForBeforeTheBody) {
  RequestHead head = from_our_page();
  head.cookie = "";
  head.content_length = "100000000";
  EXPECT_EQ(kGate.refusal(head), 403);
}

TEST(Gate, TokensDiffer) {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), 100u);
  for (const std::string& token : tokens) {
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  }
}

TEST(Gate, EqualInConstantTimeIsEqual) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "ab"));
  EXPECT_FALSE(equal_in_constant_time("ab", "abc"));
  EXPECT_FALSE(equal_in_constant_time("aaaa", "a"));
  // Nothing is no secret.
  EXPECT_FALSE(equal_in_constant_time("", ""));
  EXPECT_FALSE(equal_in_constant_time("", "a"));
}

}  // namespace
}  // namespace talisman::sequences
