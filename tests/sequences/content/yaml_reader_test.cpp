// SPDX-License-Identifier: Apache-2.0
// What is refused before any key is looked at: texts that are no single YAML map in UTF-8.
#include "sequences/content/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/utf8.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::message_of;

std::string error_of(const std::string& text) {
  return message_of([&] { read_yaml_text(text, "a.yaml"); });
}

TEST(ReadYaml, OneDocumentPasses) {
  EXPECT_EQ(error_of("a: 1\n"), "");
  EXPECT_EQ(error_of("%YAML 1.2\n---\na: 1\n...\n"), "");
  EXPECT_EQ(error_of("\xEF\xBB\xBF"
                     "a: 1\n"),
            "")
      << "a byte order mark is UTF-8 too";
}

TEST(ReadYaml, SecondDocumentIsRefusedWhereItBegins) {
  EXPECT_THAT(error_of("a: 1\n---\nb: 2\n"),
              HasSubstr("a.yaml:3: a second document, rule: one YAML document"));
  EXPECT_THAT(error_of("a: 1\n...\n---\n- 1\n"), HasSubstr("a.yaml:4: a second document"));
  EXPECT_THAT(error_of("a: 1\n---\n"), HasSubstr("a second document")) << "an empty one is one";
}

// Content behind the first document that no mark sets apart is not left out in silence.
TEST(ReadYaml, SecondDocumentWithoutAMarkIsRefused) {
  for (const char* text :
       {"{a: 1}\nb: 2\n", "  a: 1\nb: 2\n", "&x\n  a: 1\nb: 2\n", "\"a\"\nb: 2\n", "[1]\nb: 2\n",
        "--- {a: 1}\n--- {b: 2}\n", "a: 1\r---\rb: 2\r", "\xEF\xBB\xBF---\na: 1\n---\nb: 2\n"})
    EXPECT_THAT(error_of(text), HasSubstr("a.yaml:")) << text;
  EXPECT_EQ(error_of("---\na: 1\n"), "") << "the mark of the only one";
  EXPECT_EQ(error_of("a: |\n  ---\n  x\n"), "") << "a mark within a text is none";
}

// The library's LoadAll makes documents from it until memory ends.
TEST(ReadYaml, CommaBehindAnAnchorEnds) {
  EXPECT_THAT(error_of("&r(aFme!Fme!sbackg, esha 11\nha 11\n"), HasSubstr("a.yaml:"));
  EXPECT_THAT(error_of(", a: 1\n"), HasSubstr("a.yaml:"));
  EXPECT_THAT(error_of("&a ,\n"), HasSubstr("a.yaml"));
}

TEST(ReadYaml, WhatIsNoUtf8IsRefusedAtItsLine) {
  // Latin 1: an e with acute accent is the byte E9.
  EXPECT_THAT(error_of("a: 1\nname: caf\xE9\nb: 2\n"), HasSubstr("a.yaml:2: byte 233 is no UTF-8 here"));
  // UTF-16, with and without a byte order mark.
  EXPECT_THAT(error_of(std::string("\xFF\xFE"
                                   "a\0:\0 \0"
                                   "1\0",
                                   10)),
              HasSubstr("a.yaml:1: byte 255"));
  EXPECT_THAT(error_of(std::string("a\0:\0 \0"
                                   "1\0",
                                   8)),
              HasSubstr("a.yaml:1: byte 0"));
}

TEST(FirstNotUtf8, WellFormedSequencesOfEveryLengthPass) {
  // The ends of the rows of table 3-7: U+007F, U+0080, U+07FF, U+0800, U+D7FF, U+E000, U+FFFF, U+10000, U+10FFFF.
  for (const char* text : {"", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                           "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_FALSE(first_not_utf8(text)) << text;
}

TEST(FirstNotUtf8, IllFormedOnesAreFoundAtTheirFirstByte) {
  for (const char* wrong : {"\x80",              // a trailing byte alone
                            "\xC0\xAF",          // overlong
                            "\xE0\x9F\xBF",      // overlong
                            "\xED\xA0\x80",      // half of a surrogate pair
                            "\xF0\x8F\xBF\xBF",  // overlong
                            "\xF4\x90\x80\x80",  // above U+10FFFF
                            "\xF5\x80\x80\x80", "\xFF", "\xE2\x82", "\xE2\x82z"})
    EXPECT_EQ(first_not_utf8(std::string("ab") + wrong), 2u);
  EXPECT_EQ(first_not_utf8(std::string_view("a\0", 2)), 1u);
}

}  // namespace
}  // namespace talisman::sequences
